// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "bench/bench_accuracy_output.h"
#include "bench/bench_case.h"
#include "report/figures.h"
#include "report/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_STEPS = 32 };

/// Time steps in those of the scene.
static const double factors[] = {0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5, 3, 4};
enum { FACTORS = sizeof factors / sizeof *factors };

/// Length of a point: so many time steps of the scene with so many particles.
static const double default_steps = 7500, default_particles = 3000;
static const double default_error = 0.005;
/// The reference takes half the smallest step and four times as long.
static const double reference_step = 0.5, reference_length = 4;
/// The scene is equilibrated for this part of a point's time before all.
static const double preparation_share = 0.2;

struct run {
    const struct run_options *common;
    const struct bench_accuracy_options *options;
    struct progress progress;
    struct bench_scene scene;
    struct bench_method suitable[BENCH_MAX_METHODS], methods[BENCH_MAX_METHODS];
    size_t suitable_count, method_count;
    double time_steps[MAX_STEPS], unstable_from[BENCH_MAX_METHODS];
    size_t step_count;
    double time, wanted;
    double *start_values; ///< shape [6, particles]
    struct simulation_start start;
    struct bench_common points_common;
    struct bench_point reference, *points; ///< shape [method_count, step_count]
    struct bench_row *rows;
    size_t row_count;
    struct bench_limit limit[BENCH_MAX_METHODS];
    uint64_t steps_done, steps_total;
};

// Options -----------------------------------------------------------------------------------------

static enum status parse_number(const char *option, const char *text, double *number) {
    char *end;
    *number = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(*number) || *number <= 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes a number above 0", option);
    return STATUS_OK;
}

static enum status parse_time_steps(struct run *run, const char *text) {
    for (char *end; run->step_count < MAX_STEPS; text = end + 1) {
        const double step = strtod(text, &end);
        const double before = run->step_count > 0 ? run->time_steps[run->step_count - 1] : 0;
        if (end == text || (*end != '\0' && *end != ',') || !isfinite(step) || step <= before)
            break;
        run->time_steps[run->step_count++] = step;
        if (*end == '\0')
            return STATUS_OK;
    }
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "--time-steps takes growing numbers above 0, such as 0.01,0.02, %d at most", MAX_STEPS);
}

static enum status choose(struct run *run) {
    const struct bench_accuracy_options *options = run->options;
    const struct simulation_setup *setup = &run->scene.scene.setup;
    TRY(mf_bench_point_check(setup, run->scene.name, "accuracy"));
    run->suitable_count = mf_bench_methods(setup, run->suitable);
    TRY(mf_bench_methods_listed(run->suitable, run->suitable_count, options->integrators,
                                run->methods, &run->method_count));
    run->wanted = default_error;
    run->time =
        default_steps * setup->time_step * default_particles / (double)setup->placement.count;
    if (options->error)
        TRY(parse_number("--error", options->error, &run->wanted));
    if (options->time)
        TRY(parse_number("--time", options->time, &run->time));
    if (options->time_steps)
        return parse_time_steps(run, options->time_steps);
    for (; run->step_count < FACTORS; run->step_count++)
        run->time_steps[run->step_count] = factors[run->step_count] * setup->time_step;
    return STATUS_OK;
}

// Running -----------------------------------------------------------------------------------------

/// Count steps, from any thread.
static void report(void *context, uint64_t steps) {
    struct run *run = context;
#pragma omp critical
    {
        run->steps_done += steps;
        mf_progress_report(&run->progress, run->steps_done, run->steps_total, "steps",
                           run->scene.name);
    }
}

/// All points begin with the same equilibrated configuration: without ω with the same energy.
static enum status prepare(struct run *run) {
    const struct scene *scene = &run->scene.scene;
    const size_t particles = (size_t)scene->setup.placement.count;
    const struct bench_method *method =
        mf_bench_reference_method(run->suitable, run->suitable_count);
    const struct simulation_start *start =
        scene->setup.placement.kind == PLACEMENT_FILE ? &scene->start : NULL;
    TRY_ARRAY(run->start_values, 6 * particles);
    mf_progress_report(&run->progress, 0, run->steps_total, "steps", run->scene.name);
    TRY(mf_bench_point_prepare(&scene->setup, start, method, run->time_steps[0],
                               preparation_share * run->time, run->start_values));
    for (size_t d = 0; d < 3; d++) {
        run->start.position[d] = run->start_values + d * particles;
        run->start.velocity[d] = run->start_values + (3 + d) * particles;
    }
    return STATUS_OK;
}

static enum status plan(struct run *run) {
    const struct simulation_setup *setup = &run->scene.scene.setup;
    const struct pair_law law = {.potential = setup->potential, .omega = setup->omega};
    const size_t points = run->method_count * run->step_count;
    TRY_ARRAY(run->points, points);
    TRY_ARRAY(run->rows, points);
    run->points_common = (struct bench_common){
        .setup = setup,
        .start = &run->start,
        .bins =
            mf_bench_bins_choose(&setup->box, (size_t)setup->placement.count, mf_pair_cutoff(&law)),
        .report = report,
        .context = run};
    run->reference = (struct bench_point){
        .method = mf_bench_reference_method(run->suitable, run->suitable_count),
        .time_step = reference_step * run->time_steps[0],
        .time = reference_length * run->time,
        .seed = setup->seed};
    run->steps_total = mf_bench_point_steps(&run->points_common, &run->reference);
    for (size_t k = 0; k < points; k++) {
        run->points[k] = (struct bench_point){.method = &run->methods[k / run->step_count],
                                              .time_step = run->time_steps[k % run->step_count],
                                              .time = run->time,
                                              .seed = setup->seed + 1 + k};
        run->steps_total += mf_bench_point_steps(&run->points_common, &run->points[k]);
    }
    for (size_t m = 0; m < run->method_count; m++)
        run->unstable_from[m] = INFINITY;
    return STATUS_OK;
}

/// The longest first, then time step by time step: what is compared runs at about the same time.
static struct bench_point *task(struct run *run, size_t k) {
    if (k == 0)
        return &run->reference;
    const size_t method = (k - 1) % run->method_count, step = (k - 1) / run->method_count;
    return &run->points[method * run->step_count + step];
}

/// Run a point, unless a smaller time step of its method was unstable. What an unstable one leaves
/// undone is no longer to be waited for.
static enum status run_point(struct run *run, struct bench_point *point) {
    enum status status = STATUS_OK;
    if (point == &run->reference)
        return mf_bench_point_run(&run->points_common, point);
    const size_t method = (size_t)(point->method - run->methods);
    const uint64_t planned = mf_bench_point_steps(&run->points_common, point);
    double unstable_from;
#pragma omp critical
    unstable_from = run->unstable_from[method];
    point->status = STATUS_UNSTABLE;
    if (point->time_step <= unstable_from)
        status = mf_bench_point_run(&run->points_common, point);
    if (status != STATUS_OK || point->status == STATUS_OK)
        return status;
#pragma omp critical
    {
        run->unstable_from[method] = fmin(run->unstable_from[method], point->time_step);
        run->steps_total -= planned - point->reported;
    }
    return STATUS_OK;
}

static enum status run_task(void *context, size_t k, void *result) {
    (void)result;
    return run_point(context, task(context, k));
}

static enum status run_points(struct run *run) {
    TRY(mf_parallel_try(&(struct parallel_tasks){.count = 1 + run->method_count * run->step_count,
                                                 .threads = run->common->threads,
                                                 .run = run_task,
                                                 .context = run}));
    if (run->reference.status != STATUS_OK)
        return mf_status_fail(STATUS_UNSTABLE,
                              "the reference is unstable at a time step of %g; lower \"time_step\"",
                              run->reference.time_step);
    return STATUS_OK;
}

// Results -----------------------------------------------------------------------------------------

/// Rows and limit of one method, up to its first unstable time step.
static void assess(struct run *run, size_t method) {
    const struct bench_point *points = run->points + method * run->step_count;
    const struct bench_row *first = run->rows + run->row_count;
    size_t count = 0;
    for (; count < run->step_count && points[count].status == STATUS_OK; count++)
        run->rows[run->row_count++] = mf_bench_row_of(&points[count], &run->reference,
                                                      run->points_common.bins.count, run->wanted);
    run->limit[method] = mf_bench_limit_of(first, count, run->wanted);
}

static enum status write_table(struct run *run, const struct bench_diagram *diagram) {
    struct output output;
    if (run->options->output == NULL)
        return STATUS_OK;
    TRY(mf_output_open(&output, run->options->output));
    mf_bench_accuracy_tsv(output.stream, diagram);
    TRY(mf_output_commit(&output));
    if (mf_figures_draw_table(run->options->output, "accuracy") != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", mf_status_message());
    return STATUS_OK;
}

static enum status write_report(struct run *run) {
    const char *names[BENCH_MAX_METHODS];
    const size_t bins = run->points_common.bins.count;
    const struct bench_extrapolation to_zero = mf_bench_extrapolate(
        &run->reference, run->points, run->method_count * run->step_count, bins);
    for (size_t m = 0; m < run->method_count; m++) {
        names[m] = run->methods[m].name;
        assess(run, m);
    }
    const struct bench_diagram diagram = {
        .scene = run->scene.name,
        .particles = (size_t)run->scene.scene.setup.placement.count,
        .wanted = run->wanted,
        .time = run->time,
        .reference_time = run->reference.time,
        .extrapolation = to_zero,
        .row = run->rows,
        .rows = run->row_count,
        .reference = mf_bench_row_of(&run->reference, &run->reference, bins, run->wanted),
        .limit = run->limit,
        .method = names,
        .methods = run->method_count,
        .has_omega = run->scene.scene.setup.omega != NULL};
    mf_progress_print(&run->progress, "%s: %.0f s", run->scene.name,
                      mf_progress_seconds(&run->progress));
    if (run->options->json)
        TRY(mf_bench_accuracy_json(stdout, &diagram));
    else
        mf_bench_accuracy_table(stdout, &diagram);
    return write_table(run, &diagram);
}

static enum status carry_out(struct run *run, const char *file) {
    struct output probe;
    TRY(mf_bench_scene_read(&run->scene, file, run->options->output, run->common));
    if (composition_is_mixed(&run->scene.scene.setup.composition))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: particles.types: bench accuracy needs a single component", file);
    if (!simulation_has_velocities(&run->scene.scene.setup))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: dynamics.integrator: bench accuracy needs velocities, which \"%s\" does not have",
            file, run->scene.scene.setup.integrator->name);
    TRY(choose(run));
    if (run->options->output) { // two minutes are not to be lost
        if (!run->common->force)
            TRY(mf_figures_check_table(run->options->output));
        TRY(mf_output_open(&probe, run->options->output));
        mf_output_abandon(&probe);
    }
    TRY(plan(run));
    enum status status = prepare(run);
    if (status == STATUS_OK)
        status = run_points(run);
    if (status != STATUS_OK && status != STATUS_INTERRUPTED)
        return mf_status_prefix(status, "%s", file);
    TRY(status);
    return write_report(run);
}

enum status mf_bench_accuracy(const char *file, const struct run_options *common,
                              const struct bench_accuracy_options *options) {
    enum status status = STATUS_OK;
    struct run *run = NULL;
    NEW_ARRAY(run, 1);
    run->common = common;
    run->options = options;
    run->progress = mf_progress_begin(common->quiet, NULL);
    if (!run->progress.terminal)
        run->progress.quiet = RUN_SAYS_NOTHING; // nothing but results goes into a pipe
    status = carry_out(run, file);
done:
    if (run) {
        for (size_t k = 0; run->points && k < run->method_count * run->step_count; k++)
            mf_memory_free(run->points[k].g);
        mf_memory_free(run->reference.g);
        mf_memory_free(run->points);
        mf_memory_free(run->rows);
        mf_memory_free(run->start_values);
        mf_scene_clear(&run->scene.scene);
    }
    mf_memory_free(run);
    return status;
}
