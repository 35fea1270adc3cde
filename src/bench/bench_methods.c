// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest.h"
#include "bench/bench_point.h"

#include <stdio.h>
#include <string.h>

/// True if a list such as "aboba,shardlow" names a method, or its integrator.
static bool is_listed(const char *list, const struct bench_method *method) {
    const char *const names[] = {method->name, method->integrator->name};
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
        for (size_t k = 0; k < 2; k++)
            if (strcspn(at, ",") == strlen(names[k]) &&
                strncmp(at, names[k], strlen(names[k])) == 0)
                return true;
    return false;
}

/// Refuse a list with a name that is none of a suitable integrator.
static enum status check_names(const struct bench_method *methods, size_t count, const char *list) {
    const char *names[BENCH_MAX_METHODS];
    char hint[256], word[64];
    for (size_t k = 0; k < count; k++)
        names[k] = methods[k].name;
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        bool is_known = false;
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        for (size_t k = 0; k < count; k++)
            is_known |= is_listed(word, &methods[k]);
        if (is_known)
            continue;
        mf_nearest_hint(word, names, count, hint, sizeof hint);
        return mf_status_fail(STATUS_BAD_INPUT, "--integrators: \"%s\" does not suit the scene; %s",
                              word, hint);
    }
    return STATUS_OK;
}

enum status mf_bench_methods_listed(const struct bench_method *methods, size_t count,
                                    const char *list, struct bench_method *listed,
                                    size_t *listed_count) {
    if (list)
        TRY(check_names(methods, count, list));
    for (size_t k = 0; k < count; k++)
        if (list == NULL || is_listed(list, &methods[k]))
            listed[(*listed_count)++] = methods[k];
    return STATUS_OK;
}
