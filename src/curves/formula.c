// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/formula.h"

#include <math.h>

#define POSITIVE .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX
#define AT_LEAST_ZERO .minimum = 0, .maximum = DBL_MAX
#define ANY_NUMBER .minimum = -DBL_MAX, .maximum = DBL_MAX

static double lennard_jones_unshifted(const struct formula_lennard_jones_parameters *p, double r) {
    const double inner = 0.5 * p->sigma;
    const double x = p->sigma / fmax(r, inner);
    const double x6 = x * x * x * x * x * x;
    double phi = 4 * p->epsilon * x6 * (x6 - 1);
    if (r < inner)
        phi += 24 * p->epsilon * x6 * (2 * x6 - 1) / inner * (inner - r);
    return phi;
}

static double lennard_jones_value(const void *parameters, double r) {
    const struct formula_lennard_jones_parameters *p = parameters;
    return r >= p->cutoff ? 0
                          : lennard_jones_unshifted(p, r) - lennard_jones_unshifted(p, p->cutoff);
}

static double lennard_jones_cutoff(const void *parameters) {
    return ((const struct formula_lennard_jones_parameters *)parameters)->cutoff;
}

#define LJ(member) .offset = offsetof(struct formula_lennard_jones_parameters, member)
static const struct field lennard_jones_fields[] = {
    {"epsilon", FIELD_NUMBER, LJ(epsilon), .initial = 1, AT_LEAST_ZERO, .unit = "k_B T_0",
     .help = "depth of the well"},
    {"sigma", FIELD_NUMBER, LJ(sigma), .initial = 1, POSITIVE, .unit = "lambda",
     .help = "distance at which the unshifted potential is 0"},
    {"cutoff", FIELD_NUMBER, LJ(cutoff), .initial = 2.5, POSITIVE, .unit = "lambda",
     .help = "it is 0 beyond"},
    FIELD_END,
};

const struct curve_family mf_formula_lennard_jones = {
    .name = "lennard-jones",
    .summary = "4 epsilon [(sigma/r)^12 - (sigma/r)^6], shifted to 0 at the cutoff",
    .fields = lennard_jones_fields,
    .size = sizeof(struct formula_lennard_jones_parameters),
    .value = lennard_jones_value,
    .cutoff = lennard_jones_cutoff,
};

static double soft_repulsion_value(const void *parameters, double r) {
    const struct formula_soft_repulsion_parameters *p = parameters;
    const double gap = fmax(0, 1 - r / p->cutoff);
    return 0.5 * p->a * p->cutoff * gap * gap;
}

static double soft_repulsion_cutoff(const void *parameters) {
    return ((const struct formula_soft_repulsion_parameters *)parameters)->cutoff;
}

#define SOFT(member) .offset = offsetof(struct formula_soft_repulsion_parameters, member)
static const struct field soft_repulsion_fields[] = {
    {"a", FIELD_NUMBER, SOFT(a), .initial = 25, ANY_NUMBER, .unit = "k_B T_0/lambda",
     .help = "largest force"},
    {"cutoff", FIELD_NUMBER, SOFT(cutoff), .initial = 1, POSITIVE, .unit = "lambda",
     .help = "it is 0 beyond"},
    FIELD_END,
};

const struct curve_family mf_formula_soft_repulsion = {
    .name = "soft-repulsion",
    .summary = "a r_c (1 - r/r_c)^2 / 2, the force a (1 - r/r_c) of Groot and Warren (1997)",
    .fields = soft_repulsion_fields,
    .size = sizeof(struct formula_soft_repulsion_parameters),
    .value = soft_repulsion_value,
    .cutoff = soft_repulsion_cutoff,
};

static double gaussian_value(const void *parameters, double r) {
    const struct formula_gaussian_parameters *p = parameters;
    if (r >= p->cutoff)
        return 0;
    const double x = r / p->sigma, x_cut = p->cutoff / p->sigma;
    return p->epsilon * (exp(-x * x) - exp(-x_cut * x_cut));
}

static double gaussian_cutoff(const void *parameters) {
    return ((const struct formula_gaussian_parameters *)parameters)->cutoff;
}

#define GAUSS(member) .offset = offsetof(struct formula_gaussian_parameters, member)
static const struct field gaussian_fields[] = {
    {"epsilon", FIELD_NUMBER, GAUSS(epsilon), .initial = 1, ANY_NUMBER, .unit = "k_B T_0",
     .help = "height at r = 0"},
    {"sigma", FIELD_NUMBER, GAUSS(sigma), .initial = 1, POSITIVE, .unit = "lambda",
     .help = "width: epsilon/e at r = sigma"},
    {"cutoff", FIELD_NUMBER, GAUSS(cutoff), .initial = 3.2, POSITIVE, .unit = "lambda",
     .help = "it is 0 beyond"},
    FIELD_END,
};

const struct curve_family mf_formula_gaussian = {
    .name = "gaussian",
    .summary = "epsilon exp(-(r/sigma)^2), shifted to 0 at the cutoff",
    .fields = gaussian_fields,
    .size = sizeof(struct formula_gaussian_parameters),
    .value = gaussian_value,
    .cutoff = gaussian_cutoff,
};

static double power_omega_value(const void *parameters, double r) {
    const struct formula_power_omega_parameters *p = parameters;
    if (r <= p->inner_cutoff || r >= p->cutoff)
        return r == 0 && p->inner_cutoff == 0 ? p->sigma : 0;
    return p->sigma * pow(1 - r / p->cutoff, p->exponent);
}

static double power_omega_cutoff(const void *parameters) {
    return ((const struct formula_power_omega_parameters *)parameters)->cutoff;
}

static enum status power_omega_check(void *parameters) {
    const struct formula_power_omega_parameters *p = parameters;
    if (p->inner_cutoff < p->cutoff)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "the inner_cutoff %g" STATUS_LENGTH
                          " is not below the cutoff %g" STATUS_LENGTH ": omega would be 0",
                          p->inner_cutoff, p->cutoff);
}

#define OMEGA(member) .offset = offsetof(struct formula_power_omega_parameters, member)
static const struct field power_omega_fields[] = {
    {"sigma", FIELD_NUMBER, OMEGA(sigma), .initial = 2.1213203435596424, AT_LEAST_ZERO,
     .unit = "sqrt(mu/tau)",
     .help = "omega extrapolated to r = 0; sigma^2 is Groot and "
             "Warren's gamma"},
    {"exponent", FIELD_NUMBER, OMEGA(exponent), .initial = 1, POSITIVE, .unit = "",
     .help = "s, the exponent"},
    {"inner_cutoff", FIELD_NUMBER, OMEGA(inner_cutoff), .initial = 0, AT_LEAST_ZERO,
     .unit = "lambda", .help = "r_0: omega is 0 at and below it"},
    {"cutoff", FIELD_NUMBER, OMEGA(cutoff), .initial = 1, POSITIVE, .unit = "lambda",
     .help = "r_c: omega is 0 beyond it"},
    FIELD_END,
};

const struct curve_family mf_formula_power_omega = {
    .name = "power",
    .summary = "omega = sigma (1 - r/r_c)^s for r_0 < r <= r_c, else 0; omega^2 is the friction",
    .fields = power_omega_fields,
    .size = sizeof(struct formula_power_omega_parameters),
    .value = power_omega_value,
    .cutoff = power_omega_cutoff,
    .check = power_omega_check,
};
