// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/rdf_force.h"

#include "base/simd.h"
#include "base/statistics.h"

#include <math.h>

/// Blocks for the standard error, as of the histogram.
enum { BLOCKS = 20 };

/// Entries of the list looked at together.
enum { PIECE = 64 };

/// Bins on either side whose covariances are pooled for the weight of one. From 15 samples a weight
/// is so uncertain that a tenth of the gain is lost; neighbours have nearly the same.
enum { POOLED = 2 };

const char *const mf_rdf_force_estimators[] = {"histogram", "force", NULL};

static const double min_barrier = 10; // [k_B T]

bool mf_rdf_force_applies(const struct table *potential, double temperature) {
    double barrier = 0;
    if (potential)
        mf_table_evaluate(potential, 0, &barrier, NULL, NULL);
    return barrier >= min_barrier * temperature;
}

enum status mf_rdf_force_init(struct rdf_force *force, const struct rdf_bins *bins,
                              const struct box *box, size_t particle_count,
                              const struct table *potential, double temperature, double list_cutoff,
                              size_t planned) {
    enum status status = STATUS_OK;
    const double range = mf_rdf_bins_range(bins);
    *force = (struct rdf_force){.bins = *bins,
                                .box = *box,
                                .particle_count = particle_count,
                                .potential = potential,
                                .temperature = temperature,
                                .planned = planned,
                                .blocks = planned < BLOCKS ? planned : BLOCKS,
                                .needs_own_list = range > list_cutoff * (1 + 1e-9)};
    if (mf_box_shortest(box) < 2 * range)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the box is too small for the RDF: its shortest edge %g" STATUS_LENGTH
                              " is below twice "
                              "the range %g" STATUS_LENGTH,
                              mf_box_shortest(box), range);
    NEW_ARRAY(force->sums, force->blocks * RDF_FORCE_SUMS * bins->count);
    NEW_ARRAY(force->totals, force->blocks);
    NEW_ARRAY(force->pairs, bins->count + 2);
    NEW_ARRAY(force->force, particle_count);
    CHECK(mf_particles_init(&force->own_particles, box, particle_count));
    if (force->needs_own_list)
        CHECK(mf_neighbours_init(&force->manifest, NEIGHBOURS_HALF, box, particle_count,
                                 fmax(range, potential->cutoff), 0));
done:
    if (status != STATUS_OK)
        mf_rdf_force_clear(force);
    return status;
}

void mf_rdf_force_clear(struct rdf_force *force) {
    mf_memory_free(force->sums);
    mf_memory_free(force->totals);
    mf_memory_free(force->pairs);
    mf_memory_free(force->force);
    mf_particles_clear(&force->own_particles);
    mf_neighbours_clear(&force->manifest);
    *force = (struct rdf_force){0};
}

static void swap_forces(struct particles *a, struct particles *b) {
    for (int d = 0; d < BOX_MAX_DIMENSIONS; d++) {
        double *const other = a->force[d];
        a->force[d] = b->force[d];
        b->force[d] = other;
    }
}

/// Forces of the potential alone, in records. Mixed precision, which the noise does not notice.
static void find_forces(struct rdf_force *force, struct particles *particles,
                        const struct neighbours *neighbours) {
    const struct pair_law law = {.potential = force->potential};
    mf_pair_forces(&law, particles, neighbours, 0, PAIR_FORCES, NULL);
    for (int d = 0; d < force->box.dimensions; d++)
        for (size_t i = 0; i < particles->count; i++)
            force->force[i][d] = (float)particles->force[d][i];
}

/// What is computed of a piece of the list, column by column.
struct columns {
    float square[PIECE], virial[PIECE], flux[PIECE];
    int32_t bin[PIECE];
};

/// r² and u r^d = ½ (F_i − F_j)·r_ij of the pairs of particle i.
static inline __attribute__((always_inline)) void
measure_pairs(struct columns *columns, const struct particle_place *place, const float (*force)[4],
              const float scale[3], size_t i, const int32_t *list, int count) {
    const struct particle_place here = place[i];
    const float fx = force[i][0], fy = force[i][1], fz = force[i][2];
    for (int k = 0; k < count; k++) { // unrolled by hand, so that it vectorises: 1.9 times as fast
        const struct particle_place *there = &place[list[k]];
        const float *other = force[list[k]];
        const float dx =
            scale[0] * (float)box_fraction_difference(here.fraction[0], there->fraction[0]);
        const float dy =
            scale[1] * (float)box_fraction_difference(here.fraction[1], there->fraction[1]);
        const float dz =
            scale[2] * (float)box_fraction_difference(here.fraction[2], there->fraction[2]);
        columns->square[k] = dx * dx + dy * dy + dz * dz;
        columns->virial[k] =
            (dx * (fx - other[0]) + dy * (fy - other[1]) + dz * (fz - other[2])) / 2;
    }
}

/// u, and the bin: 0 for pairs below the bins, the last for those beyond and for what fills rows.
static inline __attribute__((always_inline)) void
place_pairs(struct columns *columns, const struct rdf_bins *bins, int dimensions, int count) {
    const float low = (float)bins->low, inverse_width = (float)(1 / bins->width);
    const float beyond = (float)(bins->count + 1);
    for (int k = 0; k < count; k++) {
        const float square = columns->square[k], r = sqrtf(square);
        const float power = dimensions == 3 ? r * square : square;
        columns->flux[k] = power > 0 ? columns->virial[k] / power : 0;
        const float place = (r - low) * inverse_width + 1;
        const float min = place < 0 ? 0 : place; // not fminf, which minds NaN
        columns->bin[k] = (int32_t)(power > 0 && min < beyond ? min : beyond);
    }
}

SIMD_CLONES static void add_pairs(struct rdf_force *force, const struct particles *particles,
                                  const struct neighbours *neighbours) {
    float scale[3];
    struct columns columns;
    for (int d = 0; d < 3; d++)
        scale[d] = d < force->box.dimensions ? (float)(force->box.length[d] * 0x1p-32) : 0;
    memset(force->pairs, 0, (force->bins.count + 2) * sizeof *force->pairs);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t begin = neighbours->start[i]; begin < neighbours->stop[i]; begin += PIECE) {
            const size_t left = neighbours->stop[i] - begin;
            const int count = left < PIECE ? (int)left : PIECE;
            measure_pairs(&columns, particles->kernel_place, (const float(*)[4])force->force, scale,
                          i, neighbours->list + begin, count);
            place_pairs(&columns, &force->bins, force->box.dimensions, count);
            for (int k = 0; k < count; k++) {
                struct rdf_force_bin *bin = &force->pairs[columns.bin[k]];
                bin->pairs += 1;
                bin->flux += (double)columns.flux[k];
                bin->virial += (double)columns.virial[k];
            }
        }
}

/// Fill `pairs` from a sorted copy of the particles with a list of the range.
static enum status add_own_pairs(struct rdf_force *force, const struct particles *particles) {
    struct particles *own = &force->own_particles;
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(own->position[d], particles->position[d],
               particles->count * sizeof *particles->position[d]);
    own->threads = particles->threads;
    TRY(mf_neighbours_sort_and_build(&force->manifest, own));
    find_forces(force, own, &force->manifest);
    add_pairs(force, own, &force->manifest);
    return STATUS_OK;
}

/// Ω I [1/λ^d].
static double solid_density(const struct rdf_force *force) {
    const double count = (double)force->particle_count;
    return force->box.dimensions * mf_box_shell_volume(&force->box, 0, 1) * count * (count - 1) /
           (2 * mf_box_volume(&force->box));
}

/// Add the h, z, L and D of `pairs` and their products to a block.
static void add_sample(const struct rdf_force *force, double *sums,
                       struct rdf_force_totals *totals) {
    const struct rdf_bins *bins = &force->bins;
    const int dimensions = force->box.dimensions;
    const double density = solid_density(force), factor = 1 / (force->temperature * density);
    const double ball = pow(mf_rdf_bins_range(bins), dimensions);
    double pairs = 0, flux = 0, virial = 0;
    for (size_t k = 0; k <= bins->count; k++) {
        pairs += force->pairs[k].pairs;
        flux += force->pairs[k].flux;
        virial += force->pairs[k].virial;
    }
    const double level = dimensions * pairs / (density * ball);
    const double difference = level - factor * (flux - virial / ball);
    *totals = (struct rdf_force_totals){totals->samples + 1, totals->level + level,
                                        totals->difference + difference,
                                        totals->square + difference * difference};
    double below = force->pairs[0].flux;
    for (size_t k = 0; k < bins->count; k++) {
        const struct rdf_force_bin *here = &force->pairs[k + 1];
        const double low = pow(mf_rdf_bins_edge(bins, k), dimensions);
        const double high = pow(mf_rdf_bins_edge(bins, k + 1), dimensions), volume = high - low;
        const double h = dimensions * here->pairs / (density * volume);
        const double z = factor * (below + (high * here->flux - here->virial) / volume);
        const double terms[RDF_FORCE_SUMS] = {[RDF_FORCE_H] = h,
                                              [RDF_FORCE_Z] = z,
                                              [RDF_FORCE_HH] = h * h,
                                              [RDF_FORCE_HZ] = h * z,
                                              [RDF_FORCE_ZZ] = z * z,
                                              [RDF_FORCE_HD] = h * difference,
                                              [RDF_FORCE_ZD] = z * difference};
        for (size_t t = 0; t < RDF_FORCE_SUMS; t++)
            sums[t * bins->count + k] += terms[t];
        below += here->flux;
    }
}

enum status mf_rdf_force_sample(struct rdf_force *force, struct particles *particles,
                                const struct neighbours *neighbours) {
    if (force->needs_own_list) {
        TRY(add_own_pairs(force, particles));
    } else {
        swap_forces(particles, &force->own_particles);
        find_forces(force, particles, neighbours);
        swap_forces(particles, &force->own_particles);
        add_pairs(force, particles, neighbours);
    }
    size_t block = force->samples * force->blocks / force->planned;
    if (block >= force->blocks)
        block = force->blocks - 1;
    add_sample(force, force->sums + block * RDF_FORCE_SUMS * force->bins.count,
               &force->totals[block]);
    force->samples++;
    return STATUS_OK;
}

/// Σ over the blocks of all replicas, or without one of them.
struct pool {
    size_t bins;
    double *sums; ///< shape [RDF_FORCE_SUMS, bins]
    struct rdf_force_totals totals;
};

static void pool_add(struct pool *pool, const struct rdf_force *replica, size_t block,
                     double sign) {
    const size_t stride = RDF_FORCE_SUMS * pool->bins;
    const struct rdf_force_totals *totals = &replica->totals[block];
    for (size_t n = 0; n < stride; n++)
        pool->sums[n] += sign * replica->sums[block * stride + n];
    pool->totals.samples += sign * totals->samples;
    pool->totals.level += sign * totals->level;
    pool->totals.difference += sign * totals->difference;
    pool->totals.square += sign * totals->square;
}

static double mean(const struct pool *pool, enum rdf_force_sum sum, size_t k) {
    return pool->sums[(size_t)sum * pool->bins + k] / pool->totals.samples;
}

/// Covariances of one bin.
struct covariances {
    double hh, hz, zz, hd, zd, dd;
};

static struct covariances find_covariances(const struct pool *pool, size_t k) {
    const double samples = pool->totals.samples, d = pool->totals.difference / samples;
    const double h = mean(pool, RDF_FORCE_H, k), z = mean(pool, RDF_FORCE_Z, k);
    return (struct covariances){.hh = mean(pool, RDF_FORCE_HH, k) - h * h,
                                .hz = mean(pool, RDF_FORCE_HZ, k) - h * z,
                                .zz = mean(pool, RDF_FORCE_ZZ, k) - z * z,
                                .hd = mean(pool, RDF_FORCE_HD, k) - h * d,
                                .zd = mean(pool, RDF_FORCE_ZD, k) - z * d,
                                .dd = pool->totals.square / samples - d * d};
}

/// −Σ covariance(c, h) / Σ variance(c) over bins around k, with c = s z − h to first order:
/// δc = s δz + (s z/K) δD − δh, since δL is much smaller than δK.
static double histogram_weight(const struct pool *pool, size_t k, double scale, double ball_mean) {
    double variance = 0, covariance = 0;
    const size_t first = k < POOLED ? 0 : k - POOLED;
    for (size_t n = first; n < pool->bins && n <= k + POOLED; n++) {
        const struct covariances c = find_covariances(pool, n);
        const double a = scale, b = scale * mean(pool, RDF_FORCE_Z, n) / ball_mean;
        variance += a * a * c.zz + b * b * c.dd + c.hh + 2 * (a * b * c.zd - a * c.hz - b * c.hd);
        covariance += a * c.hz + b * c.hd - c.hh;
    }
    return variance > 0 ? fmin(fmax(-covariance / variance, 0), 1) : 0;
}

static double estimate(const struct pool *pool, enum rdf_force_version version, size_t k) {
    const double level = pool->totals.level / pool->totals.samples;
    const double difference = pool->totals.difference / pool->totals.samples;
    const double h = mean(pool, RDF_FORCE_H, k), z = mean(pool, RDF_FORCE_Z, k);
    switch (version) {
    case RDF_FORCE_FROM_ZERO:
        return z;
    case RDF_FORCE_FROM_INFINITY:
        return z + difference;
    case RDF_FORCE_COMBINED: {
        const struct covariances c = find_covariances(pool, k);
        return c.dd > 0 ? z - c.zd / c.dd * difference : z;
    }
    case RDF_FORCE_COUNTED:
        break;
    }
    const double ball_mean = level - difference;
    if (!(ball_mean > level / 2)) // no forces, or none that make such a g
        return h;
    const double scale = level / ball_mean;
    return h + histogram_weight(pool, k, scale, ball_mean) * (scale * z - h);
}

/// Blocks with samples, of the replica that has fewest.
static size_t filled_blocks(const struct rdf_force *replicas, size_t count) {
    size_t min = replicas->blocks;
    for (size_t r = 0; r < count; r++)
        for (size_t b = 0; b < min; b++)
            if (replicas[r].totals[b].samples == 0)
                min = b;
    return min;
}

/// Errors by leaving out each block in turn (jackknife), whose correlation the bins show.
static enum status find_errors(const struct rdf_force *replicas, size_t count,
                               enum rdf_force_version version, struct pool *pool, double *error) {
    enum status status = STATUS_OK;
    const size_t blocks = filled_blocks(replicas, count), values = count * blocks;
    double *without = NULL; // shape [bins, count, blocks]
    NEW_ARRAY(without, pool->bins * values + 1);
    for (size_t n = 0; n < values && values > 1; n++) {
        pool_add(pool, &replicas[n / blocks], n % blocks, -1);
        for (size_t k = 0; k < pool->bins; k++)
            without[k * values + n] = estimate(pool, version, k);
        pool_add(pool, &replicas[n / blocks], n % blocks, 1);
    }
    mf_statistics_correlated_errors(without, blocks, count, pool->bins, error);
    for (size_t k = 0; k < pool->bins; k++)
        error[k] *= fmax((double)values - 1, 0);
done:
    mf_memory_free(without);
    return status;
}

enum status mf_rdf_force_result(const struct rdf_force *replicas, size_t count,
                                enum rdf_force_version version, double *g, double *error) {
    enum status status = STATUS_OK;
    struct pool pool = {.bins = replicas->bins.count};
    NEW_ARRAY(pool.sums, RDF_FORCE_SUMS * pool.bins);
    for (size_t r = 0; r < count; r++)
        for (size_t b = 0; b < replicas[r].blocks; b++)
            pool_add(&pool, &replicas[r], b, 1);
    for (size_t k = 0; k < pool.bins; k++)
        g[k] = pool.totals.samples > 0 ? estimate(&pool, version, k) : 0;
    if (error)
        CHECK(find_errors(replicas, count, version, &pool, error));
done:
    mf_memory_free(pool.sums);
    return status;
}

size_t mf_rdf_force_spans(struct rdf_force *force, struct memory_span *spans) {
    spans[0] = (struct memory_span){&force->samples, sizeof force->samples};
    spans[1] = (struct memory_span){force->sums, force->blocks * RDF_FORCE_SUMS *
                                                     force->bins.count * sizeof *force->sums};
    spans[2] = (struct memory_span){force->totals, force->blocks * sizeof *force->totals};
    return RDF_FORCE_SPANS;
}
