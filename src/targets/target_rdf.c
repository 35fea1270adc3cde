// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_rdf.h"

#include "base/memory.h"
#include "problem/targets.h"

#include <math.h>
#include <string.h>

/// Bins that an inversion solves for in little time: more are joined unless the file says how wide.
static const double max_bins = 400;

/// Standard error of g = 1 in the last bin if neither the file nor the scatter tells it: that of a
/// short simulation, or of a drawn curve.
static const double assumed_error = 0.002;

static const char *const formats[] = {"columns", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct target_rdf_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field mf_target_rdf_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "",
     .help = "g(r) at increasing r, in units of the scene"},
    {"format", FIELD_CHOICE, MEMBER(format), .choices = formats, .initial = TARGET_ROWS_COLUMNS,
     .unit = "", .help = "votca: a .dist.tgt in nm; the scene needs \"units\""},
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "largest bin centre used; 0: any"},
    {"r_column", FIELD_INTEGER, MEMBER(r_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of the bin centres, from 1"},
    {"g_column", FIELD_INTEGER, MEMBER(g_column), .initial = 2, .minimum = 1, COLUMN,
     .help = "column of g"},
    {"error_column", FIELD_INTEGER, MEMBER(error_column), .initial = -1, .minimum = -1, COLUMN,
     .help = "column of errors; 0, or nan: from the scatter; -1: 3 "
             "if present, else 0"},
    {"bin_width", FIELD_NUMBER, MEMBER(bin_width), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "width to which bins are merged; 0: the file's, or chosen"},
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e9,
     .unit = "",
     .help = "number of particles in the measured system, to correct the normalisation; 0: the "
             "scene's"},
    {"normalisation", FIELD_NUMBER, MEMBER(normalisation), .initial = 0, .minimum = 0,
     .maximum = 100, .unit = "",
     .help = "factor by which the file's g is too large; 0: estimated from g"},
    {"normalisation_error", FIELD_NUMBER, MEMBER(normalisation_error), .initial = 0.01,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "prior standard deviation of an estimated normalisation from 1"},
    {"errors_of", FIELD_CHOICE, MEMBER(errors_of), .choices = mf_targets_errors,
     .initial = TARGET_ERRORS_UNKNOWN, .unit = "",
     .help = "samples: a simulation's; bins: independent, as a figure's; "
             "unknown: the file's, or larger"},
    FIELD_END,
};

/// Errors are small beside g, and they do not add up; those of a column that is called so may be of
/// a short measurement.
static enum status check_errors(const struct target_rdf_parameters *p,
                                const struct target_rows *rows, int64_t column, bool named) {
    static const double structure = 0.1, largest_share = 0.5;
    size_t large = 0, seen = 0;
    bool grows = rows->error[rows->count - 1] > 1;
    for (size_t k = 0; k < rows->count; k++) {
        if (!isfinite(rows->error[k]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: column %lld: \"nan\" is not a finite number", p->file,
                                  rows->line[k], (long long)column);
        grows = grows && (k == 0 || rows->error[k] >= rows->error[k - 1]);
        seen += rows->y[k] > structure;
        large += rows->y[k] > structure && rows->error[k] > largest_share * rows->y[k];
    }
    if (!named && (grows || 2 * large > seen))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: column %lld cannot be the standard error of g: it %s; set "
                              "\"error_column\" to another, or to 0",
                              p->file, (long long)column,
                              grows ? "increases from row to row, as a number of neighbours does"
                                    : "is as large as g");
    return STATUS_OK;
}

static enum status read_columns(struct target_rdf *target, const struct units *units) {
    struct target_rdf_parameters *const p = &target->parameters;
    struct target_rows *const rows = &target->rows;
    struct target_columns columns = {.file = p->file,
                                     .x_unit = "lambda",
                                     .x = p->r_column,
                                     .y = p->g_column,
                                     .error = p->error_column,
                                     .usual_error = "g_error"};
    TRY(mf_target_rows_read(rows, &columns, units));
    if (columns.numbered)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: column %lld numbers the rows, and column %lld increases as r does: "
            "set \"r_column\" to %lld and \"g_column\" to that of g",
            p->file, (long long)columns.x, (long long)columns.y, (long long)columns.y);
    if (p->errors_of == TARGET_ERRORS_UNKNOWN && columns.errors_of_samples)
        p->errors_of = TARGET_ERRORS_OF_SAMPLES;
    return rows->has_errors ? check_errors(p, rows, columns.error, columns.is_usual_error)
                            : STATUS_OK;
}

/// From nm.
static enum status read_votca(const struct target_rdf_parameters *p, const struct units *units,
                              struct target_rows *rows) {
    TRY(mf_target_rows_read_votca(rows, p->file));
    for (size_t k = 0; k < rows->count; k++)
        rows->x[k] /= units->length;
    for (size_t k = 1; k < rows->count; k++)
        if (!(rows->x[k] > rows->x[k - 1]))
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column 1 does not increase", p->file,
                                  rows->line[k]);
    return STATUS_OK;
}

/// Leave out what lies beyond the cutoff.
static void cut(const struct target_rdf_parameters *p, struct target_rows *rows) {
    // One part in 10^9 forgives a rounded cutoff.
    while (p->cutoff > 0 && rows->count > 0 && rows->x[rows->count - 1] > p->cutoff * (1 + 1e-9))
        rows->count--;
}

/// What is nearer to 0 than this share of the peak may be 0, as in the core of a g that was
/// digitised or resampled.
static const double slightly = 0.02;

static double peak_of(const struct target_rows *rows) {
    double peak = 0;
    for (size_t k = 0; k < rows->count; k++)
        peak = fmax(peak, rows->y[k]);
    return peak;
}

/// VOTCA and gmx rdf have their bins about multiples of the width. The one about r = 0 is half a
/// bin: it is left out if it is empty, as far as that can be told, and the bins begin where it
/// ends.
static void leave_out_half_bin(struct target_rows *rows) {
    if (rows->count < 2 || rows->x[0] != 0 || fabs(rows->y[0]) > slightly * peak_of(rows))
        return;
    rows->count--;
    memmove(rows->x, rows->x + 1, rows->count * sizeof *rows->x);
    memmove(rows->y, rows->y + 1, rows->count * sizeof *rows->y);
    memmove(rows->error, rows->error + 1, rows->count * sizeof *rows->error);
    memmove(rows->line, rows->line + 1, rows->count * sizeof *rows->line);
}

/// Bins from their centres, which are equally spaced.
static enum status find_bins(const struct target_rows *rows, const char *file,
                             struct rdf_bins *bins) {
    enum { FEWEST_ROWS = 4 };
    if (rows->count < FEWEST_ROWS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu bin%s; a g(r) needs at least %d",
                              file, rows->count, rows->count == 1 ? "" : "s", FEWEST_ROWS);
    const double first = rows->x[0];
    const double width = (rows->x[rows->count - 1] - first) / (double)(rows->count - 1);
    // First edges come out as 0 but for the file's rounding.
    const double low = first - 0.5 * width;
    if (low < -0.01 * width)
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s:%zu: %s is not the centre of a bin%s; leave the row out", file,
            rows->line[0], first == 0 ? "r = 0" : "the first r",
            first == 0 ? ": half a bin that is not empty" : ", which would begin below 0");
    *bins = (struct rdf_bins){
        .low = fabs(low) < 0.01 * width ? 0 : low, .width = width, .count = rows->count};
    return STATUS_OK;
}

/// Read what is slightly below 0 as 0.
static enum status check_values(struct target_rdf *target, struct target_rows *rows) {
    static const double standard_errors = 3;
    const char *file = target->parameters.file;
    const double peak = peak_of(rows);
    for (size_t k = 0; k < rows->count; k++) {
        if (rows->error[k] < 0)
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: a negative error of g, %g", file,
                                  rows->line[k], rows->error[k]);
        if (rows->y[k] >= 0)
            continue;
        if (-rows->y[k] > fmax(slightly * peak, standard_errors * rows->error[k]))
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s:%zu: a negative g, %g: a potential, or another column than g?", file,
                rows->line[k], rows->y[k]);
        target->negative++;
        target->min = fmin(target->min, rows->y[k]);
        rows->y[k] = 0;
    }
    return STATUS_OK;
}

/// Rows that are not equally spaced, read at r that are.
static enum status resample(struct target_rdf *target, struct target_rows *rows) {
    if (!mf_target_resample_is_needed(rows))
        return STATUS_OK;
    TRY(mf_target_resample(rows, target->parameters.file, rows->has_errors, assumed_error,
                           &target->resampling));
    rows->has_errors = true;
    return STATUS_OK;
}

/// Join the rows to bins; errors that the file does not give come from the scatter of the rows, or,
/// where that cannot be told, are those that are assumed of the bins.
static enum status join(struct target_rdf *target, struct target_rows *rows) {
    double scatter = NAN;
    if (!rows->has_errors)
        TRY(mf_target_rows_scatter(rows, &scatter));
    if (!isnan(scatter))
        mf_target_rows_set_errors(rows, scatter);
    if (target->joined > 1)
        mf_target_rows_join(rows, target->joined);
    target->assumed = !rows->has_errors && isnan(scatter);
    if (target->assumed)
        mf_target_rows_set_errors(rows, assumed_error);
    if (!rows->has_errors)
        target->estimated_error =
            target->assumed ? assumed_error : scatter / sqrt((double)target->joined);
    return STATUS_OK;
}

/// Rows that make one bin.
static size_t rows_of_a_bin(const struct target_rdf_parameters *p, const struct rdf_bins *bins) {
    if (p->bin_width > 0)
        return (size_t)fmin(fmax(1, round(p->bin_width / bins->width)), (double)bins->count);
    return (size_t)ceil((double)bins->count / max_bins);
}

/// The mean of g at its end, or 1 if that is more.
static double level_at_end(const struct target_rows *rows) {
    const size_t from = rows->count - 1 - rows->count / 20;
    double sum = 0;
    for (size_t k = from; k < rows->count; k++)
        sum += rows->y[k];
    return fmax(1, sum / (double)(rows->count - from));
}

/// Keep the rows before they are cut. What is wrong with them is told of those that are left.
static enum status keep_whole(struct target_rdf *target, const struct target_rows *rows) {
    struct target_rdf_whole *whole = &target->whole;
    const double cutoff = target->parameters.cutoff;
    if (!rows->has_errors || !(cutoff > 0) || !(rows->x[rows->count - 1] > cutoff) ||
        find_bins(rows, target->parameters.file, &whole->bins) != STATUS_OK) {
        whole->bins = (struct rdf_bins){0};
        return STATUS_OK;
    }
    TRY_ARRAY(whole->g, rows->count);
    TRY_ARRAY(whole->error, rows->count);
    const double level = level_at_end(rows);
    for (size_t k = 0; k < rows->count; k++)
        whole->g[k] = rows->y[k] / level;
    memcpy(whole->error, rows->error, rows->count * sizeof *whole->error);
    return STATUS_OK;
}

static enum status copy(struct target_rows *to, const struct target_rows *from) {
    const size_t bytes = from->count * sizeof(double);
    TRY(mf_target_rows_allocate(to, from->count));
    memcpy(to->x, from->x, bytes);
    memcpy(to->y, from->y, bytes);
    memcpy(to->error, from->error, bytes);
    memcpy(to->line, from->line, from->count * sizeof *to->line);
    to->has_errors = from->has_errors;
    return STATUS_OK;
}

/// All that follows from the rows.
static void clear_bins(struct target_rdf *target) {
    mf_memory_free(target->g);
    mf_memory_free(target->error);
    mf_memory_free(target->whole.g);
    mf_memory_free(target->whole.error);
    *target = (struct target_rdf){.parameters = target->parameters,
                                  .given = target->given,
                                  .rows = target->rows,
                                  .tail = target->tail};
}

enum status mf_target_rdf_cut(struct target_rdf *target) {
    const struct target_rdf_parameters *p = &target->parameters;
    CLEARED_BY(mf_target_rows_clear)
    struct target_rows rows = {.dimensions = target->rows.dimensions};
    struct rdf_bins bins;
    clear_bins(target);
    TRY(copy(&rows, &target->rows));
    TRY(keep_whole(target, &rows));
    cut(p, &rows);
    TRY(check_values(target, &rows));
    TRY(resample(target, &rows));
    TRY(find_bins(&rows, p->file, &bins));
    target->joined = rows_of_a_bin(p, &bins);
    TRY(join(target, &rows));
    TRY(find_bins(&rows, p->file, &target->bins));
    target->g = rows.y;
    target->error = rows.error;
    rows.y = rows.error = NULL;
    return STATUS_OK;
}

static enum status load(struct target_rdf *target, const struct units *units, int dimensions) {
    const struct target_rdf_parameters *p = &target->parameters;
    target->rows.dimensions = dimensions;
    TRY(p->format == TARGET_ROWS_VOTCA ? read_votca(p, units, &target->rows)
                                       : read_columns(target, units));
    leave_out_half_bin(&target->rows);
    target->tail = mf_target_rows_tail(&target->rows);
    return mf_target_rdf_cut(target);
}

enum status mf_target_rdf_read(struct target_rdf *target, struct json_object *object,
                               const struct units *units, int dimensions) {
    *target = (struct target_rdf){0};
    const size_t faults = mf_json_fault_count(object->document);
    target->given = mf_json_fields(object, mf_target_rdf_fields, &target->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    if (target->parameters.format == TARGET_ROWS_VOTCA && !mf_units_known(units)) {
        mf_json_fault(object, "format", "VOTCA's nm need \"units\" in the scene");
        return STATUS_OK;
    }
    return mf_target_rows_fault(object, "file", load(target, units, dimensions));
}

/// Of N_a (N_a − 1) in N_a², in the system that was measured.
static double possible_share(const struct composition *composition, int pair, double particles) {
    int type[2];
    mf_composition_pair_types(composition, pair, type);
    const double share = particles / (double)mf_composition_particles(composition);
    return type[0] == type[1] ? 1 - 1 / (share * (double)composition->count[type[0]]) : 1;
}

void mf_target_rdf_convert(const struct target_rdf *target, const struct finite_size_fluid *fluid,
                           int pair, double *g, double *error) {
    const struct target_rdf_parameters *p = &target->parameters;
    const double to = (double)mf_composition_particles(fluid->composition);
    const double from = p->particles > 0 ? (double)p->particles : to;
    const double votca =
        p->format == TARGET_ROWS_VOTCA ? 1 / possible_share(fluid->composition, pair, from) : 1;
    for (size_t k = 0; k < target->bins.count; k++) {
        g[k] = votca * target->g[k];
        error[k] = votca * target->error[k];
    }
    const double factor = mf_finite_size_factor_of(&target->bins, g, error, fluid, pair, from, to);
    for (size_t k = 0; k < target->bins.count; k++) {
        g[k] *= factor;
        error[k] *= factor;
    }
}

void mf_target_rdf_clear(struct target_rdf *target) {
    clear_bins(target);
    mf_target_rows_clear(&target->rows);
    *target = (struct target_rdf){0};
}
