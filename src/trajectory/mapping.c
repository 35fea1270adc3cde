// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping.h"

#include "base/memory.h"
#include "trajectory/mapping_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Order of beads: by type, then by their first atoms.
static int by_type(const void *a, const void *b) {
    const struct mapping_bead *const x = a, *const y = b;
    if (x->type != y->type)
        return x->type < y->type ? -1 : 1;
    return x->first < y->first ? -1 : x->first > y->first;
}

enum status mf_mapping_init(struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure) {
    enum status status;
    *mapping = (struct mapping){.atoms = structure->atoms};
    CHECK(mf_mapping_build(mapping, plan, structure));
    CHECK(mf_mapping_build_masses(mapping, plan, structure));
    qsort(mapping->bead, mapping->beads, sizeof *mapping->bead, by_type);
    CHECK(mf_mapping_build_notes(mapping));
done:
    if (status != STATUS_OK)
        mf_mapping_clear(mapping);
    return status;
}

/// The type of an atom, by its name or else by the number of its type; `count` if it has none.
static size_t type_of(const struct structure_atom *atom, const char *const *types, size_t count,
                      bool *by_number) {
    for (size_t type = 0; type < count; type++)
        if (strcmp(types[type], atom->name) == 0)
            return type;
    *by_number = true;
    return atom->type >= 1 && (uint64_t)atom->type <= count ? (size_t)atom->type - 1 : count;
}

static enum status take_atoms(struct mapping *mapping, const struct structure *structure,
                              const char *const *types, const char *file) {
    OWNED bool *told = NULL;
    TRY_ARRAY(told, mapping->types + 1);
    for (size_t k = 0; k < structure->atoms; k++) {
        const struct structure_atom *const atom = &structure->atom[k];
        bool by_number = false;
        const size_t type = type_of(atom, types, mapping->types, &by_number);
        if (type == mapping->types)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: no type has the name of atom %zu, \"%s\"; map atoms to beads by --map", file,
                k + 1, atom->name);
        if (by_number && !told[type] && structure->names != STRUCTURE_TYPES) {
            told[type] = true;
            TRY(mf_mapping_note(mapping,
                                "%s: atoms \"%s\" of type number %zu are beads \"%s\", the type of "
                                "that number: no type is called \"%s\"",
                                file, atom->name, type + 1, types[type], atom->name));
        }
        mapping->atom[k] = k;
        mapping->weight[k] = 1;
        mapping->bead[mapping->beads++] =
            (struct mapping_bead){.first = k,
                                  .count = 1,
                                  .type = type,
                                  .molecule = structure->residues ? atom->residue : k,
                                  .mass = atom->mass};
    }
    return STATUS_OK;
}

/// Each type has a bead, the beads being in their order.
static enum status check_types(const struct mapping *mapping, const char *file) {
    size_t k = 0;
    for (size_t type = 0; type < mapping->types; type++) {
        const size_t begin = k;
        while (k < mapping->beads && mapping->bead[k].type == type)
            k++;
        if (k == begin)
            return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no atom of the type \"%s\"", file,
                                  mapping->type_name[type]);
    }
    return STATUS_OK;
}

enum status mf_mapping_init_atoms(struct mapping *mapping, const struct structure *structure,
                                  const char *const *types, size_t count, const char *file) {
    enum status status = STATUS_OK;
    *mapping = (struct mapping){.atoms = structure->atoms, .types = count};
    NEW_ARRAY(mapping->type_name, count);
    NEW_ARRAY(mapping->bead, structure->atoms);
    NEW_ARRAY(mapping->atom, structure->atoms);
    NEW_ARRAY(mapping->weight, structure->atoms);
    for (size_t type = 0; type < count; type++)
        snprintf(mapping->type_name[type], STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1, types[type]);
    CHECK(take_atoms(mapping, structure, types, file));
    qsort(mapping->bead, mapping->beads, sizeof *mapping->bead, by_type);
    CHECK(check_types(mapping, file));
    mapping->broken = structure->residues > 0 && structure->residues < structure->atoms;
    CHECK(mf_mapping_build_notes(mapping));
done:
    if (status != STATUS_OK)
        mf_mapping_clear(mapping);
    return status;
}

void mf_mapping_clear(struct mapping *mapping) {
    mf_memory_free(mapping->type_name);
    mf_memory_free(mapping->bead);
    mf_memory_free(mapping->atom);
    mf_memory_free(mapping->weight);
    mf_source_free(&mapping->notes);
    *mapping = (struct mapping){0};
}

static void copy_surroundings(const struct trajectory_frame *frame,
                              struct trajectory_frame *beads) {
    beads->number = frame->number;
    beads->step = frame->step;
    beads->time = frame->time;
    beads->has_box = frame->has_box;
    beads->unwrapped = frame->unwrapped;
    memcpy(beads->periodic, frame->periodic, sizeof beads->periodic);
    memcpy(beads->box, frame->box, sizeof beads->box);
    beads->file = frame->file;
}

enum status mf_mapping_apply(const struct mapping *mapping, const struct trajectory_frame *frame,
                             struct trajectory_frame *beads) {
    double reciprocal[3][3];
    if (frame->atoms != mapping->atoms)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu has %zu atoms, the map is for %zu",
                              frame->file, frame->number, frame->atoms, mapping->atoms);
    TRY(mf_frame_reserve(beads, mapping->beads, frame->has_velocities));
    copy_surroundings(frame, beads);
    mf_frame_reciprocal(frame, reciprocal);
    for (size_t k = 0; k < mapping->beads; k++) {
        const struct mapping_bead *const bead = &mapping->bead[k];
        const size_t *const atom = &mapping->atom[bead->first];
        const double *const weight = &mapping->weight[bead->first];
        double place[3], centre[3] = {0}, velocity[3] = {0};
        memcpy(place, frame->position[atom[0]], sizeof place);
        for (size_t i = 0; i < bead->count; i++) {
            mf_frame_step_to(frame, reciprocal, frame->position[atom[i]], place);
            for (int d = 0; d < 3; d++) {
                centre[d] += weight[i] * place[d];
                velocity[d] += frame->has_velocities ? weight[i] * frame->velocity[atom[i]][d] : 0;
            }
        }
        memcpy(beads->position[k], centre, sizeof centre);
        if (frame->has_velocities)
            memcpy(beads->velocity[k], velocity, sizeof velocity);
    }
    return STATUS_OK;
}
