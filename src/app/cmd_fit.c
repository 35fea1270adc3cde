// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "work/fit.h"

enum { EXPLAIN };

static const struct command_option options[] = {
    [EXPLAIN] = {"--explain", NULL, "print what a step will pay for and why; run nothing"},
    {NULL, NULL, NULL},
};

static enum status run(const struct command_line *line) {
    if (line->own[EXPLAIN])
        return mf_fit_explain(line->files[0], &line->options);
    return mf_fit_run(line->files[0], &line->options);
}

const struct command cmd_fit = {
    .name = "fit",
    .usage = "RUN.json",
    .summary = "find the potential that reproduces a target",
    .least_files = 1,
    .most_files = 1,
    .options = options,
    .run = run,
};
