// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is computed of a batch where there are energies of local densities: the third part of
/// the pair loop.
///
/// The force of a pair waits for the densities of both beads. So each batch is held in memory with
/// what Φ and friction make of it, and taken from there when the densities are known: the second
/// time it needs no list, no root and no table.
#pragma once

#include "many_body_work.h"
#include "pair_steps.h"

/// A batch that is held.
struct many_body_batch {
    _Alignas(MEMORY_ALIGNMENT) int32_t i[PAIR_BATCH];
    int32_t j[PAIR_BATCH];
    REAL dx[PAIR_BATCH], dy[PAIR_BATCH], dz[PAIR_BATCH];
    REAL force_over_r[PAIR_BATCH]; ///< of Φ and friction
    int count;
    _Alignas(MEMORY_ALIGNMENT) REAL pull[][PAIR_BATCH]; ///< −w'(r)/r of each term
};

INLINE struct many_body_batch *many_body_at(const struct many_body_work *work, size_t place) {
    return (struct many_body_batch *)((char *)work->held + place * work->held_size);
}

/// w and −w'/r, by the table of w, which is flat below `inner`; beyond the cutoff is the last row,
/// of zeros.
INLINE void many_body_weights(struct pair_columns *columns, REAL *pull, int count,
                              const struct weight_table *law) {
    const lanes_real inner = lanes_all((REAL)law->inner), zero = lanes_all(0);
    const lanes_real inverse_spacing = lanes_all((REAL)law->table.inverse_spacing);
    const lanes_real spacing = lanes_all((REAL)(1 / law->table.inverse_spacing));
    struct pair_places places;
    for (int k = 0; k < count; k += LANES)
        pair_place(&places, k, inverse_spacing, lanes_all_int(0),
                   -lanes_min(inner - lanes_load(columns->r + k), zero));
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record c = lanes_load_records(law->table.PAIR_ROWS, places.interval + k);
        const lanes_real f = lanes_load(places.fraction + k);
        const lanes_real force = c.word[1] + f * (c.word[2] + f * c.word[3]);
        const lanes_real half = c.word[2] / 2, third = c.word[3] * (REAL)(1 / 3.);
        lanes_store(columns->weight + k,
                    c.word[0] - spacing * f * (c.word[1] + f * (half + f * third)));
        lanes_store(pull + k, force * lanes_load(columns->inverse_r + k));
    }
}

/// Add the weights of pairs of the same i to the densities of both; returns the next one's number.
INLINE int many_body_scatter_one(const REAL *weight, const struct pair_batch *batch, int k,
                                 int count, const struct many_body_density *term,
                                 const bool shared) {
    const int32_t i = batch->i[k];
    const double own = shared ? term->share[i] : 1;
    double *density = term->density, even = 0, odd = 0; // two sums, as in pair_scatter
    for (;;) {
        int32_t j = batch->j[k];
        double w = (double)weight[k];
        density[j] += shared ? own * w : w;
        even += shared ? term->share[j] * w : w;
        if (++k == count || batch->i[k] != i)
            break;
        j = batch->j[k];
        w = (double)weight[k];
        density[j] += shared ? own * w : w;
        odd += shared ? term->share[j] * w : w;
        if (++k == count || batch->i[k] != i)
            break;
    }
    density[i] += even + odd;
    return k;
}

INLINE void many_body_scatter(const REAL *weight, const struct pair_batch *batch, int count,
                              const struct many_body_density *term) {
    if (term->share)
        for (int k = 0; k < count;)
            k = many_body_scatter_one(weight, batch, k, count, term, true);
    else
        for (int k = 0; k < count;)
            k = many_body_scatter_one(weight, batch, k, count, term, false);
}

/// Add to the densities, and hold the batch.
static __attribute__((noinline)) void many_body_hold(struct pair_columns *columns,
                                                     const struct pair_batch *batch, int count,
                                                     const struct pair_scene *scene,
                                                     const int dim) {
    const struct many_body_work *work = scene->law->many_body;
    struct many_body_batch *held = many_body_at(work, *scene->held);
    for (int t = 0; t < work->many_body->terms; t++) {
        const struct many_body_density *term = &work->term[t];
        many_body_weights(columns, held->pull[t], count, term->weight);
        many_body_scatter(columns->weight, batch, count, term);
    }
    for (int k = 0; k < count; k += LANES) {
        lanes_store_int(held->i + k, lanes_load_int(batch->i + k));
        lanes_store_int(held->j + k, lanes_load_int(batch->j + k));
        lanes_store(held->dx + k, lanes_load(batch->dx + k));
        lanes_store(held->dy + k, lanes_load(batch->dy + k));
        if (dim == 3)
            lanes_store(held->dz + k, lanes_load(batch->dz + k));
        lanes_store(held->force_over_r + k, lanes_load(columns->force_over_r + k));
    }
    held->count = count;
    ++*scene->held;
}

/// f'_i + f'_j of pairs, of central beads and neighbours that count.
INLINE void many_body_slopes(REAL *both, const struct pair_batch *batch,
                             const struct many_body_density *term) {
    const double *slope = term->slope, *share = term->share;
    for (int k = 0; k < batch->count; k++) {
        const int32_t i = batch->i[k], j = batch->j[k];
        both[k] = (REAL)(share ? slope[i] * share[j] + slope[j] * share[i] : slope[i] + slope[j]);
    }
    for (int k = batch->count; k % LANES != 0; k++)
        both[k] = 0;
}

/// F/r −= (f'_i + f'_j) w'(r)/r; returns Σ r·F of that.
INLINE REAL many_body_add(struct pair_columns *columns, const struct pair_batch *batch,
                          const REAL *both, const REAL *pull, const int dim) {
    lanes_real virial = lanes_all(0);
    for (int k = 0; k < batch->count; k += LANES) {
        const lanes_real dx = lanes_load(batch->dx + k), dy = lanes_load(batch->dy + k);
        const lanes_real added = lanes_load(both + k) * lanes_load(pull + k);
        lanes_real r2 = dx * dx + dy * dy;
        if (dim == 3) {
            const lanes_real dz = lanes_load(batch->dz + k);
            r2 += dz * dz;
        }
        virial += added * r2;
        lanes_store(columns->force_over_r + k, lanes_load(columns->force_over_r + k) + added);
    }
    return lanes_sum(virial);
}

/// Take a held batch.
INLINE void many_body_take(struct pair_columns *columns, struct pair_batch *batch,
                           const struct many_body_batch *held, const int dim) {
    for (int k = 0; k < held->count; k += LANES) {
        lanes_store_int(batch->i + k, lanes_load_int(held->i + k));
        lanes_store_int(batch->j + k, lanes_load_int(held->j + k));
        lanes_store(batch->dx + k, lanes_load(held->dx + k));
        lanes_store(batch->dy + k, lanes_load(held->dy + k));
        if (dim == 3)
            lanes_store(batch->dz + k, lanes_load(held->dz + k));
        lanes_store(columns->force_over_r + k, lanes_load(held->force_over_r + k));
    }
    batch->count = held->count;
}

/// The whole F/r of the pairs of a held batch.
INLINE void many_body_complete(struct pair_columns *columns, struct pair_batch *batch,
                               const struct many_body_batch *held, const struct pair_scene *scene,
                               const int dim) {
    const struct many_body_work *work = scene->law->many_body;
    many_body_take(columns, batch, held, dim);
    for (int t = 0; t < work->many_body->terms; t++) {
        REAL both[PAIR_BATCH];
        many_body_slopes(both, batch, &work->term[t]);
        const REAL virial = many_body_add(columns, batch, both, held->pull[t], dim);
        if (scene->sums)
            scene->sums->virial += (double)virial;
    }
}
