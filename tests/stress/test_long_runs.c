// SPDX-License-Identifier: GPL-3.0-or-later
//
// A million steps of small systems: drift of the energy, temperature, momentum; single precision
// against double.
#include "base/statistics.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

enum { STEPS = 1000000, BLOCKS = 20 };

static double energy(struct simulation *simulation) {
    simulation->wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(simulation, 1));
    simulation->wants = PAIR_FORCES;
    return simulation->sums.energy + 0.5 * mf_particles_square_velocities(&simulation->particles);
}

static double largest_momentum(const struct particles *particles) {
    double largest = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double sum = 0;
        for (size_t k = 0; k < particles->count; k++)
            sum += particles->velocity[d][k];
        largest = fmax(largest, fabs(sum));
    }
    return largest;
}

/// The energy of velocity Verlet at Δt = 0.002 wavers by some 1e-4 of a particle's and does not
/// drift; a million additions of 1e-16 each, at worst all in the same direction, are the momentum.
static void test_nve_keeps_its_energy_for_a_million_steps(void **state) {
    (void)state;
    for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++) {
        struct fluid fluid;
        struct simulation simulation;
        fluid_lennard_jones(&fluid, 112, 0.002);
        fluid.setup.omega = NULL;
        fluid.setup.integrator = &mf_velocity_verlet;
        fluid.setup.precision = precision;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 1000));
        const double before = energy(&simulation);
        assert_ok(mf_simulation_run(&simulation, STEPS));
        const double drift = (energy(&simulation) - before) / 112;
        print_message("precision %d: drift %.2g a particle in 2000 tau, momentum %.2g\n", precision,
                      drift, largest_momentum(&simulation.particles));
        assert_close(drift, 0, 2e-3);
        assert_close(largest_momentum(&simulation.particles), 0, 1e-8);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// A million steps of Δt = 0.01, in blocks that are much longer than anything remembers.
static struct running_mean long_temperature(struct simulation_setup *setup) {
    struct simulation simulation;
    struct running_mean blocks = {0};
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 1000));
    for (int block = 0; block < BLOCKS; block++) {
        double sum = 0;
        for (int k = 0; k < STEPS / BLOCKS / 10; k++) {
            assert_ok(mf_simulation_run(&simulation, 10));
            sum += mf_particles_temperature(&simulation.particles);
        }
        mf_statistics_add(&blocks, sum / (STEPS / BLOCKS / 10.0));
    }
    print_message("%s, precision %d: T %.4f(%.4f), momentum %.2g\n", setup->integrator->name,
                  setup->precision, blocks.mean, mf_statistics_standard_error(&blocks),
                  largest_momentum(&simulation.particles));
    assert_close(largest_momentum(&simulation.particles), 0, 1e-8);
    mf_simulation_clear(&simulation);
    return blocks;
}

/// At Δt = 0.01 no integrator is off by 1 %; the statistical error is some 0.1 %.
static void test_dpd_keeps_temperature_and_momentum_for_a_million_steps(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.01);
    for (size_t k = 0; mf_integrator_list[k]; k++) {
        if (!mf_integrator_list[k]->dissipative)
            continue;
        struct running_mean runs[2];
        fluid.setup.integrator = mf_integrator_list[k];
        for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++) {
            fluid.setup.precision = precision;
            runs[precision] = long_temperature(&fluid.setup);
            assert_close(runs[precision].mean, 1, 0.015);
        }
        const double error =
            hypot(mf_statistics_standard_error(&runs[0]), mf_statistics_standard_error(&runs[1]));
        assert_close(runs[0].mean, runs[1].mean, 4 * error);
    }
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nve_keeps_its_energy_for_a_million_steps),
        cmocka_unit_test(test_dpd_keeps_temperature_and_momentum_for_a_million_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
