// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/faults.h"

#include <stdio.h>

void mf_faults_add(struct faults *faults, const char *line) {
    faults->count++;
    if (faults->full)
        return;
    char *end = faults->text + faults->length;
    const size_t room = FAULTS_SIZE - faults->length;
    const size_t length = (size_t)snprintf(end, room, "%s%s", faults->told ? "\n" : "", line);
    if (length >= room) {
        *end = '\0'; // half a line would mislead
        faults->full = true;
        return;
    }
    faults->length += length;
    faults->told++;
    faults->full = faults->told == FAULTS_TOLD;
}

enum status mf_faults_status(const struct faults *faults) {
    const size_t left_out = faults->count - faults->told;
    if (faults->count == 0)
        return STATUS_OK;
    if (left_out == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s", faults->text);
    return mf_status_fail(STATUS_BAD_INPUT, "%s\n… and %zu more faults", faults->text, left_out);
}
