// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/result_tables.h"

#include "base/memory.h"
#include "io/output.h"
#include "io/text_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

/// Cut `*text` after its first line and step over it; NULL at the end.
static char *take_line(char **text) {
    char *line = *text;
    if (*line == '\0')
        return NULL;
    char *end = line + strcspn(line, "\n");
    *text = *end ? end + 1 : end;
    *end = '\0';
    return line;
}

static bool is_data(const char *line) {
    const char *word = line + strspn(line, " \t\r");
    return *word != '\0' && *word != '#';
}

/// A column of a table that is to be read.
struct wanted_column {
    const char *name; ///< in the header, without its unit; NULL: go by the place
    size_t place;     ///< from 1, if the header has no such name; 0: then it is nan
};

/// Places of the columns whose names the header has.
static void find_places(struct wanted_column *wanted, size_t count, const char *header) {
    size_t place = 0;
    for (const char *word = header + 1 + strspn(header + 1, " "); *word;) {
        const size_t length = strcspn(word, "[\t\r");
        place++;
        for (size_t k = 0; k < count; k++)
            if (wanted[k].name && strlen(wanted[k].name) == length &&
                strncmp(wanted[k].name, word, length) == 0) {
                wanted[k].place = place;
                wanted[k].name = NULL; // the first one counts
            }
        word += strcspn(word, "\t");
        word += *word == '\t';
    }
}

static enum status read_row(double *row, const struct wanted_column *wanted, size_t count,
                            const char *line, const char *file, size_t number) {
    size_t last = 0;
    for (size_t k = 0; k < count; k++) {
        row[k] = NAN;
        last = wanted[k].place > last ? wanted[k].place : last;
    }
    for (size_t place = 1; place <= last; place++) {
        char *end;
        const double value = strtod(line, &end);
        if (end == line || strchr(" \t\r", *end) == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu is not a number", file,
                                  number, place);
        for (size_t k = 0; k < count; k++)
            if (wanted[k].place == place)
                row[k] = value;
        line = end;
    }
    return STATUS_OK;
}

/// Read the columns that `wanted` says, which learns from the header; others are left alone.
static enum status read_table(struct result_table *table, const char *folder, const char *name,
                              struct wanted_column *wanted, size_t count) {
    enum status status = STATUS_OK;
    char file[PATH_SIZE], *text = NULL, *line;
    size_t length = 0, max_rows = 1, number = 0;
    snprintf(file, sizeof file, "%s/%s", folder, name);
    CHECK(mf_text_file_read(file, &text, &length));
    for (size_t k = 0; k < length; k++)
        max_rows += text[k] == '\n';
    table->columns = count;
    NEW_ARRAY(table->values, max_rows * count);
    for (char *rest = text; (line = take_line(&rest));) {
        number++;
        if (is_data(line))
            CHECK(
                read_row(table->values + count * table->rows++, wanted, count, line, file, number));
        else if (line[0] == '#')
            find_places(wanted, count, line);
    }
    if (table->rows == 0)
        status = mf_status_fail(STATUS_BAD_INPUT, "%s: there is no row of numbers", file);
done:
    mf_memory_free(text);
    return status;
}

static bool is_there(const char *folder, const char *name) {
    char file[PATH_SIZE];
    snprintf(file, sizeof file, "%s/%s", folder, name);
    return access(file, F_OK) == 0;
}

/// That of a simulation is r, g, g_error: a result without a target.
static enum status read_rdf(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3}, {NULL, 4}, {NULL, 5}};
    struct wanted_column counted[] = {{NULL, 1}, {NULL, 0}, {NULL, 0}, {NULL, 2}, {NULL, 3}};
    return is_there(folder, "rdf.tsv")
               ? read_table(table, folder, "rdf.tsv", simulated ? counted : fitted, 5)
               : STATUS_OK;
}

/// Cells of E of a simulation, which has a column for each r_0: a result without a target.
static enum status join_cells(struct result_table *cells, const struct result_table *bins,
                              const struct result_table *value, const struct result_table *error) {
    cells->columns = 6;
    TRY_ARRAY(cells->values, cells->columns * value->rows * bins->rows);
    for (size_t time = 0; time < value->rows; time++)
        for (size_t bin = 0; bin < bins->rows; bin++) {
            const size_t at = time * value->columns;
            double *row = cells->values + cells->columns * cells->rows++;
            row[0] = value->values[at];
            row[1] = bins->values[bin];
            row[2] = row[3] = NAN;
            row[4] = value->values[at + 1 + bin];
            row[5] = time < error->rows ? error->values[at + 1 + bin] : NAN;
        }
    return STATUS_OK;
}

static enum status read_simulated_etd(struct result_table *table, const char *folder) {
    enum status status = STATUS_OK;
    struct result_table bins = {0}, value = {0}, error = {0};
    struct wanted_column separation[] = {{NULL, 1}}, *columns = NULL;
    CHECK(read_table(&bins, folder, "etd_bins.tsv", separation, 1));
    NEW_ARRAY(columns, bins.rows + 1);
    for (size_t k = 0; k <= bins.rows; k++)
        columns[k] = (struct wanted_column){NULL, k + 1};
    CHECK(read_table(&value, folder, "etd.tsv", columns, bins.rows + 1));
    CHECK(read_table(&error, folder, "etd_error.tsv", columns, bins.rows + 1));
    CHECK(join_cells(table, &bins, &value, &error));
done:
    mf_memory_free(columns);
    mf_memory_free(bins.values);
    mf_memory_free(value.values);
    mf_memory_free(error.values);
    return status;
}

static enum status read_etd(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3},
                                     {NULL, 4}, {NULL, 5}, {NULL, 6}};
    if (simulated)
        return is_there(folder, "etd.tsv") ? read_simulated_etd(table, folder) : STATUS_OK;
    return is_there(folder, "etd_cells.tsv") ? read_table(table, folder, "etd_cells.tsv", fitted, 6)
                                             : STATUS_OK;
}

static enum status read_vacf(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3}, {NULL, 4}, {NULL, 5}};
    struct wanted_column counted[] = {
        {NULL, 1}, {NULL, 0}, {NULL, 0}, {"vacf", 0}, {"vacf_error", 0}};
    const char *file = simulated ? "motion.tsv" : "vacf.tsv";
    return is_there(folder, file) ? read_table(table, folder, file, simulated ? counted : fitted, 5)
                                  : STATUS_OK;
}

/// With what was known beside it, which another fit may have looked for.
static enum status read_potential(struct result_table *table, const char *folder) {
    enum { PHI = 1, TRUTH = 3, SOUGHT = 4, COLUMNS = 5 };
    struct wanted_column wanted[COLUMNS] = {
        {NULL, 1}, {"total", 2}, {"phi_error", 0}, {"truth", 0}, {NULL, 2}};
    if (!is_there(folder, "potential.tsv"))
        return STATUS_OK;
    TRY(read_table(table, folder, "potential.tsv", wanted, COLUMNS));
    table->columns = COLUMNS - 1;
    for (size_t k = 0; k < table->rows; k++) {
        const double *from = table->values + k * COLUMNS;
        double *to = table->values + k * table->columns;
        const double row[] = {from[0], from[PHI], from[2], from[TRUTH] + from[PHI] - from[SOUGHT]};
        memcpy(to, row, sizeof row);
    }
    return STATUS_OK;
}

/// A friction weight without a column of errors was not fitted.
static enum status read_omega(struct result_table *table, const char *folder) {
    struct wanted_column wanted[] = {{NULL, 1}, {NULL, 2}, {"omega_error", 0}, {"truth", 0}};
    if (!is_there(folder, "omega.tsv"))
        return STATUS_OK;
    TRY(read_table(table, folder, "omega.tsv", wanted, 4));
    if (wanted[2].place == 0) {
        mf_memory_free(table->values);
        *table = (struct result_table){0};
    }
    return STATUS_OK;
}

static double seconds_at(const struct result_table *timing, double iteration) {
    for (size_t row = 0; row < timing->rows; row++)
        if (timing->values[2 * row] == iteration)
            return timing->values[2 * row + 1];
    return NAN;
}

/// history.tsv with the seconds of timing.tsv.
static enum status read_course(struct result_table *table, const char *folder) {
    enum { SECONDS = 3 };
    enum status status = STATUS_OK;
    struct result_table timing = {0};
    struct wanted_column wanted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3},
                                     {NULL, 0}, {NULL, 4}, {NULL, 5}};
    struct wanted_column times[] = {{NULL, 1}, {NULL, 2}};
    CHECK(read_table(table, folder, "history.tsv", wanted, 6));
    CHECK(read_table(&timing, folder, "timing.tsv", times, 2));
    for (size_t row = 0; row < table->rows; row++) {
        double *values = table->values + row * table->columns;
        values[SECONDS] = seconds_at(&timing, values[0]);
    }
done:
    mf_memory_free(timing.values);
    return status;
}

enum status mf_result_tables_read(struct result *result, const char *folder, bool simulated) {
    TRY(read_rdf(&result->rdf, folder, simulated));
    TRY(read_etd(&result->etd, folder, simulated));
    TRY(read_vacf(&result->vacf, folder, simulated));
    TRY(read_potential(&result->potential, folder));
    TRY(read_omega(&result->omega, folder));
    return simulated ? STATUS_OK : read_course(&result->course, folder);
}
