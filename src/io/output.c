// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // fopencookie

#include "io/output.h"

#include "base/ranks.h"

#include <errno.h>
#include <fcntl.h>
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

static int close_file(void *context) {
    struct output *output = context;
    const int result = close(output->file);
    output->file = -1;
    return result;
}

enum status mf_output_open(struct output *output, const char *path) {
    *output = (struct output){.file = -1};
    const int length = snprintf(output->path, sizeof output->path, "%s", path);
    if (length < 0 || (size_t)length >= sizeof output->path)
        return mf_status_fail(STATUS_IO, "%.60s…: the path is longer than %d bytes", path,
                              OUTPUT_PATH_SIZE - 1);
    snprintf(output->temporary, sizeof output->temporary, "%s.%ld" OUTPUT_PARTIAL, output->path,
             (long)getpid());
    if (!ranks_lead()) {
        output->stream = fopen("/dev/null", "wb");
        return output->stream ? STATUS_OK
                              : mf_status_fail(STATUS_IO, "/dev/null: %s", strerror(errno));
    }
    // A file of our own: never one that is there, nor one that a link leads to.
    unlink(output->temporary);
    output->file =
        open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (output->file >= 0)
        output->stream = fopencookie(
            output, "wb", (cookie_io_functions_t){.write = write_bytes, .close = close_file});
    if (output->stream)
        return STATUS_OK;
    const int error = errno;
    if (output->file >= 0) {
        close_file(output);
        unlink(output->temporary);
    }
    return mf_status_fail(STATUS_IO, "cannot write %s: %s", output->path, strerror(error));
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
    if (error == 0 && fsync(output->file) != 0 && errno != EINVAL && errno != ENOSYS)
        error = errno;
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

enum status mf_output_commit(struct output *output) {
    if (!ranks_lead()) {
        mf_output_abandon(output);
        return STATUS_OK;
    }
    int error = search_stream(output);
    if (error == 0 && rename(output->temporary, output->path) != 0)
        error = errno;
    if (error == 0) {
        sync_folder(output->path);
        return STATUS_OK;
    }
    remove(output->temporary);
    return mf_status_fail(STATUS_IO, "cannot write %s: %s", output->path, strerror(error));
}

void mf_output_abandon(struct output *output) {
    if (output->stream == NULL)
        return;
    fclose(output->stream);
    output->stream = NULL;
    if (ranks_lead())
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
    if (!ranks_lead())
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
