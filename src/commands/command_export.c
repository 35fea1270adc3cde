// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "export/export_engine.h"
#include "report/progress.h"

enum { ENGINE, BANDS, DYNAMICS, PROJECT, TO };

static const struct command_option options[] = {
    [ENGINE] = {"--engine", "lammps|hoomd|espresso|openmm|gromacs|dl_poly|votca",
                "program for the result"},
    [BANDS] = {"--bands", NULL, "also the potential minus and plus one standard error"},
    [DYNAMICS] = {"--dynamics", NULL, "simulate D and E(t, r_0) there"},
    [PROJECT] = {"--project", NULL, "the engine's nearest friction; the deviation is simulated"},
    [TO] = {"-o", "DIR", "folder for its files (default: the engine's name, here)"},
    {NULL, NULL, NULL},
};

/// Who waits is told first what for: files alone would be there at once.
static void report(void *context, const struct simulation *simulation, uint64_t done,
                   uint64_t total) {
    struct progress *const progress = context;
    if (progress->pace.period == 0)
        mf_progress_print(progress,
                          "simulating %llu steps of %zu beads, to tell what D is with the "
                          "friction that runs there",
                          (unsigned long long)total, simulation->particles.count);
    mf_progress_report(progress, done, total, "steps", "with both frictions");
    if (done == total)
        mf_progress_print(progress, "%llu steps with both frictions in %.3g s",
                          (unsigned long long)total, mf_progress_seconds(progress));
}

static enum status run(const struct command_line *line) {
    struct progress progress = mf_progress_begin(line->options.quiet, line->options.watcher);
    if (line->own[ENGINE] == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "--engine: expected one of %s",
                              options[ENGINE].value);
    return mf_export_run(&(struct export_request){
        .from = line->files[0],
        .engine = line->own[ENGINE],
        .to = line->own[TO],
        .bands = line->own[BANDS] != NULL,
        .dynamics = line->own[DYNAMICS] != NULL,
        .project = line->own[PROJECT] != NULL,
        .force = line->options.force,
        .threads = line->options.threads,
        .listener = &(struct measure_listener){.report = report, .context = &progress},
        .stop = line->options.stop,
        .progress = &progress});
}

const struct command mf_command_export = {
    .name = "export",
    .usage = "DIR --engine NAME",
    .summary = "write a result for another engine",
    .min_files = 1,
    .max_files = 1,
    .options = options,
    .run = run,
};
