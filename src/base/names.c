// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/names.h"

#include "base/memory.h"

#include <string.h>

/// Record number k of a list, copied as bytes: the type of the pointers in the list is not known.
static const void *record(const void *list, size_t k) {
    const void *found;
    memcpy(&found, (const char *)list + k * sizeof found, sizeof found);
    return found;
}

static const char *name_of(const void *record) {
    return *(const char *const *)record;
}

const void *mf_names_find(const void *list, const char *name) {
    size_t k = 0;
    while (record(list, k) && strcmp(name_of(record(list, k)), name) != 0)
        k++;
    return record(list, k);
}

enum status mf_names_collect(const void *list, const char *before, const char ***names) {
    size_t records = 0, count = 0;
    while (record(list, records))
        records++;
    TRY_ARRAY(*names, records + 2);
    if (before)
        (*names)[count++] = before;
    for (size_t k = 0; k < records; k++)
        (*names)[count++] = name_of(record(list, k));
    return STATUS_OK;
}

static bool is_plain(char c, const char *marks) {
    static const char usual[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
    return c != '\0' && (strchr(usual, c) || strchr(marks, c));
}

bool mf_names_is_plain(const char *name, const char *marks, size_t size) {
    size_t length = 0;
    while (is_plain(name[length], marks))
        length++;
    return length > 0 && length < size && name[length] == '\0';
}

void mf_names_adapt(const char *from, const char *marks, char *name, size_t size) {
    size_t length = 0;
    for (; from[length] && length + 1 < size; length++)
        name[length] = is_plain(from[length], marks) ? from[length] : '_';
    name[length] = '\0';
}

bool mf_names_is_reserved(const char *name) {
    static const char *const before[] = {"now_", "error_"};
    static const char *const suffix[] = {"_history",   "_flat",  "_error",
                                         "_boltzmann", "_lower", "_upper"};
    const size_t length = strlen(name);
    bool found = false;
    for (size_t k = 0; k < sizeof before / sizeof *before; k++)
        found = found || strncmp(name, before[k], strlen(before[k])) == 0;
    for (size_t k = 0; k < sizeof suffix / sizeof *suffix; k++) {
        const size_t own = strlen(suffix[k]);
        found = found || (length >= own && strcmp(name + length - own, suffix[k]) == 0);
    }
    return found;
}

/// Whether the words a and b, of one length, are "A-B" and "B-A".
static bool is_turned(const char *a, const char *b, size_t length) {
    for (size_t dash = 1; dash + 1 < length; dash++) {
        const size_t rest = length - dash - 1;
        if (a[dash] == '-' && b[rest] == '-' && strncmp(a, b + rest + 1, dash) == 0 &&
            strncmp(a + dash + 1, b, rest) == 0)
            return true;
    }
    return false;
}

bool mf_names_are_one_path(const char *a, const char *b) {
    while (*a && *b) {
        const size_t length = strcspn(a, ".");
        if (strcspn(b, ".") != length || (strncmp(a, b, length) != 0 && !is_turned(a, b, length)))
            return false;
        a += length;
        b += length;
        a += *a == '.';
        b += *b == '.';
    }
    return *a == *b;
}
