// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/manifest.h"

#include "base/digest.h"
#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char head[] =
    "# Files that mesofit wrote here: digest, bytes, name. It replaces and removes no others.\n";

static enum status fail_to_read(const struct manifest *list) {
    return mf_status_fail(STATUS_IO, "%s/%s: %s", list->folder, list->name, strerror(errno));
}

static enum status fail_to_write(const struct manifest *list) {
    return mf_status_fail(STATUS_IO, "cannot write %s/%s: %s", list->folder, list->name,
                          strerror(errno));
}

bool mf_manifest_accepts(const char *name) {
    for (const char *letter = name; *letter; letter++)
        if ((unsigned char)*letter < ' ' || *letter == 127)
            return false;
    if (*name == '\0')
        return false;
    while (*name) {
        const size_t part = strcspn(name, "/");
        if (part == 0 || strncmp(name, "..", part) == 0)
            return false;
        name += part + (name[part] == '/');
    }
    return true;
}

// In memory ---------------------------------------------------------------------------------------

static size_t hash(const struct manifest *list, const char *name) {
    uint64_t digest = DIGEST_OF_NOTHING;
    mf_digest_add(&digest, name, strlen(name));
    return (size_t)digest & (2 * list->capacity - 1);
}

/// Where the number of an entry stands, counted from 1, or would.
static size_t *place_of(const struct manifest *list, const char *name) {
    size_t at = hash(list, name);
    while (list->number[at] && strcmp(list->entry[list->number[at] - 1].name, name) != 0)
        at = (at + 1) & (2 * list->capacity - 1);
    return &list->number[at];
}

static enum status reserve(struct manifest *list) {
    enum { FIRST = 64 };
    enum status status = STATUS_OK;
    struct manifest larger = *list;
    if (list->count < list->capacity)
        return STATUS_OK;
    larger.capacity = list->capacity ? 2 * list->capacity : FIRST;
    larger.entry = NULL;
    larger.number = NULL;
    NEW_ARRAY(larger.entry, larger.capacity);
    NEW_ARRAY(larger.number, 2 * larger.capacity);
    if (list->count > 0)
        memcpy(larger.entry, list->entry, list->count * sizeof *larger.entry);
    for (size_t k = 0; k < list->count; k++)
        *place_of(&larger, larger.entry[k].name) = k + 1;
    mf_memory_free(list->entry);
    mf_memory_free(list->number);
    *list = larger;
    return STATUS_OK;
done:
    mf_memory_free(larger.entry);
    return status;
}

enum status mf_manifest_add(struct manifest *list, const char *name,
                            struct manifest_entry **entry) {
    TRY(reserve(list));
    size_t *number = place_of(list, name);
    if (*number == 0) {
        char *copy = mf_memory_zeroed(strlen(name) + 1, 1);
        if (copy == NULL)
            return STATUS_NO_MEMORY;
        list->entry[list->count].name = strcpy(copy, name);
        *number = ++list->count;
    }
    *entry = &list->entry[*number - 1];
    **entry = (struct manifest_entry){.name = (*entry)->name, .bytes = -1};
    return STATUS_OK;
}

struct manifest_entry *mf_manifest_find(const struct manifest *list, const char *name) {
    const size_t number = list->capacity > 0 ? *place_of(list, name) : 0;
    return number > 0 && !list->entry[number - 1].gone ? &list->entry[number - 1] : NULL;
}

static void age(struct manifest *list, bool earlier) {
    for (size_t k = 0; k < list->count; k++)
        list->entry[k].earlier = earlier;
}

void mf_manifest_clear(struct manifest *list) {
    for (size_t k = 0; k < list->count; k++)
        mf_memory_free(list->entry[k].name);
    mf_memory_free(list->entry);
    mf_memory_free(list->number);
    if (list->file >= 0)
        close(list->file);
    list->entry = NULL;
    list->number = NULL;
    list->count = list->capacity = 0;
    list->file = -1;
    list->began = 0;
}

// On the disk -------------------------------------------------------------------------------------

static enum status read_line(struct manifest *list, char *line) {
    char *bytes, *name;
    struct manifest_entry *entry;
    if (strncmp(line, "begin ", 6) == 0) {
        list->began = strtoull(line + 6, NULL, 16);
        age(list, true);
    }
    if (strcmp(line, "keep") == 0)
        age(list, false);
    bytes = strchr(line, '\t');
    name = bytes ? strchr(bytes + 1, '\t') : NULL;
    if (name == NULL || !mf_manifest_accepts(name + 1))
        return STATUS_OK;
    *bytes = *name = '\0';
    TRY(mf_manifest_add(list, name + 1, &entry));
    entry->gone = strcmp(line, "gone") == 0;
    entry->digested = strspn(line, "0123456789abcdef") == 16;
    entry->digest = entry->digested ? strtoull(line, NULL, 16) : 0;
    entry->bytes = bytes[1] == '-' ? -1 : strtoll(bytes + 1, NULL, 10);
    return STATUS_OK;
}

static enum status read_lines(struct manifest *list, FILE *stream) {
    enum status status = STATUS_OK;
    char *line = NULL;
    size_t size = 0;
    ssize_t length;
    while (status == STATUS_OK && (length = getline(&line, &size, stream)) > 0) {
        if (line[length - 1] != '\n')
            break;
        line[length - 1] = '\0';
        status = read_line(list, line);
    }
    free(line);
    return status == STATUS_OK && ferror(stream) ? fail_to_read(list) : status;
}

/// A file, and no link to one; NULL with errno.
static FILE *open_to_read(const struct manifest *list) {
    struct stat about;
    const int file =
        openat(list->place, list->name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return NULL;
    FILE *stream = fdopen(file, "rb");
    if (stream == NULL)
        close(file);
    else if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) {
        fclose(stream);
        stream = NULL;
        errno = ELOOP;
    }
    return stream;
}

enum status mf_manifest_read(struct manifest *list) {
    mf_manifest_clear(list);
    FILE *stream = open_to_read(list);
    list->there = stream || errno != ENOENT;
    if (!list->there)
        return STATUS_OK;
    if (stream == NULL && errno == ELOOP)
        return mf_status_fail(STATUS_BAD_INPUT, "%s/%s is a link or not a regular file: remove it",
                              list->folder, list->name);
    if (stream == NULL)
        return fail_to_read(list);
    const enum status status = read_lines(list, stream);
    fclose(stream);
    return status;
}

static bool write_whole(int file, const char *text, size_t length) {
    const off_t before = lseek(file, 0, SEEK_END);
    size_t written = 0;
    while (written < length) {
        const ssize_t more = write(file, text + written, length - written);
        if (more < 0 && errno == EINTR)
            continue;
        if (more <= 0)
            break;
        written += (size_t)more;
    }
    const int error = errno;
    const bool whole = written == length;
    if (!whole && written > 0 && ftruncate(file, before) != 0)
        return false;
    errno = error;
    return whole;
}

/// A new file says what it is; a line that was cut short is ended.
static enum status open_to_append(struct manifest *list) {
    char last = '\n';
    if (list->file >= 0)
        return STATUS_OK;
    list->file = openat(list->place, list->name,
                        O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (list->file < 0)
        return fail_to_write(list);
    const off_t size = lseek(list->file, 0, SEEK_END);
    if (size > 0 && pread(list->file, &last, 1, size - 1) != 1)
        return fail_to_write(list);
    const char *text = size > 0 ? "\n" : head;
    if ((size > 0 && last == '\n') || write_whole(list->file, text, strlen(text)))
        return STATUS_OK;
    return fail_to_write(list);
}

/// A power cut must not leave a file that is not in the list.
static enum status append(struct manifest *list, const char *text, size_t length) {
    TRY(open_to_append(list));
    if (!write_whole(list->file, text, length))
        return fail_to_write(list);
    if (!list->later)
        fdatasync(list->file);
    return STATUS_OK;
}

static void print(const struct manifest_entry *entry, FILE *stream) {
    if (entry->gone)
        fputs("gone\t-", stream);
    else if (entry->digested)
        fprintf(stream, "%016" PRIx64 "\t%" PRId64, entry->digest, entry->bytes);
    else if (entry->bytes >= 0)
        fprintf(stream, "-\t%" PRId64, entry->bytes);
    else
        fputs("-\t-", stream);
    fprintf(stream, "\t%s\n", entry->name);
}

enum status mf_manifest_begin(struct manifest *list, uint64_t digest) {
    char line[32];
    const int length = snprintf(line, sizeof line, "begin %016" PRIx64 "\n", digest);
    TRY(append(list, line, (size_t)length));
    list->began = digest;
    age(list, true);
    return STATUS_OK;
}

enum status mf_manifest_keep(struct manifest *list) {
    TRY(append(list, "keep\n", 5));
    age(list, false);
    return STATUS_OK;
}

enum status mf_manifest_enter(struct manifest *list, struct manifest_entry *const *entry,
                              size_t count) {
    char *text = NULL;
    size_t length = 0;
    FILE *stream = count > 0 ? open_memstream(&text, &length) : NULL;
    if (count == 0)
        return STATUS_OK;
    for (size_t k = 0; stream && k < count; k++)
        print(entry[k], stream);
    const bool printed = stream && fclose(stream) == 0;
    const enum status status =
        printed ? append(list, text, length) : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    free(text);
    return status;
}

static void print_all(const struct manifest *list, FILE *stream) {
    fprintf(stream, "%sbegin %016" PRIx64 "\n", head, list->began);
    for (size_t k = 0; k < list->count; k++)
        if (!list->entry[k].gone && !list->entry[k].earlier)
            print(&list->entry[k], stream);
}

void mf_manifest_compact(struct manifest *list) {
    char whole[64];
    snprintf(whole, sizeof whole, "%s.new", list->name);
    const int file =
        openat(list->place, whole, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *stream = file >= 0 ? fdopen(file, "wb") : NULL;
    if (stream == NULL)
        return;
    print_all(list, stream);
    bool written = fflush(stream) == 0 && fsync(file) == 0;
    written = fclose(stream) == 0 && written;
    if (!written || renameat(list->place, whole, list->place, list->name) != 0) {
        unlinkat(list->place, whole, 0);
        return;
    }
    if (list->file >= 0)
        close(list->file);
    list->file = -1;
}
