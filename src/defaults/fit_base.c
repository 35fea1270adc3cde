// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_unknowns.h"

#include "base/memory.h"
#include "inversion/inversion.h"
#include "problem/unknowns.h"

#include <math.h>

/// BASE_AUTO as far as the file says it: the start, or else what is found in the target.
static enum unknown_base base_of(const struct fit_unknown *unknown) {
    if (unknown->parameters.base == BASE_AUTO && unknown->start.curves > 0)
        return BASE_START;
    return (enum unknown_base)unknown->parameters.base;
}

void mf_fit_base_check(struct fit_unknown *unknown, struct json_object *object) {
    struct unknown_parameters *p = &unknown->parameters;
    if (p->base == BASE_AUTO && !fit_unknown_says(unknown, "base") &&
        (fit_unknown_says(unknown, "minimum") || fit_unknown_says(unknown, "maximum")))
        p->base = BASE_NONE;
    const enum unknown_base base = base_of(unknown);
    if (isnan(p->minimum))
        p->minimum = base == BASE_NONE ? 0 : -p->maximum;
    if (base != BASE_NONE && p->shape == INVERSE_CURVE_POWER)
        mf_json_fault(object, "base", "the curve \"power\" takes no base");
    else if (base != BASE_NONE && p->minimum >= 0)
        mf_json_fault(object, "minimum",
                      "%g: coefficients are added to the base and must be free to fall below 0; "
                      "with \"base\": \"none\" they make the curve alone",
                      p->minimum);
    else if (base == BASE_START && unknown->start.curves == 0)
        mf_json_fault(object, "base", "\"start\" needs a start");
}

/// The hypernetted chain's. Of a target that ends before its oscillations do it is far off and puts
/// the liquid under tension; and some targets have none. There `auto` takes −k_B T ln g.
static enum status fill_hnc(const struct inverse_problem *problem, const struct unknowns *unknowns,
                            bool even_under_tension, double *curve) {
    double pressure;
    const enum status status = mf_inversion_start_curve(problem, curve, &pressure);
    if (even_under_tension || status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK || pressure < 0)
        mf_potential_grid_start_pairs(&unknowns->potential, problem, curve);
    return STATUS_OK;
}

/// The base of an unknown; what is made of the target, whatever start there is. The hypernetted
/// chain knows no bonds.
static enum status fill_base(const struct fit_file *fit, const struct unknowns *unknowns,
                             enum unknown_kind kind, double *curve) {
    struct inverse_problem without = fit->problem;
    const enum unknown_base base = base_of(&fit->unknown[kind]);
    const bool joined = scene_has_molecules(&fit->scene.molecules);
    for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
        without.unknown[UNKNOWN_POTENTIAL].start[pair] = NULL;
    if (base == BASE_START)
        mf_unknowns_start(unknowns, kind, curve);
    else if (base == BASE_MEAN_FORCE || (base == BASE_AUTO && joined))
        mf_potential_grid_start_pairs(&unknowns->potential, &without, curve);
    else if (joined)
        return mf_status_fail(STATUS_BAD_INPUT, "unknowns.potential.base: the hypernetted chain is "
                                                "not for molecules; use \"mean-force\"");
    else if (base == BASE_HNC && fit->problem.scene.box.dimensions != 3)
        return mf_status_fail(STATUS_BAD_INPUT, "unknowns.potential.base: the hypernetted chain is "
                                                "for three dimensions; use \"mean-force\"");
    else
        return fill_hnc(&without, unknowns, base == BASE_HNC, curve);
    return STATUS_OK;
}

enum status mf_fit_base_find(struct fit_file *fit) {
    CLEARED_BY(mf_unknowns_clear) struct unknowns unknowns = {0};
    if (fit->method->kind != INVERSE_MATCHING)
        return STATUS_OK;
    TRY(mf_unknowns_init(&unknowns, &fit->problem));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        struct fit_unknown *unknown = &fit->unknown[kind];
        if (!unknown->wanted || kind == UNKNOWN_BONDED || base_of(unknown) == BASE_NONE)
            continue;
        TRY_ARRAY(unknown->base, mf_unknowns_points(&unknowns, kind));
        TRY(fill_base(fit, &unknowns, kind, unknown->base));
        fit->problem.unknown[kind].base = unknown->base;
    }
    return STATUS_OK;
}
