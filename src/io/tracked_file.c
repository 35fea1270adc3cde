// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tracked_file.h"

#include "base/digest.h"
#include "io/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool mf_tracked_file_is_folder(const char *name) {
    return name[strlen(name) - 1] == '/';
}

/// The folder that a file is in, opened one step at a time; −1 with errno.
/// @param[out] last  what is after the last step, without a / at its end
static int enter(int place, const char *name, char last[256]) {
    int folder = openat(place, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (;;) {
        const size_t part = strcspn(name, "/");
        snprintf(last, 256, "%.*s", (int)part, name);
        if (folder < 0 || name[part] == '\0' || name[part + 1] == '\0')
            return folder;
        const int next = openat(folder, last, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        const int error = errno;
        close(folder);
        errno = error;
        folder = next;
        name += part + 1;
    }
}

static bool digest_file(int folder, const char *name, int64_t bytes, uint64_t *digest) {
    unsigned char piece[1 << 14];
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    *digest = DIGEST_OF_NOTHING;
    while (file >= 0 && bytes > 0) {
        const ssize_t got = read(file, piece, sizeof piece);
        if (got <= 0)
            break;
        mf_digest_add(digest, piece, (size_t)got);
        bytes -= got;
    }
    if (file >= 0)
        close(file);
    return file >= 0 && bytes == 0;
}

enum tracked_file_state mf_tracked_file_state(int place, const char *name,
                                              const struct manifest_entry *entry) {
    char last[256];
    struct stat about;
    uint64_t digest = 0;
    const int folder = enter(place, name, last);
    if (folder < 0)
        return errno == ENOENT ? TRACKED_FILE_ABSENT : TRACKED_FILE_OTHER;
    const bool there = fstatat(folder, last, &about, AT_SYMLINK_NOFOLLOW) == 0;
    const bool same = there && entry && S_ISREG(about.st_mode) &&
                      (entry->bytes < 0 || entry->bytes == about.st_size) &&
                      (!entry->digested || (digest_file(folder, last, entry->bytes, &digest) &&
                                            digest == entry->digest));
    close(folder);
    if (there && S_ISDIR(about.st_mode) && !mf_tracked_file_is_folder(name))
        return TRACKED_FILE_FOLDER;
    return same ? TRACKED_FILE_AS_LEFT : there ? TRACKED_FILE_OTHER : TRACKED_FILE_ABSENT;
}

void mf_tracked_file_seal(int place, struct manifest_entry *entry, int64_t *bytes) {
    char last[256];
    struct stat about;
    const int folder = enter(place, entry->name, last);
    entry->digested = false;
    entry->bytes = -1;
    entry->gone = folder < 0 || fstatat(folder, last, &about, AT_SYMLINK_NOFOLLOW) != 0;
    if (!entry->gone && S_ISREG(about.st_mode)) {
        entry->bytes = about.st_size;
        if (entry->bytes <= *bytes)
            entry->digested = digest_file(folder, last, entry->bytes, &entry->digest);
        *bytes -= entry->digested ? entry->bytes : 0;
    }
    if (folder >= 0)
        close(folder);
}

bool mf_tracked_file_is_link(int place, const char *name) {
    char last[256];
    struct stat about;
    const int folder = enter(place, name, last);
    const bool link = folder >= 0 && fstatat(folder, last, &about, AT_SYMLINK_NOFOLLOW) == 0 &&
                      S_ISLNK(about.st_mode);
    if (folder >= 0)
        close(folder);
    return link;
}

int mf_tracked_file_remove(int place, const char *name) {
    char last[256];
    const int folder = enter(place, name, last);
    if (folder < 0)
        return errno;
    const int failed = unlinkat(folder, last, mf_tracked_file_is_folder(name) ? AT_REMOVEDIR : 0);
    const int error = failed ? errno : 0;
    close(folder);
    return error;
}

// What killed processes had begun -----------------------------------------------------------------

/// What processes that were killed had begun to write in one folder: "rdf.tsv.12-3.partial" and the
/// like. @param[in] folder  its name, with / at its end, or ""
static void remove_in(const struct manifest *list, const char *folder) {
    char path[2 * OUTPUT_PATH_SIZE], name[OUTPUT_PATH_SIZE], whole[OUTPUT_PATH_SIZE];
    struct dirent **entries;
    snprintf(path, sizeof path, "%s/%s", list->folder, folder);
    const int count = scandir(path, &entries, NULL, alphasort);
    for (int k = 0; k < count; k++) {
        const size_t stem = mf_output_partial_stem(entries[k]->d_name);
        snprintf(name, sizeof name, "%.3800s%s", folder, entries[k]->d_name);
        snprintf(whole, sizeof whole, "%.3800s%.*s", folder, (int)stem, entries[k]->d_name);
        if (stem > 0 && mf_manifest_find(list, whole))
            mf_tracked_file_remove(list->place, name);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
}

void mf_tracked_file_remove_partial(const struct manifest *list) {
    char before[OUTPUT_PATH_SIZE] = "";
    remove_in(list, "");
    for (size_t k = 0; k < list->count; k++) {
        char folder[OUTPUT_PATH_SIZE];
        const char *name = list->entry[k].name, *slash = strrchr(name, '/');
        snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - name) + 1 : 0, name);
        if (strcmp(folder, before) != 0)
            remove_in(list, folder);
        memcpy(before, folder, sizeof before);
    }
}
