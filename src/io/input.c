// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/input.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

/// What a file is if it is none that can be read to its end; NULL if it is one.
static const char *wrong_kind(const struct stat *about) {
    if (S_ISREG(about->st_mode) || S_ISFIFO(about->st_mode))
        return NULL;
    return S_ISDIR(about->st_mode)    ? "a folder"
           : S_ISSOCK(about->st_mode) ? "a socket"
                                      : "a device";
}

enum status input_open(FILE **stream, const char *file) {
    struct stat about;
    *stream = NULL;
    // Before it is opened, since opening can do something to a device, and again of what was
    // opened.
    const char *kind = stat(file, &about) == 0 ? wrong_kind(&about) : NULL;
    if (kind == NULL && (*stream = fopen(file, "rbe")) == NULL)
        return status_fail(STATUS_IO, "%s: %s", file, strerror(errno));
    if (kind == NULL && fstat(fileno(*stream), &about) == 0)
        kind = wrong_kind(&about);
    if (kind == NULL)
        return STATUS_OK;
    if (*stream)
        fclose(*stream);
    *stream = NULL;
    return status_fail(STATUS_IO, "%s: is %s, not a file", file, kind);
}
