// SPDX-License-Identifier: GPL-3.0-or-later
//
// A simulation that goes on with another temperature and time step.
#include "dynamics/simulation_change.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/remembering.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 300, STEPS = 12 };

static const struct simulation_change other = {0, 1.7, 0.013};

static void by_id(const struct particles *particles, double place[3][COUNT]) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            place[d][particles->id[k]] = particles->position[d][k];
}

/// Begun with one temperature and time step and changed before its first step, a simulation is the
/// one that begins with the others: same places, and velocities sqrt(T) times the same numbers. All
/// that is left between them are roundings.
static void compare(const struct simulation_setup *setup) {
    struct simulation changed, begun;
    struct simulation_setup wanted = *setup;
    wanted.temperature = other.temperature;
    wanted.time_step = other.time_step;
    struct simulation_setup before = *setup;
    before.skin = wanted.skin = 0.3; // sweeps depend on the order of the list
    assert_ok(mf_simulation_init(&changed, &before, NULL));
    assert_ok(mf_simulation_init(&begun, &wanted, NULL));
    assert_ok(mf_simulation_change(&changed, &other));
    assert_ok(mf_simulation_run(&changed, STEPS));
    assert_ok(mf_simulation_run(&begun, STEPS));
    static double place[2][3][COUNT];
    by_id(&changed.particles, place[0]);
    by_id(&begun.particles, place[1]);
    double moved = 0;
    for (int d = 0; d < setup->box.dimensions; d++)
        for (size_t k = 0; k < COUNT; k++) {
            const double edge = setup->box.length[d], x = place[0][d][k] - place[1][d][k];
            assert_close(x - edge * round(x / edge), 0, 1e-6);
            moved += fabs(begun.particles.velocity[d][k]);
        }
    assert_true(moved > 0);
    mf_simulation_clear(&changed);
    mf_simulation_clear(&begun);
}

static void test_changed_simulation_is_the_one_that_begins_so(void **state) {
    (void)state;
    for (size_t n = 0; mf_integrator_list[n]; n++) {
        const struct integrator *integrator = mf_integrator_list[n];
        struct fluid fluid;
        if (integrator->events || integrator->solvent_particles || !integrator->dissipative)
            continue;
        fluid_groot_warren(&fluid, COUNT, 0.02);
        fluid.setup.integrator = integrator;
        fluid.setup.precision = PAIR_DOUBLE;
        compare(&fluid.setup);
        fluid_clear(&fluid);
    }
}

static void test_brownian_particles_change(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, COUNT, 0.002);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_brownian_euler;
    fluid.setup.precision = PAIR_DOUBLE;
    compare(&fluid.setup);
    fluid_clear(&fluid);
}

static void test_pairs_that_remember_change(void **state) {
    (void)state;
    struct remembering r;
    remembering_make(&r, COUNT, 0.02, REMEMBERING_SLOW | REMEMBERING_RATTLE | REMEMBERING_ACROSS);
    r.fluid.setup.precision = PAIR_DOUBLE;
    compare(&r.fluid.setup);
    remembering_clear(&r);
}

/// ⟨z²⟩ is k_B T: what pairs remember is of the new temperature at once.
static void test_what_pairs_remember_is_scaled(void **state) {
    (void)state;
    struct remembering r;
    struct simulation simulation;
    size_t variables;
    remembering_make(&r, COUNT, 0.02, REMEMBERING_SLOW);
    assert_ok(mf_simulation_init(&simulation, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 3));
    const double before = remembering_energy(&simulation.memory, &variables);
    assert_true(before > 0);
    assert_ok(mf_simulation_change(&simulation, &other));
    assert_close_relative(remembering_energy(&simulation.memory, &variables),
                          before * other.temperature / r.fluid.setup.temperature, 1e-12);
    mf_simulation_clear(&simulation);
    remembering_clear(&r);
}

static void expect_refusal(const struct simulation *simulation,
                           const struct simulation_change *change, const char *why) {
    assert_int_equal(mf_simulation_check_change(simulation, change), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), why);
}

static void test_what_cannot_change_is_refused(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, COUNT, 0.02);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    expect_refusal(&simulation, &(struct simulation_change){0, 0, 0.02}, "temperature: 0");
    expect_refusal(&simulation, &(struct simulation_change){0, NAN, 0.02}, "temperature:");
    expect_refusal(&simulation, &(struct simulation_change){0, 1, -1}, "time_step: -1");
    expect_refusal(&simulation, &(struct simulation_change){0, 1, INFINITY}, "time_step:");
    // Friction and noise alone hold a temperature; the time step is the integrator's.
    simulation.setup.omega = NULL;
    simulation.setup.integrator = &mf_velocity_verlet;
    expect_refusal(&simulation, &(struct simulation_change){0, 2, 0.02}, "there is no thermostat");
    assert_ok(mf_simulation_check_change(&simulation, &(struct simulation_change){0, 1, 0.01}));
    simulation.setup.integrator = &mf_event_driven;
    expect_refusal(&simulation, &(struct simulation_change){0, 1, 0.01}, "\"event-driven\"");
    simulation.setup.integrator = fluid.setup.integrator;
    simulation.setup.omega = fluid.setup.omega;
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_changed_simulation_is_the_one_that_begins_so),
        cmocka_unit_test(test_brownian_particles_change),
        cmocka_unit_test(test_pairs_that_remember_change),
        cmocka_unit_test(test_what_pairs_remember_is_scaled),
        cmocka_unit_test(test_what_cannot_change_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
