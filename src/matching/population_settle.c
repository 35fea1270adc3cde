// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/population.h"

#include "base/parallel.h"
#include "base/rng.h"

/// What settles, and what it leaves.
struct settling {
    struct population *population;
    const double *variables;
    uint32_t number;
    uint64_t steps;
};

static enum status settle_one(void *context, size_t task, void *result) {
    struct settling *settling = context;
    struct population *population = settling->population;
    const struct inverse_problem *problem = population->parametrisation->unknowns.problem;
    struct unknowns_laws laws;
    double *column[3] = {NULL};
    (void)task, (void)result;
    mf_population_split(population, population->position, column);
    enum status status =
        mf_parametrisation_laws(population->parametrisation, settling->variables, &laws);
    const struct evaluate_candidate candidate = {
        .potential = laws.table[UNKNOWN_POTENTIAL],
        .omega = laws.table[UNKNOWN_OMEGA],
        .threads = mf_population_threads_inside(problem),
        .seed = mf_rng_child_seed(problem->seed, RNG_EVALUATION, UINT32_MAX, settling->number),
    };
    if (status == STATUS_OK)
        status = mf_evaluate_settle(&laws.problem, &candidate,
                                    population->parameters.evaluate.plan.equilibration, column,
                                    &settling->steps);
    mf_unknowns_laws_clear(&laws);
    return status;
}

static size_t list_settled(void *context, size_t task, struct memory_span *span) {
    struct settling *settling = context;
    (void)task;
    span[0] = (struct memory_span){settling->population->position,
                                   mf_population_coordinates(settling->population) *
                                       sizeof *settling->population->position};
    span[1] = (struct memory_span){&settling->steps, sizeof settling->steps};
    return 2;
}

/// Candidates of one potential have one equilibrium; those of others find beads of it where they
/// want none.
static bool share_equilibrium(const struct inverse_problem *problem) {
    bool share = true;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        share = share && (unknown_is_omega(kind) || !problem->unknown[kind].wanted);
    return share;
}

enum status mf_population_settle(struct population *population,
                                 const struct optimiser_round *round) {
    enum { MAX = 4 }; // a round of which none settles is at fault as a whole
    struct population_totals *totals = &population->totals;
    const bool wanted = population->parameters.warm_start && totals->evaluations == 0 &&
                        share_equilibrium(population->parametrisation->unknowns.problem);
    for (size_t k = 0; wanted && k < round->count && k < MAX && !totals->warm; k++) {
        struct settling settling = {.population = population,
                                    .variables = round->variables +
                                                 k * population->parametrisation->variables,
                                    .number = (uint32_t)k};
        const enum status status = mf_parallel_try(&(struct parallel_tasks){.count = 1,
                                                                            .threads = 1,
                                                                            .run = settle_one,
                                                                            .context = &settling,
                                                                            .spans = list_settled});
        if (status != STATUS_OK && status != STATUS_UNSTABLE)
            return status;
        totals->steps += settling.steps;
        totals->warm = status == STATUS_OK;
    }
    return STATUS_OK;
}
