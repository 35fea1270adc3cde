// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // fopencookie, syncfs

#include "io/output.h"

#include "base/ranks.h"
#include "io/tracked_files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/// What the stream writes with: as its own file does, but the reason of the first failure is kept.
static ssize_t write_bytes(void *context, const char *bytes, size_t count) {
    struct output *output = context;
    size_t written = 0;
    while (written < count) {
        const ssize_t more = write(output->file, bytes + written, count - written);
        if (more < 0 && errno == EINTR)
            continue;
        if (more < 0 && output->error == 0)
            output->error = errno;
        if (more <= 0)
            break;
        written += (size_t)more;
    }
    return (ssize_t)written;
}

/// For formats whose head says where their end stands.
static int seek_byte(void *cookie, off64_t *offset, int whence) {
    const struct output *const output = cookie;
    const off64_t place = lseek64(output->file, *offset, whence);
    if (place < 0)
        return -1;
    *offset = place;
    return 0;
}

static int close_file(void *context) {
    struct output *output = context;
    const int result = close(output->file);
    output->file = -1;
    return result;
}

void mf_output_partial(char ending[OUTPUT_PARTIAL_SIZE]) {
    static atomic_uint number;
    snprintf(ending, OUTPUT_PARTIAL_SIZE, ".%ld-%u" OUTPUT_PARTIAL, (long)getpid(),
             atomic_fetch_add(&number, 1));
}

/// Go back over digits before `end`, of which there must be some.
static const char *before_digits(const char *begin, const char *end) {
    const char *first = end;
    while (first && first > begin && first[-1] >= '0' && first[-1] <= '9')
        first--;
    return first == end ? NULL : first;
}

size_t mf_output_partial_stem(const char *name) {
    const size_t length = strlen(name), last = sizeof OUTPUT_PARTIAL - 1;
    if (length < last || strcmp(name + length - last, OUTPUT_PARTIAL) != 0)
        return 0;
    const char *at = before_digits(name, name + length - last);
    if (at && at > name && at[-1] == '-')
        at = before_digits(name, at - 1);
    else
        at = NULL;
    return at && at - name > 1 && at[-1] == '.' ? (size_t)(at - name) - 1 : 0;
}

/// A file of our own: never one that is there, nor one that a link leads to.
static void make_temporary(struct output *output) {
    char ending[OUTPUT_PARTIAL_SIZE];
    do {
        mf_output_partial(ending);
        snprintf(output->temporary, sizeof output->temporary, "%s%s", output->path, ending);
        output->file =
            open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    } while (output->file < 0 && errno == EEXIST);
}

/// The whole folder may have gone.
static enum status fail(const struct output *output, int error) {
    if (error == ENOENT)
        TRY(mf_tracked_files_claim(output->path, false));
    return mf_status_fail(STATUS_IO, "cannot write %s: %s", output->path, strerror(error));
}

static enum status open_output(struct output *output, const char *path, bool later) {
    *output = (struct output){.file = -1, .later = later};
    const int length = snprintf(output->path, sizeof output->path, "%s", path);
    if (length < 0 || (size_t)length >= sizeof output->path)
        return mf_status_fail(STATUS_IO, "%.60s…: the path is longer than %d bytes", path,
                              OUTPUT_PATH_SIZE - 1);
    if (!ranks_lead()) {
        output->stream = fopen("/dev/null", "wb");
        return output->stream ? STATUS_OK
                              : mf_status_fail(STATUS_IO, "/dev/null: %s", strerror(errno));
    }
    TRY(mf_tracked_files_claim(output->path, later));
    make_temporary(output);
    if (output->file >= 0)
        output->stream = fopencookie(
            output, "wb",
            (cookie_io_functions_t){.write = write_bytes, .seek = seek_byte, .close = close_file});
    if (output->stream)
        return STATUS_OK;
    const int error = errno;
    if (output->file >= 0) {
        close_file(output);
        unlink(output->temporary);
    }
    return fail(output, error);
}

enum status mf_output_open(struct output *output, const char *path) {
    return open_output(output, path, false);
}

enum status mf_output_open_later(struct output *output, const char *path) {
    return open_output(output, path, true);
}

/// Whether files of this thread are not on the disk that are to come to it with the next one.
static _Thread_local bool some_wait;

void mf_output_leave_for_later(void) {
    some_wait = true;
}

/// Bring a file to the disk, and what waits for it; 0 or the error number.
static int sync_file(int file) {
    const int result = some_wait ? syncfs(file) : fsync(file);
    some_wait = some_wait && result != 0;
    return result == 0 || errno == EINVAL || errno == ENOSYS ? 0 : errno;
}

/// Close the stream, its bytes on the disk; 0 or the error number of the first write that failed.
static int search_stream(struct output *output) {
    const bool flushed = fflush(output->stream) == 0;
    int error = flushed ? 0 : errno;
    // Bytes of an earlier failure are lost even if the disk has room again.
    if (ferror(output->stream) && error == 0)
        error = EIO;
    if (output->error)
        error = output->error;
    if (error == 0 && output->later)
        mf_output_leave_for_later();
    else if (error == 0)
        error = sync_file(output->file);
    if (fclose(output->stream) != 0 && error == 0)
        error = errno;
    output->stream = NULL;
    return error;
}

/// The name of a file is on the disk once its folder is. Where a folder cannot be synced, the
/// name comes to the disk when the system likes.
static void sync_folder(const char *path) {
    char folder[OUTPUT_PATH_SIZE];
    const char *slash = strrchr(path, '/');
    const int length = slash == path ? 1 : slash ? (int)(slash - path) : 1;
    snprintf(folder, sizeof folder, "%.*s", length, slash ? path : ".");
    const int file = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0)
        return;
    fsync(file);
    close(file);
}

enum status mf_output_finish(struct output *output) {
    if (!ranks_lead()) {
        mf_output_abandon(output);
        return STATUS_OK;
    }
    const int error = search_stream(output);
    output->finished = error == 0;
    if (error == 0)
        return STATUS_OK;
    remove(output->temporary);
    return fail(output, error);
}

enum status mf_output_publish(struct output *output) {
    if (!ranks_lead())
        return STATUS_OK;
    output->finished = false;
    if (rename(output->temporary, output->path) != 0) {
        const int error = errno;
        remove(output->temporary);
        return fail(output, error);
    }
    if (!output->later)
        sync_folder(output->path);
    return STATUS_OK;
}

enum status mf_output_commit(struct output *output) {
    TRY(mf_output_finish(output));
    return mf_output_publish(output);
}

void mf_output_abandon(struct output *output) {
    const bool begun = output->stream || output->finished;
    if (output->stream)
        fclose(output->stream);
    output->stream = NULL;
    output->finished = false;
    if (begun && ranks_lead())
        remove(output->temporary);
}

static bool is_folder(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

/// Make one folder; `path` is the whole path that was asked for.
static enum status make_one_folder(const char *folder, const char *path) {
    if (mkdir(folder, 0777) == 0)
        return STATUS_OK;
    const int error = errno;
    if (is_folder(folder))
        return STATUS_OK;
    if (error == EEXIST)
        return mf_status_fail(STATUS_IO, "cannot make folder %s: %s is not a folder", path, folder);
    return mf_status_fail(STATUS_IO, "cannot make folder %s: %s: %s", path, folder,
                          strerror(error));
}

enum status mf_output_make_folder(const char *path) {
    char folder[OUTPUT_PATH_SIZE];
    bool done;
    if (!ranks_lead())
        return STATUS_OK;
    TRY(mf_tracked_files_make_folder(path, &done));
    if (done)
        return STATUS_OK;
    const int length = snprintf(folder, sizeof folder, "%s", path);
    if (length <= 0 || (size_t)length >= sizeof folder)
        return mf_status_fail(STATUS_IO, "cannot make folder \"%.60s\": its length is %d bytes",
                              path, length);
    for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        TRY(make_one_folder(folder, path));
        *slash = '/';
    }
    return make_one_folder(folder, path);
}
