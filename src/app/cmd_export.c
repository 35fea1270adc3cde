// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"
#include "export/export_engine.h"

enum { ENGINE, BANDS, PROJECT, TO };

static const struct command_option options[] = {
    [ENGINE] = {"--engine", "lammps|hoomd|espresso|openmm|gromacs|dl_poly|votca",
                "program that is to run the result"},
    [BANDS] = {"--bands", NULL, "also the potential less and plus one standard error"},
    [PROJECT] = {"--project", NULL,
                 "the nearest friction that the engine has; simulates what that costs"},
    [TO] = {"-o", "DIR", "folder for its files (default: the engine's name, here)"},
    {NULL, NULL, NULL},
};

static enum status run(const struct command_line *line) {
    if (line->own[ENGINE] == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "--engine says for what program; one of %s",
                              options[ENGINE].value);
    return mf_export_run(&(struct export_request){.from = line->files[0],
                                                  .engine = line->own[ENGINE],
                                                  .to = line->own[TO],
                                                  .bands = line->own[BANDS] != NULL,
                                                  .project = line->own[PROJECT] != NULL,
                                                  .quiet = line->options.quiet,
                                                  .threads = line->options.threads});
}

const struct command cmd_export = {
    .name = "export",
    .usage = "DIR --engine NAME",
    .summary = "write a result as files that another engine runs",
    .least_files = 1,
    .most_files = 1,
    .options = options,
    .run = run,
};
