// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"
#include "bench/bench_case.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static void test_bench_median_and_spread_ignore_the_order(void **state) {
    (void)state;
    const double odd[] = {5, 1, 4, 2, 3}, even[] = {8, 2, 4, 6}, one[] = {7};
    assert_identical(mf_bench_median(odd, 5), 3);
    assert_identical(mf_bench_spread(odd, 5), 4.0 / 3);
    assert_identical(mf_bench_median(even, 4), 5);
    assert_identical(mf_bench_spread(even, 4), 6.0 / 5);
    assert_identical(mf_bench_median(one, 1), 7);
    assert_identical(mf_bench_spread(one, 1), 0);
    assert_true(isnan(mf_bench_median(one, 0)));
    assert_true(isnan(mf_bench_spread(one, 0)));
}

static void test_bench_case_result_is_what_the_sums_say(void **state) {
    (void)state;
    struct bench_result result;
    const struct bench_case bench = {
        .simulation.particles.count = 1000,
        .how = {.isa = "portable", .precision = "double", .threads = 2},
        .steps = 50,
        .repeats = 3,
        .list_builds = 30,
        .ticks = {[SIMULATION_MOTION] = 100, [SIMULATION_LIST] = 300, [SIMULATION_FORCES] = 600},
        .ticks_total = 8000000000,
        .rate = {20, 10, 16},
        .seconds = 4,
        .in_range = 3 * 5000,
        .listed = 3 * 8000,
        .places = 3 * 10000,
        .temperature = 3 * 0.7,
    };
    mf_bench_case_result(&bench, "name", &result);
    assert_string_equal(result.scene, "name");
    assert_string_equal(result.isa, "portable");
    assert_string_equal(result.precision, "double");
    assert_identical(result.threads, 2);
    assert_identical(result.steps_per_second, 16);
    assert_identical(result.steps_per_second_best, 20);
    assert_close(result.steps_per_second_spread, 10.0 / 16, 1e-12);
    assert_identical(result.particle_steps_per_second, 16000);
    assert_identical(result.pairs_per_second, 80000);
    assert_close(result.ns_per_pair, 12500, 1e-9);
    assert_close(result.ticks_per_pair, 25000, 1e-9); // at 2 GHz
    assert_close(result.phase_share[SIMULATION_FORCES], 0.6, 1e-12);
    assert_close(result.list_efficiency, 0.625, 1e-12);
    assert_close(result.row_filling, 0.8, 1e-12);
    assert_identical(result.steps_per_build, 5);
    assert_close(result.temperature, 0.7, 1e-12);
    assert_string_equal(result.lammps_style, "");
    assert_true(isnan(result.lammps_ratio));
}

/// Pairs by brute force, and the temperature that a lattice would lose as it melts.
static void test_bench_case_counts_pairs_and_keeps_the_temperature(void **state) {
    (void)state;
    struct fluid fluid;
    struct bench_case bench;
    struct bench_result result;
    const struct bench_how how = {"portable", "mixed", 1, 0.01};
    fluid_lennard_jones(&fluid, 400, 0.002);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    const struct bench_scene scene = {.name = "scene", .scene = {.setup = fluid.setup}};
    assert_ok(mf_bench_case_begin(&bench, &scene, &how));
    assert_ok(mf_bench_case_repeat(&bench));
    double pairs = 0;
    const struct particles *particles = &bench.simulation.particles;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++) {
                const double length = particles->box.length[d];
                const double x = particles->position[d][i] - particles->position[d][j];
                square += pow(x - length * round(x / length), 2);
            }
            pairs += square < 2.5 * 2.5;
        }
    assert_ok(mf_bench_case_repeat(&bench));
    mf_bench_case_result(&bench, "scene", &result);
    assert_close_relative(result.pairs, pairs, 0.03); // the mean of two moments
    assert_close_relative(result.temperature, 0.7, 0.2);
    assert_in_range(result.list_efficiency * 100, 30, 100);
    assert_in_range(result.row_filling * 1000, 500, 999); // some rows are not full
    assert_close(result.phase_share[0] + result.phase_share[1] + result.phase_share[2], 1, 1e-12);
    assert_true(bench.steps >= 1); // as many as the machine finds time for
    mf_bench_case_clear(&bench);
    fluid_clear(&fluid);
}

static void test_bench_case_begin_refuses_kernels_that_are_not_there(void **state) {
    (void)state;
    struct bench_case bench;
    const struct bench_scene scene = {.name = "scene"};
    const struct bench_how how = {"avx1024", "mixed", 1, 0.01};
    assert_fails(mf_bench_case_begin(&bench, &scene, &how), STATUS_BAD_INPUT,
                 "this processor lacks avx1024");
    mf_bench_case_clear(&bench);
}

static size_t lines_of(const char *text) {
    size_t count = 0;
    for (; *text; text++)
        count += *text == '\n';
    return count;
}

/// A line for each part that the scene has or lacks, behind two that say what they are, and a row
/// in the table.
static void check_skips(bool dissipative, bool remembers, size_t parts) {
    struct fluid fluid;
    struct bench_scene scene = {.name = "tiny"};
    const struct bench_how how = {mf_simd_name(), "mixed", 1, 1e-4};
    char text[2048] = "", rows[2048] = "";
    fluid_groot_warren(&fluid, 100, 0.04);
    if (!dissipative) {
        fluid.setup.omega = NULL;
        fluid.setup.integrator = &mf_velocity_verlet;
    }
    if (remembers) {
        fluid.setup.integrator = &mf_aboba;
        fluid.setup.memory.modes = 1;
        fluid.setup.memory.mode[0] =
            (struct pair_memory_mode){.omega = fluid.setup.omega, .time = 0.4};
    }
    scene.scene.setup = fluid.setup;
    FILE *out = fmemopen(text, sizeof text, "w"), *table = fmemopen(rows, sizeof rows, "w");
    assert_non_null(out);
    assert_non_null(table);
    assert_ok(mf_bench_skips(out, table, &scene, &how));
    fclose(out);
    fclose(table);
    assert_int_equal(lines_of(text), 2 + parts);
    assert_int_equal(lines_of(rows), parts);
    assert_contains(text, "tiny: 100 particles");
    assert_contains(text, "g(r) at every step");
    assert_int_equal(strstr(text, "memory") != NULL, remembers);
    assert_contains(rows, "a new neighbour list at every step\tyes\t");
    double with, without, added, error;
    assert_int_equal(sscanf(strstr(rows, "step\tyes\t"), "step\tyes\t%lf\t%lf\t%lf\t%lf", &with,
                            &without, &added, &error),
                     4);
    assert_true(error > 0); // means and medians of five rounds of noise
    assert_true(fabs(without / with - 1 - added) < 5 * error);
    fluid_clear(&fluid);
}

static void test_bench_skips_has_a_line_for_each_part_of_the_scene(void **state) {
    (void)state;
    check_skips(true, false, 4);
    check_skips(true, true, 5);
    check_skips(false, false, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bench_median_and_spread_ignore_the_order),
        cmocka_unit_test(test_bench_case_result_is_what_the_sums_say),
        cmocka_unit_test(test_bench_case_counts_pairs_and_keeps_the_temperature),
        cmocka_unit_test(test_bench_case_begin_refuses_kernels_that_are_not_there),
        cmocka_unit_test(test_bench_skips_has_a_line_for_each_part_of_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
