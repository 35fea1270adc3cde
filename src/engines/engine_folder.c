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

static bool is_dots(const char *name) {
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
}

enum status mf_engine_folder_remove(const char *folder) {
    enum status status = STATUS_OK;
    DIR *listing = opendir(folder);
    if (listing == NULL)
        return errno == ENOENT ? STATUS_OK : fail(folder, "read");
    for (struct dirent *entry = readdir(listing); entry && status == STATUS_OK;
         entry = readdir(listing)) {
        char path[OUTPUT_PATH_SIZE];
        struct stat found;
        if (is_dots(entry->d_name))
            continue;
        mf_engine_path(folder, entry->d_name, path);
        if (lstat(path, &found) == 0 && S_ISDIR(found.st_mode))
            status = mf_engine_folder_remove(path);
        else if (unlink(path) != 0)
            status = fail(path, "remove");
    }
    closedir(listing);
    if (status == STATUS_OK && rmdir(folder) != 0)
        status = fail(folder, "remove");
    return status;
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

enum status mf_engine_folder_link(const char *folder, const char *file, const char *fit) {
    enum status status = STATUS_OK;
    char beside[OUTPUT_PATH_SIZE];
    snprintf(beside, sizeof beside, "%s", file);
    char *slash = strrchr(beside, '/');
    *(slash ? slash : beside + 1) = '\0';
    OWNED char *from = realpath(slash ? beside : ".", NULL), *own = realpath(fit, NULL);
    DIR *listing = from ? opendir(from) : NULL;
    if (listing == NULL)
        return fail(beside, "read");
    for (struct dirent *entry = readdir(listing); entry && status == STATUS_OK;
         entry = readdir(listing)) {
        char target[OUTPUT_PATH_SIZE], link[OUTPUT_PATH_SIZE];
        mf_engine_path(from, entry->d_name, target);
        mf_engine_path(folder, entry->d_name, link);
        if (is_dots(entry->d_name) || (own && strcmp(own, target) == 0))
            continue;
        if (symlink(target, link) != 0 && errno != EEXIST)
            status = fail(link, "make the link");
    }
    closedir(listing);
    return status;
}

enum status mf_engine_write(const char *folder, const char *name, engine_print *print,
                            const void *context) {
    char path[OUTPUT_PATH_SIZE];
    mf_engine_path(folder, name, path);
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
