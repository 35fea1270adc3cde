// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/weight.h"

#include "curves/expression_law.h"
#include "curves/sampled.h"

#include <math.h>

const struct curve_family *const mf_weight_laws[] = {
    &mf_weight_sanyal_shell,  &mf_weight_lucy,           &mf_weight_many_body_dpd,
    &mf_expression_potential, &mf_sampled_weight_family, NULL,
};

static double cutoff_of(const void *parameters) {
    return ((const struct weight_parameters *)parameters)->cutoff;
}

static double sanyal_shell_value(const void *parameters, double r) {
    const struct weight_parameters *p = parameters;
    return weight_sanyal_shell(r * r, p->inner_cutoff * p->inner_cutoff, p->cutoff * p->cutoff);
}

static double lucy_value(const void *parameters, double r) {
    const struct weight_parameters *p = parameters;
    const double q = fmin(1, r / p->cutoff), gap = 1 - q;
    const double norm =
        p->dimensions == 2 ? 5 / (M_PI * pow(p->cutoff, 2)) : 105 / (16 * M_PI * pow(p->cutoff, 3));
    return norm * (1 + 3 * q) * gap * gap * gap;
}

static double many_body_dpd_value(const void *parameters, double r) {
    const struct weight_parameters *p = parameters;
    const double gap = fmax(0, 1 - r / p->cutoff);
    const double norm =
        p->dimensions == 2 ? 6 / (M_PI * pow(p->cutoff, 2)) : 15 / (2 * M_PI * pow(p->cutoff, 3));
    return norm * gap * gap;
}

static enum status sanyal_shell_check(void *parameters) {
    const struct weight_parameters *p = parameters;
    if (p->inner_cutoff < p->cutoff)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "the inner_cutoff %g" STATUS_LENGTH
                          " is not below the cutoff %g" STATUS_LENGTH ": the weight would jump",
                          p->inner_cutoff, p->cutoff);
}

#define MEMBER(name) .offset = offsetof(struct weight_parameters, name)
#define CUTOFF                                                                                     \
    {                                                                                              \
        "cutoff", FIELD_NUMBER, MEMBER(cutoff), .required = true, .minimum = FIELD_ABOVE_ZERO,     \
                                                .maximum = DBL_MAX, .unit = "lambda",              \
                                                .help = "r_c: w is 0 beyond it"                    \
    }
static const struct field sanyal_shell_fields[] = {
    {"inner_cutoff", FIELD_NUMBER, MEMBER(inner_cutoff), .initial = 0, .minimum = 0,
     .maximum = DBL_MAX, .unit = "lambda", .help = "r_0: w is 1 below it"},
    CUTOFF,
    FIELD_END,
};
static const struct field fields[] = {CUTOFF, FIELD_END};

const struct curve_family mf_weight_sanyal_shell = {
    .name = "sanyal-shell",
    .summary = "1 - 3x^2 + 2x^3, x = (r^2 - r_0^2)/(r_c^2 - r_0^2); Sanyal and Shell",
    .fields = sanyal_shell_fields,
    .size = sizeof(struct weight_parameters),
    .value = sanyal_shell_value,
    .cutoff = cutoff_of,
    .check = sanyal_shell_check,
};

const struct curve_family mf_weight_lucy = {
    .name = "lucy",
    .summary = "(1 + 3r/r_c)(1 - r/r_c)^3, normalised",
    .fields = fields,
    .size = sizeof(struct weight_parameters),
    .value = lucy_value,
    .cutoff = cutoff_of,
};

const struct curve_family mf_weight_many_body_dpd = {
    .name = "many-body-dpd",
    .summary = "(1 - r/r_c)^2, normalised",
    .fields = fields,
    .size = sizeof(struct weight_parameters),
    .value = many_body_dpd_value,
    .cutoff = cutoff_of,
};

static bool is_closed(const struct curve_family *family) {
    return family == &mf_weight_sanyal_shell || family == &mf_weight_lucy ||
           family == &mf_weight_many_body_dpd;
}

void mf_weight_set_dimensions(const struct curve *curve, int dimensions) {
    if (is_closed(curve->family))
        ((struct weight_parameters *)curve->parameters)->dimensions = dimensions;
}

bool mf_weight_is_normalised(const struct curve *curve) {
    return curve->family == &mf_weight_lucy || curve->family == &mf_weight_many_body_dpd;
}

// Table -------------------------------------------------------------------------------------------

/// A curve from some distance on.
struct rest {
    const struct curve *curve;
    double inner;
};

static double rest_value(const void *parameters, double x) {
    const struct rest *rest = parameters;
    return mf_curve_value(rest->curve, rest->inner + x);
}

static double rest_cutoff(const void *parameters) {
    const struct rest *rest = parameters;
    return mf_curve_cutoff(rest->curve) - rest->inner;
}

enum status mf_weight_tabulate(struct weight_table *weight, const struct curve *curve) {
    static const struct curve_family family = {.value = rest_value, .cutoff = rest_cutoff};
    TRY(mf_curve_check(curve));
    weight->inner = curve->family == &mf_weight_sanyal_shell
                        ? ((const struct weight_parameters *)curve->parameters)->inner_cutoff
                        : 0;
    struct rest rest = {curve, weight->inner};
    TRY(mf_table_init_potential(&weight->table, &(struct curve){&family, &rest}));
    for (int k = 0; k < 4 * TABLE_INTERVALS; k++)
        if (weight->table.coefficient[k] != 0)
            return STATUS_OK;
    mf_weight_clear(weight);
    return mf_status_fail(STATUS_BAD_INPUT, "the weight is 0 at all distances: it has no range");
}

void mf_weight_clear(struct weight_table *weight) {
    mf_table_clear(&weight->table);
    *weight = (struct weight_table){0};
}

void mf_weight_evaluate(const struct weight_table *weight, double r, double *value, double *slope) {
    mf_table_evaluate(&weight->table, fmax(0, r - weight->inner), value, slope, NULL);
}
