// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_agreement.h"

#include "base/memory.h"
#include "observe/rdf_observable.h"
#include "problem/group_kind.h"
#include "problem/potential_grid.h"

#include <math.h>

/// The bins first … that a target tells of, those of all blocks from `known` to `end`.
static struct verify_section *add(struct verify_sections *sections,
                                  const struct potential_grid *grid, size_t known, size_t end,
                                  int kind) {
    struct verify_section *const section = &sections->section[sections->count];
    while (known < end && !grid->seen[known])
        known++;
    while (end > known && !grid->seen[end - 1])
        end--;
    if (end == known)
        return NULL;
    *section = (struct verify_section){
        .kind = kind, .first = grid->known_bin[known], .count = end - known};
    sections->count++;
    return section;
}

static enum status add_pairs(const struct potential_grid *grid, double threshold,
                             const struct measurement *replicas, size_t count,
                             struct verify_sections *sections) {
    static const double rare = 0.01; // a core is drawn, not fitted, and so few pairs change nothing
    OWNED struct rdf *rdf = NULL;
    size_t known = 0;
    TRY_ARRAY(rdf, count);
    for (size_t k = 0; k < count && grid->pairs > 0; k++) {
        const struct rdf_observed *observed =
            mf_measurement_state(&replicas[k], &mf_rdf_observable);
        rdf[k] = observed->counted;
    }
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        const size_t end = known + grid->known_of[pair];
        struct verify_section *const section = add(sections, grid, known, end, TARGET_RDF);
        known = end;
        if (section == NULL)
            continue;
        section->core = section->first - pair * grid->bins;
        section->threshold = fmax(rare, threshold);
        TRY(mf_rdf_independence(rdf, count, section->first, section->count, &section->known));
    }
    return STATUS_OK;
}

/// How many independent values the bins of a group are, counted from its first.
static enum status find_independence(const struct bonded_unknown *unknown,
                                     const struct measurement *replicas, size_t count,
                                     const void **states, struct verify_section *section) {
    const bool of_density = unknown->order == INVERSE_LOCAL_DENSITY;
    const struct observable *observable =
        of_density ? &mf_weighted_density : mf_bonded_distribution_of(unknown->order);
    for (size_t k = 0; k < count; k++)
        states[k] = mf_measurement_state(&replicas[k], observable);
    return of_density
               ? mf_weighted_density_independence(states, count, section->first, section->count,
                                                  &section->known)
               : mf_bonded_distribution_independence(states, count, unknown->group, section->first,
                                                     section->count, &section->known);
}

static enum status add_groups(const struct potential_grid *grid, const struct measurement *replicas,
                              size_t count, struct verify_sections *sections) {
    OWNED const void **states = NULL;
    size_t known = grid->pairs_known;
    TRY_ARRAY(states, count);
    for (size_t g = 0; g < grid->groups; g++) {
        const struct bonded_unknown *const unknown = grid->group[g].own.unknown;
        const size_t end = known + grid->group[g].own.known;
        struct verify_section *const section =
            add(sections, grid, known, end, mf_group_kind_target(unknown->order));
        known = end;
        if (section == NULL)
            continue;
        section->first -= grid->group[g].bin;
        TRY(find_independence(unknown, replicas, count, states, section));
        section->first += unknown->first;
    }
    return STATUS_OK;
}

static enum status add_distributions(const struct inverse_problem *problem,
                                     const struct measurement *replicas, size_t count,
                                     struct verify_sections *sections) {
    CLEARED_BY(mf_potential_grid_clear) struct potential_grid grid = {0};
    const bool pairs = problem->unknown[UNKNOWN_POTENTIAL].wanted;
    if (pairs ? !targets_ask(&problem->targets, TARGET_RDF) : problem->bonded == 0)
        return STATUS_OK;
    TRY(mf_potential_grid_init(&grid, problem));
    TRY(add_pairs(&grid, problem->core_threshold, replicas, count, sections));
    return add_groups(&grid, replicas, count, sections);
}

static bool has_section(const struct verify_sections *sections, int kind) {
    bool found = false;
    for (size_t s = 0; s < sections->count; s++)
        found = found || sections->section[s].kind == kind;
    return found;
}

/// How many independent numbers the values of a target are, by the scatter of the replicas, and how
/// well their errors are known. Values that are not known do not scatter.
/// @param[in] own  of each replica, shape [count]
static enum status find_curve(const struct target *target, int kind, const struct observed *own,
                              size_t count, double freedom, struct statistics_independence *found) {
    OWNED double *values = NULL;
    TRY_ARRAY(values, target->count * count);
    for (size_t k = 0; k < target->count; k++)
        for (size_t r = 0; r < count; r++) {
            const double value = own[r].value[kind][k];
            values[k * count + r] = isfinite(target->value[k]) && isfinite(value) ? value : 0;
        }
    TRY(mf_statistics_independence(values, 1, count, target->count, found));
    found->freedom = freedom > 0 ? freedom : INFINITY;
    return STATUS_OK;
}

static enum status add_curves(const struct targets *targets, const struct measurement *replicas,
                              size_t count, const struct observed *observed,
                              struct verify_sections *sections) {
    enum status status = STATUS_OK;
    struct observed *own = NULL;
    NEW_ARRAY(own, count);
    for (size_t r = 0; r < count; r++) {
        CHECK(mf_measurement_values_init(&own[r], replicas->targets));
        CHECK(mf_measurement_result(&replicas[r], 1, &own[r]));
    }
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(targets, kind) && !has_section(sections, kind))
            CHECK(find_curve(&targets->target[kind], kind, own, count, observed->freedom[kind],
                             &sections->curve[kind]));
done:
    for (size_t r = 0; own && r < count; r++)
        mf_measurement_values_clear(&own[r]);
    mf_memory_free(own);
    return status;
}

enum status mf_verify_sections_find(const struct inverse_problem *problem,
                                    const struct measurement *replicas, size_t count,
                                    const struct observed *observed,
                                    struct verify_sections *sections) {
    *sections = (struct verify_sections){0};
    TRY(add_distributions(problem, replicas, count, sections));
    return add_curves(&problem->compared, replicas, count, observed, sections);
}
