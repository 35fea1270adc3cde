// SPDX-License-Identifier: GPL-3.0-or-later
#include "engines/engine.h"

#include "base/memory.h"
#include "engines/engine_door.h"
#include "engines/engine_folder.h"
#include "report/program.h"

#include <string.h>

static const struct engine_tongue *const tongues[] = {
    [ENGINE_LAMMPS] = &mf_engine_lammps, [ENGINE_COMMAND] = &mf_engine_command};

void mf_engine_numbers_clear(struct engine_numbers *numbers) {
    mf_memory_free(numbers->step);
    mf_memory_free(numbers->temperature);
    mf_memory_free(numbers->pressure);
    mf_memory_free(numbers->energy);
    *numbers = (struct engine_numbers){0};
}

void mf_engine_folder(const struct engine_run *run, size_t replica, uint64_t number, char *path) {
    if (number == 0)
        snprintf(path, OUTPUT_PATH_SIZE, "%.3800s/engine/verification/%02zu", run->folder,
                 replica + 1);
    else
        snprintf(path, OUTPUT_PATH_SIZE, "%.3800s/engine/%04llu/%02zu", run->folder,
                 (unsigned long long)number, replica + 1);
}

/// One thread prepares what all pieces share; the others wait for it.
static enum status prepare(struct engine_run *run, const struct engine_piece *piece) {
    enum status status = STATUS_OK;
    pthread_mutex_lock(&run->first);
    if (!run->prepared && run->tongue->prepare)
        status = run->tongue->prepare(run, piece);
    run->prepared = status == STATUS_OK;
    pthread_mutex_unlock(&run->first);
    return status;
}

/// Say what went wrong, by the engine's own words, and where it can be looked at.
static enum status explain(const struct engine_run *run, enum status status, const char *folder,
                           char *text) {
    const char *reason = run->tongue->reason ? run->tongue->reason(text) : NULL;
    if (status != STATUS_IO)
        return status;
    const bool unstable =
        reason && run->tongue->blames_potential && run->tongue->blames_potential(reason);
    if (reason)
        return mf_status_fail(unstable ? STATUS_UNSTABLE : STATUS_IO,
                              "--engine: %s: %s; all it said is in engine.log there", folder,
                              reason);
    return mf_status_prefix(STATUS_IO, "--engine: %s", folder);
}

/// Run the command in the folder of a piece, and keep what it says.
static enum status run_command(const struct engine_run *run, const struct engine_piece *piece,
                               const char *folder) {
    enum { SAID = 1 << 16, TEXT = 512 };
    const char *words[ENGINE_MAX_WORDS + 1] = {run->command};
    char text[TEXT];
    OWNED char *said = NULL;
    TRY_ARRAY(said, SAID);
    if (run->tongue->words)
        run->tongue->words(run, piece, words + 1, text, sizeof text);
    const enum status status =
        mf_program_command(folder, words, run->fit->problem.scene.cancel, said, SAID);
    if (status != STATUS_INTERRUPTED)
        TRY(mf_engine_write_text(folder, "engine.log", said));
    return status == STATUS_OK ? STATUS_OK : explain(run, status, folder, said);
}

static enum status begin(void *context, const struct engine_piece *piece, void **frames) {
    struct engine_run *run = context;
    const uint64_t keep = (uint64_t)run->settings->keep;
    char folder[OUTPUT_PATH_SIZE], old[OUTPUT_PATH_SIZE];
    mf_engine_folder(run, piece->replica, piece->number, folder);
    TRY(prepare(run, piece));
    TRY(mf_engine_folder_make(run->folder, folder));
    TRY(run->tongue->write(run, piece, folder));
    TRY(run_command(run, piece, folder));
    TRY(mf_engine_frames_open(run, piece, folder, (struct engine_frames **)frames));
    if (piece->number <= keep)
        return STATUS_OK;
    mf_engine_folder(run, piece->replica, piece->number - keep, old);
    return mf_engine_folder_remove(old);
}

static enum status open_engine(const char *command, const struct fit_file *fit, const char *folder,
                               const struct sampling_engine **engine) {
    struct engine_run *run = mf_memory_zeroed(1, sizeof *run);
    if (run == NULL)
        return STATUS_NO_MEMORY;
    const struct engine_settings *settings = &fit->engine;
    run->tongue = tongues[settings->kind];
    run->settings = settings;
    run->fit = fit;
    run->command = command;
    run->folder = folder;
    pthread_mutex_init(&run->first, NULL);
    run->engine =
        (struct sampling_engine){.context = run,
                                 .steps = settings->steps,
                                 .at_once = (int)settings->at_once,
                                 .whole_energy = run->tongue->whole_energy && !settings->input[0],
                                 .begin = begin,
                                 .next = mf_engine_frames_next,
                                 .end = mf_engine_frames_close};
    *engine = &run->engine;
    return STATUS_OK;
}

static void close_engine(const struct sampling_engine *engine) {
    if (engine == NULL)
        return;
    struct engine_run *run = engine->context;
    if (run->tongue->forget)
        run->tongue->forget(run);
    pthread_mutex_destroy(&run->first);
    mf_memory_free(run);
}

struct engine_door mf_engine_door(const char *command) {
    return (struct engine_door){command, open_engine, close_engine};
}
