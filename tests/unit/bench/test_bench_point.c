// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which integrators suit a scene, the bins of its g(r), and a point run twice.
#include "bench/bench_point.h"
#include "dynamics/aboba.h"
#include "dynamics/dpd_verlet.h"

#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include "base/memory.h"

static const struct table some_omega;

static void test_scene_with_friction_gets_all_that_know_it(void **state) {
    (void)state;
    struct bench_method methods[BENCH_MAX_METHODS];
    const struct simulation_setup setup = {.omega = &some_omega, .integrator = &mf_dpd_verlet};
    const size_t count = mf_bench_methods(&setup, methods);
    assert_int_equal(count, 7);
    assert_string_equal(methods[0].name, "dpd-verlet(0.5)");
    assert_string_equal(methods[1].name, "dpd-verlet(0.65)");
    const struct dpd_verlet_parameters *parameters = methods[1].parameters;
    assert_true(parameters->lambda == 0.65);
    for (size_t k = 0; k < count; k++)
        assert_true(methods[k].integrator->dissipative);
    assert_ptr_equal(mf_bench_reference_method(methods, count)->integrator, &mf_aboba);
}

static void test_scene_without_friction_gets_velocity_verlet(void **state) {
    (void)state;
    struct bench_method methods[BENCH_MAX_METHODS];
    const struct simulation_setup setup = {.integrator = &mf_velocity_verlet};
    assert_int_equal(mf_bench_methods(&setup, methods), 1);
    assert_ptr_equal(mf_bench_reference_method(methods, 1)->integrator, &mf_velocity_verlet);
}

static void test_parameters_of_the_scene_are_kept_and_others_are_the_usual(void **state) {
    (void)state;
    struct bench_method methods[BENCH_MAX_METHODS];
    struct simulation_setup setup = {.omega = &some_omega, .integrator = &mf_aboba_implicit};
    const struct aboba_parameters parameters = {.tolerance = 0.125};
    setup.integrator_parameters = &parameters;
    for (size_t k = mf_bench_methods(&setup, methods); k-- > 0;)
        if (methods[k].integrator == &mf_aboba_implicit)
            assert_ptr_equal(methods[k].parameters, &parameters);
    setup.integrator = &mf_aboba;
    for (size_t k = mf_bench_methods(&setup, methods); k-- > 0;)
        if (methods[k].integrator == &mf_aboba_implicit)
            assert_null(methods[k].parameters);
}

static void test_bins_reach_the_cutoff_and_join_the_core(void **state) {
    (void)state;
    const struct box box = {3, {10, 10, 10}};
    const struct bench_bins bins = mf_bench_bins_choose(&box, 3000, 1); // mean distance 0.693
    assert_int_equal(bins.fine.count, 14);
    assert_close(mf_rdf_bins_range(&bins.fine), 1, 1e-12);
    assert_int_equal(bins.core, 3);
    assert_int_equal(bins.count, 12);
    const struct bench_bins tiny = mf_bench_bins_choose(&box, 3000, 0.01);
    assert_int_equal(tiny.fine.count, 2);
    assert_int_equal(tiny.count, 2);
}

static void count_steps(void *context, uint64_t steps) {
    *(uint64_t *)context += steps;
}

static void run(struct bench_point *point, double time_step, double time,
                const struct simulation_setup *setup) {
    static struct bench_method methods[BENCH_MAX_METHODS];
    uint64_t steps = 0;
    const size_t count = mf_bench_methods(setup, methods);
    const struct bench_common common = {.setup = setup,
                                        .bins = mf_bench_bins_choose(&setup->box, 81, 1),
                                        .report = count_steps,
                                        .context = &steps};
    *point = (struct bench_point){.method = mf_bench_reference_method(methods, count),
                                  .time_step = time_step,
                                  .time = time,
                                  .seed = 5};
    const uint64_t planned = mf_bench_point_steps(&common, point);
    assert_ok(mf_bench_point_run(&common, point));
    if (point->status == STATUS_OK)
        assert_int_equal(steps, planned);
}

static void test_point_has_the_same_bits_twice_and_sensible_numbers(void **state) {
    (void)state;
    struct fluid fluid;
    struct bench_point first, second;
    fluid_groot_warren(&fluid, 81, 0.02);
    run(&first, 0.02, 20, &fluid.setup);
    run(&second, 0.02, 20, &fluid.setup);
    assert_int_equal(first.status, STATUS_OK);
    assert_true(first.cpu.value > 0);
    // False alarm: none in a million, with standard errors of 0.01 and 0.1.
    assert_close(first.quantity[BENCH_TEMPERATURE].value, 1, 0.1);
    assert_close(first.quantity[BENCH_PRESSURE].value, 23.7, 1);
    // 0.290(3) with many particles, less in a small box, with a standard error of 0.03.
    assert_close(first.quantity[BENCH_DIFFUSION].value, 0.25, 0.15);
    assert_in_range((int)(1e4 * first.quantity[BENCH_DIFFUSION].error), 20, 1000);
    assert_memory_equal(first.quantity, second.quantity, sizeof first.quantity);
    assert_memory_equal(first.g, second.g, 12 * sizeof *first.g);
    mf_memory_free(first.g);
    mf_memory_free(second.g);
    fluid_clear(&fluid);
}

static void test_short_point_has_no_diffusion_coefficient(void **state) {
    (void)state;
    struct fluid fluid;
    struct bench_point point;
    fluid_groot_warren(&fluid, 81, 0.02);
    run(&point, 0.02, 5, &fluid.setup);
    assert_int_equal(point.status, STATUS_OK);
    assert_true(isfinite(point.quantity[BENCH_PRESSURE].value));
    assert_true(isnan(point.quantity[BENCH_DIFFUSION].value));
    mf_memory_free(point.g);
    fluid_clear(&fluid);
}

static void test_unstable_point_is_a_result(void **state) {
    (void)state;
    struct fluid fluid;
    struct bench_point point;
    fluid_groot_warren(&fluid, 81, 0.02);
    run(&point, 1, 20, &fluid.setup);
    assert_int_equal(point.status, STATUS_UNSTABLE);
    mf_memory_free(point.g);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene_with_friction_gets_all_that_know_it),
        cmocka_unit_test(test_scene_without_friction_gets_velocity_verlet),
        cmocka_unit_test(test_parameters_of_the_scene_are_kept_and_others_are_the_usual),
        cmocka_unit_test(test_bins_reach_the_cutoff_and_join_the_core),
        cmocka_unit_test(test_point_has_the_same_bits_twice_and_sensible_numbers),
        cmocka_unit_test(test_short_point_has_no_diffusion_coefficient),
        cmocka_unit_test(test_unstable_point_is_a_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
