// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is known exactly of the escape of pairs, and whether errors are what they say.
#include "observe/etd.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <stdlib.h>

enum { PARTICLES = 120, BINS = 10, TIMES = 21, CELLS = BINS * TIMES };

static const struct etd_grid grid = {.r_minimum = 0, .r_maximum = 2, .bins = BINS, .times = TIMES};
static const struct etd_plan plan = {.every = 2, .origin_every = 3};

/// Particles that fly through each other.
static void fly(struct fluid *fluid, struct simulation *simulation, uint64_t seed) {
    fluid_ideal_gas(fluid, 3, PARTICLES, 0.02);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
    fluid->setup.seed = seed;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
}

static void sample(struct etd *etd, struct simulation *simulation) {
    while (mf_etd_due(etd) != INT64_MAX) {
        assert_ok(mf_simulation_run(simulation, (uint64_t)mf_etd_due(etd) - simulation->step));
        const struct configuration now = mf_configuration_of(simulation);
        assert_ok(mf_etd_sample(etd, &now));
    }
}

static void measure(struct etd *etd, uint64_t seed, int64_t origins) {
    struct fluid fluid;
    struct simulation simulation;
    fly(&fluid, &simulation, seed);
    const int64_t steps = 2 * (TIMES - 1 + 3 * (origins - 1));
    assert_ok(mf_etd_init(etd, &grid, &plan, &simulation, 0, steps));
    assert_int_equal(etd->origins, origins);
    sample(etd, &simulation);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Pairs of a bin, and those of them that stay, along the straight lines of their flight.
static void follow_lines(const struct simulation *simulation, double begun[BINS],
                         double stay[CELLS]) {
    const struct particles *p = &simulation->particles;
    for (size_t i = 0; i < PARTICLES; i++)
        for (size_t j = 0; j < i; j++) {
            double first = 0;
            bool inside = true;
            for (int time = 0; time < TIMES && inside; time++) {
                double square = 0;
                for (int d = 0; d < 3; d++) {
                    const double dx = p->position[d][i] - p->position[d][j] +
                                      (p->velocity[d][i] - p->velocity[d][j]) * 0.04 * time;
                    const double nearest = box_nearest(dx, p->box.length[d]);
                    square += nearest * nearest;
                }
                inside = square < 4;
                first = time == 0 ? sqrt(square) : first;
                if (inside && time == 0)
                    begun[(int)(first * 5)] += 1;
                if (inside)
                    stay[time * BINS + (int)(first * 5)] += 1;
            }
        }
}

static void test_etd_is_exact_when_particles_fly_freely(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct etd etd;
    double begun[BINS] = {0}, stay[CELLS] = {0}, survival[CELLS];
    uint64_t pairs[BINS];
    fly(&fluid, &simulation, 1);
    follow_lines(&simulation, begun, stay);
    assert_ok(mf_etd_init(&etd, &grid, &plan, &simulation, 0, 2 * (TIMES - 1)));
    sample(&etd, &simulation);
    assert_ok(mf_etd_result(&(const struct etd *){&etd}, 1, survival, NULL, pairs));
    for (int bin = 0; bin < BINS; bin++) {
        assert_int_equal(pairs[bin], (uint64_t)begun[bin]);
        for (int time = 0; time < TIMES && pairs[bin] > 0; time++)
            assert_close(survival[time * BINS + bin], stay[time * BINS + bin] / begun[bin], 1e-14);
    }
    assert_true(pairs[BINS - 1] > 100);
    assert_true(survival[CELLS - 1] < 0.3);
    mf_etd_clear(&etd);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_etd_begins_with_1_and_falls(void **state) {
    (void)state;
    struct etd etd;
    double survival[CELLS], error[CELLS];
    measure(&etd, 3, 40);
    assert_ok(mf_etd_result(&(const struct etd *){&etd}, 1, survival, error, NULL));
    for (int bin = 0; bin < BINS; bin++) {
        assert_identical(survival[bin], 1.0);
        assert_identical(error[bin], 0.0);
    }
    for (int cell = BINS; cell < CELLS; cell++) {
        assert_true(survival[cell] >= 0 && survival[cell] <= survival[cell - BINS]);
        assert_true(error[cell] >= 0);
    }
    mf_etd_clear(&etd);
}

static void test_etd_result_pools_replicas_and_their_blocks(void **state) {
    (void)state;
    struct etd etd[2];
    double one[2][CELLS], both[CELLS], error[CELLS];
    uint64_t pairs[2][BINS], sum[BINS];
    const struct etd *const list[] = {&etd[0], &etd[1]};
    for (int k = 0; k < 2; k++) {
        measure(&etd[k], 10 + (uint64_t)k, 1);
        assert_ok(mf_etd_result(&list[k], 1, one[k], NULL, pairs[k]));
    }
    assert_ok(mf_etd_result(list, 2, both, error, sum));
    for (int cell = 0; cell < CELLS; cell++) {
        const double n[2] = {(double)pairs[0][cell % BINS], (double)pairs[1][cell % BINS]};
        if (n[0] == 0 || n[1] == 0)
            continue;
        assert_int_equal(sum[cell % BINS], n[0] + n[1]);
        const double mean = (n[0] * one[0][cell] + n[1] * one[1][cell]) / (n[0] + n[1]);
        assert_close(both[cell], mean, 1e-14);
        // Two blocks are too few: as if pairs were independent.
        if (cell >= BINS && (both[cell] == 0 || both[cell] == 1))
            assert_close(error[cell], 1 / (n[0] + n[1] + 1), 1e-14);
        else
            assert_close(error[cell] * error[cell], mean * (1 - mean) / (n[0] + n[1]), 1e-14);
    }
    mf_etd_clear(&etd[0]);
    mf_etd_clear(&etd[1]);
}

/// Four blocks of two replicas, one of them without pairs, against the formula written out.
static void test_etd_result_leaves_out_one_block_at_a_time(void **state) {
    (void)state;
    uint64_t counts[2][4] = {{10, 1, 20, 4}, {30, 12, 0, 0}}; // begun, escaped; the same
    const struct etd_grid small = {.r_minimum = 0, .r_maximum = 1, .bins = 1, .times = 2};
    const struct etd etd[2] = {{.grid = small, .blocks = 2, .counts = counts[0]},
                               {.grid = small, .blocks = 2, .counts = counts[1]}};
    const double without[3] = {1 - 16.0 / 50, 1 - 13.0 / 40, 1 - 5.0 / 30};
    const double mean = (without[0] + without[1] + without[2]) / 3;
    double survival[2], error[2], squares = 0;
    uint64_t pairs;
    assert_ok(
        mf_etd_result((const struct etd *const[]){&etd[0], &etd[1]}, 2, survival, error, &pairs));
    for (int k = 0; k < 3; k++)
        squares += (without[k] - mean) * (without[k] - mean);
    assert_int_equal(pairs, 60);
    assert_close(survival[1], 1 - 17.0 / 60, 1e-15);
    assert_close(error[1], sqrt(squares * 2 / 3), 1e-15);
}

/// A few pairs of which all or none stay, in one block or in each of four, where the jackknife sees
/// no spread: the error p is where Wilson's interval ends, (p − 0)² = p (1 − p)/n. Blocks with half
/// of their pairs each have the binomial error.
static void test_etd_result_has_an_error_when_no_pair_differs(void **state) {
    (void)state;
    enum { BLOCKS = 4 };
    const struct etd_grid small = {.r_minimum = 0, .r_maximum = 1, .bins = 1, .times = 2};
    for (uint64_t pairs = 1; pairs <= 2; pairs++)
        for (size_t blocks = 1; blocks <= BLOCKS; blocks += BLOCKS - 1)
            for (uint64_t escaped = 0; escaped <= pairs; escaped++) {
                uint64_t counts[2 * BLOCKS], begun;
                double survival[2], error[2];
                for (size_t b = 0; b < blocks; b++) {
                    counts[2 * b] = pairs;
                    counts[2 * b + 1] = escaped;
                }
                const struct etd etd = {.grid = small, .blocks = blocks, .counts = counts};
                assert_ok(mf_etd_result(&(const struct etd *){&etd}, 1, survival, error, &begun));
                const double n = (double)begun, p = error[1];
                assert_identical(error[0], 0.0);
                assert_true(p > 0);
                if (escaped == 0 || escaped == pairs)
                    assert_close(n * p * p, p * (1 - p), 1e-15);
                else
                    assert_close(p * p, 0.25 / n, 1e-15);
            }
}

static void test_etd_result_is_not_known_without_pairs(void **state) {
    (void)state;
    // A perfect lattice with a spacing of 1.25 on which nothing moves.
    const struct etd_grid near = {.r_minimum = 1, .r_maximum = 1.5, .bins = 2, .times = 2};
    struct fluid fluid;
    struct simulation simulation;
    struct etd etd;
    double survival[4], error[4];
    uint64_t pairs[2];
    fluid_ideal_gas(&fluid, 3, 64, 0.02);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    fluid.setup.placement.kind = PLACEMENT_LATTICE;
    fluid.setup.placement.jitter = 0;
    fluid.setup.temperature = 1e-12;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_etd_init(&etd, &near, &plan, &simulation, 0, 100));
    assert_ok(mf_etd_result(&(const struct etd *){&etd}, 1, survival, error, pairs));
    assert_true(isnan(survival[1]) && pairs[1] == 0);
    sample(&etd, &simulation);
    assert_ok(mf_etd_result(&(const struct etd *){&etd}, 1, survival, error, pairs));
    assert_int_equal(pairs[0] + pairs[1], etd.origins * 64 * 3);
    assert_true(pairs[0] == 0 || pairs[1] == 0 || isfinite(survival[3]));
    for (int bin = 0; bin < 2; bin++)
        for (int time = 0; time < 2; time++) {
            assert_true(pairs[bin] ? survival[2 * time + bin] == 1
                                   : isnan(survival[2 * time + bin]));
            const double min = time == 0 ? 0 : 1 / (double)(pairs[bin] + 1);
            assert_true(pairs[bin] ? error[2 * time + bin] == min : isnan(error[2 * time + bin]));
        }
    mf_etd_clear(&etd);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// A dense fluid, sampled in windows with gaps that let it forget.
static void measure_fluid(struct etd *etd, uint64_t seed) {
    const struct etd_grid near = {.r_minimum = 0, .r_maximum = 1, .bins = BINS, .times = TIMES};
    const struct etd_plan rare = {.every = 1, .origin_every = 40};
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, 81, 0.04);
    fluid.setup.seed = seed;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 50));
    assert_ok(mf_etd_init(etd, &near, &rare, &simulation, 50, TIMES - 1 + 19 * 40));
    sample(etd, &simulation);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Runs of 10 blocks of 2 origins against their common mean. With 9 degrees of freedom 92 % should
/// lie within two errors; the seeds are fixed, so that there are no false alarms.
static void test_etd_errors_are_what_they_say(void **state) {
    (void)state;
    enum { RUNS = 60 };
    static struct etd etd[RUNS];
    const struct etd *list[RUNS];
    static double all[CELLS], survival[CELLS], error[CELLS];
    int within = 0, cells = 0;
    for (int run = 0; run < RUNS; run++) {
        measure_fluid(&etd[run], 100 + (uint64_t)run);
        list[run] = &etd[run];
    }
    assert_ok(mf_etd_result(list, RUNS, all, NULL, NULL));
    for (int run = 0; run < RUNS; run++) {
        assert_ok(mf_etd_result(&list[run], 1, survival, error, NULL));
        for (int time = 5; time < TIMES; time += 5)
            for (int bin = 5; bin < BINS; bin++, cells++)
                within += fabs(survival[time * BINS + bin] - all[time * BINS + bin]) <
                          2 * error[time * BINS + bin];
        mf_etd_clear(&etd[run]);
    }
    assert_true(within > 0.88 * cells);
    assert_true(within < 0.96 * cells);
}

static void test_etd_init_refuses_what_cannot_be_measured(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct etd etd;
    fly(&fluid, &simulation, 1);
    assert_fails(mf_etd_init(&etd, &grid, &plan, &simulation, 0, 2 * (TIMES - 1) - 1),
                 STATUS_BAD_INPUT, "20 times of 2 steps are longer than the 39 steps");
    const struct etd_grid empty = {.r_minimum = 1, .r_maximum = 1, .bins = 1, .times = 2};
    assert_fails(mf_etd_init(&etd, &empty, &plan, &simulation, 0, 100), STATUS_BAD_INPUT,
                 "r_maximum 1 is not above r_minimum 1");
    const struct etd_grid wide = {.r_minimum = 0, .r_maximum = 2.6, .bins = 1, .times = 2};
    assert_fails(mf_etd_init(&etd, &wide, &plan, &simulation, 0, 100), STATUS_BAD_INPUT,
                 "shortest edge 5 is below twice r_maximum, 2.6");
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_etd_is_exact_when_particles_fly_freely),
        cmocka_unit_test(test_etd_begins_with_1_and_falls),
        cmocka_unit_test(test_etd_result_pools_replicas_and_their_blocks),
        cmocka_unit_test(test_etd_result_leaves_out_one_block_at_a_time),
        cmocka_unit_test(test_etd_result_has_an_error_when_no_pair_differs),
        cmocka_unit_test(test_etd_result_is_not_known_without_pairs),
        cmocka_unit_test(test_etd_errors_are_what_they_say),
        cmocka_unit_test(test_etd_init_refuses_what_cannot_be_measured),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
