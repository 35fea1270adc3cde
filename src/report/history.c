// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/history.h"

#include "base/memory.h"
#include "io/data_table.h"

#include <math.h>
#include <string.h>

enum { COMMON = 5, MAX_COLUMNS = COMMON + INVERSE_EXTRA, FIRST_ROOM = 32 };

void mf_history_init(struct history *history, const struct inverse_method *method,
                     const size_t points[UNKNOWNS], const struct inverse_problem *problem) {
    *history = (struct history){.problem = problem};
    while (method->columns[history->extra])
        history->extra++;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        history->points[kind] = points[kind];
}

/// Move rows of `row` numbers to where there is room for more.
static enum status enlarge(double **values, size_t row, size_t used, size_t capacity) {
    double *larger = NULL;
    if (row == 0)
        return STATUS_OK;
    TRY_ARRAY(larger, row * capacity);
    if (used > 0)
        memcpy(larger, *values, row * used * sizeof *larger);
    mf_memory_free(*values);
    *values = larger;
    return STATUS_OK;
}

static enum status enlarge_times(struct history *history, size_t used, size_t capacity) {
    struct history_time *larger = NULL;
    TRY_ARRAY(larger, capacity);
    if (used > 0)
        memcpy(larger, history->times, used * sizeof *larger);
    mf_memory_free(history->times);
    history->times = larger;
    return STATUS_OK;
}

/// Twice the room, or more, so that it is made seldom.
static enum status grow(struct history *history, size_t wanted) {
    const size_t used = history->capacity;
    size_t capacity = used > 0 ? used : FIRST_ROOM;
    while (capacity < wanted)
        capacity *= 2;
    TRY(enlarge(&history->rows, COMMON + history->extra, used, capacity));
    TRY(enlarge_times(history, used, capacity));
    TRY(enlarge(&history->numbers, 2 * history->problem->numbers, used, capacity));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        TRY(enlarge(&history->curve[kind], history->points[kind], used, capacity));
    history->capacity = capacity;
    return STATUS_OK;
}

enum status mf_history_reserve(struct history *history) {
    return history->iterations > history->capacity ? grow(history, history->iterations) : STATUS_OK;
}

double mf_history_first_error(const struct history *history) {
    return history->iterations > 0 ? history->rows[3] : NAN;
}

void mf_history_clear(struct history *history) {
    mf_memory_free(history->rows);
    mf_memory_free(history->times);
    mf_memory_free(history->numbers);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(history->curve[kind]);
    *history = (struct history){0};
}

double mf_history_seconds(const struct history *history) {
    return history->iterations > 0 ? history->times[history->iterations - 1].seconds : 0;
}

enum status mf_history_add(struct history *history, const struct inverse_step *step,
                           struct history_time time) {
    if (history->iterations == history->capacity)
        TRY(grow(history, history->iterations + 1));
    const size_t k = history->iterations++;
    double *row = history->rows + k * (COMMON + history->extra);
    row[0] = (double)step->iteration;
    row[1] = (double)step->evaluations;
    row[2] = (double)step->engine_steps;
    row[3] = step->error;
    row[4] = step->noise;
    memcpy(row + COMMON, step->extra, history->extra * sizeof *row);
    history->times[k] = time;
    for (size_t n = 0; n < history->problem->numbers; n++) {
        double *number = history->numbers + 2 * (k * history->problem->numbers + n);
        number[0] = step->number[n].value;
        number[1] = step->number[n].error;
    }
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (history->points[kind] > 0)
            memcpy(history->curve[kind] + k * history->points[kind], step->curve[kind],
                   history->points[kind] * sizeof(double));
    return STATUS_OK;
}

/// Write a row-major table of `rows` by `columns` numbers, transposed into columns.
static enum status write_transposed(const char *path, const struct units *units,
                                    const double *values, size_t rows, size_t columns,
                                    const struct data_column *first, size_t first_count,
                                    const char *const *names) {
    OWNED double *transposed = NULL;
    OWNED struct data_column *column = NULL;
    TRY_ARRAY(transposed, rows * columns);
    TRY_ARRAY(column, first_count + columns);
    for (size_t k = 0; k < first_count; k++)
        column[k] = first[k];
    for (size_t c = 0; c < columns; c++) {
        for (size_t k = 0; k < rows; k++)
            transposed[c * rows + k] = values[k * columns + c];
        column[first_count + c] = (struct data_column){names[c], transposed + c * rows, NULL};
    }
    return mf_data_table_write_in(path, units, NULL, column, first_count + columns, rows);
}

/// Unit of a method's column that physical files have in theirs, or NULL.
static const char *find_unit(const char *name) {
    static const char *const units[][2] = {{"pressure", "k_B.T_0/lambda^d"},
                                           {"potential_energy", "k_B.T_0"}};
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strncmp(name, units[k][0], strlen(units[k][0])) == 0)
            return units[k][1];
    return NULL;
}

static enum status write_history(const struct history *history, const struct inverse_method *method,
                                 const struct units *units, const struct run_folder *folder) {
    const char *names[MAX_COLUMNS] = {"iteration", "evaluations", "engine_steps", "error[1]",
                                      "noise[1]"};
    char path[OUTPUT_PATH_SIZE], headings[INVERSE_EXTRA][48];
    for (size_t k = 0; k < history->extra; k++) {
        const char *unit = find_unit(method->columns[k]);
        names[COMMON + k] = method->columns[k];
        if (unit == NULL)
            continue;
        mf_data_table_name(units, method->columns[k], unit, headings[k], sizeof headings[k]);
        names[COMMON + k] = headings[k];
    }
    mf_run_folder_file(folder, "history.tsv", path);
    return write_transposed(path, units, history->rows, history->iterations,
                            COMMON + history->extra, NULL, 0, names);
}

static enum status write_timing(const struct history *history, const struct run_folder *folder) {
    enum { BEFORE = 3, COLUMNS = BEFORE + SPENT_KINDS };
    static const char *const names[COLUMNS] = {
        "iteration",       "seconds[s]", "processor_seconds[s]", "equilibration[s]", "samples[s]",
        "lost_samples[s]", "algebra[s]", "verification[s]",      "figures[s]",       "engine[s]"};
    const size_t rows = history->iterations;
    OWNED double *values = NULL;
    struct data_column columns[COLUMNS];
    char path[OUTPUT_PATH_SIZE];
    TRY_ARRAY(values, COLUMNS * rows);
    for (size_t k = 0; k < rows; k++) {
        const struct history_time *time = &history->times[k];
        values[k] = history->rows[k * (COMMON + history->extra)];
        values[rows + k] = time->seconds;
        values[2 * rows + k] = time->processor;
        for (size_t kind = 0; kind < SPENT_KINDS; kind++)
            values[(BEFORE + kind) * rows + k] = time->spent.seconds[kind];
    }
    for (size_t c = 0; c < COLUMNS; c++)
        columns[c] = (struct data_column){names[c], values + c * rows, c > 0 ? "%.3f" : NULL};
    mf_run_folder_file(folder, "timing.tsv", path);
    return mf_data_table_write(path, NULL, columns, COLUMNS, rows);
}

enum status mf_history_close(struct history *history, struct spent spent,
                             const struct run_folder *folder) {
    if (history->iterations == 0)
        return STATUS_OK;
    history->times[history->iterations - 1].spent = spent;
    return write_timing(history, folder);
}

/// A field's unit as in the heads of columns, which have no blanks.
static void column_unit(const char *unit, char text[32]) {
    snprintf(text, 32, "%s", unit[0] ? unit : "1");
    for (char *blank; (blank = strchr(text, ' '));)
        *blank = '.';
}

/// Numbers of the scene: value and standard error of each.
static enum status write_numbers(const struct history *history, const struct units *units,
                                 const struct run_folder *folder) {
    enum { NAME_SIZE = INVERSE_NUMBER_NAME_SIZE + 40 };
    const struct inverse_problem *problem = history->problem;
    char names[2 * INVERSE_MAX_NUMBERS][NAME_SIZE], path[OUTPUT_PATH_SIZE];
    const char *name[2 * INVERSE_MAX_NUMBERS];
    OWNED double *iteration = NULL;
    TRY_ARRAY(iteration, history->iterations);
    for (size_t k = 0; k < history->iterations; k++)
        iteration[k] = history->rows[k * (COMMON + history->extra)];
    for (size_t n = 0; n < 2 * problem->numbers; n++) {
        const struct inverse_number *number = &problem->number[n / 2];
        char unit[32];
        column_unit(number->unit, unit);
        snprintf(names[n], NAME_SIZE, "%s%s[%s]", number->name, n % 2 ? "_error" : "", unit);
        name[n] = names[n];
    }
    mf_run_folder_file(folder, "numbers_history.tsv", path);
    return write_transposed(path, units, history->numbers, history->iterations,
                            2 * problem->numbers,
                            &(struct data_column){"iteration", iteration, NULL}, 1, name);
}

/// A curve of an unknown: one column an iteration, named by its number.
static enum status write_curve(const struct history *history, const struct unknowns *unknowns,
                               enum unknown_kind kind, size_t curve, const struct units *units,
                               const struct run_folder *folder) {
    enum { NAME_SIZE = 48 };
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    OWNED struct data_column *columns = NULL;
    OWNED char *names = NULL;
    char path[OUTPUT_PATH_SIZE], name[UNKNOWNS_NAME_SIZE], file[UNKNOWNS_NAME_SIZE + 16];
    TRY_ARRAY(columns, history->iterations + 1);
    TRY_ARRAY(names, history->iterations * NAME_SIZE);
    columns[0] = (struct data_column){mf_unknowns_heading(unknowns, kind, curve),
                                      mf_unknowns_r(unknowns, kind) + part.first, NULL};
    for (size_t k = 0; k < history->iterations; k++) {
        char iteration[24];
        snprintf(iteration, sizeof iteration, "%zu", k);
        mf_data_table_name(units, iteration, mf_unknowns_unit(kind), names + k * NAME_SIZE,
                           NAME_SIZE);
        columns[k + 1] = (struct data_column){
            names + k * NAME_SIZE, history->curve[kind] + k * history->points[kind] + part.first,
            "%.6g"};
    }
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    snprintf(file, sizeof file, "%s_history.tsv", name);
    mf_run_folder_file(folder, file, path);
    return mf_data_table_write_in(path, units, NULL, columns, history->iterations + 1, part.points);
}

enum status mf_history_write(const struct history *history, const struct inverse_method *method,
                             const struct unknowns *unknowns, const struct units *units,
                             const struct run_folder *folder) {
    TRY(write_history(history, method, units, folder));
    TRY(write_timing(history, folder));
    if (history->problem->numbers > 0)
        TRY(write_numbers(history, units, folder));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0;
             history->points[kind] > 0 && curve < mf_unknowns_curve_count(unknowns, kind); curve++)
            if (mf_unknowns_is_sought(unknowns, kind, curve))
                TRY(write_curve(history, unknowns, kind, curve, units, folder));
    return STATUS_OK;
}

size_t mf_history_spans(struct history *history, struct memory_span *spans) {
    const size_t columns = COMMON + history->extra, n = history->iterations;
    size_t count = 0;
    spans[count++] = (struct memory_span){&history->iterations, sizeof history->iterations};
    spans[count++] = (struct memory_span){history->rows, n * columns * sizeof(double)};
    spans[count++] = (struct memory_span){history->times, n * sizeof *history->times};
    if (history->problem->numbers > 0)
        spans[count++] = (struct memory_span){history->numbers,
                                              n * 2 * history->problem->numbers * sizeof(double)};
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (history->points[kind] > 0)
            spans[count++] = (struct memory_span){history->curve[kind],
                                                  n * history->points[kind] * sizeof(double)};
    return count;
}
