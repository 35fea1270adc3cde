// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/decoder.h"

#include "curves/formula.h"
#include "curves/shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct unknown *unknown_of(const struct decoder *decoder, enum unknown_kind kind) {
    return &decoder->problem->unknown[kind];
}

size_t mf_decoder_curve_count(const struct decoder *decoder, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? decoder->potential.pairs : 1;
}

bool mf_decoder_fits(const struct decoder *decoder, enum unknown_kind kind, size_t point) {
    const size_t each = mf_decoder_points(decoder, kind) / mf_decoder_curve_count(decoder, kind);
    return point % each + 1 < each &&
           !(kind == UNKNOWN_POTENTIAL && mf_potential_grid_in_core(&decoder->potential, point));
}

void mf_decoder_curve_name(const struct decoder *decoder, enum unknown_kind kind, size_t curve,
                           char name[DECODER_NAME_SIZE]) {
    char pair[COMPOSITION_PAIR_NAME_SIZE] = "";
    if (kind == UNKNOWN_POTENTIAL)
        mf_composition_pair_name(&decoder->problem->scene.composition, (int)curve, pair);
    snprintf(name, DECODER_NAME_SIZE, "%s%s%s", mf_inverse_unknown_names[kind], pair[0] ? "_" : "",
             pair);
}

static size_t genes_of_curve(const struct decoder *decoder, enum unknown_kind kind) {
    return (size_t)unknown_of(decoder, kind)->parameters.coefficients;
}

size_t mf_decoder_variables(const struct decoder *decoder, enum unknown_kind kind) {
    return unknown_of(decoder, kind)->wanted
               ? mf_decoder_curve_count(decoder, kind) * genes_of_curve(decoder, kind)
               : 0;
}

/// Points of a curve below this one do not follow its variables: the core of a potential.
static size_t first_point(const struct decoder *decoder, enum unknown_kind kind, size_t curve) {
    return kind == UNKNOWN_POTENTIAL ? decoder->potential.core[curve] : 0;
}

size_t mf_decoder_points(const struct decoder *decoder, enum unknown_kind kind) {
    if (!unknown_of(decoder, kind)->wanted)
        return 0;
    return kind == UNKNOWN_POTENTIAL ? decoder->potential.points : OMEGA_POINTS;
}

static size_t points_of_curve(const struct decoder *decoder, enum unknown_kind kind) {
    return mf_decoder_points(decoder, kind) / mf_decoder_curve_count(decoder, kind);
}

const double *mf_decoder_r(const struct decoder *decoder, enum unknown_kind kind) {
    return kind == UNKNOWN_POTENTIAL ? decoder->potential.r : decoder->omega.r;
}

/// Where the points of a curve lie between the first that follows its variables (0) and the cutoff
/// (1).
static void find_places(const struct decoder *decoder, enum unknown_kind kind, size_t curve,
                        double *place) {
    const size_t points = points_of_curve(decoder, kind);
    const size_t first = first_point(decoder, kind, curve);
    const double *r = mf_decoder_r(decoder, kind) + curve * points;
    for (size_t k = first; k < points; k++)
        place[k - first] = (r[k] - r[first]) / (r[points - 1] - r[first]);
}

static bool is_formula(const struct decoder *decoder, enum unknown_kind kind) {
    return unknown_of(decoder, kind)->parameters.shape == INVERSE_CURVE_POWER;
}

/// Basis of one curve: its block of the whole.
static enum status fill_block(struct decoder *decoder, enum unknown_kind kind, size_t curve) {
    enum status status = STATUS_OK;
    const size_t variables = mf_decoder_variables(decoder, kind),
                 own = genes_of_curve(decoder, kind);
    const size_t points = points_of_curve(decoder, kind);
    const size_t first = first_point(decoder, kind, curve), moving = points - first;
    double *place = NULL, *block = NULL;
    NEW_ARRAY(place, moving);
    NEW_ARRAY(block, moving * own);
    find_places(decoder, kind, curve, place);
    CHECK(mf_shape_basis(mf_shapes[unknown_of(decoder, kind)->parameters.shape], own, place, moving,
                         block));
    for (size_t k = 0; k < moving; k++)
        memcpy(decoder->basis[kind] + (curve * points + first + k) * variables + curve * own,
               block + k * own, own * sizeof *block);
done:
    mf_memory_free(place);
    mf_memory_free(block);
    return status;
}

static enum status make_basis(struct decoder *decoder, enum unknown_kind kind) {
    enum status status = STATUS_OK;
    if (is_formula(decoder, kind))
        return STATUS_OK;
    NEW_ARRAY(decoder->basis[kind],
              mf_decoder_points(decoder, kind) * mf_decoder_variables(decoder, kind));
    for (size_t curve = 0; curve < mf_decoder_curve_count(decoder, kind); curve++)
        CHECK(fill_block(decoder, kind, curve));
done:
    return status;
}

enum status mf_decoder_init(struct decoder *decoder, const struct inverse_problem *problem) {
    *decoder = (struct decoder){.problem = problem};
    if (problem->unknown[UNKNOWN_POTENTIAL].wanted)
        TRY(mf_potential_grid_init(&decoder->potential, problem));
    const struct unknown_parameters *omega = &problem->unknown[UNKNOWN_OMEGA].parameters;
    mf_omega_grid_init(&decoder->omega, omega->inner_cutoff, omega->cutoff);
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        decoder->first[kind] = decoder->variables;
        decoder->variables += mf_decoder_variables(decoder, kind);
        if (problem->unknown[kind].wanted)
            TRY(make_basis(decoder, kind));
    }
    return STATUS_OK;
}

void mf_decoder_clear(struct decoder *decoder) {
    mf_potential_grid_clear(&decoder->potential);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_memory_free(decoder->basis[kind]);
    *decoder = (struct decoder){0};
}

/// Σ of basis and variables, in the unknown's unit.
static void linear_curve(const struct decoder *decoder, enum unknown_kind kind, const double *x,
                         double *curve) {
    const struct unknown_parameters *p = &unknown_of(decoder, kind)->parameters;
    const size_t count = mf_decoder_variables(decoder, kind);
    for (size_t k = 0; k < mf_decoder_points(decoder, kind); k++) {
        const double *row = decoder->basis[kind] + k * count;
        double sum = 0;
        for (size_t n = 0; n < count; n++)
            sum += row[n] * (p->minimum + x[n] * (p->maximum - p->minimum));
        curve[k] = kind == UNKNOWN_OMEGA ? fmax(0, sum) : sum;
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

const char *mf_decoder_parameter_bound(const struct unknown_parameters *p, int parameter,
                                       double value) {
    static const double near = 1e-3;
    const struct span span = parameter_span(p, parameter);
    const double part = (value - span.least) / span.range;
    if (!isnan(p->fixed[parameter]))
        return NULL;
    return part < near ? "minimum" : part > 1 - near ? "maximum" : NULL;
}

void mf_decoder_parameters(const struct decoder *decoder, const double *variables,
                           const double *covariance,
                           struct inverse_parameter parameter[INVERSE_PARAMETERS]) {
    const struct unknown_parameters *p = &unknown_of(decoder, UNKNOWN_OMEGA)->parameters;
    const bool formula =
        unknown_of(decoder, UNKNOWN_OMEGA)->wanted && is_formula(decoder, UNKNOWN_OMEGA);
    size_t variable = decoder->first[UNKNOWN_OMEGA];
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
            parameter[k].error = span.range * sqrt(covariance[variable * (decoder->variables + 1)]);
        variable++;
    }
}

static void power_curve(const struct decoder *decoder, const double *variables, double *curve) {
    struct inverse_parameter found[INVERSE_PARAMETERS];
    mf_decoder_parameters(decoder, variables, NULL, found);
    struct formula_power_omega_parameters formula = {
        .sigma = found[INVERSE_SIGMA].value,
        .exponent = found[INVERSE_EXPONENT].value,
        .inner_cutoff = found[INVERSE_INNER_CUTOFF].value,
        .cutoff = unknown_of(decoder, UNKNOWN_OMEGA)->parameters.cutoff};
    const struct curve power = {&mf_formula_power_omega, &formula};
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        curve[k] = fmax(0, mf_curve_value(&power, decoder->omega.r[k]));
}

void mf_decoder_curve(const struct decoder *decoder, enum unknown_kind kind,
                      const double *variables, double *curve) {
    if (is_formula(decoder, kind))
        power_curve(decoder, variables, curve);
    else
        linear_curve(decoder, kind, variables + decoder->first[kind], curve);
    if (kind == UNKNOWN_POTENTIAL)
        mf_potential_grid_complete(&decoder->potential, curve);
}

enum status mf_decoder_table(const struct decoder *decoder, enum unknown_kind kind,
                             const double *curve, struct table *table) {
    return kind == UNKNOWN_POTENTIAL ? mf_potential_grid_table(&decoder->potential, curve, table)
                                     : mf_omega_grid_table(&decoder->omega, curve, table);
}

enum status mf_decoder_laws(const struct decoder *decoder, const double *variables,
                            struct decoder_laws *laws) {
    enum status status = STATUS_OK;
    const struct simulation_setup *scene = &decoder->problem->scene;
    double *curve = NULL;
    *laws = (struct decoder_laws){.table = {scene->potential, scene->omega}};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!unknown_of(decoder, kind)->wanted)
            continue;
        mf_memory_free(curve);
        NEW_ARRAY(curve, mf_decoder_points(decoder, kind));
        mf_decoder_curve(decoder, kind, variables, curve);
        CHECK(mf_decoder_table(decoder, kind, curve, &laws->own[kind]));
        laws->table[kind] = &laws->own[kind];
    }
done:
    mf_memory_free(curve);
    return status;
}

void mf_decoder_laws_clear(struct decoder_laws *laws) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        mf_table_clear(&laws->own[kind]);
}

/// The curve that a fit begins with, on the points of the unknown.
static void start_curve(const struct decoder *decoder, enum unknown_kind kind, double *curve) {
    const struct unknown *unknown = unknown_of(decoder, kind);
    if (kind == UNKNOWN_POTENTIAL) {
        mf_potential_grid_start(&decoder->potential, decoder->problem, curve);
        return;
    }
    const struct omega_grid *grid = &decoder->omega;
    const double middle = 0.5 * (unknown->parameters.minimum + unknown->parameters.maximum);
    for (int k = 0; k < OMEGA_POINTS; k++)
        curve[k] = unknown->start[0] ? mf_curve_value(unknown->start[0], grid->r[k])
                                     : middle * (1 - grid->r[k] / grid->cutoff);
}

/// Variables of a formula with sigma in the middle of its range, or those of the start if it is the
/// same formula.
static void start_power(const struct decoder *decoder, double *variables) {
    const struct unknown *unknown = unknown_of(decoder, UNKNOWN_OMEGA);
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
static enum status start_of_curve(const struct decoder *decoder, enum unknown_kind kind,
                                  size_t number, double *curve, double *variables) {
    enum status status = STATUS_OK;
    const struct unknown_parameters *p = &unknown_of(decoder, kind)->parameters;
    const size_t count = genes_of_curve(decoder, kind), all = mf_decoder_variables(decoder, kind);
    const size_t first = first_point(decoder, kind, number),
                 points = points_of_curve(decoder, kind);
    const double *block = decoder->basis[kind] + number * (points * all + count);
    double *place = NULL;
    NEW_ARRAY(place, points);
    find_places(decoder, kind, number, place);
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

static enum status start_of(const struct decoder *decoder, enum unknown_kind kind,
                            double *variables) {
    enum status status = STATUS_OK;
    double *curve = NULL;
    if (is_formula(decoder, kind)) {
        start_power(decoder, variables);
        return STATUS_OK;
    }
    NEW_ARRAY(curve, mf_decoder_points(decoder, kind));
    start_curve(decoder, kind, curve);
    for (size_t n = 0; n < mf_decoder_curve_count(decoder, kind); n++)
        CHECK(start_of_curve(decoder, kind, n, curve + n * points_of_curve(decoder, kind),
                             variables + n * genes_of_curve(decoder, kind)));
done:
    mf_memory_free(curve);
    return status;
}

enum status mf_decoder_start(const struct decoder *decoder, double *variables) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (unknown_of(decoder, kind)->wanted)
            TRY(start_of(decoder, kind, variables + decoder->first[kind]));
    return STATUS_OK;
}
