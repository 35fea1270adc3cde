// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/molecules_listing.h"

#include "base/memory.h"
#include "scene/molecules_file.h"
#include "topologies/structure_topology.h"

#include <string.h>

/// Whether atoms of the trajectory are called as those of the listing, again and again; one without
/// names must be listed from end to end.
static bool is_listed(const struct structure *list, const struct structure *of) {
    const bool names = list->has_names && of->has_names && list->names == of->names;
    const bool ids = list->has_ids && of->has_ids && list->atoms == of->atoms;
    if (list->atoms == 0 || of->atoms % list->atoms != 0 || (!names && list->atoms != of->atoms))
        return false;
    for (size_t k = 0; k < of->atoms; k++) {
        const struct structure_atom *const a = &list->atom[k % list->atoms], *const b =
                                                                                 &of->atom[k];
        if ((names && strcmp(a->name, b->name) != 0) || (ids && a->id != b->id))
            return false;
    }
    return true;
}

/// Molecules are what bonds join, or what the listing numbers.
static enum status find_molecules(struct structure *list) {
    const struct structure_terms *const bonds = &list->terms[0];
    if (bonds->count == 0)
        return STATUS_OK;
    for (size_t k = 0; k < list->atoms; k++)
        list->atom[k].molecule = 0;
    return mf_structure_join(list, (const uint32_t(*)[2])(const void *)bonds->atom, bonds->count);
}

/// Names of types and numbers of molecules, of which those of each repeat follow each other.
static enum status take_names(struct structure *own, const struct structure *list) {
    own->has_names = own->has_molecules = true;
    own->has_residues = false;
    own->names = STRUCTURE_NAMES;
    for (size_t k = 0; k < own->atoms; k++) {
        const struct structure_atom *const from = &list->atom[k % list->atoms];
        const int64_t before = (int64_t)(k - k % list->atoms);
        memcpy(own->atom[k].name, from->type_name[0] ? from->type_name : from->name,
               STRUCTURE_NAME);
        own->atom[k].type = 0;
        own->atom[k].molecule = from->molecule > 0 ? before + from->molecule : 0;
    }
    return mf_structure_number_residues(own);
}

static void take_masses(struct structure *own, const struct structure *list) {
    for (size_t k = 0; k < own->atoms; k++)
        if (!own->has_masses || !(own->atom[k].mass >= 0))
            own->atom[k].mass = list->atom[k % list->atoms].mass;
    own->has_masses = own->has_masses || list->has_masses;
}

static enum status take(struct molecules_listing *listing, struct structure *list,
                        const struct structure *of, bool mapped) {
    struct structure *const own = &listing->structure;
    TRY(mf_structure_init(own, of->atoms));
    struct structure_atom *const atom = own->atom;
    *own = *of;
    own->atom = memcpy(atom, of->atom, of->atoms * sizeof *atom);
    memset(own->terms, 0, sizeof own->terms); // which are the other's
    listing->repeats = of->atoms / list->atoms;
    take_masses(own, list);
    if (mapped)
        return STATUS_OK;
    TRY(find_molecules(list));
    return take_names(own, list);
}

enum status mf_molecules_listing_read(struct molecules_listing *listing, struct topology *molecules,
                                      const char *file, const char *units,
                                      const struct structure *of, bool mapped) {
    struct trajectory trajectory;
    enum status status = STATUS_OK;
    *listing = (struct molecules_listing){.repeats = 0};
    if (!mf_molecules_file_lists(file))
        return STATUS_OK;
    TRY(mf_structure_topology_open(&trajectory, file, units));
    if (is_listed(&trajectory.structure, of))
        status = take(listing, &trajectory.structure, of, mapped);
    for (int k = 0; k < molecules->kinds && listing->repeats > 0; k++)
        molecules->kind[k].count *= (int64_t)listing->repeats;
    mf_trajectory_close(&trajectory);
    return status;
}

void mf_molecules_listing_clear(struct molecules_listing *listing) {
    if (listing->structure.atoms > 0)
        mf_structure_clear(&listing->structure);
    *listing = (struct molecules_listing){.repeats = 0};
}
