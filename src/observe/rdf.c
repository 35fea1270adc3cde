// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/rdf.h"

#include "base/memory.h"
#include "base/statistics.h"

#include <math.h>

double mf_rdf_bins_edge(const struct rdf_bins *bins, size_t k) {
    return bins->low + bins->width * (double)k;
}

double mf_rdf_bins_centre(const struct rdf_bins *bins, size_t k) {
    return bins->low + bins->width * ((double)k + 0.5);
}

double mf_rdf_bins_range(const struct rdf_bins *bins) {
    return mf_rdf_bins_edge(bins, bins->count);
}

double mf_rdf_ideal_pairs(const struct rdf_bins *bins, size_t k, const struct box *box,
                          size_t count) {
    const double pairs = 0.5 * (double)count * ((double)count - 1);
    return pairs *
           mf_box_shell_volume(box, mf_rdf_bins_edge(bins, k), mf_rdf_bins_edge(bins, k + 1)) /
           mf_box_volume(box);
}

double mf_rdf_ideal_pairs_of(const struct rdf_bins *bins, size_t k, const struct box *box,
                             const struct composition *composition, int pair) {
    return mf_composition_possible_pairs(composition, pair) *
           mf_box_shell_volume(box, mf_rdf_bins_edge(bins, k), mf_rdf_bins_edge(bins, k + 1)) /
           mf_box_volume(box);
}

struct counting {
    const struct rdf_bins *bins;
    const struct composition *composition; ///< of a mixture
    double *histogram;
    double weight;                         ///< of a pair
    const struct topology *intermolecular; ///< of which pairs in a molecule are left out, or NULL
};

static void count_batch(void *context, const float *squared_distances, size_t count) {
    const struct counting *counting = context;
    const struct rdf_bins *bins = counting->bins;
    const double inverse_width = 1 / bins->width;
    for (size_t k = 0; k < count; k++) {
        const double place = (sqrt((double)squared_distances[k]) - bins->low) * inverse_width;
        if (place >= 0 && place < (double)bins->count)
            counting->histogram[(size_t)place] += counting->weight;
    }
}

static void count_batch_of(void *context, const struct neighbours_batch *batch) {
    const struct counting *counting = context;
    const struct rdf_bins *bins = counting->bins;
    const double inverse_width = 1 / bins->width;
    for (size_t k = 0; k < batch->count; k++) {
        const double place = (sqrt((double)batch->squared[k]) - bins->low) * inverse_width;
        const int pair =
            mf_composition_pair_of_ids(counting->composition, batch->id_i[k], batch->id_j[k]);
        if (counting->intermolecular && counting->intermolecular->molecule[batch->id_i[k]] ==
                                            counting->intermolecular->molecule[batch->id_j[k]])
            continue;
        if (place >= 0 && place < (double)bins->count)
            counting->histogram[(size_t)pair * bins->count + (size_t)place] += counting->weight;
    }
}

/// By types if they are told apart.
static void count(struct counting *counting, const struct particles *particles,
                  const struct neighbours *neighbours) {
    const double range = mf_rdf_bins_range(counting->bins);
    const bool types = counting->composition && composition_is_mixed(counting->composition);
    if (types || counting->intermolecular)
        mf_neighbours_visit_pairs(neighbours, particles, range, count_batch_of, counting);
    else
        mf_neighbours_visit_distances(neighbours, particles, range, count_batch, counting);
}

void mf_rdf_count_pairs(const struct rdf_bins *bins, const struct composition *composition,
                        const struct particles *particles, const struct neighbours *neighbours,
                        double *histogram) {
    count(&(struct counting){bins, composition, histogram, 1, NULL}, particles, neighbours);
}

enum status mf_rdf_init(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                        size_t particle_count, double list_cutoff, size_t planned) {
    const struct composition composition = mf_composition_of_one((int64_t)particle_count);
    return mf_rdf_init_mixture(rdf, bins, box, &composition, list_cutoff, planned);
}

/// Room for `planned` samples, 0: as many as there will be.
static enum status begin(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                         const struct composition *composition, size_t planned) {
    *rdf = (struct rdf){.bins = *bins,
                        .box = *box,
                        .particle_count = (size_t)mf_composition_particles(composition),
                        .composition = *composition,
                        .pairs = (size_t)mf_composition_pairs(composition),
                        .weight = 1};
    return mf_sample_blocks_init(&rdf->blocks, planned, rdf->pairs * bins->count);
}

/// The range is beyond that of the simulation's list.
static enum status begin_own_list(struct rdf *rdf) {
    const struct box *const box = &rdf->box;
    if (mf_box_shortest(box) < 2 * mf_rdf_bins_range(&rdf->bins))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "the box is too small for the RDF: its shortest edge %g" STATUS_LENGTH " is below "
            "twice the range %g" STATUS_LENGTH "; a larger box with more particles, or a "
            "shorter \"range\" of \"rdf\", would do",
            mf_box_shortest(box), mf_rdf_bins_range(&rdf->bins));
    TRY(mf_particles_init(&rdf->own_particles, box, rdf->particle_count));
    return mf_neighbours_init(&rdf->manifest, NEIGHBOURS_HALF, box, rdf->particle_count,
                              mf_rdf_bins_range(&rdf->bins), 0);
}

enum status mf_rdf_init_mixture(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                                const struct composition *composition, double list_cutoff,
                                size_t planned) {
    enum status status = STATUS_OK;
    CHECK(begin(rdf, bins, box, composition, planned));
    // A part in 10⁹ forgives a range that was rounded in another unit.
    rdf->needs_own_list = mf_rdf_bins_range(bins) > list_cutoff * (1 + 1e-9);
    rdf->counted = (struct pair_histogram){bins->low, bins->width, bins->count, rdf->pairs, NULL};
    NEW_ARRAY(rdf->counted.counts, NEIGHBOURS_MAX_PARTS * pair_histogram_size(&rdf->counted));
    if (rdf->needs_own_list)
        CHECK(begin_own_list(rdf));
done:
    if (status != STATUS_OK)
        mf_rdf_clear(rdf);
    return status;
}

enum status mf_rdf_init_endless(struct rdf *rdf, const struct rdf_bins *bins, const struct box *box,
                                const struct composition *composition) {
    const enum status status = begin(rdf, bins, box, composition, 0);
    if (status != STATUS_OK)
        mf_rdf_clear(rdf);
    return status;
}

void mf_rdf_clear(struct rdf *rdf) {
    mf_sample_blocks_clear(&rdf->blocks);
    mf_memory_free(rdf->counted.counts);
    mf_particles_clear(&rdf->own_particles);
    mf_neighbours_clear(&rdf->manifest);
    *rdf = (struct rdf){0};
}

/// Where the box has changed since the last sample, so have the cells of the list.
static enum status follow_box(struct rdf *rdf, const struct box *box) {
    if (memcmp(rdf->own_particles.box.length, box->length, sizeof box->length) == 0)
        return STATUS_OK;
    rdf->own_particles.box = *box;
    mf_neighbours_clear(&rdf->manifest);
    return mf_neighbours_init(&rdf->manifest, NEIGHBOURS_HALF, box, rdf->particle_count,
                              mf_rdf_bins_range(&rdf->bins), 0);
}

/// Bins of all pair types.
static size_t all_bins(const struct rdf *rdf) {
    return rdf->pairs * rdf->bins.count;
}

/// A sorted copy of the particles with a list of the bins' range.
static enum status make_own_list(struct rdf *rdf, const struct particles *particles) {
    TRY(follow_box(rdf, &particles->box));
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(rdf->own_particles.position[d], particles->position[d],
               particles->count * sizeof *particles->position[d]);
    memcpy(rdf->own_particles.id, particles->id, particles->count * sizeof *particles->id);
    TRY(mf_particles_join(&rdf->own_particles, particles->topology));
    return mf_neighbours_sort_and_build(&rdf->manifest, &rdf->own_particles);
}

void mf_rdf_set_volume(struct rdf *rdf, double volume) {
    rdf->weight = volume / mf_box_volume(&rdf->box);
}

const struct pair_histogram *mf_rdf_histogram(struct rdf *rdf) {
    if (rdf->needs_own_list || rdf->intermolecular)
        return NULL;
    memset(rdf->counted.counts, 0,
           NEIGHBOURS_MAX_PARTS * pair_histogram_size(&rdf->counted) * sizeof *rdf->counted.counts);
    return &rdf->counted;
}

void mf_rdf_sample_counted(struct rdf *rdf) {
    double *histogram = mf_sample_blocks_next(&rdf->blocks);
    for (size_t part = 0; part < NEIGHBOURS_MAX_PARTS; part++)
        for (size_t k = 0; k < all_bins(rdf); k++)
            histogram[k] +=
                rdf->weight * rdf->counted.counts[part * pair_histogram_size(&rdf->counted) + k];
}

enum status mf_rdf_sample(struct rdf *rdf, const struct particles *particles,
                          const struct neighbours *neighbours) {
    double *histogram = mf_sample_blocks_next(&rdf->blocks);
    if (rdf->needs_own_list) {
        TRY(make_own_list(rdf, particles));
        particles = &rdf->own_particles;
        neighbours = &rdf->manifest;
    }
    count(&(struct counting){&rdf->bins, &rdf->composition, histogram, rdf->weight,
                             rdf->intermolecular},
          particles, neighbours);
    return STATUS_OK;
}

void mf_rdf_add(struct rdf *rdf, const struct configuration *configuration) {
    const struct configuration_counts *const counts = configuration->counts;
    const uint64_t *const pairs = rdf->intermolecular ? counts->apart : counts->all;
    const double volume = configuration->box.volume / mf_box_volume(&rdf->box);
    const size_t bins = rdf->bins.count;
    double *histogram = mf_sample_blocks_next(&rdf->blocks);
    for (size_t pair = 0; pair < rdf->pairs; pair++) {
        const double weight = volume / counts->share[pair];
        for (size_t k = 0; k < bins; k++)
            histogram[pair * bins + k] += weight * (double)pairs[pair * counts->stride + k];
    }
}

/// Expected pairs in place k of an array over kinds and bins.
static double ideal_at(const struct rdf *rdf, size_t k) {
    return mf_rdf_ideal_pairs_of(&rdf->bins, k % rdf->bins.count, &rdf->box, &rdf->composition,
                                 (int)(k / rdf->bins.count));
}

/// Whole blocks of the replica that has fewest.
static size_t whole_blocks(const struct rdf *replicas, size_t count) {
    size_t min = SIZE_MAX;
    for (size_t r = 0; r < count; r++) {
        const size_t whole = mf_sample_blocks_whole(&replicas[r].blocks);
        min = whole < min ? whole : min;
    }
    return min;
}

/// g of every block, shape [pairs, bins, count, blocks]. Fails: NO_MEMORY.
static enum status find_series(const struct rdf *replicas, size_t count, size_t blocks,
                               double **series) {
    const size_t all = all_bins(replicas);
    TRY_ARRAY(*series, all * count * blocks + 1);
    for (size_t k = 0; k < all; k++) {
        const double ideal = ideal_at(replicas, k);
        for (size_t r = 0; r < count; r++)
            for (size_t b = 0; b < blocks && ideal > 0; b++)
                (*series)[(k * count + r) * blocks + b] =
                    replicas[r].blocks.sums[b * all + k] / replicas[r].blocks.samples[b] / ideal;
    }
    return STATUS_OK;
}

static enum status find_errors(const struct rdf *replicas, size_t count, double *error) {
    const size_t bins = replicas->bins.count, blocks = whole_blocks(replicas, count);
    const size_t values = count * blocks;
    OWNED double *series = NULL;
    TRY(find_series(replicas, count, blocks, &series));
    for (size_t pair = 0; pair < replicas->pairs; pair++)
        mf_statistics_correlated_errors(series + pair * bins * values, blocks, count, bins,
                                        error + pair * bins);
    return STATUS_OK;
}

enum status mf_rdf_result(const struct rdf *replicas, size_t count, double *g, double *error) {
    const size_t all = all_bins(replicas);
    for (size_t k = 0; k < all; k++) {
        double pairs = 0, samples = 0;
        for (size_t r = 0; r < count; r++)
            for (size_t b = 0; b < replicas[r].blocks.count; b++) {
                pairs += replicas[r].blocks.sums[b * all + k];
                samples += replicas[r].blocks.samples[b];
            }
        g[k] = samples > 0 ? pairs / samples / ideal_at(replicas, k) : 0;
    }
    return error ? find_errors(replicas, count, error) : STATUS_OK;
}

enum status mf_rdf_independence(const struct rdf *replicas, size_t count, size_t first, size_t bins,
                                struct statistics_independence *found) {
    const size_t blocks = whole_blocks(replicas, count);
    OWNED double *series = NULL;
    TRY(find_series(replicas, count, blocks, &series));
    return mf_statistics_independence(series + first * count * blocks, blocks, count, bins, found);
}

double mf_rdf_rmse(const double *g, const double *target, size_t count) {
    double sum = 0, known = 0;
    for (size_t k = 0; k < count; k++) {
        const double difference = g[k] - target[k];
        sum += isnan(difference) ? 0 : difference * difference;
        known += !isnan(difference);
    }
    return sqrt(sum / known);
}

/// Standard error of the rms if blocks were independent: by leaving out each in turn.
static double jackknife(const struct rdf *replicas, size_t count, const double *g,
                        const double *target, double *without) {
    const size_t all = all_bins(replicas);
    struct running_mean rms = {0};
    double samples = 0;
    for (size_t r = 0; r < count; r++)
        samples += (double)replicas[r].blocks.taken;
    for (size_t r = 0; r < count; r++)
        for (size_t b = 0; b < replicas[r].blocks.count; b++) {
            const double here = replicas[r].blocks.samples[b];
            if (here == 0 || samples == here)
                continue;
            for (size_t k = 0; k < all; k++)
                without[k] = (g[k] * samples -
                              replicas[r].blocks.sums[b * all + k] / ideal_at(replicas, k)) /
                             (samples - here);
            mf_statistics_add(&rms, mf_rdf_rmse(without, target, all));
        }
    return rms.count < 2 ? 0 : sqrt(rms.squares * (rms.count - 1) / rms.count);
}

enum status mf_rdf_distance(const struct rdf *replicas, size_t count, const double *target,
                            double *rmse, double *error) {
    enum status status = STATUS_OK;
    const size_t all = all_bins(replicas), blocks = whole_blocks(replicas, count);
    const double values = (double)(count * blocks);
    double *g = NULL, *without = NULL, *series = NULL;
    NEW_ARRAY(g, all);
    NEW_ARRAY(without, all);
    CHECK(mf_rdf_result(replicas, count, g, NULL));
    *rmse = mf_rdf_rmse(g, target, all);
    if (error == NULL)
        goto done;
    CHECK(find_series(replicas, count, blocks, &series));
    // The jackknife of independent values has n/(n − 1) already.
    *error = jackknife(replicas, count, g, target, without) *
             sqrt(mf_statistics_inefficiency(series, blocks, count, all) * fmax(values - 1, 0) /
                  fmax(values, 1));
done:
    mf_memory_free(g);
    mf_memory_free(without);
    mf_memory_free(series);
    return status;
}
