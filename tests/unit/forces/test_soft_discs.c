// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forces of soft discs against a double loop, for all instruction sets, precisions, boxes and
// distributions of sizes.
#include "base/rng.h"
#include "base/simd.h"
#include "dynamics/simulation.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>

/// A scene of discs without order, which may cover each other.
struct discs {
    struct simulation_setup setup;
    struct {
        double strength;
    } parameters;
};

static void make(struct discs *discs, int64_t count, double width, double height, double smallest,
                 double largest) {
    *discs = (struct discs){
        .setup = {.box = {2, {width, height, 1}},
                  .composition = mf_composition_of_one(count),
                  .placement = {.count = count, .kind = PLACEMENT_RANDOM},
                  .attribute = {[ATTRIBUTES_MASS] = {1, {{10, 110}}, NULL},
                                [ATTRIBUTES_RADIUS] = {1, {{smallest, largest}}, NULL},
                                [ATTRIBUTES_STIFFNESS] = {1, {{0.5, 2}}, NULL}},
                  .temperature = 1,
                  .time_step = 1e-3,
                  .temperature_limit = 1e9,
                  .integrator = &mf_velocity_verlet,
                  .seed = 5},
        .parameters = {1.5}};
    discs->setup.interaction[0] = (struct interaction_choice){&mf_soft_discs, &discs->parameters};
    discs->setup.interactions = 1;
}

/// Forces, energy and virial by the formula, shape [3][count], summed over all pairs.
static void double_loop(const struct simulation *simulation, double strength, double *force,
                        struct pair_sums *sums) {
    const struct particles *p = &simulation->particles;
    const double *radius = mf_particles_numbers(p, "radius");
    const double *stiffness = mf_particles_numbers(p, "stiffness");
    *sums = (struct pair_sums){0};
    for (size_t i = 0; i < p->count; i++)
        for (size_t j = 0; j < p->count; j++) {
            const double dx = box_nearest(p->position[0][i] - p->position[0][j], p->box.length[0]);
            const double dy = box_nearest(p->position[1][i] - p->position[1][j], p->box.length[1]);
            const double dz =
                p->box.dimensions == 3
                    ? box_nearest(p->position[2][i] - p->position[2][j], p->box.length[2])
                    : 0;
            const double r = sqrt(dx * dx + dy * dy + dz * dz), s = radius[i] + radius[j];
            if (i == j || r > s)
                continue;
            const double k = strength * stiffness[i] * stiffness[j];
            const double push = 4 * k * r * (s * s - r * r); // −dU/dr
            force[i] += push * dx / r;
            force[p->count + i] += push * dy / r;
            force[2 * p->count + i] += push * dz / r;
            sums->energy += 0.5 * k * pow(r * r - s * s, 2);
            sums->virial += 0.5 * push * r;
        }
}

/// Compare a simulation with the double loop. `tolerance` is relative to the root mean square of
/// the forces.
static void assert_agrees(const struct discs *discs, double tolerance) {
    struct simulation simulation;
    struct pair_sums expected;
    assert_ok(mf_simulation_init(&simulation, &discs->setup, NULL));
    assert_ok(mf_simulation_compute_potential(&simulation));
    const struct particles *p = &simulation.particles;
    const size_t numbers = (size_t)p->box.dimensions * p->count;
    double *force = mf_memory_zeroed(3 * p->count, sizeof *force), squares = 0;
    assert_non_null(force);
    double_loop(&simulation, discs->parameters.strength, force, &expected);
    for (size_t k = 0; k < numbers; k++)
        squares += force[k] * force[k] / (double)numbers;
    assert_true(expected.energy > 0);
    for (int d = 0; d < p->box.dimensions; d++)
        for (size_t k = 0; k < p->count; k++)
            assert_close(p->force[d][k], force[(size_t)d * p->count + k],
                         tolerance * sqrt(squares));
    assert_close_relative(simulation.sums.energy, expected.energy, tolerance);
    assert_close_relative(simulation.sums.virial, expected.virial, tolerance);
    mf_memory_free(force);
    mf_simulation_clear(&simulation);
}

static void test_soft_discs_forces_are_those_of_a_double_loop(void **state) {
    (void)state;
    static const struct {
        int64_t count;
        double width, height, smallest, largest, depth; // 0: two dimensions
    } scenes[] = {
        {600, 100, 100, 3, 3, 0},     // all alike
        {600, 120, 90, 1, 2.8, 0},    // two classes
        {1000, 60, 200, 0.3, 6, 0},   // five
        {300, 50, 24, 5, 6, 0},       // hardly two cells across
        {7, 40, 40, 2, 10, 0},        // hardly any
        {2000, 1000, 1000, 1, 40, 0}, // thin, sizes differ by forty
        {600, 30, 30, 3, 3, 30},      // spheres
        {1000, 60, 40, 0.3, 6, 25},
    };
    static const char *const sets[] = {"portable", "avx2", "avx512"};
    const char *before = mf_simd_name();
    for (size_t set = 0; set < 3; set++)
        for (size_t n = 0; n < sizeof scenes / sizeof *scenes; n++) {
            struct discs discs;
            if (!mf_simd_select(sets[set]))
                continue;
            make(&discs, scenes[n].count, scenes[n].width, scenes[n].height, scenes[n].smallest,
                 scenes[n].largest);
            if (scenes[n].depth > 0)
                discs.setup.box =
                    (struct box){3, {scenes[n].width, scenes[n].height, scenes[n].depth}};
            assert_agrees(&discs, 3e-6);
            discs.setup.precision = PAIR_DOUBLE;
            assert_agrees(&discs, 1e-12);
        }
    assert_true(mf_simd_select(before));
}

static void test_soft_discs_push_each_other_equally_to_rounding(void **state) {
    (void)state;
    struct discs discs;
    struct simulation simulation;
    make(&discs, 3000, 200, 200, 1, 8);
    assert_ok(mf_simulation_init(&simulation, &discs.setup, NULL));
    for (int d = 0; d < 2; d++) {
        double sum = 0, sizes = 0;
        for (size_t k = 0; k < simulation.particles.count; k++) {
            sum += simulation.particles.force[d][k];
            sizes += fabs(simulation.particles.force[d][k]);
        }
        assert_close(sum / sizes, 0, 1e-7);
    }
    mf_simulation_clear(&simulation);
}

static void test_soft_discs_go_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    struct discs discs;
    struct simulation whole, halves;
    make(&discs, 3000, 200, 200, 1, 8);
    assert_ok(mf_simulation_init(&whole, &discs.setup, NULL));
    assert_ok(mf_simulation_init(&halves, &discs.setup, NULL));
    assert_ok(mf_simulation_run(&whole, 300));
    assert_true(whole.list_builds > 2);
    assert_ok(mf_simulation_run(&halves, 137));
    restart_simulation(&halves);
    assert_ok(mf_simulation_run(&halves, 163));
    restart_assert_same(&whole, &halves);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&halves);
}

static void test_soft_discs_have_the_same_bits_for_any_threads(void **state) {
    (void)state;
    struct discs discs;
    struct simulation simulation[2];
    make(&discs, 3000, 200, 200, 1, 8);
    for (int n = 0; n < 2; n++) {
        discs.setup.threads = n == 0 ? 1 : 3;
        assert_ok(mf_simulation_init(&simulation[n], &discs.setup, NULL));
        assert_ok(mf_simulation_run(&simulation[n], 100));
        simulation[n].wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation[n], 1));
    }
    restart_assert_same(&simulation[0], &simulation[1]);
    assert_identical(simulation[0].sums.energy, simulation[1].sums.energy);
    for (int n = 0; n < 2; n++)
        mf_simulation_clear(&simulation[n]);
}

static void test_soft_discs_refuse_what_they_cannot_do(void **state) {
    (void)state;
    struct discs discs;
    struct simulation simulation;
    make(&discs, 100, 50, 50, 1, 2);
    discs.setup.attribute[ATTRIBUTES_RADIUS].ranges = 0;
    assert_fails(mf_simulation_init(&simulation, &discs.setup, NULL), STATUS_BAD_INPUT,
                 "interactions.soft-discs: needs \"radius\" in \"particles\"");
    make(&discs, 100, 50, 50, 1, 13);
    assert_fails(mf_simulation_init(&simulation, &discs.setup, NULL), STATUS_BAD_INPUT,
                 "interactions.soft-discs: the shortest edge 50 of the box");
    make(&discs, 100, 50, 50, 1, 2);
    discs.setup.box = (struct box){3, {50, 50, 7}};
    assert_fails(mf_simulation_init(&simulation, &discs.setup, NULL), STATUS_BAD_INPUT,
                 "interactions.soft-discs: the shortest edge 7 of the box");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_soft_discs_forces_are_those_of_a_double_loop),
        cmocka_unit_test(test_soft_discs_push_each_other_equally_to_rounding),
        cmocka_unit_test(test_soft_discs_go_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_soft_discs_have_the_same_bits_for_any_threads),
        cmocka_unit_test(test_soft_discs_refuse_what_they_cannot_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
