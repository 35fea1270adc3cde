// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit simulate` from outside: its files, the same bits again, interruption, instability.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

/// The fluid of Groot and Warren (1997): density 3, a = 25, sigma^2 = 4.5, time step 0.04.
static const char groot_warren[] =
    "{\"seed\": 5, \"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300},\n"
    "\"time_step\": 0.04, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10},\n"
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}}\n";

#define LONG_MEASURE "\"measure\": {\"equilibration\": 1200, \"samples\": 60, \"every\": 20}"

static const char flat[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [11, 11], \"particles\": {\"count\": 300},\n"
    "\"conservative\": {\"law\": \"gaussian\", \"epsilon\": 2, \"cutoff\": 2.5},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, " LONG_MEASURE "}\n";

#define FORCE_RDF "\"rdf\": {\"estimator\": \"force\", \"range\": 2}, "

/// NVE, with a range of g(r) beyond the cutoff.
static const char conservative[] =
    "{\"seed\": 5, \"box\": [7.3, 7.1, 7.2], \"particles\": {\"count\": 300},\n"
    "\"time_step\": 0.002, \"conservative\": {\"law\": \"lennard-jones\"},\n"
    "\"rdf\": {\"range\": 3.5, \"bins\": 70}, " LONG_MEASURE "}\n";

static const char *const tables[] = {"rdf.tsv", "thermodynamics.tsv", NULL};

/// Diffusion in windows of 24 steps, whose samples do not fall in with the others.
#define MOTION "\"motion\": {\"every\": 3, \"lags\": 8, \"origin_every\": 2}, "
static const char *const moving_tables[] = {"rdf.tsv", "thermodynamics.tsv", "motion.tsv", NULL};

static void write_scene(struct temporary_folder *folder, const char *text, const char *from,
                        const char *to) {
    small_inputs_write(folder, "scene.json", text, from, to);
}

static void simulate(struct run_program_result *result, const char *out) {
    RUN_PROGRAM(result, "simulate", "scene.json", "-o", out);
    run_program_assert_code(result, 0);
}

static void test_simulate_leaves_all_files_of_a_run(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "");
    results_assert_table("out/rdf.tsv", 4, 100);
    results_assert_table("out/thermodynamics.tsv", 9, 20);
    assert_true(temporary_folder_exists("out/used.json"));
    static const char *const numbers[] = {"seconds",
                                          "engine_steps",
                                          "steps_per_second",
                                          "seed",
                                          "temperature",
                                          "temperature_error",
                                          "pressure",
                                          "pressure_error",
                                          "potential_energy",
                                          "temperature_configurational",
                                          "physical.time_unit_ps",
                                          "physical.pressure_bar",
                                          NULL};
    results_assert_numbers("out/summary.json", numbers);
    results_assert_text("out/summary.json", "status", "ok");
    results_assert_number("out/summary.json", "engine_steps", 300);
    results_assert_number("out/summary.json", "seed", 5);
    assert_false(temporary_folder_exists("out/checkpoint.bin"));
}

static const char mixture[] =
    "{\"seed\": 5, \"box\": [4.64, 4.64, 4.64],\n"
    "\"particles\": {\"types\": {\"A\": 120, \"B\": 180}}, \"time_step\": 0.04,\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "  \"B-A\": {\"law\": \"soft-repulsion\", \"a\": 30, \"cutoff\": 0.9},\n"
    "  \"B-B\": {\"law\": \"none\"}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}}\n";
static const char *const mixture_tables[] = {"rdf_A-A.tsv", "rdf_A-B.tsv", "rdf_B-B.tsv",
                                             "thermodynamics.tsv", NULL};

static void test_simulate_leaves_a_table_for_each_pair_type_of_a_mixture(void **state) {
    static struct run_program_result result;
    write_scene(*state, mixture, NULL, NULL);
    simulate(&result, "out");
    for (int k = 0; k < 3; k++) {
        char path[64];
        snprintf(path, sizeof path, "out/%s", mixture_tables[k]);
        results_assert_table(path, 3, 100);
    }
    assert_false(temporary_folder_exists("out/rdf.tsv"));
    char *used = temporary_folder_read("out/used.json");
    assert_contains(used, "\"B\":\t180");
    assert_contains(used, "\"A-B\":");
    assert_null(strstr(used, "\"B-A\":"));
    free(used);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", mixture_tables);
    results_assert_same("out", "again", (const char *const[]){"used.json", NULL});
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "2 types: which curve a pair of the 3 kinds has");
}

static void test_simulate_takes_a_dissipative_law_for_each_pair_type(void **state) {
    static struct run_program_result result;
    write_scene(*state, mixture, NULL, NULL);
    simulate(&result, "one");
    write_scene(*state, mixture, "{\"law\": \"power\", \"sigma\": 2.1213}",
                "{\"A-A\": {\"law\": \"power\", \"sigma\": 2.1213}, \"B-B\": {\"law\": \"power\", "
                "\"sigma\": 2.1213}, \"A-B\": {\"law\": \"power\", \"sigma\": 2.1213}}");
    simulate(&result, "each");
    results_assert_same("one", "each", mixture_tables);
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "each");
    assert_true(temporary_folder_exists("each/rdf.tsv"));
    assert_false(temporary_folder_exists("each/rdf_A-B.tsv"));
}

static void test_simulate_measures_diffusion_when_asked(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "without");
    assert_false(temporary_folder_exists("without/motion.tsv"));
    write_scene(*state, groot_warren, "\"units\"", MOTION "\"units\"");
    simulate(&result, "with");
    results_assert_same("without", "with", tables);
    results_assert_table("with/motion.tsv", 10, 9);
    static const char *const numbers[] = {"motion.diffusion_msd",
                                          "motion.diffusion_msd_error",
                                          "motion.diffusion_green_kubo",
                                          "motion.diffusion_green_kubo_error",
                                          "motion.diffusion_msd_error_cm2_per_s",
                                          "motion.diffusion_green_kubo_cm2_per_s",
                                          "motion.velocities_kolmogorov_smirnov",
                                          "motion.velocities_p_value",
                                          NULL};
    results_assert_numbers("with/summary.json", numbers);
    results_assert_number("with/summary.json", "motion.fit_begin", 0.48);
    results_assert_number("with/summary.json", "motion.fit_end", 0.96);
    results_assert_number("with/summary.json", "motion.velocities_tested", 9 * 900);
    results_assert_number(
        "with/summary.json", "motion.diffusion_msd_cm2_per_s",
        results_number("with/summary.json", "motion.diffusion_msd") *
            results_number("with/summary.json", "physical.diffusion_unit_cm2_per_s"));
    RUN_PROGRAM(&result, "simulate", "with/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("with", "again", moving_tables);
    results_assert_same("with", "again", (const char *const[]){"used.json", NULL});
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "5 time origins, one step in 3");
    RUN_PROGRAM(&result, "describe", "motion");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "origin_every");
}

static void test_simulate_draws_diffusion_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write_scene(*state, groot_warren, "\"units\"", MOTION "\"units\"");
    simulate(&result, "out");
    assert_true(temporary_folder_exists("out/figures/motion.svg"));
    assert_true(temporary_folder_exists("out/figures/motion.png"));
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

static void test_simulate_draws_its_figure_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "out");
    assert_true(temporary_folder_exists("out/figures/simulation.svg"));
    assert_true(temporary_folder_exists("out/figures/simulation.png"));
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

static void test_simulate_draws_all_g_of_a_mixture_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write_scene(*state, mixture, NULL, NULL);
    simulate(&result, "out");
    char *figure = temporary_folder_read("out/figures/simulation.svg");
    assert_contains(figure, "A-A");
    assert_contains(figure, "A-B");
    assert_contains(figure, "B-B");
    free(figure);
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

static void test_used_settings_run_again_give_the_same_bits(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "a/b/one");
    RUN_PROGRAM(&result, "simulate", "a/b/one/used.json", "-o", "two");
    run_program_assert_code(&result, 0);
    results_assert_same("a/b/one", "two", tables);
    results_assert_same("a/b/one", "two", (const char *const[]){"used.json", NULL});
}

static void test_the_seed_of_the_command_line_counts(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "one");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "two", "--seed", "6");
    run_program_assert_code(&result, 0);
    results_assert_number("two/summary.json", "seed", 6);
    results_assert_differ("one", "two", "rdf.tsv");
    write_scene(*state, groot_warren, "\"seed\": 5", "\"seed\": 6");
    simulate(&result, "three");
    results_assert_same("three", "two", tables);
}

/// Every stage has a line, on or off with the reason, and nothing is run or written.
static void test_explain_tells_what_is_on_and_off(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "300 particles: about ");
    assert_contains(result.out, "friction and noise                 on ");
    assert_contains(result.out, "its pairs are kept for aboba");
    assert_contains(result.out, "counted in a pass at the end of one step in 10");
    write_scene(*state, groot_warren, "\"measure\"",
                "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "counted in the force pass of one step in 10");
    write_scene(*state, groot_warren, "\"measure\"", FORCE_RDF "\"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "g(r) from forces                   on ");
    write_scene(*state, conservative, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "friction and noise                 off         no friction");
    assert_contains(result.out, "to 3.5, beyond the forces: a list of its own");
    assert_null(strstr(result.out, "g(r) from forces"));
    assert_false(temporary_folder_exists("out"));
    write_scene(*state,
                "{\"box\": [5, 5, 5], \"particles\": {\"count\": 100},\n"
                "\"dissipative\": {\"law\": \"power\"}}\n",
                NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "conservative force                 off         no potential");
    RUN_PROGRAM(&result, "simulate", "none.json", "--explain");
    run_program_assert_code(&result, 2);
}

static void test_threads_do_not_change_the_bits(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, "4.64, 4.64, 4.64], \"particles\": {\"count\": 300}",
                "6.94, 6.94, 6.94], " MOTION "\"particles\": {\"count\": 1000}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "one", "--threads", "1");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "two", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("one", "two", moving_tables);
}

/// Interrupted again and again at different places, the run ends with the bits of one in peace.
static void check_interruption_of(struct temporary_folder *folder, const char *scene,
                                  const char *from, const char *to, const char *const *expected) {
    static struct run_program_result result;
    write_scene(folder, scene, from, to);
    simulate(&result, "whole");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    assert_false(temporary_folder_exists("pieces/checkpoint.bin"));
    results_assert_same("whole", "pieces", expected);
    results_assert_same("whole", "pieces", (const char *const[]){"used.json", NULL});
}

static void check_interruption(struct temporary_folder *folder, const char *scene, const char *from,
                               const char *to) {
    check_interruption_of(folder, scene, from, to, tables);
}

static void test_interrupted_mixture_goes_on_with_the_same_bits(void **state) {
    check_interruption_of(*state, mixture,
                          "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                          LONG_MEASURE, mixture_tables);
}

static void test_interrupted_dpd_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, groot_warren,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       LONG_MEASURE);
}

static void test_interrupted_diffusion_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, groot_warren,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       MOTION LONG_MEASURE);
    results_assert_same("whole", "pieces", moving_tables);
}

/// Shardlow's step begins with pairs that no checkpoint holds; ABOBA's samples need a force pass of
/// their own.
static void
test_interrupted_dpd_goes_on_with_the_same_bits_when_friction_is_split_off(void **state) {
    check_interruption(*state, flat, "\"seed\": 5",
                       "\"seed\": 5, \"dynamics\": {\"integrator\": \"shardlow\"}");
    check_interruption(*state, flat, "\"seed\": 5",
                       "\"seed\": 5, \"dynamics\": {\"integrator\": \"aboba\"}");
}

static void test_interrupted_dpd_in_the_plane_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, flat, NULL, NULL);
}

static void test_interrupted_force_rdf_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, groot_warren,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       FORCE_RDF LONG_MEASURE);
}

/// The forces of the steps are their own again after a sample, so thermodynamics.tsv stays.
static void test_force_rdf_leaves_the_steps_alone(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "one");
    write_scene(*state, groot_warren, "\"measure\"", FORCE_RDF "\"measure\"");
    simulate(&result, "two");
    results_assert_table("two/rdf.tsv", 6, 100);
    results_assert_same("one", "two", (const char *const[]){"thermodynamics.tsv", NULL});
}

static void test_interrupted_nve_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, conservative, NULL, NULL);
}

static void test_interrupted_run_says_so_and_refuses_other_settings(void **state) {
    static struct run_program_result result;
    const struct run_program_how how = {.interrupt_after = 0.001};
    write_scene(*state, groot_warren, "\"samples\": 20", "\"samples\": 100000");
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", NULL});
    run_program_assert_code(&result, 130);
    assert_contains(result.err, "mesofit: interrupted at step ");
    assert_contains(result.err, "--resume");
    assert_true(temporary_folder_exists("out/checkpoint.bin"));
    assert_false(temporary_folder_exists("out/summary.json"));
    char *used = temporary_folder_read("out/used.json");
    write_scene(*state, groot_warren, "\"samples\": 20", "\"samples\": 100001");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--resume");
    run_program_assert_refused(&result, ".", "other settings", 1,
                               (const char *[]){"checkpoint.bin", "settings have changed", NULL});
    char *used_now = temporary_folder_read("out/used.json");
    assert_string_equal(used, used_now);
    free(used);
    free(used_now);
}

static void test_a_new_run_removes_the_results_of_the_one_before(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "out");
    temporary_folder_write(*state, "out/checkpoint.bin", "old", 3);
    write_scene(*state, groot_warren, "0.04", "4");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 1);
    assert_false(temporary_folder_exists("out/summary.json"));
    assert_false(temporary_folder_exists("out/rdf.tsv"));
    char *saved = temporary_folder_read("out/checkpoint.bin"); // from before the first step
    assert_int_equal(strncmp(saved, "mesofit state", 13), 0);
    free(saved);
}

static void test_unstable_scene_ends_with_step_and_force(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, "0.04", "4");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 1);
    assert_contains(result.err, "mesofit: unstable at step 1: ");
    assert_contains(result.err, "largest force ");
    assert_int_equal(run_program_lines(result.err), 1);
    assert_false(temporary_folder_exists("out/summary.json"));
}

/// Friction too large for the time step: the velocities look right, the structure is wrong.
static void test_simulate_warns_when_only_the_kinetic_temperature_is_right(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "good");
    assert_null(strstr(result.err, "warning: the temperature"));
    write_scene(*state,
                "{\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300},\n"
                "\"time_step\": 0.01, \"dynamics\": {\"integrator\": \"dpd-verlet\"},\n"
                "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
                "\"dissipative\": {\"law\": \"power\", \"sigma\": 14.142}, " LONG_MEASURE "}\n",
                NULL, NULL);
    simulate(&result, "out");
    assert_contains(result.err, "mesofit: warning: the temperature is 1.0");
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "by the positions, not 1: lower");
    free(summary);
}

static void test_quiet_run_says_nothing(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write_scene(*state, groot_warren, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "");
    assert_string_equal(result.err, "");
}

/// A first line, a last one, one with the result, and between them one every five seconds.
static void test_progress_in_a_pipe_is_a_few_plain_lines(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write_scene(*state, groot_warren, NULL, NULL);
    simulate(&result, "out");
    assert_in_range(run_program_lines(result.err), 2, 3 + (size_t)(result.seconds / 5));
    assert_null(strchr(result.err, '\r'));
    assert_null(strchr(result.err, '\033'));
}

/// One sample has no error and no scatter, and is a result all the same.
static void test_one_sample_is_enough(void **state) {
    static struct run_program_result result;
    write_scene(*state, groot_warren, "\"samples\": 20", "\"samples\": 1");
    simulate(&result, "out");
    results_assert_table("out/thermodynamics.tsv", 9, 1);
    results_assert_number("out/summary.json", "engine_steps", 110);
}

static void test_ideal_gas_has_no_configurational_temperature(void **state) {
    static struct run_program_result result;
    write_scene(*state, conservative, "\"conservative\": {\"law\": \"lennard-jones\"}",
                "\"temperature\": 1");
    simulate(&result, "out");
    results_assert_text("out/summary.json", "status", "ok");
    char *table = temporary_folder_read("out/thermodynamics.tsv");
    assert_contains(table, "\tnan\n");
    assert_null(strstr(table, "-nan"));
    free(table);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)
#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_simulate_draws_its_figure_when_gnuplot_is_there),
        TEST(test_quiet_run_says_nothing),
        TEST(test_progress_in_a_pipe_is_a_few_plain_lines),
        TEST_WITHOUT_FIGURES(test_simulate_leaves_all_files_of_a_run),
        TEST(test_simulate_draws_diffusion_when_gnuplot_is_there),
        TEST_WITHOUT_FIGURES(test_simulate_measures_diffusion_when_asked),
        TEST_WITHOUT_FIGURES(test_simulate_leaves_a_table_for_each_pair_type_of_a_mixture),
        TEST_WITHOUT_FIGURES(test_simulate_takes_a_dissipative_law_for_each_pair_type),
        TEST_WITHOUT_FIGURES(test_interrupted_mixture_goes_on_with_the_same_bits),
        TEST(test_simulate_draws_all_g_of_a_mixture_when_gnuplot_is_there),
        TEST_WITHOUT_FIGURES(test_used_settings_run_again_give_the_same_bits),
        TEST_WITHOUT_FIGURES(test_the_seed_of_the_command_line_counts),
        TEST_WITHOUT_FIGURES(test_explain_tells_what_is_on_and_off),
        TEST_WITHOUT_FIGURES(test_threads_do_not_change_the_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_dpd_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_diffusion_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(
            test_interrupted_dpd_goes_on_with_the_same_bits_when_friction_is_split_off),
        TEST_WITHOUT_FIGURES(test_interrupted_dpd_in_the_plane_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_force_rdf_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_force_rdf_leaves_the_steps_alone),
        TEST_WITHOUT_FIGURES(test_interrupted_nve_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_run_says_so_and_refuses_other_settings),
        TEST_WITHOUT_FIGURES(test_a_new_run_removes_the_results_of_the_one_before),
        TEST_WITHOUT_FIGURES(test_unstable_scene_ends_with_step_and_force),
        TEST_WITHOUT_FIGURES(test_simulate_warns_when_only_the_kinetic_temperature_is_right),
        TEST_WITHOUT_FIGURES(test_one_sample_is_enough),
        TEST_WITHOUT_FIGURES(test_ideal_gas_has_no_configurational_temperature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
