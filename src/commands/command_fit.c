// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "base/memory.h"
#include "base/ranks.h"
#include "io/json_fill.h"
#include "io/output.h"
#include "io/text_file.h"
#include "work/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXPLAIN, RANKS, TARGET, DENSITY, TEMPERATURE, FRICTION, LIVE };

/// Of --explain.
enum { MAX_RANKS = 100000 };

static const struct command_option options[] = {
    [EXPLAIN] = {"--explain", NULL, "print what will be done and what it costs; run nothing"},
    [RANKS] = {"--ranks", "N", "with --explain: speed-up of N processes of an MPI job"},
    [TARGET] = {"--target", "DIR", "folder of target.json; with the next two rdf.tsv is enough"},
    [DENSITY] = {"--density", "NUMBER", "number density of the beads, without target.json"},
    [TEMPERATURE] = {"--temperature", "NUMBER",
                     "temperature of the target, without target.json; else 1"},
    [FRICTION] = {"--friction", "free|exportable|linear",
                  "omega: any, one that LAMMPS runs, or HOOMD and ESPResSo too"},
    [LIVE] = COMMAND_LIVE_OPTION,
    {NULL, NULL, NULL},
};

/// The fit, with the other processes of an MPI job if there are some.
static enum status run_shared(const char *file, const struct command_line *line) {
    struct run_options own = line->options;
    TRY(mf_ranks_begin());
    own.quiet = ranks_lead() ? own.quiet : RUN_SAYS_NOTHING;
    const enum status status =
        line->own[LIVE] && mf_ranks_count() > 1
            ? mf_status_fail(STATUS_BAD_INPUT, "--live is for a fit in one process; progress.json "
                                               "in the folder shows the progress of any")
        : line->own[LIVE] ? line->live(file, &own, line->own[LIVE])
                          : mf_fit_run(file, &own);
    mf_ranks_end();
    return status;
}

static enum status parse_positive(const char *option, const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !(*value > 0) || isinf(*value))
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes a number above 0", option);
    return STATUS_OK;
}

static enum status run_whole(const char *file, const struct command_line *line) {
    double ranks = 0;
    if (line->own[RANKS] && !line->own[EXPLAIN])
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "--ranks is for --explain; mpirun -np sets the number of processes of a fit");
    if (line->own[RANKS])
        TRY(parse_positive("--ranks", line->own[RANKS], &ranks));
    if (ranks != floor(ranks) || ranks > MAX_RANKS)
        return mf_status_fail(STATUS_BAD_INPUT, "--ranks takes a whole number from 1 to %d",
                              MAX_RANKS);
    return line->own[EXPLAIN] ? mf_fit_explain(file, &line->options, (int)ranks)
                              : run_shared(file, line);
}

/// The file with what the command line puts into it.
static enum status run_with(const char *file, const char *text, const struct command_line *line,
                            enum status (*run_it)(const char *, const struct command_line *)) {
    const struct memory_file memory_files = {file, text};
    mf_text_file_set_memory_files(&memory_files, 1);
    const enum status status = run_it(file, line);
    mf_text_file_set_memory_files(NULL, 0);
    return status;
}

static enum status run_file(const char *file, const struct command_line *line) {
    const struct json_filling friction = {.key = "friction", .text = line->own[FRICTION]};
    char *text;
    if (friction.text == NULL)
        return run_whole(file, line);
    TRY(mf_json_fill(file, NULL, &friction, 1, &text));
    const enum status status = run_with(file, text, line, run_whole);
    mf_memory_free(text);
    return status;
}

/// A run file that nobody wrote: g(r) of the folder, density and temperature.
static enum status run_rdf(const char *file, const char *rdf, const struct command_line *line) {
    double density = 0, temperature = 1;
    char text[256];
    if (access(rdf, R_OK) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--target: %s not found, nor rdf.tsv for use with --density", file);
    if (line->own[DENSITY] == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--target: %s not found: give --density and --temperature instead",
                              file);
    TRY(parse_positive("--density", line->own[DENSITY], &density));
    if (line->own[TEMPERATURE])
        TRY(parse_positive("--temperature", line->own[TEMPERATURE], &temperature));
    snprintf(text, sizeof text,
             "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}}, "
             "\"scene\": {\"density\": %.17g, \"temperature\": %.17g}}",
             density, temperature);
    return run_with(file, text, line, run_file);
}

/// The folder's target.json with what the command line says and the file does not.
static enum status run_filled(const char *file, const struct command_line *line) {
    struct json_filling filling[2];
    size_t count = 0;
    char *text;
    if (line->own[DENSITY]) {
        filling[count].key = "density";
        TRY(parse_positive("--density", line->own[DENSITY], &filling[count++].value));
    }
    if (line->own[TEMPERATURE]) {
        filling[count].key = "temperature";
        TRY(parse_positive("--temperature", line->own[TEMPERATURE], &filling[count++].value));
    }
    TRY(mf_json_fill(file, "scene", filling, count, &text));
    const enum status status = run_with(file, text, line, run_file);
    mf_memory_free(text);
    return status;
}

static enum status run_target(const char *folder, const struct command_line *line) {
    char file[OUTPUT_PATH_SIZE], rdf[OUTPUT_PATH_SIZE];
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    if (length + sizeof "/target.json" > sizeof file)
        return mf_status_fail(STATUS_BAD_INPUT, "--target: the path is too long");
    snprintf(file, sizeof file, "%.*s/target.json", (int)length, folder);
    snprintf(rdf, sizeof rdf, "%.*s/rdf.tsv", (int)length, folder);
    if (access(file, F_OK) != 0)
        return run_rdf(file, rdf, line);
    if (line->own[DENSITY] || line->own[TEMPERATURE])
        return run_filled(file, line);
    return run_file(file, line);
}

static bool has_file(const char *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return length > 0 && (size_t)length < sizeof path && access(path, F_OK) == 0;
}

/// A folder in the place of its run file, or of --target.
static enum status check_no_folder(const char *file) {
    if (has_file(file, "run.json"))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s is a folder: fit its file by mesofit fit %s/run.json", file,
                              file);
    if (has_file(file, "target.json") || has_file(file, "rdf.tsv"))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s is a folder: fit the target in it by mesofit fit --target %s",
                              file, file);
    return STATUS_OK;
}

static enum status run(const struct command_line *line) {
    const char *folder = line->own[TARGET];
    if (line->own[EXPLAIN])
        TRY(mf_command_check_live(line, "--explain"));
    if (line->own[LIVE])
        TRY(mf_command_check_live(line, "--live"));
    if ((folder != NULL) == (line->file_count > 0))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "usage: mesofit fit RUN.json, or mesofit fit --target DIR");
    if (folder)
        return run_target(folder, line);
    if (line->own[DENSITY] || line->own[TEMPERATURE])
        return mf_status_fail(STATUS_BAD_INPUT, "--density and --temperature are for --target DIR");
    TRY(check_no_folder(line->files[0]));
    return run_file(line->files[0], line);
}

const struct command mf_command_fit = {
    .name = "fit",
    .usage = "RUN.json",
    .summary = "find the potential that reproduces a target",
    .min_files = 0,
    .max_files = 1,
    .options = options,
    .run = run,
};
