// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/decoder.h"

#include "base/memory.h"

#include <math.h>

enum status mf_decoder_curves_init(const struct decoder *decoder, struct decoder_curves *curves) {
    enum status status = STATUS_OK;
    *curves = (struct decoder_curves){0};
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        curves->parameter[k].error = NAN;
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t points = mf_decoder_points(decoder, kind);
        if (points == 0)
            continue;
        NEW_ARRAY(curves->value[kind], points);
        NEW_ARRAY(curves->error[kind], points);
        NEW_ARRAY(curves->flat[kind], INVERSE_FLAT * points);
    }
done:
    return status;
}

void mf_decoder_curves_clear(struct decoder_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        mf_memory_free(curves->value[kind]);
        mf_memory_free(curves->error[kind]);
        mf_memory_free(curves->flat[kind]);
    }
    *curves = (struct decoder_curves){0};
}

void mf_decoder_curves_show(const struct decoder *decoder, const double *variables,
                            struct decoder_curves *curves, struct inverse_step *step) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (curves->value[kind] == NULL)
            continue;
        mf_decoder_curve(decoder, kind, variables, curves->value[kind]);
        step->curve[kind] = curves->value[kind];
        step->curve_error[kind] = curves->error[kind];
        step->curve_flat[kind] = curves->flat[kind];
    }
    mf_decoder_parameters(decoder, variables, NULL, step->parameter);
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        step->parameter[k].error = curves->parameter[k].error;
}

enum status mf_decoder_curves_bands(const struct decoder *decoder, const double *variables,
                                    const double *covariance, struct decoder_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (curves->error[kind])
            TRY(mf_decoder_band(decoder, kind, variables, covariance, curves->error[kind],
                                curves->flat[kind]));
    mf_decoder_parameters(decoder, variables, covariance, curves->parameter);
    return STATUS_OK;
}

size_t mf_decoder_curves_spans(const struct decoder *decoder, struct decoder_curves *curves,
                               struct memory_span *spans) {
    size_t n = 0;
    spans[n++] = (struct memory_span){curves->parameter, sizeof curves->parameter};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t bytes = mf_decoder_points(decoder, kind) * sizeof(double);
        if (bytes == 0)
            continue;
        spans[n++] = (struct memory_span){curves->error[kind], bytes};
        spans[n++] = (struct memory_span){curves->flat[kind], INVERSE_FLAT * bytes};
    }
    return n;
}
