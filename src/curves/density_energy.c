// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/density_energy.h"

#include "curves/expression_text.h"
#include "curves/sampled.h"
#include "curves/weight.h"

#include <math.h>

const struct curve_family *const mf_density_energy_laws[] = {
    &mf_density_energy_polynomial,
    &mf_density_energy_many_body_dpd,
    &mf_density_energy_expression,
    &mf_density_energy_table,
    NULL,
};

#define ANY_NUMBER .minimum = -DBL_MAX, .maximum = DBL_MAX

/// In which units a law was written: its densities are ρ times `density`, its values f times
/// `unit`; 0: 1.
struct scales {
    double density, unit;
};

static double or_one(double scale) {
    return scale > 0 ? scale : 1;
}

// Polynomials -------------------------------------------------------------------------------------

struct polynomial {
    double term[DENSITY_ENERGY_TERMS], origin;
    struct scales scales;
};

static void polynomial_scale(void *parameters, double density, double unit) {
    ((struct polynomial *)parameters)->scales = (struct scales){density, unit};
}

/// The coefficients of powers of ρ in reduced units: those of (ρ − ρ_o)^n by Pascal's triangle.
static void polynomial_terms(const struct polynomial *p, double term[DENSITY_ENERGY_TERMS]) {
    for (int k = 0; k < DENSITY_ENERGY_TERMS; k++) {
        double sum = 0, choose = 1; // n over k
        for (int n = k; n < DENSITY_ENERGY_TERMS; n++) {
            sum += choose * p->term[n] * pow(-p->origin, n - k);
            choose *= (n + 2) / (double)(n + 1 - k);
        }
        term[k] = sum * pow(or_one(p->scales.density), k + 1) / or_one(p->scales.unit);
    }
}

static double polynomial_sum(const double term[DENSITY_ENERGY_TERMS], double x, double *slope) {
    double value = 0, derivative = 0;
    for (int n = DENSITY_ENERGY_TERMS - 1; n >= 0; n--) {
        derivative = derivative * x + (n + 1) * term[n];
        value = (value + term[n]) * x;
    }
    if (slope)
        *slope = derivative;
    return value;
}

static double polynomial_value(const void *parameters, double x) {
    double term[DENSITY_ENERGY_TERMS];
    polynomial_terms(parameters, term);
    return polynomial_sum(term, x, NULL);
}

/// There is no end.
static double endless(const void *parameters) {
    (void)parameters;
    return INFINITY;
}

#define TERM(n, name, power)                                                                       \
    {                                                                                              \
        name, FIELD_NUMBER, offsetof(struct polynomial, term[n]), .initial = 0, ANY_NUMBER,        \
                                                                  .unit = "", .help = "of x" power \
    }
static const struct field polynomial_fields[] = {
    TERM(0, "c1", ""),
    TERM(1, "c2", "^2"),
    TERM(2, "c3", "^3"),
    TERM(3, "c4", "^4"),
    {"origin", FIELD_NUMBER, .offset = offsetof(struct polynomial, origin), .initial = 0,
     ANY_NUMBER, .unit = "", .help = "rho_o, best the mean of rho in a fit"},
    FIELD_END,
};

const struct curve_family mf_density_energy_polynomial = {
    .name = "polynomial",
    .summary = "c1 x + c2 x^2 + c3 x^3 + c4 x^4, x = rho - origin, less its value at rho = 0; in "
               "units of the file",
    .fields = polynomial_fields,
    .size = sizeof(struct polynomial),
    .value = polynomial_value,
    .cutoff = endless,
    .scale = polynomial_scale,
};

struct dpd {
    double b, cutoff; ///< in units of the file
    int dimensions;   ///< of the scene; 0: three
    struct scales scales;
};

static void dpd_scale(void *parameters, double density, double unit) {
    ((struct dpd *)parameters)->scales = (struct scales){density, unit};
}

/// f/ρ² in reduced units.
static double dpd_factor(const struct dpd *p) {
    const double factor = p->dimensions == 2 ? M_PI * p->b * pow(p->cutoff, 3) / 24
                                             : M_PI * p->b * pow(p->cutoff, 4) / 30;
    return factor * pow(or_one(p->scales.density), 2) / or_one(p->scales.unit);
}

static double dpd_value(const void *parameters, double x) {
    return dpd_factor(parameters) * x * x;
}

#define DPD(member) .offset = offsetof(struct dpd, member)
static const struct field dpd_fields[] = {
    {"b", FIELD_NUMBER, DPD(b), .required = true, ANY_NUMBER, .unit = "", .help = "B"},
    {"cutoff", FIELD_NUMBER, DPD(cutoff), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "", .help = "r_c of the weight"},
    FIELD_END,
};

const struct curve_family mf_density_energy_many_body_dpd = {
    .name = "many-body-dpd",
    .summary = "forces B (rho_i + rho_j)(1 - r/r_c), with the weight of that name",
    .fields = dpd_fields,
    .size = sizeof(struct dpd),
    .value = dpd_value,
    .cutoff = endless,
    .scale = dpd_scale,
};

enum status mf_density_energy_check_weight(const struct curve *curve, const struct curve *weight) {
    static const double rounding = 1e-9;
    if (curve->family != &mf_density_energy_many_body_dpd)
        return STATUS_OK;
    if (weight->family != &mf_weight_many_body_dpd)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the law \"many-body-dpd\" needs the weight \"many-body-dpd\", not "
                              "\"%s\": with that, take a \"polynomial\"",
                              weight->family->name);
    const struct dpd *p = curve->parameters;
    const double unit = pow(or_one(p->scales.density), p->dimensions == 2 ? 1.0 / 2 : 1.0 / 3);
    const double cutoff = mf_curve_cutoff(weight) / unit;
    if (fabs(p->cutoff - cutoff) <= rounding * cutoff)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "the cutoff %g is not that of the weight, %g: give both the same",
                          p->cutoff, cutoff);
}

// Formulas ----------------------------------------------------------------------------------------

struct formula {
    char formula[FIELD_TEXT_SIZE];
    double minimum, maximum; ///< densities of the file
    struct scales scales;
    struct expression expression; ///< once it was read
};

static void formula_scale(void *parameters, double density, double unit) {
    ((struct formula *)parameters)->scales = (struct scales){density, unit};
}

static enum status formula_check(void *parameters) {
    struct formula *p = parameters;
    double where;
    TRY(mf_expression_parse_of(&p->expression, p->formula, "rho"));
    if (p->minimum >= p->maximum)
        return mf_status_fail(STATUS_BAD_INPUT, "the minimum %g is not below the maximum %g",
                              p->minimum, p->maximum);
    if (mf_expression_is_finite(&p->expression, p->minimum, p->maximum, TABLE_INTERVALS, &where))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "the formula \"%s\" divides by 0, or is no number, near rho = %.4g: give "
                          "a \"minimum\" and a \"maximum\" between which it is one",
                          p->formula, where);
}

static double formula_value(const void *parameters, double x) {
    const struct formula *p = parameters;
    return mf_expression_value(&p->expression, or_one(p->scales.density) * x, NULL) /
           or_one(p->scales.unit);
}

static double formula_end(const void *parameters) {
    const struct formula *p = parameters;
    return p->maximum / or_one(p->scales.density);
}

#define FORMULA(member) .offset = offsetof(struct formula, member)
static const struct field formula_fields[] = {
    {"formula", FIELD_TEXT, FORMULA(formula), .required = true, .unit = "",
     .help = "of rho, with +-*/^ exp,sqrt,log,tanh,erf,min,max"},
    {"minimum", FIELD_NUMBER, FORMULA(minimum), .initial = 0, ANY_NUMBER, .unit = "",
     .help = "rho below which it is a straight line"},
    {"maximum", FIELD_NUMBER, FORMULA(maximum), .required = true, ANY_NUMBER, .unit = "",
     .help = "rho beyond which it is a straight line"},
    FIELD_END,
};

const struct curve_family mf_density_energy_expression = {
    .name = "expression",
    .summary = "a formula of rho",
    .fields = formula_fields,
    .size = sizeof(struct formula),
    .value = formula_value,
    .cutoff = formula_end,
    .check = formula_check,
    .scale = formula_scale,
};

// Tables ------------------------------------------------------------------------------------------

static const struct field table_fields[] = {
    {"file", FIELD_FILE, .offset = offsetof(struct sampled_parameters, file), .required = true,
     .unit = "", .help = "columns rho, f"},
    FIELD_END,
};

static double table_value(const void *parameters, double x) {
    const struct sampled_parameters *p = parameters;
    const size_t last = p->spline->size - 1;
    const double low = p->spline->x[0], high = p->spline->x[last];
    return gsl_spline_eval(p->spline, fmin(high, fmax(low, x)), NULL);
}

static double table_end(const void *parameters) {
    const struct sampled_parameters *p = parameters;
    return p->spline->x[p->spline->size - 1];
}

static void table_clear(void *parameters) {
    gsl_spline_free(((struct sampled_parameters *)parameters)->spline);
}

const struct curve_family mf_density_energy_table = {
    .name = "table",
    .summary = "cubic spline through points, straight lines beyond",
    .fields = table_fields,
    .size = sizeof(struct sampled_parameters),
    .value = table_value,
    .cutoff = table_end,
    .clear = table_clear,
};

enum status mf_density_energy_set_points(struct curve *curve, const double *density,
                                         const double *energy, size_t count) {
    return mf_sampled_set_points(curve, density, energy, count);
}

const char *mf_density_energy_file(const struct curve *curve) {
    return ((const struct sampled_parameters *)curve->parameters)->file;
}

// What simulations evaluate -----------------------------------------------------------------------

void mf_density_energy_set_dimensions(const struct curve *curve, int dimensions) {
    if (curve->family == &mf_density_energy_many_body_dpd)
        ((struct dpd *)curve->parameters)->dimensions = dimensions;
}

/// A law from some density on.
struct rest {
    const struct curve *curve;
    double low;
};

static double rest_value(const void *parameters, double x) {
    const struct rest *rest = parameters;
    return mf_curve_value(rest->curve, rest->low + x);
}

static double rest_end(const void *parameters) {
    const struct rest *rest = parameters;
    return mf_curve_cutoff(rest->curve) - rest->low;
}

static double low_of(const struct curve *curve) {
    if (curve->family == &mf_density_energy_table)
        return ((const struct sampled_parameters *)curve->parameters)->spline->x[0];
    const struct formula *p = curve->parameters;
    return p->minimum / or_one(p->scales.density);
}

enum status mf_density_energy_init(struct density_energy *energy, const struct curve *curve) {
    static const struct curve_family family = {.value = rest_value, .cutoff = rest_end};
    *energy = (struct density_energy){0};
    TRY(mf_curve_check(curve));
    if (curve->family == &mf_density_energy_polynomial)
        polynomial_terms(curve->parameters, energy->term);
    if (curve->family == &mf_density_energy_many_body_dpd)
        energy->term[1] = dpd_factor(curve->parameters);
    energy->tabulated = isfinite(mf_curve_cutoff(curve));
    if (!energy->tabulated)
        return STATUS_OK;
    energy->low = low_of(curve);
    energy->high = mf_curve_cutoff(curve);
    energy->shift = mf_curve_value(curve, energy->high);
    struct rest rest = {curve, energy->low};
    TRY(mf_table_init_potential(&energy->table, &(struct curve){&family, &rest}));
    const double *first = energy->table.coefficient;
    const double *last = first + (ptrdiff_t)4 * (TABLE_INTERVALS - 1);
    energy->slope_at_low = energy->table.inverse_spacing * first[1];
    energy->slope_at_high = energy->table.inverse_spacing * (last[1] + 2 * last[2] + 3 * last[3]);
    return STATUS_OK;
}

void mf_density_energy_clear(struct density_energy *energy) {
    mf_table_clear(&energy->table);
    *energy = (struct density_energy){0};
}

bool mf_density_energy_is_zero(const struct density_energy *energy) {
    bool zero = !energy->tabulated;
    for (int n = 0; n < DENSITY_ENERGY_TERMS; n++)
        zero = zero && energy->term[n] == 0;
    return zero;
}

double mf_density_energy_value(const struct density_energy *energy, double density, double *slope) {
    double value;
    if (!energy->tabulated)
        return polynomial_sum(energy->term, density, slope);
    if (density >= energy->high) {
        *slope = energy->slope_at_high;
        return energy->shift + energy->slope_at_high * (density - energy->high);
    }
    const double x = fmax(0, density - energy->low);
    mf_table_evaluate(&energy->table, x, &value, slope, NULL);
    return energy->shift + value + energy->slope_at_low * fmin(0, density - energy->low);
}
