// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/normalisation.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "inversion/ornstein_zernike.h"

#include <math.h>
#include <string.h>

/// Where the tail of a potential begins and where its end does, as parts of its range. What a
/// factor makes goes to 0 there as a ramp does, what a soft potential has as a parabola, whose mean
/// over the end is `parabola` times that over the tail.
static const double tail_begin = 2.0 / 3, tail_end = 0.9, parabola = 0.09;

/// Standard deviation of the mean over the end but for a parabola [k_B T]. By their own g(r) it is
/// within 0.005 of water, Lennard-Jones and a Gaussian core; with a factor of 1.002 it becomes 0.03
/// to 0.1.
static const double tail_width = 0.03;

/// Standard deviation of ln(S(0)/S_0). By their own g(r): −0.2 for water, 0.2 to 0.3 for
/// Lennard-Jones liquids, −1.3 for a Gaussian core; attraction makes it as much larger.
static const double compressibility_width = 1;

/// g at which the core ends, for S_0.
static const double core_end = 0.5;

/// Cost of ν = 1 over the least at which it is given up.
static const double evidence = 6;

/// Standard errors that ν must be away from 1, too: a wide minimum says little.
static const double min_errors = 2;

/// What the theory does not know of a factor: of 45 fluids with exact g(r), soft, hard and
/// attractive, the longest-ranged came out at 0.997 and 0.998.
static const double theory_error = 1e-3;

/// A g(r) that ends before so many mean distances of particles has no tail.
static const double min_range = 1.8;

/// The bins of a target are joined until they are no more than this.
enum { MAX_CELLS = 100 };

/// The least cost is looked for so many widths about 1, in so many steps a width, then by halving
/// the interval around it so often; its error in steps a few times finer.
enum { WIDTHS = 4, STEPS = 8, HALVINGS = 12, FINER = 4 };

/// The noise of the target is made so many times, to see what it does to the tail and to S(0).
enum { DRAWS = 8 };

struct work {
    struct ornstein_zernike oz;
    size_t cells;
    double *g, *error, *h; ///< of all beads in the infinite system; g/ν less 1; shape [cells]
    double width;
    double expected; ///< S_0; 0: the liquid has no core to tell
    double compressibility;
    double tail_noise, compressibility_noise; ///< variances of the tail and of ln S(0)
};

static void work_clear(struct work *work) {
    mf_ornstein_zernike_clear(&work->oz);
    mf_memory_free(work->g);
    mf_memory_free(work->error);
    mf_memory_free(work->h);
}

/// Mean over the pairs of all beads of what is given for a bin of each pair type.
static double total(const struct rdf_bins *bins, const struct composition *composition,
                    const double *values, size_t bin) {
    double sum = 0, pairs = 0;
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        const double possible = mf_composition_possible_pairs(composition, pair);
        sum += possible > 0 ? possible * values[(size_t)pair * bins->count + bin] : 0;
        pairs += possible;
    }
    return sum / pairs;
}

/// g and its error in a cell of joined bins. As if the system were infinite: of N particles the
/// tail is 1/N too high, but for the small S(0)/N.
static void fill_cell(struct work *work, size_t cell, const struct rdf_bins *bins, size_t first,
                      size_t last, const struct box *box, const struct composition *composition,
                      const double *g, const double *error) {
    const double infinite = 1 - 1 / (double)mf_composition_particles(composition);
    double sum = 0, squares = 0, volume = 0;
    for (size_t bin = first; bin < last; bin++) {
        const double shell =
            mf_box_shell_volume(box, mf_rdf_bins_edge(bins, bin), mf_rdf_bins_edge(bins, bin + 1));
        const double noise = total(bins, composition, error, bin);
        sum += shell * total(bins, composition, g, bin);
        squares += isfinite(noise) ? pow(shell * noise, 2) : 0;
        volume += shell;
    }
    work->g[cell] = infinite * sum / volume;
    work->error[cell] = sqrt(squares) / volume;
}

/// Cells of the core below the first bin, about as wide as the bins, then the bins joined.
static enum status fill_cells(struct work *work, const struct rdf_bins *bins, const struct box *box,
                              const struct composition *composition, const double *g,
                              const double *error) {
    enum status status = STATUS_OK;
    const size_t join = (bins->count - 1) / MAX_CELLS + 1;
    const size_t core = (size_t)ceil(bins->low / (bins->width * (double)join) - 1e-6);
    work->cells = core + (bins->count - 1) / join + 1;
    const struct composition all = {.types = 1, .count = {mf_composition_particles(composition)}};
    double *edge = NULL;
    NEW_ARRAY(edge, work->cells + 1);
    NEW_ARRAY(work->g, work->cells);
    NEW_ARRAY(work->error, work->cells);
    NEW_ARRAY(work->h, work->cells);
    for (size_t k = 0; k < core; k++)
        edge[k] = bins->low * (double)k / (double)core;
    for (size_t k = core; k < work->cells; k++) {
        const size_t first = (k - core) * join, last = first + join;
        edge[k] = mf_rdf_bins_edge(bins, first);
        fill_cell(work, k, bins, first, last < bins->count ? last : bins->count, box, composition,
                  g, error);
    }
    edge[work->cells] = mf_rdf_bins_range(bins);
    CHECK(mf_ornstein_zernike_init(&work->oz, edge, work->cells, &all, mf_box_volume(box)));
done:
    mf_memory_free(edge);
    return status;
}

/// S(0) of hard spheres whose diameter is where g rises. A core that can be entered tells nothing.
static double expect_compressibility(const struct work *work) {
    size_t k = 0;
    while (k + 1 < work->cells && work->g[k] < core_end)
        k++;
    const double d = work->oz.edge[k];
    const double eta = fmin(0.5, 3.14159265358979323846 / 6 * work->oz.density[0] * d * d * d);
    if (k == 0 || work->g[0] > 0.01)
        return 0;
    return pow(1 - eta, 4) / (pow(1 + 2 * eta, 2) + pow(eta, 3) * (eta - 4));
}

/// Mean of the hypernetted chain's Φ/k_B T = −ln g + h − c beyond a part of the range.
static double mean_beyond(const struct work *work, double part) {
    double sum = 0, count = 0;
    for (size_t k = 0; k < work->cells; k++) {
        if (work->oz.edge[k + 1] <= part * work->oz.edge[work->cells])
            continue;
        sum += -log(work->h[k] + 1) + work->h[k] - work->oz.c[k];
        count += 1;
    }
    return sum / count;
}

/// S(0) of g/ν, and what of the tail of its potential is no parabola.
static enum status solve(struct work *work, double factor, double *tail) {
    for (size_t k = 0; k < work->cells; k++)
        work->h[k] = work->g[k] / factor - 1;
    TRY(mf_ornstein_zernike_solve(&work->oz, work->h, &work->compressibility));
    *tail = mean_beyond(work, tail_end) - parabola * mean_beyond(work, tail_begin);
    return STATUS_OK;
}

/// How unlikely a factor is; infinite where g/ν has no stable liquid.
static enum status find_cost(struct work *work, double factor, double *cost) {
    double tail;
    TRY(solve(work, factor, &tail));
    *cost = INFINITY;
    if (!(work->compressibility > 0) || isnan(tail))
        return STATUS_OK;
    *cost = pow((factor - 1) / work->width, 2) +
            tail * tail / (tail_width * tail_width + work->tail_noise);
    if (work->expected > 0)
        *cost += pow(log(work->compressibility / work->expected), 2) /
                 (compressibility_width * compressibility_width + work->compressibility_noise);
    return STATUS_OK;
}

/// How the noise of the target makes the tail and ln S(0) vary at a factor.
static enum status find_noise(struct work *work, double factor) {
    enum status status = STATUS_OK;
    struct running_mean tails = {0}, logarithms = {0};
    double *g = NULL;
    NEW_ARRAY(g, work->cells);
    memcpy(g, work->g, work->cells * sizeof *g);
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        double tail;
        for (size_t k = 0; k < work->cells; k++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(1, RNG_INITIAL, draw, (uint32_t)k, 0), normal);
            work->g[k] = fmax(0, g[k] + work->error[k] * normal[0]);
        }
        CHECK(solve(work, factor, &tail));
        if (!(work->compressibility > 0) || !isfinite(tail))
            continue;
        mf_statistics_add(&tails, tail);
        mf_statistics_add(&logarithms, log(work->compressibility));
    }
    // Where noise alone leaves no liquid, the target tells nothing.
    const bool reported = tails.count > DRAWS / 2;
    work->tail_noise = reported ? tails.squares / (tails.count - 1) : INFINITY;
    work->compressibility_noise = reported ? logarithms.squares / (logarithms.count - 1) : INFINITY;
done:
    if (g)
        memcpy(work->g, g, work->cells * sizeof *g);
    mf_memory_free(g);
    return status;
}

/// The least cost of a grid about 1.
static enum status scan(struct work *work, double *best, double *min) {
    *min = INFINITY;
    for (int n = -WIDTHS * STEPS; n <= WIDTHS * STEPS; n++) {
        const double factor = 1 + n * work->width / STEPS;
        double cost;
        if (!(factor > 0))
            continue;
        TRY(find_cost(work, factor, &cost));
        if (cost < *min) {
            *min = cost;
            *best = factor;
        }
    }
    return STATUS_OK;
}

/// Closer to the least.
static enum status refine(struct work *work, double *best, double *min) {
    double step = work->width / STEPS;
    for (int n = 0; n < HALVINGS; n++) {
        step *= 0.5;
        const double centre = *best;
        for (int sign = -1; sign <= 1; sign += 2) {
            const double factor = centre + sign * step;
            double cost;
            TRY(find_cost(work, factor, &cost));
            if (cost < *min) {
                *min = cost;
                *best = factor;
            }
        }
    }
    return STATUS_OK;
}

/// Standard error of a factor: how far to each side the cost, which is χ², is within 1 of it; the
/// larger of both, since on one there may be no liquid, and never more than the width.
static enum status find_error(struct work *work, double best, double min, double *error) {
    const double step = work->width / (STEPS * FINER);
    *error = step;
    for (int sign = -1; sign <= 1; sign += 2) {
        double cost = min;
        int n = 0;
        while (cost < min + 1 && n < STEPS * FINER)
            TRY(find_cost(work, best + sign * ++n * step, &cost));
        *error = fmax(*error, n * step);
    }
    *error = hypot(*error, theory_error);
    return STATUS_OK;
}

/// Whether 1 is given up, and for what.
static enum status assess(struct work *work, struct normalisation *normalisation) {
    double one, min, best = 1, error;
    TRY(find_cost(work, 1, &one));
    normalisation->compressibility = work->compressibility;
    if (one < evidence)
        return find_error(work, 1, one, &normalisation->error);
    TRY(scan(work, &best, &min));
    if (!isfinite(min))
        return STATUS_OK;
    // Noise is to be seen where the target would be a liquid; with it, once more.
    TRY(find_noise(work, best));
    TRY(find_cost(work, 1, &one));
    TRY(scan(work, &best, &min));
    TRY(refine(work, &best, &min));
    TRY(find_error(work, best, min, &error));
    if (!(one - min > evidence) || !(fabs(best - 1) > min_errors * error))
        return STATUS_OK;
    *normalisation = (struct normalisation){.factor = best, .error = error, .found = true};
    TRY(find_cost(work, best, &min));
    normalisation->compressibility = work->compressibility;
    return STATUS_OK;
}

enum status mf_normalisation_find(const struct rdf_bins *bins, const struct box *box,
                                  const struct composition *composition, const double *g,
                                  const double *error, double width,
                                  struct normalisation *normalisation) {
    enum status status = STATUS_OK;
    struct work work = {.width = width};
    *normalisation = (struct normalisation){.factor = 1, .error = width, .compressibility = NAN};
    const double density = (double)mf_composition_particles(composition) / mf_box_volume(box);
    if (box->dimensions != 3 || mf_rdf_bins_range(bins) < min_range / cbrt(density))
        return STATUS_OK;
    CHECK(fill_cells(&work, bins, box, composition, g, error));
    work.expected = expect_compressibility(&work);
    CHECK(assess(&work, normalisation));
done:
    work_clear(&work);
    return status;
}
