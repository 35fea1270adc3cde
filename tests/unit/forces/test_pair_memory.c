// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction that remembers: what it conserves, a pair against its exact law, and that its variables
// depend on the motion alone: not on the list, the threads, or a restart.
#include "base/simd.h"
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
           remembering_energy(memory, &variables);
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
    mf_pair_memory_sweep(&memory, &simulation.particles, 1, NULL);
    const double energy = extended_energy(&simulation, &memory);
    const double kinetic = mf_particles_kinetic_energy(&simulation.particles);
    for (uint64_t step = 2; step < 22; step++)
        mf_pair_memory_sweep(&memory, &simulation.particles, step, NULL);
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
            mf_pair_memory_sweep(&memory, &simulation.particles, step, NULL);
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
        mf_pair_memory_sweep(&memory, &simulation.particles, step, NULL);
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

/// Variable `k` of the pair of two ids; NaN if it has none.
static double value_of(const struct pair_memory_pairs *pairs, uint32_t a, uint32_t b, int k) {
    for (size_t n = 0; n < pairs->count; n++)
        if ((pairs->first_id[n] == a && pairs->second_id[n] == b) ||
            (pairs->first_id[n] == b && pairs->second_id[n] == a))
            return pairs->value[k][n];
    return NAN;
}

static void test_pairs_take_their_variables_to_another_list(void **state) {
    (void)state;
    struct remembering r;
    struct simulation simulation;
    struct neighbours other;
    remembering_make(&r, 300, 0.01, ALL);
    assert_ok(mf_simulation_init(&simulation, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 60));
    struct pair_memory *memory = &simulation.memory;
    const struct box *box = &simulation.particles.box;
    assert_ok(mf_neighbours_init(&other, NEIGHBOURS_HALF, box, 300,
                                 mf_pair_memory_range(&memory->law), 0.05));
    assert_ok(mf_neighbours_sort_and_build(&other, &simulation.particles));
    assert_ok(mf_pair_memory_follow(memory, &simulation.particles, &other, memory->builds + 1));
    assert_true(memory->pairs.count < memory->before.count);
    size_t known = 0;
    for (size_t n = 0; n < memory->pairs.count; n++)
        for (int k = 0; k < memory->variables; k++) {
            const double was =
                value_of(&memory->before, memory->pairs.first_id[n], memory->pairs.second_id[n], k);
            const double is = memory->pairs.value[k][n];
            assert_true(is == was || (isnan(is) && isnan(was)));
            known += !isnan(is);
        }
    assert_true(known > 1000);
    mf_neighbours_clear(&other);
    mf_simulation_clear(&simulation);
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
    assert_identical(remembering_energy(&whole.memory, &variables),
                     remembering_energy(&pieces.memory, &variables));
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
    for (size_t n = 0; n < memory->pairs.count; n++)
        if (!isnan(memory->pairs.value[0][n]))
            of_type[mf_composition_pair_of_ids(&r.fluid.setup.composition,
                                               memory->pairs.first_id[n],
                                               memory->pairs.second_id[n])]++;
    assert_true(of_type[1] > 100);
    for (int type = 0; type < 6; type++)
        assert_true(type == 1 || of_type[type] == 0);
    mf_simulation_clear(&simulation);
    mf_table_clear(&mixed);
    remembering_clear(&r);
}

/// Velocities of a fluid after some sweeps, by id.
static void sweep_some(const struct simulation_setup *setup, double (*velocity)[3]) {
    struct simulation simulation;
    struct pair_memory memory;
    begin(&simulation, &memory, setup);
    for (uint64_t step = 1; step < 6; step++)
        mf_pair_memory_sweep(&memory, &simulation.particles, step, NULL);
    const struct particles *particles = &simulation.particles;
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < 3; d++)
            velocity[particles->id[k]][d] = particles->velocity[d][k];
    mf_pair_memory_clear(&memory);
    mf_simulation_clear(&simulation);
}

/// All instances of the loop do the same, to the rounding of floats; the portable one is in plain
/// C.
static void test_instruction_sets_agree(void **state) {
    (void)state;
    enum { COUNT = 600 };
    static const char *const sets[] = {"avx2", "avx512"};
    static double wanted[COUNT][3], found[COUNT][3];
    const char *before = mf_simd_name();
    for (int mixed = 0; mixed < 2; mixed++) {
        struct remembering r = {0};
        if (mixed) {
            fluid_mixture(&r.fluid, COUNT, 0.01);
            remembering_add(&r, &r.fluid.setup, ALL);
        } else {
            remembering_make(&r, COUNT, 0.01, ALL);
        }
        assert_true(mf_simd_select("portable"));
        sweep_some(&r.fluid.setup, wanted);
        for (int s = 0; s < 2; s++) {
            if (!mf_simd_select(sets[s]))
                continue;
            sweep_some(&r.fluid.setup, found);
            for (int k = 0; k < COUNT; k++)
                for (int d = 0; d < 3; d++)
                    assert_close(found[k][d], wanted[k][d], 2e-5);
        }
        remembering_clear(&r);
    }
    assert_true(mf_simd_select(before));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rotations_conserve_energy_and_momentum),
        cmocka_unit_test(test_memory_keeps_angular_momentum_and_transverse_friction_does_not),
        cmocka_unit_test(test_a_pair_follows_its_exact_law),
        cmocka_unit_test(test_a_pair_keeps_its_temperature_at_a_large_step),
        cmocka_unit_test(test_pairs_take_their_variables_to_another_list),
        cmocka_unit_test(test_memory_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_memory_has_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_mixtures_have_a_memory_by_pair_type),
        cmocka_unit_test(test_instruction_sets_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
