// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/potential_grid.h"

#include "base/memory.h"
#include "curves/core.h"
#include "problem/group_kind.h"

#include <math.h>
#include <string.h>

/// g of a bin, of several states the largest: what one of them tells is known.
static double max_pairs(const struct inverse_problem *problem, size_t bin) {
    double max = problem->targets.target[TARGET_RDF].value[bin];
    for (size_t s = 0; s < problem->states; s++)
        max = fmax(max, problem->state[s]->targets.target[TARGET_RDF].value[bin]);
    return max;
}

/// Whether a target knows that there are pairs in a bin. A single pair of a whole measurement does
/// not tell how rare they are: its g is as large as its error.
static bool knows_pairs(const struct inverse_problem *problem, size_t bin) {
    static const double errors = 2;
    const struct target *rdf = &problem->targets.target[TARGET_RDF];
    const double error = rdf->error ? rdf->error[bin] : 0;
    return rdf->value[bin] > fmax(problem->core_threshold, errors * error);
}

/// The same of this problem's target or that of another state.
static bool target_has_pairs(const struct inverse_problem *problem, size_t bin) {
    bool known = knows_pairs(problem, bin);
    for (size_t s = 0; s < problem->states; s++)
        known = known || knows_pairs(problem->state[s], bin);
    return known;
}

/// Where the target is well known.
static const double well = 0.1;

/// Fewer known bins than this are no curve.
enum { MIN_KNOWN = 3 };

/// The core ends where the bins begin that know of pairs, without a gap up to the first that is
/// well known, or to the last one: few pairs nearer than that tell nothing of the bins between.
/// A target that knows of next to none, with errors as large as g, has its first pairs there.
static enum status find_core(struct potential_grid *grid, const struct inverse_problem *problem,
                             size_t pair) {
    const size_t first = pair * grid->bins;
    size_t *core = &grid->core[pair];
    if (!mf_targets_have_pair(&problem->targets, pair)) {
        *core = grid->empty[pair] = grid->bins; // nothing is to be found
        return STATUS_OK;
    }
    while (*core < grid->bins &&
           (max_pairs(problem, first + *core) <= well || !target_has_pairs(problem, first + *core)))
        (*core)++;
    while (*core > 0 && target_has_pairs(problem, first + *core - 1))
        (*core)--;
    if (*core + MIN_KNOWN > grid->bins)
        for (*core = 0;
             *core < grid->bins && max_pairs(problem, first + *core) <= problem->core_threshold;)
            (*core)++;
    size_t *empty = &grid->empty[pair];
    while (*empty < *core && max_pairs(problem, first + *empty) <= problem->core_threshold)
        (*empty)++;
    if (*core + MIN_KNOWN > grid->bins) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&problem->scene.composition, (int)pair, name);
        return mf_status_fail(STATUS_BAD_INPUT, "the target%s%s is nowhere above %g",
                              name[0] ? " of " : "", name, problem->core_threshold);
    }
    grid->known_of[pair] = grid->bins - *core;
    grid->known += grid->known_of[pair];
    return STATUS_OK;
}

/// The first bin in which this problem's own target has pairs.
static size_t first_seen(const struct potential_grid *grid, const struct inverse_problem *problem,
                         size_t pair) {
    size_t k = grid->core[pair];
    while (k < grid->bins && !knows_pairs(problem, pair * grid->bins + k))
        k++;
    return k;
}

/// Where the known bins are.
static void index_known(struct potential_grid *grid, const struct inverse_problem *problem) {
    size_t n = 0;
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        const size_t seen = first_seen(grid, problem, pair);
        for (size_t k = grid->core[pair]; k < grid->bins; k++, n++) {
            grid->known_point[n] = mf_potential_grid_block(grid, pair) + k;
            grid->known_bin[n] = pair * grid->bins + k;
            grid->well_known[n] = max_pairs(problem, grid->known_bin[n]) > well;
            grid->seen[n] = k >= seen;
        }
    }
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *group = &grid->group[g];
        const struct bonded_grid *own = &group->own;
        for (size_t k = 0; k < own->known; k++, n++) {
            const size_t bin = own->first + k;
            grid->known_point[n] = group->point + own->below + k;
            grid->known_bin[n] = group->bin + bin;
            grid->well_known[n] = mf_bonded_grid_is_above(own, problem, bin, well);
            grid->seen[n] = bin >= own->seen_first && bin < own->seen_first + own->seen;
        }
    }
}

/// Blocks of the groups, after those of pairs.
static enum status init_groups(struct potential_grid *grid, const struct inverse_problem *problem) {
    for (size_t g = 0; g < grid->groups; g++) {
        struct potential_group *group = &grid->group[g];
        TRY(mf_bonded_grid_init(&group->own, problem, &problem->group[g]));
        group->point = grid->points;
        group->bin = grid->all_bins;
        grid->points += group->own.points;
        grid->all_bins += group->own.unknown->bins.count;
        grid->known_of[grid->pairs + g] = group->own.known;
        grid->known += group->own.known;
    }
    return STATUS_OK;
}

static void place_points(struct potential_grid *grid, const struct rdf_bins *bins) {
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        double *r = grid->r + mf_potential_grid_block(grid, pair);
        for (size_t k = 0; k < bins->count; k++)
            r[k] = mf_rdf_bins_centre(bins, k);
        r[bins->count] = mf_rdf_bins_range(bins);
    }
    for (size_t g = 0; g < grid->groups; g++)
        for (size_t k = 0; k < grid->group[g].own.points; k++)
            grid->r[grid->group[g].point + k] = mf_bonded_grid_place(&grid->group[g].own, k);
}

enum status mf_potential_grid_init(struct potential_grid *grid,
                                   const struct inverse_problem *problem) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = &problem->targets.bins;
    const bool groups_alone = problem->bonded > 0 && !problem->unknown[UNKNOWN_POTENTIAL].wanted;
    *grid = (struct potential_grid){
        .pairs = groups_alone ? 0 : (size_t)mf_composition_pairs(&problem->scene.composition),
        .bins = bins->count,
        .groups = problem->bonded};
    if (!problem->knows_elsewhere)
        grid->beside = problem->known;
    grid->blocks = grid->pairs + grid->groups;
    grid->points = grid->pair_points = grid->pairs * (bins->count + 1);
    grid->all_bins = grid->pair_bins = grid->pairs * bins->count;
    NEW_ARRAY(grid->core, grid->pairs);
    NEW_ARRAY(grid->empty, grid->pairs);
    NEW_ARRAY(grid->known_of, grid->blocks);
    NEW_ARRAY(grid->stiffness, grid->pairs);
    NEW_ARRAY(grid->rise, grid->pairs);
    NEW_ARRAY(grid->group, grid->groups);
    for (size_t pair = 0; pair < grid->pairs; pair++)
        CHECK(find_core(grid, problem, pair));
    grid->pairs_known = grid->known;
    CHECK(init_groups(grid, problem));
    NEW_ARRAY(grid->known_point, grid->known);
    NEW_ARRAY(grid->known_bin, grid->known);
    NEW_ARRAY(grid->well_known, grid->known);
    NEW_ARRAY(grid->seen, grid->known);
    index_known(grid, problem);
    NEW_ARRAY(grid->r, grid->points);
    place_points(grid, bins);
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        grid->stiffness[pair] = mf_potential_grid_stiffness(grid, problem, pair);
        grid->rise[pair] = mf_potential_grid_rise(grid, problem, pair);
    }
    CHECK(mf_potential_grid_find_shared(grid, problem));
    CHECK(mf_potential_grid_check_known(grid, problem));
done:
    if (status != STATUS_OK)
        mf_potential_grid_clear(grid);
    return status;
}

void mf_potential_grid_clear(struct potential_grid *grid) {
    mf_memory_free(grid->core);
    mf_memory_free(grid->empty);
    mf_memory_free(grid->known_of);
    mf_memory_free(grid->stiffness);
    mf_memory_free(grid->rise);
    mf_memory_free(grid->known_point);
    mf_memory_free(grid->known_bin);
    mf_memory_free(grid->well_known);
    mf_memory_free(grid->seen);
    mf_memory_free(grid->r);
    mf_memory_free(grid->group);
    mf_memory_free(grid->shared.change);
    mf_memory_free(grid->shared.weight);
    *grid = (struct potential_grid){0};
}

bool mf_potential_grid_has_terms(const struct potential_grid *grid) {
    for (size_t g = 0; g < grid->groups; g++)
        if (grid->group[g].own.unknown->order != INVERSE_LOCAL_DENSITY)
            return true;
    return false;
}

size_t mf_potential_grid_block(const struct potential_grid *grid, size_t pair) {
    return pair * (grid->bins + 1);
}

bool mf_potential_grid_in_core(const struct potential_grid *grid, size_t point) {
    return point % (grid->bins + 1) < grid->core[point / (grid->bins + 1)];
}

/// The slope with which Φ goes on into the core: between the first two known bins, or, where some
/// pairs come nearer and these are noisy, to the first bin that is well known.
static double find_slope(const struct potential_grid *grid, size_t pair, const double *r,
                         const double *block) {
    const size_t first = grid->core[pair];
    const bool *well_known = grid->well_known;
    size_t last = first + 1;
    for (size_t before = 0; before < pair; before++)
        well_known += grid->known_of[before];
    while (grid->empty[pair] < first && last + 1 < grid->bins && !well_known[last - first])
        last++;
    return (block[last] - block[first]) / (r[last] - r[first]);
}

void mf_potential_grid_complete_pairs(const struct potential_grid *grid, double *phi) {
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        const size_t begin = mf_potential_grid_block(grid, pair);
        const size_t first = grid->core[pair], empty = grid->empty[pair];
        const double *r = grid->r + begin;
        double *block = phi + begin;
        if (first == grid->bins) { // it is known, or there are no such pairs
            memset(block, 0, (grid->bins + 1) * sizeof *block);
            continue;
        }
        const double slope = fmin(find_slope(grid, pair, r, block), -grid->rise[pair]);
        mf_core_fill(r + empty, block + empty, first - empty, slope, 0);
        mf_core_fill(r, block, empty, slope, grid->stiffness[pair]);
        block[grid->bins] = 0;
    }
}

void mf_potential_grid_complete_groups(const struct potential_grid *grid, double *energy) {
    for (size_t g = 0; g < grid->groups; g++)
        mf_bonded_grid_complete(&grid->group[g].own,
                                energy + (grid->group[g].point - grid->pair_points));
}

void mf_potential_grid_complete(const struct potential_grid *grid, double *phi) {
    mf_potential_grid_remove_shared(grid, phi);
    mf_potential_grid_complete_pairs(grid, phi);
    for (size_t g = 0; g < grid->groups; g++)
        mf_bonded_grid_level(&grid->group[g].own, phi + grid->group[g].point);
    mf_potential_grid_complete_groups(grid, phi + grid->pair_points);
}

void mf_potential_grid_close(const struct potential_grid *grid, size_t group, double *values) {
    const struct potential_group *own = &grid->group[group];
    double *block = values + own->point;
    if (mf_group_kind_is_periodic(own->own.unknown->order))
        block[own->own.known] = block[0];
}

/// The curve of a group that is a term of molecules; NULL of a local density.
static struct bonded_curve *curve_of(const struct potential_grid *grid, size_t g,
                                     struct molecules *molecules) {
    const struct bonded_unknown *unknown = grid->group[g].own.unknown;
    return unknown->order == INVERSE_LOCAL_DENSITY
               ? NULL
               : &molecules->group[unknown->order][unknown->group].curve;
}

enum status mf_potential_grid_molecules(const struct potential_grid *grid, const double *energy,
                                        const struct molecules *from, struct molecules *to) {
    *to = *from;
    for (size_t g = 0; g < grid->groups; g++)
        if (curve_of(grid, g, to))
            *curve_of(grid, g, to) = (struct bonded_curve){0};
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *group = &grid->group[g];
        if (curve_of(grid, g, to))
            TRY(mf_bonded_grid_curve(&group->own, energy + (group->point - grid->pair_points),
                                     curve_of(grid, g, to)));
    }
    return STATUS_OK;
}

void mf_potential_grid_molecules_clear(const struct potential_grid *grid,
                                       struct molecules *molecules) {
    for (size_t g = 0; g < grid->groups; g++)
        if (curve_of(grid, g, molecules))
            mf_bonded_clear(curve_of(grid, g, molecules));
}

/// The energy of a group that is a local density; NULL of others.
static struct density_energy *energy_of(const struct potential_grid *grid, size_t g,
                                        struct many_body *many_body) {
    const struct bonded_unknown *unknown = grid->group[g].own.unknown;
    return unknown->order == INVERSE_LOCAL_DENSITY ? &many_body->term[unknown->group].energy : NULL;
}

enum status mf_potential_grid_many_body(const struct potential_grid *grid, const double *energy,
                                        const struct many_body *from, struct many_body *to) {
    *to = *from;
    for (size_t g = 0; g < grid->groups; g++)
        if (energy_of(grid, g, to))
            *energy_of(grid, g, to) = (struct density_energy){0};
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *group = &grid->group[g];
        if (energy_of(grid, g, to))
            TRY(mf_bonded_grid_density(&group->own, energy + (group->point - grid->pair_points),
                                       energy_of(grid, g, to)));
    }
    return STATUS_OK;
}

void mf_potential_grid_many_body_clear(const struct potential_grid *grid,
                                       struct many_body *many_body) {
    for (size_t g = 0; g < grid->groups; g++)
        if (energy_of(grid, g, many_body))
            mf_density_energy_clear(energy_of(grid, g, many_body));
}

/// −k_B T ln g* in a known bin, less what is known there.
static double mean_force(const struct potential_grid *grid, const struct inverse_problem *problem,
                         size_t n) {
    // A bin without pairs beyond the core is as high as one with the threshold's few.
    const double g = fmax(problem->targets.target[TARGET_RDF].value[grid->known_bin[n]],
                          problem->core_threshold);
    const size_t point = grid->known_point[n];
    return -problem->scene.temperature * log(g) -
           mf_potential_grid_known(problem, point / (grid->bins + 1), point % (grid->bins + 1));
}

void mf_potential_grid_start_pairs(const struct potential_grid *grid,
                                   const struct inverse_problem *problem, double *phi) {
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t point = grid->known_point[n], pair = point / (grid->bins + 1);
        const struct curve *start = problem->unknown[UNKNOWN_POTENTIAL].start[pair];
        phi[point] = start ? mf_curve_value(start, grid->r[point]) : mean_force(grid, problem, n);
    }
    mf_potential_grid_complete_pairs(grid, phi);
}

static void start_groups(const struct potential_grid *grid, double *phi) {
    for (size_t g = 0; g < grid->groups; g++)
        mf_bonded_grid_start(&grid->group[g].own, phi + grid->group[g].point);
}

void mf_potential_grid_start(const struct potential_grid *grid,
                             const struct inverse_problem *problem, double *phi) {
    mf_potential_grid_start_pairs(grid, problem, phi);
    start_groups(grid, phi);
}

void mf_potential_grid_mean_force(const struct potential_grid *grid,
                                  const struct inverse_problem *problem, double *phi) {
    for (size_t n = 0; n < grid->pairs_known; n++)
        phi[grid->known_point[n]] = mean_force(grid, problem, n);
    mf_potential_grid_complete_pairs(grid, phi);
    start_groups(grid, phi);
}

double mf_potential_grid_ramp(const struct potential_grid *grid, size_t point) {
    return point < grid->pair_points ? 1 - grid->r[point] / grid->r[grid->pair_points - 1] : 0;
}

/// Places in a bin at which its mean is taken.
enum { PLACES = 8 };

/// Mean of −r Φ'(r) over the shell of a bin.
static double shell_virial(const struct table *table, const struct rdf_bins *bins, size_t bin,
                           int dimensions) {
    double sum = 0, volume = 0;
    for (int k = 0; k < PLACES; k++) {
        const double r = mf_rdf_bins_edge(bins, bin) + (k + 0.5) / PLACES * bins->width;
        const double shell = pow(r, dimensions - 1);
        double slope;
        mf_table_evaluate(table, r, NULL, &slope, NULL);
        sum -= shell * r * slope;
        volume += shell;
    }
    return sum / volume;
}

/// Add `factor` times the virials of a block's bins by a table that is `change` higher at one
/// point.
static enum status add_virials(const struct potential_grid *grid, const struct rdf_bins *bins,
                               int dimensions, const double *phi, size_t point, double change,
                               double factor, double *changed, double *virial) {
    const size_t pair = point / (grid->bins + 1);
    struct table table;
    for (size_t k = 0; k < grid->points; k++)
        changed[k] = phi[k];
    changed[point] += change;
    mf_potential_grid_complete(grid, changed);
    TRY(mf_potential_grid_table_pair(grid, changed, pair, &table));
    for (size_t a = 0; a < bins->count; a++)
        virial[(pair * bins->count + a) * grid->known] +=
            factor * shell_virial(&table, bins, a, dimensions);
    mf_table_clear(&table);
    return STATUS_OK;
}

enum status mf_potential_grid_virials(const struct potential_grid *grid,
                                      const struct rdf_bins *bins, int dimensions,
                                      const double *phi, double *virial) {
    // The table is linear in its values but for the kink of the core: any small step will do.
    const double change = 1e-3;
    OWNED double *changed = NULL;
    TRY_ARRAY(changed, grid->points);
    for (size_t k = 0; k < grid->pairs * bins->count * grid->known; k++)
        virial[k] = 0;
    for (size_t b = 0; b < grid->pairs_known; b++)
        for (int sign = -1; sign <= 1; sign += 2)
            TRY(add_virials(grid, bins, dimensions, phi, grid->known_point[b], sign * change,
                            sign / (2 * change), changed, virial + b));
    return STATUS_OK;
}
