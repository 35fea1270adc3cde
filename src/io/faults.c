// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/faults.h"

#include <stdio.h>
#include <string.h>

/// The line that begins with these words; NULL if there is none.
static char *find_line(struct faults *faults, const char *words) {
    for (char *line = faults->text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, words, strlen(words)) == 0)
            return line;
    }
    return NULL;
}

void mf_faults_take_back(struct faults *faults, const char *words) {
    char *line = faults->reported > 0 ? find_line(faults, words) : NULL;
    if (line == NULL)
        return;
    char *next = line + strcspn(line, "\n");
    if (*next == '\n')
        next++;
    else if (line > faults->text)
        line--; // the last one takes the end of the line before with it
    memmove(line, next, strlen(next) + 1);
    faults->length = strlen(faults->text);
    faults->reported--;
    faults->count--;
    faults->full = false;
}

void mf_faults_add(struct faults *faults, const char *line) {
    const char *same = faults->reported > 0 ? find_line(faults, line) : NULL;
    if (same && strchr("\n", same[strlen(line)]))
        return;
    faults->count++;
    if (faults->full)
        return;
    char *end = faults->text + faults->length;
    const size_t capacity = FAULTS_SIZE - faults->length;
    const size_t length =
        (size_t)snprintf(end, capacity, "%s%s", faults->reported ? "\n" : "", line);
    if (length >= capacity) {
        *end = '\0'; // half a line would mislead
        faults->full = true;
        return;
    }
    faults->length += length;
    faults->reported++;
    faults->full = faults->reported == FAULTS_REPORTED;
}

enum status mf_faults_status(const struct faults *faults) {
    const size_t left_out = faults->count - faults->reported;
    if (faults->count == 0)
        return STATUS_OK;
    if (left_out == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s", faults->text);
    return mf_status_fail(STATUS_BAD_INPUT, "%s\n… and %zu more faults", faults->text, left_out);
}
