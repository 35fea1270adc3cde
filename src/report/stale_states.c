// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/stale_states.h"

#include "base/ranks.h"
#include "io/snapshot.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_folder(const char *path) {
    struct stat about;
    return lstat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static bool is_named(const char *state, const char *const *name, size_t count) {
    bool named = false;
    for (size_t k = 0; k < count; k++)
        named = named || strcmp(state, name[k]) == 0;
    return named;
}

/// A figure is called as the table that it shows.
static int is_figure(const struct dirent *entry) {
    char table[sizeof entry->d_name + sizeof ".tsv"];
    const char *end = strrchr(entry->d_name, '.');
    if (end == NULL || (strcmp(end, ".svg") != 0 && strcmp(end, ".png") != 0))
        return 0;
    snprintf(table, sizeof table, "%.*s.tsv", (int)(end - entry->d_name), entry->d_name);
    return mf_run_folder_is_result(table);
}

static void remove_figures(const struct run_folder *state) {
    struct run_folder figures = {.locked = false};
    struct dirent **entries;
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(state, "figures", figures.path);
    const int found =
        is_folder(figures.path) ? scandir(figures.path, &entries, is_figure, alphasort) : -1;
    for (int k = 0; k < found; k++) {
        mf_run_folder_file(&figures, entries[k]->d_name, path);
        unlink(path);
        free(entries[k]);
    }
    if (found < 0)
        return;
    free(entries);
    rmdir(figures.path); // unless there is something else in it
}

static enum status remove_state(const struct run_folder *state) {
    char path[OUTPUT_PATH_SIZE];
    mf_run_folder_file(state, "used.json", path);
    if (!is_folder(state->path) || access(path, F_OK) == 0)
        return STATUS_OK;
    TRY(mf_run_folder_begin(state, false));
    remove_figures(state);
    mf_run_folder_file(state, SNAPSHOT_FOLDER, path);
    rmdir(path);
    rmdir(state->path);
    return STATUS_OK;
}

enum status mf_stale_states_remove(const struct run_folder *folder, const char *const *name,
                                   size_t count) {
    struct run_folder states = {.locked = false}, state = {.locked = false};
    struct dirent **entries;
    enum status status = STATUS_OK;
    mf_run_folder_file(folder, STATES_FOLDER, states.path);
    const int found = ranks_lead() && is_folder(states.path)
                          ? scandir(states.path, &entries, NULL, alphasort)
                          : -1;
    for (int k = 0; k < found; k++) {
        const char *own = entries[k]->d_name;
        mf_run_folder_file(&states, own, state.path);
        if (status == STATUS_OK && own[0] != '.' && !is_named(own, name, count))
            status = remove_state(&state);
        free(entries[k]);
    }
    if (found < 0)
        return STATUS_OK;
    free(entries);
    rmdir(states.path); // unless a state is left
    return status;
}
