// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // scandirat
#include "live/live_scratch.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char stem[] = "mesofit-live-";
enum { LETTERS = 6, TRIES = 10 }; // of mkdtemp

static const char *find_place(void) {
    const char *place = getenv("TMPDIR");
    return place && place[0] ? place : "/tmp";
}

static int is_scratch(const struct dirent *entry) {
    return strncmp(entry->d_name, stem, strlen(stem)) == 0 &&
           strlen(entry->d_name) == strlen(stem) + LETTERS;
}

static int open_folder(int place, const char *name) {
    return openat(place, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

/// Whether the folder is ours, and still has its name.
static bool is_own(int folder) {
    struct stat about;
    return fstat(folder, &about) == 0 && about.st_uid == geteuid() && about.st_nlink > 0;
}

/// A folder with the files in it; folders in it, of which we make none, keep it.
static void remove_folder(int place, const char *name, int folder) {
    struct dirent **entries;
    const int count = scandirat(folder, ".", &entries, NULL, NULL);
    for (int k = 0; k < count; k++) {
        unlinkat(folder, entries[k]->d_name, 0);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
    unlinkat(place, name, AT_REMOVEDIR);
}

/// What no process has locked is left over. Who has just made one and comes second to the lock
/// finds it gone, and makes another.
static void remove_left_over(int place) {
    struct dirent **entries;
    const int count = scandirat(place, ".", &entries, is_scratch, NULL);
    for (int k = 0; k < count; k++) {
        const int folder = open_folder(place, entries[k]->d_name);
        if (folder >= 0 && is_own(folder) && flock(folder, LOCK_EX | LOCK_NB) == 0)
            remove_folder(place, entries[k]->d_name, folder);
        if (folder >= 0)
            close(folder);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
}

/// Make a folder and lock it; false if it went before it was locked, or cannot be made. Where files
/// cannot be locked it goes on without: then nobody else gets the lock, either.
static bool try_to_make(struct live_scratch *scratch) {
    const char *place = find_place();
    if (snprintf(scratch->path, sizeof scratch->path, "%s/%sXXXXXX", place, stem) >=
            (int)sizeof scratch->path ||
        mkdtemp(scratch->path) == NULL)
        return false;
    scratch->folder = open_folder(AT_FDCWD, scratch->path);
    if (scratch->folder < 0)
        return false;
    flock(scratch->folder, LOCK_EX);
    if (is_own(scratch->folder))
        return true;
    close(scratch->folder);
    return false;
}

void mf_live_scratch_make(struct live_scratch *scratch) {
    const int place = open(find_place(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (place >= 0) {
        remove_left_over(place);
        close(place);
    }
    for (int k = 0; k < TRIES; k++)
        if (try_to_make(scratch))
            return;
    scratch->path[0] = '\0';
}

void mf_live_scratch_remove(struct live_scratch *scratch) {
    if (scratch->path[0] == '\0')
        return;
    remove_folder(AT_FDCWD, scratch->path, scratch->folder);
    close(scratch->folder);
    scratch->path[0] = '\0';
}
