// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation.h"

#include "curves/formula.h"
#include "curves/shape.h"

#include <math.h>
#include <string.h>

static const struct unknown *unknown_of(const struct parametrisation *parametrisation,
                                        enum unknown_kind kind) {
    return &parametrisation->unknowns.problem->unknown[kind];
}

static size_t variables_of_curve(const struct parametrisation *parametrisation,
                                 enum unknown_kind kind) {
    return (size_t)unknown_of(parametrisation, kind)->parameters.coefficients;
}

size_t mf_parametrisation_variables(const struct parametrisation *parametrisation,
                                    enum unknown_kind kind) {
    return unknown_of(parametrisation, kind)->wanted
               ? mf_unknowns_curve_count(&parametrisation->unknowns, kind) *
                     variables_of_curve(parametrisation, kind)
               : 0;
}

size_t mf_parametrisation_first_point(const struct parametrisation *parametrisation,
                                      enum unknown_kind kind, size_t curve) {
    return kind == UNKNOWN_POTENTIAL ? parametrisation->unknowns.potential.core[curve] : 0;
}

/// The same, but half of the way is that which the target's g(r) goes up and down.
static void add_steepness(const struct parametrisation *parametrisation, size_t curve,
                          double *place) {
    const struct potential_grid *grid = &parametrisation->unknowns.potential;
    const size_t first = grid->core[curve];
    const double *g =
        parametrisation->unknowns.problem->targets.target[TARGET_RDF].value + curve * grid->bins;
    double whole = 0, way = 0;
    for (size_t k = first + 1; k < grid->bins; k++)
        whole += fabs(g[k] - g[k - 1]);
    for (size_t k = first; k <= grid->bins; k++) {
        if (k > first && k < grid->bins)
            way += fabs(g[k] - g[k - 1]);
        place[k - first] = 0.5 * (place[k - first] + (whole > 0 ? way / whole : place[k - first]));
    }
}

void mf_parametrisation_places(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve, double *place) {
    const size_t points = mf_unknowns_part(&parametrisation->unknowns, kind, 0).points;
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, curve);
    const double *r = mf_unknowns_r(&parametrisation->unknowns, kind) + curve * points;
    for (size_t k = first; k < points; k++)
        place[k - first] = (r[k] - r[first]) / (r[points - 1] - r[first]);
    if (unknown_of(parametrisation, kind)->parameters.spacing == SPACING_STEEP)
        add_steepness(parametrisation, curve, place);
}

static bool is_formula(const struct parametrisation *parametrisation, enum unknown_kind kind) {
    return unknown_of(parametrisation, kind)->parameters.shape == INVERSE_CURVE_POWER;
}

/// Basis of one curve: its block of the whole.
static enum status fill_block(struct parametrisation *parametrisation, enum unknown_kind kind,
                              size_t curve) {
    enum status status = STATUS_OK;
    const size_t variables = mf_parametrisation_variables(parametrisation, kind),
                 own = variables_of_curve(parametrisation, kind);
    const size_t points = mf_unknowns_part(&parametrisation->unknowns, kind, 0).points;
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, curve),
                 moving = points - first;
    double *place = NULL, *block = NULL;
    NEW_ARRAY(place, moving);
    NEW_ARRAY(block, moving * own);
    mf_parametrisation_places(parametrisation, kind, curve, place);
    CHECK(mf_shape_basis(mf_shapes[unknown_of(parametrisation, kind)->parameters.shape], own, place,
                         moving, block));
    for (size_t k = 0; k < moving; k++)
        memcpy(parametrisation->basis[kind] + (curve * points + first + k) * variables +
                   curve * own,
               block + k * own, own * sizeof *block);
done:
    mf_memory_free(place);
    mf_memory_free(block);
    return status;
}

static enum status make_basis(struct parametrisation *parametrisation, enum unknown_kind kind) {
    enum status status = STATUS_OK;
    if (is_formula(parametrisation, kind))
        return STATUS_OK;
    NEW_ARRAY(parametrisation->basis[kind],
              mf_unknowns_points(&parametrisation->unknowns, kind) *
                  mf_parametrisation_variables(parametrisation, kind));
    for (size_t curve = 0; curve < mf_unknowns_curve_count(&parametrisation->unknowns, kind);
         curve++)
        CHECK(fill_block(parametrisation, kind, curve));
done:
    return status;
}

enum status mf_parametrisation_init(struct parametrisation *parametrisation,
                                    const struct inverse_problem *problem) {
    *parametrisation = (struct parametrisation){0};
    TRY(mf_unknowns_init(&parametrisation->unknowns, problem));
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        parametrisation->first[kind] = parametrisation->variables;
        parametrisation->variables += mf_parametrisation_variables(parametrisation, kind);
        if (problem->unknown[kind].wanted)
            TRY(make_basis(parametrisation, kind));
    }
    parametrisation->first_number = parametrisation->variables;
    parametrisation->variables += problem->numbers;
    return STATUS_OK;
}

void mf_parametrisation_clear(struct parametrisation *parametrisation) {
    mf_unknowns_clear(&parametrisation->unknowns);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(parametrisation->basis[kind]);
    *parametrisation = (struct parametrisation){0};
}

/// What coefficients are added to.
static double base_of(const struct parametrisation *parametrisation, enum unknown_kind kind,
                      size_t point) {
    const double *base = unknown_of(parametrisation, kind)->base;
    return base ? base[point] : 0;
}

/// The base and Σ of basis and variables, in the unknown's unit.
static void linear_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                         const double *x, double *curve) {
    const struct unknown_parameters *p = &unknown_of(parametrisation, kind)->parameters;
    const size_t count = mf_parametrisation_variables(parametrisation, kind);
    for (size_t k = 0; k < mf_unknowns_points(&parametrisation->unknowns, kind); k++) {
        const double *row = parametrisation->basis[kind] + k * count;
        double sum = base_of(parametrisation, kind, k);
        for (size_t n = 0; n < count; n++)
            sum += row[n] * (p->minimum + x[n] * (p->maximum - p->minimum));
        curve[k] = unknown_is_omega(kind) ? fmax(0, sum) : sum;
    }
}

/// Largest exponent of the formula, and how much of the way to the cutoff r_0 may go.
static const double largest_exponent = 4, inner_part = 0.5;

/// What a parameter of the formula is where its variable is 0, and how much more where it is 1.
struct span {
    double least, range;
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
    const double part = (value - span.least) / span.range;
    if (!isnan(p->fixed[parameter]))
        return NULL;
    return part < near ? "minimum" : part > 1 - near ? "maximum" : NULL;
}

void mf_parametrisation_parameters(const struct parametrisation *parametrisation,
                                   const double *variables, const double *covariance,
                                   struct inverse_parameter parameter[INVERSE_PARAMETERS]) {
    const struct unknown_parameters *p = &unknown_of(parametrisation, UNKNOWN_OMEGA)->parameters;
    const bool formula = unknown_of(parametrisation, UNKNOWN_OMEGA)->wanted &&
                         is_formula(parametrisation, UNKNOWN_OMEGA);
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
        parameter[k].value = span.least + span.range * variables[variable];
        if (covariance)
            parameter[k].error =
                span.range * sqrt(covariance[variable * (parametrisation->variables + 1)]);
        variable++;
    }
}

static void power_curve(const struct parametrisation *parametrisation, const double *variables,
                        double *curve) {
    struct inverse_parameter found[INVERSE_PARAMETERS];
    mf_parametrisation_parameters(parametrisation, variables, NULL, found);
    struct formula_power_omega_parameters formula = {
        .sigma = found[INVERSE_SIGMA].value,
        .exponent = found[INVERSE_EXPONENT].value,
        .inner_cutoff = found[INVERSE_INNER_CUTOFF].value,
        .cutoff = unknown_of(parametrisation, UNKNOWN_OMEGA)->parameters.cutoff};
    const struct curve power = {&mf_formula_power_omega, &formula};
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        curve[k] =
            fmax(0, mf_curve_value(&power, parametrisation->unknowns.omega[UNKNOWN_OMEGA].r[k]));
}

void mf_parametrisation_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                              const double *variables, double *curve) {
    if (is_formula(parametrisation, kind))
        power_curve(parametrisation, variables, curve);
    else
        linear_curve(parametrisation, kind, variables + parametrisation->first[kind], curve);
    if (kind == UNKNOWN_POTENTIAL)
        mf_potential_grid_complete(&parametrisation->unknowns.potential, curve);
}

size_t mf_parametrisation_blocks(const struct parametrisation *parametrisation, size_t *block) {
    size_t count = 0;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t first = 0; first < mf_parametrisation_variables(parametrisation, kind);
             first += variables_of_curve(parametrisation, kind))
            block[count++] = variables_of_curve(parametrisation, kind);
    for (size_t n = 0; n < parametrisation->unknowns.problem->numbers; n++)
        block[count++] = 1;
    return count;
}

void mf_parametrisation_numbers(const struct parametrisation *parametrisation,
                                const double *variables, const double *covariance,
                                struct inverse_parameter *number) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    for (size_t n = 0; n < problem->numbers; n++) {
        const size_t variable = parametrisation->first_number + n;
        const double least = problem->number[n].minimum, range = problem->number[n].maximum - least;
        number[n] = (struct inverse_parameter){least + range * variables[variable], NAN};
        if (covariance)
            number[n].error = range * sqrt(covariance[variable * (parametrisation->variables + 1)]);
    }
}

enum status mf_parametrisation_laws(const struct parametrisation *parametrisation,
                                    const double *variables, struct unknowns_laws *laws) {
    enum status status = STATUS_OK;
    double *curve[UNKNOWNS] = {NULL}, value[INVERSE_MOST_NUMBERS];
    struct inverse_parameter number[INVERSE_MOST_NUMBERS];
    *laws = (struct unknowns_laws){0};
    mf_parametrisation_numbers(parametrisation, variables, NULL, number);
    for (size_t n = 0; n < parametrisation->unknowns.problem->numbers; n++)
        value[n] = number[n].value;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_of(parametrisation, kind)->wanted) {
            NEW_ARRAY(curve[kind], mf_unknowns_points(&parametrisation->unknowns, kind));
            mf_parametrisation_curve(parametrisation, kind, variables, curve[kind]);
        }
    CHECK(mf_unknowns_laws_make(&parametrisation->unknowns, (const double *const *)curve, value,
                                laws));
done:
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(curve[kind]);
    return status;
}

/// Variables of a formula with sigma in the middle of its range, or those of the start if it is the
/// same formula.
static void start_power(const struct parametrisation *parametrisation, double *variables) {
    const struct unknown *unknown = unknown_of(parametrisation, UNKNOWN_OMEGA);
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
            *variables++ = fmin(1, fmax(0, (value[k] - span.least) / span.range));
    }
}

/// Variables of one curve nearest to `curve`, shape [points of it], which is changed.
static enum status start_of_curve(const struct parametrisation *parametrisation,
                                  enum unknown_kind kind, size_t number, double *curve,
                                  double *variables) {
    enum status status = STATUS_OK;
    const struct unknown_parameters *p = &unknown_of(parametrisation, kind)->parameters;
    const size_t count = variables_of_curve(parametrisation, kind),
                 all = mf_parametrisation_variables(parametrisation, kind);
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, number),
                 points = mf_unknowns_part(&parametrisation->unknowns, kind, 0).points;
    const double *block = parametrisation->basis[kind] + number * (points * all + count);
    double *place = NULL;
    NEW_ARRAY(place, points);
    mf_parametrisation_places(parametrisation, kind, number, place);
    // Variables that the curve leaves open stay in the middle of their range.
    const double middle = 0.5 * (p->minimum + p->maximum), range = p->maximum - p->minimum;
    for (size_t k = first; k < points; k++)
        for (size_t n = 0; n < count; n++)
            curve[k] -= middle * block[k * all + n];
    CHECK(mf_shape_fit(mf_shapes[p->shape], place, curve + first, NULL, points - first, variables,
                       count));
    for (size_t k = 0; k < count; k++)
        variables[k] = fmin(1, fmax(0, 0.5 + variables[k] / range));
done:
    mf_memory_free(place);
    return status;
}

/// What coefficients add up to where the fit begins.
static void start_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                        double *curve) {
    const struct unknown *unknown = unknown_of(parametrisation, kind);
    const size_t points = mf_unknowns_points(&parametrisation->unknowns, kind);
    if (unknown->base == NULL || mf_unknowns_has_start(&parametrisation->unknowns, kind))
        mf_unknowns_start(&parametrisation->unknowns, kind, curve);
    else
        memcpy(curve, unknown->base, points * sizeof *curve);
    for (size_t k = 0; k < points; k++)
        curve[k] -= base_of(parametrisation, kind, k);
}

static enum status start_of(const struct parametrisation *parametrisation, enum unknown_kind kind,
                            double *variables) {
    enum status status = STATUS_OK;
    double *curve = NULL;
    if (is_formula(parametrisation, kind)) {
        start_power(parametrisation, variables);
        return STATUS_OK;
    }
    NEW_ARRAY(curve, mf_unknowns_points(&parametrisation->unknowns, kind));
    start_curve(parametrisation, kind, curve);
    for (size_t n = 0; n < mf_unknowns_curve_count(&parametrisation->unknowns, kind); n++)
        CHECK(
            start_of_curve(parametrisation, kind, n,
                           curve + n * mf_unknowns_part(&parametrisation->unknowns, kind, 0).points,
                           variables + n * variables_of_curve(parametrisation, kind)));
done:
    mf_memory_free(curve);
    return status;
}

enum status mf_parametrisation_start(const struct parametrisation *parametrisation,
                                     double *variables) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_of(parametrisation, kind)->wanted)
            TRY(start_of(parametrisation, kind, variables + parametrisation->first[kind]));
    for (size_t n = 0; n < problem->numbers; n++) {
        const struct inverse_number *number = &problem->number[n];
        variables[parametrisation->first_number + n] =
            (number->start - number->minimum) / (number->maximum - number->minimum);
    }
    return STATUS_OK;
}
