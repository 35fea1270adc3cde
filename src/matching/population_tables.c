// SPDX-License-Identifier: GPL-3.0-or-later
//
// The curves of the last generation, side by side.
#include "matching/population.h"

#include "base/memory.h"
#include "matching/curve_tables.h"

#include <stdio.h>
#include <stdlib.h>

/// A candidate in the order of the tables.
struct line {
    size_t candidate;
    double error;
};

static int compare_lines(const void *a, const void *b) {
    const struct line *x = a, *y = b;
    if (x->error != y->error)
        return x->error < y->error ? -1 : 1;
    return (x->candidate > y->candidate) - (x->candidate < y->candidate);
}

/// What has not failed, from the least error on.
static size_t sort_lines(const struct population *population, struct line *lines) {
    size_t count = 0;
    for (size_t k = 0; k < population->shown_count; k++)
        if (population->shown_error[k] < OPTIMISER_FAILED)
            lines[count++] = (struct line){k, population->shown_error[k]};
    qsort(lines, count, sizeof *lines, compare_lines);
    return count;
}

enum status mf_population_write(const struct population *population,
                                const struct inverse_folder *folder) {
    OWNED struct line *lines = NULL;
    OWNED struct curve_tables_member *member = NULL;
    if (population->shown_count == 0)
        return STATUS_OK;
    TRY_ARRAY(lines, population->shown_count);
    TRY_ARRAY(member, population->shown_count);
    const size_t count = sort_lines(population, lines);
    for (size_t k = 0; k < count; k++) {
        member[k].variables =
            population->shown + lines[k].candidate * population->parametrisation->variables;
        snprintf(member[k].name, sizeof member[k].name, "%.4g", lines[k].error);
    }
    return mf_curve_tables_write(population->parametrisation, folder, "population",
                                 "columns are named by the error of their candidate", member,
                                 count);
}
