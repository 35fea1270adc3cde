// SPDX-License-Identifier: GPL-3.0-or-later
//
// The slopes of the pressure in the potential, against differences of simulations.
#include "curves/formula.h"
#include "curves/sampled.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"

enum { PARTICLES = 300, MAX_BINS = 40 };

/// Of the predicted change of the pressure: g(r) counts as constant in a bin, the change is not
/// infinitesimal, and both have statistical errors of about 1 %. Measured, predicted over found,
/// ramp and bump: 1.001 and 1.002 (soft), 1.014 and 0.978 (core and well). In short the errors are
/// 2.5 times as large.
static const double tolerance = 0.04, tolerance_in_short = 0.1;

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// One iteration from a potential: what its samples say.
static void measure(const struct fluid *fluid, const struct rdf_bins *bins, const double *g,
                    const struct curve *potential, struct inversion *inversion) {
    static const double errors[MAX_BINS];
    const struct inverse_listener listener = {ignore, NULL};
    struct inversion_parameters settings = {.replicas = 8,
                                            .equilibration = 60,
                                            .samples = length_is_long() ? 1500 : 240,
                                            .every = 4,
                                            .iterations = 1,
                                            .precision = 1};
    const struct inverse_problem problem = {
        .targets = {.bins = *bins,
                    .target[TARGET_RDF] = {.count = bins->count, .value = g, .error = errors}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true, .start = {potential}},
        .scene = fluid->setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    struct inverse_step step;
    *inversion = (struct inversion){0};
    assert_ok(mf_inversion_create(inversion, &mf_ibi, &problem, &settings));
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    inversion->problem = inversion->state->problem = NULL;
}

/// The ramp, and a bump where the first neighbours are.
static double change_of(int kind, double r, double cutoff) {
    return r >= cutoff ? 0 : kind == 0 ? 1 - r / cutoff : exp(-pow((r / cutoff - 0.6) / 0.08, 2));
}

static double pressure_when_changed(const struct fluid *fluid, const struct rdf_bins *bins,
                                    const double *g, const struct inversion *from, int kind,
                                    double amount) {
    const struct inversion_state *at = from->state;
    struct inversion changed;
    struct curve curve;
    double phi[MAX_BINS + 1];
    for (size_t k = 0; k < at->grid.points; k++)
        phi[k] = from->course.best.phi[k] +
                 amount * change_of(kind, at->grid.r[k], mf_rdf_bins_range(bins));
    assert_ok(mf_sampled_create(&curve, at->grid.r, phi, at->grid.points));
    measure(fluid, bins, g, &curve, &changed);
    const double pressure = changed.state->bulk.value;
    mf_inversion_destroy(&changed);
    mf_curve_clear(&curve);
    return pressure;
}

static void check_slopes(const struct fluid *fluid, const struct rdf_bins *bins, size_t core,
                         const struct curve *potential, double amount) {
    struct inversion from;
    double g[MAX_BINS];
    for (size_t k = 0; k < bins->count; k++)
        g[k] = k < core ? 0 : 1;
    measure(fluid, bins, g, potential, &from);
    const struct inversion_state *at = from.state;
    for (int kind = 0; kind < 2; kind++) {
        double predicted = 0;
        for (size_t b = 0; b < at->grid.known; b++)
            predicted +=
                2 * amount * at->bulk.slope[b] *
                change_of(kind, at->grid.r[at->grid.known_point[b]], mf_rdf_bins_range(bins));
        const double found = pressure_when_changed(fluid, bins, g, &from, kind, amount) -
                             pressure_when_changed(fluid, bins, g, &from, kind, -amount);
        print_message("pressure %.3f(%.3f), change predicted %.4f, found %.4f\n", at->bulk.value,
                      at->bulk.error, predicted, found);
        assert_close_relative(predicted, found, length_is_long() ? tolerance : tolerance_in_short);
    }
    mf_inversion_destroy(&from);
}

static void test_inversion_pressure_slopes_are_those_of_simulations_when_it_is_soft(void **state) {
    (void)state;
    struct fluid fluid;
    struct formula_soft_repulsion_parameters parameters = {25, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    check_slopes(&fluid, &(struct rdf_bins){0, 0.05, 20}, 0, &curve, 0.5);
    fluid_clear(&fluid);
}

static void
test_inversion_pressure_slopes_are_those_of_simulations_when_it_has_a_core(void **state) {
    (void)state;
    struct fluid fluid;
    struct formula_lennard_jones_parameters parameters = {1, 1, 1.8};
    const struct curve curve = {&mf_formula_lennard_jones, &parameters};
    fluid_lennard_jones(&fluid, PARTICLES, 0.01);
    fluid.setup.temperature = 1.5;
    check_slopes(&fluid, &(struct rdf_bins){0, 0.045, 40}, 19, &curve, 0.3);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_pressure_slopes_are_those_of_simulations_when_it_is_soft),
        cmocka_unit_test(
            test_inversion_pressure_slopes_are_those_of_simulations_when_it_has_a_core),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
