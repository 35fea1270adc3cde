// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "run/simulate.h"

static enum status run(const struct command_line *line) {
    return simulate_file(line->files[0], &line->options);
}

const struct command cmd_simulate = {
    .name = "simulate",
    .usage = "SCENE.json",
    .summary = "run a scene and measure it",
    .least_files = 1,
    .most_files = 1,
    .run = run,
};
