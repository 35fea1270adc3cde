// SPDX-License-Identifier: GPL-3.0-or-later
//
// The slope of the pressure in f of a local density, against differences of simulations of another
// f; and what f and the potential of pairs share moves neither.
#include "curves/formula.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/many_bodies.h"
#include "shared/testing.h"

#include <math.h>

enum { PARTICLES = 300, BINS = 30, RHO_BINS = 90 };
static const double rho_width = 0.15, mean = 9.23, origin = 5;
static const struct weighted_density_settings weight = {0.5, 1.2, RHO_BINS, RHO_BINS * 0.15};

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// f = c (ρ − ρ_o)². ρ is 9.2(9).
static double energy_at(double c, double rho) {
    return c * pow(rho - origin, 2);
}

/// One iteration of soft beads with this f, which is to be found or is known.
static void measure(double c, bool found, struct inversion *inversion) {
    static double g[BINS], no_errors[RHO_BINS], rho[RHO_BINS], p[RHO_BINS];
    static struct formula_soft_repulsion_parameters parameters = {25, 1};
    static const struct curve potential = {&mf_formula_soft_repulsion, &parameters};
    static const struct inverse_listener listener = {ignore, NULL};
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    for (size_t k = 0; k < BINS; k++)
        g[k] = 1;
    for (size_t k = 0; k < RHO_BINS; k++) {
        rho[k] = ((double)k + 0.5) * rho_width;
        p[k] = exp(-0.5 * pow((rho[k] - mean) / 0.9, 2)) / (0.9 * sqrt(2 * M_PI));
    }
    struct many_body law;
    many_bodies_crowd(&law, weight.inner_cutoff, weight.cutoff, found ? 0 : c, origin,
                      &fluid.setup.composition);
    fluid.setup.interaction[fluid.setup.interactions++] =
        (struct interaction_choice){&mf_many_body, &law};
    struct inversion_parameters settings = {.replicas = 8,
                                            .equilibration = 60,
                                            .samples = length_is_long() ? 1000 : 120,
                                            .every = 4,
                                            .iterations = 1,
                                            .precision = 1,
                                            .sampler = SAMPLER_AUTO};
    static struct inverse_problem problem; // the grid of an inversion points to its groups
    problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.05, BINS},
                    .target[TARGET_RDF] = {.count = BINS, .value = g, .error = no_errors}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true, .start = {&potential}},
        .scene = fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    const int kind = mf_weighted_density_kind();
    if (found) {
        problem.targets.target[kind] = (struct target){RHO_BINS, p, no_errors, .x = rho};
        problem.targets.settings[mf_observable_kind(kind).place] = &weight;
        problem.unknown[UNKNOWN_BONDED].wanted = true;
        problem.group[problem.bonded++] = (struct bonded_unknown){.order = INVERSE_LOCAL_DENSITY,
                                                                  .bins = {0, rho_width, RHO_BINS}};
    }
    struct inverse_step step;
    *inversion = (struct inversion){0};
    assert_ok(mf_inversion_create(inversion, &mf_ibi, &problem, &settings));
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    inversion->problem = inversion->state->problem = NULL;
    mf_many_body_clear(&law);
    fluid_clear(&fluid);
}

static double pressure_with(double c) {
    struct inversion inversion;
    measure(c, false, &inversion);
    const double pressure = inversion.state->bulk.value;
    mf_inversion_destroy(&inversion);
    return pressure;
}

/// Without what f does to the virial itself, beside what it does to S, the change would be another
/// one, of the other sign.
static void test_slope_of_the_pressure_is_that_of_simulations(void **state) {
    static const double amount = 0.02;
    struct inversion inversion;
    (void)state;
    measure(0, true, &inversion);
    const struct inversion_state *at = inversion.state;
    double predicted = 0;
    for (size_t b = at->grid.pairs_known; b < at->grid.known; b++)
        predicted += 2 * at->bulk.slope[b] * energy_at(amount, at->grid.r[at->grid.known_point[b]]);
    const double found = pressure_with(amount) - pressure_with(-amount);
    print_message("pressure %.3f(%.3f), change predicted %.4f, found %.4f\n", at->bulk.value,
                  at->bulk.error, predicted, found);
    assert_close_relative(predicted, found, length_is_long() ? 0.05 : 0.1);
    // The straight line of f as a potential of pairs: as much pressure, and no S.
    double shared = 0, all = 0;
    for (size_t b = 0; b < at->grid.known; b++) {
        const double part = at->bulk.slope[b] * at->grid.shared.change[b];
        shared += part;
        all += fabs(part);
    }
    print_message("slope along what is shared: %.4f of %.4f\n", shared, all);
    assert_true(fabs(shared) < 0.03 * all);
    mf_inversion_destroy(&inversion);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slope_of_the_pressure_is_that_of_simulations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
