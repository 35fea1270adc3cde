// SPDX-License-Identifier: GPL-3.0-or-later
#include "engines/engine_folder.h"

#include "base/memory.h"
#include "engines/engine.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static enum status fail(const char *path, const char *what) {
    return mf_status_fail(STATUS_IO, "%s: cannot %s: %s", path, what, strerror(errno));
}

void mf_engine_path(const char *folder, const char *name, char *path) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.3800s/%.250s", folder, name);
}

static int is_own(const struct dirent *entry) {
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

/// What lies in a folder; −1: it is not there.
struct listing {
    struct dirent **entry;
    int count;
};

static struct listing list(const char *folder) {
    struct listing listing = {NULL, 0};
    listing.count = scandir(folder, &listing.entry, is_own, alphasort);
    return listing;
}

static void forget(struct listing *listing) {
    for (int k = 0; k < listing->count; k++)
        free(listing->entry[k]);
    free(listing->entry);
}

static enum status remove_one(const char *path) {
    struct stat found;
    if (lstat(path, &found) == 0 && S_ISDIR(found.st_mode))
        return mf_engine_folder_remove(path);
    return unlink(path) == 0 ? STATUS_OK : fail(path, "remove");
}

enum status mf_engine_folder_remove(const char *folder) {
    enum status status = STATUS_OK;
    struct listing inside = list(folder);
    if (inside.count < 0)
        return errno == ENOENT ? STATUS_OK : fail(folder, "read");
    for (int k = 0; k < inside.count && status == STATUS_OK; k++) {
        char path[OUTPUT_PATH_SIZE];
        mf_engine_path(folder, inside.entry[k]->d_name, path);
        status = remove_one(path);
    }
    forget(&inside);
    return status != STATUS_OK || rmdir(folder) == 0 ? status : fail(folder, "remove");
}

enum status mf_engine_folder_begin(const char *fit, bool resume) {
    static const char mark[] = "of-mesofit";
    char folder[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE];
    mf_engine_path(fit, "engine", folder);
    mf_engine_path(folder, mark, path);
    struct stat found;
    const bool there = lstat(folder, &found) == 0;
    if (there && (!S_ISDIR(found.st_mode) || access(path, F_OK) != 0))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: a folder of this name is there and is not of a fit; give another "
            "folder with -o",
            folder);
    if (!resume)
        TRY(mf_engine_folder_remove(folder));
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return fail(folder, "make the folder");
    return mf_engine_write_text(
        folder, mark, "Files of an engine that samples for a fit; the next one removes them.\n");
}

enum status mf_engine_folder_make(const char *fit, const char *folder) {
    char path[OUTPUT_PATH_SIZE];
    TRY(mf_engine_folder_remove(folder));
    snprintf(path, sizeof path, "%s", folder);
    for (char *slash = path + strlen(fit) + 1; (slash = strchr(slash, '/')) != NULL;
         *slash++ = '/') {
        *slash = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return fail(path, "make the folder");
    }
    return mkdir(path, 0777) == 0 ? STATUS_OK : fail(path, "make the folder");
}

enum status mf_engine_folder_link(const char *folder, const char *file, const char *name) {
    char beside[OUTPUT_PATH_SIZE], link[OUTPUT_PATH_SIZE], path[OUTPUT_PATH_SIZE];
    const char *slash = strrchr(file, '/');
    if (name[0] == '/') // found from anywhere
        return STATUS_OK;
    snprintf(beside, sizeof beside, "%.*s", slash ? (int)(slash - file) : 1, slash ? file : ".");
    OWNED char *from = realpath(beside, NULL);
    if (from == NULL)
        return fail(beside, "read");
    mf_engine_path(from, name, path);
    mf_engine_path(folder, name, link);
    for (char *at = strchr(link + strlen(folder) + 1, '/'); at; at = strchr(at + 1, '/')) {
        *at = '\0'; // folders on the way to it
        if (mkdir(link, 0777) != 0 && errno != EEXIST)
            return fail(link, "make the folder");
        *at = '/';
    }
    return symlink(path, link) == 0 || errno == EEXIST ? STATUS_OK : fail(link, "make the link");
}

enum status mf_engine_write(const char *folder, const char *name, engine_print *print,
                            const void *context) {
    char path[OUTPUT_PATH_SIZE];
    mf_engine_path(folder, name, path);
    unlink(path); // and not through a link
    FILE *stream = fopen(path, "w");
    if (stream == NULL)
        return fail(path, "write");
    print(context, stream);
    const bool whole = ferror(stream) == 0;
    return fclose(stream) == 0 && whole ? STATUS_OK : fail(path, "write");
}

static void print_text(const void *text, FILE *stream) {
    fputs(text, stream);
}

enum status mf_engine_write_text(const char *folder, const char *name, const char *text) {
    return mf_engine_write(folder, name, print_text, text);
}
