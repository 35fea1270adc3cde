// SPDX-License-Identifier: GPL-3.0-or-later
//
// What simulations say of formulas, and the choice from their front.
#include "base/parallel.h"
#include "base/rng.h"
#include "curves/expression_text.h"
#include "formulas_state.h"
#include "io/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Formulas whose g(r) would be off by more than this, or by so many times that of the best, are
/// not simulated: the first may be no liquid.
static const double worst_error = 1, too_far = 2;

void mf_formulas_make_curve(const struct formulas_state *state, const struct expression *expression,
                            double *curve) {
    const size_t points = mf_unknowns_points(&state->unknowns, state->kind);
    const bool potential = state->kind == UNKNOWN_POTENTIAL;
    const double shift = potential ? mf_expression_value(expression, state->points.zero, NULL) : 0;
    for (size_t k = 0; k < state->count; k++) {
        const double value = mf_expression_value(expression, state->points.r[k], NULL) - shift;
        curve[state->first + k] = potential ? value : fmax(0, value);
    }
    curve[points - 1] = 0;
    if (potential)
        mf_potential_grid_complete(&state->unknowns.potential, curve);
}

enum { MAX_CANDIDATES = 2 * PROGRAMMING_MAX_NODES };

/// Formulas to be simulated, each as often as "checks" says.
struct work {
    struct formulas_state *state;
    const struct inverse_listener *listener;
    size_t candidates, done;
    struct formulas_member candidate[MAX_CANDIDATES];
    struct evaluate_result *result; ///< shape [candidates, checks]
    double *features;               ///< shape [candidates, checks, features]
};

static enum status measure_one(void *context, size_t task, void *unused) {
    struct work *work = context;
    const struct formulas_state *state = work->state;
    const size_t checks = (size_t)state->own.checks, member = task / checks;
    struct unknowns_laws laws = {0};
    double *curve[UNKNOWNS] = {NULL};
    enum status status = STATUS_OK;
    (void)unused;
    NEW_ARRAY(curve[state->kind], mf_unknowns_points(&state->unknowns, state->kind));
    mf_formulas_make_curve(state, &work->candidate[member].formula.expression, curve[state->kind]);
    CHECK(mf_unknowns_laws_make(&state->unknowns, (const double *const *)curve, NULL, &laws));
    const struct evaluate_candidate candidate = {
        .potential = laws.table[UNKNOWN_POTENTIAL],
        .omega = laws.table[UNKNOWN_OMEGA],
        .discard_above = HUGE_VAL,
        .threads = 1,
        .seed = mf_rng_child_seed(state->problem->seed, RNG_EVALUATION, state->progress.iteration,
                                  (uint32_t)task),
    };
    status = mf_evaluate(&laws.problem, &candidate, &state->own.population.evaluate,
                         work->features + task * state->features, NULL, NULL, &work->result[task]);
    if (status == STATUS_UNSTABLE || (status == STATUS_OK && !isfinite(work->result[task].error))) {
        work->result[task].error = OPTIMISER_FAILED;
        status = STATUS_OK;
    }
done:
    mf_unknowns_laws_clear(&laws);
    mf_memory_free(curve[state->kind]);
    return status;
}

static size_t list_measured(void *context, size_t task, struct memory_span *span) {
    const struct work *work = context;
    const size_t features = work->state->features;
    span[0] = (struct memory_span){&work->result[task], sizeof *work->result};
    span[1] = (struct memory_span){work->features + task * features, features * sizeof(double)};
    return 2;
}

static void report_one(void *context, size_t task, const void *unused) {
    struct work *work = context;
    const struct formulas_state *state = work->state;
    (void)task, (void)unused;
    const struct inverse_progress progress = {
        .iteration = state->progress.iteration,
        .iterations = state->progress.iteration + 1,
        .done = ++work->done,
        .total = work->candidates * (size_t)state->own.checks,
        .best = state->progress.error,
        .min = NAN,
        .mean = NAN,
    };
    work->listener->report(work->listener->context, &progress);
}

/// Mean of a formula's simulations, and of what they found; it takes its place in the front if it
/// is better than what stands there.
static void take_mean(struct work *work, size_t n) {
    struct formulas_state *state = work->state;
    const size_t checks = (size_t)state->own.checks;
    struct formulas_member mean = work->candidate[n];
    struct formulas_member *in_front = &state->front[mean.formula.expression.length];
    mean.measured = true;
    mean.error = mean.noise = mean.variance = 0;
    for (size_t k = 0; k < checks; k++) {
        const struct evaluate_result *result = &work->result[n * checks + k];
        mean.error += result->error / (double)checks;
        mean.noise += result->noise / (double)checks;
        mean.variance += result->variance / (double)(checks * checks);
        if (result->error >= OPTIMISER_FAILED)
            mean.error = OPTIMISER_FAILED * (double)checks;
        state->progress.evaluations++;
        state->progress.engine_steps += result->engine_steps;
    }
    mean.error = fmin(mean.error, OPTIMISER_FAILED);
    if (in_front->measured && !(mean.error < in_front->error))
        return;
    *in_front = mean;
    double *found = state->found + (size_t)mean.formula.expression.length * state->features;
    for (size_t f = 0; f < state->features; f++) {
        found[f] = 0;
        for (size_t k = 0; k < checks; k++)
            found[f] += work->features[(n * checks + k) * state->features + f] / (double)checks;
    }
}

/// Whether a length has a formula that could be simulated.
static bool is_known(const struct formulas_state *state, int length) {
    return state->front[length].measured && state->front[length].error < OPTIMISER_FAILED;
}

/// Compare formulas with one that was simulated, in place of the curve: its values, and the
/// differences from the target that its simulations have shown.
static void compare_with(const struct formulas_state *state, int length, double *curve, double *y,
                         double *offset) {
    const double *found = state->found + (size_t)length * state->features;
    mf_formulas_make_curve(state, &state->front[length].formula.expression, curve);
    memcpy(y, curve + state->first, state->count * sizeof *y);
    for (size_t a = 0; a < state->count; a++)
        offset[a] = M_SQRT2 * (found[state->first + a] - state->target[state->first + a]);
    for (size_t a = 0; a < state->count; a++)
        offset[state->count + a] =
            state->response[(state->count + a) * state->count + a] * (y[a] - state->start[a]);
}

/// A formula that was simulated with constants by which the response makes up for what that showed.
static enum status refine(const struct formulas_state *state, int length,
                          struct formulas_member *refined) {
    OWNED double *curve = NULL, *y = NULL, *offset = NULL;
    TRY_ARRAY(curve, mf_unknowns_points(&state->unknowns, state->kind));
    TRY_ARRAY(y, state->count);
    TRY_ARRAY(offset, 2 * state->count);
    compare_with(state, length, curve, y, offset);
    struct programming_points points = state->points;
    points.y = y;
    points.offset = offset;
    *refined = state->front[length];
    return mf_programming_polish(&points, &refined->formula);
}

/// The front as it was bred, and what is best of what was simulated before with other constants.
static enum status find_candidates(struct work *work) {
    struct formulas_state *state = work->state;
    struct programming_member front[PROGRAMMING_MAX_NODES];
    size_t members;
    TRY(mf_programming_front(&state->programming, front, &members));
    const double max = members > 0 && state->kind == UNKNOWN_POTENTIAL
                           ? fmin(worst_error, too_far * front[members - 1].error)
                           : INFINITY;
    for (size_t k = 0; k < members; k++) {
        const int length = front[k].expression.length;
        const struct formulas_member member = {.formula = front[k], .error = OPTIMISER_FAILED};
        if (front[k].error <= max)
            work->candidate[work->candidates++] = member;
        else if (!state->front[length].measured)
            state->front[length] = member;
    }
    const double best = state->front[state->progress.nearest].error;
    for (int length = 1; length <= PROGRAMMING_MAX_NODES && state->progress.nearest > 0; length++)
        if (is_known(state, length) && state->front[length].error < too_far * best)
            TRY(refine(state, length, &work->candidate[work->candidates++]));
    return STATUS_OK;
}

static enum status measure(struct formulas_state *state, const struct inverse_listener *listener) {
    enum status status = STATUS_OK;
    struct work *work = NULL;
    NEW_ARRAY(work, 1);
    work->state = state;
    work->listener = listener;
    CHECK(find_candidates(work));
    const size_t tasks = work->candidates * (size_t)state->own.checks;
    NEW_ARRAY(work->result, tasks + 1);
    NEW_ARRAY(work->features, tasks * state->features + 1);
    CHECK(mf_parallel_try(&(struct parallel_tasks){.count = tasks,
                                                   .threads = state->problem->threads,
                                                   .run = measure_one,
                                                   .take = report_one,
                                                   .context = work,
                                                   .spans = list_measured}));
    for (size_t k = 0; k < work->candidates; k++)
        take_mean(work, k);
done:
    if (work) {
        mf_memory_free(work->result);
        mf_memory_free(work->features);
    }
    mf_memory_free(work);
    return status;
}

/// The best formula by simulations, and the least error that the response expects of one; 0 if none
/// could be simulated.
static int find_nearest(const struct formulas_state *state, double *expected) {
    double min = OPTIMISER_FAILED;
    int nearest = 0;
    *expected = INFINITY;
    for (int length = 1; length <= PROGRAMMING_MAX_NODES; length++) {
        const struct formulas_member *member = &state->front[length];
        if (!is_known(state, length))
            continue;
        *expected = fmin(*expected, member->formula.error);
        if (member->error < min)
            nearest = length;
        min = fmin(min, member->error);
    }
    return nearest;
}

/// The shortest formula that is as good as the best by chance: by the simulations, whose noise is
/// their own, and by the response, whose noise is that of the curve.
static void choose(struct formulas_state *state) {
    struct formulas_progress *progress = &state->progress;
    double expected;
    progress->nearest = progress->chosen = find_nearest(state, &expected);
    if (progress->nearest == 0)
        return;
    const struct formulas_member *best = &state->front[progress->nearest];
    for (int length = progress->nearest; length > 0; length--) {
        const struct formulas_member *member = &state->front[length];
        if (is_known(state, length) &&
            member->error <=
                best->error + FORMULAS_CHANCE * sqrt(best->variance + member->variance) &&
            member->formula.error <= hypot(expected, state->points.noise))
            progress->chosen = length;
    }
    const struct formulas_member *chosen = &state->front[progress->chosen];
    char text[EXPRESSION_TEXT_SIZE];
    mf_expression_print(&chosen->formula.expression, EXPRESSION_PLAIN, text);
    snprintf(state->formula, sizeof state->formula, "%.*s", (int)sizeof state->formula - 1, text);
    mf_formulas_make_curve(state, &chosen->formula.expression, state->curve);
    progress->error = chosen->error;
    progress->noise = chosen->noise;
    progress->variance = chosen->variance;
}

enum status mf_formulas_simulate(struct formulas_state *state,
                                 const struct inverse_listener *listener, bool *finished) {
    struct formulas_progress *progress = &state->progress;
    TRY(measure(state, listener));
    choose(state);
    // Nearer than its noise there is nothing left to learn from differences.
    *finished = state->kind == UNKNOWN_OMEGA || progress->nearest == 0 ||
                progress->error <= mf_inverse_noise_margin * progress->noise ||
                progress->cycle + 1 >= (uint32_t)state->own.cycles;
    if (*finished)
        return STATUS_OK;
    compare_with(state, progress->nearest, state->curve, state->y, state->offset);
    mf_formulas_make_curve(state, &state->front[progress->chosen].formula.expression, state->curve);
    TRY(mf_programming_reconsider(&state->programming));
    progress->cycle++;
    progress->stage = FORMULAS_BREED;
    return STATUS_OK;
}

// Tables ------------------------------------------------------------------------------------------

/// Open a file of the run's folder.
static enum status open_in(const struct inverse_folder *folder, const char *name,
                           struct output *output) {
    char path[OUTPUT_PATH_SIZE];
    folder->file(folder->context, name, path);
    return mf_output_open(output, path);
}

/// A formula of the front as its tables tell it, with what it is shifted by.
struct converted {
    struct expression expression;
    double shift;
};

static struct converted convert(const struct formulas_state *state, int nodes,
                                const struct inverse_folder *folder) {
    const double length = mf_units_factor(folder->units, "lambda");
    const double unit = mf_units_factor(folder->units, mf_unknowns_unit(state->kind));
    struct converted converted = {.expression = state->front[nodes].formula.expression};
    if (!isnan(state->points.zero))
        converted.shift =
            unit * mf_expression_value(&converted.expression, state->points.zero, NULL);
    if (length != 1 || unit != 1)
        mf_expression_scale(&converted.expression, length, unit);
    return converted;
}

/// formulas.tsv: a row a formula; the last column is text.
static enum status write_front(const struct formulas_state *state,
                               const struct inverse_folder *folder) {
    struct output output;
    TRY(open_in(folder, "formulas.tsv", &output));
    fprintf(output.stream, "# nodes\tchosen\texpected\terror[1]\terror_error[1]\tformula\n");
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct formulas_member *member = &state->front[k];
        if (member->formula.expression.length == 0)
            continue;
        const bool known = member->measured && member->error < OPTIMISER_FAILED;
        char text[EXPRESSION_TEXT_SIZE];
        const struct converted converted = convert(state, k, folder);
        mf_expression_print(&converted.expression, EXPRESSION_PLAIN, text);
        fprintf(output.stream, "%d\t%d\t%.6g\t%.6g\t%.3g\t%s\n", member->formula.expression.length,
                known && k == state->progress.chosen, member->formula.error,
                known ? member->error : NAN, known ? sqrt(member->variance) : NAN, text);
    }
    return mf_output_commit(&output);
}

/// formulas.tex: an equation a formula.
static enum status write_latex(const struct formulas_state *state,
                               const struct inverse_folder *folder) {
    const char *symbol = state->kind == UNKNOWN_POTENTIAL ? "\\Phi" : "\\omega";
    struct output output;
    TRY(open_in(folder, "formulas.tex", &output));
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct expression *expression = &state->front[k].formula.expression;
        if (expression->length == 0)
            continue;
        const struct converted converted = convert(state, k, folder);
        const double shift = converted.shift;
        char text[EXPRESSION_TEXT_SIZE];
        mf_expression_print(&converted.expression, EXPRESSION_LATEX, text);
        fprintf(output.stream, "%% %d nodes\n\\begin{equation}\n  %s(r) = %s", expression->length,
                symbol, text);
        if (shift != 0)
            fprintf(output.stream, " %s %.10g", shift < 0 ? "+" : "-", fabs(shift));
        fprintf(output.stream, "\n\\end{equation}\n");
    }
    return mf_output_commit(&output);
}

/// formulas.h: a function a formula, named by its nodes.
static enum status write_c(const struct formulas_state *state,
                           const struct inverse_folder *folder) {
    const double last = mf_unknowns_r(
        &state->unknowns, state->kind)[mf_unknowns_points(&state->unknowns, state->kind) - 1];
    const double length = mf_units_factor(folder->units, "lambda");
    struct output output;
    TRY(open_in(folder, "formulas.h", &output));
    fprintf(output.stream, "#include <math.h>\n");
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct expression *expression = &state->front[k].formula.expression;
        if (expression->length == 0)
            continue;
        char text[EXPRESSION_TEXT_SIZE];
        const struct converted converted = convert(state, k, folder);
        mf_expression_print(&converted.expression, EXPRESSION_C, text);
        fprintf(output.stream,
                "\n/* For %.10g <= r < %.10g. */\nstatic inline double formula_%d(double r) {\n"
                "    return %s - (%.17g);\n}\n",
                length * state->points.r[0], length * last, expression->length, text,
                converted.shift);
    }
    return mf_output_commit(&output);
}

enum status mf_formulas_write(const void *memory, const struct inverse_folder *folder) {
    const struct formulas_state *state = memory;
    TRY(write_front(state, folder));
    TRY(write_latex(state, folder));
    return write_c(state, folder);
}
