// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/fit_base.h"

#include "base/memory.h"
#include "inversion/inversion.h"
#include "problem/unknowns.h"

#include <math.h>

static enum unknown_base base_of(const struct fit_unknown *unknown) {
    if (unknown->parameters.base != BASE_AUTO)
        return (enum unknown_base)unknown->parameters.base;
    return unknown->start.curves > 0 ? BASE_START : BASE_HNC;
}

void mf_fit_base_check(struct fit_unknown *unknown, enum unknown_kind kind,
                       struct json_object *object) {
    struct unknown_parameters *p = &unknown->parameters;
    const enum unknown_base base = base_of(unknown);
    if (isnan(p->minimum))
        p->minimum = base == BASE_NONE ? 0 : -p->maximum;
    if (base != BASE_NONE && p->shape == INVERSE_CURVE_POWER)
        mf_json_fault(object, "base", "the curve \"power\" stands for itself");
    else if (base != BASE_NONE && p->minimum >= 0)
        mf_json_fault(object, "minimum",
                      "%g: coefficients are added to the base and must be free to fall below 0; "
                      "with \"base\": \"none\" they make the curve alone",
                      p->minimum);
    else if (base == BASE_START && unknown->start.curves == 0 && kind == UNKNOWN_POTENTIAL)
        mf_json_fault(object, "base", "\"start\" needs a start");
}

/// The base of an unknown; that of the target whatever start there is.
static enum status fill_base(const struct fit_file *fit, const struct unknowns *unknowns,
                             enum unknown_kind kind, double *curve) {
    struct inverse_problem without = fit->problem;
    for (int pair = 0; pair < COMPOSITION_MOST_PAIRS; pair++)
        without.unknown[UNKNOWN_POTENTIAL].start[pair] = NULL;
    switch (base_of(&fit->unknown[kind])) {
    case BASE_HNC:
        return mf_inversion_start_curve(&without, curve);
    case BASE_MEAN_FORCE:
        mf_potential_grid_start(&unknowns->potential, &without, curve);
        return STATUS_OK;
    default:
        mf_unknowns_start(unknowns, kind, curve);
        return STATUS_OK;
    }
}

enum status mf_fit_base_find(struct fit_file *fit) {
    enum status status = STATUS_OK;
    struct unknowns unknowns = {0};
    if (fit->method->kind == INVERSE_INVERSION)
        return STATUS_OK;
    CHECK(mf_unknowns_init(&unknowns, &fit->problem));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        struct fit_unknown *unknown = &fit->unknown[kind];
        if (!unknown->wanted || base_of(unknown) == BASE_NONE)
            continue;
        NEW_ARRAY(unknown->base, mf_unknowns_points(&unknowns, kind));
        CHECK(fill_base(fit, &unknowns, kind, unknown->base));
        fit->problem.unknown[kind].base = unknown->base;
    }
done:
    mf_unknowns_clear(&unknowns);
    return status;
}
