// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steady-state genetic algorithm: children are asked for one by one, and each takes a place in
// the population as soon as it is measured. D. Whitley, Proc. 3rd Int. Conf. Genetic Algorithms,
// 116 (1989) ("GENITOR") gives it the place of the worst, G. Syswerda, Foundations of Genetic
// Algorithms 1, 94 (1991) compares that with the place of the oldest, and K. A. De Jong and
// J. Sarma, Foundations of Genetic Algorithms 2, 19 (1993) find the oldest to take over as
// generations do. It is the oldest here: the worst would never make those leave whose noisy error
// was lucky once.
//
// Selection, operators, elite and challenger are those of generations. One has passed whenever as
// many as the population have joined it; then the elite is measured again, and the best of the
// population becomes the challenger, whose fresh measurements go before all others.
#include "optimise/genetic_state.h"

#include "base/rng.h"

#include <string.h>

/// Of a child; other origins are numbers of challengers.
enum { CHILD = 0 };

enum status mf_genetic_begin_stream(struct genetic_state *state) {
    if (state->genetic.parameters.islands > 1)
        return mf_status_fail(STATUS_BAD_INPUT, "\"islands\" are parts of generations, which an "
                                                "\"asynchronous\" population does not have");
    state->genetic.rows = 0;
    return STATUS_OK;
}

static bool wanted(const void *parameters) {
    return ((const struct genetic_parameters *)parameters)->asynchronous != 0;
}

static size_t round_size(const void *memory) {
    return (size_t)((const struct genetic_state *)memory)->genetic.parameters.population;
}

static size_t genes_size(const struct genetic_state *state) {
    return (size_t)state->genetic.parameters.genes * sizeof(double);
}

// Asking ------------------------------------------------------------------------------------------

static void ask_copy(const struct genetic_state *state, const double *genes, uint64_t origin,
                     uint64_t number, struct optimiser_candidate *candidate) {
    candidate->origin = origin;
    candidate->parent[0] = number;
    memcpy(candidate->numbers, genes, genes_size(state));
}

static void ask_child(struct genetic_state *state, struct optimiser_candidate *candidate) {
    struct genetic *genetic = &state->genetic;
    struct rng_sequence random =
        mf_rng_sequence_begin(genetic->seed, RNG_SELECTION, (uint32_t)state->stream.asked++, 0);
    double *first = genetic->offspring, *second = first + genetic->parameters.genes;
    int64_t winner[2];
    const bool crossed = mf_genetic_breed(genetic, (struct genetic_parents){0, genetic->rows},
                                          state->errors, first, second, winner, &random);
    memcpy(candidate->numbers, first, genes_size(state));
    candidate->parent[0] = state->number[winner[0]];
    candidate->parent[1] = crossed ? state->number[winner[1]] : 0;
}

static bool ask(void *memory, struct optimiser_candidate *candidate) {
    struct genetic_state *state = memory;
    struct genetic *genetic = &state->genetic;
    struct genetic_standing *stream = &state->stream;
    *candidate = (struct optimiser_candidate){.origin = CHILD};
    if (stream->challenging && state->copies < genetic->parameters.remeasurements) {
        state->copies++;
        ask_copy(state, state->challenger, stream->challenge, stream->challenger_number, candidate);
    } else if (mf_genetic_is_over(genetic)) {
        return false;
    } else if (stream->elite_due) {
        stream->elite_due = 0;
        ask_copy(state, genetic->elite, stream->elite, stream->elite_number, candidate);
    } else if (stream->asked < (uint64_t)genetic->parameters.population) {
        ask_copy(state, mf_genetic_individual(genetic, (int64_t)stream->asked++), CHILD, 0,
                 candidate);
    } else if (genetic->rows == 0) {
        return false;
    } else {
        ask_child(state, candidate);
    }
    return true;
}

// Telling -----------------------------------------------------------------------------------------

/// Add a fresh error of the challenger, who is judged by the mean once they are enough.
static void hear_challenger(struct genetic_state *state, double error) {
    struct genetic *genetic = &state->genetic;
    struct genetic_standing *stream = &state->stream;
    const int64_t enough = genetic->parameters.remeasurements;
    stream->fresh_sum += error;
    if (++stream->fresh < enough)
        return;
    stream->challenging = 0;
    if (!mf_genetic_offer(genetic, state->challenger, stream->fresh_sum / (double)enough,
                          (double)enough))
        return;
    stream->elite = stream->challenge;
    stream->elite_number = stream->challenger_number;
}

/// Take the place of the oldest. Candidates of the first population are asked for in the order of
/// their rows, so that nobody takes the place of one who was not.
static void join(struct genetic_state *state, const double *genes, double error) {
    struct genetic *genetic = &state->genetic;
    const int64_t population = genetic->parameters.population;
    const size_t row = (size_t)(state->stream.joined++ % (uint64_t)population);
    memcpy(genetic->population + row * (size_t)genetic->parameters.genes, genes, genes_size(state));
    state->errors[row] = error;
    state->number[row] = genetic->measured;
    if (genetic->rows < population)
        genetic->rows++;
}

static void begin_challenge(struct genetic_state *state, int64_t row) {
    struct genetic_standing *stream = &state->stream;
    memcpy(state->challenger, mf_genetic_individual(&state->genetic, row), genes_size(state));
    stream->challenge++;
    stream->challenger_number = state->number[row];
    stream->challenging = 1;
    stream->fresh = 0;
    stream->fresh_sum = 0;
    state->copies = 0;
}

static void end_generation(struct genetic_state *state) {
    struct genetic *genetic = &state->genetic;
    genetic->generation++;
    mf_genetic_survey(genetic, state->errors);
    state->stream.elite_due = genetic->elite_measured > 0;
    if (state->stream.challenging)
        return;
    const int64_t row = mf_genetic_find_challenger(genetic, state->errors);
    if (row >= 0)
        begin_challenge(state, row);
}

static enum status tell(void *memory, const struct optimiser_candidate *candidate, double error,
                        double variance, bool *ended) {
    struct genetic_state *state = memory;
    struct genetic *genetic = &state->genetic;
    struct genetic_standing *stream = &state->stream;
    const bool over = mf_genetic_is_over(genetic);
    const double told = optimiser_error(error);
    (void)variance; // as by generations
    *ended = false;
    genetic->measured++;
    if (stream->challenging && candidate->origin == stream->challenge) {
        hear_challenger(state, told);
        return STATUS_OK;
    }
    if (genetic->elite_measured > 0 && candidate->origin == stream->elite)
        mf_genetic_remeasure_elite(genetic, told);
    join(state, candidate->numbers, told);
    *ended = !over && stream->joined % (uint64_t)genetic->parameters.population == 0;
    if (*ended)
        end_generation(state);
    return STATUS_OK;
}

size_t mf_genetic_stream_spans(struct genetic_state *state, struct memory_span *spans) {
    const size_t population = (size_t)state->genetic.parameters.population;
    size_t n = 0;
    spans[n++] = (struct memory_span){&state->stream, sizeof state->stream};
    spans[n++] = (struct memory_span){state->errors, population * sizeof *state->errors};
    spans[n++] = (struct memory_span){state->challenger, genes_size(state)};
    spans[n++] = (struct memory_span){state->number, population * sizeof *state->number};
    return n;
}

const struct optimiser_stream mf_genetic_stream = {
    .wanted = wanted, .round = round_size, .ask = ask, .tell = tell};
