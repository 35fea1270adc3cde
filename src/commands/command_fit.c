// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "base/ranks.h"
#include "engines/engine_door.h"
#include "io/json.h"
#include "io/output.h"
#include "io/text_file.h"
#include "work/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { EXPLAIN, RANKS, TARGET, DENSITY, TEMPERATURE, FRICTION, ENGINE, LIVE };

/// Of --explain.
enum { MAX_RANKS = 100000 };

/// That the command line can say of a file: density, temperature, friction.
enum { FIT_WORDS = 3 };

static const struct command_option options[] = {
    [EXPLAIN] = {"--explain", NULL, "print what will be done and what it costs; run nothing"},
    [RANKS] = {"--ranks", "N", "with --explain: speed-up of N processes of an MPI job"},
    [TARGET] = {"--target", "DIR", "folder of target.json; with the next two rdf.tsv is enough"},
    [DENSITY] = {"--density", "NUMBER", "number density of the beads, without target.json"},
    [TEMPERATURE] = {"--temperature", "NUMBER",
                     "temperature of the target, without target.json; else 1"},
    [FRICTION] = {"--friction", "free|exportable|linear",
                  "omega: any, one that LAMMPS runs, or HOOMD and ESPResSo too"},
    [ENGINE] = {"--engine", "COMMAND", "command of the run file's \"engine\""},
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

/// The file, with a word about it if there is one.
static enum status run_with(const char *file, const struct command_line *line,
                            const struct json_word *words, size_t count) {
    struct json_word all[FIT_WORDS];
    struct command_line own = *line;
    const struct engine_door door = mf_engine_door(line->own[ENGINE]);
    for (size_t k = 0; k < count; k++)
        all[k] = words[k];
    if (line->own[FRICTION])
        all[count++] = (struct json_word){.key = "friction", .text = line->own[FRICTION]};
    own.options.words = all;
    own.options.word_count = count;
    own.options.engine = &door;
    return run_whole(file, &own);
}

/// What the command line says of the scene.
static enum status find_words(const struct command_line *line, struct json_word *words,
                              size_t *count) {
    static const struct {
        int option;
        const char *key, *name;
    } known[] = {{DENSITY, "density", "--density"}, {TEMPERATURE, "temperature", "--temperature"}};
    *count = 0;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (line->own[known[k].option] == NULL)
            continue;
        words[*count] = (struct json_word){.object = "scene", .key = known[k].key};
        TRY(parse_positive(known[k].name, line->own[known[k].option], &words[(*count)++].value));
    }
    return STATUS_OK;
}

/// A run file that nobody wrote: g(r) of the folder, of what density and temperature the words say.
static enum status run_rdf(const char *file, const char *rdf, const struct command_line *line,
                           const struct json_word *words, size_t count) {
    static const char text[] = "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}}}";
    const struct memory_file unwritten = {.name = file, .text = text};
    struct stat is;
    if (stat(line->own[TARGET], &is) == 0 && S_ISREG(is.st_mode))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--target %s: a file: give the folder of a measurement",
                              line->own[TARGET]);
    if (access(rdf, R_OK) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--target: %s not found, nor rdf.tsv for use with --density", file);
    if (line->own[DENSITY] == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--target: %s not found: give --density and --temperature instead",
                              file);
    mf_text_file_set_memory_files(&unwritten, 1);
    const enum status status = run_with(file, line, words, count);
    mf_text_file_set_memory_files(NULL, 0);
    return status;
}

static enum status run_target(const char *folder, const struct command_line *line) {
    char file[OUTPUT_PATH_SIZE], rdf[OUTPUT_PATH_SIZE];
    struct json_word words[FIT_WORDS];
    size_t length = strlen(folder), count;
    while (length > 1 && folder[length - 1] == '/')
        length--;
    if (length + sizeof "/target.json" > sizeof file)
        return mf_status_fail(STATUS_BAD_INPUT, "--target: the path is too long");
    snprintf(file, sizeof file, "%.*s/target.json", (int)length, folder);
    snprintf(rdf, sizeof rdf, "%.*s/rdf.tsv", (int)length, folder);
    TRY(find_words(line, words, &count));
    return access(file, F_OK) == 0 ? run_with(file, line, words, count)
                                   : run_rdf(file, rdf, line, words, count);
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
    if (has_file(file, "history.tsv"))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s is the folder of a result: fit its run file, or a copy of %s/used.json", file,
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
    return run_with(line->files[0], line, NULL, 0);
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
