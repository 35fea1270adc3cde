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

#include "many_body_steps.h"

/// Add the forces to the particles.
INLINE void pair_give(struct pair_columns *columns, struct pair_batch *batch, int count,
                      const struct pair_scene *scene, const int dim) {
    lanes_double4 *force = (lanes_double4 *)scene->particles->kernel_force;
    pair_vectors(columns, batch, count, dim);
    if (scene->has_few)
        pair_scatter_few(columns, batch, count, force);
    else
        pair_scatter(columns, batch, count, force);
    if (scene->transfer)
        pair_transfer(columns, batch, count, scene->transfer, dim);
}

/// The forces of the first `count` pairs of a batch, and their sums if they are wanted.
INLINE void pair_evaluate(struct pair_batch *batch, int count, const struct pair_scene *scene,
                          const int dim, const bool conservative, const enum pair_friction friction,
                          const bool mixed) {
    const struct pair_law *law = scene->law;
    struct pair_columns columns;
    if (mixed)
        pair_kinds(columns.kind, batch, count, &scene->mixture);
    pair_distances(&columns, batch, count, scene, dim, conservative, friction, mixed);
    if (scene->counts)
        pair_count(&columns, count, scene, mixed);
    if (conservative && scene->sums)
        pair_conservative(&columns, count, scene, true, mixed);
    else if (conservative)
        pair_conservative(&columns, count, scene, false, mixed);
    if (friction == PAIR_ADDS_FRICTION) {
        pair_velocities(&columns, batch, count, scene->particles->PAIR_MOTIONS, dim);
        pair_noise(&columns, count, law->seed, scene->step);
        pair_dissipative(&columns, count, law, conservative);
    }
    if (conservative && scene->held)
        many_body_hold(&columns, batch, count, scene, dim);
    else if (conservative || friction == PAIR_ADDS_FRICTION)
        pair_give(&columns, batch, count, scene, dim);
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

/// pair_evaluate of an instance, out of line: inlined at each of its up to four callers, it took
/// three times as long to compile, and ran no faster.
typedef void pair_evaluator(struct pair_batch *batch, int count, const struct pair_scene *scene);

/// Evaluate a full batch, and move what is beyond to the front.
INLINE void pair_evaluate_full(struct pair_batch *batch, const struct pair_scene *scene,
                               pair_evaluator *evaluate, const int dim,
                               const enum pair_friction friction, const bool mixed) {
    if (batch->count < PAIR_BATCH)
        return;
    evaluate(batch, PAIR_BATCH, scene);
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
                               pair_evaluator *evaluate) {
    pair_fill_up(batch, 2 * (REAL)sqrt(scene->cutoff2));
    evaluate(batch, batch->count, scene);
}

/// What the two loops below have in common.
INLINE struct pair_scene pair_scene_of(const struct pair_law *law, struct particles *particles,
                                       const struct neighbours *neighbours, int part_number,
                                       uint64_t step, struct pair_sums *sums) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    struct pair_scene scene = {.law = law, .particles = particles, .sums = sums, .step = step};
    scene.has_few =
        sizeof(REAL) == 4 && part->end - part->begin < PAIR_FEW * (part->last - part->first);
    if (law->transfer)
        scene.transfer = law->transfer->part[part_number];
    if (law->many_body)
        scene.held = &law->many_body->end[part_number];
    return scene;
}

/// Collects the pairs in range of one part of the list in a batch, those beyond the cutoff of ω in
/// one of their own, and evaluates a batch whenever it is full.
/// @param[in] evaluate_near  for pairs within the cutoff of ω, or for all if there is no friction
/// @param[in] evaluate_far   for pairs beyond the cutoff of ω, which feel Φ alone
INLINE void pair_loop(const struct pair_law *law, struct particles *particles,
                      const struct neighbours *neighbours, int part_number, uint64_t step,
                      struct pair_sums *sums, pair_evaluator *evaluate_near,
                      pair_evaluator *evaluate_far, const int dim, const bool conservative,
                      const enum pair_friction friction, const bool mixed) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const struct pair_histogram *histogram = law->histogram;
    const double cutoff = fmax(mf_pair_cutoff(law), many_body_cutoff(law->many_body));
    const double near_cutoff = friction != PAIR_NO_FRICTION ? law->omega->cutoff : cutoff;
    struct pair_scene scene = pair_scene_of(law, particles, neighbours, part_number, step, sums);
    scene.box = pair_box_of(&particles->box);
    scene.cutoff2 = (REAL)(cutoff * cutoff);
    scene.near_cutoff2 = (REAL)(near_cutoff * near_cutoff);
    if (histogram)
        scene.counts = histogram->counts + (size_t)part_number * pair_histogram_size(histogram);
    if (friction == PAIR_KEEPS_FRICTION)
        scene.kept = &law->friction->end[part_number];
    if (mixed)
        scene.mixture = pair_mixture_of(law);
    const bool has_far = conservative && friction != PAIR_NO_FRICTION && near_cutoff < cutoff;
    struct pair_batch near, far;
    near.count = far.count = 0;
    for (size_t k = part->begin; k < part->end; k += PAIR_PIECE) {
        const int count = part->end - k < PAIR_PIECE ? (int)(part->end - k) : PAIR_PIECE;
        pair_collect(&near, &far, &scene, neighbours->list + k,
                     neighbours->owner + k / NEIGHBOURS_ROW, count, dim, has_far,
                     friction == PAIR_KEEPS_FRICTION || mixed, mixed);
        pair_evaluate_full(&near, &scene, evaluate_near, dim, friction, mixed);
        if (has_far)
            pair_evaluate_full(&far, &scene, evaluate_far, dim, PAIR_NO_FRICTION, mixed);
    }
    pair_evaluate_rest(&near, &scene, evaluate_near);
    if (has_far)
        pair_evaluate_rest(&far, &scene, evaluate_far);
}

/// The pairs of a part that a pass has held: their forces, now that the densities are known.
INLINE void pair_held_loop(const struct pair_law *law, struct particles *particles,
                           const struct neighbours *neighbours, int part, uint64_t step,
                           struct pair_sums *sums, const int dim) {
    const struct pair_scene scene = pair_scene_of(law, particles, neighbours, part, step, sums);
    for (size_t n = many_body_begin(neighbours, part); n < *scene.held; n++) {
        const struct many_body_batch *held = many_body_at(law->many_body, n);
        struct pair_batch batch;
        struct pair_columns columns;
        many_body_complete(&columns, &batch, held, &scene, dim);
        pair_give(&columns, &batch, batch.count, &scene, dim);
    }
}

/// An instance, and how it evaluates; `far` is the instance without friction.
#define PAIR_ONE(name, far, dim, conservative, friction, mixed)                                    \
    static __attribute__((noinline)) void name##_evaluate(struct pair_batch *batch, int count,     \
                                                          const struct pair_scene *scene) {        \
        pair_evaluate(batch, count, scene, dim, conservative, friction, mixed);                    \
    }                                                                                              \
    static void name(PAIR_KERNEL_ARGUMENTS) {                                                      \
        pair_loop(law, particles, neighbours, part, step, sums, name##_evaluate, far##_evaluate,   \
                  dim, conservative, friction, mixed);                                             \
    }
/// An instance for one component and one for mixtures.
#define PAIR_INSTANCE(name, far, dim, conservative, friction)                                      \
    PAIR_ONE(name, far, dim, conservative, friction, false)                                        \
    PAIR_ONE(name##_mixed, far##_mixed, dim, conservative, friction, true)
#define PAIR_BOTH(name)                                                                            \
    { name, name##_mixed }

/// All instances of a number of dimensions: friction added to the forces or kept, each without and
/// (_c) with a potential. Without friction pairs have a potential.
#define PAIR_INSTANCES_OF(set, dim)                                                                \
    PAIR_INSTANCE(set, set, dim, true, PAIR_NO_FRICTION)                                           \
    PAIR_INSTANCE(set##_added, set, dim, false, PAIR_ADDS_FRICTION)                                \
    PAIR_INSTANCE(set##_added_c, set, dim, true, PAIR_ADDS_FRICTION)                               \
    PAIR_INSTANCE(set##_kept, set, dim, false, PAIR_KEEPS_FRICTION)                                \
    PAIR_INSTANCE(set##_kept_c, set, dim, true, PAIR_KEEPS_FRICTION)
/// The same, in the order of pair_kernels: [potential][friction][mixed].
#define PAIR_KERNELS_OF(set)                                                                       \
    {                                                                                              \
        {{NULL}, PAIR_BOTH(set##_added), PAIR_BOTH(set##_kept)}, {                                 \
            PAIR_BOTH(set), PAIR_BOTH(set##_added_c), PAIR_BOTH(set##_kept_c)                      \
        }                                                                                          \
    }

/// All instances for one instruction set and precision, and the record from which pair_kernels.c
/// chooses.
#define PAIR_INSTANCES(set)                                                                        \
    PAIR_INSTANCES_OF(set##_2d, 2)                                                                 \
    PAIR_INSTANCES_OF(set##_3d, 3)                                                                 \
    static void set##_2d_held(PAIR_KERNEL_ARGUMENTS) {                                             \
        pair_held_loop(law, particles, neighbours, part, step, sums, 2);                           \
    }                                                                                              \
    static void set##_3d_held(PAIR_KERNEL_ARGUMENTS) {                                             \
        pair_held_loop(law, particles, neighbours, part, step, sums, 3);                           \
    }                                                                                              \
    const struct pair_kernels set = {                                                              \
        .all = {PAIR_KERNELS_OF(set##_2d), PAIR_KERNELS_OF(set##_3d)},                             \
        .held = {set##_2d_held, set##_3d_held},                                                    \
        .held_size = sizeof(struct many_body_batch),                                               \
        .held_term_size = PAIR_BATCH * sizeof(REAL)};
