// SPDX-License-Identifier: GPL-3.0-or-later
//
// Several goals without weights: NSGA-II (optimise/nsga2.h) on the distance from each. What comes
// of it is a front, on which one goal is only met better if another is met worse; the weighted
// error of the goals chooses from it.
#include "inverse/inverse.h"

#include "base/memory.h"
#include "inverse/candidates.h"
#include "io/data_table.h"
#include "io/output.h"
#include "optimise/nsga2.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct own {
    struct nsga2_parameters nsga2;
    int64_t checks, surrogate;
};

/// What a row of the log is of.
enum log_kind { LOG_MEASURED, LOG_FRONT, LOG_CHOSEN };

/// Columns of a row before the objectives.
enum { LOG_ITERATION, LOG_KIND, LOG_ERROR, LOG_OBJECTIVES };

struct state {
    struct own own;
    const struct inverse_problem *problem;
    struct decoder decoder;
    struct candidates candidates;
    struct nsga2 nsga2;
    size_t objectives;
    enum goal_kind goal[GOALS];                      ///< of each objective
    double *value;                                   ///< shape [candidates, objectives]: scratch
    double *log;                                     ///< shape [rows, LOG_OBJECTIVES + objectives]
    double *curve[UNKNOWNS], *curve_error[UNKNOWNS]; ///< of the chosen
    struct progress {
        uint32_t iteration, stage;
        uint64_t rows;       ///< of the log
        uint64_t chosen;     ///< parent
        bool known;          ///< whether there is a chosen one
        double noise[GOALS]; ///< of one simulation's distances, by objective
    } progress;
};

#define OWN(name) .offset = offsetof(struct own, name)
static const struct field own_fields[] = {
    {"checks", FIELD_INTEGER, OWN(checks), .initial = 2, .minimum = 1, .maximum = CANDIDATES_MOST,
     .unit = "", .help = "fresh measurements of a member of the front before it is chosen"},
    {"surrogate", FIELD_INTEGER, OWN(surrogate), .initial = 4, .minimum = 0,
     .maximum = NSGA2_PLANTED, .unit = "",
     .help = "children of a generation that are what linear models of the simulations think best"},
    FIELD_END,
};

static_assert(sizeof(struct own) <= sizeof((struct candidates_settings){0}.method), "no room");
static_assert(offsetof(struct own, nsga2) == 0, "nsga2_fields need it first");

static const char *const columns[] = {"best[1]", "mean[1]", "diversity[1]", "failures", NULL};

/// How far the linear model may go from the chosen, as a part of a gene's range: the first child so
/// far, each of the others half as far as the one before.
static const double reach = 0.3;

static uint32_t most_iterations(const struct inverse_method *method,
                                const struct inverse_problem *problem, const void *parameters) {
    (void)method, (void)problem;
    return (uint32_t)((const struct own *)parameters)->nsga2.generations;
}

static void destroy(void *memory) {
    struct state *state = memory;
    nsga2_clear(&state->nsga2);
    candidates_clear(&state->candidates);
    decoder_clear(&state->decoder);
    memory_free(state->value);
    memory_free(state->log);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        memory_free(state->curve[kind]);
        memory_free(state->curve_error[kind]);
    }
}

static size_t log_width(const struct state *state) {
    return LOG_OBJECTIVES + state->objectives;
}

/// Every measurement and every front: at most twice the population in a round, and once.
static size_t log_rows(const struct state *state) {
    return 3 * state->nsga2.population * (size_t)state->own.nsga2.generations;
}

static enum status create_nsga2(struct state *state) {
    enum status status = STATUS_OK;
    double *start = NULL;
    NEW_ARRAY(start, state->decoder.genes);
    CHECK(decoder_start(&state->decoder, start));
    const struct nsga2_space space = {.genes = state->decoder.genes,
                                      .objectives = state->objectives,
                                      .start = start,
                                      .seed = state->problem->seed};
    CHECK(nsga2_init(&state->nsga2, &state->own.nsga2, &space));
done:
    memory_free(start);
    return status;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    enum status status = STATUS_OK;
    struct state *state = memory;
    const struct candidates_settings *settings = parameters;
    memcpy(&state->own, &settings->method, sizeof state->own);
    state->problem = problem;
    for (int kind = 0; kind < GOALS; kind++)
        if (goals_ask(&problem->goals, kind))
            state->goal[state->objectives++] = kind;
    if (state->objectives < 2)
        return status_fail(STATUS_BAD_INPUT,
                           "method.name: \"%s\" needs two fitted targets at least", method->name);
    CHECK(decoder_init(&state->decoder, problem));
    CHECK(create_nsga2(state));
    NEW_ARRAY(state->value, CANDIDATES_MOST * state->objectives);
    NEW_ARRAY(state->log, log_rows(state) * log_width(state));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!problem->unknown[kind].wanted)
            continue;
        NEW_ARRAY(state->curve[kind], decoder_points(&state->decoder, kind));
        NEW_ARRAY(state->curve_error[kind], decoder_points(&state->decoder, kind));
    }
    CHECK(candidates_init(&state->candidates, &state->decoder, &settings->candidates));
    state->candidates.iterations = most_iterations(method, problem, parameters);
done:
    return status;
}

/// Weighted error of a row of objectives, or of their noise.
static double error_of(const struct state *state, const double *value) {
    struct goal_distance distance[GOALS] = {0};
    for (size_t m = 0; m < state->objectives; m++) {
        if (value[m] >= OPTIMISER_FAILED)
            return OPTIMISER_FAILED;
        distance[state->goal[m]].rms = value[m];
    }
    return goals_error(&state->problem->goals, distance);
}

/// Distances of a measurement as a row of objectives.
static void take_distances(const struct state *state, double error,
                           const struct goal_distance distance[GOALS], double *value) {
    for (size_t m = 0; m < state->objectives; m++)
        value[m] = error < OPTIMISER_FAILED ? distance[state->goal[m]].rms : OPTIMISER_FAILED;
}

static const double *value_of(const struct state *state, size_t parent) {
    return state->nsga2.value + parent * state->objectives;
}

/// Whether a parent is a member of the front. Those that failed are a front when all have.
static bool is_member(const struct state *state, size_t parent) {
    return state->nsga2.rank[parent] == 1 && value_of(state, parent)[0] < OPTIMISER_FAILED;
}

static void add_to_log(struct state *state, enum log_kind kind, const double *value) {
    double *row = state->log + state->progress.rows * log_width(state);
    const double error = error_of(state, value);
    if (error >= OPTIMISER_FAILED || state->progress.rows >= log_rows(state))
        return;
    row[LOG_ITERATION] = state->progress.iteration;
    row[LOG_KIND] = kind;
    row[LOG_ERROR] = error;
    memcpy(row + LOG_OBJECTIVES, value, state->objectives * sizeof *row);
    state->progress.rows++;
}

static enum status take_round(struct state *state, const struct inverse_listener *listener) {
    const struct optimiser_round round = nsga2_ask(&state->nsga2);
    struct candidates *candidates = &state->candidates;
    TRY(candidates_measure(candidates, &round, HUGE_VAL, listener));
    for (size_t k = 0; k < round.count; k++) {
        double *value = state->value + k * state->objectives;
        take_distances(state, candidates->errors[k], candidates->distances + k * GOALS, value);
        add_to_log(state, LOG_MEASURED, value);
    }
    TRY(nsga2_tell(&state->nsga2, state->value));
    candidates_next_round(candidates);
    return STATUS_OK;
}

static bool is_checked(const struct state *state, size_t parent) {
    return state->nsga2.measured[parent] > (double)state->own.checks;
}

/// Member of the front of the least error; false if there is none.
static bool find_best(const struct state *state, size_t *best) {
    double least = OPTIMISER_FAILED;
    for (size_t k = 0; k < nsga2_parents(&state->nsga2); k++) {
        const double error = error_of(state, value_of(state, k));
        if (!is_member(state, k) || error >= least)
            continue;
        least = error;
        *best = k;
    }
    return least < OPTIMISER_FAILED;
}

/// Measure a parent until it is checked.
static enum status check_one(struct state *state, size_t parent) {
    struct goal_distance distance[GOALS];
    double error, noise, variance, value[GOALS];
    TRY(candidates_remeasure(&state->candidates, nsga2_parent(&state->nsga2, parent),
                             (size_t)state->own.checks, &error, &noise, &variance, distance));
    take_distances(state, error, distance, value);
    for (size_t m = 0; m < state->objectives && error < OPTIMISER_FAILED; m++)
        state->progress.noise[m] = distance[state->goal[m]].noise;
    // The mean of some measurements counts as many times.
    for (int64_t k = 0; k < state->own.checks; k++)
        TRY(nsga2_add_measurement(&state->nsga2, parent, value));
    return STATUS_OK;
}

/// Choose from the front: by fresh measurements, since what seems best on one is a lucky draw. They
/// go on until the best has been checked.
static enum status choose(struct state *state) {
    size_t best = 0;
    while (find_best(state, &best) && !is_checked(state, best))
        TRY(check_one(state, best));
    state->progress.known = find_best(state, &best);
    state->progress.chosen = best;
    return STATUS_OK;
}

static void find_bands(struct state *state, const struct surrogate_model *model) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (state->problem->unknown[kind].wanted)
            decoder_band(&state->decoder, kind, model ? model->covariance : NULL,
                         state->curve_error[kind]);
}

/// Standard errors of the curves, and children where the linear model sees the goals met best.
static enum status ask_surrogate(struct state *state) {
    enum status status = STATUS_OK;
    struct surrogate_model model = {0};
    bool known = state->progress.known;
    const double *chosen = nsga2_parent(&state->nsga2, state->progress.chosen);
    find_bands(state, NULL);
    for (int64_t k = 0; known && (k == 0 || k < state->own.surrogate); k++) {
        surrogate_model_clear(&model);
        CHECK(surrogate_fit(&state->candidates.surrogate, chosen, ldexp(reach, (int)-k), &model,
                            &known));
        if (known && k == 0)
            find_bands(state, &model);
        if (known && k < state->own.surrogate)
            nsga2_plant(&state->nsga2, model.best);
    }
done:
    surrogate_model_clear(&model);
    return status;
}

static void describe(struct state *state, struct inverse_step *step) {
    const struct candidates_survey *survey = &state->candidates.survey;
    const struct progress *progress = &state->progress;
    const bool finished = nsga2_is_over(&state->nsga2);
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = state->candidates.totals.evaluations,
        .engine_steps = state->candidates.totals.steps,
        .error = progress->known ? error_of(state, value_of(state, progress->chosen)) : NAN,
        .noise = progress->known ? error_of(state, progress->noise) : NAN,
        .extra = {survey->best, survey->alive.count > 0 ? survey->alive.mean : NAN,
                  nsga2_diversity(&state->nsga2), (double)survey->failures},
        .finished = finished,
        .converged = finished && progress->known,
    };
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!state->problem->unknown[kind].wanted)
            continue;
        decoder_curve(&state->decoder, kind,
                      progress->known ? nsga2_parent(&state->nsga2, progress->chosen)
                                      : state->candidates.first,
                      state->curve[kind]);
        step->curve[kind] = state->curve[kind];
        step->curve_error[kind] = state->curve_error[kind];
    }
}

static void log_front(struct state *state) {
    for (size_t k = 0; k < nsga2_parents(&state->nsga2); k++)
        if (is_member(state, k))
            add_to_log(state,
                       state->progress.known && k == state->progress.chosen ? LOG_CHOSEN
                                                                            : LOG_FRONT,
                       value_of(state, k));
}

/// A round, and then the choice: each is done once, also if an interruption comes between them.
static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    enum { ROUND, CHOICE };
    struct state *state = memory;
    state->candidates.iteration = state->progress.iteration;
    if (state->progress.stage == ROUND) {
        TRY(take_round(state, listener));
        state->progress.stage = CHOICE;
    }
    TRY(choose(state));
    TRY(ask_surrogate(state));
    log_front(state);
    describe(state, step);
    candidates_forget_survey(&state->candidates);
    state->progress.stage = ROUND;
    state->progress.iteration++;
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] =
        (struct memory_span){state->log, log_rows(state) * log_width(state) * sizeof(double)};
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (state->curve_error[kind])
            span[n++] = (struct memory_span){
                state->curve_error[kind], decoder_points(&state->decoder, kind) * sizeof(double)};
    n += nsga2_spans(&state->nsga2, span + n);
    return n + candidates_spans(&state->candidates, span + n);
}

// Tables ----------------------------------------------------------------------------------------

enum { NAME_SIZE = 32, EXTRA_COLUMNS = 5 };

/// Parents in the order of the tables: by rank, then by the first objective.
struct line {
    size_t parent;
    uint32_t rank;
    double value;
};

static int compare_lines(const void *a, const void *b) {
    const struct line *x = a, *y = b;
    if (x->rank != y->rank)
        return x->rank < y->rank ? -1 : 1;
    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return (x->parent > y->parent) - (x->parent < y->parent);
}

/// Parents that have not failed, in order; `members` are on the first front and come first.
static size_t sort_lines(const struct state *state, struct line *lines, size_t *members) {
    size_t count = 0;
    *members = 0;
    for (size_t k = 0; k < nsga2_parents(&state->nsga2); k++) {
        if (value_of(state, k)[0] >= OPTIMISER_FAILED)
            continue;
        lines[count++] = (struct line){k, state->nsga2.rank[k], value_of(state, k)[0]};
        *members += is_member(state, k);
    }
    qsort(lines, count, sizeof *lines, compare_lines);
    return count;
}

/// A column of a table under construction: `rows` numbers in `memory`, which it returns.
static double *begin_column(struct data_column *column, const char *name, double *memory,
                            const char *format) {
    *column = (struct data_column){name, memory, format};
    return memory;
}

/// pareto.tsv: every parent that has not failed.
static enum status write_front(const struct state *state, const struct inverse_folder *folder,
                               const struct line *lines, size_t rows) {
    enum status status = STATUS_OK;
    const size_t objectives = state->objectives, most = EXTRA_COLUMNS + 2 * objectives;
    char names[2 * GOALS][NAME_SIZE], path[OUTPUT_PATH_SIZE];
    struct data_column *column = NULL;
    double *memory = NULL;
    NEW_ARRAY(column, most);
    NEW_ARRAY(memory, most * (rows + 1));
    double *value[EXTRA_COLUMNS + 2 * GOALS];
    static const char *const extra[EXTRA_COLUMNS] = {"member", "rank", "chosen", "measured",
                                                     "error[1]"};
    for (size_t c = 0; c < most; c++) {
        const size_t m = (c - EXTRA_COLUMNS) % objectives;
        if (c >= EXTRA_COLUMNS)
            snprintf(names[c - EXTRA_COLUMNS], NAME_SIZE, "%s_%s[1]", goals_names[state->goal[m]],
                     c < EXTRA_COLUMNS + objectives ? "rmse" : "noise");
        value[c] = begin_column(&column[c], c < EXTRA_COLUMNS ? extra[c] : names[c - EXTRA_COLUMNS],
                                memory + c * (rows + 1), NULL);
    }
    for (size_t k = 0; k < rows; k++) {
        const size_t parent = lines[k].parent;
        value[0][k] = (double)k + 1;
        value[1][k] = lines[k].rank;
        value[2][k] = state->progress.known && parent == state->progress.chosen;
        value[3][k] = state->nsga2.measured[parent];
        value[4][k] = error_of(state, value_of(state, parent));
        for (size_t m = 0; m < objectives; m++) {
            value[EXTRA_COLUMNS + m][k] = value_of(state, parent)[m];
            value[EXTRA_COLUMNS + objectives + m][k] = state->progress.noise[m];
        }
    }
    folder->file(folder->context, "pareto.tsv", path);
    CHECK(data_table_write(path, NULL, column, most, rows));
done:
    memory_free(column);
    memory_free(memory);
    return status;
}

/// pareto_history.tsv: the log.
static enum status write_log(const struct state *state, const struct inverse_folder *folder) {
    enum status status = STATUS_OK;
    static const char *const first[LOG_OBJECTIVES] = {"iteration", "front", "error[1]"};
    const size_t rows = state->progress.rows, width = log_width(state);
    char names[GOALS][NAME_SIZE], path[OUTPUT_PATH_SIZE];
    struct data_column column[LOG_OBJECTIVES + GOALS];
    double *memory = NULL;
    NEW_ARRAY(memory, width * (rows + 1));
    for (size_t c = 0; c < width; c++) {
        if (c >= LOG_OBJECTIVES)
            snprintf(names[c - LOG_OBJECTIVES], NAME_SIZE, "%s_rmse[1]",
                     goals_names[state->goal[c - LOG_OBJECTIVES]]);
        double *value =
            begin_column(&column[c], c < LOG_OBJECTIVES ? first[c] : names[c - LOG_OBJECTIVES],
                         memory + c * (rows + 1), NULL);
        for (size_t k = 0; k < rows; k++)
            value[k] = state->log[k * width + c];
    }
    folder->file(folder->context, "pareto_history.tsv", path);
    CHECK(data_table_write(path, NULL, column, width, rows));
done:
    memory_free(memory);
    return status;
}

/// pareto_potential.tsv or pareto_weight.tsv: a column a member of the front, named by its number
/// in pareto.tsv.
static enum status write_curves(const struct state *state, enum unknown_kind kind,
                                const struct inverse_folder *folder, const struct line *lines,
                                size_t members) {
    enum status status = STATUS_OK;
    const size_t points = decoder_points(&state->decoder, kind);
    struct data_column *column = NULL;
    double *curves = NULL;
    char *names = NULL, name[NAME_SIZE], path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(column, members + 1);
    NEW_ARRAY(curves, (members + 1) * points);
    NEW_ARRAY(names, (members + 1) * NAME_SIZE);
    column[0] = (struct data_column){"r[lambda]", decoder_r(&state->decoder, kind), NULL};
    for (size_t k = 0; k < members; k++) {
        snprintf(names + k * NAME_SIZE, NAME_SIZE, "%zu", k + 1);
        decoder_curve(&state->decoder, kind, nsga2_parent(&state->nsga2, lines[k].parent),
                      curves + k * points);
        column[k + 1] = (struct data_column){names + k * NAME_SIZE, curves + k * points, "%.8g"};
    }
    snprintf(name, sizeof name, "pareto_%s.tsv", inverse_unknown_names[kind]);
    folder->file(folder->context, name, path);
    CHECK(data_table_write(path, NULL, column, members + 1, points));
done:
    memory_free(column);
    memory_free(curves);
    memory_free(names);
    return status;
}

static enum status write_tables(const void *memory, const struct inverse_folder *folder) {
    enum status status = STATUS_OK;
    const struct state *state = memory;
    struct line *lines = NULL;
    NEW_ARRAY(lines, state->nsga2.population);
    size_t members;
    const size_t rows = sort_lines(state, lines, &members);
    CHECK(write_front(state, folder, lines, rows));
    CHECK(write_log(state, folder));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (state->problem->unknown[kind].wanted)
            CHECK(write_curves(state, kind, folder, lines, members));
done:
    memory_free(lines);
    return status;
}

const struct inverse_method pareto = {
    .name = "pareto",
    .summary = "the front of all goals by NSGA-II, without weights; K. Deb et al. (2002)",
    .tables = (const struct field *const[]){nsga2_fields, own_fields, candidates_fields, NULL},
    .parameters_size = sizeof(struct candidates_settings),
    .state_size = sizeof(struct state),
    .fits = {true, true},
    .most_iterations = most_iterations,
    .sampling = candidates_sampling,
    .keeps_parts = true,
    .columns = columns,
    .create = create,
    .destroy = destroy,
    .iterate = iterate,
    .spans = spans,
    .write = write_tables,
};
