// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the pair loop.
///
/// Included by pair_portable.c, pair_avx2.c and pair_avx512.c, and by their twins for double
/// precision, which compile it for an instruction set and for each combination of the constant
/// arguments. What differs between the precisions is in pair_precision.h. Pairs within the cutoff
/// are collected from the list into a batch; the law is evaluated for the batch, column by column;
/// the forces are added to the particles.
///
/// Each step is a short loop of its own over columns in the first-level cache. One loop from the
/// list to the forces reads as well but takes 1.7 times as long: a pair is a chain of 110 cycles
/// there, and a processor cannot look far enough ahead to overlap several.
#pragma once

#include "base/rng_lanes.h"
#include "pair_kernels.h"
#include "pair_precision.h"

enum {
    /// Pairs evaluated together; always as many, so that loops are predictable. Measured on Zen 5,
    /// AVX-512: 64, 128, 256 and 512 make 3400, 3600, 3840 and 3790 steps/s of Lennard-Jones.
    PAIR_BATCH = 256,
    PAIR_PIECE = 128, ///< entries of the list looked at together
    PAIR_ROOM = PAIR_BATCH + PAIR_PIECE + RNG_LANES,
    PAIR_FEW = 20, ///< entries of a particle on the list, see pair_scatter_few
};

/// Pairs in range.
struct pair_batch {
    int count;
    int32_t i[PAIR_ROOM], j[PAIR_ROOM];
    int32_t id_i[PAIR_ROOM], id_j[PAIR_ROOM]; ///< where friction is kept
    REAL dx[PAIR_ROOM], dy[PAIR_ROOM], dz[PAIR_ROOM];
};

/// Where distances lie in a table.
struct pair_places {
    int32_t interval[PAIR_BATCH];
    REAL fraction[PAIR_BATCH];
};

/// What is computed from a batch, column by column.
struct pair_columns {
    REAL r[PAIR_BATCH], inverse_r[PAIR_BATCH];
    struct pair_places potential, weight;
    REAL force_over_r[PAIR_BATCH];
    REAL r_dot_v[PAIR_BATCH];
    int32_t low_id[PAIR_BATCH], high_id[PAIR_BATCH], noise[PAIR_BATCH];
    REAL force[PAIR_BATCH][4];
};

/// What stays the same from pair to pair.
struct pair_scene {
    const struct pair_law *law;
    struct particles *particles;
    struct pair_sums *sums;
    uint32_t *counts; ///< of the histogram, or NULL
    uint64_t step;
    struct pair_box box;
    REAL cutoff2, near_cutoff2; ///< squared: of the law, of its dissipative part
    bool has_few;               ///< particles have few pairs each
    size_t *kept;               ///< where the next pair is kept
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

/// Collect those of `count` entries of the list that are in range.
INLINE void pair_collect(struct pair_batch *near, struct pair_batch *far,
                         const struct pair_scene *scene, const int32_t *list, const int32_t *owner,
                         int count, const int dim, const bool has_far, const bool has_ids) {
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
        far_count = pair_append(far, far_count, in_range & ~is_near, &pairs, dim, false);
    }
    near->count = near_count;
    far->count = far_count;
}

INLINE void pair_place(struct pair_places *places, int k, const struct table *table, lanes_real r) {
    const REAL inverse_spacing = (REAL)table->inverse_spacing;
    // Beyond the cutoff is the last row, of zeros.
    const lanes_real place = lanes_least(r * inverse_spacing, lanes_all(TABLE_INTERVALS));
    const lanes_int interval = lanes_to_int(place);
    lanes_store_int(places->interval + k, interval);
    lanes_store(places->fraction + k, place - lanes_to_real(interval));
}

INLINE void pair_distances(struct pair_columns *columns, const struct pair_batch *batch, int count,
                           const struct pair_law *law, const int dim, const bool conservative,
                           const enum pair_friction friction) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_real dx = lanes_load(batch->dx + k), dy = lanes_load(batch->dy + k);
        lanes_real r2 = dx * dx + dy * dy;
        if (dim == 3) {
            const lanes_real dz = lanes_load(batch->dz + k);
            r2 += dz * dz;
        }
        // Exact root and quotient: an estimate with a Newton step is no faster, since the other
        // steps leave the divider idle, and differs between makes of processors.
        const lanes_real r = lanes_sqrt(r2);
        lanes_store(columns->r + k, r);
        lanes_store(columns->inverse_r + k, 1 / r);
        if (conservative)
            pair_place(&columns->potential, k, law->potential, r);
        if (friction != PAIR_NO_FRICTION)
            pair_place(&columns->weight, k, law->weight, r);
    }
}

/// F_C / r = −Φ'(r) / r, and the sums.
INLINE void pair_conservative(struct pair_columns *columns, int count,
                              const struct table *potential, struct pair_sums *sums,
                              const bool wants_sums) {
    const REAL spacing = (REAL)(1 / potential->inverse_spacing);
    lanes_real energy = lanes_all(0), virial = lanes_all(0);
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record c =
            lanes_load_records(potential->PAIR_ROWS, columns->potential.interval + k);
        const lanes_real f = lanes_load(columns->potential.fraction + k);
        const lanes_real force = c.word[1] + f * (c.word[2] + f * c.word[3]);
        lanes_store(columns->force_over_r + k, force * lanes_load(columns->inverse_r + k));
        if (wants_sums) {
            const lanes_real c2 = c.word[2] / 2, c3 = c.word[3] / 3;
            energy += c.word[0] - spacing * f * (c.word[1] + f * (c2 + f * c3));
            virial += force * lanes_load(columns->r + k);
        }
    }
    if (wants_sums) {
        sums->energy += lanes_sum(energy);
        sums->virial += lanes_sum(virial);
    }
}

/// r·v_ij, and the ordered ids that key the noise.
INLINE void pair_velocities(struct pair_columns *columns, const struct pair_batch *batch, int count,
                            const struct PAIR_MOTION *motion, const int dim) {
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record i = lanes_load_records(motion, batch->i + k);
        const struct lanes_record j = lanes_load_records(motion, batch->j + k);
        lanes_real r_dot_v = lanes_load(batch->dx + k) * (i.word[0] - j.word[0]) +
                             lanes_load(batch->dy + k) * (i.word[1] - j.word[1]);
        if (dim == 3)
            r_dot_v += lanes_load(batch->dz + k) * (i.word[2] - j.word[2]);
        const lanes_int id_i = pair_id(&i), id_j = pair_id(&j);
        lanes_store(columns->r_dot_v + k, r_dot_v);
        lanes_store_int(columns->low_id + k, lanes_least_int(id_i, id_j));
        lanes_store_int(columns->high_id + k, lanes_most_int(id_i, id_j));
    }
}

INLINE void pair_noise(struct pair_columns *columns, int count, uint64_t seed, uint64_t step) {
    const uint32_t stream = rng_stream_word(RNG_PAIR_NOISE, (uint32_t)(step >> 32));
    for (int k = 0; k < count; k += RNG_LANES)
        rng_philox_lanes((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)step,
                         columns->low_id + k, columns->high_id + k, stream, columns->noise + k);
}

/// Adds (F_D + F_R) / r = ω/r (sqrt(2 k_B T / Δt) ζ − ω/r r·v_ij).
INLINE void pair_dissipative(struct pair_columns *columns, int count, const struct pair_law *law,
                             const bool conservative) {
    // ζ = sqrt(12) (u − ½) with u uniform; the word as a signed integer is (u − ½) 2³².
    const REAL amplitude = (REAL)(sqrt(2 * law->temperature / law->time_step) * sqrt(12) * 0x1p-32);
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record c =
            lanes_load_records(law->weight->PAIR_ROWS, columns->weight.interval + k);
        const lanes_real omega = c.word[0] + lanes_load(columns->weight.fraction + k) * c.word[1];
        const lanes_real omega_over_r = omega * lanes_load(columns->inverse_r + k);
        const lanes_real noise = amplitude * lanes_to_real(lanes_load_int(columns->noise + k));
        lanes_real force_over_r =
            omega_over_r * (noise - omega_over_r * lanes_load(columns->r_dot_v + k));
        if (conservative)
            force_over_r += lanes_load(columns->force_over_r + k);
        lanes_store(columns->force_over_r + k, force_over_r);
    }
}

/// F = F/r (r_i − r_j), in records.
INLINE void pair_vectors(struct pair_columns *columns, const struct pair_batch *batch, int count,
                         const int dim) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_real scale = lanes_load(columns->force_over_r + k);
        lanes_store_records(columns->force + k, scale * lanes_load(batch->dx + k),
                            scale * lanes_load(batch->dy + k),
                            dim == 3 ? scale * lanes_load(batch->dz + k) : lanes_all(0),
                            lanes_all(0));
    }
}

/// force_i += F, force_j −= F: the same F, in double precision.
INLINE void pair_scatter(const struct pair_columns *columns, struct pair_batch *batch, int count,
                         lanes_double4 *force) {
    const int32_t after = batch->i[count];
    batch->i[count] = -1;
    for (int k = 0; k < count;) {
        const int32_t i = batch->i[k];
        // Two sums, because each addition waits for the one before.
        lanes_double4 sum[2] = {{0}, {0}};
        for (;;) {
            const lanes_double4 even = lanes_load_double4(columns->force[k]);
            force[batch->j[k]] -= even;
            sum[0] += even;
            if (batch->i[++k] != i)
                break;
            const lanes_double4 odd = lanes_load_double4(columns->force[k]);
            force[batch->j[k]] -= odd;
            sum[1] += odd;
            if (batch->i[++k] != i)
                break;
        }
        force[i] += sum[0] + sum[1];
    }
    batch->i[count] = after;
}

/// The same where particles have few pairs each: the branch at the end of each, which no processor
/// foresees, costs more than its pairs. So sums from the first pair of all are kept at the ends,
/// and their differences belong to the particles. Measured on Zen 5: 6 % more steps/s with 6 pairs
/// a particle, 8 % less with 28, 19 % less with 68. Not for forces in double precision, of which
/// the differences would lose the last digits: sums of floats have room for that.
INLINE void pair_scatter_few(const struct pair_columns *columns, struct pair_batch *batch,
                             int count, lanes_double4 *force) {
    lanes_double4 sum = {0}, sums[PAIR_BATCH];
    int32_t owner[PAIR_BATCH];
    int owners = 0;
    const int32_t after = batch->i[count];
    batch->i[count] = -1;
    for (int k = 0; k < count; k++) {
        const lanes_double4 here = lanes_load_double4(columns->force[k]);
        force[batch->j[k]] -= here;
        sum += here;
        sums[owners] = sum;
        owner[owners] = batch->i[k];
        owners += batch->i[k] != batch->i[k + 1];
    }
    batch->i[count] = after;
    lanes_double4 before = {0};
    for (int n = 0; n < owners; n++) {
        force[owner[n]] += sums[n] - before;
        before = sums[n];
    }
}

/// The ordered ids that key the noise.
INLINE void pair_ids(struct pair_columns *columns, const struct pair_batch *batch, int count) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_int id_i = lanes_load_int(batch->id_i + k);
        const lanes_int id_j = lanes_load_int(batch->id_j + k);
        lanes_store_int(columns->low_id + k, lanes_least_int(id_i, id_j));
        lanes_store_int(columns->high_id + k, lanes_most_int(id_i, id_j));
    }
}

/// Keep the pairs for the integrator, in whole vectors: the list has room for more.
INLINE void pair_keep(const struct pair_columns *columns, const struct pair_batch *batch, int count,
                      struct friction *friction, size_t place, const int dim) {
    const REAL unit = (REAL)(sqrt(12) * 0x1p-32); // as in pair_dissipative
    for (int k = 0; k < count; k += LANES) {
        const lanes_real inverse_r = lanes_load(columns->inverse_r + k);
        const struct lanes_record c =
            lanes_load_records(friction->PAIR_ROWS, columns->weight.interval + k);
        const lanes_real f = lanes_load(columns->weight.fraction + k);
        const lanes_real zeta = unit * lanes_to_real(lanes_load_int(columns->noise + k));
        pair_store_directions(friction->direction + place + k,
                              inverse_r * lanes_load(batch->dx + k),
                              inverse_r * lanes_load(batch->dy + k),
                              dim == 3 ? inverse_r * lanes_load(batch->dz + k) : lanes_all(0));
        pair_store_frictions(friction->pair + place + k, c.word[0] + f * c.word[1],
                             (c.word[2] + f * c.word[3]) * zeta, lanes_load_int(batch->i + k),
                             lanes_load_int(batch->j + k));
    }
}

INLINE void pair_count(const struct pair_columns *columns, int count,
                       const struct pair_histogram *histogram, uint32_t *counts) {
    const REAL low = (REAL)histogram->low, inverse_width = (REAL)(1 / histogram->width);
    const REAL bins = (REAL)histogram->bins;
    for (int k = 0; k < count; k++) {
        const REAL place = (columns->r[k] - low) * inverse_width;
        counts[place >= 0 && place < bins ? (size_t)place : histogram->bins]++;
    }
}

/// The forces of the first `count` pairs of a batch.
INLINE void pair_evaluate(struct pair_batch *batch, int count, const struct pair_scene *scene,
                          const int dim, const bool conservative, const enum pair_friction friction,
                          const bool wants_sums) {
    const struct pair_law *law = scene->law;
    struct pair_columns columns;
    pair_distances(&columns, batch, count, law, dim, conservative, friction);
    if (scene->counts)
        pair_count(&columns, count, law->histogram, scene->counts);
    if (conservative)
        pair_conservative(&columns, count, law->potential, scene->sums, wants_sums);
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
    }
    if (friction == PAIR_KEEPS_FRICTION) {
        pair_ids(&columns, batch, count);
        pair_noise(&columns, count, law->seed, scene->step);
        pair_keep(&columns, batch, count, law->friction, *scene->kept, dim);
        *scene->kept += (size_t)count;
    }
}

/// Evaluate a full batch, and move what is beyond to the front.
INLINE void pair_evaluate_full(struct pair_batch *batch, const struct pair_scene *scene,
                               const int dim, const bool conservative,
                               const enum pair_friction friction, const bool wants_sums) {
    if (batch->count < PAIR_BATCH)
        return;
    pair_evaluate(batch, PAIR_BATCH, scene, dim, conservative, friction, wants_sums);
    batch->count -= PAIR_BATCH;
    for (int k = 0; k < PAIR_PIECE; k += LANES) { // always as many: predictable
        lanes_store_int(batch->i + k, lanes_load_int(batch->i + PAIR_BATCH + k));
        lanes_store_int(batch->j + k, lanes_load_int(batch->j + PAIR_BATCH + k));
        if (friction == PAIR_KEEPS_FRICTION) {
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
                               const enum pair_friction friction, const bool wants_sums) {
    const REAL beyond = 2 * (REAL)sqrt(scene->cutoff2);
    for (int k = batch->count; k < batch->count + RNG_LANES; k++) {
        batch->i[k] = batch->j[k] = batch->id_i[k] = batch->id_j[k] = 0;
        batch->dx[k] = beyond;
        batch->dy[k] = batch->dz[k] = 0;
    }
    pair_evaluate(batch, batch->count, scene, dim, conservative, friction, wants_sums);
}

INLINE void pair_loop(const struct pair_law *law, struct particles *particles,
                      const struct neighbours *neighbours, int part_number, uint64_t step,
                      struct pair_sums *sums, const int dim, const bool conservative,
                      const enum pair_friction friction, const bool wants_sums) {
    const struct neighbours_part *part = &neighbours->part[part_number];
    const struct pair_histogram *histogram = law->histogram;
    const double cutoff = pair_cutoff(law);
    const double near_cutoff = friction != PAIR_NO_FRICTION ? law->weight->cutoff : cutoff;
    struct pair_scene scene = {.law = law,
                               .particles = particles,
                               .sums = sums,
                               .step = step,
                               .box = pair_box_of(&particles->box),
                               .cutoff2 = (REAL)(cutoff * cutoff),
                               .near_cutoff2 = (REAL)(near_cutoff * near_cutoff)};
    if (histogram)
        scene.counts = histogram->counts + (size_t)part_number * (histogram->bins + 1);
    scene.has_few =
        sizeof(REAL) == 4 && part->end - part->begin < PAIR_FEW * (part->last - part->first);
    if (friction == PAIR_KEEPS_FRICTION)
        scene.kept = &law->friction->end[part_number];
    // Near pairs feel the whole law, far ones the potential alone.
    const bool has_far = conservative && friction != PAIR_NO_FRICTION && near_cutoff < cutoff;
    struct pair_batch near, far;
    near.count = far.count = 0;
    for (size_t k = part->begin; k < part->end; k += PAIR_PIECE) {
        const int count = part->end - k < PAIR_PIECE ? (int)(part->end - k) : PAIR_PIECE;
        pair_collect(&near, &far, &scene, neighbours->list + k,
                     neighbours->owner + k / NEIGHBOURS_ROW, count, dim, has_far,
                     friction == PAIR_KEEPS_FRICTION);
        pair_evaluate_full(&near, &scene, dim, conservative, friction, wants_sums);
        if (has_far)
            pair_evaluate_full(&far, &scene, dim, conservative, PAIR_NO_FRICTION, wants_sums);
    }
    pair_evaluate_rest(&near, &scene, dim, conservative, friction, wants_sums);
    if (has_far)
        pair_evaluate_rest(&far, &scene, dim, conservative, PAIR_NO_FRICTION, wants_sums);
}

#define PAIR_INSTANCE(name, dim, conservative, friction, wants_sums)                               \
    static void name(PAIR_KERNEL_ARGUMENTS) {                                                      \
        pair_loop(law, particles, neighbours, part, step, sums, dim, conservative, friction,       \
                  wants_sums);                                                                     \
    }

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

/// All instances for one instruction set and precision, by name, and the table from which
/// pair_kernels.c chooses.
#define PAIR_INSTANCES(set)                                                                        \
    PAIR_INSTANCE(set##_2d_c, 2, true, PAIR_NO_FRICTION, false)                                    \
    PAIR_INSTANCE(set##_2d_cs, 2, true, PAIR_NO_FRICTION, true)                                    \
    PAIR_INSTANCE(set##_3d_c, 3, true, PAIR_NO_FRICTION, false)                                    \
    PAIR_INSTANCE(set##_3d_cs, 3, true, PAIR_NO_FRICTION, true)                                    \
    PAIR_FRICTION_INSTANCES(set##_added, PAIR_ADDS_FRICTION)                                       \
    PAIR_FRICTION_INSTANCES(set##_kept, PAIR_KEEPS_FRICTION)                                       \
    const pair_kernel set[2][2][PAIR_FRICTIONS][2] = {                                             \
        {{{NULL, NULL}, {set##_added_2d, set##_added_2d_s}, {set##_kept_2d, set##_kept_2d_s}},     \
         {{set##_2d_c, set##_2d_cs},                                                               \
          {set##_added_2d_c, set##_added_2d_cs},                                                   \
          {set##_kept_2d_c, set##_kept_2d_cs}}},                                                   \
        {{{NULL, NULL}, {set##_added_3d, set##_added_3d_s}, {set##_kept_3d, set##_kept_3d_s}},     \
         {{set##_3d_c, set##_3d_cs},                                                               \
          {set##_added_3d_c, set##_added_3d_cs},                                                   \
          {set##_kept_3d_c, set##_kept_3d_cs}}}};
