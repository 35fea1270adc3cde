// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a round of candidates has left, for a person: its curves side by side, and why some failed.
#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"
#include "matching/population.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// The columns of one curve of an unknown.
static enum status write_curve(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve,
                               const struct population_member *member, size_t members,
                               const char *comment, const struct units *units, const char *path) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    const size_t points = mf_unknowns_points(unknowns, kind);
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const size_t each = part.points, first = part.first;
    OWNED struct data_column *column = NULL;
    OWNED double *values = NULL;
    OWNED char(*names)[POPULATION_NAME_SIZE + 24] = NULL;
    TRY_ARRAY(column, members + 1);
    TRY_ARRAY(names, members);
    TRY_ARRAY(values, (members + 1) * points);
    column[0] = (struct data_column){mf_unknowns_heading(unknowns, kind, curve),
                                     mf_unknowns_r(unknowns, kind) + first, NULL};
    for (size_t k = 0; k < members; k++) {
        double *value = values + k * points;
        mf_parametrisation_curve(parametrisation, kind, member[k].variables, value);
        mf_data_table_name(units, member[k].name, mf_unknowns_unit(kind), names[k],
                           sizeof names[k]);
        column[k + 1] = (struct data_column){names[k], value + first, "%.8g"};
    }
    return mf_data_table_write_in(path, units, comment, column, members + 1, each);
}

enum status mf_population_write_curves(const struct parametrisation *parametrisation,
                                       const struct inverse_folder *folder, const char *prefix,
                                       const char *comment, const struct population_member *member,
                                       size_t members) {
    const struct unknowns *unknowns = &parametrisation->unknowns;
    char name[UNKNOWNS_NAME_SIZE], file[2 * UNKNOWNS_NAME_SIZE], path[OUTPUT_PATH_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; unknowns->problem->unknown[kind].wanted &&
                               curve < mf_unknowns_curve_count(unknowns, kind);
             curve++) {
            mf_unknowns_curve_name(unknowns, kind, curve, name);
            snprintf(file, sizeof file, "%s_%s.tsv", prefix, name);
            folder->file(folder->context, file, path);
            TRY(write_curve(parametrisation, kind, curve, member, members, comment, folder->units,
                            path));
        }
    return STATUS_OK;
}

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
    OWNED struct population_member *member = NULL;
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
    return mf_population_write_curves(population->parametrisation, folder, "population",
                                      "columns are named by the error of their candidate", member,
                                      count);
}

// What candidates have failed of ------------------------------------------------------------------

enum { CAUSE_SIZE = 160 };

void mf_population_add_failure(struct population_failures *failures,
                               const struct evaluate_result *result) {
    if (result->error < OPTIMISER_FAILED)
        return;
    const bool first = failures->count[EVALUATE_TEMPERATURE] == 0;
    failures->count[result->failure]++;
    if (result->failure != EVALUATE_TEMPERATURE)
        return;
    failures->coldest = first ? result->temperature : fmin(failures->coldest, result->temperature);
    failures->hottest = first ? result->temperature : fmax(failures->hottest, result->temperature);
}

static void describe(const struct population_failures *failures, enum evaluate_failure cause,
                     char text[CAUSE_SIZE]) {
    static const char *const others[EVALUATE_FAILURES] = {
        [EVALUATE_BLEW_UP] = "blew up: a shorter \"time_step\" or a narrower range of the curves "
                             "may help",
        [EVALUATE_COLLAPSED] = "collapsed into a drop: curves that attract less may help",
        [EVALUATE_UNMEASURED] = "did not measure all targets: more \"samples\" may help",
    };
    if (cause != EVALUATE_TEMPERATURE)
        snprintf(text, CAUSE_SIZE, "%s", others[cause]);
    else
        snprintf(text, CAUSE_SIZE,
                 "had %.3g to %.3g times their temperature after \"equilibration\": a longer one "
                 "or a shorter \"time_step\" may help",
                 failures->coldest, failures->hottest);
}

void mf_population_report_failure(const struct population *population, const char *why,
                                  char reason[INVERSE_REASON_SIZE]) {
    const struct population_failures *failures = &population->totals.failures;
    const unsigned long long all = population->totals.evaluations;
    unsigned long long failed = 0;
    enum evaluate_failure cause = EVALUATE_BLEW_UP;
    char text[CAUSE_SIZE], which[64];
    for (enum evaluate_failure k = 0; k < EVALUATE_FAILURES; k++) {
        failed += failures->count[k];
        cause = failures->count[k] > failures->count[cause] ? k : cause;
    }
    describe(failures, cause, text);
    if (failed == failures->count[cause])
        snprintf(which, sizeof which, "all %llu", failed);
    else
        snprintf(which, sizeof which, "%llu of %llu", (unsigned long long)failures->count[cause],
                 failed);
    if (failed == 0)
        snprintf(reason, INVERSE_REASON_SIZE, "all %llu simulations succeeded, %s", all, why);
    else if (failed < all)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "%llu of %llu simulations succeeded, %s; %s that failed %s", all - failed, all,
                 why, which, text);
    else
        snprintf(reason, INVERSE_REASON_SIZE, "not one simulation of the fit succeeded; %s %s",
                 which, text);
}
