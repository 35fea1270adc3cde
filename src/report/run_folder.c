// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/run_folder.h"

#include "base/ranks.h"
#include "io/configuration.h"
#include "io/json.h"
#include "io/snapshot.h"
#include "observe/observable.h"
#include "report/figures.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/// Room for the name of any file behind the path of the folder.
enum {
    NAME_ROOM = 320,
    LONGEST_FOLDER = OUTPUT_PATH_SIZE - NAME_ROOM,
    LONGEST_PLACE = OUTPUT_PATH_SIZE - 258
};

/// What a run writes beside used.json; with *-* the tables about the pair types of a mixture, with
/// * those about the modes of a memory, with both those about groups of bonds, angles and
/// dihedrals.
static const char *const results[] = {
    "summary.json",
    PROGRESS_FILE,
    CONFIGURATION_BONDS_FILE,
    "target.json",
    "history.tsv",
    "timing.tsv",
    "tasks.tsv",
    "rdf_now.tsv",
    "rdf_now_*-*.tsv",
    "now_bond_lengths_*.tsv",
    "now_bond_lengths_*-*.tsv",
    "now_bond_angles_*.tsv",
    "now_bond_angles_*-*.tsv",
    "now_dihedral_angles_*.tsv",
    "now_dihedral_angles_*-*.tsv",
    "excess_history.tsv",
    "excess_*-*.tsv",
    "potential.tsv",
    "potential_*-*.tsv",
    "potential_history.tsv",
    "potential_flat.tsv",
    "potential.pot",
    "potential_*-*.pot",
    "omega_flat.tsv",
    "omega_history.tsv",
    "omega.tsv",
    "omega_transverse.tsv",
    "omega_transverse_flat.tsv",
    "omega_transverse_history.tsv",
    "memory_*.tsv",
    "bonds_*.tsv",
    "bonds_*-*.tsv",
    "angles_*.tsv",
    "angles_*-*.tsv",
    "dihedrals_*.tsv",
    "dihedrals_*-*.tsv",
    "bond_lengths_*.tsv",
    "bond_lengths_*-*.tsv",
    "bond_angles_*.tsv",
    "bond_angles_*-*.tsv",
    "dihedral_angles_*.tsv",
    "dihedral_angles_*-*.tsv",
    "numbers_history.tsv",
    "etd_cells.tsv",
    "population_potential.tsv",
    "population_potential_*-*.tsv",
    "population_omega.tsv",
    "population_omega_transverse.tsv",
    "population_memory_*.tsv",
    "individuals.tsv",
    "genes_potential.tsv",
    "genes_potential_*-*.tsv",
    "genes_omega.tsv",
    "genes_omega_transverse.tsv",
    "genes_memory_*.tsv",
    "formulas.tsv",
    "formulas.tex",
    "formulas.h",
    "pareto.tsv",
    "pareto_history.tsv",
    "pareto_omega.tsv",
    "pareto_omega_transverse.tsv",
    "pareto_memory_*.tsv",
    "pareto_potential.tsv",
    "pareto_potential_*-*.tsv",
    "checkpoint.bin",
    // Of earlier versions, in whose folder this may be.
    "weight_history.tsv",
    "pareto_weight.tsv",
    "singular_values.tsv",
    "singular_values_history.tsv",
};

/// Whether a pattern is a file's name, each * being a name of a type or a mode: a date is none.
static bool fits(const char *pattern, const char *name) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    const char *star = strchr(pattern, '*');
    if (fnmatch(pattern, name, 0) != 0)
        return false;
    if (star == NULL)
        return true;
    const char *first = name + (star - pattern), *end = first + strspn(first, letters);
    if (end > first && star[1] != '-')
        return strcmp(end, star + 1) == 0;
    if (end == first || *end != '-')
        return false;
    const char *second = end + 1, *dot = second + strspn(second, letters);
    return dot > second && *dot == '.';
}

/// A table of an observable, or of a target and what was found of it.
static bool is_observed(const char *name) {
    struct observable_kind found;
    for (size_t k = 0; mf_observables[k]; k++)
        for (const char *const *file = mf_observables[k]->files; file && *file; file++)
            if (fits(*file, name))
                return true;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++) {
        const size_t length = strlen(found.target->name);
        if (strncmp(name, found.target->name, length) == 0 && strcmp(name + length, ".tsv") == 0)
            return true;
    }
    return false;
}

bool mf_run_folder_is_result(const char *name) {
    for (size_t k = 0; k < sizeof results / sizeof *results; k++)
        if (fits(results[k], name))
            return true;
    return mf_snapshot_is_file(name) || is_observed(name);
}

static int is_result(const struct dirent *entry) {
    return mf_run_folder_is_result(entry->d_name);
}

/// A result, but for the checkpoint, which the new run has replaced by its own.
static int is_earlier(const struct dirent *entry) {
    return is_result(entry) && strcmp(entry->d_name, "checkpoint.bin") != 0;
}

/// A result, or the settings.
static int is_output(const struct dirent *entry) {
    return is_result(entry) || strcmp(entry->d_name, "used.json") == 0;
}

/// "rdf.tsv.123.partial" and the like: what a process that was killed had begun to write.
static int is_left_behind(const struct dirent *entry) {
    struct dirent whole = *entry;
    if (strcmp(entry->d_name, "used.json.resumed") == 0)
        return 1;
    char *end = strrchr(whole.d_name, '.');
    if (end == NULL || strcmp(end, OUTPUT_PARTIAL) != 0)
        return 0;
    *end = '\0';
    end = strrchr(whole.d_name, '.');
    if (end == NULL || end[1] == '\0' || end[1 + strspn(end + 1, "0123456789")] != '\0')
        return 0;
    *end = '\0';
    return is_output(&whole);
}

/// What to do with a file of the folder.
static enum status remove_file(const char *path, const void *context) {
    (void)context;
    if (unlink(path) != 0 && errno != ENOENT)
        return mf_status_fail(STATUS_IO, "%s: %s", path, strerror(errno));
    return STATUS_OK;
}

static enum status spare_input(const char *path, const void *context) {
    return mf_input_files_spare(context, path);
}

static enum status refuse_stranger(const char *path, const void *context) {
    (void)context;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s is there, but no used.json, so no run wrote it: -o OTHER keeps it, "
                          "--force replaces it",
                          path);
}

static enum status with_files_in(const char *place, int (*is_one)(const struct dirent *),
                                 enum status (*act)(const char *path, const void *context),
                                 const void *context) {
    enum status status = STATUS_OK;
    struct dirent **entries;
    const int count = scandir(place, &entries, is_one, alphasort);
    if (count < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", place, strerror(errno));
    for (int k = 0; k < count; k++) {
        char path[OUTPUT_PATH_SIZE];
        snprintf(path, sizeof path, "%.*s/%s", LONGEST_PLACE, place, entries[k]->d_name);
        if (status == STATUS_OK)
            status = act(path, context);
        free(entries[k]);
    }
    free(entries);
    return status;
}

/// Do something with every file of the folder, and of that of its snapshots, that is one of those.
static enum status with_files(const struct run_folder *folder, int (*is_one)(const struct dirent *),
                              enum status (*act)(const char *path, const void *context),
                              const void *context) {
    char snapshots[OUTPUT_PATH_SIZE];
    TRY(with_files_in(folder->path, is_one, act, context));
    mf_run_folder_file(folder, SNAPSHOT_FOLDER, snapshots);
    return access(snapshots, F_OK) == 0 ? with_files_in(snapshots, is_one, act, context)
                                        : STATUS_OK;
}

// May it be written? ------------------------------------------------------------------------------

static bool has(const struct run_folder *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(folder, name, path);
    return access(path, F_OK) == 0;
}

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
        const char *said = mf_json_choice(&root, key, NULL, NULL);
        found = said && strcmp(said, text) == 0;
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

/// What is done again in no time may be replaced by its like.
static enum status check_kind(const struct run_folder *folder, bool same, const char *name) {
    return same ? STATUS_OK
                : mf_status_fail(STATUS_BAD_INPUT,
                                 "%s holds a %s: --force replaces it, -o OTHER keeps it",
                                 folder->path, name);
}

/// Hours of work are not to be lost by a word: a fit goes by --force alone.
static enum status check_replaced(const struct run_folder *folder, enum run_kind kind) {
    if (!has(folder, "used.json"))
        return with_files(folder, is_result, refuse_stranger, NULL);
    const bool summary = has(folder, "summary.json"), saved = has(folder, "checkpoint.bin");
    if (!summary && !saved)
        return STATUS_OK;
    if (is_measurement(folder))
        return check_kind(folder, kind == RUN_MEASUREMENT, "measurement");
    if (is_simulation(folder))
        return check_kind(folder, kind == RUN_SIMULATION, "simulation");
    if (summary && !says(folder, "summary.json", "status", mf_status_name(STATUS_INTERRUPTED)))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s holds a finished fit: --force replaces it, -o OTHER keeps it",
                              folder->path);
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s holds an unfinished fit: --resume goes on, --force begins anew",
                          folder->path);
}

static enum status check_resumed(const struct run_folder *folder) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(folder, "checkpoint.bin", path);
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

/// The system takes the lock back when the process ends, however it ends.
static enum status lock(struct run_folder *folder) {
    folder->lock = open(folder->path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder->lock < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder->path, strerror(errno));
    folder->locked = true;
    if (flock(folder->lock, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: another process is running in this folder",
                          folder->path);
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
    TRY(mf_run_folder_choose(folder, kind, input, options));
    if (!ranks_lead())
        return STATUS_OK;
    TRY(mf_output_make_folder(folder->path));
    TRY(check_writable(folder));
    TRY(lock(folder));
    // A run that goes on leaves used.json alone, which may then be its input.
    TRY(with_files(folder, options->resume ? is_result : is_output, spare_input, inputs));
    if (options->resume)
        return check_resumed(folder);
    return options->force ? STATUS_OK : check_replaced(folder, kind);
}

enum status mf_run_folder_begin(const struct run_folder *folder, bool resume) {
    TRY(with_files(folder, is_left_behind, remove_file, NULL));
    return resume ? STATUS_OK : with_files(folder, is_earlier, remove_file, NULL);
}

void mf_run_folder_close(struct run_folder *folder) {
    if (folder->locked)
        close(folder->lock);
    folder->locked = false;
}

void mf_run_folder_file(const struct run_folder *folder, const char *name, char *path) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.*s/%.*s", LONGEST_FOLDER, folder->path, NAME_ROOM - 2,
             name);
}

/// A folder of this fit, and no link to another's.
static enum status make_own(const char *path) {
    struct stat about;
    TRY(mf_output_make_folder(path));
    if (lstat(path, &about) == 0 && S_ISDIR(about.st_mode))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s is a link: states have folders of their own", path);
}

enum status mf_run_folder_state(const struct run_folder *folder, const char *name,
                                struct run_folder *state) {
    char states[OUTPUT_PATH_SIZE];
    *state = (struct run_folder){0};
    mf_run_folder_file(folder, STATES_FOLDER, states);
    const int length = snprintf(state->path, sizeof state->path, "%s/%s", states, name);
    if (length < 0 || length > LONGEST_FOLDER)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%.60s…: the path of a state's folder has at most %d bytes",
                              folder->path, LONGEST_FOLDER);
    if (!ranks_lead())
        return STATUS_OK;
    TRY(make_own(states));
    return make_own(state->path);
}

enum status mf_run_folder_open_state(const struct run_folder *folder, const char *name,
                                     const struct input_files *inputs) {
    struct run_folder state;
    TRY(mf_run_folder_state(folder, name, &state));
    if (!ranks_lead())
        return STATUS_OK;
    TRY(check_writable(&state));
    if (has(&state, "used.json"))
        return mf_status_fail(STATUS_BAD_INPUT, "%s holds a run of its own: -o OTHER keeps it",
                              state.path);
    return with_files(&state, is_output, spare_input, inputs);
}

enum status mf_run_folder_begin_state(const struct run_folder *folder, const char *name,
                                      bool resume) {
    struct run_folder state;
    TRY(mf_run_folder_state(folder, name, &state));
    return mf_run_folder_begin(&state, resume);
}

void mf_run_folder_draw(const struct run_folder *folder) {
    if (ranks_lead() && mf_figures_draw(folder->path) != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", mf_status_message());
}
