// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/scaled_system.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static int kinds_of(const struct topology *topology) {
    return topology ? topology->kinds : 0;
}

/// The beads that are in no molecule.
static struct composition find_single(const struct composition *composition,
                                      const struct topology *topology) {
    struct composition single = *composition;
    for (int k = 0; k < kinds_of(topology); k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            single.count[topology->kind[k].type[bead]] -= topology->kind[k].count;
    return single;
}

/// Molecules of all kinds by their share, with their beads; into a system of scaled single beads.
static void add_molecules(const struct topology *topology, double share,
                          struct scaled_system *scaled) {
    for (int k = 0; k < kinds_of(topology); k++) {
        const struct topology_kind *kind = &topology->kind[k];
        int64_t *const count = &scaled->molecules[k];
        *count =
            kind->count < 2 ? kind->count : (int64_t)fmax(2, round(share * (double)kind->count));
        for (int bead = 0; bead < kind->beads; bead++)
            scaled->composition.count[kind->type[bead]] += *count;
    }
}

/// The relative change of a share, all beads being `scale` times as many as they are now.
static double find_change(double scale, int64_t from, int64_t to) {
    return fabs(scale * (double)to / (double)from - 1);
}

struct scaled_system mf_scaled_system(const struct composition *composition,
                                      const struct topology *topology, int64_t particles) {
    const double all = (double)mf_composition_particles(composition);
    const double share = (double)particles / all;
    const struct composition single = find_single(composition, topology);
    const double singles = (double)mf_composition_particles(&single);
    const struct composition less = mf_composition_scaled(&single, (int64_t)round(share * singles));
    struct scaled_system scaled = {.composition = less};
    add_molecules(topology, share, &scaled);
    const double scale = all / (double)mf_composition_particles(&scaled.composition);
    for (int type = 0; type < single.types; type++)
        if (single.count[type] > 1)
            scaled.distortion =
                fmax(scaled.distortion, find_change(scale, single.count[type], less.count[type]));
    for (int k = 0; k < kinds_of(topology); k++)
        if (topology->kind[k].count > 0)
            scaled.distortion = fmax(scaled.distortion, find_change(scale, topology->kind[k].count,
                                                                    scaled.molecules[k]));
    return scaled;
}

bool mf_scaled_system_is_alike(const struct composition *composition,
                               const struct topology *topology) {
    const struct composition single = find_single(composition, topology);
    if (topology == NULL || (topology->kinds == 1 && mf_composition_particles(&single) == 0))
        return true;
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        int type[2];
        mf_composition_pair_types(composition, pair, type);
        if (mf_topology_intramolecular_pairs(topology, type, false) >
            mf_topology_intramolecular_pairs(topology, type, true))
            return false;
    }
    return true;
}

int64_t mf_scaled_system_min(const struct composition *composition, const struct topology *topology,
                             int64_t particles, double distortion) {
    enum { TRIALS = 100000 };
    const int64_t all = mf_composition_particles(composition);
    // A multiple of the whole is exact, unless a kind has one molecule.
    for (int64_t more = 0; more <= all && more < TRIALS; more++)
        if (mf_scaled_system(composition, topology, particles + more).distortion <= distortion)
            return particles + more;
    return all;
}

/// A kind without what mf_topology_complete finds.
static enum status copy_kind(const struct topology_kind *from, struct topology_kind *to) {
    *to = (struct topology_kind){.exclude = from->exclude, .beads = from->beads};
    memcpy(to->name, from->name, sizeof to->name);
    TRY_ARRAY(to->type, from->beads);
    memcpy(to->type, from->type, (size_t)from->beads * sizeof *to->type);
    for (int order = 0; order < BONDED_KINDS; order++) {
        to->terms[order] = from->terms[order];
        TRY_ARRAY(to->term[order], from->terms[order]);
        if (from->terms[order] > 0)
            memcpy(to->term[order], from->term[order],
                   (size_t)from->terms[order] * sizeof *to->term[order]);
    }
    return STATUS_OK;
}

enum status mf_scaled_system_topology(const struct scaled_system *system,
                                      const struct topology *from, struct topology *to) {
    *to = (struct topology){.kinds = from->kinds};
    for (int k = 0; k < from->kinds; k++) {
        TRY(copy_kind(&from->kind[k], &to->kind[k]));
        to->kind[k].count = system->molecules[k];
    }
    return mf_topology_complete(to, &system->composition);
}
