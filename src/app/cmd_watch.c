// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "watch/watch.h"

static enum status run(const struct command_line *line) {
    return mf_watch(line->files[0]);
}

const struct command cmd_watch = {
    .name = "watch",
    .usage = "DIR",
    .summary = "see on a terminal what a run writes into its folder; q quits",
    .least_files = 1,
    .most_files = 1,
    .run = run,
};
