// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the two sweeps over pairs of local densities.
///
/// Included by many_body_portable.c, many_body_avx2.c and many_body_avx512.c, and by their twins
/// for double precision. The first sweep collects pairs as the pair loop does (pair_collect.h), and
/// keeps those in range: the second, once all densities are known, needs no list, no root and no
/// table.
#pragma once

#include "many_body_kernels.h"
#include "pair_collect.h"

#if defined(LANES_DOUBLE)
#define MANY_BODY_PAIRS precise
#else
#define MANY_BODY_PAIRS pair
#endif

/// What is computed from a batch, column by column: one loop from separations to pairs is a chain
/// that is too long for a processor to overlap several (pair_loop.h).
struct many_body_columns {
    REAL inverse_r[PAIR_BATCH], fraction[PAIR_BATCH], weight[PAIR_BATCH], pull[PAIR_BATCH];
    int32_t interval[PAIR_BATCH];
};

/// Places in the table of w, which is flat below `inner`; beyond the cutoff is the last row, of
/// zeros.
INLINE void many_body_distances(struct many_body_columns *columns, const struct pair_batch *batch,
                                int count, const struct weight_table *law, const int dim) {
    const lanes_real inner = lanes_all((REAL)law->inner), zero = lanes_all(0);
    const lanes_real inverse_spacing = lanes_all((REAL)law->table.inverse_spacing);
    for (int k = 0; k < count; k += LANES) {
        const lanes_real dx = lanes_load(batch->dx + k), dy = lanes_load(batch->dy + k);
        lanes_real r2 = dx * dx + dy * dy;
        if (dim == 3) {
            const lanes_real dz = lanes_load(batch->dz + k);
            r2 += dz * dz;
        }
        const lanes_real r = lanes_sqrt(r2), beyond = -lanes_min(inner - r, zero);
        const lanes_real place = lanes_min(beyond * inverse_spacing, lanes_all(TABLE_INTERVALS));
        const lanes_int interval = lanes_to_int(place);
        lanes_store(columns->inverse_r + k, 1 / r);
        lanes_store_int(columns->interval + k, interval);
        lanes_store(columns->fraction + k, place - lanes_to_real(interval));
    }
}

/// w and −w'/r.
INLINE void many_body_weights(struct many_body_columns *columns, int count,
                              const struct weight_table *law) {
    const lanes_real spacing = lanes_all((REAL)(1 / law->table.inverse_spacing));
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record c =
            lanes_load_records(law->table.PAIR_ROWS, columns->interval + k);
        const lanes_real f = lanes_load(columns->fraction + k);
        const lanes_real force = c.word[1] + f * (c.word[2] + f * c.word[3]);
        const lanes_real half = c.word[2] / 2, third = c.word[3] / 3;
        lanes_store(columns->weight + k,
                    c.word[0] - spacing * f * (c.word[1] + f * (half + f * third)));
        lanes_store(columns->pull + k, force * lanes_load(columns->inverse_r + k));
    }
}

/// Keep the pairs, in whole vectors: there is room for more.
INLINE void many_body_keep(const struct many_body_columns *columns, const struct pair_batch *batch,
                           int count, struct many_body_work *work, size_t end, const int dim) {
    REAL(*pair)[4] = work->MANY_BODY_PAIRS + end;
    for (int k = 0; k < count; k += LANES)
        lanes_store_records(pair + k, lanes_load(batch->dx + k), lanes_load(batch->dy + k),
                            dim == 3 ? lanes_load(batch->dz + k) : lanes_all(0),
                            lanes_load(columns->pull + k));
    memcpy(work->i + end, batch->i, (size_t)count * sizeof *work->i);
    memcpy(work->j + end, batch->j, (size_t)count * sizeof *work->j);
}

/// Add the weights to the densities of both beads of each pair.
INLINE void many_body_scatter(const REAL *weight, const struct pair_batch *batch, int count,
                              const struct many_body_work *work, const bool mixed) {
    double *density = work->density;
    const double *share = work->share;
    for (int k = 0; k < count;) {
        const int32_t i = batch->i[k];
        const double own = mixed ? share[i] : 1;
        double sum = 0;
        for (; k < count && batch->i[k] == i; k++) {
            const int32_t j = batch->j[k];
            const double w = (double)weight[k];
            density[j] += mixed ? own * w : w;
            sum += mixed ? share[j] * w : w;
        }
        density[i] += sum;
    }
}

/// Of the first `count` pairs of a batch: weights, densities, and what is kept of them.
INLINE void many_body_evaluate(struct pair_batch *batch, int count,
                               const struct many_body_term *term, struct many_body_work *work,
                               int part, const int dim, const bool mixed) {
    struct many_body_columns columns;
    const size_t end = work->end[part];
    many_body_distances(&columns, batch, count, &term->weight, dim);
    many_body_weights(&columns, count, &term->weight);
    many_body_scatter(columns.weight, batch, count, work, mixed);
    many_body_keep(&columns, batch, count, work, end, dim);
    work->end[part] = end + (size_t)count;
}

/// What is beyond a full batch moves to its front.
INLINE void many_body_shift(struct pair_batch *batch, const int dim) {
    batch->count -= PAIR_BATCH;
    memmove(batch->i, batch->i + PAIR_BATCH, PAIR_PIECE * sizeof *batch->i);
    memmove(batch->j, batch->j + PAIR_BATCH, PAIR_PIECE * sizeof *batch->j);
    memmove(batch->dx, batch->dx + PAIR_BATCH, PAIR_PIECE * sizeof *batch->dx);
    memmove(batch->dy, batch->dy + PAIR_BATCH, PAIR_PIECE * sizeof *batch->dy);
    if (dim == 3)
        memmove(batch->dz, batch->dz + PAIR_BATCH, PAIR_PIECE * sizeof *batch->dz);
}

INLINE void many_body_density_loop(const struct many_body_term *term, struct many_body_work *work,
                                   const struct particles *particles,
                                   const struct neighbours *neighbours, int part_number,
                                   const int dim, const bool mixed) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const double cutoff = weight_cutoff(&term->weight);
    const struct pair_scene scene = {.particles = (struct particles *)particles,
                                     .box = pair_box_of(&particles->box),
                                     .cutoff2 = (REAL)(cutoff * cutoff)};
    struct pair_batch batch, none;
    batch.count = none.count = 0;
    work->end[part_number] = part->begin;
    for (size_t k = part->begin; k < part->end; k += PAIR_PIECE) {
        const int count = part->end - k < PAIR_PIECE ? (int)(part->end - k) : PAIR_PIECE;
        pair_collect(&batch, &none, &scene, neighbours->list + k,
                     neighbours->owner + k / NEIGHBOURS_ROW, count, dim, false, false, false);
        if (batch.count < PAIR_BATCH)
            continue;
        many_body_evaluate(&batch, PAIR_BATCH, term, work, part_number, dim, mixed);
        many_body_shift(&batch, dim);
    }
    pair_fill_up(&batch, 2 * (REAL)cutoff);
    many_body_evaluate(&batch, batch.count, term, work, part_number, dim, mixed);
}

INLINE void many_body_add_transfer(double (*transfer)[3], double pull, const REAL *separation,
                                   const int dim) {
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
            transfer[a][b] += pull * (double)separation[a] * (double)separation[b];
}

/// F = −(f'_i + f'_j) w'(r)/r (r_i − r_j), on i and against j: the same F. The fourth word of a sum
/// of forces means nothing.
INLINE void many_body_force_loop(const struct many_body_work *work,
                                 const struct neighbours *neighbours, int part, double (*force)[4],
                                 double *virial, double (*transfer)[3], const int dim,
                                 const bool mixed) {
    const double *slope = work->slope, *share = work->share;
    lanes_double4 *forces = (lanes_double4 *)force;
    const size_t end = work->end[part];
    double sum_of_virials = 0;
    for (size_t k = neighbours->part[part].begin; k < end;) {
        const int32_t i = work->i[k];
        const double own = slope[i], own_share = mixed ? share[i] : 1;
        lanes_double4 sum = {0};
        for (; k < end && work->i[k] == i; k++) {
            const int32_t j = work->j[k];
            const REAL *pair = work->MANY_BODY_PAIRS[k];
            const double both = mixed ? own * share[j] + slope[j] * own_share : own + slope[j];
            const double pull = both * (double)pair[3];
            const lanes_double4 separation = lanes_load_double4(pair);
            const lanes_double4 here = pull * separation;
            forces[j] -= here;
            sum += here;
            if (virial)
                sum_of_virials +=
                    here[0] * separation[0] + here[1] * separation[1] + here[2] * separation[2];
            if (transfer)
                many_body_add_transfer(transfer, pull, pair, dim);
        }
        forces[i] += sum;
    }
    if (virial)
        *virial += sum_of_virials;
}

#define MANY_BODY_DENSITIES(name, dim, mixed)                                                      \
    static void name(const struct many_body_term *term, struct many_body_work *work,               \
                     const struct particles *particles, const struct neighbours *neighbours,       \
                     int part) {                                                                   \
        many_body_density_loop(term, work, particles, neighbours, part, dim, mixed);               \
    }
#define MANY_BODY_FORCES(name, mixed)                                                              \
    static void name(const struct many_body_work *work, const struct neighbours *neighbours,       \
                     int part, double(*force)[4], double *virial, double(*transfer)[3]) {          \
        if (virial || transfer)                                                                    \
            many_body_force_loop(work, neighbours, part, force, virial, transfer, 3, mixed);       \
        else                                                                                       \
            many_body_force_loop(work, neighbours, part, force, NULL, NULL, 3, mixed);             \
    }

/// All instances for one instruction set and precision, and the record of them.
#define MANY_BODY_INSTANCES(set)                                                                   \
    MANY_BODY_DENSITIES(set##_2d, 2, false)                                                        \
    MANY_BODY_DENSITIES(set##_2d_mixed, 2, true)                                                   \
    MANY_BODY_DENSITIES(set##_3d, 3, false)                                                        \
    MANY_BODY_DENSITIES(set##_3d_mixed, 3, true)                                                   \
    MANY_BODY_FORCES(set##_forces, false)                                                          \
    MANY_BODY_FORCES(set##_forces_mixed, true)                                                     \
    const struct many_body_kernels set = {                                                         \
        {{set##_2d, set##_2d_mixed}, {set##_3d, set##_3d_mixed}},                                  \
        {set##_forces, set##_forces_mixed}};
