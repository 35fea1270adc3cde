// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping_build.h"

#include "base/memory.h"
#include "trajectory/elements.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum status mf_mapping_note(struct mapping *mapping, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const enum status status = mf_source_note(&mapping->notes, format, arguments);
    va_end(arguments);
    return status;
}

/// Mass of an atom and who says so.
enum origin { FROM_PLAN, FROM_FILE, FROM_ELEMENT, FROM_NOBODY };

const char *mf_mapping_element(const struct structure *structure, size_t k) {
    const struct structure_atom *const atom = &structure->atom[k];
    const bool alone = structure->residues > 0 && (k == 0 || atom[-1].residue != atom->residue) &&
                       (k + 1 == structure->atoms || atom[1].residue != atom->residue);
    return mf_elements_guess(atom, alone);
}

/// A mass of 0 is that of a site without any, as M of TIP4P; in a file where all are 0 it is none.
static bool has_masses(const struct structure *structure) {
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].mass > 0)
            return true;
    return false;
}

static enum origin find_mass(const struct mapping_plan *plan, const struct structure *structure,
                             bool from_file, size_t number, double *mass) {
    const struct structure_atom *const atom = &structure->atom[number];
    for (size_t k = 0; k < plan->masses; k++)
        if (strcmp(plan->mass[k].name, atom->name) == 0) {
            *mass = plan->mass[k].mass;
            return FROM_PLAN;
        }
    *mass = atom->mass;
    if (from_file && atom->mass >= 0)
        return FROM_FILE;
    const char *const element = mf_mapping_element(structure, number);
    *mass = element ? mf_elements_mass(element) : NAN;
    return element ? FROM_ELEMENT : FROM_NOBODY;
}

/// What has been guessed once need not be reported again: few names make up a liquid.
enum { MAX_REPORTED = 64 };
struct reported {
    const struct structure_atom *atom[MAX_REPORTED];
    size_t count;
    bool from_file; ///< the file knows masses
    bool *guessed;  ///< shape [atoms]
};

static bool was_reported(struct reported *reported, const struct structure_atom *atom) {
    for (size_t k = 0; k < reported->count; k++)
        if (strcmp(reported->atom[k]->name, atom->name) == 0 &&
            strcmp(reported->atom[k]->residue_name, atom->residue_name) == 0)
            return true;
    if (reported->count == MAX_REPORTED)
        return true;
    reported->atom[reported->count++] = atom;
    return false;
}

static enum status note_guess(struct mapping *mapping, struct reported *reported,
                              const struct structure *structure, size_t k, double mass) {
    const struct structure_atom *const atom = &structure->atom[k];
    if (was_reported(reported, atom))
        return STATUS_OK;
    if (reported->count == MAX_REPORTED)
        return mf_mapping_note(mapping, "masses of further names were guessed, too");
    return mf_mapping_note(mapping, "guessed by its name: \"%s\"%s%s%s is %s, %g u", atom->name,
                           atom->residue_name[0] ? " of \"" : "", atom->residue_name,
                           atom->residue_name[0] ? "\"" : "", mf_mapping_element(structure, k),
                           mass);
}

/// Whether given weights are those of masses, as 16 1 1 of water: a bead's velocity is then that of
/// its centre of mass, but for the share by which they differ.
static bool moves_with_mass(const struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure, const struct mapping_bead *bead,
                            const struct reported *reported) {
    static const double share = 0.01;
    for (size_t i = 0; bead->weighted && bead->count > 1 && i < bead->count; i++) {
        double mass;
        (void)find_mass(plan, structure, reported->from_file, mapping->atom[bead->first + i],
                        &mass);
        if (!(fabs(mapping->weight[bead->first + i] - mass / bead->mass) < share))
            return false;
    }
    return true;
}

/// The mass of a bead, and the weights of its atoms if these are not those of geometry. The weight
/// of an atom alone is 1, whatever its mass; atoms none of which has a mass weigh the same.
static enum status weigh_bead(struct mapping *mapping, const struct mapping_plan *plan,
                              const struct structure *structure, struct mapping_bead *bead,
                              struct reported *reported) {
    double *const weight = &mapping->weight[bead->first];
    const bool by_mass = !bead->weighted;
    for (size_t i = 0; i < bead->count; i++) {
        const size_t k = mapping->atom[bead->first + i];
        double mass;
        const enum origin origin = find_mass(plan, structure, reported->from_file, k, &mass);
        if (origin == FROM_NOBODY && by_mass && bead->count > 1)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: unknown mass of atom %zu, \"%s\": give it in \"masses\" of "
                                  "the map (0 for a site without mass)",
                                  plan->file, k + 1, structure->atom[k].name);
        reported->guessed[k] = origin == FROM_ELEMENT;
        if (origin == FROM_ELEMENT)
            TRY(note_guess(mapping, reported, structure, k, mass));
        bead->mass += mass;
        if (by_mass)
            weight[i] = bead->count > 1 ? mass : 1;
    }
    mapping->broken = mapping->broken || !moves_with_mass(mapping, plan, structure, bead, reported);
    const bool without = bead->mass == 0;
    for (size_t i = 0; by_mass && bead->count > 1 && i < bead->count; i++)
        weight[i] = without ? 1 / (double)bead->count : weight[i] / bead->mass;
    if (!without)
        return STATUS_OK;
    bead->mass = NAN; // none that a simulation could have
    const struct structure_atom *const first = &structure->atom[mapping->atom[bead->first]];
    return was_reported(reported, first)
               ? STATUS_OK
               : mf_mapping_note(mapping,
                                 "the bead of \"%s\" has no mass: it is at the centre of "
                                 "geometry, and its temperature is not known",
                                 first->name);
}

enum status mf_mapping_build_masses(struct mapping *mapping, const struct mapping_plan *plan,
                                    const struct structure *structure) {
    struct reported reported = {.from_file = has_masses(structure)};
    OWNED bool *guessed = NULL;
    TRY_ARRAY(guessed, structure->atoms);
    reported.guessed = guessed;
    for (size_t k = 0; k < mapping->beads; k++)
        TRY(weigh_bead(mapping, plan, structure, &mapping->bead[k], &reported));
    return mf_mapping_build_united(mapping, structure, guessed);
}

enum status mf_mapping_build_notes(struct mapping *mapping) {
    size_t k = 0;
    for (size_t type = 0; type < mapping->types; type++) {
        const size_t begin = k;
        bool same = true;
        for (; k < mapping->beads && mapping->bead[k].type == type; k++)
            same = same && mapping->bead[k].count == mapping->bead[begin].count;
        const struct mapping_bead *first = &mapping->bead[begin];
        char mass[64] = "of unknown mass: nothing names residues and atoms (-s)";
        if (isfinite(first->mass))
            snprintf(mass, sizeof mass, "the first of %.6g u", first->mass);
        TRY(mf_mapping_note(mapping, "%s: %zu beads of %s%zu atom%s, %s", mapping->type_name[type],
                            k - begin, same ? "" : "other than ", first->count,
                            first->count == 1 ? "" : "s", mass));
    }
    return STATUS_OK;
}
