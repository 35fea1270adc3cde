// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "work/simulate.h"

enum { EXPLAIN, LIVE };

static const struct command_option options[] = {
    [EXPLAIN] = {"--explain", NULL, "print what will be done and what it costs; run nothing"},
    [LIVE] = COMMAND_LIVE_OPTION,
    {NULL, NULL, NULL},
};

static enum status run(const struct command_line *line) {
    if (line->own[EXPLAIN])
        TRY(mf_command_check_live(line, "--explain"));
    if (line->own[LIVE])
        TRY(mf_command_check_live(line, "--live"));
    if (line->own[EXPLAIN])
        return mf_simulate_explain(line->files[0], &line->options);
    if (line->own[LIVE])
        return line->live(line->files[0], &line->options, line->own[LIVE]);
    return mf_simulate_file(line->files[0], &line->options);
}

const struct command mf_command_simulate = {
    .name = "simulate",
    .usage = "SCENE.json",
    .summary = "run a scene and measure it",
    .min_files = 1,
    .max_files = 1,
    .options = options,
    .run = run,
};
