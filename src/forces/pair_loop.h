// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the pair loop.
///
/// Included by pair_portable.c, pair_avx2.c and pair_avx512.c, and by their twins for double
/// precision, which compile it for an instruction set and for each combination of the constant
/// arguments. What differs between the precisions is in pair_precision.h. Pairs within the cutoff
/// are collected from the list into a batch (pair_collect.h); the law is evaluated for the batch,
/// column by column, and the forces are added to the particles (pair_steps.h).
///
/// Each step is a short loop of its own over columns in the first-level cache. One loop from the
/// list to the forces reads as well but takes 1.7 times as long: a pair is a chain of 110 cycles
/// there, and a processor cannot look far enough ahead to overlap several.
#pragma once

#include "pair_kernels.h"
#include "pair_steps.h"

/// The forces of the first `count` pairs of a batch.
INLINE void pair_evaluate(struct pair_batch *batch, int count, const struct pair_scene *scene,
                          const int dim, const bool conservative, const enum pair_friction friction,
                          const bool wants_sums, const bool mixed) {
    const struct pair_law *law = scene->law;
    struct pair_columns columns;
    if (mixed)
        pair_kinds(columns.kind, batch, count, &scene->mixture);
    pair_distances(&columns, batch, count, scene, dim, conservative, friction, mixed);
    if (scene->counts)
        pair_count(&columns, count, scene, mixed);
    if (conservative)
        pair_conservative(&columns, count, scene, wants_sums, mixed);
    if (friction == PAIR_ADDS_FRICTION) {
        pair_velocities(&columns, batch, count, scene->particles->PAIR_MOTIONS, dim);
        pair_noise(&columns, count, law->seed, scene->step);
        pair_dissipative(&columns, count, law, conservative);
    }
    if (conservative || friction == PAIR_ADDS_FRICTION) {
        pair_vectors(&columns, batch, count, dim);
        lanes_double4 *force = (lanes_double4 *)scene->particles->kernel_force;
        if (scene->has_few)
            pair_scatter_few(&columns, batch, count, force);
        else
            pair_scatter(&columns, batch, count, force);
        if (scene->transfer)
            pair_transfer(&columns, batch, count, scene->transfer, dim);
    }
    if (friction == PAIR_KEEPS_FRICTION) {
        pair_ids(columns.low_id, columns.high_id, batch, count);
        pair_noise(&columns, count, law->seed, scene->step);
        if (law->friction->method->uniform)
            pair_uniform(&columns, count);
        else
            pair_normal(columns.zeta, columns.noise, count, &law->friction->normal);
        pair_keep(&columns, batch, count, law->friction, *scene->kept, dim);
        *scene->kept += (size_t)count;
    }
}

/// Evaluate a full batch, and move what is beyond to the front.
INLINE void pair_evaluate_full(struct pair_batch *batch, const struct pair_scene *scene,
                               const int dim, const bool conservative,
                               const enum pair_friction friction, const bool wants_sums,
                               const bool mixed) {
    if (batch->count < PAIR_BATCH)
        return;
    pair_evaluate(batch, PAIR_BATCH, scene, dim, conservative, friction, wants_sums, mixed);
    batch->count -= PAIR_BATCH;
    for (int k = 0; k < PAIR_PIECE; k += LANES) { // always as many: predictable
        lanes_store_int(batch->i + k, lanes_load_int(batch->i + PAIR_BATCH + k));
        lanes_store_int(batch->j + k, lanes_load_int(batch->j + PAIR_BATCH + k));
        if (friction == PAIR_KEEPS_FRICTION || mixed) {
            lanes_store_int(batch->id_i + k, lanes_load_int(batch->id_i + PAIR_BATCH + k));
            lanes_store_int(batch->id_j + k, lanes_load_int(batch->id_j + PAIR_BATCH + k));
        }
        lanes_store(batch->dx + k, lanes_load(batch->dx + PAIR_BATCH + k));
        lanes_store(batch->dy + k, lanes_load(batch->dy + PAIR_BATCH + k));
        if (dim == 3)
            lanes_store(batch->dz + k, lanes_load(batch->dz + PAIR_BATCH + k));
    }
}

/// Evaluate what is left. The last vector is filled up with pairs beyond the cutoff, without force.
INLINE void pair_evaluate_rest(struct pair_batch *batch, const struct pair_scene *scene,
                               const int dim, const bool conservative,
                               const enum pair_friction friction, const bool wants_sums,
                               const bool mixed) {
    pair_fill_up(batch, 2 * (REAL)sqrt(scene->cutoff2));
    pair_evaluate(batch, batch->count, scene, dim, conservative, friction, wants_sums, mixed);
}

INLINE void pair_loop(const struct pair_law *law, struct particles *particles,
                      const struct neighbours *neighbours, int part_number, uint64_t step,
                      struct pair_sums *sums, const int dim, const bool conservative,
                      const enum pair_friction friction, const bool wants_sums, const bool mixed) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const struct pair_histogram *histogram = law->histogram;
    const double cutoff = mf_pair_cutoff(law);
    const double near_cutoff = friction != PAIR_NO_FRICTION ? law->omega->cutoff : cutoff;
    struct pair_scene scene = {.law = law,
                               .particles = particles,
                               .sums = sums,
                               .step = step,
                               .box = pair_box_of(&particles->box),
                               .cutoff2 = (REAL)(cutoff * cutoff),
                               .near_cutoff2 = (REAL)(near_cutoff * near_cutoff)};
    if (histogram)
        scene.counts = histogram->counts + (size_t)part_number * pair_histogram_size(histogram);
    if (law->transfer)
        scene.transfer = law->transfer->part[part_number];
    scene.has_few =
        sizeof(REAL) == 4 && part->end - part->begin < PAIR_FEW * (part->last - part->first);
    if (friction == PAIR_KEEPS_FRICTION)
        scene.kept = &law->friction->end[part_number];
    if (mixed)
        scene.mixture = pair_mixture_of(law);
    // Near pairs feel the whole law, far ones the potential alone.
    const bool has_far = conservative && friction != PAIR_NO_FRICTION && near_cutoff < cutoff;
    struct pair_batch near, far;
    near.count = far.count = 0;
    for (size_t k = part->begin; k < part->end; k += PAIR_PIECE) {
        const int count = part->end - k < PAIR_PIECE ? (int)(part->end - k) : PAIR_PIECE;
        pair_collect(&near, &far, &scene, neighbours->list + k,
                     neighbours->owner + k / NEIGHBOURS_ROW, count, dim, has_far,
                     friction == PAIR_KEEPS_FRICTION || mixed, mixed);
        pair_evaluate_full(&near, &scene, dim, conservative, friction, wants_sums, mixed);
        if (has_far)
            pair_evaluate_full(&far, &scene, dim, conservative, PAIR_NO_FRICTION, wants_sums,
                               mixed);
    }
    pair_evaluate_rest(&near, &scene, dim, conservative, friction, wants_sums, mixed);
    if (has_far)
        pair_evaluate_rest(&far, &scene, dim, conservative, PAIR_NO_FRICTION, wants_sums, mixed);
}

/// An instance for one component and one for mixtures.
#define PAIR_INSTANCE(name, dim, conservative, friction, wants_sums)                               \
    static void name(PAIR_KERNEL_ARGUMENTS) {                                                      \
        pair_loop(law, particles, neighbours, part, step, sums, dim, conservative, friction,       \
                  wants_sums, false);                                                              \
    }                                                                                              \
    static void name##_mixed(PAIR_KERNEL_ARGUMENTS) {                                              \
        pair_loop(law, particles, neighbours, part, step, sums, dim, conservative, friction,       \
                  wants_sums, true);                                                               \
    }
#define PAIR_BOTH(name)                                                                            \
    { name, name##_mixed }

/// All instances of a friction.
#define PAIR_FRICTION_INSTANCES(set, friction)                                                     \
    PAIR_INSTANCE(set##_2d, 2, false, friction, false)                                             \
    PAIR_INSTANCE(set##_2d_s, 2, false, friction, true)                                            \
    PAIR_INSTANCE(set##_2d_c, 2, true, friction, false)                                            \
    PAIR_INSTANCE(set##_2d_cs, 2, true, friction, true)                                            \
    PAIR_INSTANCE(set##_3d, 3, false, friction, false)                                             \
    PAIR_INSTANCE(set##_3d_s, 3, false, friction, true)                                            \
    PAIR_INSTANCE(set##_3d_c, 3, true, friction, false)                                            \
    PAIR_INSTANCE(set##_3d_cs, 3, true, friction, true)
#define PAIR_WITHOUT_POTENTIAL(set)                                                                \
    { PAIR_BOTH(set), PAIR_BOTH(set##_s) }
#define PAIR_WITH_POTENTIAL(set)                                                                   \
    { PAIR_BOTH(set##_c), PAIR_BOTH(set##_cs) }

/// All instances for one instruction set and precision, by name, and the table from which
/// pair_kernels.c chooses.
#define PAIR_INSTANCES(set)                                                                        \
    PAIR_INSTANCE(set##_2d_c, 2, true, PAIR_NO_FRICTION, false)                                    \
    PAIR_INSTANCE(set##_2d_cs, 2, true, PAIR_NO_FRICTION, true)                                    \
    PAIR_INSTANCE(set##_3d_c, 3, true, PAIR_NO_FRICTION, false)                                    \
    PAIR_INSTANCE(set##_3d_cs, 3, true, PAIR_NO_FRICTION, true)                                    \
    PAIR_FRICTION_INSTANCES(set##_added, PAIR_ADDS_FRICTION)                                       \
    PAIR_FRICTION_INSTANCES(set##_kept, PAIR_KEEPS_FRICTION)                                       \
    const pair_kernel set[2][2][PAIR_FRICTIONS][2][2] = {                                          \
        {{{{NULL}},                                                                                \
          PAIR_WITHOUT_POTENTIAL(set##_added_2d),                                                  \
          PAIR_WITHOUT_POTENTIAL(set##_kept_2d)},                                                  \
         {PAIR_WITH_POTENTIAL(set##_2d), PAIR_WITH_POTENTIAL(set##_added_2d),                      \
          PAIR_WITH_POTENTIAL(set##_kept_2d)}},                                                    \
        {{{{NULL}},                                                                                \
          PAIR_WITHOUT_POTENTIAL(set##_added_3d),                                                  \
          PAIR_WITHOUT_POTENTIAL(set##_kept_3d)},                                                  \
         {PAIR_WITH_POTENTIAL(set##_3d), PAIR_WITH_POTENTIAL(set##_added_3d),                      \
          PAIR_WITH_POTENTIAL(set##_kept_3d)}}};
