// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"
#include "report/figures.h"

static enum status run(const struct command_line *line) {
    return mf_figures_draw_again(line->files[0], line->options.force);
}

const struct command cmd_plot = {
    .name = "plot",
    .usage = "DIR",
    .summary = "draw a run's figures again",
    .min_files = 1,
    .max_files = 1,
    .run = run,
};
