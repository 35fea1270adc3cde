// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction that is thin or strong: a pair gets one or two kicks on its way through, so that the
// noise itself must be normal. A uniform ζ leaves the shell below at 0.84 of its temperature.
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"
#include "shared/watched.h"
#include "curves/formula.h"

/// By which either temperature may be off: three to four of their standard errors, with fixed
/// seeds, and the whole of the error of the time step; in short of twice those errors.
static const double temperature_tolerance = 0.01;

/// Of Kolmogorov and Smirnov's test, for each of the integrators.
static const double false_alarm_rate = 1e-4;

static void make_omega(struct fluid *fluid, struct formula_power_omega_parameters parameters) {
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    mf_table_clear(&fluid->omega);
    assert_ok(mf_table_init_omega(&fluid->omega, &curve));
}

static void check_temperatures(const struct simulation_setup *setup) {
    const struct measure_plan plan = {
        .equilibration = 2000, .samples = length_is_long() ? 4000 : 1000, .every = 10};
    const double max = temperature_tolerance * (length_is_long() ? 1 : 2);
    static struct simulation simulation;
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(&simulation, &plan,
                             (struct watched){.thermodynamics = &thermodynamics}, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    print_message("%-15s temperature %.4f(%.4f), configurational %.4f(%.4f)\n",
                  setup->integrator->name, s.temperature, s.temperature_error,
                  s.temperature_configurational, s.temperature_configurational_error);
    assert_close(s.temperature, 1, max);
    assert_close(s.temperature_configurational, 1, max);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
}

/// The standard fluid's potential with ω = 10 from r = 0.97 to 1 alone.
static void test_temperatures_are_set_when_friction_is_a_thin_shell(void **state) {
    (void)state;
    static const struct integrator *const with[] = {&mf_aboba, &mf_shardlow, &mf_aboba_implicit,
                                                    &mf_lowe_andersen};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 375, 0.005);
    make_omega(&fluid, (struct formula_power_omega_parameters){10, 1e-6, 0.97, 1});
    for (int k = 0; k < 4; k++) {
        fluid.setup.integrator = with[k];
        check_temperatures(&fluid.setup);
    }
    fluid_clear(&fluid);
}

/// Samples 0.5 τ apart: with γ = 900 velocities forget each other in less.
static void check_velocities(const struct simulation_setup *setup) {
    enum { SAMPLES = 300, EVERY = 50 };
    static struct simulation simulation;
    struct maxwell maxwell;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_maxwell_init(&maxwell, SAMPLES));
    assert_ok(mf_simulation_run(&simulation, 500));
    for (int n = 0; n < SAMPLES; n++) {
        assert_ok(mf_simulation_run(&simulation, EVERY));
        mf_maxwell_sample(&maxwell, &simulation.particles, setup->temperature, setup->seed,
                          simulation.step);
    }
    const struct maxwell_summary s = mf_maxwell_result(&maxwell);
    print_message("%-15s velocities against Maxwell's: D = %.2e, p = %.2g\n",
                  setup->integrator->name, s.statistic, s.probability);
    assert_true(s.probability > false_alarm_rate);
    mf_maxwell_clear(&maxwell);
    mf_simulation_clear(&simulation);
}

/// σ = 30, γ = 900: in a step of 0.01 a near pair forgets its velocity altogether, and its new one
/// is the noise.
static void test_velocities_are_those_of_maxwell_when_friction_is_strong(void **state) {
    (void)state;
    static const struct integrator *const with[] = {&mf_aboba, &mf_lowe_andersen};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 375, 0.01);
    make_omega(&fluid, (struct formula_power_omega_parameters){30, 1, 0, 1});
    for (int k = 0; k < 2; k++) {
        fluid.setup.integrator = with[k];
        check_velocities(&fluid.setup);
    }
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_temperatures_are_set_when_friction_is_a_thin_shell),
        cmocka_unit_test(test_velocities_are_those_of_maxwell_when_friction_is_strong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
