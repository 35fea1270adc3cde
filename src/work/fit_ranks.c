// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_ranks.h"

#include "base/digest.h"
#include "base/simd.h"

#include <math.h>
#include <string.h>

uint64_t mf_fit_ranks_digest(const struct fit_file *fit) {
    enum { TRIED = 1000 };
    double (*const functions[])(double) = {exp, log, sin, cos, tanh, erf, cbrt};
    uint64_t digest = DIGEST_OF_NOTHING;
    const char *kernels = mf_simd_name();
    mf_digest_add(&digest, kernels, strlen(kernels));
    for (size_t f = 0; f < sizeof functions / sizeof *functions; f++)
        for (int k = 1; k <= TRIED; k++) {
            const double value = functions[f](0.0137 * k) + pow(0.0137 * k, 1.7);
            mf_digest_add(&digest, &value, sizeof value);
        }
    mf_digest_add(&digest, &fit->problem.seed, sizeof fit->problem.seed);
    mf_fit_file_digest(fit, &digest);
    return digest;
}

uint64_t mf_fit_ranks_digest_curves(const struct unknowns *unknowns, double *const *curve) {
    uint64_t digest = DIGEST_OF_NOTHING;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_digest_add(&digest, curve[kind],
                      mf_unknowns_points(unknowns, kind) * sizeof *curve[kind]);
    return digest;
}
