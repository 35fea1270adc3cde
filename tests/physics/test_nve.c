// SPDX-License-Identifier: GPL-3.0-or-later
//
// Conservation laws: energy without friction, momentum with it.
#include "base/comoments.h"
#include "dynamics/dpd_verlet.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"
#include "shared/variants.h"

enum { PARTICLES = 864 };

/// Drift of the energy of a particle in a time unit. Measured with four seeds: 2e-7 to 1.1e-6 of
/// either sign, a random walk by what crosses the cutoff, where the force jumps.
static const double largest_drift = 1e-5;

/// The error of velocity Verlet in the energy is of second order, so that halving Δt divides its
/// fluctuation by 4; a first-order scheme would give 2. Measured with twelve seeds: 24 ratios, mean
/// 3.94, standard deviation 0.11. The band is four of these: a false alarm for 1 seed in 10^4.
static const double order_ratio = 4, order_band = 0.5;

/// Of the instantaneous temperature about 0.7: its standard deviation is 0.7 sqrt(2/(3N)) = 0.02.
static const double temperature_band = 0.1;

/// Sum of 10^4 steps' roundings, 2^-53 of a velocity each, that add up like a random walk over
/// particles and steps. Measured: 4e-13.
static const double momentum_rounding = 1e-11;

/// Energy at equal times.
struct energies {
    size_t count;
    double time[4096], energy[4096]; ///< of a particle
};

static double total_energy(const struct simulation *simulation) {
    return (simulation->sums.energy +
            0.5 * mf_particles_square_velocities(&simulation->particles)) /
           (double)simulation->particles.count;
}

/// A melted Lennard-Jones liquid at about T = 0.7, left by its thermostat.
static void prepare(struct fluid *fluid, struct simulation *simulation) {
    fluid_lennard_jones(fluid, PARTICLES, 0.004);
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
    assert_ok(mf_simulation_run(simulation, 2500));
}

/// NVE from where `from` is, for `duration`, with the energy every `interval` [τ].
static void follow(const struct fluid *fluid, const struct simulation *from, double time_step,
                   double duration, double interval, struct energies *energies) {
    struct simulation_setup setup = fluid->setup;
    struct simulation simulation;
    setup.omega = NULL;
    setup.integrator = &mf_velocity_verlet;
    setup.time_step = time_step;
    fluid_continue(&simulation, &setup, from);
    const uint64_t every = (uint64_t)lround(interval / time_step);
    energies->count = (size_t)lround(duration / interval);
    for (size_t k = 0; k < energies->count; k++) {
        simulation.wants = PAIR_FORCES;
        assert_ok(mf_simulation_run(&simulation, every - 1));
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, 1));
        energies->time[k] = (double)simulation.step * time_step;
        energies->energy[k] = total_energy(&simulation);
    }
    // Else the scene is not the liquid that it should be.
    assert_close(mf_particles_temperature(&simulation.particles), 0.7, temperature_band);
    mf_simulation_clear(&simulation);
}

/// Straight line through the energies begin … end − 1: its slope, and the mean square about it.
static void fit_line(const struct energies *energies, size_t begin, size_t end, double *slope,
                     double *square) {
    struct comoments moments;
    assert_ok(mf_comoments_init(&moments, 2));
    for (size_t k = begin; k < end; k++)
        mf_comoments_add(&moments, (double[]){energies->time[k], energies->energy[k]});
    const double tt = mf_comoments_covariance(&moments, 0, 0),
                 te = mf_comoments_covariance(&moments, 0, 1),
                 ee = mf_comoments_covariance(&moments, 1, 1);
    *slope = te / tt;
    *square = ee - te * te / tt;
    mf_comoments_clear(&moments);
}

/// Fluctuation of the energy within half a time unit, which is long for the error of the
/// integrator and short for the random walk by what crosses the cutoff.
static double fluctuation(const struct energies *energies) {
    enum { PARTS = 4 };
    double slope, square, sum = 0;
    for (size_t p = 0; p < PARTS; p++) {
        fit_line(energies, energies->count * p / PARTS, energies->count * (p + 1) / PARTS, &slope,
                 &square);
        sum += square;
    }
    return sqrt(sum / PARTS);
}

/// NVE of the liquid with each variant from the same start, which the first one made.
static void for_each_variant(void (*check)(const struct fluid *fluid,
                                           const struct simulation *start)) {
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    struct fluid fluid;
    struct simulation start;
    prepare(&fluid, &start);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        fluid.setup.precision = (int)variants[v].precision;
        print_message("%s:\n", variants[v].name);
        check(&fluid, &start);
    }
    variants_select(&variants[0]);
    mf_simulation_clear(&start);
    fluid_clear(&fluid);
}

static void check_drift(const struct fluid *fluid, const struct simulation *start) {
    struct energies energies;
    double slope, square;
    follow(fluid, start, 0.001, length_is_long() ? 10 : 4, 0.01, &energies);
    fit_line(&energies, 0, energies.count, &slope, &square);
    print_message("drift %.2e per particle and time unit\n", slope);
    assert_true(fabs(slope) < largest_drift);
}

static void test_velocity_verlet_keeps_the_energy_when_the_time_step_is_small(void **state) {
    (void)state;
    for_each_variant(check_drift);
}

static void check_order(const struct fluid *fluid, const struct simulation *start) {
    static const double time_steps[] = {0.004, 0.002, 0.001};
    struct energies energies;
    double scatter[3];
    for (int k = 0; k < 3; k++) {
        follow(fluid, start, time_steps[k], 2, 0.004, &energies);
        scatter[k] = fluctuation(&energies);
        print_message("time step %g: fluctuation of the energy of a particle %.3e\n", time_steps[k],
                      scatter[k]);
    }
    assert_close(scatter[0] / scatter[1], order_ratio, order_band);
    assert_close(scatter[1] / scatter[2], order_ratio, order_band);
}

static void test_velocity_verlet_is_of_second_order_when_the_time_step_is_halved(void **state) {
    (void)state;
    for_each_variant(check_order);
}

/// Largest component of the total momentum.
static double momentum(const struct particles *particles) {
    double largest = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double sum = 0;
        for (size_t k = 0; k < particles->count; k++)
            sum += particles->velocity[d][k];
        largest = fmax(largest, fabs(sum));
    }
    return largest;
}

/// Over 10^4 steps with the first variant, and 10^3 with the others; a third of them in short.
static void assert_momentum_stays_zero(struct simulation_setup *setup) {
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int v = 0; v < variant_count; v++) {
        const uint64_t steps = (v == 0 ? 10000 : 1000) / (length_is_long() ? 1 : 3);
        struct simulation simulation;
        variants_select(&variants[v]);
        setup->precision = (int)variants[v].precision;
        assert_ok(mf_simulation_init(&simulation, setup, NULL));
        double largest = momentum(&simulation.particles);
        while (simulation.step < steps) {
            assert_ok(mf_simulation_run(&simulation, 100));
            largest = fmax(largest, momentum(&simulation.particles));
        }
        print_message("%s, %s: largest momentum in %d steps %.2e\n", setup->integrator->name,
                      variants[v].name, (int)steps, largest);
        assert_true(largest < momentum_rounding);
        mf_simulation_clear(&simulation);
    }
    variants_select(&variants[0]);
}

static void test_momentum_stays_zero_when_forces_are_conservative(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_lennard_jones(&fluid, 512, 0.004);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    assert_momentum_stays_zero(&fluid.setup);
    fluid_clear(&fluid);
}

static void test_momentum_stays_zero_when_there_are_friction_and_noise(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 648, 0.04);
    fluid.setup.integrator_parameters = &(struct dpd_verlet_parameters){.lambda = 0.65};
    assert_momentum_stays_zero(&fluid.setup);
    fluid_clear(&fluid);
    fluid_soft_discs(&fluid, 450, 0.04);
    assert_momentum_stays_zero(&fluid.setup);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_velocity_verlet_keeps_the_energy_when_the_time_step_is_small),
        cmocka_unit_test(test_velocity_verlet_is_of_second_order_when_the_time_step_is_halved),
        cmocka_unit_test(test_momentum_stays_zero_when_forces_are_conservative),
        cmocka_unit_test(test_momentum_stays_zero_when_there_are_friction_and_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
