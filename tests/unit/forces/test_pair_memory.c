// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction that remembers: what it conserves, a pair against its exact law, and that its variables
// depend on the motion alone: not on the list, the threads, or a restart.
#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/remembering.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>

enum { ALL = REMEMBERING_SLOW | REMEMBERING_RATTLE | REMEMBERING_ACROSS };

/// Standard errors that a mean may be off: one false alarm in 15,000, with fixed seeds.
static const double deviations = 4;

/// A fluid at rest, whose velocities and variables alone change.
static void begin(struct simulation *simulation, struct pair_memory *memory,
                  const struct simulation_setup *setup) {
    const struct pair_memory_scene scene = {setup->composition, setup->temperature,
                                            setup->time_step, setup->seed};
    assert_ok(mf_simulation_init(simulation, setup, NULL));
    assert_ok(mf_pair_memory_init(memory, &setup->memory, &scene));
    assert_ok(mf_pair_memory_follow(memory, &simulation->particles, &simulation->neighbours, 0));
}

static double extended_energy(const struct simulation *simulation,
                              const struct pair_memory *memory) {
    size_t variables;
    return mf_particles_kinetic_energy(&simulation->particles) +
           mf_pair_memory_energy(memory, &variables);
}

/// Σ r × v about the middle of the box, along z.
static double angular_momentum(const struct particles *particles) {
    double sum = 0;
    for (size_t k = 0; k < particles->count; k++)
        sum += particles->position[0][k] * particles->velocity[1][k] -
               particles->position[1][k] * particles->velocity[0][k];
    return sum;
}

/// A memory that never fades has no noise: what particles lose, pairs have.
static void test_rotations_conserve_energy_and_momentum(void **state) {
    (void)state;
    struct remembering r;
    struct simulation simulation;
    struct pair_memory memory;
    remembering_make(&r, 400, 0.02, REMEMBERING_SLOW | REMEMBERING_RATTLE);
    for (int m = 0; m < 2; m++)
        r.fluid.setup.memory.mode[m].time = 1e15;
    for (int k = 0; k < 2 * TABLE_INTERVALS; k++) { // g = ω/sqrt(τ) shall be felt
        r.slow.coefficient[k] *= 1e8;
        r.rattle.coefficient[k] *= 1e8;
    }
    begin(&simulation, &memory, &r.fluid.setup);
    mf_pair_memory_sweep(&memory, &simulation.particles, 1);
    const double energy = extended_energy(&simulation, &memory);
    const double kinetic = mf_particles_kinetic_energy(&simulation.particles);
    for (uint64_t step = 2; step < 22; step++)
        mf_pair_memory_sweep(&memory, &simulation.particles, step);
    assert_close_relative(extended_energy(&simulation, &memory), energy, 1e-6);
    assert_true(fabs(mf_particles_kinetic_energy(&simulation.particles) - kinetic) > 1);
    for (int d = 0; d < 3; d++)
        assert_close(mf_particles_mean_velocity(&simulation.particles, d), 0, 1e-15);
    mf_pair_memory_clear(&memory);
    mf_simulation_clear(&simulation);
    remembering_clear(&r);
}

/// Three beads in the middle of a large box, none of whose pairs crosses its edge.
static void test_memory_keeps_angular_momentum_and_transverse_friction_does_not(void **state) {
    (void)state;
    double position[3][3] = {{2, 2.5, 2.2}, {2, 2.1, 2.6}, {2, 2, 2.1}};
    double velocity[3][3] = {{1, -2, 1}, {-0.5, 1, -0.5}, {2, 0, -2}};
    for (int across = 0; across < 2; across++) {
        struct remembering r;
        struct simulation simulation;
        struct pair_memory memory;
        remembering_make(&r, 3, 0.02, across ? ALL : ALL - REMEMBERING_ACROSS);
        struct simulation_setup *setup = &r.fluid.setup;
        struct simulation_start start = {{position[0], position[1], position[2]},
                                         {velocity[0], velocity[1], velocity[2]}};
        setup->box = (struct box){3, {5, 5, 5}};
        setup->placement = (struct placement){.count = 3, .kind = PLACEMENT_FILE};
        const struct pair_memory_scene scene = {setup->composition, 1, 0.02, 1};
        assert_ok(mf_simulation_init(&simulation, setup, &start));
        assert_ok(mf_pair_memory_init(&memory, &setup->memory, &scene));
        assert_ok(mf_pair_memory_follow(&memory, &simulation.particles, &simulation.neighbours, 0));
        const double before = angular_momentum(&simulation.particles);
        const double kinetic = mf_particles_kinetic_energy(&simulation.particles);
        for (uint64_t step = 1; step < 20; step++)
            mf_pair_memory_sweep(&memory, &simulation.particles, step);
        const double change = fabs(angular_momentum(&simulation.particles) - before);
        assert_true(fabs(mf_particles_kinetic_energy(&simulation.particles) - kinetic) > 0.1);
        assert_true(across ? change > 0.01 : change < 1e-5); // e is in single precision
        mf_pair_memory_clear(&memory);
        mf_simulation_clear(&simulation);
        remembering_clear(&r);
    }
}

/// Two beads that stay where they are, 0.4 apart, as a linear process: with s = u/√2 and G = √2 g,
/// ds = G z dt, dz = −G s dt − z dt/τ + noise, of which ⟨s(0) s(t)⟩ = k_B T e^(−t/2τ)
/// (cos νt + sin νt/(2ντ)), ν² = G² − 1/(4τ²): that of a damped oscillator.
static void check_pair(double time_step, double *variance, double *correlation, double lag) {
    enum { SAMPLES = 400000 };
    static double s[SAMPLES];
    double place[2] = {1, 1.4}, zero[2] = {0, 0};
    struct remembering r;
    struct simulation simulation;
    struct pair_memory memory;
    remembering_make(&r, 2, time_step, REMEMBERING_SLOW);
    struct simulation_setup *setup = &r.fluid.setup;
    struct simulation_start start = {{place, zero, zero}, {zero, zero, zero}};
    setup->box = (struct box){3, {5, 5, 5}};
    setup->placement = (struct placement){.count = 2, .kind = PLACEMENT_FILE};
    const struct pair_memory_scene scene = {setup->composition, 1, time_step, 3};
    assert_ok(mf_simulation_init(&simulation, setup, &start));
    assert_ok(mf_pair_memory_init(&memory, &setup->memory, &scene));
    assert_ok(mf_pair_memory_follow(&memory, &simulation.particles, &simulation.neighbours, 0));
    for (uint64_t step = 0; step < SAMPLES; step++) {
        mf_pair_memory_sweep(&memory, &simulation.particles, step);
        const double *v = simulation.particles.velocity[0];
        s[step] = M_SQRT1_2 * (v[0] - v[1]);
    }
    const size_t ahead = (size_t)lround(lag / time_step);
    *variance = *correlation = 0;
    for (size_t k = 0; k < SAMPLES; k++)
        *variance += s[k] * s[k] / SAMPLES;
    for (size_t k = 0; k + ahead < SAMPLES; k++)
        *correlation += s[k] * s[k + ahead] / (double)(SAMPLES - ahead);
    mf_pair_memory_clear(&memory);
    mf_simulation_clear(&simulation);
    remembering_clear(&r);
}

static void test_a_pair_follows_its_exact_law(void **state) {
    (void)state;
    static const double time = 0.5, distance = 0.4;
    const double g = 8 * (1 - distance / 0.9) / sqrt(time);
    const double nu = sqrt(2 * g * g - 1 / (4 * time * time));
    const double steps[] = {0.004, 0.02};
    for (int k = 0; k < 2; k++) {
        const double lag = 0.1, rate = 1 / (2 * time);
        const double expected = exp(-rate * lag) * (cos(nu * lag) + rate / nu * sin(nu * lag));
        double variance, correlation;
        check_pair(steps[k], &variance, &correlation, lag);
        // 400000 samples that forget each other in about 2τ: ⟨s²⟩ to sqrt(2 · 2τ/(n Δt)).
        const double error = sqrt(4 * time / (400000 * steps[k]));
        print_message("step %g: variance %.3f (1), correlation %.3f (%.3f), error %.3f\n", steps[k],
                      variance, correlation, expected, error);
        assert_close(variance, 1, deviations * error);
        assert_close(correlation, expected, deviations * error);
        assert_true(fabs(expected) > 0.4);
    }
}

/// The stationary law is kept at any step, here one that turns a pair by a radian.
static void test_a_pair_keeps_its_temperature_at_a_large_step(void **state) {
    (void)state;
    double variance, correlation;
    check_pair(0.1, &variance, &correlation, 1);
    assert_close(variance, 1, deviations * sqrt(4 * 0.5 / (400000 * 0.1)));
}

static void test_variables_do_not_depend_on_the_list(void **state) {
    (void)state;
    struct remembering r;
    struct simulation simulation[2];
    double energy[2];
    size_t variables[2];
    remembering_make(&r, 300, 0.01, ALL);
    r.fluid.setup.precision = PAIR_DOUBLE;
    for (int k = 0; k < 2; k++) {
        r.fluid.setup.skin = k ? 0.1 : 0.4;
        assert_ok(mf_simulation_init(&simulation[k], &r.fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation[k], 60));
        energy[k] = mf_pair_memory_energy(&simulation[k].memory, &variables[k]);
    }
    // The order of pairs differs, and with it velocities after the first sweep, by little.
    assert_true(simulation[1].list_builds > simulation[0].list_builds + 5);
    assert_true(variables[0] > 1000);
    assert_close_relative((double)variables[0], (double)variables[1], 0.02);
    assert_close_relative(energy[0], energy[1], 0.05);
    assert_close_relative(energy[0], 0.5 * (double)variables[0], 0.1);
    for (int k = 0; k < 2; k++)
        mf_simulation_clear(&simulation[k]);
    remembering_clear(&r);
}

static void test_memory_goes_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    struct remembering r;
    struct simulation whole, pieces;
    remembering_make(&r, 300, 0.02, ALL);
    assert_ok(mf_simulation_init(&whole, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_init(&pieces, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&whole, 80));
    assert_ok(mf_simulation_run(&pieces, 33));
    restart_simulation(&pieces);
    assert_ok(mf_simulation_run(&pieces, 47));
    restart_assert_same(&whole, &pieces);
    size_t variables;
    assert_identical(mf_pair_memory_energy(&whole.memory, &variables),
                     mf_pair_memory_energy(&pieces.memory, &variables));
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
    remembering_clear(&r);
}

static void test_memory_has_the_same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    struct remembering r;
    struct simulation alone, shared;
    remembering_make(&r, 3000, 0.02, ALL);
    assert_ok(mf_simulation_init(&alone, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&alone, 30));
    r.fluid.setup.threads = 3;
    assert_ok(mf_simulation_init(&shared, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&shared, 30));
    restart_assert_same(&alone, &shared);
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
    remembering_clear(&r);
}

/// Only pairs whose type has a memory have variables.
static void test_mixtures_have_a_memory_by_pair_type(void **state) {
    (void)state;
    struct remembering r = {0};
    struct table part[6] = {{0}}, mixed;
    struct simulation simulation;
    fluid_mixture(&r.fluid, 600, 0.01);
    remembering_add(&r, &r.fluid.setup, REMEMBERING_SLOW);
    part[1] = r.slow; // A-B
    assert_ok(mf_table_stack(&mixed, part, 6));
    r.fluid.setup.memory.mode[0].omega = &mixed;
    assert_ok(mf_simulation_init(&simulation, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 20));
    const struct pair_memory *memory = &simulation.memory;
    size_t of_type[6] = {0};
    for (size_t n = 0; n < memory->pairs; n++)
        if (!isnan(memory->value[0][n]))
            of_type[mf_composition_pair_of_ids(&r.fluid.setup.composition, memory->low[n],
                                               memory->high[n])]++;
    assert_true(of_type[1] > 100);
    for (int type = 0; type < 6; type++)
        assert_true(type == 1 || of_type[type] == 0);
    mf_simulation_clear(&simulation);
    mf_table_clear(&mixed);
    remembering_clear(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rotations_conserve_energy_and_momentum),
        cmocka_unit_test(test_memory_keeps_angular_momentum_and_transverse_friction_does_not),
        cmocka_unit_test(test_a_pair_follows_its_exact_law),
        cmocka_unit_test(test_a_pair_keeps_its_temperature_at_a_large_step),
        cmocka_unit_test(test_variables_do_not_depend_on_the_list),
        cmocka_unit_test(test_memory_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_memory_has_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_mixtures_have_a_memory_by_pair_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
