// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "base/nearest.h"
#include "run/bench.h"

#include <string.h>

enum { JSON, AGAINST_LAMMPS, SKIPS, ISA, PRECISION, OUTPUT };

static const struct command_option options[] = {
    [JSON] = {"--json", NULL, "print a JSON list instead of tables"},
    [AGAINST_LAMMPS] = {"--against-lammps", NULL, "time LAMMPS (lmp) in turn, print the ratio"},
    [SKIPS] = {"--skips", NULL, "time steps with and without each of their parts"},
    [ISA] = {"--isa", "NAME", "portable, avx2 or avx512 alone"},
    [PRECISION] = {"--precision", "NAME", "mixed or double alone"},
    [OUTPUT] = {"-o", "FILE.tsv", "write the results to a table, too"},
    {NULL, NULL, NULL},
};

static enum status run(const struct command_line *line) {
    static const char *const subjects[] = {"engine"};
    char hint[128];
    if (strcmp(line->files[0], subjects[0]) != 0) {
        nearest_hint(line->files[0], subjects, 1, hint, sizeof hint);
        return status_fail(STATUS_BAD_INPUT, "bench: \"%s\" is not known; %s", line->files[0],
                           hint);
    }
    const struct bench_options chosen = {
        .isa = line->own[ISA],
        .precision = line->own[PRECISION],
        .output = line->own[OUTPUT],
        .json = line->own[JSON] != NULL,
        .against_lammps = line->own[AGAINST_LAMMPS] != NULL,
        .skips = line->own[SKIPS] != NULL,
    };
    return bench_engine(line->files + 1, line->file_count - 1, &line->options, &chosen);
}

const struct command cmd_bench = {
    .name = "bench",
    .usage = "engine [SCENE.json...]",
    .summary = "time the engine, by default on the scenes that come with it",
    .least_files = 1,
    .most_files = COMMAND_MAX_FILES,
    .options = options,
    .threads = 1,
    .run = run,
};
