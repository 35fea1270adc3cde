// SPDX-License-Identifier: GPL-3.0-or-later
//
// Orientations, self-propulsion and polar alignment against a double loop; the same bits through
// threads and restarts.
#include "dynamics/brownian.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"
#include "system/orientation.h"

#include <math.h>

static const struct { double force; } propulsion = {3};
static const struct { double coupling, range; } alignment = {1.5, 1.3};
static const struct brownian_parameters parameters = {1, 2, 0.5};

static void make(struct fluid *fluid, int64_t count, const struct integrator *integrator) {
    fluid_soft_discs(fluid, count, 0.002);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = integrator;
    fluid->setup.integrator_parameters = &parameters;
    fluid->setup.interaction[0] = (struct interaction_choice){&mf_self_propulsion, &propulsion};
    fluid->setup.interaction[1] = (struct interaction_choice){&mf_polar_alignment, &alignment};
    fluid->setup.interactions = 2;
}

/// Against the C library, far from 0, too.
static void test_polarity_is_cosine_and_sine(void **state) {
    (void)state;
    double worst = 0;
    for (int n = -400000; n <= 400000; n++) {
        const double angle = n * (n % 3 ? 0.0137 : 2.4);
        double cosine, sine;
        orientation_polarity(angle, &cosine, &sine);
        worst = fmax(worst, fmax(fabs(cosine - cos(angle)), fabs(sine - sin(angle))));
    }
    print_message("largest error of a cosine or sine: %.1e\n", worst);
    assert_true(worst < 5e-15);
}

/// −J Σ sin(θ_i − θ_j) over pairs within the range, of a list that reaches farther.
static void test_torques_are_those_of_a_double_loop(void **state) {
    (void)state;
    enum { COUNT = 500 };
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, COUNT, &mf_brownian);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 100));
    const struct particles *particles = &simulation.particles;
    const struct orientation orientation = mf_orientation_of(particles);
    double total = 0, largest = 0;
    for (size_t i = 0; i < COUNT; i++) {
        double torque = 0;
        for (size_t j = 0; j < COUNT; j++) {
            double square = 0;
            for (int d = 0; d < 2; d++)
                square += pow(box_nearest(particles->position[d][i] - particles->position[d][j],
                                          particles->box.length[d]),
                              2);
            if (square <= alignment.range * alignment.range)
                torque -= alignment.coupling * sin(orientation.angle[i] - orientation.angle[j]);
        }
        assert_close(orientation.torque[i], torque, 1e-12);
        total += orientation.torque[i];
        largest = fmax(largest, fabs(torque));
    }
    assert_close(total, 0, 1e-10);
    assert_true(largest > 1);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// The force of a particle alone is α n, whose n is that without the noise that outlasts a step.
static void test_free_particles_are_pushed_along_their_heading(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, 100, &mf_brownian);
    fluid.setup.potential = NULL;
    fluid.setup.interactions = 1;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 10));
    const struct orientation orientation = mf_orientation_of(&simulation.particles);
    for (size_t k = 0; k < 100; k++) {
        assert_close(simulation.particles.force[0][k], 3 * orientation.heading[0][k], 1e-14);
        assert_close(simulation.particles.force[1][k], 3 * orientation.heading[1][k], 1e-14);
        const double between = acos(orientation.heading[0][k] * orientation.polarity[0][k] +
                                    orientation.heading[1][k] * orientation.polarity[1][k]);
        assert_true(between < 0.5 * 6.4 * sqrt(2 * 0.25 * 0.002)); // of a noise of at most 6.4
    }
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_active_particles_go_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    static const struct integrator *const integrators[] = {&mf_brownian, &mf_brownian_euler};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation whole, pieces;
        make(&fluid, 300, integrators[n]);
        fluid.setup.temperature = n; // without noise of the positions, too
        assert_ok(mf_simulation_init(&whole, &fluid.setup, NULL));
        assert_ok(mf_simulation_init(&pieces, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&whole, 80));
        assert_ok(mf_simulation_run(&pieces, 33));
        restart_simulation(&pieces);
        assert_ok(mf_simulation_run(&pieces, 47));
        restart_assert_same(&whole, &pieces);
        mf_simulation_clear(&whole);
        mf_simulation_clear(&pieces);
        fluid_clear(&fluid);
    }
}

static void test_active_particles_have_the_same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation alone, shared;
    make(&fluid, 5000, &mf_brownian);
    assert_ok(mf_simulation_init(&alone, &fluid.setup, NULL));
    assert_true(alone.neighbours.parts > 1);
    assert_ok(mf_simulation_run(&alone, 20));
    fluid.setup.threads = 2;
    assert_ok(mf_simulation_init(&shared, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&shared, 20));
    restart_assert_same(&alone, &shared);
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
    fluid_clear(&fluid);
}

static void test_orientations_are_refused_where_there_are_none(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, 100, &mf_velocity_verlet);
    fluid.setup.integrator_parameters = NULL;
    assert_fails(mf_simulation_init(&simulation, &fluid.setup, NULL), STATUS_BAD_INPUT,
                 "interactions.self-propulsion: \"velocity-verlet\" turns no orientations");
    fluid_clear(&fluid);
    fluid_groot_warren(&fluid, 100, 0.01);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_brownian;
    fluid.setup.interaction[0] = (struct interaction_choice){&mf_polar_alignment, &alignment};
    fluid.setup.interactions = 1;
    assert_fails(mf_simulation_init(&simulation, &fluid.setup, NULL), STATUS_BAD_INPUT,
                 "interactions.polar-alignment: orientations are of two dimensions, not 3");
    fluid_clear(&fluid);
}

/// Particles that are driven, and that no noise moves, may move far in a step, but not through each
/// other.
static void test_particles_without_noise_are_unstable_when_they_leap(void **state) {
    (void)state;
    static const struct { double force; } slow = {1}, wild = {3000};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        make(&fluid, 300, &mf_brownian);
        fluid.setup.temperature = 0;
        fluid.setup.interaction[0].parameters = n == 0 ? &slow : &wild;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        if (n == 0)
            assert_ok(mf_simulation_run(&simulation, 50));
        else
            assert_fails(mf_simulation_run(&simulation, 50), STATUS_UNSTABLE, "mean squared step");
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_polarity_is_cosine_and_sine),
        cmocka_unit_test(test_torques_are_those_of_a_double_loop),
        cmocka_unit_test(test_free_particles_are_pushed_along_their_heading),
        cmocka_unit_test(test_active_particles_go_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_active_particles_have_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_orientations_are_refused_where_there_are_none),
        cmocka_unit_test(test_particles_without_noise_are_unstable_when_they_leap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
