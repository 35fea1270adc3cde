// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"
#include "base/nearest.h"
#include "bench/bench.h"

#include <omp.h>
#include <string.h>

enum {
    JSON,
    AGAINST_LAMMPS,
    SKIPS,
    ISA,
    PRECISION,
    SECONDS,
    OUTPUT,
    WANTED,
    TIME,
    TIME_STEPS,
    INTEGRATORS,
    OPTIONS
};

static const struct command_option options[] = {
    [JSON] = {"--json", NULL, "print a JSON list instead of tables"},
    [AGAINST_LAMMPS] = {"--against-lammps", NULL, "time LAMMPS in turn"},
    [SKIPS] = {"--skips", NULL, "time steps without each part"},
    [ISA] = {"--isa", "NAME", "portable, avx2, avx512"},
    [PRECISION] = {"--precision", "NAME", "mixed or double alone"},
    [SECONDS] = {"--seconds", "S", "engine: length of a repeat (0.35)"},
    [OUTPUT] = {"-o", "FILE.tsv", "table for the results"},
    [WANTED] = {"--error", "E", "accuracy: largest |dg| wanted (0.005)"},
    [TIME] = {"--time", "T", "accuracy, stability: runs [tau]"},
    [TIME_STEPS] = {"--time-steps", "A,..", "accuracy: time steps [tau]"},
    [INTEGRATORS] = {"--integrators", "A,..", "accuracy, stability: only these"},
    {NULL, NULL, NULL},
};

/// Refuse what belongs to the other subject.
static enum status check_options(const struct command_line *line, const char *subject,
                                 const int *foreign) {
    for (; *foreign < OPTIONS; foreign++)
        if (line->own[*foreign])
            return mf_status_fail(STATUS_BAD_INPUT, "bench %s takes no %s", subject,
                                  options[*foreign].name);
    return STATUS_OK;
}

static enum status run_engine(const struct command_line *line) {
    static const int foreign[] = {WANTED, TIME, TIME_STEPS, INTEGRATORS, OPTIONS};
    TRY(check_options(line, "engine", foreign));
    const struct bench_options chosen = {
        .isa = line->own[ISA],
        .precision = line->own[PRECISION],
        .output = line->own[OUTPUT],
        .seconds = line->own[SECONDS],
        .json = line->own[JSON] != NULL,
        .against_lammps = line->own[AGAINST_LAMMPS] != NULL,
        .skips = line->own[SKIPS] != NULL,
    };
    return mf_bench_engine(line->files + 1, line->file_count - 1, &line->options, &chosen);
}

static enum status run_accuracy(const struct command_line *line) {
    static const int foreign[] = {AGAINST_LAMMPS, SKIPS, ISA, PRECISION, SECONDS, OPTIONS};
    TRY(check_options(line, "accuracy", foreign));
    if (line->file_count != 2)
        return mf_status_fail(STATUS_BAD_INPUT, "usage: mesofit bench accuracy SCENE.json");
    const struct bench_accuracy_options chosen = {
        .output = line->own[OUTPUT],
        .error = line->own[WANTED],
        .time = line->own[TIME],
        .time_steps = line->own[TIME_STEPS],
        .integrators = line->own[INTEGRATORS],
        .json = line->own[JSON] != NULL,
    };
    struct run_options common = line->options;
    if (!common.has_threads)
        common.threads = omp_get_max_threads();
    return mf_bench_accuracy(line->files[1], &common, &chosen);
}

static enum status run_stability(const struct command_line *line) {
    static const int foreign[] = {JSON,    AGAINST_LAMMPS, SKIPS,      ISA,    PRECISION,
                                  SECONDS, WANTED,         TIME_STEPS, OPTIONS};
    TRY(check_options(line, "stability", foreign));
    if (line->file_count > 2)
        return mf_status_fail(STATUS_BAD_INPUT, "usage: mesofit bench stability [SCENE.json]");
    const struct bench_stability_options chosen = {
        .output = line->own[OUTPUT],
        .time = line->own[TIME],
        .integrators = line->own[INTEGRATORS],
    };
    return mf_bench_stability(line->file_count == 2 ? line->files[1] : NULL, &line->options,
                              &chosen);
}

static enum status run_samplers(const struct command_line *line) {
    static const int foreign[] = {JSON,   AGAINST_LAMMPS, SKIPS, ISA,        PRECISION,   SECONDS,
                                  OUTPUT, WANTED,         TIME,  TIME_STEPS, INTEGRATORS, OPTIONS};
    TRY(check_options(line, "samplers", foreign));
    if (line->file_count != 2)
        return mf_status_fail(STATUS_BAD_INPUT, "usage: mesofit bench samplers SCENE.json");
    return mf_bench_samplers(line->files[1], &line->options);
}

static enum status run(const struct command_line *line) {
    static const char *const subjects[] = {"engine", "accuracy", "stability", "samplers"};
    char hint[128];
    if (strcmp(line->files[0], subjects[0]) == 0)
        return run_engine(line);
    if (strcmp(line->files[0], subjects[1]) == 0)
        return run_accuracy(line);
    if (strcmp(line->files[0], subjects[2]) == 0)
        return run_stability(line);
    if (strcmp(line->files[0], subjects[3]) == 0)
        return run_samplers(line);
    mf_nearest_hint(line->files[0], subjects, 4, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "bench: \"%s\" is not known; %s", line->files[0], hint);
}

const struct command cmd_bench = {
    .name = "bench",
    .usage = "engine|accuracy|stability|samplers [SCENE...]",
    .summary = "costs of the engine, time steps, samplers",
    .min_files = 1,
    .max_files = SIZE_MAX,
    .options = options,
    .threads = 1,
    .run = run,
};
