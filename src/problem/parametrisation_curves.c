// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation.h"

#include "base/memory.h"

#include <math.h>

enum status mf_parametrisation_curves_init(const struct parametrisation *parametrisation,
                                           struct parametrisation_curves *curves) {
    *curves = (struct parametrisation_curves){0};
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        curves->parameter[k].error = NAN;
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        curves->number[n].error = NAN;
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t points = mf_unknowns_points(&parametrisation->unknowns, kind);
        if (points == 0)
            continue;
        TRY_ARRAY(curves->value[kind], points);
        TRY_ARRAY(curves->error[kind], points);
        TRY_ARRAY(curves->flat[kind], INVERSE_FLAT * points);
    }
    return STATUS_OK;
}

void mf_parametrisation_curves_clear(struct parametrisation_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        mf_memory_free(curves->value[kind]);
        mf_memory_free(curves->error[kind]);
        mf_memory_free(curves->flat[kind]);
    }
    *curves = (struct parametrisation_curves){0};
}

void mf_parametrisation_curves_show(const struct parametrisation *parametrisation,
                                    const double *variables, struct parametrisation_curves *curves,
                                    struct inverse_step *step) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (curves->value[kind] == NULL)
            continue;
        mf_parametrisation_curve(parametrisation, kind, variables, curves->value[kind]);
        step->curve[kind] = curves->value[kind];
        step->curve_error[kind] = curves->error[kind];
        step->curve_flat[kind] = curves->flat[kind];
    }
    mf_parametrisation_parameters(parametrisation, variables, NULL, step->parameter);
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        step->parameter[k].error = curves->parameter[k].error;
    mf_parametrisation_numbers(parametrisation, variables, NULL, step->number);
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        step->number[n].error = curves->number[n].error;
}

enum status mf_parametrisation_curves_bands(const struct parametrisation *parametrisation,
                                            const double *variables, const double *covariance,
                                            struct parametrisation_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (curves->error[kind])
            TRY(mf_parametrisation_band(parametrisation, kind, variables, covariance,
                                        curves->error[kind], curves->flat[kind]));
    mf_parametrisation_parameters(parametrisation, variables, covariance, curves->parameter);
    mf_parametrisation_numbers(parametrisation, variables, covariance, curves->number);
    return STATUS_OK;
}

size_t mf_parametrisation_curves_spans(const struct parametrisation *parametrisation,
                                       struct parametrisation_curves *curves,
                                       struct memory_span *spans) {
    size_t n = 0;
    spans[n++] = (struct memory_span){curves->parameter, sizeof curves->parameter};
    spans[n++] = (struct memory_span){curves->number, sizeof curves->number};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t bytes = mf_unknowns_points(&parametrisation->unknowns, kind) * sizeof(double);
        if (bytes == 0)
            continue;
        spans[n++] = (struct memory_span){curves->error[kind], bytes};
        spans[n++] = (struct memory_span){curves->flat[kind], INVERSE_FLAT * bytes};
    }
    return n;
}
