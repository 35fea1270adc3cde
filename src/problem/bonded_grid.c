// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tested: test_bonded_grid.
#include "problem/bonded_grid.h"

#include "base/memory.h"
#include "curves/bonded_table.h"
#include "problem/group_kind.h"

#include <gsl/gsl_spline.h>
#include <math.h>
#include <string.h>

enum { FEWEST_BINS = BONDED_GRID_FEWEST_BINS };

/// The slope at an end is that of the chord to where U is this much lower [k_B T], that noise may
/// not turn it, and at least so much over the known range.
static const double chord = 2, min_rise = 10;

static bool is_periodic(const struct bonded_grid *grid) {
    return mf_group_kind_is_periodic(grid->unknown->order);
}

static double largest_of(const struct bonded_grid *grid, const double *target) {
    double largest = 0;
    for (size_t k = 0; k < grid->unknown->bins.count; k++)
        largest = fmax(largest, target[k]);
    return largest;
}

/// Whether q can be the centre of a bin.
static bool is_possible(const struct bonded_grid *grid, double q) {
    return mf_group_kind_is_possible(grid->unknown->order, q);
}

/// The bins first … end − 1 from the first to the last that a target has seen.
static void find_seen(const struct bonded_grid *grid, const double *target, size_t *first,
                      size_t *end) {
    const struct bonded_bins *bins = &grid->unknown->bins;
    const double seen = mf_bonded_distribution_seen * largest_of(grid, target);
    *first = 0;
    *end = bins->count;
    if (is_periodic(grid))
        return;
    while (*first < *end &&
           (target[*first] <= seen || !is_possible(grid, bonded_bins_centre(bins, *first))))
        ++*first;
    while (*end > *first &&
           (target[*end - 1] <= seen || !is_possible(grid, bonded_bins_centre(bins, *end - 1))))
        --*end;
}

/// p of the same group in one of the states.
static const double *target_of(const struct bonded_grid *grid,
                               const struct inverse_problem *problem, size_t state) {
    const struct inverse_problem *other = problem->state[state];
    const ptrdiff_t g = grid->unknown - problem->group;
    return other->targets.target[mf_group_kind_target(grid->unknown->order)].value +
           other->group[g].first;
}

/// The bins that one of the states has seen.
static void find_known(struct bonded_grid *grid, const struct inverse_problem *problem) {
    size_t first, end;
    find_seen(grid, grid->target, &first, &end);
    grid->seen_first = first;
    grid->seen = end - first;
    for (size_t s = 0; s < problem->states; s++) {
        size_t own_first, own_end;
        find_seen(grid, target_of(grid, problem, s), &own_first, &own_end);
        first = own_first < first ? own_first : first;
        end = own_end > end ? own_end : end;
    }
    grid->first = first;
    grid->known = end - first;
}

/// Half of the known range on both sides, as far as q can be.
static void find_margins(struct bonded_grid *grid) {
    const struct bonded_bins *bins = &grid->unknown->bins;
    const size_t max = grid->known / 2 + FEWEST_BINS;
    size_t above = 0;
    if (is_periodic(grid)) {
        grid->points = grid->known + 1;
        return;
    }
    const double low = bonded_bins_centre(bins, grid->first);
    const double high = bonded_bins_centre(bins, grid->first + grid->known - 1);
    while (grid->below < max && is_possible(grid, low - (double)(grid->below + 1) * bins->width))
        grid->below++;
    while (above < max && is_possible(grid, high + (double)(above + 1) * bins->width))
        above++;
    grid->points = grid->below + grid->known + above;
}

/// Whether the potentials of all pair types are looked for: one that the scene gives takes no part
/// of the slope of f, which is then known by it.
static bool finds_all_pairs(const struct inverse_problem *problem) {
    const struct composition *const composition = &problem->scene.composition;
    bool all = problem->unknown[UNKNOWN_POTENTIAL].wanted;
    for (int pair = 0; all && pair < mf_composition_pairs(composition); pair++)
        all = mf_targets_have_pair(&problem->targets, (size_t)pair) ||
              !mf_composition_has_pairs(composition, pair);
    return all;
}

enum status mf_bonded_grid_init(struct bonded_grid *grid, const struct inverse_problem *problem,
                                const struct bonded_unknown *unknown) {
    const char *kind = mf_group_kind_name(unknown->order),
               *name = mf_group_kind_group(&problem->scene, unknown);
    *grid = (struct bonded_grid){
        .unknown = unknown,
        .target =
            problem->targets.target[mf_group_kind_target(unknown->order)].value + unknown->first,
        .temperature = problem->scene.temperature,
        .dimensions = problem->scene.box.dimensions,
        .is_level = unknown->order == INVERSE_LOCAL_DENSITY && finds_all_pairs(problem)};
    find_known(grid, problem);
    find_margins(grid);
    if (is_periodic(grid) &&
        fabs(unknown->bins.width * (double)unknown->bins.count - 360) > 0.01 * unknown->bins.width)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the target of the %s \"%s\" has bins over %g degrees, not 360", kind,
                              name, unknown->bins.width * (double)unknown->bins.count);
    if (grid->known < FEWEST_BINS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the target of the %s \"%s\" has only %zu bin%s with a p above %g of "
                              "its peak: narrower bins are needed, or a law in \"scene.%s\"",
                              kind, name, grid->known, grid->known == 1 ? "" : "s",
                              mf_bonded_distribution_seen, mf_group_kind_file(unknown->order));
    return STATUS_OK;
}

double mf_bonded_grid_place(const struct bonded_grid *grid, size_t point) {
    const double beyond = (double)point - (double)grid->below;
    return bonded_bins_centre(&grid->unknown->bins, grid->first) +
           beyond * grid->unknown->bins.width;
}

bool mf_bonded_grid_is_above(const struct bonded_grid *grid, const struct inverse_problem *problem,
                             size_t bin, double part) {
    bool above = grid->target[bin] > part * largest_of(grid, grid->target);
    for (size_t s = 0; s < problem->states; s++) {
        const double *target = target_of(grid, problem, s);
        above = above || target[bin] > part * largest_of(grid, target);
    }
    return above;
}

/// Mean of a spline from one q to another: either may be beyond the ends of a circle, and where the
/// points of another curve end, so does the mean.
static double mean_between(const gsl_spline *spline, double low, double high) {
    const double first = spline->x[0], last = spline->x[spline->size - 1];
    const double from = fmax(low, first), to = fmin(high, last), round = last - first;
    double sum = gsl_spline_eval_integ(spline, from, to, NULL);
    if (spline->interp->type != gsl_interp_cspline_periodic)
        return sum / (to - from);
    if (low < first)
        sum += gsl_spline_eval_integ(spline, low + round, last, NULL);
    if (high > last)
        sum += gsl_spline_eval_integ(spline, first, high - round, NULL);
    return sum / (high - low);
}

enum status mf_bonded_grid_means(const struct bonded_grid *grid, double *means) {
    enum status status = STATUS_OK;
    const double half = 0.5 * grid->unknown->bins.width;
    double *q = NULL, *unit = NULL;
    gsl_spline *spline = gsl_spline_alloc(
        is_periodic(grid) ? gsl_interp_cspline_periodic : gsl_interp_cspline, grid->points);
    CHECK(spline ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(q, grid->points);
    NEW_ARRAY(unit, grid->points);
    for (size_t k = 0; k < grid->points; k++)
        q[k] = mf_bonded_grid_place(grid, k);
    for (size_t b = 0; b < grid->known; b++) {
        for (size_t k = 0; k < grid->points; k++)
            unit[k] = k == grid->below + b;
        if (is_periodic(grid))
            unit[grid->known] = unit[0];
        gsl_spline_init(spline, q, unit, grid->points);
        for (size_t a = 0; a < grid->known; a++) {
            const double centre = q[grid->below + a];
            means[a * grid->known + b] = mean_between(spline, centre - half, centre + half);
        }
    }
done:
    mf_memory_free(q);
    mf_memory_free(unit);
    gsl_spline_free(spline);
    return status;
}

double mf_bonded_grid_mean(const struct bonded_grid *grid) {
    double sum = 0;
    for (size_t k = 0; k < grid->known; k++)
        sum += grid->target[grid->first + k];
    return sum / (double)grid->known;
}

/// The same points, of which those are known that this target has seen.
static struct bonded_grid seen_by_itself(const struct bonded_grid *grid) {
    struct bonded_grid own = *grid;
    own.first = grid->seen_first;
    own.known = grid->seen;
    own.below = grid->below + (grid->seen_first - grid->first);
    return own;
}

void mf_bonded_grid_level(const struct bonded_grid *grid, double *energy) {
    double min = INFINITY, *known = energy + grid->below;
    for (size_t k = 0; k < grid->known; k++)
        min = fmin(min, known[k]);
    for (size_t k = 0; k < grid->known; k++)
        known[k] -= min;
}

void mf_bonded_grid_start(const struct bonded_grid *grid, double *energy) {
    const struct bonded_unknown *unknown = grid->unknown;
    // What was not seen is as high as what is hardly seen.
    const double seen = mf_bonded_distribution_seen * largest_of(grid, grid->target);
    const struct bonded_grid own = seen_by_itself(grid);
    double *known = energy + own.below;
    if (unknown->order == INVERSE_LOCAL_DENSITY) { // most of p is what pairs make of it
        memset(energy, 0, grid->points * sizeof *energy);
        return;
    }
    for (size_t k = 0; k < own.known; k++) {
        const size_t bin = own.first + k;
        const double p = fmax(grid->target[bin], seen);
        known[k] =
            -grid->temperature *
            log(p / mf_group_kind_jacobian(unknown->order, grid->dimensions, &unknown->bins, bin));
    }
    mf_bonded_grid_level(&own, energy);
    mf_bonded_grid_complete(&own, energy);
}

/// Go on with `count` values beyond an end, by steps of `direction`, 1 or −1, through the array.
static void extend(const struct bonded_grid *grid, double *end, ptrdiff_t direction, size_t count,
                   bool at_bound) {
    const size_t last = grid->known - 1;
    size_t lower = 1, lowest = 1;
    while (lower < last && end[0] - end[-direction * (ptrdiff_t)lower] < chord * grid->temperature)
        lower++;
    for (size_t k = 1; k <= last; k++)
        if (end[-direction * (ptrdiff_t)k] < end[-direction * (ptrdiff_t)lowest])
            lowest = k;
    double slope = (end[0] - end[-direction * (ptrdiff_t)lower]) / (double)lower, bend = 0;
    if (!at_bound) {
        slope = fmax(slope, min_rise * grid->temperature / (double)grid->known);
        bend = slope / (double)lowest;
    }
    for (size_t k = 1; k <= count; k++)
        end[direction * (ptrdiff_t)k] = end[0] + (double)k * (slope + 0.5 * bend * (double)k);
}

void mf_bonded_grid_complete(const struct bonded_grid *grid, double *energy) {
    const size_t above = grid->points - grid->below - grid->known;
    if (is_periodic(grid)) {
        energy[grid->known] = energy[0];
        return;
    }
    // An angle that can go no further is not held back.
    extend(grid, energy + grid->below, -1, grid->below, grid->below < FEWEST_BINS);
    extend(grid, energy + grid->below + grid->known - 1, 1, above, above < FEWEST_BINS);
}

/// Where the points are.
static void find_places(const struct bonded_grid *grid, double *q) {
    for (size_t k = 0; k < grid->points; k++)
        q[k] = mf_bonded_grid_place(grid, k);
}

enum status mf_bonded_grid_curve(const struct bonded_grid *grid, const double *energy,
                                 struct bonded_curve *curve) {
    OWNED double *q = NULL;
    TRY_ARRAY(q, grid->points);
    find_places(grid, q);
    TRY(mf_bonded_create(curve, mf_bonded_kinds[grid->unknown->order]->table));
    return mf_bonded_table_set_points(curve, q, energy, grid->points);
}

enum status mf_bonded_grid_density(const struct bonded_grid *grid, const double *energy,
                                   struct density_energy *density) {
    OWNED double *rho = NULL;
    CLEARED_BY(mf_curve_clear) struct curve curve = {0};
    TRY_ARRAY(rho, grid->points);
    find_places(grid, rho);
    TRY(mf_curve_create(&curve, &mf_density_energy_table));
    TRY(mf_density_energy_set_points(&curve, rho, energy, grid->points));
    return mf_density_energy_init(density, &curve);
}
