// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/compare.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"
#include "run/figures.h"
#include "run/result.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64,
    CELL_SIZE = 64,    ///< one entry of the printed table
    COLUMN_COUNT = 12, ///< of the printed table
    TEXT_COLUMNS = 2,  ///< that hold texts: the first ones
    MOST_NUMBERS = 32, ///< in a summary
    HEADER_SIZE = 64,  ///< of one column of compare.tsv
};

struct fit {
    char path[OUTPUT_PATH_SIZE]; ///< absolute, without "out" at its end
    char name[OUTPUT_PATH_SIZE];
    struct result result;
};

// Names -------------------------------------------------------------------------------------------

/// The absolute path of a folder, without a last part "out", which says nothing.
static enum status find_path(struct fit *fit, const char *folder) {
    char *path = realpath(folder, NULL);
    if (path == NULL)
        return status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    char *slash = strrchr(path, '/');
    if (slash > path && strcmp(slash, "/out") == 0)
        *slash = '\0';
    snprintf(fit->path, sizeof fit->path, "%s", path);
    free(path);
    return STATUS_OK;
}

/// The last `parts` parts of a path, or all of it without its first slash.
static const char *last_parts(const char *path, size_t parts) {
    const char *begin = path + strlen(path);
    for (; parts > 0 && begin > path; parts--)
        do
            begin--;
        while (begin > path && begin[-1] != '/');
    return begin;
}

/// True if another folder has the same last parts.
static bool is_shared(const struct fit *fits, size_t count, const char *path, size_t parts) {
    const char *name = last_parts(path, parts);
    for (size_t k = 0; k < count; k++)
        if (strcmp(fits[k].path, path) != 0 && strcmp(last_parts(fits[k].path, parts), name) == 0)
            return true;
    return false;
}

/// A name goes into comment lines of tables, where tabs and line ends have a meaning.
static void replace_controls(char *text) {
    for (; *text; text++)
        if ((unsigned char)*text < ' ')
            *text = '?';
}

static void name_fits(struct fit *fits, size_t count) {
    for (size_t k = 0; k < count; k++) {
        size_t parts = 1, same = 1;
        while (is_shared(fits, count, fits[k].path, parts))
            parts++;
        for (size_t before = 0; before < k; before++)
            same += strcmp(fits[before].path, fits[k].path) == 0;
        const char *name = last_parts(fits[k].path, parts);
        if (same > 1)
            snprintf(fits[k].name, sizeof fits[k].name, "%.*s (%zu)", OUTPUT_PATH_SIZE - 32, name,
                     same);
        else
            snprintf(fits[k].name, sizeof fits[k].name, "%s", name);
        replace_controls(fits[k].name);
    }
}

// The printed table -------------------------------------------------------------------------------

/// "0.0123(4)": the error in units of the last digit, with two digits if it begins with 1.
static void print_with_error(char *cell, double value, double error) {
    if (!isfinite(value) || !(error > 0) || !isfinite(error)) {
        snprintf(cell, CELL_SIZE, isfinite(value) ? "%.4g" : "-", value);
        return;
    }
    int decimals = -(int)floor(log10(error));
    if (error * pow(10, decimals) < 1.95)
        decimals++;
    if (error * pow(10, decimals) >= 9.5 && error * pow(10, decimals) < 10)
        decimals--;
    if (decimals < 0)
        decimals = 0;
    snprintf(cell, CELL_SIZE, "%.*f(%.0f)", decimals, value, error * pow(10, decimals));
}

static void print_number(char *cell, const char *format, double value) {
    if (isfinite(value))
        snprintf(cell, CELL_SIZE, format, value);
    else
        snprintf(cell, CELL_SIZE, "-");
}

static void print_text(char *cell, const char *text) {
    snprintf(cell, CELL_SIZE, "%.60s", text[0] ? text : "-");
}

static const char *const titles[COLUMN_COUNT] = {
    "method", "status",  "threads", "iterations", "simulations", "steps",
    "time/s", "rmse(g)", "noise",   "T",          "T_conf",      "p",
};

static void fill_cells(char cells[COLUMN_COUNT][CELL_SIZE], const struct result_summary *summary) {
    print_text(cells[0], summary->method);
    print_text(cells[1], summary->status);
    print_number(cells[2], "%.0f", summary->threads);
    print_number(cells[3], "%.0f", summary->iterations);
    print_number(cells[4], "%.0f", summary->evaluations);
    print_number(cells[5], "%.0f", summary->engine_steps);
    print_number(cells[6], summary->seconds < 100 ? "%.1f" : "%.0f", summary->seconds);
    print_with_error(cells[7], summary->rdf_rmse, summary->rdf_rmse_error);
    print_number(cells[8], "%.2g", summary->rdf_noise);
    print_number(cells[9], "%.3f", summary->temperature);
    print_number(cells[10], "%.3f", summary->temperature_configurational);
    print_number(cells[11], "%.4g", summary->pressure);
}

/// Characters of a UTF-8 text.
static size_t width_of(const char *text) {
    size_t width = 0;
    for (; *text; text++)
        width += ((unsigned char)*text & 0xC0) != 0x80;
    return width;
}

static void widen(size_t *width, const char *text) {
    const size_t needed = width_of(text);
    if (needed > *width)
        *width = needed;
}

/// Texts begin, and numbers end, at the edge of their column.
static void print_cell(size_t column, const char *text, size_t width) {
    const int blanks = (int)(width - width_of(text));
    if (column < TEXT_COLUMNS)
        printf("  %s%*s", text, blanks, "");
    else
        printf("  %*s%s", blanks, "", text);
}

static enum status print_table(const struct fit *fits, size_t count) {
    enum status status = STATUS_OK;
    char(*cells)[COLUMN_COUNT][CELL_SIZE] = NULL;
    size_t widths[COLUMN_COUNT] = {0}, name_width = 0;
    NEW_ARRAY(cells, count + 1);
    for (size_t column = 0; column < COLUMN_COUNT; column++)
        print_text(cells[0][column], titles[column]);
    for (size_t k = 0; k < count; k++)
        fill_cells(cells[k + 1], &fits[k].result.summary);
    for (size_t row = 0; row <= count; row++) {
        widen(&name_width, row ? fits[row - 1].name : "name");
        for (size_t column = 0; column < COLUMN_COUNT; column++)
            widen(&widths[column], cells[row][column]);
    }
    for (size_t row = 0; row <= count; row++) {
        const char *name = row ? fits[row - 1].name : "name";
        printf("%s%*s", name, (int)(name_width - width_of(name)), "");
        for (size_t column = 0; column < COLUMN_COUNT; column++)
            print_cell(column, cells[row][column], widths[column]);
        printf("\n");
    }
done:
    memory_free(cells);
    return status;
}

// Tables ------------------------------------------------------------------------------------------

/// Lines "index, name, method, status, version" for the comment of compare.tsv.
static enum status list_names(char **comment, const struct fit *fits, size_t count) {
    enum status status = STATUS_OK;
    const size_t size = (count + 1) * (sizeof fits->name + sizeof fits->result.summary);
    NEW_ARRAY(*comment, size);
    char *end = *comment;
    end += sprintf(end, "index\tname\tmethod\tstatus\tversion");
    for (size_t k = 0; k < count; k++) {
        struct result_summary texts = fits[k].result.summary;
        replace_controls(texts.method);
        replace_controls(texts.status);
        replace_controls(texts.version);
        end += sprintf(end, "\n%zu\t%s\t%s\t%s\t%s", k, fits[k].name, texts.method, texts.status,
                       texts.version);
    }
done:
    return status;
}

static double summary_number(const struct result_summary *summary, const struct field *field) {
    double value;
    memcpy(&value, (const char *)summary + field->offset, sizeof value);
    return value;
}

/// One column a number of the summaries, under the name it has there.
static enum status write_numbers(const char *out, const struct fit *fits, size_t count) {
    enum status status = STATUS_OK;
    char file[PATH_SIZE], headers[MOST_NUMBERS][HEADER_SIZE], *comment = NULL;
    struct data_column columns[MOST_NUMBERS] = {{.name = "index[1]"}};
    double *values = NULL;
    size_t used = 1;
    NEW_ARRAY(values, MOST_NUMBERS * count);
    for (size_t k = 0; k < count; k++)
        values[k] = (double)k;
    columns[0].values = values;
    for (const struct field *field = result_summary_fields; field->name; field++) {
        if (field->type != FIELD_NUMBER || used == MOST_NUMBERS)
            continue;
        double *column = values + used * count;
        for (size_t k = 0; k < count; k++)
            column[k] = summary_number(&fits[k].result.summary, field);
        snprintf(headers[used], HEADER_SIZE, "%s[%s]", field->name, field->unit);
        columns[used] = (struct data_column){headers[used], column, "%.16g"};
        used++;
    }
    CHECK(list_names(&comment, fits, count));
    snprintf(file, sizeof file, "%s/compare.tsv", out);
    CHECK(data_table_write(file, comment, columns, used, count));
done:
    memory_free(comment);
    memory_free(values);
    return status;
}

static void write_rows(FILE *stream, const struct result_table *table) {
    for (size_t k = 0; k < table->rows * table->columns; k++)
        fprintf(stream, "%.10g%c", table->values[k], (k + 1) % table->columns ? '\t' : '\n');
}

static void write_rdf(FILE *stream, const struct result *result) {
    write_rows(stream, &result->rdf);
}

static void write_potential(FILE *stream, const struct result *result) {
    write_rows(stream, &result->potential);
}

static double seconds_at(const struct result_table *timing, double iteration) {
    for (size_t row = 0; row < timing->rows; row++)
        if (timing->values[2 * row] == iteration)
            return timing->values[2 * row + 1];
    return NAN;
}

static void write_error(FILE *stream, const struct result *result) {
    for (size_t row = 0; row < result->history.rows; row++) {
        const double *history = result->history.values + row * result->history.columns;
        fprintf(stream, "%.10g\t%.10g\t%.10g\t%.10g\t%.10g\n", history[0], history[1],
                seconds_at(&result->timing, history[0]), history[3], history[4]);
    }
}

/// A table of one block a fit.
static enum status write_blocks(const char *out, const char *name, const char *header,
                                const struct fit *fits, size_t count,
                                void (*write)(FILE *, const struct result *)) {
    struct output output;
    char file[PATH_SIZE];
    snprintf(file, sizeof file, "%s/%s", out, name);
    TRY(output_open(&output, file));
    for (size_t k = 0; k < count; k++) {
        fprintf(output.stream, "%s# %zu\t%s\n# %s\n", k ? "\n\n" : "", k, fits[k].name, header);
        write(output.stream, &fits[k].result);
    }
    return output_commit(&output);
}

static enum status write_tables(const char *out, const struct fit *fits, size_t count) {
    TRY(output_make_folder(out));
    TRY(write_numbers(out, fits, count));
    TRY(write_blocks(out, "rdf_compare.tsv",
                     "r[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]", fits,
                     count, write_rdf));
    TRY(write_blocks(out, "potential_compare.tsv", "r[lambda]\tphi[k_BT_0]", fits, count,
                     write_potential));
    return write_blocks(out, "error_compare.tsv",
                        "iteration[1]\tevaluations[1]\tseconds[s]\terror[1]\tnoise[1]", fits, count,
                        write_error);
}

enum status compare_folders(const char *const *folders, size_t count, const char *out, bool quiet) {
    enum status status = STATUS_OK;
    struct fit *fits = NULL;
    if (count == 0)
        return status_fail(STATUS_BAD_INPUT, "compare: give the folder of at least one fit");
    NEW_ARRAY(fits, count);
    for (size_t k = 0; k < count; k++) {
        CHECK(result_read(&fits[k].result, folders[k]));
        CHECK(find_path(&fits[k], folders[k]));
    }
    name_fits(fits, count);
    CHECK(write_tables(out, fits, count));
    if (!quiet)
        CHECK(print_table(fits, count));
    if (figures_draw_comparison(out) != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", status_message());
done:
    for (size_t k = 0; fits && k < count; k++)
        result_clear(&fits[k].result);
    memory_free(fits);
    return status;
}
