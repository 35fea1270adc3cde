// SPDX-License-Identifier: GPL-3.0-or-later
#include "engines/engine.h"

#include "base/memory.h"
#include "engines/engine_door.h"
#include "engines/engine_folder.h"
#include "report/program.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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
    pthread_mutex_lock(&run->lock);
    if (!run->prepared && run->tongue->prepare)
        status = run->tongue->prepare(run, piece);
    run->prepared = status == STATUS_OK;
    pthread_mutex_unlock(&run->lock);
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
                              "--engine: %s: %s; the end of what it said is in engine.log there",
                              folder, reason);
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

/// A line that runs a piece by hand: sh run.sh COMMAND.
static enum status write_script(const struct engine_run *run, const struct engine_piece *piece,
                                const char *folder) {
    enum { TEXT = 512 };
    const char *words[ENGINE_MAX_WORDS + 1] = {NULL};
    char text[TEXT], script[OUTPUT_PATH_SIZE];
    if (run->tongue->words)
        run->tongue->words(run, piece, words, text, sizeof text);
    int length = snprintf(script, sizeof script,
                          "#!/bin/sh\n# sh run.sh COMMAND: what --engine COMMAND runs here\n"
                          "cd \"$(dirname \"$0\")\" || exit 1\nrm -f failed\n\"$@\"");
    for (size_t k = 0; words[k]; k++)
        length += snprintf(script + length, sizeof script - (size_t)length, " '%s'", words[k]);
    snprintf(
        script + length, sizeof script - (size_t)length,
        " >engine.log 2>&1\ncode=$?\n[ $code = 0 ] && exit 0\necho $code >failed\n"
        "echo \"$PWD: exit code $code; the end of engine.log:\" >&2\ntail -n 3 engine.log >&2\n"
        "exit $code\n");
    return mf_engine_write_text(folder, "run.sh", script);
}

enum { ASKED_SIZE = 256 };

/// What tells one piece from another of the same folder, as the two of a verification.
static void describe(const struct engine_piece *piece, char asked[ASKED_SIZE]) {
    snprintf(asked, ASKED_SIZE, "seed %llu, lead %llu, frames %llu, every %llu, %s\n",
             (unsigned long long)piece->seed, (unsigned long long)piece->lead,
             (unsigned long long)piece->frames, (unsigned long long)piece->every,
             piece->fresh ? "from the beginning" : "from the piece before");
}

/// Whether a folder is that of this piece.
static bool is_of(const char *folder, const struct engine_piece *piece) {
    char path[OUTPUT_PATH_SIZE], asked[ASKED_SIZE], there[ASKED_SIZE] = "";
    mf_engine_path(folder, "asked", path);
    FILE *file = fopen(path, "r");
    if (file == NULL)
        return false;
    const size_t length = fread(there, 1, sizeof there - 1, file);
    fclose(file);
    describe(piece, asked);
    return length == strlen(asked) && memcmp(there, asked, length) == 0;
}

static enum status write_piece(struct engine_run *run, const struct engine_piece *piece,
                               const char *folder) {
    TRY(prepare(run, piece));
    TRY(mf_engine_folder_make(run->folder, folder));
    TRY(run->tongue->write(run, piece, folder));
    TRY(write_script(run, piece, folder));
    char asked[ASKED_SIZE];
    describe(piece, asked);
    return mf_engine_write_text(folder, "asked", asked);
}

/// Whether a piece that somebody else runs is there.
static bool has_frames(const struct engine_run *run, const char *folder) {
    char path[OUTPUT_PATH_SIZE];
    struct stat found;
    mf_engine_path(folder, "failed", path); // by run.sh
    if (stat(path, &found) == 0)
        return false;
    mf_engine_path(folder, run->tongue->frames(run), path);
    return stat(path, &found) == 0;
}

enum status mf_engine_wait(struct engine_run *run, const char *folder) {
    char path[OUTPUT_PATH_SIZE];
    mf_engine_path(run->folder, "engine/waiting", path);
    pthread_mutex_lock(&run->lock);
    FILE *list = fopen(path, folder ? "a" : "w");
    bool written = list != NULL;
    if (written && folder)
        written = fprintf(list, "%s\n", folder) > 0;
    if (list != NULL && fclose(list) != 0)
        written = false;
    pthread_mutex_unlock(&run->lock);
    return written ? STATUS_OK : mf_status_fail(STATUS_IO, "%s: cannot be written", path);
}

enum status mf_engine_refuse(struct engine_run *run, const char *folder, enum status status) {
    if (run->later)
        (void)mf_engine_wait(run, folder);
    return status;
}

/// Of who runs the pieces elsewhere: what is there already stays.
static enum status announce(void *context, const struct engine_piece *piece) {
    struct engine_run *run = context;
    char folder[OUTPUT_PATH_SIZE];
    mf_engine_folder(run, piece->replica, piece->number, folder);
    TRY(is_of(folder, piece) ? prepare(run, piece) : write_piece(run, piece, folder));
    return has_frames(run, folder) ? STATUS_OK : mf_engine_wait(run, folder);
}

/// A piece whose predecessor is gone, as after a kill, begins anew, and equilibrates for as long as
/// it samples besides.
static struct engine_piece whole(const struct engine_run *run, const struct engine_piece *piece) {
    struct engine_piece own = *piece;
    char before[OUTPUT_PATH_SIZE];
    if (piece->fresh)
        return own;
    mf_engine_folder(run, piece->replica, piece->number - 1, before);
    if (access(before, F_OK) != 0) {
        own.fresh = true;
        own.lead += own.frames * own.every;
    }
    return own;
}

enum status mf_engine_compare(struct engine_run *run, uint64_t number, size_t replica,
                              uint64_t digest) {
    size_t like = ENGINE_MAX_REPLICAS;
    pthread_mutex_lock(&run->lock);
    for (size_t k = 0; k < ENGINE_MAX_REPLICAS; k++)
        if (k != replica && run->seen[k].number == number + 1 && run->seen[k].digest == digest)
            like = k;
    if (replica < ENGINE_MAX_REPLICAS) {
        run->seen[replica].number = number + 1; // 0: nothing is known
        run->seen[replica].digest = digest;
    }
    pthread_mutex_unlock(&run->lock);
    return like == ENGINE_MAX_REPLICAS
               ? STATUS_OK
               : mf_status_fail(
                     STATUS_BAD_INPUT,
                     "--engine: replicas %zu and %zu have the same frames: the seed that "
                     "each is given is not used (of LAMMPS ${seed}, in every command "
                     "that takes one)",
                     like + 1, replica + 1);
}

static enum status begin(void *context, const struct engine_piece *asked, void **frames) {
    struct engine_run *run = context;
    const struct engine_piece own = whole(run, asked), *piece = &own;
    const uint64_t keep = (uint64_t)run->settings->keep;
    char folder[OUTPUT_PATH_SIZE], old[OUTPUT_PATH_SIZE];
    mf_engine_folder(run, piece->replica, piece->number, folder);
    if (run->later && !has_frames(run, folder)) {
        atomic_store(&run->waits, true);
        return mf_status_fail(STATUS_INTERRUPTED, "%s is waited for", folder);
    }
    if (!run->later) {
        TRY(write_piece(run, piece, folder));
        TRY(run_command(run, piece, folder));
    }
    const enum status status =
        mf_engine_frames_open(run, piece, folder, (struct engine_frames **)frames);
    if (status != STATUS_OK)
        return mf_engine_refuse(run, folder, status);
    if (run->later || piece->number <= keep)
        return STATUS_OK;
    mf_engine_folder(run, piece->replica, piece->number - keep, old);
    return mf_engine_folder_remove(old);
}

/// Words of a shell as one.
static void print_quoted(const char *words, FILE *stream) {
    fputc('\'', stream);
    for (; *words; words++)
        fprintf(stream, *words == '\'' ? "'\\''" : "%c", *words);
    fputc('\'', stream);
}

/// A Slurm job in which the whole fit goes on, and which hands over to the next one when Slurm says
/// that its time is nearly over.
static void print_job(const void *fit, FILE *stream) {
    OWNED char *folder = realpath(fit, NULL);
    fprintf(stream,
            "#!/bin/sh\n#SBATCH --ntasks=64 --time=24:00:00 --signal=B:USR1@300\n"
            "# sbatch slurm.sh RUN.json COMMAND: the fit goes on, COMMAND as of --engine, \"srun "
            "lmp\"\n"
            "run=$1 command=$2 out=");
    print_quoted(folder ? folder : fit, stream);
    fprintf(
        stream,
        "\nmesofit fit \"$run\" -o \"$out\" --engine \"$command\" --threads 1 --resume &\nfit=$!\n"
        "trap 'more=yes; kill -USR1 $fit' USR1 # of Slurm, before the time is over\n"
        "more=\nwait $fit\ncode=$?\n"
        "[ -z \"$more\" ] || { wait $fit; code=$?; } # the signal ended the first\n"
        "if [ -n \"$more\" ] && [ $code = 0 ]; then\n"
        "    sbatch \"$out/engine/slurm.sh\" \"$run\" \"$command\"\nfi\nexit $code\n");
}

static enum status write_job(const char *fit) {
    char folder[OUTPUT_PATH_SIZE];
    mf_engine_path(fit, "engine", folder);
    return mf_engine_write(folder, "slurm.sh", print_job, fit);
}

static enum status open_engine(const char *command, const struct fit_file *fit, const char *folder,
                               bool resume, const struct sampling_engine **engine) {
    TRY(mf_engine_folder_begin(folder, resume));
    struct engine_run *run = mf_memory_zeroed(1, sizeof *run);
    if (run == NULL)
        return STATUS_NO_MEMORY;
    const struct engine_settings *settings = &fit->engine;
    run->tongue = tongues[settings->kind];
    run->settings = settings;
    run->fit = fit;
    run->command = command;
    run->later = strcmp(command, ENGINE_LATER) == 0;
    run->folder = folder;
    pthread_mutex_init(&run->lock, NULL);
    run->engine =
        (struct sampling_engine){.context = run,
                                 .steps = settings->steps,
                                 .at_once = (int)settings->at_once,
                                 .whole_energy = run->tongue->whole_energy && !settings->input[0],
                                 .announce = run->later ? announce : NULL,
                                 .begin = begin,
                                 .next = mf_engine_frames_next,
                                 .end = mf_engine_frames_close};
    *engine = &run->engine;
    if (!run->later)
        return STATUS_OK;
    TRY(write_job(folder));
    return mf_engine_wait(run, NULL);
}

static bool waits(const struct sampling_engine *engine, char *text, size_t size) {
    const struct engine_run *run = engine->context;
    if (atomic_load(&run->waits))
        snprintf(text, size,
                 "waits for samples: run the pieces whose folders are listed in %.2000s/engine/"
                 "waiting, each by its run.sh or as you like, and go on with --engine later "
                 "--resume",
                 run->folder);
    return atomic_load(&run->waits);
}

static void close_engine(const struct sampling_engine *engine) {
    if (engine == NULL)
        return;
    struct engine_run *run = engine->context;
    if (run->tongue->forget)
        run->tongue->forget(run);
    pthread_mutex_destroy(&run->lock);
    mf_memory_free(run);
}

struct engine_door mf_engine_door(const char *command) {
    return (struct engine_door){command, open_engine, waits, close_engine};
}
