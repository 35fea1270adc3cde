// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/input.h"

#include "base/growing.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { INPUT_PATH_SIZE = 4096 };

/// What a file is if it is none that can be read to its end; NULL if it is one.
static const char *wrong_kind(const struct stat *about) {
    if (S_ISREG(about->st_mode) || S_ISFIFO(about->st_mode))
        return NULL;
    return S_ISDIR(about->st_mode)    ? "a folder"
           : S_ISSOCK(about->st_mode) ? "a socket"
                                      : "a device";
}

/// Whether there is a file of the same name but for a pair of types in the other order:
/// "rdf_B-A.tsv" for "rdf_A-B.tsv", "B-A.dist.tgt" for "A-B.dist.tgt".
static bool find_other_order(const char *file, char other[INPUT_PATH_SIZE]) {
    const char *const slash = strrchr(file, '/'), *const base = slash ? slash + 1 : file;
    const char *const end = base + strcspn(base, ".");
    for (const char *pair = base; pair < end; pair += strcspn(pair, "_.") + 1)
        for (const char *dash = pair + 1; dash + 1 < end; dash++) {
            if (*dash != '-')
                continue;
            snprintf(other, INPUT_PATH_SIZE, "%.*s%.*s-%.*s%s", (int)(pair - file), file,
                     (int)(end - dash - 1), dash + 1, (int)(dash - pair), pair, end);
            if (strcmp(other, file) != 0 && access(other, R_OK) == 0)
                return true;
        }
    return false;
}

static enum status fail_to_open(const char *file, int error) {
    char other[INPUT_PATH_SIZE];
    if (error == ENOENT && find_other_order(file, other))
        return mf_status_fail(STATUS_IO,
                              "%s: %s, but %s, the same pair in the other order, is "
                              "there",
                              file, strerror(error), other);
    return mf_status_fail(STATUS_IO, "%s: %s", file, strerror(error));
}

enum status mf_input_open(FILE **stream, const char *file) {
    struct stat about;
    *stream = NULL;
    // Before it is opened, since opening can do something to a device, and again of what was
    // opened.
    const char *kind = stat(file, &about) == 0 ? wrong_kind(&about) : NULL;
    if (kind == NULL && (*stream = fopen(file, "rbe")) == NULL)
        return fail_to_open(file, errno);
    if (kind == NULL && fstat(fileno(*stream), &about) == 0)
        kind = wrong_kind(&about);
    if (kind == NULL)
        return STATUS_OK;
    if (*stream)
        fclose(*stream);
    *stream = NULL;
    return mf_status_fail(STATUS_IO, "%s: is %s, not a file", file, kind);
}

enum status mf_input_files_add(struct input_files *inputs, const char *name) {
    struct stat about;
    if (stat(name, &about) != 0)
        return STATUS_OK;
    TRY(mf_growing_reserve(&inputs->file, &inputs->capacity, inputs->count, inputs->count + 1,
                           sizeof *inputs->file, 16));
    char *copy = mf_memory_zeroed(strlen(name) + 1, 1);
    if (copy == NULL)
        return STATUS_NO_MEMORY;
    strcpy(copy, name);
    inputs->file[inputs->count++] = (struct input_file){about.st_dev, about.st_ino, copy};
    return STATUS_OK;
}

enum status mf_input_files_protect(const struct input_files *inputs, const char *path) {
    struct stat about;
    if (stat(path, &about) != 0)
        return STATUS_OK;
    for (size_t k = 0; k < inputs->count; k++) {
        const struct input_file *input = &inputs->file[k];
        if (input->device == about.st_dev && input->number == about.st_ino)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s would be replaced, but the run reads it as %s: write elsewhere "
                "with -o",
                path, input->name);
    }
    return STATUS_OK;
}

void mf_input_files_clear(struct input_files *inputs) {
    for (size_t k = 0; k < inputs->count; k++)
        mf_memory_free(inputs->file[k].name);
    mf_memory_free(inputs->file);
    *inputs = (struct input_files){0};
}
