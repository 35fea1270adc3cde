// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is looked for and what is known beside it, as tables.
#include "base/memory.h"
#include "curves/sampled.h"
#include "curves/sum.h"
#include "problem/potential_grid.h"

#include <math.h>

/// A known part that is so high keeps all pairs away [k_B T].
static const double too_high = 50;

static enum status tabulate(const struct potential_grid *grid, const double *phi, size_t pair,
                            const struct inverse_law *known, struct table *table) {
    const size_t begin = mf_potential_grid_block(grid, pair);
    const struct curve *beside = inverse_law_curve(known, (int)pair);
    struct curve curve;
    TRY(mf_sampled_create(&curve, grid->r + begin, phi + begin, grid->bins + 1));
    const enum status status =
        beside ? mf_sum_tabulate(table, &curve, beside) : mf_table_init_potential(table, &curve);
    mf_curve_clear(&curve);
    return status;
}

static enum status tabulate_all(const struct potential_grid *grid, const double *phi,
                                const struct inverse_law *known, struct table *table) {
    enum status status = STATUS_OK;
    struct table part[COMPOSITION_MAX_PAIRS] = {{0}};
    if (grid->pairs == 1)
        return tabulate(grid, phi, 0, known, table);
    for (size_t pair = 0; pair < grid->pairs; pair++)
        CHECK(tabulate(grid, phi, pair, known, &part[pair]));
    CHECK(mf_table_stack(table, part, (int)grid->pairs));
done:
    for (size_t pair = 0; pair < grid->pairs; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

enum status mf_potential_grid_table(const struct potential_grid *grid, const double *phi,
                                    struct table *table) {
    return tabulate_all(grid, phi, &grid->beside, table);
}

enum status mf_potential_grid_table_sought(const struct potential_grid *grid, const double *phi,
                                           struct table *table) {
    return tabulate_all(grid, phi, &(struct inverse_law){0}, table);
}

enum status mf_potential_grid_table_pair(const struct potential_grid *grid, const double *phi,
                                         size_t pair, struct table *table) {
    return tabulate(grid, phi, pair, &(struct inverse_law){0}, table);
}

/// Places in a bin at which its mean is taken.
enum { PLACES = 16 };

double mf_potential_grid_known(const struct inverse_problem *problem, size_t pair, size_t bin) {
    const struct curve *known = inverse_law_curve(&problem->known, (int)pair);
    const struct rdf_bins *bins = &problem->targets.bins;
    const double temperature = problem->scene.temperature;
    double phi[PLACES], least = INFINITY, sum = 0, volume = 0;
    if (known == NULL)
        return 0;
    for (int k = 0; k < PLACES; k++) {
        phi[k] =
            mf_sum_shifted(known, mf_rdf_bins_edge(bins, bin) + (k + 0.5) / PLACES * bins->width);
        least = fmin(least, phi[k]);
    }
    for (int k = 0; k < PLACES; k++) {
        const double r = mf_rdf_bins_edge(bins, bin) + (k + 0.5) / PLACES * bins->width;
        const double shell = pow(r, problem->scene.box.dimensions - 1);
        sum += shell * exp((least - phi[k]) / temperature);
        volume += shell;
    }
    return fmin(least - temperature * log(sum / volume), too_high * temperature);
}

/// Whether the known part keeps pairs out of the core by itself.
static bool keeps_away(const struct potential_grid *grid, const struct inverse_problem *problem,
                       size_t pair) {
    const struct curve *known = inverse_law_curve(&problem->known, (int)pair);
    const double *r = grid->r + mf_potential_grid_block(grid, pair);
    const size_t first = grid->empty[pair];
    bool rises = known != NULL;
    for (size_t k = 0; k < first && rises; k++) {
        const double depth = r[first] - r[k];
        const double rise = mf_curve_value(known, r[k]) - mf_curve_value(known, r[first]);
        rises = rise >= 0.5 * problem->core_stiffness * depth * depth;
    }
    return rises;
}

/// The same in all states.
static bool all_keep_away(const struct potential_grid *grid, const struct inverse_problem *problem,
                          size_t pair) {
    bool away = keeps_away(grid, problem, pair);
    for (size_t s = 0; s < problem->states; s++)
        away = away && keeps_away(grid, problem->state[s], pair);
    return away;
}

double mf_potential_grid_stiffness(const struct potential_grid *grid,
                                   const struct inverse_problem *problem, size_t pair) {
    return all_keep_away(grid, problem, pair) ? 0 : problem->core_stiffness;
}

/// Upper bound of g in the bin before a known one: a thousandth of g there, what counts as none,
/// two errors more than what was seen, or the three pairs of which chance shows none in one of
/// twenty measurements.
static double most_before(const struct inverse_problem *problem, size_t bin) {
    static const double errors = 2, unseen = 3, rare = 1e-3;
    const struct target *rdf = &problem->targets.target[TARGET_RDF];
    const struct rdf_bins *bins = &problem->targets.bins;
    const size_t k = bin % bins->count;
    const double g = rdf->value[bin], none = fmax(problem->core_threshold, rare * g);
    if (rdf->error == NULL)
        return fmax(none, rdf->value[bin - 1]);
    const double pair = rdf->error[bin] * rdf->error[bin] / g;
    const double shells = mf_rdf_bins_centre(bins, k) / mf_rdf_bins_centre(bins, k - 1);
    const double seen = rdf->value[bin - 1] + errors * rdf->error[bin - 1];
    return fmax(none, fmax(unseen * pair * shells * shells, seen));
}

/// By how much Φ rises at least from a known bin to the one before, by the mean force of one state.
static double own_rise(const struct inverse_problem *problem, size_t bin) {
    const double g = problem->targets.target[TARGET_RDF].value[bin];
    return g > 0 ? problem->scene.temperature * log(g / most_before(problem, bin)) : 0;
}

double mf_potential_grid_rise(const struct potential_grid *grid,
                              const struct inverse_problem *problem, size_t pair) {
    const size_t first = grid->core[pair], bin = pair * grid->bins + first;
    if (first == 0 || first == grid->bins || all_keep_away(grid, problem, pair))
        return 0;
    double rise = own_rise(problem, bin);
    for (size_t s = 0; s < problem->states; s++)
        rise = fmax(rise, own_rise(problem->state[s], bin));
    rise -= mf_potential_grid_known(problem, pair, first - 1) -
            mf_potential_grid_known(problem, pair, first);
    return fmax(0, rise) / problem->targets.bins.width;
}

enum status mf_potential_grid_check_known(const struct potential_grid *grid,
                                          const struct inverse_problem *problem) {
    const double most = too_high * problem->scene.temperature;
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t bin = grid->known_bin[n] % grid->bins, pair = grid->known_bin[n] / grid->bins;
        char name[COMPOSITION_PAIR_NAME_SIZE];
        if (!grid->well_known[n] || mf_potential_grid_known(problem, pair, bin) < most)
            continue;
        mf_composition_pair_name(&problem->scene.composition, (int)pair, name);
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "scene.known%s%s: it is above %g" STATUS_ENERGY " at r = %g" STATUS_LENGTH
            ", where the target has pairs, g = %.3g: nothing smooth beside it "
            "makes them; look at its length and its unit of energy",
            name[0] ? "." : "", name, most, mf_rdf_bins_centre(&problem->targets.bins, bin),
            problem->targets.target[TARGET_RDF].value[grid->known_bin[n]]);
    }
    return STATUS_OK;
}

// What an energy of local densities and the potential of pairs share ------------------------------

/// The group of local densities whose slope pairs have, or NULL.
static const struct potential_group *find_density(const struct potential_grid *grid,
                                                  size_t *first) {
    *first = grid->pairs_known;
    for (size_t g = 0; g < grid->groups; *first += grid->group[g++].own.known)
        if (grid->group[g].own.is_level)
            return &grid->group[g];
    return NULL;
}

/// ⟨ρ⟩ and its variance by the target.
static void find_moments(const struct bonded_grid *own, const double *rho, double *mean,
                         double *variance) {
    const double sum = mf_bonded_grid_mean(own) * (double)own->known;
    *mean = *variance = 0;
    for (size_t a = 0; a < own->known; a++)
        *mean += own->target[own->first + a] / sum * rho[a];
    for (size_t a = 0; a < own->known; a++)
        *variance += own->target[own->first + a] / sum * pow(rho[a] - *mean, 2);
}

enum status mf_potential_grid_find_shared(struct potential_grid *grid,
                                          const struct inverse_problem *problem) {
    size_t first;
    const struct potential_group *group = find_density(grid, &first);
    if (group == NULL)
        return STATUS_OK;
    const struct bonded_grid *own = &group->own;
    const struct simulation_setup *scene = &problem->scene;
    const struct many_body *many_body = mf_many_body_find(scene->interaction, scene->interactions);
    const double sum = mf_bonded_grid_mean(own) * (double)own->known;
    const double *rho = grid->r + group->point + own->below; // of the known bins
    double mean, variance;
    TRY_ARRAY(grid->shared.change, grid->known);
    TRY_ARRAY(grid->shared.weight, grid->known);
    find_moments(own, rho, &mean, &variance);
    for (size_t a = 0; a < grid->pairs_known; a++) {
        double w;
        mf_weight_evaluate(&many_body->term[own->unknown->group].weight,
                           grid->r[grid->known_point[a]], &w, NULL);
        grid->shared.change[a] = -2 * w;
    }
    for (size_t a = 0; a < own->known; a++) {
        const double off = rho[a] - mean;
        grid->shared.change[first + a] = off;
        grid->shared.weight[first + a] = own->target[own->first + a] / sum * off / variance;
    }
    return STATUS_OK;
}

void mf_potential_grid_remove_shared(const struct potential_grid *grid, double *phi) {
    double part = 0;
    if (grid->shared.change == NULL)
        return;
    for (size_t a = 0; a < grid->known; a++)
        part += grid->shared.weight[a] * phi[grid->known_point[a]];
    for (size_t a = 0; a < grid->known; a++)
        phi[grid->known_point[a]] -= part * grid->shared.change[a];
}
