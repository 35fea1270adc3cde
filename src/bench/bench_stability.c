// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/statistics.h"
#include "bench/bench_case.h"
#include "bench/bench_point.h"
#include "observe/thermodynamics.h"
#include "report/figures.h"
#include "report/program.h"
#include "report/progress.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/// Time steps in those of the scene, growing; strengths in those of the scene.
static const double step_factors[] = {1. / 16, 1. / 8, 1. / 4, 1. / 2, 3. / 4, 1,
                                      1.5,     2,      2.5,    3,      4,      5};
enum {
    STEPS = sizeof step_factors / sizeof *step_factors,
    ROWS = 6,
    OWN_ROW = 1, ///< with the scene's own strength
};

static const struct map {
    const char *name;
    double factor[ROWS]; ///< of ω², of Φ
} maps[] = {
    {"friction", {0.25, 1, 4, 16, 64, 256}},
    {"stiffness", {0.25, 1, 2, 4, 8, 16}},
};
enum { FRICTION, STIFFNESS, MAPS };

/// Lengths: of a run [τ], and of the equilibration before in its parts; steps at least.
static const double default_time = 5, equilibration_share = 0.4;
enum { LEAST_STEPS = 200, SAMPLES = 100 };

struct cell {
    double temperature, temperature_error, configurational, configurational_error;
    double energy; ///< of a particle, with its kinetic one: rms about its mean [k_B T_0]
    bool unstable;
};

struct run {
    const struct run_options *common;
    const struct bench_stability_options *options;
    struct progress progress;
    struct bench_scene scene;
    struct bench_method suitable[BENCH_MAX_METHODS], methods[BENCH_MAX_METHODS];
    size_t suitable_count, method_count;
    double time;
    struct table tables[MAPS][ROWS];     ///< of the friction and of the potential
    double *start_values;                ///< shape [ROWS, 6, particles]
    struct simulation_start start[ROWS]; ///< equilibrated with each potential
    bool starts[ROWS];                   ///< it could be
    struct cell *cells;                  ///< shape [MAPS, method_count, ROWS, STEPS]
    uint64_t done;
};

static bool has_map(const struct run *run, int map) {
    const struct simulation_setup *setup = &run->scene.scene.setup;
    return map == FRICTION ? setup->omega != NULL : setup->potential != NULL;
}

static struct cell *cells_of(const struct run *run, size_t map, size_t method, size_t row) {
    return run->cells + ((map * run->method_count + method) * ROWS + row) * STEPS;
}

static double time_step_of(const struct run *run, size_t step) {
    return step_factors[step] * run->scene.scene.setup.time_step;
}

/// The largest ω² of a scene [μ/τ].
static double largest_friction(const struct table *omega) {
    double max = 0;
    for (int k = 0; k < omega->curves * (TABLE_INTERVALS + 1); k++)
        max = fmax(max, omega->precise[k][0] * omega->precise[k][0]);
    return max;
}

static double strength_of(const struct run *run, size_t map, size_t row) {
    return maps[map].factor[row] *
           (map == FRICTION ? largest_friction(run->scene.scene.setup.omega) : 1);
}

// Preparing --------------------------------------------------------------------------------------

static enum status read_scene(struct run *run, const char *file) {
    char folder[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE + 64];
    if (file)
        return mf_bench_scene_read(&run->scene, file, run->options->output, run->common);
    TRY(mf_program_find_folder(folder, sizeof folder, "tests/bench/scenes", "stability.json"));
    snprintf(path, sizeof path, "%s/stability.json", folder);
    return mf_bench_scene_read(&run->scene, path, run->options->output, run->common);
}

static enum status check_scene(const struct run *run) {
    const struct simulation_setup *setup = &run->scene.scene.setup;
    TRY(mf_bench_point_check(setup, run->scene.name, "stability"));
    if (setup->potential == NULL)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: bench stability wants \"conservative\", whose strength it varies",
            run->scene.name);
    for (int k = 0; setup->omega == NULL && k < setup->interactions; k++)
        if (setup->interaction[k].kind->does_work)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: bench stability has no measure: \"%s\" does work, and "
                                  "without \"dissipative\" nothing holds the energy",
                                  run->scene.name, setup->interaction[k].kind->name);
    return STATUS_OK;
}

static enum status choose(struct run *run) {
    const char *text = run->options->time;
    char *end;
    run->suitable_count = mf_bench_methods(&run->scene.scene.setup, run->suitable);
    TRY(mf_bench_methods_listed(run->suitable, run->suitable_count, run->options->integrators,
                                run->methods, &run->method_count));
    run->time = text ? strtod(text, &end) : default_time;
    if (text && (end == text || *end != '\0' || !(run->time > 0) || !isfinite(run->time)))
        return mf_status_fail(STATUS_BAD_INPUT, "--time takes a number above 0");
    return STATUS_OK;
}

static enum status scale_tables(struct run *run) {
    const struct simulation_setup *setup = &run->scene.scene.setup;
    for (int row = 0; row < ROWS; row++) {
        if (setup->omega)
            TRY(mf_table_scale(&run->tables[FRICTION][row], setup->omega,
                               sqrt(maps[FRICTION].factor[row])));
        TRY(mf_table_scale(&run->tables[STIFFNESS][row], setup->potential,
                           maps[STIFFNESS].factor[row]));
    }
    return STATUS_OK;
}

/// All runs of a potential begin with the same configuration: of a stiff one, that of a soft one
/// would be hot. Each begins with that of the next softer one. Rows of friction have that of the
/// scene's own potential.
static enum status equilibrate(struct run *run) {
    enum status status = STATUS_OK;
    const struct scene *scene = &run->scene.scene;
    const size_t particles = (size_t)scene->setup.placement.count;
    struct simulation_setup setup = scene->setup;
    NEW_ARRAY(run->start_values, ROWS * 6 * particles);
    for (size_t row = 0; row < ROWS; row++) {
        double *values = run->start_values + row * 6 * particles;
        setup.potential = &run->tables[STIFFNESS][row];
        const bool own = row == 0 || !run->starts[row - 1];
        setup.placement.kind = own ? scene->setup.placement.kind : PLACEMENT_FILE;
        status =
            mf_bench_point_prepare(&setup, own ? &scene->start : &run->start[row - 1],
                                   mf_bench_reference_method(run->suitable, run->suitable_count),
                                   time_step_of(run, 0), run->time, values);
        run->starts[row] = status == STATUS_OK;
        CHECK(status == STATUS_UNSTABLE ? STATUS_OK : status);
        for (size_t d = 0; d < 3; d++) {
            run->start[row].position[d] = values + d * particles;
            run->start[row].velocity[d] = values + (3 + d) * particles;
        }
    }
done:
    return status;
}

// Running ----------------------------------------------------------------------------------------

static double scatter_of_energy(const struct thermodynamics *thermodynamics) {
    const double *energy = mf_thermodynamics_series(thermodynamics, THERMODYNAMICS_TOTAL_ENERGY);
    struct running_mean mean = {0};
    for (size_t k = 0; k < thermodynamics->series.count; k++)
        mf_statistics_add(&mean, energy[k]);
    return sqrt(mean.squares / mean.count);
}

static enum status measure(const struct simulation_setup *setup,
                           const struct simulation_start *start, double time, struct cell *cell) {
    enum status status = STATUS_OK;
    struct simulation simulation = {0};
    struct thermodynamics thermodynamics;
    double temperature;
    const int64_t steps = (int64_t)fmax(LEAST_STEPS, ceil(time / setup->time_step));
    const struct measure_plan plan = {(int64_t)(equilibration_share * (double)steps), SAMPLES,
                                      steps / SAMPLES};
    const struct observable_use uses[] = {{&mf_thermodynamics_observable, &thermodynamics, NULL},
                                          {NULL, NULL, NULL}};
    mf_thermodynamics_init(&thermodynamics);
    CHECK(mf_simulation_init(&simulation, setup, start));
    CHECK(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    CHECK(mf_measure_sample(&simulation, &plan, uses, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    *cell = (struct cell){.temperature = s.temperature,
                          .temperature_error = s.temperature_error,
                          .configurational = s.temperature_configurational,
                          .configurational_error = s.temperature_configurational_error,
                          .energy = scatter_of_energy(&thermodynamics)};
done:
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    return status;
}

/// One row of one map: time steps grow until one is unstable, and then all that follow are.
static enum status run_row(struct run *run, size_t map, size_t method, size_t row) {
    struct cell *cells = cells_of(run, map, method, row);
    struct simulation_setup setup = run->scene.scene.setup;
    setup.placement.kind = PLACEMENT_FILE;
    setup.threads = 1;
    setup.integrator = run->methods[method].integrator;
    setup.integrator_parameters = run->methods[method].parameters;
    *(map == FRICTION ? &setup.omega : &setup.potential) = &run->tables[map][row];
    const size_t potential = map == STIFFNESS ? row : OWN_ROW;
    bool unstable = !run->starts[potential];
    for (size_t step = 0; step < STEPS; step++) {
        setup.time_step = time_step_of(run, step);
        setup.seed = run->scene.scene.setup.seed + 1 + (uint64_t)(cells + step - run->cells);
        enum status status = unstable
                                 ? STATUS_UNSTABLE
                                 : measure(&setup, &run->start[potential], run->time, &cells[step]);
        unstable = status == STATUS_UNSTABLE;
        cells[step].unstable = unstable;
        if (!unstable)
            TRY(status);
    }
    return STATUS_OK;
}

static size_t count_rows(const struct run *run) {
    return MAPS * run->method_count * ROWS;
}

static enum status run_task(void *context, size_t k, void *result) {
    struct run *run = context;
    const size_t map = k / ROWS / run->method_count;
    (void)result;
    return has_map(run, (int)map) ? run_row(run, map, k / ROWS % run->method_count, k % ROWS)
                                  : STATUS_OK;
}

static void report(void *context, size_t k, const void *result) {
    struct run *run = context;
    (void)k, (void)result;
    mf_progress_report(&run->progress, ++run->done, count_rows(run), "rows", run->scene.name);
}

static enum status run_rows(struct run *run) {
    const int threads = run->common->has_threads ? run->common->threads : omp_get_max_threads();
    mf_progress_report(&run->progress, 0, count_rows(run), "rows", run->scene.name);
    return mf_parallel_try(&(struct parallel_tasks){.count = count_rows(run),
                                                    .threads = threads,
                                                    .run = run_task,
                                                    .take = report,
                                                    .context = run});
}

// Telling ----------------------------------------------------------------------------------------

/// How far the temperature that is farther off is from the set one: a part of it. Without friction
/// energy is conserved but for the time step: how much it scatters, as a part of k_B T.
static double off(const struct run *run, const struct cell *cell) {
    const struct simulation_setup *setup = &run->scene.scene.setup;
    const double set = setup->temperature;
    if (setup->omega == NULL)
        return cell->energy / set;
    return fmax(fabs(cell->temperature - set), fabs(cell->configurational - set)) / set;
}

static void print_map(const struct run *run, size_t map, size_t method) {
    printf("\n%s, %s by time step:\n%10s", run->methods[method].name, maps[map].name, "");
    for (size_t step = 0; step < STEPS; step++)
        printf(" %7.4g", time_step_of(run, step));
    for (size_t row = ROWS; row-- > 0;) {
        printf("\n%10.4g", strength_of(run, map, row));
        for (size_t step = 0; step < STEPS; step++) {
            const struct cell *cell = cells_of(run, map, method, row) + step;
            if (cell->unstable)
                printf(" %7s", "x");
            else
                printf(off(run, cell) < 0.1 ? " %7.2g" : " %7.0f", 100 * off(run, cell));
        }
    }
    printf("\n");
}

static void print(const struct run *run) {
    printf("%s: %lld particles, %g tau a run\n%s [%%]; x: ended as unstable\n", run->scene.name,
           (long long)run->scene.scene.setup.placement.count, run->time,
           run->scene.scene.setup.omega
               ? "how far kinetic and configurational temperature are off, the larger of both"
               : "how much the energy of a particle, which is conserved, scatters, over k_B T");
    for (size_t map = 0; map < MAPS; map++)
        for (size_t method = 0; method < run->method_count; method++)
            if (has_map(run, (int)map))
                print_map(run, map, method);
}

static void write_rows(const struct run *run, size_t map, size_t method, FILE *stream) {
    for (size_t row = 0; row < ROWS; row++)
        for (size_t step = 0; step < STEPS; step++) {
            const struct cell *cell = cells_of(run, map, method, row) + step;
            fprintf(stream, "%s\t%s\t%zu\t%zu\t%.6g\t%.6g\t%.6g\t%.3g\t%.6g\t%.3g\t%.4g\t%d\n",
                    maps[map].name, run->methods[method].name, row, step,
                    strength_of(run, map, row), time_step_of(run, step),
                    cell->unstable ? NAN : cell->temperature, cell->temperature_error,
                    cell->unstable ? NAN : cell->configurational, cell->configurational_error,
                    cell->unstable ? NAN : off(run, cell), cell->unstable);
        }
}

static enum status write_table(const struct run *run) {
    struct output output;
    size_t blocks = 0;
    if (run->options->output == NULL)
        return STATUS_OK;
    TRY(mf_output_open(&output, run->options->output));
    fprintf(output.stream,
            "# %s: %lld particles\n# map\tintegrator\trow\tcolumn\tstrength\ttime_step[tau]\t"
            "temperature[T_0]\ttemperature_error[T_0]\ttemperature_configurational[T_0]\t"
            "temperature_configurational_error[T_0]\toff[1]\tunstable\n",
            run->scene.name, (long long)run->scene.scene.setup.placement.count);
    for (size_t map = 0; map < MAPS; map++)
        for (size_t method = 0; method < run->method_count; method++)
            if (has_map(run, (int)map)) {
                fprintf(output.stream, "%s", blocks++ > 0 ? "\n\n" : "");
                write_rows(run, map, method, output.stream);
            }
    TRY(mf_output_commit(&output));
    if (mf_figures_draw_table(run->options->output, "stability") != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", mf_status_message());
    return STATUS_OK;
}

// Beginning and end ------------------------------------------------------------------------------

static enum status carry_out(struct run *run, const char *file) {
    enum status status = STATUS_OK;
    struct output probe;
    TRY(read_scene(run, file));
    TRY(check_scene(run));
    TRY(choose(run));
    if (run->options->output) { // minutes are not to be lost
        if (!run->common->force)
            TRY(mf_figures_check_table(run->options->output));
        TRY(mf_output_open(&probe, run->options->output));
        mf_output_abandon(&probe);
    }
    NEW_ARRAY(run->cells, MAPS * run->method_count * ROWS * STEPS);
    CHECK(scale_tables(run));
    CHECK(equilibrate(run));
    CHECK(run_rows(run));
    mf_progress_print(&run->progress, "%s: %.0f s", run->scene.name,
                      mf_progress_seconds(&run->progress));
    print(run);
    CHECK(write_table(run));
done:
    return status;
}

enum status mf_bench_stability(const char *file, const struct run_options *common,
                               const struct bench_stability_options *options) {
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
    for (int row = 0; run && row < ROWS; row++) {
        mf_table_clear(&run->tables[FRICTION][row]);
        mf_table_clear(&run->tables[STIFFNESS][row]);
    }
    if (run) {
        mf_memory_free(run->start_values);
        mf_memory_free(run->cells);
        mf_scene_clear(&run->scene.scene);
    }
    mf_memory_free(run);
    return status;
}
