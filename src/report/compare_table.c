// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/compare_table.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/visible.h"
#include "io/data_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    PATH_SIZE = OUTPUT_PATH_SIZE + 64,
    CELL_SIZE = 64,    ///< one entry of the printed table, and NUMBER_TEXT_SIZE fits
    MAX_NUMBERS = 128, ///< in a summary
    HEADER_SIZE = 96,  ///< of one column of compare.tsv
};

// Columns of the printed table --------------------------------------------------------------------

static void print_number(char *cell, const char *format, double value) {
    if (isfinite(value))
        snprintf(cell, CELL_SIZE, format, value);
    else
        snprintf(cell, CELL_SIZE, "-");
}

static void print_with_error(char *cell, double value, double error) {
    if (isfinite(value))
        mf_number_text(value, error, cell);
    else
        snprintf(cell, CELL_SIZE, "-");
}

static void print_text(char *cell, const char *text) {
    char beginning[61];
    snprintf(beginning, sizeof beginning, "%s", text[0] ? text : "-");
    mf_visible_copy(cell, CELL_SIZE, beginning, "");
}

/// One column: a text, or a number with its format or its error.
struct column {
    const char *title;
    bool is_text;
    size_t value;       ///< offset in struct result_summary
    const char *format; ///< NULL: with the error
    size_t error;       ///< offset in struct result_summary
    const char *target; ///< offsets are in struct result_distance of that one; NULL: none
};

#define AT(member) offsetof(struct result_summary, member)
#define OF(member) offsetof(struct result_distance, member)
#define RMSE(symbol, target)                                                                       \
    { "rmse(" symbol ")", false, OF(rmse), NULL, OF(rmse_error), target }
#define NOISE(title, target)                                                                       \
    { title, false, OF(noise), "%.2g", 0, target }
#define BONDED(NAME, kind, beads, key, ...) RMSE(#kind "s", #key),
static const struct column columns[] = {
    {"method", true, AT(method), NULL, 0, NULL},
    {"status", true, AT(status), NULL, 0, NULL},
    {"threads", false, AT(threads), "%.0f", 0, NULL},
    {"iterations", false, AT(iterations), "%.0f", 0, NULL},
    {"simulations", false, AT(evaluations), "%.0f", 0, NULL},
    {"steps", false, AT(engine_steps), "%.0f", 0, NULL},
    {"time/s", false, AT(seconds), "%.1f", 0, NULL},
    {"error/noise", false, AT(error_over_noise), "%.2f", 0, NULL},
    {"worst", true, AT(worst), NULL, 0, NULL},
    RMSE("g", "rdf"),
    NOISE("noise", "rdf"),
    RMSE("g_inter", "intermolecular_rdf"),
    RMSE("E", "etd"),
    NOISE("noise(E)", "etd"),
    RMSE("VACF", "vacf"),
    RMSE("MSD", "msd"),
    RMSE("D", "diffusion"),
    RMSE("p", "pressure"),
    RMSE("rho", "density"),
    RMSE("S", "structure_factor"),
    RMSE("kappa", "force_covariance"),
    BONDED_LIST(BONDED){"D", false, AT(diffusion), NULL, AT(diffusion_error), NULL},
    {"truth(phi)", false, AT(truth_rms), "%.3g", 0, NULL},
    {"truth(omega)", false, AT(omega_truth_rms), "%.3g", 0, NULL},
    {"T", false, AT(temperature), "%.3f", 0, NULL},
    {"T_conf", false, AT(temperature_configurational), "%.3f", 0, NULL},
    {"p", false, AT(pressure), "%.4g", 0, NULL},
    {"p_open", false, AT(pressure_left_open), "%.2g", 0, NULL},
};
enum { COLUMN_COUNT = sizeof columns / sizeof columns[0] };

static const void *of_target(const struct result_summary *summary, const char *target) {
    int kind = 0;
    while (strcmp(mf_targets_name(kind), target) != 0)
        kind++;
    return &summary->distance[kind];
}

static double number_at(const void *of, size_t offset) {
    double value;
    memcpy(&value, (const char *)of + offset, sizeof value);
    return value;
}

static void fill_cell(char *cell, const struct column *column,
                      const struct result_summary *summary) {
    if (column->is_text) {
        print_text(cell, (const char *)summary + column->value);
        return;
    }
    const void *of = column->target ? of_target(summary, column->target) : summary;
    const double value = number_at(of, column->value);
    if (column->format == NULL)
        print_with_error(cell, value, number_at(of, column->error));
    else
        print_number(cell,
                     of == summary && column->value == AT(seconds) && value >= 100 ? "%.0f"
                                                                                   : column->format,
                     value);
}

/// What no fit has gets no column.
static bool is_shown(const struct column *column, const struct compared *fits, size_t count) {
    for (size_t k = 0; k < count; k++) {
        const struct result_summary *summary = &fits[k].result.summary;
        const void *of = column->target ? of_target(summary, column->target) : summary;
        if (column->is_text ? ((const char *)of)[column->value] != '\0'
                            : isfinite(number_at(of, column->value)))
            return true;
    }
    return false;
}

// The printed table -------------------------------------------------------------------------------

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
static void print_cell(const struct column *column, const char *text, size_t width) {
    const int blanks = (int)(width - width_of(text));
    if (column->is_text)
        printf("  %s%*s", text, blanks, "");
    else
        printf("  %*s%s", blanks, "", text);
}

static void print_column(char (*cells)[CELL_SIZE], const struct column *column,
                         const struct compared *fits, size_t count) {
    print_text(cells[0], column->title);
    for (size_t k = 0; k < count; k++)
        fill_cell(cells[k + 1], column, &fits[k].result.summary);
}

enum status mf_compare_table_print(const struct compared *fits, size_t count) {
    enum status status = STATUS_OK;
    char(*cells)[CELL_SIZE] = NULL; // shape [COLUMN_COUNT][count + 1]
    size_t widths[COLUMN_COUNT] = {0}, name_width = width_of("name");
    const size_t rows = count + 1;
    NEW_ARRAY(cells, COLUMN_COUNT * rows);
    for (size_t k = 0; k < count; k++)
        widen(&name_width, fits[k].name);
    for (size_t c = 0; c < COLUMN_COUNT; c++) {
        if (!is_shown(&columns[c], fits, count))
            continue;
        print_column(cells + c * rows, &columns[c], fits, count);
        for (size_t row = 0; row < rows; row++)
            widen(&widths[c], cells[c * rows + row]);
    }
    for (size_t row = 0; row < rows; row++) {
        const char *name = row ? fits[row - 1].name : "name";
        printf("%s%*s", name, (int)(name_width - width_of(name)), "");
        for (size_t c = 0; c < COLUMN_COUNT; c++)
            if (widths[c] > 0)
                print_cell(&columns[c], cells[c * rows + row], widths[c]);
        printf("\n");
    }
done:
    mf_memory_free(cells);
    return status;
}

// compare.tsv -------------------------------------------------------------------------------------

void mf_compare_table_clean(char *text) {
    for (; *text; text++)
        if ((unsigned char)*text < ' ')
            *text = '?';
}

/// Lines "index, name, method, status, version" for the comment of compare.tsv.
static enum status list_names(char **comment, const struct compared *fits, size_t count) {
    enum status status = STATUS_OK;
    const size_t size = (count + 1) * (sizeof fits->name + sizeof fits->result.summary);
    NEW_ARRAY(*comment, size);
    char *end = *comment;
    end += sprintf(end, "index\tname\tmethod\tstatus\tversion");
    for (size_t k = 0; k < count; k++) {
        struct result_summary texts = fits[k].result.summary;
        mf_compare_table_clean(texts.method);
        mf_compare_table_clean(texts.status);
        mf_compare_table_clean(texts.version);
        end += sprintf(end, "\n%zu\t%s\t%s\t%s\t%s", k, fits[k].name, texts.method, texts.status,
                       texts.version);
    }
done:
    return status;
}

/// Numbers of all fits under one name; false if no fit has it.
static bool fill_numbers(double *values, const struct field *field, const struct compared *fits,
                         size_t count) {
    bool any = false;
    for (size_t k = 0; field->type == FIELD_NUMBER && k < count; k++) {
        values[k] = number_at(&fits[k].result.summary, field->offset);
        any = any || isfinite(values[k]);
    }
    return any;
}

enum status mf_compare_table_write(const char *out, const struct compared *fits, size_t count) {
    OWNED char *comment = NULL;
    char file[PATH_SIZE], headers[MAX_NUMBERS][HEADER_SIZE];
    struct data_column written[MAX_NUMBERS] = {{.name = "index[1]"}};
    const struct units units = fits[0].result.summary.units;
    const struct field *field;
    struct result_field capacity;
    OWNED double *values = NULL;
    size_t used = 1;
    TRY_ARRAY(values, MAX_NUMBERS * count);
    for (size_t k = 0; k < count; k++)
        values[k] = (double)k;
    written[0].values = values;
    for (size_t n = 0; (field = mf_result_summary_field(n, &capacity)); n++) {
        if (used == MAX_NUMBERS || !fill_numbers(values + used * count, field, fits, count))
            continue;
        char reduced[HEADER_SIZE];
        snprintf(reduced, sizeof reduced, "%s[%s]", field->name, field->unit);
        mf_data_table_translate(&units, reduced, headers[used], HEADER_SIZE);
        written[used] = (struct data_column){headers[used], values + used * count, "%.16g"};
        used++;
    }
    TRY(list_names(&comment, fits, count));
    snprintf(file, sizeof file, "%s/compare.tsv", out);
    return mf_data_table_write(file, comment, written, used, count);
}
