// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/run_folder.h"

#include "base/clock.h"
#include "base/digest.h"
#include "base/ranks.h"
#include "base/spent.h"
#include "io/checkpoint.h"
#include "io/json.h"
#include "io/tracked_file.h"
#include "trajectory/snapshot.h"
#include "report/figures.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Room for the name of any file after the path of the folder.
enum { NAME_ROOM = 320, LONGEST_FOLDER = OUTPUT_PATH_SIZE - NAME_ROOM };

static bool exists(const struct run_folder *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(folder, name, path);
    return access(path, F_OK) == 0;
}

// May it be written? ------------------------------------------------------------------------------

/// What a run goes on from.
static const char checkpoint[] = "checkpoint.bin";

/// Whether the object in a JSON file has this key, with this text if one is given. A file that
/// cannot be read has not.
static bool says(const struct run_folder *folder, const char *name, const char *key,
                 const char *text) {
    char path[OUTPUT_PATH_SIZE];
    struct json_document *document;
    mf_run_folder_file(folder, name, path);
    if (mf_json_open(&document, path) != STATUS_OK)
        return false;
    struct json_object root = mf_json_root(document);
    bool found = mf_json_has(&root, key);
    if (found && text) {
        const char *value = mf_json_choice(&root, key, NULL, NULL);
        found = value && strcmp(value, text) == 0;
    }
    return mf_json_close(document, STATUS_OK) == STATUS_OK && found;
}

/// Settings that cannot be read are taken for those of a fit, which is worth more.
static bool is_simulation(const struct run_folder *folder) {
    return says(folder, "used.json", "seed", NULL) && !says(folder, "used.json", "method", NULL);
}

static bool is_measurement(const struct run_folder *folder) {
    return says(folder, "used.json", "trajectories", NULL);
}

/// A file of the run's that somebody has changed since, or NULL.
static const char *find_changed(const struct run_folder *folder) {
    const struct manifest *list = &folder->own.list;
    for (size_t k = 0; k < list->count; k++) {
        const struct manifest_entry *entry = &list->entry[k];
        if (!mf_tracked_file_is_folder(entry->name) &&
            mf_tracked_file_state(list->place, entry->name, entry) == TRACKED_FILE_OTHER)
            return entry->name;
    }
    return NULL;
}

static enum status refuse(const struct run_folder *folder, const char *what, const char *remedy) {
    const char *changed = find_changed(folder);
    return mf_status_fail(STATUS_BAD_INPUT, "%s holds %s%s%s%s: %s", folder->path, what,
                          changed ? ", in which " : "", changed ? changed : "",
                          changed ? " was changed since mesofit wrote it" : "", remedy);
}

/// What is done again in no time may be replaced by its like; hours of work are not to be lost by
/// a word.
static enum status check_replaced(const struct run_folder *folder, enum run_kind kind) {
    static const char replaces[] = "--force replaces it, -o OTHER keeps it",
                      resumes[] = "--resume continues it, --force starts again";
    const bool summary = mf_tracked_files_has(&folder->own, "summary.json");
    const bool saved = mf_tracked_files_has(&folder->own, checkpoint);
    if (!summary && !saved)
        return STATUS_OK;
    if (is_measurement(folder))
        return kind == RUN_MEASUREMENT ? STATUS_OK : refuse(folder, "a measurement", replaces);
    if (is_simulation(folder)) {
        if (kind != RUN_SIMULATION)
            return refuse(folder, "a simulation", replaces);
        return saved ? refuse(folder, "an unfinished simulation", resumes) : STATUS_OK;
    }
    if (summary && !says(folder, "summary.json", "status", mf_status_name(STATUS_INTERRUPTED)))
        return refuse(folder, "a finished fit", replaces);
    return refuse(folder, "an unfinished fit", resumes);
}

/// Results that are in no list, as in a copy without it, and of version 0.2.0: what else is of that
/// run is not known.
static enum status check_listed(const struct run_folder *folder) {
    if (!exists(folder, "used.json") || mf_tracked_files_has(&folder->own, "used.json"))
        return STATUS_OK;
    return refuse(folder, "results without a list of files (" TRACKED_FILES_OF_RUN ")",
                  exists(folder, checkpoint) ? "--resume may continue it, -o OTHER keeps them"
                                             : "write elsewhere with -o");
}

static enum status check_resumed(const struct run_folder *folder) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(folder, checkpoint, path);
    if (access(path, F_OK) == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "%s: %s: there is nothing to resume", path, strerror(errno));
}

/// Find out now, and not after an hour, that the folder cannot be written.
static enum status check_writable(const struct run_folder *folder) {
    if (access(folder->path, W_OK | X_OK) == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_IO, "%s: %s", folder->path, strerror(errno));
}

/// What any run writes.
static enum status reserve_all(struct run_folder *folder, bool resume) {
    static const char *const names[] = {
        "summary.json", PROGRESS_FILE, "figures/", SNAPSHOT_FOLDER "/", STATES_FOLDER "/",
        "used.json", // a run that goes on reads it, and its checkpoint
        checkpoint};
    for (size_t k = 0; k < sizeof names / sizeof *names - (resume ? 2 : 0); k++)
        TRY(mf_run_folder_reserve(folder, names[k]));
    return STATUS_OK;
}

enum status mf_run_folder_choose(struct run_folder *folder, enum run_kind kind, const char *input,
                                 const struct run_options *options) {
    const char *slash = strrchr(input, '/');
    const char *const given =
        options->folder || kind != RUN_MEASUREMENT ? options->folder : "target";
    const int length = given ? snprintf(folder->path, sizeof folder->path, "%s", given)
                             : snprintf(folder->path, sizeof folder->path, "%.*sout",
                                        slash ? (int)(slash - input + 1) : 0, input);
    if (length >= 0 && length <= LONGEST_FOLDER)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%.60s…: the path of a run's folder has at most %d bytes", folder->path,
                          LONGEST_FOLDER);
}

enum status mf_run_folder_open(struct run_folder *folder, enum run_kind kind, const char *input,
                               const struct input_files *inputs,
                               const struct run_options *options) {
    static const char *const read[] = {"used.json", checkpoint, NULL};
    TRY(mf_run_folder_choose(folder, kind, input, options));
    folder->no_figures = options->no_figures;
    if (!ranks_lead())
        return STATUS_OK;
    if (options->resume)
        TRY(check_resumed(folder));
    TRY(mf_tracked_files_make(&folder->own, folder->path, TRACKED_FILES_OF_RUN));
    folder->own.inputs = inputs;
    folder->own.force = options->force;
    if (options->resume)
        folder->own.goes_on_from = checkpoint;
    TRY(check_writable(folder));
    TRY(mf_tracked_files_lock(&folder->own));
    if (!options->resume)
        TRY(check_listed(folder));
    TRY(mf_tracked_files_protect_inputs(&folder->own, options->resume ? read : NULL));
    if (!options->resume && !options->force)
        TRY(check_replaced(folder, kind));
    TRY(mf_tracked_files_check(&folder->own, options->resume ? read : NULL));
    return reserve_all(folder, options->resume);
}

enum status mf_run_folder_reserve(struct run_folder *folder, const char *name) {
    return folder->own.open ? mf_tracked_files_reserve(&folder->own, name) : STATUS_OK;
}

// From one run to the next ------------------------------------------------------------------------

enum status mf_run_folder_keep_settings(struct run_folder *folder, const struct json_writer *writer,
                                        uint64_t *digest) {
    FILE *stream = open_memstream(&folder->settings, &folder->settings_size);
    if (stream == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    const enum status status = mf_json_write_stream(writer, stream, "used.json");
    fclose(stream);
    *digest = DIGEST_OF_NOTHING;
    mf_digest_add(digest, folder->settings, folder->settings_size);
    return status;
}

static enum status prepare_settings(struct run_folder *folder) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(folder, "used.json", path);
    TRY(mf_output_open(&folder->used, path));
    fwrite(folder->settings, 1, folder->settings_size, folder->used.stream);
    return mf_output_finish(&folder->used);
}

enum status mf_run_folder_begin(struct run_folder *folder, uint64_t digest) {
    TRY(mf_tracked_files_begin(&folder->own, digest));
    return folder->settings ? prepare_settings(folder) : STATUS_OK;
}

enum status mf_run_folder_take_over(struct run_folder *folder) {
    if (folder->settings)
        TRY(mf_output_publish(&folder->used));
    folder->own.goes_on_from = checkpoint;
    return mf_tracked_files_remove_earlier(&folder->own);
}

/// The run has read its checkpoint, which is thus its own, and so are its settings, whether or not
/// a list says so. A run that was killed may have saved itself and not its settings.
enum status mf_run_folder_resume(struct run_folder *folder, uint64_t digest) {
    char path[OUTPUT_PATH_SIZE];
    uint64_t found, wanted = DIGEST_OF_NOTHING;
    TRY(mf_tracked_files_resume(&folder->own, digest));
    if (exists(folder, checkpoint))
        TRY(mf_tracked_files_adopt(&folder->own, checkpoint));
    mf_run_folder_file(folder, "used.json", path);
    mf_digest_add(&wanted, folder->settings, folder->settings_size);
    if (mf_checkpoint_digest(path, &found) == STATUS_OK && found == wanted)
        return mf_tracked_files_adopt(&folder->own, "used.json");
    TRY(prepare_settings(folder));
    return mf_output_publish(&folder->used);
}

void mf_run_folder_close(struct run_folder *folder) {
    mf_output_abandon(&folder->used);
    mf_tracked_files_close(&folder->own);
    free(folder->settings);
    folder->settings = NULL;
}

void mf_run_folder_file(const struct run_folder *folder, const char *name, char *path) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.*s/%.*s", LONGEST_FOLDER, folder->path, NAME_ROOM - 2,
             name);
}

// Folders of states -------------------------------------------------------------------------------

static enum status choose_state(const struct run_folder *folder, const char *name,
                                struct run_folder *state) {
    *state = (struct run_folder){0};
    const int length =
        snprintf(state->path, sizeof state->path, "%s/" STATES_FOLDER "/%s", folder->path, name);
    if (length >= 0 && length <= LONGEST_FOLDER)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%.60s…: the path of a state's folder has at most %d bytes", folder->path,
                          LONGEST_FOLDER);
}

enum status mf_run_folder_check_state(struct run_folder *folder, const char *name) {
    struct run_folder state;
    char inside[OUTPUT_PATH_SIZE];
    TRY(choose_state(folder, name, &state));
    if (!ranks_lead())
        return STATUS_OK;
    snprintf(inside, sizeof inside, STATES_FOLDER "/%.3800s/", name);
    TRY(mf_run_folder_reserve(folder, inside));
    if (exists(&state, "used.json"))
        return mf_status_fail(STATUS_BAD_INPUT, "%s holds another run: give another folder with -o",
                              state.path);
    return access(state.path, F_OK) == 0 ? check_writable(&state) : STATUS_OK;
}

enum status mf_run_folder_state(const struct run_folder *folder, const char *name,
                                struct run_folder *state) {
    TRY(choose_state(folder, name, state));
    state->no_figures = folder->no_figures;
    return mf_output_make_folder(state->path);
}

bool mf_run_folder_draw(const struct run_folder *folder) {
    const double begun = clock_children_seconds();
    const bool drawn =
        !ranks_lead() || folder->no_figures || mf_figures_draw(folder->path) == STATUS_OK;
    if (!drawn)
        fprintf(stderr, "mesofit: warning: %s\n", mf_status_message());
    mf_spent_add(SPENT_FIGURES, clock_children_seconds() - begun);
    return drawn;
}
