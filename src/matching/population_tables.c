// SPDX-License-Identifier: GPL-3.0-or-later
//
// The curves of the last generation, side by side.
#include "matching/population.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <stdio.h>
#include <stdlib.h>

enum { NAME_SIZE = 16 };

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

/// One of the curves that an unknown is made of, of all candidates.
static enum status write_curve(const struct population *population, enum unknown_kind kind,
                               size_t curve, const struct inverse_folder *folder,
                               const struct line *lines, size_t count) {
    enum status status = STATUS_OK;
    const struct parametrisation *parametrisation = population->parametrisation;
    const struct unknowns *unknowns = &parametrisation->unknowns;
    const size_t points = mf_unknowns_points(unknowns, kind);
    const size_t each = mf_unknowns_points_each(unknowns, kind), first = curve * each;
    struct data_column *column = NULL;
    double *values = NULL;
    char *names = NULL, name[UNKNOWNS_NAME_SIZE], file[UNKNOWNS_NAME_SIZE + 16];
    char path[OUTPUT_PATH_SIZE];
    NEW_ARRAY(column, count + 1);
    NEW_ARRAY(values, (count + 1) * points);
    NEW_ARRAY(names, (count + 1) * NAME_SIZE);
    column[0] = (struct data_column){"r[lambda]", mf_unknowns_r(unknowns, kind) + first, NULL};
    for (size_t k = 0; k < count; k++) {
        const double *variables =
            population->shown + lines[k].candidate * parametrisation->variables;
        snprintf(names + k * NAME_SIZE, NAME_SIZE, "%.4g", lines[k].error);
        mf_parametrisation_curve(parametrisation, kind, variables, values + k * points);
        column[k + 1] =
            (struct data_column){names + k * NAME_SIZE, values + k * points + first, "%.6g"};
    }
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    snprintf(file, sizeof file, "population_%s.tsv", name);
    folder->file(folder->context, file, path);
    CHECK(mf_data_table_write(path, "columns are named by the error of their candidate", column,
                              count + 1, each));
done:
    mf_memory_free(column);
    mf_memory_free(values);
    mf_memory_free(names);
    return status;
}

enum status mf_population_write(const struct population *population,
                                const struct inverse_folder *folder) {
    enum status status = STATUS_OK;
    const struct unknowns *unknowns = &population->parametrisation->unknowns;
    struct line *lines = NULL;
    if (population->shown_count == 0)
        return STATUS_OK;
    NEW_ARRAY(lines, population->shown_count);
    const size_t count = sort_lines(population, lines);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; unknowns->problem->unknown[kind].wanted &&
                               curve < mf_unknowns_curve_count(unknowns, kind);
             curve++)
            CHECK(write_curve(population, kind, curve, folder, lines, count));
done:
    mf_memory_free(lines);
    return status;
}
