// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_scratch.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char stem[] = "mesofit-live-";

static const char *find_place(void) {
    const char *place = getenv("TMPDIR");
    return place && place[0] ? place : "/tmp";
}

static int is_scratch(const struct dirent *entry) {
    return strncmp(entry->d_name, stem, strlen(stem)) == 0;
}

static bool is_own(const char *path) {
    struct stat about;
    return lstat(path, &about) == 0 && S_ISDIR(about.st_mode) && about.st_uid == geteuid();
}

/// What has a list and no process is left over.
static void remove_if_left(const char *path) {
    struct tracked_files own = {.open = false};
    if (is_own(path) && mf_tracked_files_open(&own, path, TRACKED_FILES_OF_LIVE) == STATUS_OK &&
        own.list.there && mf_tracked_files_lock(&own) == STATUS_OK)
        mf_tracked_files_remove_all(&own);
    mf_tracked_files_close(&own);
}

static void remove_left_over(const char *place) {
    struct dirent **entries;
    const int count = scandir(place, &entries, is_scratch, alphasort);
    for (int k = 0; k < count; k++) {
        char path[OUTPUT_PATH_SIZE];
        snprintf(path, sizeof path, "%.3800s/%s", place, entries[k]->d_name);
        remove_if_left(path);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
}

/// The list is there once the folder is locked: nobody takes it for left over.
static bool try_to_make(struct live_scratch *scratch, const char *place) {
    return snprintf(scratch->path, sizeof scratch->path, "%s/%sXXXXXX", place, stem) <
               (int)sizeof scratch->path &&
           mkdtemp(scratch->path) &&
           mf_tracked_files_open(&scratch->own, scratch->path, TRACKED_FILES_OF_LIVE) ==
               STATUS_OK &&
           mf_tracked_files_lock(&scratch->own) == STATUS_OK &&
           mf_tracked_files_begin(&scratch->own, 0) == STATUS_OK;
}

void mf_live_scratch_make(struct live_scratch *scratch) {
    const char *place = find_place();
    remove_left_over(place);
    if (try_to_make(scratch, place))
        return;
    if (scratch->own.open)
        mf_tracked_files_remove_all(&scratch->own);
    scratch->path[0] = '\0';
}

void mf_live_scratch_remove(struct live_scratch *scratch) {
    if (scratch->path[0] == '\0')
        return;
    mf_tracked_files_remove_all(&scratch->own);
    scratch->path[0] = '\0';
}
