// SPDX-License-Identifier: GPL-3.0-or-later
//
// What mixed precision costs in accuracy, and that it does not show in results: the same fluids in
// mixed and in double precision.

#include "base/comoments.h"
#include "base/memory.h"
#include "shared/all_pairs.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/watched.h"
#include "shared/testing.h"

/// Of the error of a force, relative to the root mean square force: bounds of its root mean square
/// and of its largest value.
struct error_bound {
    double rms, largest;
};

/// Measured, DPD and Lennard-Jones: mixed 2.3e-7 and 1.1e-6 in the mean, 7e-7 and 7e-6 at most;
/// double 4e-16 and 1.2e-15, 1.8e-15 and 9e-15, of which the reference has its share. Neighbours in
/// the liquid press against each other: their forces are far larger than what is left of them. One
/// configuration in some 40 would have a pair so near the cutoff of Lennard-Jones, where the force
/// jumps by 0.04, that the precisions disagree about it; this one has none.
static const struct error_bound mixed_bound = {3e-6, 3e-5}, double_bound = {3e-15, 3e-14};

static const enum pair_precision precisions[] = {PAIR_MIXED, PAIR_DOUBLE};
static const char *const names[] = {"mixed", "double"};

/// Forces by id at the start of a simulation: shape [3, count].
static double *first_forces(const struct simulation_setup *setup, const struct simulation *from,
                            bool from_all_pairs) {
    struct simulation simulation;
    const size_t count = from->particles.count;
    double *forces = mf_memory_zeroed(3 * count, sizeof *forces);
    assert_non_null(forces);
    fluid_continue(&simulation, setup, from);
    if (from_all_pairs) {
        // The forces at the start saw the velocities as they are.
        all_pairs_forces(&simulation.law, &simulation.particles, 0, NULL);
    }
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < count; k++)
            forces[(size_t)d * count + simulation.particles.id[k]] =
                simulation.particles.force[d][k];
    mf_simulation_clear(&simulation);
    return forces;
}

/// Length of the difference of two vectors among `count`.
static double distance(const double *a, const double *b, size_t count, size_t k) {
    double square = 0;
    for (size_t d = 0; d < 3; d++)
        square += (a[d * count + k] - b[d * count + k]) * (a[d * count + k] - b[d * count + k]);
    return sqrt(square);
}

/// Error of `forces` in units of the root mean square of `expected`.
static struct error_bound force_error(const double *forces, const double *expected, size_t count) {
    double squares = 0, error_squares = 0, largest = 0;
    for (size_t k = 0; k < 3 * count; k++)
        squares += expected[k] * expected[k];
    for (size_t k = 0; k < count; k++) {
        const double error = distance(forces, expected, count, k);
        error_squares += error * error;
        largest = fmax(largest, error);
    }
    return (struct error_bound){sqrt(error_squares / squares),
                                largest / sqrt(squares / (double)count)};
}

/// Of an equilibrated fluid, in both precisions.
static void check_forces(const char *what, const struct simulation_setup *setup,
                         const struct simulation *from) {
    const size_t count = from->particles.count;
    struct simulation_setup here = *setup;
    double *exact = first_forces(&here, from, true);
    for (int p = 0; p < 2; p++) {
        const struct error_bound allowed = p == 0 ? mixed_bound : double_bound;
        here.precision = (int)precisions[p];
        double *forces = first_forces(&here, from, false);
        const struct error_bound error = force_error(forces, exact, count);
        print_message("%s, %s: error of a force relative to the rms force: rms %.2e, largest "
                      "%.2e\n",
                      what, names[p], error.rms, error.largest);
        assert_true(error.rms < allowed.rms);
        assert_true(error.largest < allowed.largest);
        mf_memory_free(forces);
    }
    mf_memory_free(exact);
}

static void test_forces_are_as_exact_as_their_precision_when_the_fluid_is_dpd(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation start;
    fluid_groot_warren(&fluid, 3000, 0.04);
    assert_ok(mf_simulation_init(&start, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&start, 300));
    check_forces("DPD", &fluid.setup, &start);
    fluid.setup.omega = NULL;
    check_forces("DPD, conservative", &fluid.setup, &start);
    mf_simulation_clear(&start);
    fluid_clear(&fluid);
}

/// A melted Lennard-Jones liquid at about T = 0.7, left by its thermostat.
static void melt(struct fluid *fluid, struct simulation *simulation, int64_t count) {
    fluid_lennard_jones(fluid, count, 0.004);
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
    assert_ok(mf_simulation_run(simulation, 2500));
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
}

static void
test_forces_are_as_exact_as_their_precision_when_the_fluid_is_lennard_jones(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation start;
    melt(&fluid, &start, 2048);
    check_forces("Lennard-Jones", &fluid.setup, &start);
    mf_simulation_clear(&start);
    fluid_clear(&fluid);
}

static double total_energy(const struct simulation *simulation) {
    return (simulation->sums.energy +
            0.5 * mf_particles_square_velocities(&simulation->particles)) /
           (double)simulation->particles.count;
}

/// Drift of the energy of a particle [1/τ], from a straight line through 10 τ.
static double energy_drift(const struct simulation_setup *setup, const struct simulation *from) {
    enum { SAMPLES = 500, EVERY = 20 };
    struct simulation simulation;
    struct comoments moments;
    fluid_continue(&simulation, setup, from);
    assert_ok(mf_comoments_init(&moments, 2));
    for (int k = 0; k < SAMPLES; k++) {
        simulation.wants = PAIR_FORCES;
        assert_ok(mf_simulation_run(&simulation, EVERY - 1));
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, 1));
        mf_comoments_add(&moments, (double[]){(double)simulation.step * setup->time_step,
                                              total_energy(&simulation)});
    }
    const double slope =
        mf_comoments_covariance(&moments, 0, 1) / mf_comoments_covariance(&moments, 0, 0);
    mf_comoments_clear(&moments);
    mf_simulation_clear(&simulation);
    return slope;
}

/// Steps with its thermostat after which the liquid is a new start of the drift.
enum { BETWEEN_STARTS = 500 };

/// Standard deviation of the drift from one start, a random walk by what crosses the cutoff, where
/// the force jumps. Measured with 48 starts, two seeds: 1.0e-6 in either precision, and means of
/// -1.7(1.4)e-7 in mixed and -0.7(1.5)e-7 in double precision.
static const double drift_scatter = 1.0e-6;

/// Standard errors that a mean may be from what it should be: with the bounds on each drift and on
/// their difference one false alarm in 5000 for new seeds.
static const double deviations = 4;

static void
test_energy_drifts_no_more_in_mixed_precision_when_the_time_step_is_small(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation start;
    double mean[2] = {0};
    const int starts = length_is_long() ? 8 : 2;
    const double error = drift_scatter / sqrt(starts);
    melt(&fluid, &start, 864);
    struct simulation_setup setup = fluid.setup;
    setup.time_step = 0.001;
    for (int s = 0; s < starts; s++) {
        assert_ok(mf_simulation_run(&start, BETWEEN_STARTS));
        for (int p = 0; p < 2; p++) {
            setup.precision = (int)precisions[p];
            mean[p] += energy_drift(&setup, &start) / starts;
        }
    }
    for (int p = 0; p < 2; p++) {
        print_message("Lennard-Jones, %s: drift of the energy %.1e(%.1e) per particle and time "
                      "unit\n",
                      names[p], mean[p], error);
        assert_close(mean[p], 0, deviations * error);
    }
    assert_close(mean[0], mean[1], deviations * sqrt(2) * error);
    mf_simulation_clear(&start);
    fluid_clear(&fluid);
}

enum { BINS = 40 };

/// What a short simulation of the standard fluid measures.
struct measured {
    struct thermodynamics_summary thermodynamics;
    double g[BINS], g_error[BINS];
};

static void measure(const struct simulation_setup *setup, struct measured *measured) {
    const struct measure_plan plan = {
        .equilibration = 150, .samples = length_is_long() ? 300 : 100, .every = 10};
    const size_t samples = (size_t)plan.samples;
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    struct rdf rdf;
    double temperature;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    // Beyond the cutoff, so that the RDF makes its own list.
    assert_ok(mf_rdf_init(&rdf, &(struct rdf_bins){0, 0.05, BINS}, &setup->box,
                          simulation.particles.count, 1, samples));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    const struct watched observables = {.rdf = &rdf, .thermodynamics = &thermodynamics};
    assert_ok(watched_sample(&simulation, &plan, observables, NULL));
    measured->thermodynamics = mf_thermodynamics_result(&thermodynamics, 1);
    assert_ok(mf_rdf_result(&rdf, 1, measured->g, measured->g_error));
    mf_rdf_clear(&rdf);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
}

/// Two temperatures and 40 bins of g, with errors from 20 blocks: one false alarm in 80 for new
/// seeds. The fluid is chaotic: after some time units the two runs are as independent as with other
/// seeds.
static void test_results_do_not_depend_on_the_precision_when_the_fluid_is_dpd(void **state) {
    (void)state;
    struct fluid fluid;
    struct measured measured[2];
    double squares = 0, largest = 0;
    fluid_groot_warren(&fluid, 3000, 0.04);
    for (int p = 0; p < 2; p++) {
        fluid.setup.precision = (int)precisions[p];
        measure(&fluid.setup, &measured[p]);
        const struct thermodynamics_summary *s = &measured[p].thermodynamics;
        print_message("DPD, %s: kinetic temperature %.5f(%.5f), configurational %.5f(%.5f), U/N "
                      "%.4f(%.4f), pressure %.4f(%.4f)\n",
                      names[p], s->temperature, s->temperature_error,
                      s->temperature_configurational, s->temperature_configurational_error,
                      s->potential_energy, s->potential_energy_error, s->pressure,
                      s->pressure_error);
    }
    const struct thermodynamics_summary *a = &measured[0].thermodynamics,
                                        *b = &measured[1].thermodynamics;
    assert_close(a->temperature, b->temperature,
                 deviations * hypot(a->temperature_error, b->temperature_error));
    assert_close(a->temperature_configurational, b->temperature_configurational,
                 deviations * hypot(a->temperature_configurational_error,
                                    b->temperature_configurational_error));
    for (int k = 0; k < BINS; k++) {
        const double off = measured[0].g[k] - measured[1].g[k];
        const double error = hypot(measured[0].g_error[k], measured[1].g_error[k]);
        assert_close(off, 0, deviations * error);
        squares += error > 0 ? off * off / (error * error) / BINS : 0; // no pair in the first bin
        largest = fmax(largest, fabs(off));
    }
    print_message("DPD: g(r) differs by %.4f at most, by %.2f errors in the mean square\n", largest,
                  sqrt(squares));
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forces_are_as_exact_as_their_precision_when_the_fluid_is_dpd),
        cmocka_unit_test(
            test_forces_are_as_exact_as_their_precision_when_the_fluid_is_lennard_jones),
        cmocka_unit_test(test_energy_drifts_no_more_in_mixed_precision_when_the_time_step_is_small),
        cmocka_unit_test(test_results_do_not_depend_on_the_precision_when_the_fluid_is_dpd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
