// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // scandirat
#include "live/live_folder.h"

#include "base/visible.h"
#include "io/json_write.h"
#include "io/output.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// What a page may write: settings and data, nothing that is run.
static const char *const endings[] = {".json", ".tsv", ".txt", ".csv", ".xvg", ".dat", ".pot"};

static bool is_plain_name(const char *name, size_t length) {
    for (size_t k = 0, bytes; k < length; k += bytes) {
        bytes = mf_visible_character(name + k, length - k);
        if (bytes == 0 || (unsigned char)name[k] < ' ' || name[k] == 127 || name[k] == '\\')
            return false;
    }
    return length > 0 && length <= 255 && name[0] != '.';
}

bool mf_live_folder_is_plain(const char *path) {
    if (strlen(path) >= OUTPUT_PATH_SIZE)
        return false;
    while (*path) {
        const size_t length = strcspn(path, "/");
        if (!is_plain_name(path, length))
            return false;
        path += length;
        if (*path == '/' && *++path == '\0')
            return false;
    }
    return true;
}

static int refuse(const char *path) {
    mf_status_fail(STATUS_BAD_INPUT, "\"%.200s\" is not a file of the working folder", path);
    return -1;
}

static int report_error(const char *path) {
    mf_status_fail(STATUS_IO, "%.200s: %s", path,
                   errno == ELOOP ? "links are not followed" : strerror(errno));
    return -1;
}

/// Go down the first `length` bytes of a path that is plain, one name at a time; −1 with errno.
static int go_down(int root, const char *path, size_t length) {
    int folder = openat(root, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    for (size_t at = 0; at < length && folder >= 0;) {
        char name[256];
        const size_t part = strcspn(path + at, "/");
        snprintf(name, sizeof name, "%.*s", (int)part, path + at);
        const int next = openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        const int error = errno;
        close(folder);
        errno = error;
        folder = next;
        at += part + 1;
    }
    return folder;
}

static int descend(int root, const char *path, size_t length) {
    const int folder = go_down(root, path, length);
    return folder >= 0 ? folder : report_error(path);
}

int mf_live_folder_enter(int root, const char *path) {
    return mf_live_folder_is_plain(path) ? descend(root, path, strlen(path)) : refuse(path);
}

enum status mf_live_folder_check_new(int root, const char *path) {
    if (!mf_live_folder_is_plain(path))
        return mf_status_fail(STATUS_BAD_INPUT, "\"%.200s\" is not a folder of the working folder",
                              path);
    const int folder = go_down(root, path, strlen(path));
    if (folder < 0 && errno != ENOENT)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "\"%.200s\" passes through a file or a link; links are not followed",
                              path);
    if (folder >= 0)
        close(folder);
    return STATUS_OK;
}

/// The folder that a path's last name is in; *name points to that.
static int enter_parent(int root, const char *path, const char **name) {
    const char *slash = strrchr(path, '/');
    *name = slash ? slash + 1 : path;
    return mf_live_folder_is_plain(path) && path[0]
               ? descend(root, path, slash ? (size_t)(slash - path) : 0)
               : refuse(path);
}

/// Opening a FIFO must not wait for who writes it.
static int open_regular(int folder, const char *name, size_t *size) {
    struct stat status;
    const int file = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return report_error(name);
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        *size = (size_t)status.st_size;
        return file;
    }
    close(file);
    mf_status_fail(STATUS_BAD_INPUT, "%.200s is not a regular file", name);
    return -1;
}

int mf_live_folder_read(int root, const char *path, size_t *size) {
    const char *name;
    const int folder = enter_parent(root, path, &name);
    if (folder < 0)
        return -1;
    const int file = open_regular(folder, name, size);
    close(folder);
    return file;
}

static bool may_be_written(const char *name) {
    const char *end = strrchr(name, '.');
    for (size_t k = 0; end && k < sizeof endings / sizeof *endings; k++)
        if (strcmp(end, endings[k]) == 0)
            return true;
    return false;
}

static enum status write_bytes(int file, const char *name, const char *bytes, size_t size) {
    while (size > 0) {
        const ssize_t written = write(file, bytes, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return mf_status_fail(STATUS_IO, "%.200s: %s", name, strerror(errno));
        bytes += written;
        size -= (size_t)written;
    }
    return fsync(file) == 0 ? STATUS_OK
                            : mf_status_fail(STATUS_IO, "%.200s: %s", name, strerror(errno));
}

/// A hard link fails if the name is taken, a rename replaces it, though not what is no file: a link
/// is somebody's way to another one.
static enum status give_name(int folder, const char *partial, const char *name, bool replace) {
    struct stat about;
    if (replace && fstatat(folder, name, &about, AT_SYMLINK_NOFOLLOW) == 0 &&
        !S_ISREG(about.st_mode))
        return mf_status_fail(STATUS_BAD_INPUT, "%.200s is no plain file: it is not replaced",
                              name);
    const int failed = replace ? renameat(folder, partial, folder, name)
                               : linkat(folder, partial, folder, name, 0);
    if (failed && errno == EEXIST)
        return mf_status_fail(STATUS_BAD_INPUT, "%.200s is there already", name);
    return failed ? mf_status_fail(STATUS_IO, "%.200s: %s", name, strerror(errno)) : STATUS_OK;
}

/// A new file of a name that nothing has: each connection writes from a thread of its own, and a
/// program before this one may have had the same number.
static int open_partial(int folder, char *partial, size_t size) {
    char ending[OUTPUT_PARTIAL_SIZE];
    int file;
    do {
        mf_output_partial(ending);
        snprintf(partial, size, ".live%s", ending);
        file = openat(folder, partial, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    } while (file < 0 && errno == EEXIST);
    return file;
}

static enum status write_in(int folder, const char *name, const void *bytes, size_t size,
                            bool replace) {
    char partial[64];
    const int file = open_partial(folder, partial, sizeof partial);
    if (file < 0)
        return mf_status_fail(STATUS_IO, "%.200s: %s", name, strerror(errno));
    enum status status = write_bytes(file, name, bytes, size);
    close(file);
    if (status == STATUS_OK)
        status = give_name(folder, partial, name, replace);
    unlinkat(folder, partial, 0);
    return status;
}

enum status mf_live_folder_write(int root, const char *path, const void *bytes, size_t size,
                                 bool replace) {
    const char *name;
    if (!may_be_written(path))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "\"%.200s\": the page writes .json, .tsv, .txt, .csv, .xvg, .dat and "
                              ".pot alone",
                              path);
    const int folder = enter_parent(root, path, &name);
    if (folder < 0)
        return STATUS_BAD_INPUT;
    const enum status status = write_in(folder, name, bytes, size, replace);
    close(folder);
    return status;
}

/// Names of a folder that a plain path can have, sorted; −1 with a message.
static int scan(int folder, const char *path, struct dirent ***entries) {
    const int count = scandirat(folder, ".", entries, NULL, alphasort);
    return count >= 0 ? count : report_error(path);
}

static void insert_entry(struct json_writer *writer, int folder, const char *name) {
    struct stat status;
    if (!is_plain_name(name, strlen(name)) ||
        fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) != 0 ||
        (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)))
        return;
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "name", name);
    mf_json_write_integer(writer, "folder", S_ISDIR(status.st_mode));
    mf_json_write_integer(writer, "size", status.st_size);
    mf_json_write_number(writer, "seconds",
                         (double)status.st_mtim.tv_sec + 1e-9 * (double)status.st_mtim.tv_nsec);
    mf_json_end(writer);
}

enum status mf_live_folder_list(int root, const char *path, FILE *stream) {
    struct dirent **entries;
    const int folder = mf_live_folder_enter(root, path);
    if (folder < 0)
        return STATUS_BAD_INPUT;
    const int count = scan(folder, path, &entries);
    struct json_writer *writer = mf_json_writer_create_list();
    for (int k = 0; k < count; k++) {
        if (writer)
            insert_entry(writer, folder, entries[k]->d_name);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
    close(folder);
    const enum status status = count < 0 ? STATUS_IO
                               : writer  ? mf_json_write_stream(writer, stream, path)
                                         : STATUS_NO_MEMORY;
    mf_json_writer_free(writer);
    return status;
}

/// One entry: a file is acted upon, a folder entered.
static enum status visit(int root, int folder, const char *name, const char *entry, int deep,
                         enum status (*act)(void *, int, size_t, const char *), void *context) {
    struct stat status;
    size_t size;
    if (!is_plain_name(entry, strlen(entry)) || strlen(name) >= OUTPUT_PATH_SIZE - 1 ||
        fstatat(folder, entry, &status, AT_SYMLINK_NOFOLLOW) != 0)
        return STATUS_OK;
    if (S_ISDIR(status.st_mode) && deep > 0)
        return mf_live_folder_each(root, name, deep - 1, act, context);
    if (!S_ISREG(status.st_mode))
        return STATUS_OK;
    const int file = open_regular(folder, entry, &size);
    if (file < 0)
        return STATUS_IO;
    const enum status done = act(context, file, size, name);
    close(file);
    return done;
}

enum status mf_live_folder_each(int root, const char *path, int deep,
                                enum status (*act)(void *context, int file, size_t size,
                                                   const char *name),
                                void *context) {
    enum status status = STATUS_OK;
    struct dirent **entries;
    const int folder = mf_live_folder_enter(root, path);
    if (folder < 0)
        return STATUS_BAD_INPUT;
    const int count = scan(folder, path, &entries);
    for (int k = 0; k < count; k++) {
        char name[OUTPUT_PATH_SIZE + 256];
        snprintf(name, sizeof name, "%s%s%s", path, path[0] ? "/" : "", entries[k]->d_name);
        if (status == STATUS_OK)
            status = visit(root, folder, name, entries[k]->d_name, deep, act, context);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
    close(folder);
    return count < 0 ? STATUS_IO : status;
}

// A folder for a while ----------------------------------------------------------------------------

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
