// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/methods.h"

#include <stdio.h>

#define METHOD(name) &mf_##name,
#define METHOD_OPTIMISER(record, name, summary) &mf_matching_##record,
const struct inverse_method *const mf_methods[] = {INVERSIONS(METHOD) MATCHINGS(METHOD) NULL};

const char *mf_methods_list(bool (*can)(const struct inverse_method *method),
                            char text[METHODS_TEXT_SIZE]) {
    size_t count = 0, named = 0, length = 0;
    for (size_t k = 0; mf_methods[k]; k++)
        count += can(mf_methods[k]);
    text[0] = '\0';
    for (size_t k = 0; mf_methods[k] && length < METHODS_TEXT_SIZE; k++) {
        if (!can(mf_methods[k]))
            continue;
        const char *const before = named == 0 ? "" : named + 1 < count ? ", " : " and ";
        length += (size_t)snprintf(text + length, METHODS_TEXT_SIZE - length, "%s\"%s\"", before,
                                   mf_methods[k]->name);
        named++;
    }
    return text;
}

bool mf_methods_fits_any_target(const struct inverse_method *method) {
    return method->kind == INVERSE_MATCHING;
}
