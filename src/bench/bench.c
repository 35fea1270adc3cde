// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench.h"

#include "base/memory.h"
#include "base/nearest.h"
#include "base/simd.h"
#include "bench/bench_case.h"
#include "bench/bench_lammps.h"
#include "bench/bench_output.h"
#include "report/program.h"
#include "report/progress.h"

#include <stdlib.h>
#include <string.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64,
    MAX_KERNELS = 3,
    MAX_PRECISIONS = 2,
    MAX_CASES = MAX_KERNELS * MAX_PRECISIONS, ///< of a scene
};

/// Seconds of one repeat, alone and in turn with LAMMPS.
static const double repeat_seconds = 0.35, turn_seconds = 1, most_seconds = 1000;

static const char *const kernels[MAX_KERNELS] = {"portable", "avx2", "avx512"};
static const char *const precisions[MAX_PRECISIONS] = {"mixed", "double"};

/// The scenes that ship with the program.
static const char scenes_folder[] = "tests/bench/scenes";
static const char *const shipped[] = {"thesis",        "thesis-conservative", "standard-dpd",
                                      "lennard-jones", "local-density",       "chains"};
enum { SHIPPED = sizeof shipped / sizeof *shipped };

struct run {
    const struct run_options *common;
    const struct bench_options *options;
    struct progress progress;
    struct bench_scene *scenes;
    size_t scene_count;
    struct bench_how hows[MAX_CASES];
    size_t how_count;
    double seconds;               ///< of a repeat
    struct bench_result *results; ///< shape [scene_count × how_count]
    size_t result_count;
    uint64_t parts_done;
};

// What to time ------------------------------------------------------------------------------------

/// Add one kernel with every precision that is asked for.
static void add_kernel(struct run *run, const char *isa) {
    for (size_t k = 0; k < MAX_PRECISIONS; k++) {
        const char *wanted = run->options->precision;
        if (wanted && strcmp(wanted, precisions[k]) != 0)
            continue;
        run->hows[run->how_count++] = (struct bench_how){
            .isa = isa,
            .precision = precisions[k],
            .threads = run->common->threads,
            .seconds = run->seconds,
        };
    }
}

static enum status check_choice(const char *option, const char *given, const char *const *known,
                                size_t count) {
    char hint[128];
    for (size_t k = 0; k < count; k++)
        if (given == NULL || strcmp(given, known[k]) == 0)
            return STATUS_OK;
    mf_nearest_hint(given, known, count, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "%s: \"%s\" is not known; %s", option, given, hint);
}

static enum status choose_seconds(struct run *run) {
    const struct bench_options *options = run->options;
    char *end;
    run->seconds = options->against_lammps ? turn_seconds : repeat_seconds;
    if (options->seconds == NULL)
        return STATUS_OK;
    run->seconds = strtod(options->seconds, &end);
    if (*end == '\0' && run->seconds > 0 && run->seconds <= most_seconds)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "--seconds: expected a number above 0, at most %g, not \"%s\"",
                          most_seconds, options->seconds);
}

static enum status choose_cases(struct run *run) {
    const struct bench_options *options = run->options;
    TRY(choose_seconds(run));
    TRY(check_choice("--isa", options->isa, kernels, MAX_KERNELS));
    TRY(check_choice("--precision", options->precision, precisions, MAX_PRECISIONS));
    if (options->isa && !mf_simd_select(options->isa))
        return mf_status_fail(STATUS_BAD_INPUT, "--isa: this processor lacks %s", options->isa);
    if (options->isa || options->against_lammps || options->skips) {
        add_kernel(run, mf_simd_name());
        return STATUS_OK;
    }
    for (size_t k = 0; k < MAX_KERNELS; k++)
        if (mf_simd_select(kernels[k]))
            add_kernel(run, kernels[k]);
    return STATUS_OK;
}

// Scenes ------------------------------------------------------------------------------------------

static enum status read_shipped(struct run *run) {
    char folder[PATH_SIZE], file[PATH_SIZE + 64];
    TRY(mf_program_find_folder(folder, sizeof folder, scenes_folder, "thesis.json"));
    for (size_t k = 0; k < SHIPPED; k++) {
        snprintf(file, sizeof file, "%s/%s.json", folder, shipped[k]);
        TRY(mf_bench_scene_read(&run->scenes[k], file, run->options->output, run->common));
    }
    return STATUS_OK;
}

static enum status read_scenes(struct run *run, const char *const *files, size_t count) {
    run->scene_count = count > 0 ? count : SHIPPED;
    TRY_ARRAY(run->scenes, run->scene_count);
    if (count == 0)
        TRY(read_shipped(run));
    for (size_t k = 0; k < count; k++)
        TRY(mf_bench_scene_read(&run->scenes[k], files[k], run->options->output, run->common));
    TRY_ARRAY(run->results, run->scene_count * run->how_count);
    return STATUS_OK;
}

// Timing ------------------------------------------------------------------------------------------

static void report(struct run *run, const struct bench_scene *scene, const struct bench_how *how) {
    const uint64_t cases = run->scene_count * run->how_count;
    const uint64_t parts = run->options->against_lammps ? 1 : 1 + BENCH_REPEATS;
    char text[BENCH_NAME_SIZE + 32];
    snprintf(text, sizeof text, "%s  %s  %s", scene->name, how->isa, how->precision);
    mf_progress_report(&run->progress, run->parts_done++, parts * cases, "runs", text);
}

static enum status time_alone(struct run *run, struct bench_case *bench,
                              const struct bench_scene *scene, struct bench_result *result) {
    for (int k = 0; k < BENCH_REPEATS; k++) {
        report(run, scene, &bench->how);
        TRY(mf_bench_case_repeat(bench));
    }
    mf_bench_case_result(bench, scene->name, result);
    return STATUS_OK;
}

static enum status time_case(struct run *run, const struct bench_scene *scene,
                             const struct bench_how *how) {
    struct bench_case bench;
    struct bench_result *result = &run->results[run->result_count];
    report(run, scene, how);
    enum status status = mf_bench_case_begin(&bench, scene, how);
    if (status == STATUS_OK)
        status = run->options->against_lammps ? mf_bench_lammps_compare(&bench, scene, result)
                                              : time_alone(run, &bench, scene, result);
    mf_bench_case_clear(&bench);
    if (status != STATUS_OK && status != STATUS_INTERRUPTED)
        return mf_status_prefix(status, "%s", scene->name);
    run->result_count += status == STATUS_OK;
    return status;
}

/// True, after a word about it, if LAMMPS cannot do the scene.
static bool is_left_out(struct run *run, const struct bench_scene *scene) {
    const char *unsupported = mf_bench_lammps_unsupported(&scene->scene);
    if (!run->options->against_lammps || unsupported == NULL)
        return false;
    if (!run->common->quiet)
        fprintf(stderr, "%s is not compared: %s\n", scene->name, unsupported);
    run->parts_done += run->how_count;
    return true;
}

static enum status time_scene(struct run *run, const struct bench_scene *scene) {
    const struct bench_result *first = run->results + run->result_count;
    for (size_t k = 0; k < run->how_count; k++)
        TRY(time_case(run, scene, &run->hows[k]));
    mf_progress_print(&run->progress, "%s: %.0f s", scene->name,
                      mf_progress_seconds(&run->progress));
    if (run->options->json)
        return STATUS_OK;
    if (first > run->results)
        printf("\n");
    TRY(mf_bench_output_table(stdout, first, run->how_count, run->options->against_lammps));
    fflush(stdout);
    return STATUS_OK;
}

static enum status time_skips(struct run *run, FILE *table) {
    if (table)
        mf_bench_skips_head(table);
    for (size_t s = 0; s < run->scene_count; s++)
        for (size_t k = 0; k < run->how_count; k++) {
            const enum status status =
                mf_bench_skips(stdout, table, &run->scenes[s], &run->hows[k]);
            if (status != STATUS_OK && status != STATUS_INTERRUPTED)
                return mf_status_prefix(status, "%s", run->scenes[s].name);
            TRY(status);
        }
    return STATUS_OK;
}

static enum status time_scenes(struct run *run) {
    for (size_t k = 0; k < run->scene_count; k++)
        if (!is_left_out(run, &run->scenes[k]))
            TRY(time_scene(run, &run->scenes[k]));
    return run->options->json ? mf_bench_output_json(stdout, run->results, run->result_count)
                              : STATUS_OK;
}

static enum status prepare(struct run *run, const char *const *files, size_t count) {
    if (run->options->skips && (run->options->json || run->options->against_lammps))
        return mf_status_fail(STATUS_BAD_INPUT, "--skips goes with neither --json nor "
                                                "--against-lammps; -o FILE.tsv writes its table");
    TRY(choose_cases(run));
    TRY(read_scenes(run, files, count));
    if (!run->options->against_lammps)
        return STATUS_OK;
    if (run->common->threads > 1)
        return mf_status_fail(STATUS_BAD_INPUT, "--against-lammps compares single threads");
    return mf_bench_lammps_check();
}

/// Time all scenes, the file for the results being open already, so that two minutes are not lost.
static enum status time_to_file(struct run *run) {
    struct output output;
    const bool skips = run->options->skips;
    if (run->options->output == NULL)
        return skips ? time_skips(run, NULL) : time_scenes(run);
    TRY(mf_output_open(&output, run->options->output));
    const enum status status = skips ? time_skips(run, output.stream) : time_scenes(run);
    if (status != STATUS_OK) {
        mf_output_abandon(&output);
        return status;
    }
    if (!skips)
        mf_bench_output_tsv(output.stream, run->results, run->result_count);
    return mf_output_commit(&output);
}

enum status mf_bench_engine(const char *const *files, size_t count,
                            const struct run_options *common, const struct bench_options *options) {
    struct run run = {.common = common, .options = options};
    run.progress = mf_progress_begin(common->quiet, NULL);
    if (!run.progress.terminal)
        run.progress.quiet = RUN_SAYS_NOTHING; // nothing but results goes into a pipe
    enum status status = prepare(&run, files, count);
    if (status == STATUS_OK)
        status = time_to_file(&run);
    for (size_t k = 0; run.scenes && k < run.scene_count; k++)
        mf_scene_clear(&run.scenes[k].scene);
    mf_memory_free(run.scenes);
    mf_memory_free(run.results);
    return status;
}
