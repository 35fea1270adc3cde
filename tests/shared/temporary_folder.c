// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

int temporary_folder_create(void **state) {
    struct temporary_folder *folder = calloc(1, sizeof *folder);
    assert_non_null(folder);
    const char *parent = getenv("TMPDIR");
    snprintf(folder->path, sizeof folder->path, "%s/mesofit-test-XXXXXX", parent ? parent : "/tmp");
    assert_non_null(mkdtemp(folder->path));
    *state = folder;
    return 0;
}

static int remove_entry(const char *path, const struct stat *about, int type, struct FTW *place) {
    (void)about, (void)type, (void)place;
    return remove(path);
}

int temporary_folder_remove(void **state) {
    struct temporary_folder *folder = *state;
    const int result = nftw(folder->path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    free(folder);
    return result;
}

const char *temporary_folder_file(struct temporary_folder *folder, const char *name) {
    snprintf(folder->file, sizeof folder->file, "%s/%s", folder->path, name);
    return folder->file;
}

const char *temporary_folder_write(struct temporary_folder *folder, const char *name,
                                   const char *bytes, size_t length) {
    FILE *stream = fopen(temporary_folder_file(folder, name), "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, length, stream), length);
    assert_int_equal(fclose(stream), 0);
    return folder->file;
}

char *temporary_folder_read(const char *path) {
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        fail_msg("cannot open %s", path);
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    const size_t length = (size_t)ftell(stream);
    rewind(stream);
    char *text = calloc(length + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, length, stream), length);
    fclose(stream);
    return text;
}

bool temporary_folder_exists(const char *path) {
    struct stat about;
    return lstat(path, &about) == 0;
}
