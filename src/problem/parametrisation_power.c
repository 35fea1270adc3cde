// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation_power.h"

#include "curves/formula.h"

#include <math.h>

static const struct unknown *unknown_of(const struct parametrisation *parametrisation) {
    return &parametrisation->unknowns.problem->unknown[UNKNOWN_OMEGA];
}

/// Largest exponent of the formula, and how much of the way to the cutoff r_0 may go.
static const double largest_exponent = 4, inner_part = 0.5;

/// What a parameter of the formula is where its variable is 0, and how much more where it is 1.
struct span {
    double min, range;
};

static struct span parameter_span(const struct unknown_parameters *p, int parameter) {
    const struct span spans[INVERSE_PARAMETERS] = {
        [INVERSE_SIGMA] = {p->minimum, p->maximum - p->minimum},
        [INVERSE_EXPONENT] = {0, largest_exponent},
        [INVERSE_INNER_CUTOFF] = {p->inner_cutoff, inner_part * (p->cutoff - p->inner_cutoff)}};
    return spans[parameter];
}

const char *mf_parametrisation_parameter_bound(const struct unknown_parameters *p, int parameter,
                                               double value) {
    static const double near = 1e-3;
    const struct span span = parameter_span(p, parameter);
    const double part = (value - span.min) / span.range;
    if (!isnan(p->fixed[parameter]))
        return NULL;
    return part < near ? "minimum" : part > 1 - near ? "maximum" : NULL;
}

void mf_parametrisation_parameters(const struct parametrisation *parametrisation,
                                   const double *variables, const double *covariance,
                                   struct inverse_parameter parameter[INVERSE_PARAMETERS]) {
    const struct unknown_parameters *p = &unknown_of(parametrisation)->parameters;
    const bool formula = unknown_of(parametrisation)->wanted &&
                         unknown_of(parametrisation)->parameters.shape == INVERSE_CURVE_POWER;
    size_t variable = parametrisation->first[UNKNOWN_OMEGA];
    for (int k = 0; k < INVERSE_PARAMETERS; k++) {
        const struct span span = parameter_span(p, k);
        parameter[k] = (struct inverse_parameter){NAN, NAN};
        if (!formula)
            continue;
        if (!isnan(p->fixed[k])) {
            parameter[k] = (struct inverse_parameter){p->fixed[k], 0};
            continue;
        }
        parameter[k].value = span.min + span.range * variables[variable];
        if (covariance)
            parameter[k].error =
                span.range * sqrt(covariance[variable * (parametrisation->variables + 1)]);
        variable++;
    }
}

void mf_parametrisation_power_curve(const struct parametrisation *parametrisation,
                                    const double *variables, double *curve) {
    struct inverse_parameter found[INVERSE_PARAMETERS];
    mf_parametrisation_parameters(parametrisation, variables, NULL, found);
    struct formula_power_omega_parameters formula = {
        .sigma = found[INVERSE_SIGMA].value,
        .exponent = found[INVERSE_EXPONENT].value,
        .inner_cutoff = found[INVERSE_INNER_CUTOFF].value,
        .cutoff = unknown_of(parametrisation)->parameters.cutoff};
    const struct curve power = {&mf_formula_power_omega, &formula};
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        curve[k] =
            fmax(0, mf_curve_value(&power, parametrisation->unknowns.omega[UNKNOWN_OMEGA].r[k]));
}

void mf_parametrisation_power_start(const struct parametrisation *parametrisation,
                                    double *variables) {
    const struct unknown *unknown = unknown_of(parametrisation);
    const struct unknown_parameters *p = &unknown->parameters;
    double value[INVERSE_PARAMETERS] = {[INVERSE_SIGMA] = 0.5 * (p->minimum + p->maximum),
                                        [INVERSE_EXPONENT] = 1,
                                        [INVERSE_INNER_CUTOFF] = p->inner_cutoff};
    if (unknown->start[0] && unknown->start[0]->family == &mf_formula_power_omega) {
        const struct formula_power_omega_parameters *start = unknown->start[0]->parameters;
        value[INVERSE_SIGMA] = start->sigma;
        value[INVERSE_EXPONENT] = start->exponent;
        value[INVERSE_INNER_CUTOFF] = start->inner_cutoff;
    }
    for (int k = 0; k < INVERSE_PARAMETERS; k++) {
        const struct span span = parameter_span(p, k);
        if (isnan(p->fixed[k]))
            *variables++ = fmin(1, fmax(0, (value[k] - span.min) / span.range));
    }
}
