// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forces from outside against equipartition. Seeds are fixed; each comparison allows 4.5 standard
// errors, a false alarm in 150,000.
#include "base/statistics.h"
#include "dynamics/brownian.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/watched.h"

#include <math.h>

static const double deviations = 4.5;

struct trap {
    double stiffness[3], centre[3];
};

/// Measure a setup in a trap.
static struct thermodynamics_summary measure(const struct simulation_setup *setup,
                                             const struct trap *trap,
                                             const struct measure_plan *plan) {
    struct simulation_setup trapped = *setup;
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    double temperature;
    trapped.interaction[0] = (struct interaction_choice){&mf_harmonic_trap, trap};
    trapped.interactions = 1;
    assert_ok(mf_simulation_init(&simulation, &trapped, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, plan, &temperature, NULL));
    const struct watched watched = {.thermodynamics = &thermodynamics};
    assert_ok(watched_sample(&simulation, plan, watched, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    return s;
}

/// An ideal gas with the friction of pairs, whose centre of mass swings on its own, as nothing acts
/// on it but the trap. It begins within 0.1 of the centre, with no momentum, in d degrees of
/// freedom of d N: equipartition gives the others ½ k_B T each.
static void test_ideal_gas_in_a_trap_has_equipartition(void **state) {
    (void)state;
    enum { COUNT = 300 };
    static const struct trap trap = {{8, 5, 12}, {2.5, 2.5, 2.5}};
    const struct measure_plan plan = {.equilibration = 4000, .samples = 600, .every = 20};
    struct fluid fluid;
    fluid_ideal_gas(&fluid, 3, COUNT, 0.01);
    fluid.setup.placement.kind = PLACEMENT_LATTICE;
    fluid.setup.integrator = &mf_aboba;
    fluid.setup.temperature_limit = 100; // they fall into it
    const struct thermodynamics_summary s = measure(&fluid.setup, &trap, &plan);
    const double expected = 1.5 * (1 - 1.0 / COUNT);
    print_message("energy in the trap %.4f(%.4f), by equipartition %.4f\n", s.potential_energy,
                  s.potential_energy_error, expected);
    assert_true(s.potential_energy_error < 0.02);
    assert_close(s.potential_energy, expected,
                 deviations * s.potential_energy_error + 0.05 / COUNT);
    fluid_clear(&fluid);
}

/// Soft particles pressed together in a trap: the temperature by the positions is that of the pairs
/// in the field of the trap, and without its forces it would be too high by far.
static void test_trapped_drop_has_the_temperature_by_its_positions(void **state) {
    (void)state;
    static const struct trap trap = {{3, 3, 3}, {0, 0, 0}};
    const struct measure_plan plan = {.equilibration = 2000, .samples = 200, .every = 20};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 300, 0.01);
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = 10;
    fluid.setup.integrator = &mf_aboba;
    fluid.setup.temperature_limit = 1000;
    const struct thermodynamics_summary s = measure(&fluid.setup, &trap, &plan);
    print_message("a drop: kinetic %.4f(%.4f), configurational %.4f(%.4f)\n", s.temperature,
                  s.temperature_error, s.temperature_configurational,
                  s.temperature_configurational_error);
    assert_close(s.temperature_configurational, 1,
                 deviations * s.temperature_configurational_error + 0.01);
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    fluid_clear(&fluid);
}

/// Pulled by a force F and held by a spring k, the Gaussian moves by F/k. The other axis does not
/// notice.
static void test_uniform_force_shifts_a_trap_by_force_over_stiffness(void **state) {
    (void)state;
    enum { COUNT = 500, SAMPLES = 200 };
    static const struct trap trap = {{10, 10, 0}, {2.5, 2.5, 0}};
    static const struct { double force[3]; } pull = {{0, -4, 0}};
    static const struct brownian_parameters parameters = {.friction = 1};
    struct fluid fluid;
    struct simulation simulation;
    struct running_mean mean[2] = {{0}};
    fluid_ideal_gas(&fluid, 2, COUNT, 0.1);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_brownian;
    fluid.setup.integrator_parameters = &parameters;
    fluid.setup.temperature_limit = 100;
    fluid.setup.interaction[0] = (struct interaction_choice){&mf_uniform_force, &pull};
    fluid.setup.interaction[1] = (struct interaction_choice){&mf_harmonic_trap, &trap};
    fluid.setup.interactions = 2;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 100));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_simulation_run(&simulation, 10));
        for (int d = 0; d < 2; d++)
            for (size_t k = 0; k < COUNT; k++)
                mf_statistics_add(&mean[d],
                                  box_nearest(simulation.particles.position[d][k] - 2.5, 5));
    }
    const double error = sqrt(0.1 / (COUNT * SAMPLES));
    print_message("shift %.4f and %.4f, by force over stiffness 0 and -0.4(%.4f)\n", mean[0].mean,
                  mean[1].mean, error);
    assert_close(mean[0].mean, 0, deviations * error);
    assert_close(mean[1].mean, -0.4, deviations * error);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ideal_gas_in_a_trap_has_equipartition),
        cmocka_unit_test(test_trapped_drop_has_the_temperature_by_its_positions),
        cmocka_unit_test(test_uniform_force_shifts_a_trap_by_force_over_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
