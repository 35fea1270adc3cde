// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"
#include "report/compare.h"

static enum status run(const struct command_line *line) {
    return mf_compare_folders(line->files, line->file_count,
                              line->options.folder ? line->options.folder : "compare",
                              line->options.force, line->options.quiet);
}

const struct command cmd_compare = {
    .name = "compare",
    .usage = "DIR DIR...",
    .summary = "compare fits and simulations: a table, a figure",
    .min_files = 1,
    .max_files = SIZE_MAX,
    .run = run,
};
