// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/sampled.h"

static double value(const void *parameters, double r) {
    const struct sampled_parameters *p = parameters;
    if (r >= p->cutoff)
        return 0;
    const double first = p->spline->x[0];
    if (r < first)
        return p->spline->y[0] + p->first_slope * (r - first);
    return gsl_spline_eval(p->spline, r, NULL);
}

static double omega_value(const void *parameters, double r) {
    const struct sampled_parameters *p = parameters;
    const double *x = p->spline->x, *y = p->spline->y;
    if (r >= p->cutoff || r < x[0])
        return 0;
    const size_t k = gsl_interp_bsearch(x, r, 0, p->spline->size - 1);
    return y[k] + (r - x[k]) / (x[k + 1] - x[k]) * (y[k + 1] - y[k]);
}

static double cutoff(const void *parameters) {
    return ((const struct sampled_parameters *)parameters)->cutoff;
}

static void clear(void *parameters) {
    gsl_spline_free(((struct sampled_parameters *)parameters)->spline);
}

static const char *const formats[] = {"columns", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct sampled_parameters, name)
// clang-format off
#define FILE_NAME                                                                                  \
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "", .help = "columns r, value"}
#define CUTOFF                                                                                     \
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .initial = 0, .minimum = 0, .maximum = DBL_MAX,       \
     .unit = "lambda", .help = "it is 0 beyond; 0: the last r"}
// clang-format on
static const struct field fields[] = {
    FILE_NAME,
    {"format", FIELD_CHOICE, MEMBER(format), .choices = formats, .initial = SAMPLED_COLUMNS,
     .unit = "", .help = "votca: a .pot in nm and kJ/mol; the scene needs \"units\""},
    CUTOFF,
    FIELD_END,
};
static const struct field weight_fields[] = {FILE_NAME, CUTOFF, FIELD_END};

const struct curve_family mf_sampled_family = {
    .name = "table",
    .summary = "cubic spline through the points of a file",
    .fields = fields,
    .size = sizeof(struct sampled_parameters),
    .value = value,
    .cutoff = cutoff,
    .clear = clear,
};

const struct curve_family mf_sampled_omega_family = {
    .name = "table",
    .summary = "linear interpolation of the points of a file, as omega.tsv; 0 before the first",
    .fields = fields,
    .size = sizeof(struct sampled_parameters),
    .value = omega_value,
    .cutoff = cutoff,
    .clear = clear,
};

const struct curve_family mf_sampled_weight_family = {
    .name = "table",
    .summary = "cubic spline through the points of a file",
    .fields = weight_fields,
    .size = sizeof(struct sampled_parameters),
    .value = value,
    .cutoff = cutoff,
    .clear = clear,
};

enum status mf_sampled_set_points(struct curve *curve, const double *r, const double *y,
                                  size_t count) {
    struct sampled_parameters *p = curve->parameters;
    if (count < 3)
        return mf_status_fail(STATUS_BAD_INPUT, "a table needs at least 3 points, not %zu", count);
    for (size_t k = 1; k < count; k++)
        if (!(r[k] > r[k - 1]))
            return mf_status_fail(STATUS_BAD_INPUT, "r does not increase at point %zu", k + 1);
    const double last = r[count - 1];
    // One part in 10^9 forgives a cutoff that was rounded when the table was written.
    if (p->cutoff > last * (1 + 1e-9))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the table ends at r = %g" STATUS_LENGTH
                              ", before the cutoff %g" STATUS_LENGTH,
                              last, p->cutoff);
    if (p->cutoff == 0 || p->cutoff > last)
        p->cutoff = last;
    p->spline = gsl_spline_alloc(gsl_interp_cspline, count);
    if (p->spline == NULL || gsl_spline_init(p->spline, r, y, count) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no memory for a table of %zu points", count);
    p->first_slope = gsl_spline_eval_deriv(p->spline, r[0], NULL);
    return STATUS_OK;
}

enum status mf_sampled_create(struct curve *curve, const double *r, const double *y, size_t count) {
    TRY(mf_curve_create(curve, &mf_sampled_family));
    const enum status status = mf_sampled_set_points(curve, r, y, count);
    if (status != STATUS_OK)
        mf_curve_clear(curve);
    return status;
}
