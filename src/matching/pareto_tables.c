// SPDX-License-Identifier: GPL-3.0-or-later
#include "pareto_state.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <stdio.h>
#include <stdlib.h>

enum { NAME_SIZE = 32, EXTRA_COLUMNS = 5 };

/// Parents in the order of the tables: by rank, then by the first objective.
struct line {
    size_t parent;
    uint32_t rank;
    double value;
};

static int compare_lines(const void *a, const void *b) {
    const struct line *x = a, *y = b;
    if (x->rank != y->rank)
        return x->rank < y->rank ? -1 : 1;
    if (x->value != y->value)
        return x->value < y->value ? -1 : 1;
    return (x->parent > y->parent) - (x->parent < y->parent);
}

/// Parents that have not failed, in order; `members` are on the first front and come first.
static size_t sort_lines(const struct pareto_state *state, struct line *lines, size_t *members) {
    size_t count = 0;
    *members = 0;
    for (size_t k = 0; k < mf_nsga2_parents(&state->nsga2); k++) {
        if (mf_pareto_value(state, k)[0] >= OPTIMISER_FAILED)
            continue;
        lines[count++] = (struct line){k, state->nsga2.rank[k], mf_pareto_value(state, k)[0]};
        *members += mf_pareto_is_member(state, k);
    }
    qsort(lines, count, sizeof *lines, compare_lines);
    return count;
}

/// A column of a table under construction: `rows` numbers in `memory`, which it returns.
static double *begin_column(struct data_column *column, const char *name, double *memory,
                            const char *format) {
    *column = (struct data_column){name, memory, format};
    return memory;
}

/// Rows of pareto.tsv.
/// @param[out] value  columns, shape [EXTRA_COLUMNS + 2 objectives + numbers][rows]
static void fill_front(const struct pareto_state *state, const struct line *lines, size_t rows,
                       double *const *value) {
    const size_t objectives = state->objectives;
    for (size_t k = 0; k < rows; k++) {
        const size_t parent = lines[k].parent;
        value[0][k] = (double)k + 1;
        value[1][k] = lines[k].rank;
        value[2][k] = state->progress.known && parent == state->progress.chosen;
        value[3][k] = state->nsga2.measured[parent];
        value[4][k] = mf_pareto_error(state, mf_pareto_value(state, parent));
        for (size_t m = 0; m < objectives; m++) {
            value[EXTRA_COLUMNS + m][k] = mf_pareto_value(state, parent)[m];
            value[EXTRA_COLUMNS + objectives + m][k] = state->progress.noise[m];
        }
        struct inverse_parameter found[INVERSE_MAX_NUMBERS];
        mf_parametrisation_numbers(&state->parametrisation, mf_nsga2_parent(&state->nsga2, parent),
                                   NULL, found);
        for (size_t n = 0; n < state->problem->numbers; n++)
            value[EXTRA_COLUMNS + 2 * objectives + n][k] = found[n].value;
    }
}

/// pareto.tsv: every parent that has not failed.
static enum status write_front(const struct pareto_state *state,
                               const struct inverse_folder *folder, const struct line *lines,
                               size_t rows) {
    const size_t objectives = state->objectives, of_targets = EXTRA_COLUMNS + 2 * objectives;
    const struct inverse_problem *problem = state->problem;
    const size_t max = of_targets + problem->numbers;
    char names[2 * TARGETS][NAME_SIZE], path[OUTPUT_PATH_SIZE];
    OWNED struct data_column *column = NULL;
    OWNED double *memory = NULL;
    TRY_ARRAY(column, max);
    TRY_ARRAY(memory, max * (rows + 1));
    double *value[EXTRA_COLUMNS + 2 * TARGETS + INVERSE_MAX_NUMBERS];
    static const char *const extra[EXTRA_COLUMNS] = {"member", "rank", "chosen", "measured",
                                                     "error[1]"};
    for (size_t n = 0; n < problem->numbers; n++)
        value[of_targets + n] = begin_column(&column[of_targets + n], problem->number[n].name,
                                             memory + (of_targets + n) * (rows + 1), NULL);
    for (size_t c = 0; c < of_targets; c++) {
        const size_t m = (c - EXTRA_COLUMNS) % objectives;
        if (c >= EXTRA_COLUMNS)
            snprintf(names[c - EXTRA_COLUMNS], NAME_SIZE, "%s_%s[1]",
                     mf_targets_name(state->target[m]),
                     c < EXTRA_COLUMNS + objectives ? "rmse" : "noise");
        value[c] = begin_column(&column[c], c < EXTRA_COLUMNS ? extra[c] : names[c - EXTRA_COLUMNS],
                                memory + c * (rows + 1), NULL);
    }
    fill_front(state, lines, rows, value);
    folder->file(folder->context, "pareto.tsv", path);
    return mf_data_table_write_in(path, folder->units, NULL, column, max, rows);
}

/// pareto_history.tsv: the log.
static enum status write_log(const struct pareto_state *state,
                             const struct inverse_folder *folder) {
    static const char *const first[LOG_OBJECTIVES] = {"iteration", "front", "error[1]"};
    const size_t rows = state->progress.rows, width = mf_pareto_log_width(state);
    char names[TARGETS][NAME_SIZE], path[OUTPUT_PATH_SIZE];
    struct data_column column[LOG_OBJECTIVES + TARGETS];
    OWNED double *memory = NULL;
    TRY_ARRAY(memory, width * (rows + 1));
    for (size_t c = 0; c < width; c++) {
        if (c >= LOG_OBJECTIVES)
            snprintf(names[c - LOG_OBJECTIVES], NAME_SIZE, "%s_rmse[1]",
                     mf_targets_name(state->target[c - LOG_OBJECTIVES]));
        double *value =
            begin_column(&column[c], c < LOG_OBJECTIVES ? first[c] : names[c - LOG_OBJECTIVES],
                         memory + c * (rows + 1), NULL);
        for (size_t k = 0; k < rows; k++)
            value[k] = state->log[k * width + c];
    }
    folder->file(folder->context, "pareto_history.tsv", path);
    return mf_data_table_write_in(path, folder->units, NULL, column, width, rows);
}

/// pareto_potential.tsv and so on: the members of the front, named by their numbers in pareto.tsv.
static enum status write_curves(const struct pareto_state *state,
                                const struct inverse_folder *folder, const struct line *lines,
                                size_t members) {
    OWNED struct population_member *member = NULL;
    TRY_ARRAY(member, members);
    for (size_t k = 0; k < members; k++) {
        member[k].variables = mf_nsga2_parent(&state->nsga2, lines[k].parent);
        snprintf(member[k].name, sizeof member[k].name, "%zu", k + 1);
    }
    return mf_population_write_curves(&state->parametrisation, folder, "pareto", NULL, member,
                                      members);
}

enum status mf_pareto_write_tables(const void *memory, const struct inverse_folder *folder) {
    const struct pareto_state *state = memory;
    OWNED struct line *lines = NULL;
    TRY_ARRAY(lines, state->nsga2.population);
    size_t members;
    const size_t rows = sort_lines(state, lines, &members);
    TRY(write_front(state, folder, lines, rows));
    TRY(write_log(state, folder));
    return write_curves(state, folder, lines, members);
}
