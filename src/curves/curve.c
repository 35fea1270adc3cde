// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/curve.h"

#include "base/memory.h"
#include "base/names.h"
#include "curves/expression_law.h"
#include "curves/formula.h"
#include "curves/sampled.h"
#include "curves/sum.h"

const struct curve_family *const mf_curve_potentials[] = {
    &mf_formula_lennard_jones,
    &mf_formula_soft_repulsion,
    &mf_formula_gaussian,
    &mf_expression_potential,
    &mf_sampled_family,
    &mf_sum_family,
    NULL,
};

const struct curve_family *const mf_curve_omegas[] = {
    &mf_formula_power_omega,
    &mf_expression_omega,
    &mf_sampled_omega_family,
    NULL,
};

NAMED_RECORD(struct curve_family);

const struct curve_family *mf_curve_find(const struct curve_family *const *list, const char *name) {
    return mf_names_find(list, name);
}

enum status mf_curve_create(struct curve *curve, const struct curve_family *family) {
    *curve = (struct curve){.family = family, .parameters = mf_memory_zeroed(1, family->size)};
    if (curve->parameters == NULL)
        return STATUS_NO_MEMORY;
    mf_fields_set_defaults(family->fields, curve->parameters);
    return STATUS_OK;
}

void mf_curve_scale(const struct curve *curve, double length, double unit) {
    if (curve->family->scale)
        curve->family->scale(curve->parameters, length, unit);
}

enum status mf_curve_check(const struct curve *curve) {
    return curve->family->check ? curve->family->check(curve->parameters) : STATUS_OK;
}

void mf_curve_clear(struct curve *curve) {
    if (curve->parameters && curve->family->clear)
        curve->family->clear(curve->parameters);
    mf_memory_free(curve->parameters);
    *curve = (struct curve){0};
}

double mf_curve_value(const struct curve *curve, double r) {
    return curve->family->value(curve->parameters, r);
}

double mf_curve_cutoff(const struct curve *curve) {
    return curve->family->cutoff(curve->parameters);
}
