// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_bonded.h"

#include "base/memory.h"
#include "forces/bonded.h"
#include "problem/targets.h"
#include "targets/target_rows.h"

#include <math.h>
#include <string.h>

/// Bins beyond these are joined; standard error at the peak, in peaks, if nothing tells it.
enum { MAX_BINS = 200, FEWEST_ROWS = 8 };
static const double assumed_error = 0.01;

/// By which the integral of p may differ from 1.
static const double normalised = 0.01;

static const char *const formats[] = {"columns", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct target_bonded_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field mf_target_bonded_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "",
     .help = "p at equally spaced bin centres (angles in degrees), normalised, not divided by the "
             "Jacobian"},
    {"format", FIELD_CHOICE, MEMBER(format), .choices = formats, .initial = TARGET_ROWS_COLUMNS,
     .unit = "", .help = "votca: a .dist.tgt in nm or radians; the scene needs \"units\""},
    {"q_column", FIELD_INTEGER, MEMBER(q_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of the bin centres, from 1"},
    {"value_column", FIELD_INTEGER, MEMBER(value_column), .initial = 0, .minimum = 0, COLUMN,
     .help = "column of p; 0: that named as the group, or 2"},
    {"error_column", FIELD_INTEGER, MEMBER(error_column), .initial = -1, .minimum = -1, COLUMN,
     .help = "column of errors; 0: from the scatter; -1: that named "
             "as the group with \"_error\", or 3, else 0"},
    {"errors_of", FIELD_CHOICE, MEMBER(errors_of), .choices = mf_targets_errors,
     .initial = TARGET_ERRORS_UNKNOWN, .unit = "",
     .help = "samples: a simulation's; bins: independent, as a figure's; "
             "unknown: the file's, or larger"},
    FIELD_END,
};

/// In λ or degrees.
static enum status read_columns(struct target_bonded_parameters *p, int order, const char *name,
                                const struct units *units, struct target_rows *rows) {
    struct target_columns columns = {.file = p->file,
                                     .name = name,
                                     .x_unit = mf_bonded_kinds[order]->unit,
                                     .y_unit = mf_bonded_kinds[order]->density,
                                     .min = -INFINITY,
                                     .x = p->q_column,
                                     .y = p->value_column,
                                     .error = p->error_column};
    TRY(mf_target_rows_read(rows, &columns, units));
    if (p->errors_of == TARGET_ERRORS_UNKNOWN && columns.errors_of_samples)
        p->errors_of = TARGET_ERRORS_OF_SAMPLES;
    for (size_t k = 0; k < rows->count; k++)
        rows->error[k] = isfinite(rows->error[k]) ? rows->error[k] : 0;
    const double last = rows->x[rows->count - 1];
    if (mf_bonded_kinds[order]->is_length || last >= 7) // 2 pi, and no range of degrees
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: the angles end at %g, as if in radians; they are in degrees, "
                          "but in files of \"format\": \"votca\"",
                          p->file, last);
}

/// From nm or radians.
static enum status read_votca(const char *file, int order, const struct units *units,
                              struct target_rows *rows) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double unit = kind->is_length ? 1 / units->length : 1 / kind->scale;
    TRY(mf_target_rows_read_votca(rows, file));
    const double last = rows->x[rows->count - 1];
    for (size_t k = 0; k < rows->count; k++) {
        rows->x[k] *= unit;
        rows->y[k] /= unit;
        rows->error[k] /= unit;
    }
    if (kind->is_length || last <= 7) // 2 pi
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: the angles end at %g, as if in degrees; VOTCA's are in radians",
                          file, last);
}

// Checks ------------------------------------------------------------------------------------------

static double width_of(const struct target_rows *rows) {
    return (rows->x[rows->count - 1] - rows->x[0]) / (double)(rows->count - 1);
}

static enum status check_rows(const struct target_rows *rows, const char *file) {
    if (rows->count < FEWEST_ROWS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu bin%s; at least %d are needed", file,
                              rows->count, rows->count == 1 ? "" : "s", FEWEST_ROWS);
    const double width = width_of(rows);
    for (size_t k = 0; k < rows->count; k++) {
        const double step = k > 0 ? rows->x[k] - rows->x[k - 1] : width;
        if (!(fabs(step / width - 1) < 0.05))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: the bins are not equally spaced: this step is %.3g "
                                  "times the mean one; use equal bins",
                                  file, rows->line[k], step / width);
        if (!(rows->y[k] >= 0 && rows->error[k] >= 0 && isfinite(rows->y[k] + rows->error[k])))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: p = %g with an error of %g is not a distribution", file,
                                  rows->line[k], rows->y[k], rows->error[k]);
    }
    return STATUS_OK;
}

static enum status check_range(const struct target_rows *rows, int order, const char *file) {
    const double width = width_of(rows), last = rows->x[rows->count - 1];
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double low = kind->periodic ? -360 : kind->low, high = kind->periodic ? 360 : kind->high;
    if (rows->x[0] >= low - 0.01 * width && last <= high + width)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: the range is %g to %g; expected %s from %g to %g",
                          file, rows->x[0], last, kind->is_length ? "lengths" : "angles", low,
                          high);
}

static void rescale(struct target_rows *rows, double factor) {
    for (size_t k = 0; k < rows->count; k++) {
        rows->y[k] *= factor;
        rows->error[k] *= factor;
    }
}

/// Divide by the integral, which is 1 up to rounding.
static enum status normalise(struct target_rows *rows, const char *file) {
    double sum = 0;
    for (size_t k = 0; k < rows->count; k++)
        sum += rows->y[k] * width_of(rows);
    if (!(fabs(sum - 1) <= normalised))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the integral of p is %.4g, not 1: expected a normalised "
                              "distribution, not divided by the Jacobian",
                              file, sum);
    rescale(rows, 1 / sum);
    return STATUS_OK;
}

static enum status check(struct target_rows *rows, int order, const char *file) {
    TRY(check_rows(rows, file));
    TRY(check_range(rows, order, file));
    return normalise(rows, file);
}

enum status mf_target_bonded_check_votca(const char *file, int order) {
    static const struct units nanometres = {.length = 1};
    struct target_rows rows = {0};
    enum status status = read_votca(file, order, &nanometres, &rows);
    if (status == STATUS_OK)
        status = check(&rows, order, file);
    mf_target_rows_clear(&rows);
    return status;
}

// Bins --------------------------------------------------------------------------------------------

/// Whether the first and the last row of a circle are halves of one bin, and not the same bin
/// twice, by what is between the rows beside them.
static bool has_half_ends(const struct target_rows *rows) {
    const size_t last = rows->count - 1;
    const double beside = 0.5 * (rows->y[1] + rows->y[last - 1]);
    const double here = rows->y[0] + rows->y[last];
    return fabs(here - beside) <= fabs(0.5 * here - beside);
}

/// The first and the last row of a circle may be halves of one bin, or the same bin twice.
static enum status close_circle(struct target_rows *rows, double *width, const char *file) {
    const size_t last = rows->count - 1;
    const double bins = 360 / *width;
    if (fabs((double)last - bins) < 0.5) {
        if (has_half_ends(rows)) {
            rows->y[0] += rows->y[last];
            rows->error[0] = hypot(rows->error[0], rows->error[last]);
        } else {
            rows->y[0] = 0.5 * (rows->y[0] + rows->y[last]);
            rescale(rows, 1 / (1 - rows->y[last] * *width));
        }
        rows->count--;
    } else if (fabs((double)rows->count - bins) >= 0.5) {
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: expected dihedrals from -180 to 180 degrees, found bins over %g",
                              file, (double)rows->count * *width);
    }
    *width = 360 / (double)rows->count;
    return STATUS_OK;
}

/// Leave out what was never seen, but for two rows at each end.
static void trim(struct target_rows *rows) {
    enum { LEFT = 2 };
    size_t first = 0, end = rows->count;
    while (first + 1 < end && rows->y[first] == 0)
        first++;
    while (end > first + 1 && rows->y[end - 1] == 0)
        end--;
    first = first > LEFT ? first - LEFT : 0;
    end = end + LEFT < rows->count ? end + LEFT : rows->count;
    rows->count = end - first;
    memmove(rows->x, rows->x + first, rows->count * sizeof *rows->x);
    memmove(rows->y, rows->y + first, rows->count * sizeof *rows->y);
    memmove(rows->error, rows->error + first, rows->count * sizeof *rows->error);
}

/// σ² = c² p of counts: c² by fourth differences of −ln(p/J), whose variance is c² Σ b_j²/p_j,
/// where p is above a twentieth of its peak; NaN if that does not tell.
static enum status find_scatter(const struct target_rows *rows, int order, int dimensions,
                                const struct bonded_bins *bins, double *square) {
    enum { TAPS = 5, MIN_DIFFERENCES = 8 };
    static const double taps[TAPS] = {1, -4, 6, -4, 1}, min = 0.05;
    OWNED double *all = NULL;
    double peak = 0;
    size_t count = 0;
    *square = NAN;
    TRY_ARRAY(all, rows->count);
    for (size_t k = 0; k < rows->count; k++)
        peak = fmax(peak, rows->y[k]);
    for (size_t k = 0; k + TAPS <= rows->count; k++) {
        double difference = 0, variance = 0, lowest = INFINITY;
        for (size_t j = 0; j < TAPS; j++) {
            const double p = rows->y[k + j];
            const double jacobian = mf_bonded_distribution_jacobian(order, dimensions, bins, k + j);
            lowest = fmin(lowest, p);
            difference += taps[j] * log(p / jacobian);
            variance += taps[j] * taps[j] / p;
        }
        if (lowest > min * peak)
            all[count++] = difference * difference / variance;
    }
    if (count >= MIN_DIFFERENCES)
        *square = mf_target_rows_robust_mean(all, count);
    return STATUS_OK;
}

/// Errors that a file gives are the scatter of counts, which is 0 where nothing was seen. That of
/// one count is the least of all.
static void set_errors_of_unseen(struct target_rows *rows) {
    double once = INFINITY;
    for (size_t k = 0; k < rows->count; k++)
        if (rows->y[k] > 0 && rows->error[k] > 0)
            once = fmin(once, rows->error[k]);
    for (size_t k = 0; k < rows->count && isfinite(once); k++)
        if (rows->y[k] == 0 && rows->error[k] == 0)
            rows->error[k] = once;
}

/// What was not seen has the error of what was seen once.
static enum status set_errors(struct target_bonded *target, struct target_rows *rows, int order,
                              int dimensions) {
    double square, peak = 0;
    if (rows->has_errors) {
        set_errors_of_unseen(rows);
        return STATUS_OK;
    }
    for (size_t k = 0; k < rows->count; k++)
        peak = fmax(peak, rows->y[k]);
    TRY(find_scatter(rows, order, dimensions, &target->bins, &square));
    target->assumed = !(square > 0);
    if (target->assumed)
        square = assumed_error * assumed_error * peak;
    for (size_t k = 0; k < rows->count; k++)
        rows->error[k] = sqrt(square * fmax(rows->y[k], square));
    target->estimated_error = sqrt(square / peak);
    return STATUS_OK;
}

/// Join rows to bins, if there are many. A rest at the end is dropped; of a circle there is none,
/// and rows whose number has no such divisor stay as they are.
static void join(struct target_bonded *target, struct target_rows *rows, bool circle) {
    enum { COARSEST = 2 };
    const size_t min = (rows->count + MAX_BINS - 1) / MAX_BINS;
    size_t of = min;
    while (circle && rows->count % of != 0)
        of++;
    if (of > COARSEST * min)
        of = 1;
    target->joined = of;
    target->bins.width *= (double)of;
    target->bins.count = rows->count / of;
    for (size_t n = 0; n < target->bins.count; n++) {
        double p = 0, squares = 0;
        for (size_t k = n * of; k < (n + 1) * of; k++) {
            p += rows->y[k] / (double)of;
            squares += pow(rows->error[k] / (double)of, 2);
        }
        rows->y[n] = p;
        rows->error[n] = sqrt(squares);
    }
}

static enum status load(struct target_bonded *target, int order, const char *name,
                        const struct units *units, int dimensions) {
    enum status status = STATUS_OK;
    struct target_bonded_parameters *p = &target->parameters;
    const bool circle = mf_bonded_kinds[order]->periodic;
    struct target_rows rows = {0};
    CHECK(p->format == TARGET_ROWS_VOTCA ? read_votca(p->file, order, units, &rows)
                                         : read_columns(p, order, name, units, &rows));
    CHECK(check(&rows, order, p->file));
    double width = width_of(&rows);
    if (circle)
        CHECK(close_circle(&rows, &width, p->file));
    else
        trim(&rows);
    target->bins = (struct bonded_bins){rows.x[0] - 0.5 * width, width, rows.count};
    CHECK(set_errors(target, &rows, order, dimensions));
    join(target, &rows, circle);
    target->value = rows.y;
    target->error = rows.error;
    rows.y = rows.error = NULL;
done:
    if (status != STATUS_OK)
        target->bins = (struct bonded_bins){0};
    mf_target_rows_clear(&rows);
    return status;
}

enum status mf_target_bonded_read(struct target_bonded *target, int order, const char *name,
                                  struct json_object *object, const struct units *units,
                                  int dimensions) {
    const size_t faults = mf_json_fault_count(object->document);
    *target = (struct target_bonded){0};
    mf_json_fields(object, mf_target_bonded_fields, &target->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    if (target->parameters.format == TARGET_ROWS_VOTCA && mf_bonded_kinds[order]->is_length &&
        !mf_units_known(units)) {
        mf_json_fault(object, "format",
                      "VOTCA's files are in nm: the scene needs \"units\" to convert them");
        return STATUS_OK;
    }
    return mf_target_rows_fault(object, "file", load(target, order, name, units, dimensions));
}

void mf_target_bonded_clear(struct target_bonded *target) {
    mf_memory_free(target->value);
    mf_memory_free(target->error);
    *target = (struct target_bonded){0};
}
