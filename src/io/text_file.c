// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_file.h"

#include "base/growing.h"
#include "io/input.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>

struct text_place mf_text_file_place(const char *text, const char *at) {
    struct text_place place = {1, 1};
    for (const char *c = text; c < at; c++) {
        if (*c == '\n')
            place = (struct text_place){place.line + 1, 1};
        else if (((unsigned char)*c & 0xC0) != 0x80)
            place.column++;
    }
    return place;
}

static enum status fail_large(const char *file) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: the file is larger than 1 GiB", file);
}

/// Read to the end of the stream rather than trust its size: pipes have none.
static enum status read_all(FILE *stream, const char *file, char **text, size_t *length) {
    size_t capacity = 0, used = 0;
    OWNED char *bytes = NULL;
    while (!feof(stream)) {
        if (used > TEXT_FILE_LARGEST)
            return fail_large(file);
        TRY(mf_growing_reserve(&bytes, &capacity, used, used + 2, 1, 65536));
        used += fread(bytes + used, 1, capacity - 1 - used, stream);
        if (ferror(stream))
            return mf_status_fail(STATUS_IO, "%s: %s", file, strerror(errno));
    }
    bytes[used] = '\0';
    *text = bytes;
    bytes = NULL;
    *length = used;
    return STATUS_OK;
}

static void drop_byte_order_mark(char *text, size_t *length) {
    if (strncmp(text, "\xEF\xBB\xBF", 3) != 0)
        return;
    *length -= 3;
    memmove(text, text + 3, *length + 1);
}

/// A CR alone ends a line, too: texts of old Macs have no other ends.
static void end_lines(char *text, size_t length) {
    for (char *at = text; (at = memchr(at, '\r', length - (size_t)(at - text))); at++)
        if (at[1] != '\n')
            *at = '\n';
}

static enum status check_is_text(const char *file, const char *text, size_t length) {
    if (length == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file is empty", file);
    const char *nul = memchr(text, '\0', length);
    if (nul == NULL)
        return STATUS_OK;
    const struct text_place place = mf_text_file_place(text, nul);
    // A zip, as .xlsx and .ods are; UTF-16, as programs with tables call "Unicode".
    const bool sheet =
        length > 1 && (memcmp(text, "PK", 2) == 0 || memcmp(text, "\xff\xfe", 2) == 0 ||
                       memcmp(text, "\xfe\xff", 2) == 0);
    return mf_status_fail(
        STATUS_BAD_INPUT, "%s:%zu:%zu: a NUL byte: this is not a UTF-8 text file%s", file,
        place.line, place.column, sheet ? "; save the spreadsheet as CSV (UTF-8)" : "");
}

static _Thread_local const struct memory_file *memory_file_list;
static _Thread_local size_t memory_file_count;

void mf_text_file_set_memory_files(const struct memory_file *memory_files, size_t count) {
    memory_file_list = memory_files;
    memory_file_count = count;
}

const struct memory_file *mf_text_file_find_memory_file(const char *name) {
    for (size_t k = 0; k < memory_file_count; k++)
        if (strcmp(memory_file_list[k].name, name) == 0)
            return &memory_file_list[k];
    return NULL;
}

static enum status copy_text(const char *file, const char *from, char **text, size_t *length) {
    const size_t bytes = strlen(from);
    TRY(check_is_text(file, from, bytes));
    TRY_ARRAY(*text, bytes + 1);
    memcpy(*text, from, bytes + 1);
    end_lines(*text, bytes);
    *length = bytes;
    return STATUS_OK;
}

enum status mf_text_file_read(const char *file, char **text, size_t *length) {
    enum status status = STATUS_OK;
    *text = NULL;
    *length = 0;
    const struct memory_file *in_memory = mf_text_file_find_memory_file(file);
    if (in_memory && in_memory->text)
        return copy_text(file, in_memory->text, text, length);
    FILE *stream;
    struct stat about;
    TRY(mf_input_open(&stream, file));
    if (fstat(fileno(stream), &about) == 0 && about.st_size > (off_t)TEXT_FILE_LARGEST)
        CHECK(fail_large(file));
    CHECK(read_all(stream, file, text, length));
    drop_byte_order_mark(*text, length);
    CHECK(check_is_text(file, *text, *length));
    end_lines(*text, *length);
done:
    fclose(stream);
    if (status != STATUS_OK) {
        mf_memory_free(*text);
        *text = NULL;
    }
    return status;
}
