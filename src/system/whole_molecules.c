// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/whole_molecules.h"

#include "base/memory.h"

enum status mf_whole_molecules_init(struct whole_molecules *whole,
                                    const struct topology *topology) {
    const size_t kinds = (size_t)topology->kinds;
    *whole = (struct whole_molecules){.topology = topology};
    for (size_t k = 0; k < kinds; k++)
        if ((size_t)topology->kind[k].beads > whole->max_beads)
            whole->max_beads = (size_t)topology->kind[k].beads;
    TRY_ARRAY(whole->place, whole->max_beads);
    TRY_ARRAY(whole->parent, kinds * whole->max_beads);
    TRY_ARRAY(whole->order, kinds * whole->max_beads);
    for (size_t k = 0; k < kinds; k++)
        mf_topology_walk(&topology->kind[k], whole->order + k * whole->max_beads,
                         whole->parent + k * whole->max_beads);
    return STATUS_OK;
}

void mf_whole_molecules_clear(struct whole_molecules *whole) {
    mf_memory_free(whole->place);
    mf_memory_free(whole->parent);
    mf_memory_free(whole->order);
    *whole = (struct whole_molecules){0};
}

void mf_whole_molecules_make(struct whole_molecules *whole, const struct particles *particles,
                             int k, int64_t m) {
    const struct topology_kind *kind = &whole->topology->kind[k];
    const int *order = whole->order + (size_t)k * whole->max_beads;
    const int *parent = whole->parent + (size_t)k * whole->max_beads;
    for (int n = 0; n < kind->beads; n++) {
        const int bead = order[n], from = parent[bead] < 0 ? order[0] : parent[bead];
        const size_t here = particles->place[topology_id(kind, m, bead)];
        const size_t there = particles->place[topology_id(kind, m, from)];
        for (int d = 0; d < particles->box.dimensions; d++)
            whole->place[bead][d] =
                (n > 0 ? whole->place[from][d] : 0) +
                box_nearest(particles->position[d][here] - particles->position[d][there],
                            particles->box.length[d]);
    }
}

/// Σ |r_i − r_cm|² of the molecule that was made whole.
static double sum_squares(const struct whole_molecules *whole, int beads) {
    double squares = 0, centre[3] = {0};
    for (int bead = 0; bead < beads; bead++)
        for (int d = 0; d < 3; d++) {
            squares += whole->place[bead][d] * whole->place[bead][d];
            centre[d] += whole->place[bead][d];
        }
    for (int d = 0; d < 3; d++)
        squares -= centre[d] * centre[d] / beads;
    return squares;
}

double mf_whole_molecules_gyration(struct whole_molecules *whole,
                                   const struct particles *particles) {
    double squares = 0;
    for (int k = 0; k < whole->topology->kinds; k++)
        for (int64_t m = 0; m < whole->topology->kind[k].count; m++) {
            mf_whole_molecules_make(whole, particles, k, m);
            squares += sum_squares(whole, whole->topology->kind[k].beads);
        }
    return squares;
}
