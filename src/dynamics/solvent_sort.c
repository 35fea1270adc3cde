// SPDX-License-Identifier: GPL-3.0-or-later
//
// A counting sort that keeps the order within a cell: the same order for any number of parts.
#include "base/memory.h"
#include "base/parallel.h"
#include "dynamics/solvent.h"

/// From the counts of each part to its places: after the earlier cells, and the earlier parts.
static void find_places(struct solvent *solvent) {
    uint32_t place = 0;
    for (size_t cell = 0; cell < solvent->cell_total; cell++) {
        solvent->start[cell] = place;
        for (int part = 0; part < solvent->parts; part++) {
            const uint32_t count = solvent->places[part][cell];
            solvent->places[part][cell] = place;
            place += count;
        }
    }
    solvent->start[solvent->cell_total] = place;
}

static void sort_plane(const struct solvent *solvent, int part) {
    uint32_t *restrict places = solvent->places[part];
    const double *x = solvent->position[0], *y = solvent->position[1];
    const double *vx = solvent->velocity[0], *vy = solvent->velocity[1];
    double *const *to = solvent->spare;
    const size_t end = solvent_part(solvent, solvent->count, part + 1);
    for (size_t k = solvent_part(solvent, solvent->count, part); k < end; k++) {
        const uint32_t place = places[solvent->cell[k]]++;
        to[0][place] = x[k];
        to[1][place] = y[k];
        to[3][place] = vx[k];
        to[4][place] = vy[k];
    }
}

static inline void fetch(const struct solvent *solvent, uint32_t place) {
    for (int d = 0; d < 6; d++)
        __builtin_prefetch(&solvent->spare[d][place], 1);
}

/// Particles beyond which memory is not in the caches of a core, and how many ahead a place is
/// fetched.
enum { FETCHED_FROM = 30000, AHEAD = 6 };

static void sort_space(const struct solvent *solvent, int part) {
    uint32_t *restrict places = solvent->places[part];
    double *const *to = solvent->spare;
    const size_t end = solvent_part(solvent, solvent->count, part + 1);
    const size_t fetches = solvent->count >= FETCHED_FROM ? end : 0;
    for (size_t k = solvent_part(solvent, solvent->count, part); k < end; k++) {
        const uint32_t place = places[solvent->cell[k]]++;
        if (k + AHEAD < fetches)
            fetch(solvent, places[solvent->cell[k + AHEAD]]);
        for (int d = 0; d < 3; d++) {
            to[d][place] = solvent->position[d][k];
            to[3 + d][place] = solvent->velocity[d][k];
        }
    }
}

static void sort_parts(void *context, size_t begin, size_t end) {
    const struct solvent *solvent = context;
    for (size_t part = begin / SOLVENT_STRETCH; part < end / SOLVENT_STRETCH; part++)
        if (solvent->box.dimensions == 2)
            sort_plane(solvent, (int)part);
        else
            sort_space(solvent, (int)part);
}

void mf_solvent_sort(struct solvent *solvent, int threads) {
    find_places(solvent);
    mf_parallel_for((size_t)solvent->parts * SOLVENT_STRETCH, threads, sort_parts, solvent);
    for (int d = 0; d < solvent->box.dimensions; d++) {
        double *position = solvent->position[d], *velocity = solvent->velocity[d];
        solvent->position[d] = solvent->spare[d];
        solvent->velocity[d] = solvent->spare[3 + d];
        solvent->spare[d] = position;
        solvent->spare[3 + d] = velocity;
    }
}
