// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is computed of a batch, step by step: the second part of the pair loop.
#pragma once

#include "pair_collect.h"

/// Where the distances of a batch lie in a table: its row, and the fraction of the interval after
/// it.
struct pair_places {
    int32_t interval[PAIR_BATCH];
    REAL fraction[PAIR_BATCH];
};

/// What is computed from a batch, column by column.
struct pair_columns {
    _Alignas(MEMORY_ALIGNMENT) REAL r[PAIR_BATCH];
    REAL inverse_r[PAIR_BATCH];
    struct pair_places potential, omega;
    int32_t kind[PAIR_BATCH]; ///< pair type in a mixture: mf_composition_pair
    REAL force_over_r[PAIR_BATCH];
    REAL weight[PAIR_BATCH]; ///< of a local density
    REAL r_dot_v[PAIR_BATCH];
    int32_t low_id[PAIR_BATCH], high_id[PAIR_BATCH], noise[PAIR_BATCH];
    REAL zeta[PAIR_BATCH]; ///< of friction that is kept
    REAL force[PAIR_BATCH][4];
};

/// Pair types.
INLINE void pair_kinds(int32_t *kind, const struct pair_batch *batch, int count,
                       const struct pair_mixture *mixture) {
    for (int k = 0; k < count; k += LANES)
        lanes_store_int(kind + k, pair_kind(mixture, lanes_load_int(batch->id_i + k),
                                            lanes_load_int(batch->id_j + k)));
}

/// The same of one vector of pairs.
struct pair_rows {
    lanes_int interval;
    lanes_real fraction;
};

/// Rows of a table for the distances r, where the curves of these pairs begin at row `first`.
INLINE struct pair_rows pair_rows_of(lanes_real inverse_spacing, lanes_int first, lanes_real r) {
    // Beyond the cutoff is the last row, of zeros.
    const lanes_real place = lanes_min(r * inverse_spacing, lanes_all(TABLE_INTERVALS));
    const lanes_int interval = lanes_to_int(place);
    return (struct pair_rows){first + interval, place - lanes_to_real(interval)};
}

INLINE void pair_place(struct pair_places *places, int k, lanes_real inverse_spacing,
                       lanes_int first, lanes_real r) {
    const struct pair_rows rows = pair_rows_of(inverse_spacing, first, r);
    lanes_store_int(places->interval + k, rows.interval);
    lanes_store(places->fraction + k, rows.fraction);
}

INLINE void pair_place_all(struct pair_columns *columns, int k, const struct pair_law *law,
                           lanes_real r, const bool conservative,
                           const enum pair_friction friction) {
    const lanes_int first = lanes_all_int(0);
    if (conservative)
        pair_place(&columns->potential, k, lanes_all((REAL)law->potential->inverse_spacing), first,
                   r);
    if (friction != PAIR_NO_FRICTION)
        pair_place(&columns->omega, k, lanes_all((REAL)law->omega->inverse_spacing), first, r);
}

INLINE void pair_place_mixed(struct pair_columns *columns, int k,
                             const struct pair_mixture *mixture, lanes_real r,
                             const bool conservative, const enum pair_friction friction) {
    const struct lanes_record grid = lanes_load_records(mixture->grid, columns->kind + k);
    const lanes_int kind = lanes_load_int(columns->kind + k);
    if (conservative)
        pair_place(&columns->potential, k, grid.word[0], kind * mixture->potential_stride, r);
    if (friction != PAIR_NO_FRICTION)
        pair_place(&columns->omega, k, grid.word[1], kind * mixture->omega_stride, r);
}

INLINE void pair_distances(struct pair_columns *columns, const struct pair_batch *batch, int count,
                           const struct pair_scene *scene, const int dim, const bool conservative,
                           const enum pair_friction friction, const bool mixed) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_real dx = lanes_load(batch->dx + k), dy = lanes_load(batch->dy + k);
        lanes_real r2 = dx * dx + dy * dy;
        if (dim == 3) {
            const lanes_real dz = lanes_load(batch->dz + k);
            r2 += dz * dz;
        }
        // Exact root and quotient: an estimate with a Newton step is no faster, since the other
        // steps leave the divider idle, and differs between makes of processors; an integer start
        // with three steps does not, and takes 0.98 to 1.03 of the time on Zen 5, AVX-512.
        const lanes_real r = lanes_sqrt(r2);
        lanes_store(columns->r + k, r);
        lanes_store(columns->inverse_r + k, 1 / r);
        if (mixed)
            pair_place_mixed(columns, k, &scene->mixture, r, conservative, friction);
        else
            pair_place_all(columns, k, scene->law, r, conservative, friction);
    }
}

/// F_C / r = −Φ'(r) / r, and the sums, of the rows of the potential's table (curves/table.h).
INLINE void pair_conservative(struct pair_columns *columns, int count,
                              const struct pair_scene *scene, const bool wants_sums,
                              const bool mixed) {
    const struct table *potential = scene->law->potential;
    lanes_real energy = lanes_all(0), virial = lanes_all(0);
    for (int k = 0; k < count; k += LANES) {
        const struct lanes_record c =
            lanes_load_records(potential->PAIR_ROWS, columns->potential.interval + k);
        const lanes_real f = lanes_load(columns->potential.fraction + k);
        const lanes_real force = c.word[1] + f * (c.word[2] + f * c.word[3]);
        lanes_store(columns->force_over_r + k, force * lanes_load(columns->inverse_r + k));
        if (wants_sums) {
            const lanes_real c2 = c.word[2] / 2, c3 = c.word[3] / 3;
            const lanes_real spacing =
                mixed ? lanes_load_records(scene->mixture.grid, columns->kind + k).word[2]
                      : lanes_all((REAL)(1 / potential->inverse_spacing));
            energy += c.word[0] - spacing * f * (c.word[1] + f * (c2 + f * c3));
            virial += force * lanes_load(columns->r + k);
        }
    }
    if (wants_sums) {
        scene->sums->energy += lanes_sum(energy);
        scene->sums->virial += lanes_sum(virial);
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
        lanes_store_int(columns->low_id + k, lanes_min_int(id_i, id_j));
        lanes_store_int(columns->high_id + k, lanes_max_int(id_i, id_j));
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
            lanes_load_records(law->omega->PAIR_ROWS, columns->omega.interval + k);
        const lanes_real omega = c.word[0] + lanes_load(columns->omega.fraction + k) * c.word[1];
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
/// foresees, costs more than its pairs. So a running sum over all pairs is noted where the pairs of
/// each particle end, and the force of a particle is the difference of two of these. Measured on
/// Zen 5: 6 % more steps/s with 6 pairs a particle, 8 % less with 28, 19 % less with 68. Not for
/// forces in double precision, of which the differences would lose the last digits: sums of floats
/// have room for that.
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

/// Adds Σ r_a F_b: struct transfer.
INLINE void pair_transfer(const struct pair_columns *columns, const struct pair_batch *batch,
                          int count, double (*transfer)[3], const int dim) {
    const REAL *const separation[3] = {batch->dx, batch->dy, batch->dz};
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) {
            lanes_real sum = lanes_all(0);
            for (int k = 0; k < count; k += LANES)
                sum += lanes_load(columns->force_over_r + k) * lanes_load(separation[a] + k) *
                       lanes_load(separation[b] + k);
            const double all = (double)lanes_sum(sum);
            transfer[a][b] += all;
            if (b != a)
                transfer[b][a] += all;
        }
}

/// The ordered ids that key the noise.
INLINE void pair_ids(int32_t *low, int32_t *high, const struct pair_batch *batch, int count) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_int id_i = lanes_load_int(batch->id_i + k);
        const lanes_int id_j = lanes_load_int(batch->id_j + k);
        lanes_store_int(low + k, lanes_min_int(id_i, id_j));
        lanes_store_int(high + k, lanes_max_int(id_i, id_j));
    }
}

/// ζ of the words: normal_of_word of each.
INLINE void pair_normal(REAL *zeta, const int32_t *words, int count,
                        const struct normal_table *table) {
    for (int k = 0; k < count; k += LANES) {
        const lanes_int word = lanes_load_int(words + k);
        // GCC's vectors shift the sign in: one instruction, where word < 0 is three.
        // cppcheck-suppress shiftTooManyBitsSigned
        const lanes_int sign = word >> 31;
        const lanes_int bits = (lanes_int)(lanes_to_float(word ^ sign) + 0.5F);
        const lanes_int place = bits & ((1 << NORMAL_BITS) - 1);
        int32_t row[LANES];
        lanes_store_int(row, (bits >> NORMAL_BITS) - NORMAL_FIRST);
        const struct lanes_record c = lanes_load_records(table->PAIR_ROWS, row);
        const lanes_real f = (REAL)(1.0 / (1 << NORMAL_BITS)) * lanes_to_real(place);
        const lanes_real value = c.word[0] + f * (c.word[1] + f * (c.word[2] + f * c.word[3]));
        lanes_store(zeta + k, value * lanes_to_real(sign | 1));
    }
}

/// Uniform ζ of the words, as in pair_dissipative.
INLINE void pair_uniform(struct pair_columns *columns, int count) {
    for (int k = 0; k < count; k += LANES)
        lanes_store(columns->zeta + k,
                    (REAL)(sqrt(12) * 0x1p-32) * lanes_to_real(lanes_load_int(columns->noise + k)));
}

/// Keep the pairs for the integrator, in whole vectors: the list has room for more.
INLINE void pair_keep(const struct pair_columns *columns, const struct pair_batch *batch, int count,
                      struct friction *friction, size_t place, const int dim) {
    const REAL scale = (REAL)friction->kick, bound = (REAL)friction->bound;
    for (int k = 0; k < count; k += LANES) {
        const lanes_real inverse_r = lanes_load(columns->inverse_r + k);
        const struct lanes_record c =
            lanes_load_records(friction->PAIR_ROWS, columns->omega.interval + k);
        const lanes_real f = lanes_load(columns->omega.fraction + k);
        const lanes_real root = c.word[0] + f * c.word[1], damping = root * root;
        lanes_real kick = lanes_load(columns->zeta + k);
        if (scale > 0) // of the damping, so that the two agree wherever r is
            kick *= scale * root * lanes_sqrt(1 - lanes_min(bound * damping, lanes_all(1)));
        pair_store_directions(friction->direction + place + k,
                              inverse_r * lanes_load(batch->dx + k),
                              inverse_r * lanes_load(batch->dy + k),
                              dim == 3 ? inverse_r * lanes_load(batch->dz + k) : lanes_all(0));
        pair_store_frictions(friction->pair + place + k, damping, kick,
                             lanes_load_int(batch->i + k), lanes_load_int(batch->j + k));
    }
}

INLINE void pair_count(const struct pair_columns *columns, int count,
                       const struct pair_scene *scene, const bool mixed) {
    const struct pair_histogram *histogram = scene->law->histogram;
    uint32_t *counts = scene->counts;
    const REAL low = (REAL)histogram->low, inverse_width = (REAL)(1 / histogram->width);
    const REAL bins = (REAL)histogram->bins;
    const size_t none = pair_histogram_size(histogram) - 1;
    for (int k = 0; k < count; k++) {
        const REAL place = (columns->r[k] - low) * inverse_width;
        const int32_t first = mixed ? columns->kind[k] * scene->mixture.histogram_stride : 0;
        counts[place >= 0 && place < bins ? (size_t)(first + (int32_t)place) : none]++;
    }
}
