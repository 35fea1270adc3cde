// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "run/fit.h"

static enum status run(const struct command_line *line) {
    return fit_run(line->files[0], &line->options);
}

const struct command cmd_fit = {
    .name = "fit",
    .usage = "RUN.json",
    .summary = "find the potential that reproduces a target",
    .least_files = 1,
    .most_files = 1,
    .run = run,
};
