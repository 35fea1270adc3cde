// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_output.h"

#include "base/memory.h"
#include "io/json_write.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { CELL_SIZE = BENCH_NAME_SIZE };

/// Which printed table shows a number.
enum shown { SHOWN_NEVER, SHOWN_ENGINE, SHOWN_LAMMPS, SHOWN_BOTH };

/// One number of a result.
struct column {
    const char *key, *unit; ///< in JSON and TSV
    size_t offset;
    enum shown shown;
    const char *title, *title_unit; ///< in the printed table
    double scale;                   ///< printed is so many times the number
    int digits;                     ///< that count
};

#define MEMBER(name) offsetof(struct bench_result, name)
#define SHARE(phase) (MEMBER(phase_share) + (phase) * sizeof(double))

static const struct column columns[] = {
    {"particles", "1", MEMBER(particles), SHOWN_NEVER, NULL, NULL, 1, 0},
    {"threads", "1", MEMBER(threads), SHOWN_NEVER, NULL, NULL, 1, 0},
    {"temperature", "T_0", MEMBER(temperature), SHOWN_NEVER, NULL, NULL, 1, 0},
    {"pairs", "1", MEMBER(pairs), SHOWN_NEVER, NULL, NULL, 1, 0},
    {"steps_per_second", "1/s", MEMBER(steps_per_second), SHOWN_BOTH, "median", "steps/s", 1, 4},
    {"steps_per_second_best", "1/s", MEMBER(steps_per_second_best), SHOWN_BOTH, "best", "steps/s",
     1, 4},
    {"steps_per_second_spread", "1", MEMBER(steps_per_second_spread), SHOWN_BOTH, "spread", "%",
     100, 2},
    {"particle_steps_per_second", "1/s", MEMBER(particle_steps_per_second), SHOWN_ENGINE,
     "particle-steps", "M/s", 1e-6, 3},
    {"pairs_per_second", "1/s", MEMBER(pairs_per_second), SHOWN_ENGINE, "pairs", "M/s", 1e-6, 3},
    {"ns_per_pair", "ns", MEMBER(ns_per_pair), SHOWN_ENGINE, "per pair", "ns", 1, 3},
    {"ticks_per_pair", "1", MEMBER(ticks_per_pair), SHOWN_ENGINE, "per pair", "ticks", 1, 3},
    {"list_share", "1", SHARE(SIMULATION_LIST), SHOWN_ENGINE, "list", "%", 100, 2},
    {"forces_share", "1", SHARE(SIMULATION_FORCES), SHOWN_ENGINE, "forces", "%", 100, 2},
    {"motion_share", "1", SHARE(SIMULATION_MOTION), SHOWN_ENGINE, "motion", "%", 100, 2},
    {"list_efficiency", "1", MEMBER(list_efficiency), SHOWN_ENGINE, "in range", "%", 100, 3},
    {"row_filling", "1", MEMBER(row_filling), SHOWN_ENGINE, "rows full", "%", 100, 3},
    {"steps_per_build", "1", MEMBER(steps_per_build), SHOWN_ENGINE, "rebuild", "steps", 1, 3},
    {"lammps_steps_per_second", "1/s", MEMBER(lammps_steps_per_second), SHOWN_LAMMPS, "LAMMPS",
     "steps/s", 1, 4},
    {"lammps_ratio", "1", MEMBER(lammps_ratio), SHOWN_LAMMPS, "ratio", "1", 1, 3},
};
enum { COLUMNS = sizeof columns / sizeof *columns };

static double number_of(const struct bench_result *result, const struct column *column) {
    double value;
    memcpy(&value, (const char *)result + column->offset, sizeof value);
    return value;
}

static bool is_lammps(const struct column *column) {
    return column->shown == SHOWN_LAMMPS;
}

/// True if some result was compared, so that TSV has the columns of the comparison.
static bool are_compared(const struct bench_result *results, size_t count) {
    for (size_t k = 0; k < count; k++)
        if (results[k].lammps_style[0])
            return true;
    return false;
}

// For people --------------------------------------------------------------------------------------

/// A number with `digits` digits that count, and never an exponent; "-" if there is none.
static void print_number(char cell[CELL_SIZE], double value, int digits) {
    if (!isfinite(value)) {
        snprintf(cell, CELL_SIZE, "-");
        return;
    }
    const double size = value != 0 ? floor(log10(fabs(value))) : 0;
    const int decimals = (int)fmin(fmax(digits - 1 - size, 0), digits);
    snprintf(cell, CELL_SIZE, "%.*f", decimals, value);
}

static size_t larger(size_t a, size_t b) {
    return a > b ? a : b;
}

/// One column of the table, its title and unit above it, appended to the lines.
static void append_column(char *const *lines, size_t rows, char (*cells)[CELL_SIZE], bool is_text) {
    size_t width = 0;
    for (size_t row = 0; row < rows; row++)
        width = larger(width, strlen(cells[row]));
    for (size_t row = 0; row < rows; row++)
        sprintf(lines[row] + strlen(lines[row]), is_text ? "  %-*s" : "  %*s", (int)width,
                cells[row]);
}

static void append_text(char *const *lines, const struct bench_result *results, size_t count,
                        const char *title, size_t offset, char (*cells)[CELL_SIZE]) {
    snprintf(cells[0], CELL_SIZE, "%s", title);
    cells[1][0] = '\0';
    for (size_t k = 0; k < count; k++) {
        const char *text;
        memcpy(&text, (const char *)&results[k] + offset, sizeof text);
        snprintf(cells[k + 2], CELL_SIZE, "%s", text);
    }
    append_column(lines, count + 2, cells, true);
}

static void append_number(char *const *lines, const struct bench_result *results, size_t count,
                          const struct column *column, char (*cells)[CELL_SIZE]) {
    snprintf(cells[0], CELL_SIZE, "%s", column->title);
    snprintf(cells[1], CELL_SIZE, "%s", column->title_unit);
    for (size_t k = 0; k < count; k++)
        print_number(cells[k + 2], column->scale * number_of(&results[k], column), column->digits);
    append_column(lines, count + 2, cells, false);
}

enum status mf_bench_output_table(FILE *stream, const struct bench_result *results, size_t count,
                                  bool lammps) {
    enum { LINE_SIZE = (COLUMNS + 2) * (CELL_SIZE + 2) };
    const size_t rows = count + 2;
    OWNED char(*cells)[CELL_SIZE] = NULL, *text = NULL, **lines = NULL;
    TRY_ARRAY(cells, rows);
    TRY_ARRAY(text, rows * LINE_SIZE);
    TRY_ARRAY(lines, rows);
    for (size_t row = 0; row < rows; row++)
        lines[row] = text + row * LINE_SIZE;
    append_text(lines, results, count, "isa", MEMBER(isa), cells);
    append_text(lines, results, count, "precision", MEMBER(precision), cells);
    for (size_t k = 0; k < COLUMNS; k++)
        if (columns[k].shown == SHOWN_BOTH ||
            columns[k].shown == (lammps ? SHOWN_LAMMPS : SHOWN_ENGINE))
            append_number(lines, results, count, &columns[k], cells);
    fprintf(stream, "%s: %.0f particles with %.3g neighbours in range, %.0f thread%s%s%s\n",
            results->scene, results->particles, 2 * results->pairs / results->particles,
            results->threads, results->threads > 1 ? "s" : "", lammps ? ", LAMMPS with " : "",
            lammps ? results->lammps_style : "");
    for (size_t row = 0; row < rows; row++)
        fprintf(stream, "%s\n", lines[row]);
    return STATUS_OK;
}

// For programs ------------------------------------------------------------------------------------

static void write_result(struct json_writer *writer, const struct bench_result *result) {
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "scene", result->scene);
    mf_json_write_text(writer, "isa", result->isa);
    mf_json_write_text(writer, "precision", result->precision);
    for (size_t k = 0; k < COLUMNS; k++) {
        const double value = number_of(result, &columns[k]);
        if (isfinite(value))
            mf_json_write_number(writer, columns[k].key, value);
    }
    if (result->lammps_style[0])
        mf_json_write_text(writer, "lammps_style", result->lammps_style);
    mf_json_end(writer);
}

enum status mf_bench_output_json(FILE *stream, const struct bench_result *results, size_t count) {
    struct json_writer *writer = mf_json_writer_create_list();
    if (writer == NULL)
        return STATUS_NO_MEMORY;
    for (size_t k = 0; k < count; k++)
        write_result(writer, &results[k]);
    const enum status status = mf_json_write_stream(writer, stream, "the results");
    mf_json_writer_free(writer);
    return status;
}

void mf_bench_output_tsv(FILE *stream, const struct bench_result *results, size_t count) {
    const bool lammps = are_compared(results, count);
    fprintf(stream, "# scene\tisa\tprecision");
    for (size_t k = 0; k < COLUMNS; k++)
        if (lammps || !is_lammps(&columns[k]))
            fprintf(stream, "\t%s[%s]", columns[k].key, columns[k].unit);
    fprintf(stream, "\n");
    for (size_t row = 0; row < count; row++) {
        const struct bench_result *result = &results[row];
        fprintf(stream, "%s\t%s\t%s", result->scene, result->isa, result->precision);
        for (size_t k = 0; k < COLUMNS; k++)
            if (lammps || !is_lammps(&columns[k]))
                fprintf(stream, "\t%.6g", number_of(result, &columns[k]));
        fprintf(stream, "\n");
    }
}
