// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/force_equations.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "observe/sample_blocks.h"
#include "trajectory/source.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum status mf_force_equations_init(struct force_equations *equations,
                                    const struct force_curve *curve, size_t curves) {
    enum status status = STATUS_OK;
    *equations = (struct force_equations){.curves = curves, .each = 1};
    NEW_ARRAY(equations->curve, curves);
    for (size_t n = 0; n < curves; n++) {
        equations->curve[n] = curve[n];
        equations->curve[n].first = equations->size;
        equations->size += curve[n].nodes;
    }
    NEW_ARRAY(equations->gram, FORCES_BLOCKS * force_equations_entries(equations));
    NEW_ARRAY(equations->product, FORCES_BLOCKS * equations->size);
    NEW_ARRAY(equations->virial, FORCES_BLOCKS * equations->size);
done:
    if (status != STATUS_OK)
        mf_force_equations_clear(equations);
    return status;
}

void mf_force_equations_clear(struct force_equations *equations) {
    mf_memory_free(equations->curve);
    mf_memory_free(equations->gram);
    mf_memory_free(equations->product);
    mf_memory_free(equations->virial);
    *equations = (struct force_equations){0};
}

bool mf_force_equations_find(const struct force_curve *curve, double q, size_t *node, size_t *next,
                             double *share) {
    double at = (q - curve->low) / curve->width;
    const double last = (double)(curve->nodes - 1);
    const bool circle = force_curve_is_circle(curve);
    if (curve->order == FORCES_OF_PAIRS && at > last)
        return false;
    if (circle)
        at -= (double)curve->nodes * floor(at / (double)curve->nodes);
    const size_t below = (size_t)fmin(fmax(floor(at), 0), circle ? last : last - 1);
    *node = curve->first + below;
    *next = curve->first + (below + 1) % curve->nodes;
    *share = at - (double)below;
    return true;
}

void mf_force_equations_add(struct force_equations *equations, const double *gram,
                            const double *product, const double *virial, double square) {
    const size_t entries = force_equations_entries(equations), size = equations->size;
    if (equations->frames == FORCES_BLOCKS * equations->each) {
        mf_sample_blocks_join(equations->gram, FORCES_BLOCKS, entries);
        mf_sample_blocks_join(equations->product, FORCES_BLOCKS, size);
        mf_sample_blocks_join(equations->virial, FORCES_BLOCKS, size);
        equations->each *= 2;
    }
    const size_t block = equations->frames / equations->each;
    for (size_t k = 0; k < entries; k++)
        equations->gram[block * entries + k] += gram[k];
    for (size_t k = 0; k < size; k++) {
        equations->product[block * size + k] += product[k];
        equations->virial[block * size + k] += virial[k];
    }
    equations->square += square;
    equations->frames++;
}

/// Whether nodes are at lengths.
static bool is_of_length(const struct force_curve *curve) {
    return curve->order == FORCES_OF_PAIRS ||
           (curve->order != FORCES_OF_DENSITY && mf_bonded_kinds[curve->order]->is_length);
}

void mf_force_equations_scale(struct force_equations *equations, double length, double energy) {
    double factor[FORCES_MAX_NODES] = {0};
    for (size_t n = 0; n < equations->curves; n++) {
        struct force_curve *const curve = &equations->curve[n];
        const double unit = is_of_length(curve) ? length : 1;
        curve->low /= unit;
        curve->width /= unit;
        curve->inner_cutoff /= length;
        curve->cutoff /= length;
        for (size_t k = 0; k < curve->nodes; k++)
            factor[curve->first + k] = energy / unit;
    }
    for (size_t b = 0; b < force_equations_blocks(equations); b++) {
        double *entry = equations->gram + b * force_equations_entries(equations);
        for (size_t k = 0; k < equations->size; k++) {
            equations->product[b * equations->size + k] *= factor[k];
            equations->virial[b * equations->size + k] *= factor[k] * pow(length, 3) / energy;
            for (size_t l = 0; l <= k; l++)
                *entry++ *= factor[k] * factor[l];
        }
    }
}

//
// Comment lines say what the unknowns are:
//   # frames 1000 64 beads 864 square 1.2e9
//   # curve pairs A-B 13 0.1 0.01
//   # curve bond backbone 40 0.2 0.005
//   # curve density 0.3,0.7 41 0 0.5
// the frames of all and of a block; the nodes of a curve, the first, and between two [nm, rad].

static const char *kind_name(int order) {
    return order == FORCES_OF_PAIRS     ? "pairs"
           : order == FORCES_OF_DENSITY ? "density"
                                        : mf_bonded_kinds[order]->name;
}

static enum status note(struct bytes *text, const char *format, ...)
    __attribute__((format(printf, 2, 3), warn_unused_result));
static enum status note(struct bytes *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const enum status status = mf_source_note(text, format, arguments);
    va_end(arguments);
    return status;
}

static enum status describe(const struct force_equations *equations, struct bytes *text) {
    TRY(note(text, "Normal equations of forces [nm, rad, kJ/mol], summed over blocks of frames: b "
                   "at the nodes, and the virial of the nodes by 3 V"));
    TRY(note(text, "frames %zu %zu beads %.0f square %.17g", equations->frames, equations->each,
             equations->beads, equations->square));
    for (size_t n = 0; n < equations->curves; n++) {
        const struct force_curve *const curve = &equations->curve[n];
        TRY(note(text, "curve %s %s %zu %.17g %.17g", kind_name(curve->order), curve->name,
                 curve->nodes, curve->low, curve->width));
    }
    return STATUS_OK;
}

enum { BLOCK_NAME = 32 };

/// Columns of a table.
struct columns {
    struct data_column column[2 * FORCES_BLOCKS + 1];
    char name[2 * FORCES_BLOCKS][BLOCK_NAME];
    size_t count;
};

/// Columns "what_1", …: numbers of blocks.
static void add_blocks(struct columns *columns, const char *what, size_t blocks,
                       const double *numbers, size_t rows) {
    for (size_t b = 0; b < blocks; b++) {
        char *const name = columns->name[columns->count - 1];
        snprintf(name, BLOCK_NAME, "%s_%zu", what, b + 1);
        columns->column[columns->count++] = (struct data_column){name, numbers + b * rows, "%.15g"};
    }
}

static enum status write_products(const struct force_equations *equations, const char *file,
                                  const char *comment, const double *q) {
    const size_t blocks = force_equations_blocks(equations);
    struct columns columns = {.column = {{"q[nm or rad]", q, NULL}}, .count = 1};
    add_blocks(&columns, "block", blocks, equations->product, equations->size);
    add_blocks(&columns, "virial", blocks, equations->virial, equations->size);
    return mf_data_table_write(file, comment, columns.column, columns.count, equations->size);
}

static enum status write_gram(const struct force_equations *equations, const char *file) {
    const size_t rows = force_equations_entries(equations);
    struct columns columns = {.count = 1}; // none stands before those of blocks
    add_blocks(&columns, "block", force_equations_blocks(equations), equations->gram, rows);
    return mf_data_table_write(file,
                               "G of the same unknowns: rows (1, 1), (2, 1), (2, 2), (3, 1), …",
                               columns.column + 1, columns.count - 1, rows);
}

enum status mf_force_equations_write(const struct force_equations *equations, const char *file,
                                     const char *gram_file) {
    enum status status = STATUS_OK;
    struct bytes text = {0};
    double *q = NULL;
    NEW_ARRAY(q, equations->size);
    for (size_t n = 0; n < equations->curves; n++)
        for (size_t k = 0; k < equations->curve[n].nodes; k++)
            q[equations->curve[n].first + k] =
                equations->curve[n].low + (double)k * equations->curve[n].width;
    CHECK(describe(equations, &text));
    CHECK(write_products(equations, file, (const char *)text.data, q));
    CHECK(write_gram(equations, gram_file));
done:
    mf_memory_free(q);
    mf_source_free(&text);
    return status;
}

// Reading -----------------------------------------------------------------------------------------

/// False if there is no such kind.
static bool find_order(const char *kind, int *order) {
    for (*order = FORCES_OF_PAIRS; *order <= FORCES_OF_DENSITY; ++*order)
        if (strcmp(kind, kind_name(*order)) == 0)
            return true;
    return false;
}

/// The weight that its name tells.
static bool read_weight(struct force_curve *curve) {
    return curve->order != FORCES_OF_DENSITY ||
           (sscanf(curve->name, "%lf,%lf", &curve->inner_cutoff, &curve->cutoff) == 2 &&
            curve->inner_cutoff >= 0 && curve->cutoff > curve->inner_cutoff &&
            isfinite(curve->cutoff));
}

/// A line of the comments as "curve pairs A-B 13 0.1 0.01"; false if it is another.
static bool read_curve(const char *line, struct force_curve *curve) {
    char kind[FORCES_NAME_SIZE];
    *curve = (struct force_curve){0};
    if (sscanf(line, "# curve %63s %63s %zu %lf %lf", kind, curve->name, &curve->nodes, &curve->low,
               &curve->width) != 5)
        return false;
    return find_order(kind, &curve->order) && read_weight(curve) && curve->nodes >= 2 &&
           curve->nodes <= FORCES_MAX_NODES && curve->width > 0 && isfinite(curve->low) &&
           isfinite(curve->width);
}

static enum status fail(const char *file, const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: %s: it is to be a table that \"mesofit measure --forces\" has "
                          "written",
                          file, what);
}

/// What the comments say.
static enum status read_heading(struct force_equations *equations, const struct data_table *table,
                                const char *file) {
    struct force_curve curve[FORCES_MAX_CURVES];
    size_t curves = 0, frames = 0, each = 0, nodes = 0;
    double beads = 0, square = 0;
    for (const char *line = table->comments; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (sscanf(line, "# frames %zu %zu beads %lf square %lf", &frames, &each, &beads,
                   &square) == 4)
            continue;
        if (curves < FORCES_MAX_CURVES && read_curve(line, &curve[curves]))
            nodes += curve[curves++].nodes;
    }
    const size_t blocks = each ? (frames + each - 1) / each : 0;
    if (curves == 0 || nodes > FORCES_MAX_NODES || nodes != table->rows || blocks == 0 ||
        blocks > FORCES_BLOCKS || 2 * blocks + 1 != table->columns || !(square > 0))
        return fail(file, "its heading does not fit its rows and columns");
    TRY(mf_force_equations_init(equations, curve, curves));
    equations->frames = frames;
    equations->each = each;
    equations->beads = beads;
    equations->square = square;
    return STATUS_OK;
}

/// So many columns from `first` on, shape [blocks, rows].
static void take(const struct data_table *table, size_t first, size_t blocks, double *numbers) {
    for (size_t row = 0; row < table->rows; row++)
        for (size_t b = 0; b < blocks; b++)
            numbers[b * table->rows + row] = table->values[row * table->columns + first + b];
}

enum status mf_force_equations_read(struct force_equations *equations, const char *file,
                                    const char *gram_file) {
    CLEARED_BY(mf_data_table_clear) struct data_table table = {0}, gram = {0};
    TRY(mf_data_table_read(&table, file, 2));
    TRY(read_heading(equations, &table, file));
    const size_t blocks = force_equations_blocks(equations);
    take(&table, 1, blocks, equations->product);
    take(&table, 1 + blocks, blocks, equations->virial);
    TRY(mf_data_table_read(&gram, gram_file, 1));
    if (gram.rows != force_equations_entries(equations) || gram.columns != blocks)
        return fail(gram_file, "its rows and columns are not those of the other file");
    take(&gram, 0, blocks, equations->gram);
    return STATUS_OK;
}
