// SPDX-License-Identifier: GPL-3.0-or-later
//
// Masses that a scene gives: who has which, how they fall, and what knows them.
#include "dynamics/dpd_verlet.h"
#include "observe/maxwell.h"
#include "observe/motion.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 2000 };

/// The standard fluid without friction; masses between `light` and `heavy`.
static void begin(struct fluid *fluid, struct simulation *simulation, double light, double heavy) {
    fluid_groot_warren(fluid, COUNT, 0.01);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
    fluid->setup.precision = PAIR_DOUBLE;
    fluid->setup.attribute[ATTRIBUTES_MASS] =
        (struct attributes_source){.ranges = 1, .range = {{light, heavy}}};
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
}

static void test_masses_are_uniform_and_belong_to_ids(void **state) {
    (void)state;
    static const struct box box = {2, {9, 9, 1}};
    static const struct attributes_source source[ATTRIBUTES_NAMES] = {
        [ATTRIBUTES_MASS] = {.ranges = 1, .range = {{10, 110}}},
        [ATTRIBUTES_STIFFNESS] = {.ranges = 1, .range = {{3, 3}}}};
    const struct composition one = mf_composition_of_one(COUNT);
    struct particles forward, backward;
    assert_ok(mf_particles_init(&forward, &box, COUNT));
    assert_ok(mf_particles_init(&backward, &box, COUNT));
    for (size_t k = 0; k < COUNT; k++)
        backward.id[k] = (uint32_t)(COUNT - 1 - k);
    assert_ok(mf_attributes_give(&forward, source, &one, 7));
    assert_ok(mf_attributes_give(&backward, source, &one, 7));
    const double *mass = particles_masses(&forward), *other = particles_masses(&backward);
    double sum = 0, squares = 0;
    for (size_t k = 0; k < COUNT; k++) {
        assert_in_range((int)mass[k], 10, 110);
        assert_identical(mass[k], other[COUNT - 1 - k]);
        assert_identical(mf_particles_numbers(&forward, "stiffness")[k], 3);
        sum += mass[k];
        squares += (mass[k] - 60) * (mass[k] - 60);
    }
    // Four standard errors of a uniform number's mean and variance: one false alarm in 8,000 seeds.
    assert_close(sum / COUNT, 60, 4 * 100 / sqrt(12.0 * COUNT));
    assert_close(squares / COUNT, 1e4 / 12, 4 * 1e4 / 12 * sqrt(0.8 / COUNT));
    assert_null(mf_particles_numbers(&forward, "radius"));
    mf_particles_clear(&forward);
    mf_particles_clear(&backward);
}

static void test_masses_follow_the_types_of_a_mixture(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    fluid_mixture(&fluid, 300, 0.01);
    fluid.setup.attribute[ATTRIBUTES_MASS] =
        (struct attributes_source){.ranges = 3, .range = {{1, 1}, {5, 5}, {0.5, 0.5}}};
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    static const double expected[] = {1, 5, 0.5};
    for (size_t k = 0; k < simulation.particles.count; k++) {
        const int type = mf_composition_type(&fluid.setup.composition, simulation.particles.id[k]);
        assert_identical(particles_masses(&simulation.particles)[k], expected[type]);
    }
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Friction and noise hold each type at the temperature, whatever its mass, and keep the momentum.
/// T of 500 particles in 100 samples, of which about a half are independent, has a standard error
/// of 0.5 %, and dpd-verlet heats by about 1 % with this time step.
static void check_friction(const struct integrator *integrator, const void *parameters) {
    enum { STEPS = 2000, EVERY = 20, EQUILIBRATION = 1000 };
    static const double mass_of[] = {1, 5, 0.5};
    struct fluid fluid;
    struct simulation simulation;
    double sum[3] = {0}, count[3] = {0};
    fluid_mixture(&fluid, 1500, 0.01);
    fluid.setup.integrator = integrator;
    fluid.setup.integrator_parameters = parameters;
    fluid.setup.attribute[ATTRIBUTES_MASS] =
        (struct attributes_source){.ranges = 3, .range = {{1, 1}, {5, 5}, {0.5, 0.5}}};
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const struct particles *particles = &simulation.particles;
    assert_ok(mf_simulation_run(&simulation, EQUILIBRATION));
    for (int n = 0; n < STEPS; n += EVERY) {
        assert_ok(mf_simulation_run(&simulation, EVERY));
        for (size_t k = 0; k < particles->count; k++) {
            const int type = mf_composition_type(&fluid.setup.composition, particles->id[k]);
            for (int d = 0; d < 3; d++)
                sum[type] += mass_of[type] * particles->velocity[d][k] * particles->velocity[d][k];
            count[type] += 3;
        }
    }
    for (int type = 0; type < 3; type++) {
        print_message("T of mass %g: %.4f\n", mass_of[type], sum[type] / count[type]);
        assert_close(sum[type] / count[type], 1, 0.025);
    }
    for (int d = 0; d < 3; d++) {
        double momentum = 0;
        for (size_t k = 0; k < particles->count; k++)
            momentum += particles_masses(particles)[k] * particles->velocity[d][k];
        assert_close(momentum, 0, 1e-3);
    }
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_masses_with_friction_are_at_the_temperature(void **state) {
    (void)state;
    static const struct dpd_verlet_parameters half = {.lambda = 0.5};
    check_friction(&mf_dpd_verlet, &half);
    check_friction(&mf_aboba, NULL);
}

/// Two particles without a potential in a harmonic trap: x = A cos(ωt), ω = sqrt(k/m). Velocity
/// Verlet has the phase ω t (1 + (ωΔt)²/24).
static void test_masses_swing_with_their_own_periods_in_a_trap(void **state) {
    (void)state;
    enum { STEPS = 1000 };
    static const struct { double stiffness[3], centre[3]; } trap = {{2, 2, 0}, {5, 5, 0}};
    double place[2][2] = {{6, 5}, {5, 4}}, rest[2] = {0, 0}, mass[2] = {0.5, 8};
    const struct simulation_start start = {.position = {place[0], place[1]},
                                           .velocity = {rest, rest}};
    struct simulation simulation;
    struct simulation_setup setup = {
        .box = {2, {10, 10, 1}},
        .composition = mf_composition_of_one(2),
        .placement = {.count = 2, .kind = PLACEMENT_FILE},
        .attribute = {[ATTRIBUTES_MASS] = {.ranges = 1, .range = {{0.5, 8}}, .column = mass}},
        .temperature = 1,
        .time_step = 0.005,
        .temperature_limit = 100,
        .integrator = &mf_velocity_verlet,
        .interaction = {{&mf_harmonic_trap, &trap}},
        .interactions = 1};
    struct table none;
    fluid_no_potential(&none);
    setup.potential = &none;
    assert_ok(mf_simulation_init(&simulation, &setup, &start));
    assert_ok(mf_simulation_run(&simulation, STEPS));
    for (size_t k = 0; k < 2; k++) {
        const uint32_t id = simulation.particles.id[k];
        const double expected = cos(sqrt(trap.stiffness[0] / mass[id]) * STEPS * setup.time_step);
        const double at = simulation.particles.position[id][k] - 5;
        assert_close(id == 0 ? at : -at, expected, 2e-4);
    }
    mf_simulation_clear(&simulation);
    mf_table_clear(&none);
}

static double energy_of(struct simulation *simulation) {
    assert_ok(mf_simulation_compute_potential(simulation));
    return simulation->sums.energy + mf_particles_kinetic_energy(&simulation->particles);
}

static void test_masses_keep_energy_and_momentum_of_a_fluid(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    begin(&fluid, &simulation, 0.5, 20);
    const double before = energy_of(&simulation);
    assert_ok(mf_simulation_run(&simulation, 300));
    assert_close(energy_of(&simulation) / COUNT, before / COUNT, 0.003);
    for (int d = 0; d < 3; d++)
        assert_close(mf_particles_mean_velocity(&simulation.particles, d), 0, 1e-13);
    restart_simulation(&simulation);
    assert_non_null(particles_masses(&simulation.particles));
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Light and heavy halves each have T, and so has what thermodynamics call the temperature. Errors
/// of a chi-square of 3000 numbers are 2.6 %; four of them, and no more, are 10 %.
static void test_masses_begin_in_equilibrium(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    begin(&fluid, &simulation, 1, 9);
    const struct particles *particles = &simulation.particles;
    const double *mass = particles_masses(particles);
    double sum[2] = {0}, numbers[2] = {0};
    for (size_t k = 0; k < COUNT; k++)
        for (int d = 0; d < 3; d++) {
            sum[mass[k] > 5] += mass[k] * particles->velocity[d][k] * particles->velocity[d][k];
            numbers[mass[k] > 5]++;
        }
    assert_close(sum[0] / numbers[0], 1, 0.1);
    assert_close(sum[1] / numbers[1], 1, 0.1);
    assert_close(mf_particles_temperature(particles), 1, 4 * sqrt(2.0 / (3 * COUNT)));
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static double probability_of(const struct particles *particles) {
    struct maxwell maxwell;
    assert_ok(mf_maxwell_init(&maxwell, 1));
    mf_maxwell_sample(&maxwell, particles, 1, 3, 0);
    const double probability = mf_maxwell_result(&maxwell).probability;
    mf_maxwell_clear(&maxwell);
    return probability;
}

/// Fixed seed, one false alarm in 1000.
static void test_masses_are_known_to_the_test_of_velocities(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    begin(&fluid, &simulation, 0.2, 20);
    assert_true(probability_of(&simulation.particles) > 1e-3);
    mf_particles_draw_velocities(&simulation.particles, PARTICLES_NORMAL, 1, 5);
    assert_true(probability_of(&simulation.particles) < 1e-6);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// All four starts have the kinetic temperature that was asked for, and their own fourth moment:
/// 3 for normal numbers, 9/5 for uniform ones, 1 for signs.
static void test_masses_may_begin_out_of_equilibrium(void **state) {
    (void)state;
    static const double fourth[] = {
        [PARTICLES_NORMAL] = 3, [PARTICLES_UNIFORM] = 1.8, [PARTICLES_SIGNS] = 1};
    struct fluid fluid;
    struct simulation simulation;
    begin(&fluid, &simulation, 1, 9);
    for (int speeds = PARTICLES_NORMAL; speeds <= PARTICLES_SIGNS; speeds++) {
        struct particles *particles = &simulation.particles;
        mf_particles_draw_velocities(particles, (enum particles_speeds)speeds, 2, 4);
        double squares = 0, fourths = 0;
        for (size_t k = 0; k < COUNT; k++) {
            const double v = particles->velocity[1][k];
            squares += v * v / COUNT;
            fourths += v * v * v * v / COUNT;
        }
        assert_close(fourths / (squares * squares), fourth[speeds], 0.25);
        assert_close(mf_particles_temperature(particles), 2, 0.2);
        assert_close(squares, 2.0 / 5, 0.06);
        assert_close(mf_particles_mean_velocity(particles, 1), 0, 1e-14);
    }
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Displacements are those from the centre of mass, which rests: particles that fly freely have the
/// MSD 3 T ⟨1/m⟩ t² and the VACF 3 T ⟨1/m⟩.
static void test_masses_are_known_to_displacements(void **state) {
    (void)state;
    static const struct motion_plan plan = {.every = 1, .lags = 4, .origin_every = 1};
    double msd[5], msd_error[5], vacf[5], vacf_error[5];
    const struct motion_curves curves = {msd, msd_error, vacf, vacf_error};
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    begin(&fluid, &simulation, 0.2, 20);
    mf_simulation_clear(&simulation);
    mf_table_clear(&fluid.potential);
    fluid_no_potential(&fluid.potential);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    struct particles *particles = &simulation.particles;
    double expected = 0;
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < COUNT; k++) {
            expected += particles->velocity[d][k] * particles->velocity[d][k] / COUNT;
            particles->velocity[d][k] += 3; // all of them drift
        }
    assert_ok(mf_motion_init(&motion, &plan, &simulation, 0, 20));
    for (int64_t due; (due = mf_motion_due(&motion)) != INT64_MAX;) {
        assert_ok(mf_simulation_run(&simulation, (uint64_t)due - simulation.step));
        mf_motion_sample(&motion, &simulation);
    }
    mf_motion_result(&motion, &curves);
    assert_close_relative(vacf[2], expected, 1e-9);
    assert_close_relative(msd[4], expected * 16e-4, 1e-6);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_masses_are_uniform_and_belong_to_ids),
        cmocka_unit_test(test_masses_follow_the_types_of_a_mixture),
        cmocka_unit_test(test_masses_with_friction_are_at_the_temperature),
        cmocka_unit_test(test_masses_swing_with_their_own_periods_in_a_trap),
        cmocka_unit_test(test_masses_keep_energy_and_momentum_of_a_fluid),
        cmocka_unit_test(test_masses_begin_in_equilibrium),
        cmocka_unit_test(test_masses_are_known_to_the_test_of_velocities),
        cmocka_unit_test(test_masses_may_begin_out_of_equilibrium),
        cmocka_unit_test(test_masses_are_known_to_displacements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
