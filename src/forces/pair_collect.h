// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From the list to a batch of pairs in range: the first part of the pair loop.
#pragma once

#include "base/rng_lanes.h"
#include "forces/pair_kernels.h"
#include "forces/pair_mixture.h"
#include "pair_precision.h"

enum {
    PAIR_PIECE = 128, ///< entries of the list looked at together
    PAIR_ROOM = PAIR_BATCH + PAIR_PIECE + RNG_LANES,
    PAIR_FEW = 20, ///< entries of a particle on the list, see pair_scatter_few
};

/// Pairs in range.
struct pair_batch {
    _Alignas(MEMORY_ALIGNMENT) int32_t i[PAIR_ROOM];
    int32_t j[PAIR_ROOM];
    int32_t id_i[PAIR_ROOM], id_j[PAIR_ROOM]; ///< where friction is kept, and in mixtures
    REAL dx[PAIR_ROOM], dy[PAIR_ROOM], dz[PAIR_ROOM];
    int count;
};

/// What stays the same from pair to pair, in a pass over one part of the list. (Not the scene of a
/// run file.)
struct pair_scene {
    const struct pair_law *law;
    struct particles *particles;
    struct pair_sums *sums; ///< NULL: not wanted
    uint32_t *counts;       ///< of the histogram, or NULL
    double (*transfer)[3];  ///< of this part, or NULL
    uint64_t step;
    struct pair_box box;
    REAL cutoff2, near_cutoff2; ///< squared: of the law, of its dissipative part
    bool has_few;               ///< particles have few pairs each
    size_t *kept;               ///< where the next pair is kept
    size_t *held;               ///< where the next batch is held: many_body_steps.h
    struct pair_mixture mixture;
};

/// Pairs of a vector.
struct pair_vector {
    lanes_int i, j, id_i, id_j;
    lanes_real dr[3];
};

/// Append the entries of a vector whose bits are set to the first `n`; returns their new number.
INLINE int pair_append(struct pair_batch *batch, int n, unsigned mask,
                       const struct pair_vector *pairs, const int dim, const bool has_ids) {
    const lanes_int order = lanes_set_bits(mask);
    const lanes_real *dr = pairs->dr;
    lanes_store_int(batch->i + n, lanes_permute_int(pairs->i, order));
    lanes_store_int(batch->j + n, lanes_permute_int(pairs->j, order));
    if (has_ids) {
        lanes_store_int(batch->id_i + n, lanes_permute_int(pairs->id_i, order));
        lanes_store_int(batch->id_j + n, lanes_permute_int(pairs->id_j, order));
    }
    lanes_store(batch->dx + n, lanes_permute(dr[0], order));
    lanes_store(batch->dy + n, lanes_permute(dr[1], order));
    if (dim == 3)
        lanes_store(batch->dz + n, lanes_permute(dr[2], order));
    return n + __builtin_popcount(mask);
}

/// Fill up the last vector with pairs so far apart.
INLINE void pair_fill_up(struct pair_batch *batch, REAL beyond) {
    for (int k = batch->count; k < batch->count + RNG_LANES; k++) {
        batch->i[k] = batch->j[k] = batch->id_i[k] = batch->id_j[k] = 0;
        batch->dx[k] = beyond;
        batch->dy[k] = batch->dz[k] = 0;
    }
}

/// Collect those of `count` entries of the list that are in range.
INLINE void pair_collect(struct pair_batch *near, struct pair_batch *far,
                         const struct pair_scene *scene, const int32_t *list, const int32_t *owner,
                         int count, const int dim, const bool has_far, const bool has_ids,
                         const bool far_has_ids) {
    const struct PAIR_PLACE *place = scene->particles->PAIR_PLACES;
    int near_count = near->count, far_count = far->count;
    for (int k = 0; k < count; k += LANES) {
        const int32_t *rows = owner + k / NEIGHBOURS_ROW;
        const struct lanes_record j = lanes_load_records(place, list + k);
        struct pair_vector pairs = {.i = lanes_eights(rows[0], rows[1]),
                                    .j = lanes_load_int(list + k)};
        lanes_real r2 = lanes_all(0);
        for (int d = 0; d < dim; d++) {
            pairs.dr[d] = pair_separation(&scene->box, &place[rows[0]], &place[rows[1]], &j, d);
            r2 += pairs.dr[d] * pairs.dr[d];
        }
        if (has_ids) {
            pairs.id_i =
                lanes_eights(pair_owner_id(&place[rows[0]]), pair_owner_id(&place[rows[1]]));
            pairs.id_j = pair_id(&j);
        }
        // Rows are filled up with their owner, whose distance from itself is 0.
        const unsigned in_range =
            lanes_below(lanes_all(0), r2) & lanes_below(r2, lanes_all(scene->cutoff2));
        if (!has_far) {
            near_count = pair_append(near, near_count, in_range, &pairs, dim, has_ids);
            continue;
        }
        const unsigned is_near = in_range & lanes_below(r2, lanes_all(scene->near_cutoff2));
        near_count = pair_append(near, near_count, is_near, &pairs, dim, has_ids);
        far_count = pair_append(far, far_count, in_range & ~is_near, &pairs, dim, far_has_ids);
    }
    near->count = near_count;
    far->count = far_count;
}
