// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/normalisation.h"

#include "base/memory.h"
#include "inverse/ornstein_zernike.h"

#include <math.h>

/// Where the tail of a potential begins, as a part of its range, and the standard deviation of its
/// mean there [k_B T]. By their own g(r) the tails of water and of Lennard-Jones liquids are within
/// 0.03; with a factor of 1.002 they become 0.15 to 0.6.
static const double tail_begin = 2.0 / 3, tail_width = 0.15;

/// Standard deviation of ln(S(0)/S_0). By their own g(r): −0.2 for water, 0.2 to 0.3 for
/// Lennard-Jones liquids, −1.3 for a Gaussian core; attraction makes it as much larger.
static const double compressibility_width = 1;

/// g at which the core ends, for S_0.
static const double core_end = 0.5;

/// Cost of ν = 1 over the least at which it is given up.
static const double evidence = 6;

/// Standard errors that ν must be away from 1, too: a wide minimum says little.
static const double least_errors = 2;

/// A g(r) that ends before so many mean distances of particles has no tail.
static const double least_range = 1.8;

/// The bins of a target are joined until they are no more than this.
enum { MOST_CELLS = 100 };

/// The least cost is looked for so many widths about 1, in so many steps a width, then by halving
/// the interval around it so often.
enum { WIDTHS = 4, STEPS = 8, HALVINGS = 12 };

struct work {
    struct ornstein_zernike oz;
    size_t cells;
    double *g, *h; ///< of all beads in the infinite system, and of g/ν less 1; shape [cells]
    double width;
    double expected; ///< S_0; 0: the liquid has no core to tell
    double compressibility;
};

static void work_clear(struct work *work) {
    ornstein_zernike_clear(&work->oz);
    memory_free(work->g);
    memory_free(work->h);
}

/// g of all beads in a bin, as if the system were infinite: of N particles its tail is 1/N too
/// high, but for the small S(0)/N.
static double total_g(const struct rdf_bins *bins, const struct composition *composition,
                      const double *g, size_t bin) {
    const double count = (double)composition_particles(composition);
    double sum = 0, pairs = 0;
    for (int pair = 0; pair < composition_pairs(composition); pair++) {
        const double possible = composition_possible_pairs(composition, pair);
        sum += possible * g[(size_t)pair * bins->count + bin];
        pairs += possible;
    }
    return sum / pairs * (1 - 1 / count);
}

/// Cells of the core below the first bin, about as wide as the bins, then the bins joined.
static enum status fill_cells(struct work *work, const struct rdf_bins *bins, const struct box *box,
                              const struct composition *composition, const double *g) {
    enum status status = STATUS_OK;
    const size_t join = (bins->count - 1) / MOST_CELLS + 1;
    const size_t core = (size_t)ceil(bins->low / (bins->width * (double)join) - 1e-6);
    work->cells = core + (bins->count - 1) / join + 1;
    const double density = (double)composition_particles(composition) / box_volume(box);
    double *edge = NULL;
    NEW_ARRAY(edge, work->cells + 1);
    NEW_ARRAY(work->g, work->cells);
    NEW_ARRAY(work->h, work->cells);
    for (size_t k = 0; k < core; k++)
        edge[k] = bins->low * (double)k / (double)core;
    for (size_t k = core; k < work->cells; k++) {
        const size_t first = (k - core) * join;
        double sum = 0, volume = 0;
        edge[k] = rdf_bins_edge(bins, first);
        for (size_t bin = first; bin < first + join && bin < bins->count; bin++) {
            const double shell =
                box_shell_volume(box, rdf_bins_edge(bins, bin), rdf_bins_edge(bins, bin + 1));
            sum += shell * total_g(bins, composition, g, bin);
            volume += shell;
        }
        work->g[k] = sum / volume;
    }
    edge[work->cells] = rdf_bins_range(bins);
    CHECK(ornstein_zernike_init(&work->oz, edge, work->cells, density));
done:
    memory_free(edge);
    return status;
}

/// S(0) of hard spheres whose diameter is where g rises. A core that can be entered tells nothing.
static double expect_compressibility(const struct work *work) {
    size_t k = 0;
    while (k + 1 < work->cells && work->g[k] < core_end)
        k++;
    const double d = work->oz.edge[k];
    const double eta = fmin(0.5, 3.14159265358979323846 / 6 * work->oz.density * d * d * d);
    if (k == 0 || work->g[0] > 0.01)
        return 0;
    return pow(1 - eta, 4) / (pow(1 + 2 * eta, 2) + pow(eta, 3) * (eta - 4));
}

/// Mean of the hypernetted chain's Φ/k_B T = −ln g + h − c over the tail.
static double tail_mean(const struct work *work) {
    double sum = 0, count = 0;
    for (size_t k = 0; k < work->cells; k++) {
        if (work->oz.edge[k] < tail_begin * work->oz.edge[work->cells])
            continue;
        sum += -log(work->h[k] + 1) + work->h[k] - work->oz.c[k];
        count += 1;
    }
    return sum / count;
}

/// How unlikely a factor is; infinite where g/ν has no stable liquid.
static enum status find_cost(struct work *work, double factor, double *cost) {
    for (size_t k = 0; k < work->cells; k++)
        work->h[k] = work->g[k] / factor - 1;
    TRY(ornstein_zernike_solve(&work->oz, work->h, &work->compressibility));
    *cost = INFINITY;
    if (!(work->compressibility > 0))
        return STATUS_OK;
    *cost = pow((factor - 1) / work->width, 2) + pow(tail_mean(work) / tail_width, 2);
    if (work->expected > 0)
        *cost += pow(log(work->compressibility / work->expected) / compressibility_width, 2);
    if (isnan(*cost))
        *cost = INFINITY;
    return STATUS_OK;
}

/// The least cost of a grid about 1.
static enum status scan(struct work *work, double *best, double *least) {
    *least = INFINITY;
    for (int n = -WIDTHS * STEPS; n <= WIDTHS * STEPS; n++) {
        const double factor = 1 + n * work->width / STEPS;
        double cost;
        if (!(factor > 0))
            continue;
        TRY(find_cost(work, factor, &cost));
        if (cost < *least) {
            *least = cost;
            *best = factor;
        }
    }
    return STATUS_OK;
}

/// Standard error of a factor of the least cost, which is χ².
static enum status find_error(struct work *work, double best, double least, double *error) {
    const double step = work->width / STEPS / 4;
    double side[2];
    for (int sign = 0; sign < 2; sign++)
        TRY(find_cost(work, best + (sign ? step : -step), &side[sign]));
    const double curvature = (side[0] + side[1] - 2 * least) / (step * step);
    *error = curvature > 0 && isfinite(curvature) ? sqrt(2 / curvature) : step;
    return STATUS_OK;
}

/// Closer to the least.
static enum status refine(struct work *work, double *best, double *least) {
    double step = work->width / STEPS;
    for (int n = 0; n < HALVINGS; n++) {
        step *= 0.5;
        const double centre = *best;
        for (int sign = 0; sign < 2; sign++) {
            const double factor = centre + (sign ? step : -step);
            double cost;
            TRY(find_cost(work, factor, &cost));
            if (cost < *least) {
                *least = cost;
                *best = factor;
            }
        }
    }
    return STATUS_OK;
}

/// Whether 1 is given up, and for what.
static enum status judge(struct work *work, struct normalisation *normalisation) {
    double one, least = INFINITY, best = 1, error = 0;
    TRY(find_cost(work, 1, &one));
    normalisation->compressibility = work->compressibility;
    if (one < evidence)
        return find_error(work, 1, one, &normalisation->error);
    TRY(scan(work, &best, &least));
    if (!isfinite(least))
        return STATUS_OK;
    TRY(refine(work, &best, &least));
    TRY(find_error(work, best, least, &error));
    if (!(one - least > evidence) || !(fabs(best - 1) > least_errors * error))
        return STATUS_OK;
    *normalisation = (struct normalisation){.factor = best, .error = error, .found = true};
    TRY(find_cost(work, best, &least));
    normalisation->compressibility = work->compressibility;
    return STATUS_OK;
}

enum status normalisation_find(const struct rdf_bins *bins, const struct box *box,
                               const struct composition *composition, const double *g, double width,
                               struct normalisation *normalisation) {
    enum status status = STATUS_OK;
    struct work work = {.width = width};
    *normalisation = (struct normalisation){.factor = 1, .error = width, .compressibility = NAN};
    const double density = (double)composition_particles(composition) / box_volume(box);
    if (box->dimensions != 3 || rdf_bins_range(bins) < least_range / cbrt(density))
        return STATUS_OK;
    CHECK(fill_cells(&work, bins, box, composition, g));
    work.expected = expect_compressibility(&work);
    CHECK(judge(&work, normalisation));
done:
    work_clear(&work);
    return status;
}
