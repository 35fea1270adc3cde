// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesofit/run.h"

#include "base/memory.h"
#include "commands/command.h"
#include "library/guard.h"
#include "library/memory_files.h"
#include "library/run_frames.h"
#include "library/run_observables.h"
#include "report/watcher.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct mesofit_run {
    atomic_bool stop;
    pthread_mutex_t lock; ///< of all that follows
    struct mesofit_run_progress progress;
    char **line; ///< shape [room], of which there are `lines`
    size_t lines, capacity;
};

struct mesofit_run *mesofit_run_create(void) {
    struct mesofit_run *run = mf_memory_zeroed(1, sizeof *run);
    if (run && pthread_mutex_init(&run->lock, NULL) == 0)
        return run;
    mf_memory_free(run);
    return NULL;
}

void mesofit_run_free(struct mesofit_run *run) {
    if (run == NULL)
        return;
    for (size_t k = 0; k < run->lines; k++)
        free(run->line[k]);
    free(run->line);
    pthread_mutex_destroy(&run->lock);
    mf_memory_free(run);
}

void mesofit_run_stop(struct mesofit_run *run) {
    atomic_store(&run->stop, true);
}

void mesofit_run_progress(struct mesofit_run *run, struct mesofit_run_progress *progress) {
    pthread_mutex_lock(&run->lock);
    *progress = run->progress;
    pthread_mutex_unlock(&run->lock);
}

const char *mesofit_run_line(struct mesofit_run *run, size_t number) {
    pthread_mutex_lock(&run->lock);
    const char *line = number < run->lines ? run->line[number] : NULL;
    pthread_mutex_unlock(&run->lock);
    return line;
}

// Who watches -------------------------------------------------------------------------------------

static void begin(void *context, const struct watcher_run *watched) {
    (void)context, (void)watched;
}

static void report(void *context, const struct watcher_progress *at) {
    struct mesofit_run *run = context;
    struct mesofit_run_progress progress = {
        .done = at->done, .total = at->total, .rate = at->rate, .open = at->open};
    snprintf(progress.unit, sizeof progress.unit, "%s", at->unit);
    snprintf(progress.text, sizeof progress.text, "%s", at->text);
    pthread_mutex_lock(&run->lock);
    run->progress = progress;
    pthread_mutex_unlock(&run->lock);
}

/// Without memory a line is lost: what it is about goes on.
static void print(void *context, const char *line) {
    struct mesofit_run *run = context;
    pthread_mutex_lock(&run->lock);
    if (run->lines == run->capacity) {
        const size_t capacity = run->capacity ? 2 * run->capacity : 32;
        char **larger = realloc(run->line, capacity * sizeof *larger);
        if (larger) {
            run->line = larger;
            run->capacity = capacity;
        }
    }
    if (run->lines < run->capacity && (run->line[run->lines] = strdup(line)))
        run->lines++;
    pthread_mutex_unlock(&run->lock);
}

static void written(void *context) {
    (void)context;
}

static int64_t steps(void *context) {
    (void)context;
    return 0;
}

static bool change(void *context, struct simulation_change *wanted) {
    (void)context, (void)wanted;
    return false;
}

static bool damp(void *context, double *wanted) {
    (void)context, (void)wanted;
    return false;
}

// What is to be done ------------------------------------------------------------------------------

static const struct command *const commands[] = {&mf_command_measure, &mf_command_fit,
                                                 &mf_command_export,  &mf_command_simulate,
                                                 &mf_command_import,  NULL};

static enum status carry_out(struct mesofit_run *run, size_t count, const char *const *words,
                             const struct caller_observables *callers) {
    const struct watcher watcher = {.context = run,
                                    .begin = begin,
                                    .report = report,
                                    .print = print,
                                    .write = written,
                                    .steps = steps,
                                    .change = change,
                                    .damp = damp};
    const struct command *command = NULL;
    struct command_line line = {0};
    TRY(mf_command_find(commands, words[0], &command));
    TRY(mf_command_parse(command, count - 1, words + 1, &line));
    line.options.quiet = RUN_SAYS_NOTHING;
    line.options.no_figures = true;
    line.options.stop = &run->stop;
    line.options.callers = callers;
    if (callers->count > 0 && command != &mf_command_simulate)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes no observables of the caller",
                              command->name);
    line.options.watcher = &watcher;
    return command->run(&line);
}

static enum status check_words(size_t count, const char *const *words) {
    for (size_t k = 0; words && k < count; k++)
        if (words[k] == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "word %zu is missing", k + 1);
    return words && count > 0 ? STATUS_OK
                              : mf_status_fail(STATUS_BAD_INPUT, "give a command and its words");
}

static enum status run_words(struct mesofit_run *run, size_t count, const char *const *words,
                             const struct mesofit_inputs *inputs) {
    enum status status = STATUS_OK;
    struct memory_files memory_files = {0};
    struct run_frames frames = {0};
    struct caller_observables callers = {0};
    TRY(check_words(count, words));
    CHECK(mf_memory_files_begin(&memory_files, inputs->texts, inputs->text_count, inputs->tables,
                                inputs->table_count));
    if (inputs->trajectory)
        CHECK(mf_run_frames_begin(&frames, inputs->trajectory));
    CHECK(mf_run_observables_begin(&callers, inputs->observables, inputs->observable_count));
    status = carry_out(run, count, words, &callers);
done:
    mf_run_frames_end(&frames);
    mf_memory_files_end(&memory_files);
    return status;
}

enum mesofit_status mesofit_run_words(struct mesofit_run *run, size_t count,
                                      const char *const *words,
                                      const struct mesofit_inputs *inputs) {
    static const struct mesofit_inputs none;
    mf_guard_enter();
    return mf_guard_return(run_words(run, count, words, inputs ? inputs : &none));
}
