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

// A friction weight that is a formula -------------------------------------------------------------

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
    const struct unknown_parameters *p = &unknown_of(parametrisation, UNKNOWN_OMEGA)->parameters;
    const bool formula =
        unknown_of(parametrisation, UNKNOWN_OMEGA)->wanted &&
        unknown_of(parametrisation, UNKNOWN_OMEGA)->parameters.shape == INVERSE_CURVE_POWER;
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

/// ω at the points of the grid from all variables, shape [OMEGA_POINTS].
static void make_power(const struct parametrisation *parametrisation, const double *variables,
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
            *variables++ = fmin(1, fmax(0, (value[k] - span.min) / span.range));
    }
}

// Curves of coefficients
// ---------------------------------------------------------------------------

/// Curves of an unknown, and coefficients of one.
static size_t curves_of(const struct inverse_problem *problem, int kind) {
    return !problem->unknown[kind].wanted ? 0
           : kind == UNKNOWN_POTENTIAL ? (size_t)mf_composition_pairs(&problem->scene.composition)
           : kind == UNKNOWN_BONDED    ? problem->bonded
                                       : 1;
}

static size_t coefficients_of(const struct inverse_problem *problem, int kind, size_t curve) {
    return (size_t)(kind == UNKNOWN_BONDED ? problem->group[curve].shape.coefficients
                                           : problem->unknown[kind].parameters.coefficients);
}

/// Of the first `curves` of an unknown.
static size_t coefficients_before(const struct inverse_problem *problem, int kind, size_t curves) {
    size_t count = 0;
    for (size_t curve = 0; curve < curves; curve++)
        count += coefficients_of(problem, kind, curve);
    return count;
}

size_t mf_parametrisation_count(const struct inverse_problem *problem) {
    size_t count = problem->numbers;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        count += coefficients_before(problem, kind, curves_of(problem, kind));
    return count;
}

size_t mf_parametrisation_variables(const struct parametrisation *parametrisation,
                                    enum unknown_kind kind) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    return coefficients_before(problem, kind, curves_of(problem, kind));
}

size_t mf_parametrisation_variables_of(const struct parametrisation *parametrisation,
                                       enum unknown_kind kind, size_t curve) {
    return coefficients_of(parametrisation->unknowns.problem, kind, curve);
}

size_t mf_parametrisation_first_point(const struct parametrisation *parametrisation,
                                      enum unknown_kind kind, size_t curve) {
    const struct potential_grid *grid = &parametrisation->unknowns.potential;
    return kind == UNKNOWN_POTENTIAL ? grid->core[curve]
           : kind == UNKNOWN_BONDED  ? grid->group[curve].own.below
                                     : 0;
}

void mf_parametrisation_places(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve, double *place) {
    const size_t points = mf_unknowns_part(&parametrisation->unknowns, kind, 0).points;
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, curve);
    const double *r = mf_unknowns_r(&parametrisation->unknowns, kind) + curve * points;
    for (size_t k = first; k < points; k++)
        place[k - first] = (r[k] - r[first]) / (r[points - 1] - r[first]);
}

static bool is_formula(const struct parametrisation *parametrisation, enum unknown_kind kind) {
    return unknown_of(parametrisation, kind)->parameters.shape == INVERSE_CURVE_POWER;
}

/// Points of a curve that follow its variables: how many, and the first of them among all.
static struct unknowns_part moving_part(const struct parametrisation *parametrisation,
                                        enum unknown_kind kind, size_t curve) {
    struct unknowns_part part = mf_unknowns_part(&parametrisation->unknowns, kind, curve);
    const size_t still = mf_parametrisation_first_point(parametrisation, kind, curve);
    part.first += still;
    part.points = kind == UNKNOWN_BONDED
                      ? parametrisation->unknowns.potential.group[curve].own.known
                      : part.points - still;
    return part;
}

/// What each coefficient of a curve adds to its moving points, shape [points, coefficients].
static enum status curve_basis(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve, size_t points, double *block) {
    OWNED double *place = NULL;
    if (kind == UNKNOWN_BONDED)
        return mf_parametrisation_bonded_basis(
            &parametrisation->unknowns.potential.group[curve].own,
            mf_parametrisation_variables_of(parametrisation, kind, curve), block);
    TRY_ARRAY(place, points);
    mf_parametrisation_places(parametrisation, kind, curve, place);
    return mf_shape_basis(mf_shapes[unknown_of(parametrisation, kind)->parameters.shape],
                          mf_parametrisation_variables_of(parametrisation, kind, curve), place,
                          points, block);
}

/// Basis of one curve: its block of the whole.
static enum status fill_block(struct parametrisation *parametrisation, enum unknown_kind kind,
                              size_t curve) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    const size_t variables = mf_parametrisation_variables(parametrisation, kind),
                 own = coefficients_of(problem, kind, curve),
                 before = coefficients_before(problem, kind, curve);
    const struct unknowns_part moving = moving_part(parametrisation, kind, curve);
    OWNED double *block = NULL;
    TRY_ARRAY(block, moving.points * own);
    TRY(curve_basis(parametrisation, kind, curve, moving.points, block));
    for (size_t k = 0; k < moving.points; k++)
        memcpy(parametrisation->basis[kind] + (moving.first + k) * variables + before,
               block + k * own, own * sizeof *block);
    return STATUS_OK;
}

/// The ranges of all coefficients and numbers.
static enum status find_ranges(struct parametrisation *parametrisation) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    size_t n = 0;
    TRY_ARRAY(parametrisation->min, parametrisation->variables);
    TRY_ARRAY(parametrisation->range, parametrisation->variables);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; curve < curves_of(problem, kind); curve++) {
            const struct unknown_parameters *p = &problem->unknown[kind].parameters;
            const double max = kind == UNKNOWN_BONDED ? problem->group[curve].shape.maximum : 0;
            const double min = is_formula(parametrisation, kind) ? 0
                               : kind == UNKNOWN_BONDED          ? -max
                                                                 : p->minimum;
            const double range = is_formula(parametrisation, kind) ? 1
                                 : kind == UNKNOWN_BONDED          ? 2 * max
                                                                   : p->maximum - p->minimum;
            for (size_t k = 0; k < coefficients_of(problem, kind, curve); k++, n++) {
                parametrisation->min[n] = min;
                parametrisation->range[n] = range;
            }
        }
    for (size_t k = 0; k < problem->numbers; k++, n++) {
        parametrisation->min[n] = problem->number[k].minimum;
        parametrisation->range[n] = problem->number[k].maximum - problem->number[k].minimum;
    }
    return STATUS_OK;
}

static enum status make_basis(struct parametrisation *parametrisation, enum unknown_kind kind) {
    if (is_formula(parametrisation, kind))
        return STATUS_OK;
    TRY_ARRAY(parametrisation->basis[kind],
              mf_unknowns_points(&parametrisation->unknowns, kind) *
                  mf_parametrisation_variables(parametrisation, kind));
    for (size_t curve = 0; curve < mf_unknowns_curve_count(&parametrisation->unknowns, kind);
         curve++)
        TRY(fill_block(parametrisation, kind, curve));
    return STATUS_OK;
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
    if (problem->unknown[UNKNOWN_BONDED].wanted) {
        TRY_ARRAY(parametrisation->bonded,
                  mf_unknowns_points(&parametrisation->unknowns, UNKNOWN_BONDED));
        mf_unknowns_start(&parametrisation->unknowns, UNKNOWN_BONDED, parametrisation->bonded);
    }
    return find_ranges(parametrisation);
}

void mf_parametrisation_clear(struct parametrisation *parametrisation) {
    mf_unknowns_clear(&parametrisation->unknowns);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(parametrisation->basis[kind]);
    mf_memory_free(parametrisation->min);
    mf_memory_free(parametrisation->range);
    mf_memory_free(parametrisation->bonded);
    *parametrisation = (struct parametrisation){0};
}

/// What coefficients are added to.
static double base_of(const struct parametrisation *parametrisation, enum unknown_kind kind,
                      size_t point) {
    const double *base =
        kind == UNKNOWN_BONDED ? parametrisation->bonded : unknown_of(parametrisation, kind)->base;
    return base ? base[point] : 0;
}

/// The base and Σ of basis and variables, in the unknown's unit.
static void linear_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                         const double *x, double *curve) {
    const double *min = parametrisation->min + parametrisation->first[kind],
                 *range = parametrisation->range + parametrisation->first[kind];
    const size_t count = mf_parametrisation_variables(parametrisation, kind);
    for (size_t k = 0; k < mf_unknowns_points(&parametrisation->unknowns, kind); k++) {
        const double *row = parametrisation->basis[kind] + k * count;
        double sum = base_of(parametrisation, kind, k);
        for (size_t n = 0; n < count; n++)
            sum += row[n] * (min[n] + x[n] * range[n]);
        curve[k] = unknown_is_omega(kind) ? fmax(0, sum) : sum;
    }
}

void mf_parametrisation_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                              const double *variables, double *curve) {
    if (is_formula(parametrisation, kind))
        make_power(parametrisation, variables, curve);
    else
        linear_curve(parametrisation, kind, variables + parametrisation->first[kind], curve);
    if (kind == UNKNOWN_POTENTIAL)
        mf_potential_grid_complete_pairs(&parametrisation->unknowns.potential, curve);
    if (kind == UNKNOWN_BONDED)
        mf_potential_grid_complete_groups(&parametrisation->unknowns.potential, curve);
}

size_t mf_parametrisation_blocks(const struct parametrisation *parametrisation, size_t *block) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    size_t count = 0;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; curve < curves_of(problem, kind); curve++)
            block[count++] = coefficients_of(problem, kind, curve);
    for (size_t n = 0; n < problem->numbers; n++)
        block[count++] = 1;
    return count;
}

void mf_parametrisation_numbers(const struct parametrisation *parametrisation,
                                const double *variables, const double *covariance,
                                struct inverse_parameter *number) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    for (size_t n = 0; n < problem->numbers; n++) {
        const size_t variable = parametrisation->first_number + n;
        const double min = parametrisation->min[variable], range = parametrisation->range[variable];
        number[n] = (struct inverse_parameter){min + range * variables[variable], NAN};
        if (covariance)
            number[n].error = range * sqrt(covariance[variable * (parametrisation->variables + 1)]);
    }
}

enum status mf_parametrisation_laws(const struct parametrisation *parametrisation,
                                    const double *variables, struct unknowns_laws *laws) {
    enum status status = STATUS_OK;
    double *curve[UNKNOWNS] = {NULL}, value[INVERSE_MAX_NUMBERS];
    struct inverse_parameter number[INVERSE_MAX_NUMBERS];
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

/// Variables of one curve nearest to `curve`, shape [points of it], which is changed.
static enum status start_of_curve(const struct parametrisation *parametrisation,
                                  enum unknown_kind kind, size_t number, double *curve,
                                  double *variables) {
    const struct unknown_parameters *p = &unknown_of(parametrisation, kind)->parameters;
    const size_t count = mf_parametrisation_variables_of(parametrisation, kind, number),
                 all = mf_parametrisation_variables(parametrisation, kind);
    const size_t first = mf_parametrisation_first_point(parametrisation, kind, number),
                 points = mf_unknowns_part(&parametrisation->unknowns, kind, 0).points;
    const double *block = parametrisation->basis[kind] + number * (points * all + count);
    OWNED double *place = NULL;
    TRY_ARRAY(place, points);
    mf_parametrisation_places(parametrisation, kind, number, place);
    // Variables that the curve leaves open stay in the middle of their range.
    const double middle = 0.5 * (p->minimum + p->maximum), range = p->maximum - p->minimum;
    for (size_t k = first; k < points; k++)
        for (size_t n = 0; n < count; n++)
            curve[k] -= middle * block[k * all + n];
    TRY(mf_shape_fit(mf_shapes[p->shape], place, curve + first, NULL, points - first, variables,
                     count));
    for (size_t k = 0; k < count; k++)
        variables[k] = fmin(1, fmax(0, 0.5 + variables[k] / range));
    return STATUS_OK;
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
    OWNED double *curve = NULL;
    if (is_formula(parametrisation, kind)) {
        start_power(parametrisation, variables);
        return STATUS_OK;
    }
    // The base of the groups is where they begin.
    for (size_t n = 0; n < mf_parametrisation_variables(parametrisation, kind); n++)
        variables[n] = 0.5;
    if (kind == UNKNOWN_BONDED)
        return STATUS_OK;
    TRY_ARRAY(curve, mf_unknowns_points(&parametrisation->unknowns, kind));
    start_curve(parametrisation, kind, curve);
    for (size_t n = 0; n < mf_unknowns_curve_count(&parametrisation->unknowns, kind); n++)
        TRY(start_of_curve(parametrisation, kind, n,
                           curve + n * mf_unknowns_part(&parametrisation->unknowns, kind, 0).points,
                           variables +
                               n * mf_parametrisation_variables_of(parametrisation, kind, n)));
    return STATUS_OK;
}

enum status mf_parametrisation_start(const struct parametrisation *parametrisation,
                                     double *variables) {
    const struct inverse_problem *problem = parametrisation->unknowns.problem;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_of(parametrisation, kind)->wanted)
            TRY(start_of(parametrisation, kind, variables + parametrisation->first[kind]));
    for (size_t n = 0; n < problem->numbers; n++) {
        const size_t variable = parametrisation->first_number + n;
        variables[variable] = (problem->number[n].start - parametrisation->min[variable]) /
                              parametrisation->range[variable];
    }
    return STATUS_OK;
}
