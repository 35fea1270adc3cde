// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "commands/command.h"
#include "library/guard.h"
#include "library/memory_files.h"
#include "mesofit/run.h"
#include "observe/caller_observable.h"
#include "report/watcher.h"
#include "trajectory/trajectory_memory.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

// Functions of the caller's, as observables -------------------------------------------------------

static ptrdiff_t ask(void *context, const struct caller_sample *sample, size_t room,
                     double *values) {
    const struct mesofit_named_observable *const own = context;
    return own->function(own->context, sample->count, sample->dimensions, sample->position,
                         sample->velocity, sample->type, sample->edge, room, values);
}

static enum status begin_observables(struct caller_observables *callers,
                                     const struct mesofit_named_observable *given, size_t count) {
    if (count > CALLER_OBSERVABLES_MAX)
        return mf_status_fail(STATUS_BAD_INPUT, "%zu observables: at most %d can be measured",
                              count, CALLER_OBSERVABLES_MAX);
    for (size_t k = 0; k < count; k++) {
        if (given[k].function == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "observable \"%.60s\" has no function",
                                  given[k].name ? given[k].name : "");
        // What is lent is not changed: the context of all functions is of one type, no more.
        callers->item[k] = (struct caller_observable){
            .name = given[k].name, .function = ask, .context = (void *)&given[k]};
    }
    callers->count = count;
    return STATUS_OK;
}

// Runs --------------------------------------------------------------------------------------------

// Frames in the caller's memory -------------------------------------------------------------------

/// Zeros are none. Must not be moved.
struct run_frames {
    struct structure structure;
    struct trajectory_memory memory_files;
    const struct mesofit_trajectory *from;
};

static enum status read_frame(void *context, size_t number, struct trajectory_memory_frame *frame,
                              bool *there) {
    const struct mesofit_trajectory *const from = ((const struct run_frames *)context)->from;
    struct mesofit_frame given = {.time = NAN};
    const int answer = from->read(from->context, number, &given);
    if (answer < 0)
        return mf_status_fail(STATUS_INTERRUPTED, "%s: frame %zu could not be had", from->name,
                              number + 1);
    *there = answer > 0;
    if (*there && given.positions == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu has no positions", from->name,
                              number + 1);
    frame->time = given.time;
    memcpy(frame->box, given.box, sizeof given.box);
    frame->positions = given.positions;
    frame->velocities = given.velocities;
    frame->forces = given.forces;
    return STATUS_OK;
}

static enum status check(const struct mesofit_trajectory *from) {
    const char *const name = from->name ? from->name : "a trajectory without a name";
    if (from->name == NULL || from->read == NULL || from->names == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: names of atoms and a reader are required",
                              name);
    if (from->atoms == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there are no atoms", name);
    if (!(from->length > 0) || !(from->time > 0) || isinf(from->length) || isinf(from->time))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: units of length and time must be above 0",
                              name);
    if ((from->residues == NULL) != (from->residue_names == NULL))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: residues need names and numbers", name);
    return STATUS_OK;
}

static enum status copy_name(const struct mesofit_trajectory *from, size_t atom, const char *name,
                             char to[STRUCTURE_NAME]) {
    if (name == NULL || name[0] == '\0')
        return mf_status_fail(STATUS_BAD_INPUT, "%s: atom %zu has no name", from->name, atom + 1);
    if (strlen(name) >= STRUCTURE_NAME)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the name \"%.60s\" of atom %zu has more than %d characters",
                              from->name, name, atom + 1, STRUCTURE_NAME - 1);
    strcpy(to, name);
    return STATUS_OK;
}

static enum status describe(struct structure *structure, const struct mesofit_trajectory *from) {
    const bool residues = from->residues != NULL;
    TRY(mf_structure_init(structure, from->atoms));
    structure->has_names = structure->has_residues = true;
    structure->has_masses = from->masses != NULL;
    for (size_t k = 0; k < from->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        TRY(copy_name(from, k, from->names[k], atom->name));
        TRY(copy_name(from, k, residues ? from->residue_names[k] : from->names[k],
                      atom->residue_name));
        atom->residue_number = residues ? from->residues[k] : (int64_t)k + 1;
        atom->mass = from->masses ? from->masses[k] : NAN;
    }
    return STATUS_OK;
}

static enum status begin_frames(struct run_frames *frames, const struct mesofit_trajectory *from) {
    TRY(check(from));
    frames->from = from;
    TRY(describe(&frames->structure, from));
    frames->memory_files = (struct trajectory_memory){.name = from->name,
                                                      .structure = &frames->structure,
                                                      .frames = from->frames,
                                                      .length = from->length,
                                                      .time = from->time,
                                                      .read = read_frame,
                                                      .context = frames};
    mf_trajectory_lend(&frames->memory_files);
    return STATUS_OK;
}

static void end_frames(struct run_frames *frames) {
    mf_trajectory_lend(NULL);
    mf_structure_clear(&frames->structure);
}

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

// What is to be done ------------------------------------------------------------------------------

static const struct command *const commands[] = {&mf_command_measure, &mf_command_fit,
                                                 &mf_command_export,  &mf_command_simulate,
                                                 &mf_command_import,  NULL};

static enum status carry_out(struct mesofit_run *run, size_t count, const char *const *words,
                             const struct caller_observables *callers) {
    const struct watcher watcher = {.context = run, .report = report, .print = print};
    const struct command *command = NULL;
    CLEARED_BY(mf_command_line_clear) struct command_line line = {0};
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
        CHECK(begin_frames(&frames, inputs->trajectory));
    CHECK(begin_observables(&callers, inputs->observables, inputs->observable_count));
    status = carry_out(run, count, words, &callers);
done:
    end_frames(&frames);
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
