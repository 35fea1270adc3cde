// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/curve.h"

#include "base/memory.h"
#include "curves/formula.h"
#include "curves/sampled.h"

#include <string.h>

const struct curve_family *const curve_potentials[] = {
    &formula_lennard_jones, &formula_soft_repulsion, &formula_gaussian, &sampled_family, NULL,
};

const struct curve_family *const curve_weights[] = {
    &formula_power_weight,
    &sampled_family,
    NULL,
};

const struct curve_family *curve_find(const struct curve_family *const *list, const char *name) {
    for (; *list; list++)
        if (strcmp((*list)->name, name) == 0)
            return *list;
    return NULL;
}

enum status curve_create(struct curve *curve, const struct curve_family *family) {
    *curve = (struct curve){.family = family, .parameters = memory_zeroed(1, family->size)};
    if (curve->parameters == NULL)
        return STATUS_NO_MEMORY;
    fields_set_defaults(family->fields, curve->parameters);
    return STATUS_OK;
}

void curve_clear(struct curve *curve) {
    if (curve->parameters && curve->family->clear)
        curve->family->clear(curve->parameters);
    memory_free(curve->parameters);
    *curve = (struct curve){0};
}

double curve_value(const struct curve *curve, double r) {
    return curve->family->value(curve->parameters, r);
}

double curve_cutoff(const struct curve *curve) {
    return curve->family->cutoff(curve->parameters);
}
