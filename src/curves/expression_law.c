// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/expression_law.h"

#include "curves/expression_text.h"
#include "curves/table.h"

#include <math.h>

static double cutoff(const void *parameters) {
    return ((const struct expression_parameters *)parameters)->cutoff;
}

static double length_of(const struct expression_parameters *p) {
    return p->length > 0 ? p->length : 1;
}

/// Value of the formula at r, and, unless it is NULL, its slope.
static double formula(const struct expression_parameters *p, double r, double *slope) {
    const double unit = p->unit > 0 ? p->unit : 1, length = length_of(p);
    const double value = mf_expression_value(&p->expression, length * r, slope) / unit;
    if (slope)
        *slope *= length / unit;
    return value;
}

static void scale(void *parameters, double length, double unit) {
    struct expression_parameters *p = parameters;
    p->length = length;
    p->unit = unit;
}

/// The formula is finite from the inner cutoff to the cutoff, in each interval of a table.
static enum status check_range(const struct expression_parameters *p, const char *advice) {
    double where;
    const double low = length_of(p) * p->inner_cutoff, high = length_of(p) * p->cutoff;
    if (low >= high)
        return mf_status_fail(STATUS_BAD_INPUT, "the inner_cutoff %g is not below the cutoff %g",
                              low, high);
    if (mf_expression_is_finite(&p->expression, low, high, TABLE_INTERVALS, &where))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "the formula \"%s\" divides by 0, or is no number, near r = %.4g%s",
                          p->formula, where, where == low ? advice : "");
}

static enum status check_potential(void *parameters) {
    struct expression_parameters *p = parameters;
    TRY(mf_expression_parse(&p->expression, p->formula));
    TRY(check_range(p, ": below \"inner_cutoff\" the potential would be a straight line"));
    p->shift = formula(p, p->cutoff, NULL);
    p->inner_value = formula(p, p->inner_cutoff, &p->inner_slope);
    if (!isfinite(p->inner_value) || !isfinite(p->inner_slope) || !isfinite(p->shift))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the formula \"%s\" has no finite value and slope at r = %.4g",
                              p->formula, length_of(p) * p->inner_cutoff);
    return STATUS_OK;
}

static enum status check_omega(void *parameters) {
    struct expression_parameters *p = parameters;
    TRY(mf_expression_parse(&p->expression, p->formula));
    TRY(check_range(p, ": below \"inner_cutoff\" omega would be 0"));
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        const double r = p->inner_cutoff + (p->cutoff - p->inner_cutoff) * k / TABLE_INTERVALS;
        if (formula(p, r, NULL) < 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "the formula \"%s\" is negative at r = %.4g: omega is not",
                                  p->formula, length_of(p) * r);
    }
    return STATUS_OK;
}

static double potential_value(const void *parameters, double r) {
    const struct expression_parameters *p = parameters;
    if (r >= p->cutoff)
        return 0;
    if (r < p->inner_cutoff)
        return p->inner_value - p->shift + p->inner_slope * (r - p->inner_cutoff);
    return formula(p, r, NULL) - p->shift;
}

static double omega_value(const void *parameters, double r) {
    const struct expression_parameters *p = parameters;
    const bool inside = r > p->inner_cutoff || (r == 0 && p->inner_cutoff == 0);
    return inside && r < p->cutoff ? formula(p, r, NULL) : 0;
}

#define MEMBER(name) .offset = offsetof(struct expression_parameters, name)
#define FIELDS(inner_help, cutoff_help)                                                            \
    {                                                                                              \
        {"formula",                                                                                \
         FIELD_TEXT,                                                                               \
         MEMBER(formula),                                                                          \
         .required = true,                                                                         \
         .unit = "",                                                                               \
         .help = "with +-*/^ exp,sqrt,log,tanh,erf,min,max, as 4*(1/r^12 - 1/r^6), in units "      \
                 "of the"                                                                          \
                 " file"},                                                                         \
            {"inner_cutoff", FIELD_NUMBER,       MEMBER(inner_cutoff), .initial = 0,               \
             .minimum = 0,   .maximum = DBL_MAX, .unit = "lambda",     .help = inner_help},        \
            {"cutoff",                                                                             \
             FIELD_NUMBER,                                                                         \
             MEMBER(cutoff),                                                                       \
             .initial = 1,                                                                         \
             .minimum = FIELD_ABOVE_ZERO,                                                          \
             .maximum = DBL_MAX,                                                                   \
             .unit = "lambda",                                                                     \
             .help = cutoff_help},                                                                 \
            FIELD_END,                                                                             \
    }

static const struct field potential_fields[] =
    FIELDS("r below which the potential is a straight line", "it is 0 beyond");

static const struct field omega_fields[] =
    FIELDS("r_0: omega is 0 at and below it", "r_c: omega is 0 beyond it");

const struct curve_family mf_expression_potential = {
    .name = "expression",
    .summary = "a formula of r, shifted to 0 at the cutoff",
    .fields = potential_fields,
    .size = sizeof(struct expression_parameters),
    .value = potential_value,
    .cutoff = cutoff,
    .check = check_potential,
    .scale = scale,
};

const struct curve_family mf_expression_omega = {
    .name = "expression",
    .summary = "omega as a formula of r for r_0 < r <= r_c, else 0",
    .fields = omega_fields,
    .size = sizeof(struct expression_parameters),
    .value = omega_value,
    .cutoff = cutoff,
    .check = check_omega,
    .scale = scale,
};
