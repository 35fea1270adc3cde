// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/output.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum status output_open(struct output *output, const char *path) {
    *output = (struct output){0};
    const int length = snprintf(output->path, sizeof output->path, "%s", path);
    if (length < 0 || (size_t)length >= sizeof output->path)
        return status_fail(STATUS_IO, "%.60s…: the path is longer than %d bytes", path,
                           OUTPUT_PATH_SIZE - 1);
    snprintf(output->temporary, sizeof output->temporary, "%s.partial", output->path);
    output->stream = fopen(output->temporary, "wb");
    if (output->stream == NULL)
        return status_fail(STATUS_IO, "cannot write %s: %s", output->path, strerror(errno));
    return STATUS_OK;
}

/// Close the stream and return 0 or the error number of the first write that failed.
static int close_stream(struct output *output) {
    const bool failed_before = ferror(output->stream) != 0;
    const int error = fclose(output->stream) != 0 ? errno : 0;
    output->stream = NULL;
    // An earlier failure keeps no reason, and its bytes are lost even if the disk has room again.
    return failed_before && error == 0 ? EIO : error;
}

enum status output_commit(struct output *output) {
    int error = close_stream(output);
    if (error == 0 && rename(output->temporary, output->path) != 0)
        error = errno;
    if (error == 0)
        return STATUS_OK;
    remove(output->temporary);
    return status_fail(STATUS_IO, "cannot write %s: %s", output->path, strerror(error));
}

void output_abandon(struct output *output) {
    if (output->stream == NULL)
        return;
    fclose(output->stream);
    output->stream = NULL;
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
        return status_fail(STATUS_IO, "cannot make folder %s: %s is not a folder", path, folder);
    return status_fail(STATUS_IO, "cannot make folder %s: %s: %s", path, folder, strerror(error));
}

enum status output_make_folder(const char *path) {
    char folder[OUTPUT_PATH_SIZE];
    const int length = snprintf(folder, sizeof folder, "%s", path);
    if (length <= 0 || (size_t)length >= sizeof folder)
        return status_fail(STATUS_IO, "cannot make folder \"%.60s\": its length is %d bytes", path,
                           length);
    for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        TRY(make_one_folder(folder, path));
        *slash = '/';
    }
    return make_one_folder(folder, path);
}
