// SPDX-License-Identifier: GPL-3.0-or-later
//
// The genetic algorithm by ask and tell. A round is a generation: the elite is individual 0 and is
// measured again each time. The best of the others, if it measured below the elite's mean, is the
// challenger: its genes follow the next generation in as many rows as it needs fresh measurements,
// and only their mean is offered for the elite's place. These rows take part in the selection, so
// that a challenger has children while it waits. A last round measures the last challenger alone.
#include "optimise/genetic.h"
#include "optimise/optimiser.h"

#include <math.h>
#include <string.h>

struct state {
    struct genetic genetic;
    double *errors;     ///< shape [population + GENETIC_REMEASUREMENTS]: scratch
    double *challenger; ///< shape [genes]: scratch
};

static uint32_t max_rounds(const void *parameters, size_t genes) {
    (void)genes;
    return (uint32_t)((const struct genetic_parameters *)parameters)->generations + 1;
}

static void destroy(void *memory) {
    struct state *state = memory;
    mf_genetic_clear(&state->genetic);
    mf_memory_free(state->errors);
    mf_memory_free(state->challenger);
    *state = (struct state){0};
}

static enum status create(void *memory, const struct optimiser_space *space,
                          const void *parameters) {
    enum status status = STATUS_OK;
    struct state *state = memory;
    const struct genetic_parameters *p = parameters;
    struct optimiser_space inside = *space;
    double *start = NULL;
    CHECK(mf_optimiser_check_space(space));
    CHECK(mf_optimiser_check_round(space, (size_t)(p->population + GENETIC_REMEASUREMENTS)));
    NEW_ARRAY(state->errors, (size_t)(p->population + GENETIC_REMEASUREMENTS));
    NEW_ARRAY(state->challenger, space->variables);
    NEW_ARRAY(start, space->variables);
    for (size_t k = 0; space->start && k < space->variables; k++)
        start[k] = optimiser_variable(space, mf_optimiser_start(space, k));
    if (space->start)
        inside.start = start;
    CHECK(mf_genetic_init(&state->genetic, p, &inside));
done:
    mf_memory_free(start);
    if (status != STATUS_OK)
        destroy(state);
    return status;
}

/// Whether the elite has stood its ground for long.
static bool has_settled(const struct genetic *genetic) {
    const int64_t patience = genetic->parameters.patience;
    const uint32_t since =
        genetic->elite_since > genetic->resumed ? genetic->elite_since : genetic->resumed;
    return patience > 0 && genetic_has_elite(genetic) &&
           genetic->generation >= since + (uint64_t)patience;
}

/// Whether all generations are measured, and perhaps a last challenger is left.
static bool is_over(const struct genetic *genetic) {
    return has_settled(genetic) || genetic->generation >= (uint32_t)genetic->parameters.generations;
}

/// Rows of the population that this round leaves out.
static int64_t first_row(const struct genetic *genetic) {
    return is_over(genetic) ? genetic->parameters.population : 0;
}

static bool has_challenger(const struct genetic *genetic) {
    return genetic->rows > genetic->parameters.population;
}

static const double *last_challenger(const struct genetic *genetic) {
    return mf_genetic_individual(genetic, genetic->parameters.population);
}

static enum status ask(void *memory, struct optimiser_round *round) {
    const struct genetic *genetic = &((struct state *)memory)->genetic;
    const int64_t first = first_row(genetic);
    *round = (struct optimiser_round){mf_genetic_individual(genetic, first),
                                      (size_t)(genetic->rows - first)};
    return STATUS_OK;
}

/// Offer the challenger the place of the elite for the mean of its fresh measurements.
static void assess_challenger(struct genetic *genetic, const double *fresh) {
    double mean = 0;
    for (int k = 0; k < GENETIC_REMEASUREMENTS; k++)
        mean += fresh[k] / GENETIC_REMEASUREMENTS;
    mf_genetic_offer(genetic, last_challenger(genetic), mean, GENETIC_REMEASUREMENTS);
}

static bool is_elite(const struct genetic *genetic, int64_t row) {
    return genetic_has_elite(genetic) &&
           memcmp(mf_genetic_individual(genetic, row), genetic->elite,
                  (size_t)genetic->parameters.genes * sizeof(double)) == 0;
}

/// Index of the best individual below the elite's error, −1 if there is none. Twins of the elite
/// are left out: they would win by a lucky draw of the same genes.
static int64_t find_challenger(const struct genetic *genetic, const double *errors) {
    int64_t best = -1;
    double min = genetic->elite_error;
    for (int64_t k = 0; k < genetic->parameters.population; k++) {
        if (errors[k] >= min || is_elite(genetic, k))
            continue;
        best = k;
        min = errors[k];
    }
    return best;
}

/// Rows of a challenger after the next generation.
/// @param[in] number  of the individual that it is
static void add_challenger(struct state *state, uint64_t number) {
    struct genetic *genetic = &state->genetic;
    const int64_t population = genetic->parameters.population;
    const size_t genes = (size_t)genetic->parameters.genes;
    genetic->rows = population + GENETIC_REMEASUREMENTS;
    for (int64_t k = population; k < genetic->rows; k++) {
        memcpy(genetic->population + (size_t)k * genes, state->challenger, genes * sizeof(double));
        genetic->parent[2 * k] = number;
        genetic->parent[2 * k + 1] = 0;
    }
}

static void report_generation(struct state *state) {
    struct genetic *genetic = &state->genetic;
    const int64_t population = genetic->parameters.population;
    if (genetic_has_elite(genetic))
        mf_genetic_remeasure_elite(genetic, state->errors[0]);
    if (has_challenger(genetic))
        assess_challenger(genetic, state->errors + population);
    const int64_t challenger = find_challenger(genetic, state->errors);
    if (challenger >= 0)
        memcpy(state->challenger, mf_genetic_individual(genetic, challenger),
               (size_t)genetic->parameters.genes * sizeof(double));
    const uint64_t number = genetic->measured + (uint64_t)challenger + 1;
    mf_genetic_next_generation(genetic, state->errors);
    if (challenger >= 0)
        add_challenger(state, number);
}

/// In the place of the elite, which it was the last to be measured as.
static void begin_with_challenger(struct genetic *genetic) {
    memcpy(genetic->population, genetic->elite, (size_t)genetic->parameters.genes * sizeof(double));
    genetic->parent[0] = genetic->measured;
    genetic->parent[1] = 0;
}

static enum status tell(void *memory, const double *errors, const double *variances) {
    struct state *state = memory;
    struct genetic *genetic = &state->genetic;
    const int64_t count = genetic->rows - first_row(genetic);
    (void)variances; // the selection needs ranks alone, and the elite is measured again anyway
    for (int64_t k = 0; k < count; k++)
        state->errors[k] = optimiser_error(errors[k]);
    if (!is_over(genetic)) {
        report_generation(state);
    } else if (has_challenger(genetic)) {
        assess_challenger(genetic, state->errors);
        genetic->measured += (uint64_t)count;
        genetic->rows = genetic->parameters.population;
        // If it has won, patience starts again, with it in the place of the elite.
        if (!is_over(genetic))
            begin_with_challenger(genetic);
    }
    return STATUS_OK;
}

static bool best_candidate(const void *memory, double *genes) {
    const struct genetic *genetic = &((const struct state *)memory)->genetic;
    const bool has_elite = genetic_has_elite(genetic);
    if (!has_elite && !has_challenger(genetic))
        return false;
    memcpy(genes, has_elite ? genetic->elite : last_challenger(genetic),
           (size_t)genetic->parameters.genes * sizeof *genes);
    return true;
}

static double spread(const void *memory) {
    return mf_genetic_diversity(&((const struct state *)memory)->genetic);
}

static bool settled(const void *memory) {
    return has_settled(&((const struct state *)memory)->genetic);
}

static bool go_on(void *memory) {
    struct genetic *genetic = &((struct state *)memory)->genetic;
    if (genetic->generation >= (uint32_t)genetic->parameters.generations)
        return false;
    mf_genetic_forget(genetic);
    return true;
}

/// In the last place of the next generation.
static void suggest(void *memory, const double *genes) {
    struct genetic *genetic = &((struct state *)memory)->genetic;
    const struct genetic_parameters *p = &genetic->parameters;
    memcpy(genetic->population + (p->population - 1) * p->genes, genes,
           (size_t)p->genes * sizeof *genes);
    genetic->parent[2 * (p->population - 1)] = genetic->parent[2 * p->population - 1] = 0;
}

static void parents(const void *memory, size_t row, uint64_t parent[2]) {
    const struct genetic *genetic = &((const struct state *)memory)->genetic;
    const uint64_t *of_row = genetic->parent + 2 * ((size_t)first_row(genetic) + row);
    parent[0] = of_row[0];
    parent[1] = of_row[1];
}

/// A roulette may choose anyone.
static double discard_above(const void *memory) {
    const struct genetic *genetic = &((const struct state *)memory)->genetic;
    return genetic->parameters.selection == GENETIC_ROULETTE ? HUGE_VAL : genetic->median;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    struct genetic *genetic = &state->genetic;
    const struct genetic_parameters *p = &genetic->parameters;
    const size_t row = (size_t)p->genes * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&genetic->median, sizeof genetic->median};
    span[n++] = (struct memory_span){&genetic->generation, sizeof genetic->generation};
    span[n++] = (struct memory_span){&genetic->rows, sizeof genetic->rows};
    span[n++] = (struct memory_span){genetic->population,
                                     (size_t)(p->population + GENETIC_REMEASUREMENTS) * row};
    span[n++] = (struct memory_span){genetic->elite, row};
    span[n++] = (struct memory_span){&genetic->elite_error, sizeof genetic->elite_error};
    span[n++] = (struct memory_span){&genetic->elite_measured, sizeof genetic->elite_measured};
    span[n++] = (struct memory_span){genetic->spread, genetic->blocks * sizeof *genetic->spread};
    span[n++] = (struct memory_span){&genetic->measured, sizeof genetic->measured};
    span[n++] =
        (struct memory_span){genetic->parent, (size_t)(p->population + GENETIC_REMEASUREMENTS) * 2 *
                                                  sizeof *genetic->parent};
    span[n++] = (struct memory_span){&genetic->elite_since, sizeof genetic->elite_since};
    span[n++] = (struct memory_span){&genetic->resumed, sizeof genetic->resumed};
    return n;
}

const struct optimiser mf_genetic_optimiser = {
    .name = "genetic",
    .tables = (const struct field *const[]){mf_genetic_fields, NULL},
    .parameters_size = sizeof(struct genetic_parameters),
    .budget = "generations",
    OPTIMISER_RECORD,
    .suggest = suggest,
    .go_on = go_on,
    .parents = parents,
};
