// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/target.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "observe/finite_size.h"

#include <math.h>

static const char *const formats[] = {"columns", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct target_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field target_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "",
     .help = "g(r) at equally spaced bin centres, in units of the scene"},
    {"format", FIELD_CHOICE, MEMBER(format), .choices = formats, .initial = TARGET_COLUMNS,
     .unit = "",
     .help = "votca: a .dist.tgt in nm, by the scene's \"units\"; its columns are known"},
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "bins with centres beyond are left out; 0: none"},
    {"r_column", FIELD_INTEGER, MEMBER(r_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "number of the column with the bin centres, from 1"},
    {"g_column", FIELD_INTEGER, MEMBER(g_column), .initial = 2, .minimum = 1, COLUMN,
     .help = "number of the column with g"},
    {"error_column", FIELD_INTEGER, MEMBER(error_column), .initial = 3, .minimum = 0, COLUMN,
     .help = "number of the column with the standard error of g; 0 if there is none"},
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e9,
     .unit = "",
     .help = "of all types in the system where it was measured, to correct for another number in "
             "the scene; 0 means the same"},
    {"normalisation", FIELD_NUMBER, MEMBER(normalisation), .initial = 0, .minimum = 0,
     .maximum = 100, .unit = "",
     .help = "factor by which g of the file is too large as a whole, as by N - 1 for N or by a "
             "wrong density; 0: found from g itself, and 1 where nothing speaks against it"},
    {"normalisation_error", FIELD_NUMBER, MEMBER(normalisation_error), .initial = 0.01,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help =
         "how far from 1 a normalisation that is to be found may well be: its standard deviation "
         "before any measurement"},
    FIELD_END,
};

/// Rows of a file, in units of the scene.
struct rows {
    size_t count;
    double *r, *g, *error;
    size_t *line;
};

static void rows_clear(struct rows *rows) {
    memory_free(rows->r);
    memory_free(rows->g);
    memory_free(rows->error);
    memory_free(rows->line);
}

static enum status rows_allocate(struct rows *rows, size_t count) {
    enum status status = STATUS_OK;
    rows->count = count;
    NEW_ARRAY(rows->r, count);
    NEW_ARRAY(rows->g, count);
    NEW_ARRAY(rows->error, count);
    NEW_ARRAY(rows->line, count);
done:
    return status;
}

static double cell(const struct data_table *table, size_t row, int64_t column) {
    return table->values[row * table->columns + (size_t)column - 1];
}

static enum status read_columns(const struct target_parameters *p, struct rows *rows) {
    enum status status = STATUS_OK;
    struct data_table table = {0};
    const int64_t most = p->r_column > p->g_column ? p->r_column : p->g_column;
    const int64_t columns = p->error_column > most ? p->error_column : most;
    CHECK(data_table_read(&table, p->file, (size_t)columns));
    CHECK(data_table_check_increasing(&table, p->file, (size_t)p->r_column - 1, 0));
    CHECK(rows_allocate(rows, table.rows));
    for (size_t k = 0; k < table.rows; k++) {
        rows->r[k] = cell(&table, k, p->r_column);
        rows->g[k] = cell(&table, k, p->g_column);
        rows->error[k] = p->error_column ? cell(&table, k, p->error_column) : 0;
        rows->line[k] = table.line[k];
    }
done:
    data_table_clear(&table);
    return status;
}

/// From nm. VOTCA's bin about r = 0 is half a bin, and empty: it is left out.
static enum status read_votca(const struct target_parameters *p, const struct units *units,
                              struct rows *rows) {
    enum status status = STATUS_OK;
    struct votca_table table = {0};
    CHECK(votca_read(&table, p->file));
    const size_t first = table.rows > 0 && table.x[0] == 0 && table.y[0] == 0;
    CHECK(rows_allocate(rows, table.rows - first));
    for (size_t k = first; k < table.rows; k++) {
        rows->r[k - first] = table.x[k] / units->length;
        rows->g[k - first] = table.y[k];
        rows->error[k - first] = table.error[k];
        rows->line[k - first] = table.line[k];
    }
    for (size_t k = 1; k < rows->count; k++)
        if (!(rows->r[k] > rows->r[k - 1])) {
            status = status_fail(STATUS_BAD_INPUT, "%s:%zu: column 1 does not grow", p->file,
                                 rows->line[k]);
            goto done;
        }
done:
    votca_clear(&table);
    return status;
}

/// Leave out what lies beyond the cutoff.
static void cut(const struct target_parameters *p, struct rows *rows) {
    // One part in 10^9 forgives a rounded cutoff.
    while (p->cutoff > 0 && rows->count > 0 && rows->r[rows->count - 1] > p->cutoff * (1 + 1e-9))
        rows->count--;
}

/// The row whose step from the one before is farthest from `width`, the mean step: with a gap, the
/// row behind it.
static size_t oddest_row(const struct rows *rows, double width, double *step) {
    size_t oddest = 1;
    *step = width;
    for (size_t k = 1; k < rows->count; k++) {
        const double here = rows->r[k] - rows->r[k - 1];
        if (fabs(here - width) > fabs(*step - width)) {
            oddest = k;
            *step = here;
        }
    }
    return oddest;
}

/// Bins from their centres, which must be equally spaced to the digits of the file.
static enum status find_bins(const struct rows *rows, const char *file, struct rdf_bins *bins) {
    if (rows->count < 4)
        return status_fail(STATUS_BAD_INPUT, "%s: only %zu bins", file, rows->count);
    const double first = rows->r[0];
    const double width = (rows->r[rows->count - 1] - first) / (double)(rows->count - 1);
    double step;
    const size_t oddest = oddest_row(rows, width, &step);
    if (fabs(step / width - 1) > 0.01)
        return status_fail(STATUS_BAD_INPUT,
                           "%s:%zu: the bins are not equally spaced: a step of %g where the mean "
                           "is %g (a gap in the target?)",
                           file, rows->line[oddest], step, width);
    // First edges come out as 0 but for the file's rounding.
    const double low = first - 0.5 * width;
    if (low < -0.01 * width)
        return status_fail(STATUS_BAD_INPUT,
                           "%s:%zu: r = %g is not the centre of a bin of width %g", file,
                           rows->line[0], first, width);
    *bins = (struct rdf_bins){
        .low = fabs(low) < 0.01 * width ? 0 : low, .width = width, .count = rows->count};
    return STATUS_OK;
}

static enum status check_values(const struct rows *rows, const char *file) {
    for (size_t k = 0; k < rows->count; k++)
        if (rows->g[k] < 0 || rows->error[k] < 0)
            return status_fail(STATUS_BAD_INPUT, "%s:%zu: a negative g or error", file,
                               rows->line[k]);
    return STATUS_OK;
}

static enum status load(struct target *target, const struct units *units) {
    enum status status = STATUS_OK;
    const struct target_parameters *p = &target->parameters;
    struct rows rows = {0};
    CHECK(p->format == TARGET_VOTCA ? read_votca(p, units, &rows) : read_columns(p, &rows));
    cut(p, &rows);
    struct rdf_bins bins;
    CHECK(find_bins(&rows, p->file, &bins));
    CHECK(check_values(&rows, p->file));
    target->bins = bins;
    target->g = rows.g;
    target->error = rows.error;
    rows.g = rows.error = NULL;
done:
    rows_clear(&rows);
    return status;
}

enum status target_read(struct target *target, struct json_object *object,
                        const struct units *units) {
    *target = (struct target){0};
    const size_t faults = json_fault_count(object->document);
    json_fields(object, target_fields, &target->parameters);
    json_finish(object);
    if (json_fault_count(object->document) > faults)
        return STATUS_OK;
    if (target->parameters.format == TARGET_VOTCA && !units_known(units)) {
        json_fault(object, "format", "VOTCA's nm need \"units\" in the scene");
        return STATUS_OK;
    }
    const enum status status = load(target, units);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        json_fault(object, "file", "%s", status_message());
    return STATUS_OK;
}

/// Of N_a (N_a − 1) in N_a², in the system that was measured.
static double possible_share(const struct composition *composition, int pair, double particles) {
    int type[2];
    composition_pair_types(composition, pair, type);
    const double share = particles / (double)composition_particles(composition);
    return type[0] == type[1] ? 1 - 1 / (share * (double)composition->count[type[0]]) : 1;
}

void target_convert(const struct target *target, const struct box *box,
                    const struct composition *composition, int pair, double *g, double *error) {
    const struct target_parameters *p = &target->parameters;
    const double to = (double)composition_particles(composition);
    const double from = p->particles > 0 ? (double)p->particles : to;
    const double votca =
        p->format == TARGET_VOTCA ? 1 / possible_share(composition, pair, from) : 1;
    for (size_t k = 0; k < target->bins.count; k++) {
        g[k] = votca * target->g[k];
        error[k] = votca * target->error[k];
    }
    const double factor =
        finite_size_factor_of(&target->bins, g, error, box, composition, pair, from, to);
    for (size_t k = 0; k < target->bins.count; k++) {
        g[k] *= factor;
        error[k] *= factor;
    }
}

void target_clear(struct target *target) {
    memory_free(target->g);
    memory_free(target->error);
    *target = (struct target){0};
}
