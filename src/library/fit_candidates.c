// SPDX-License-Identifier: GPL-3.0-or-later
//
// Single candidates of a fit, for optimisers of the caller's own.
#include "library/fit.h"
#include "library/guard.h"
#include "matching/population.h"

#include <math.h>

size_t mesofit_fit_coefficients(const struct mesofit_fit *fit) {
    return fit->parametrisation.variables;
}

/// An inversion has no coefficients.
static enum status check_kind(const struct mesofit_fit *fit) {
    const struct inverse_method *method = fit->file.method;
    return method->kind == INVERSE_MATCHING
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "the method \"%s\" does not measure candidates",
                                method->name);
}

static enum status start(const struct mesofit_fit *fit, double *coefficients) {
    TRY(check_kind(fit));
    return mf_parametrisation_start(&fit->parametrisation, coefficients);
}

enum mesofit_status mesofit_fit_start(const struct mesofit_fit *fit, double *coefficients) {
    mf_guard_enter();
    return mf_guard_return(start(fit, coefficients));
}

static enum status evaluate(const struct mesofit_fit *fit, const double *coefficients,
                            uint64_t seed, double *error, double *variance) {
    enum status status = STATUS_OK;
    struct unknowns_laws laws = {0};
    struct evaluate_result result;
    TRY(check_kind(fit));
    const struct population_parameters *population = fit->file.method_parameters;
    CHECK(mf_parametrisation_laws(&fit->parametrisation, coefficients, &laws));
    const struct evaluate_candidate candidate = {.potential = laws.table[UNKNOWN_POTENTIAL],
                                                 .omega = laws.table[UNKNOWN_OMEGA],
                                                 .discard_above = HUGE_VAL,
                                                 .threads = 1,
                                                 .seed = seed};
    status =
        mf_evaluate(&laws.problem, &candidate, &population->evaluate, NULL, NULL, NULL, &result);
    *error = status == STATUS_OK ? result.error : HUGE_VAL;
    if (variance)
        *variance = status == STATUS_OK ? result.variance : 0;
    if (status == STATUS_UNSTABLE)
        status = STATUS_OK;
done:
    mf_unknowns_laws_clear(&laws);
    return status;
}

enum mesofit_status mesofit_fit_evaluate(const struct mesofit_fit *fit, const double *coefficients,
                                         uint64_t seed, double *error, double *variance) {
    mf_guard_enter();
    return mf_guard_return(evaluate(fit, coefficients, seed, error, variance));
}
