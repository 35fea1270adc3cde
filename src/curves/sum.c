// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/sum.h"

double mf_sum_shifted(const struct curve *curve, double r) {
    const double cutoff = mf_curve_cutoff(curve), inside = cutoff * (1 - 1e-12);
    return r >= cutoff ? 0 : mf_curve_value(curve, r) - mf_curve_value(curve, inside);
}

static double value(const void *parameters, double r) {
    const struct sum_parameters *p = parameters;
    double sum = 0;
    for (int k = 0; k < p->parts; k++)
        sum += mf_sum_shifted(&p->part[k], r);
    return sum;
}

static double cutoff(const void *parameters) {
    const struct sum_parameters *p = parameters;
    double largest = 0;
    for (int k = 0; k < p->parts; k++)
        largest = fmax(largest, mf_curve_cutoff(&p->part[k]));
    return largest;
}

static void clear(void *parameters) {
    struct sum_parameters *p = parameters;
    for (int k = 0; k < p->parts; k++)
        mf_curve_clear(&p->part[k]);
}

static const struct field fields[] = {FIELD_END};

const struct curve_family mf_sum_family = {
    .name = "sum",
    .summary = "sum of laws, each shifted to 0 at its cutoff",
    .fields = fields,
    .size = sizeof(struct sum_parameters),
    .value = value,
    .cutoff = cutoff,
    .clear = clear,
};

enum status mf_sum_tabulate(struct table *table, const struct curve *one,
                            const struct curve *other) {
    struct sum_parameters sum = {.parts = 2, .part = {*one, *other}}; // borrowed: not cleared
    return mf_table_init_potential(table, &(struct curve){&mf_sum_family, &sum});
}
