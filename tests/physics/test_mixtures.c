// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mixtures whose answer is known: types in name only are the fluid of one type; types that repel
// each other more stay apart, at the temperature that was set.
#include "curves/sampled.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/watched.h"
#include "shared/testing.h"

enum { PARTICLES = 3000, BINS = 20, SAMPLES = 200, PAIRS = 3 };

/// Standard errors by which two means may differ: one false alarm in 15,000 comparisons, of which
/// there are 70, with fixed seeds.
static const double deviations = 4;

static const struct rdf_bins bins = {0.2, 0.09, BINS};
static const struct composition halves = {.types = 2, .count = {1000, 2000}};

/// What is measured of a fluid, g by pair types.
struct measured {
    struct thermodynamics_summary summary;
    double g[PAIRS * BINS], error[PAIRS * BINS];
};

static void measure(const struct simulation_setup *setup, int64_t equilibration,
                    struct measured *measured) {
    const struct measure_plan plan = {
        .equilibration = equilibration, .samples = SAMPLES, .every = 10};
    const struct composition one = mf_composition_of_one(PARTICLES);
    const bool mixed = composition_is_mixed(&setup->composition);
    static struct simulation simulation;
    struct thermodynamics thermodynamics;
    struct rdf rdf;
    double temperature;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_rdf_init_mixture(&rdf, &bins, &setup->box, mixed ? &setup->composition : &one, 1,
                                  SAMPLES));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    const struct watched observables = {.rdf = &rdf, .thermodynamics = &thermodynamics};
    assert_ok(watched_sample(&simulation, &plan, observables, NULL));
    measured->summary = mf_thermodynamics_result(&thermodynamics, 1);
    assert_ok(mf_rdf_result(&rdf, 1, measured->g, measured->error));
    print_message("%d types: configurational %.4f(%.4f), pressure %.4f(%.4f)\n",
                  setup->composition.types, measured->summary.temperature_configurational,
                  measured->summary.temperature_configurational_error, measured->summary.pressure,
                  measured->summary.pressure_error);
    mf_rdf_clear(&rdf);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
}

static void assert_same_mean(double a, double a_error, double b, double b_error) {
    assert_close(a, b, deviations * hypot(a_error, b_error));
}

/// The seeds differ, and so do the runs: that they agree is no matter of bits.
static void test_mixture_of_equals_is_the_fluid_of_one_type(void **state) {
    (void)state;
    struct fluid fluid;
    static struct measured alone, mixed;
    struct table parts[PAIRS], potential, omega;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    measure(&fluid.setup, 400, &alone);
    for (int pair = 0; pair < PAIRS; pair++)
        parts[pair] = fluid.potential;
    assert_ok(mf_table_stack(&potential, parts, PAIRS));
    for (int pair = 0; pair < PAIRS; pair++)
        parts[pair] = fluid.omega;
    assert_ok(mf_table_stack(&omega, parts, PAIRS));
    fluid.setup.composition = halves;
    fluid.setup.potential = &potential;
    fluid.setup.omega = &omega;
    fluid.setup.seed = 2;
    measure(&fluid.setup, 400, &mixed);
    for (int pair = 0; pair < PAIRS; pair++)
        for (int k = 0; k < BINS; k++)
            assert_same_mean(mixed.g[pair * BINS + k], mixed.error[pair * BINS + k], alone.g[k],
                             alone.error[k]);
    const struct thermodynamics_summary *a = &mixed.summary, *b = &alone.summary;
    assert_same_mean(a->pressure, a->pressure_error, b->pressure, b->pressure_error);
    assert_same_mean(a->potential_energy, a->potential_energy_error, b->potential_energy,
                     b->potential_energy_error);
    assert_same_mean(a->temperature_configurational, a->temperature_configurational_error,
                     b->temperature_configurational, b->temperature_configurational_error);
    mf_table_clear(&potential);
    mf_table_clear(&omega);
    fluid_clear(&fluid);
}

/// a_AB = 60, a_AA = a_BB = 25 (R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997),
/// section V: they part from Δa of some 5 on). The potential of A-B ends at 0.9 with a force, so
/// that the configurational temperature needs the edge of that pair type alone: without it, it
/// is several per cent off.
static void test_mixture_that_parts_keeps_its_temperature(void **state) {
    (void)state;
    enum { POINTS = 10 };
    const double known = 0.0036; // of the standard fluid at this time step, test_groot_warren
    double r[POINTS], phi[POINTS];
    struct fluid fluid;
    struct curve curve;
    static struct measured measured;
    struct table potential, parts[PAIRS];
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    for (int k = 0; k < POINTS; k++) {
        r[k] = 0.1 * k;
        phi[k] = 30 * (1 - r[k]) * (1 - r[k]);
    }
    assert_ok(mf_sampled_create(&curve, r, phi, POINTS));
    parts[0] = parts[2] = fluid.potential;
    assert_ok(mf_table_init_potential(&parts[1], &curve));
    assert_ok(mf_table_stack(&potential, parts, PAIRS));
    fluid.setup.composition = halves;
    fluid.setup.potential = &potential;     // one friction weight is for all pairs
    measure(&fluid.setup, 6000, &measured); // parting makes heat
    print_message("g at the cutoff: A-A %.2f, A-B %.2f, B-B %.2f\n", measured.g[BINS - 1],
                  measured.g[2 * BINS - 1], measured.g[3 * BINS - 1]);
    assert_close(measured.summary.temperature_configurational, 1 + known,
                 deviations * measured.summary.temperature_configurational_error);
    assert_close(measured.summary.temperature, 1 + known,
                 deviations * measured.summary.temperature_error);
    const int last = BINS - 1;
    assert_true(measured.g[last] > 1.5);            // A among A
    assert_true(measured.g[BINS + last] < 0.6);     // B around A
    assert_true(measured.g[2 * BINS + last] > 1.1); // B among B, of which there are more
    mf_curve_clear(&curve);
    mf_table_clear(&parts[1]);
    mf_table_clear(&potential);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mixture_of_equals_is_the_fluid_of_one_type),
        cmocka_unit_test(test_mixture_that_parts_keeps_its_temperature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
