// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit simulate` from outside: its files, what it says, and how it ends.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void test_simulate_leaves_all_files_of_a_run(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "");
    results_assert_table("out/rdf.tsv", 4, 100);
    results_assert_table("out/thermodynamics.tsv", 10, 20);
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

static double number_after(const char *text, const char *words) {
    const char *found = strstr(text, words);
    if (found == NULL)
        fail_msg("no %s in %s", words, text);
    return strtod(found + strlen(words), NULL);
}

/// R. D. Groot and P. B. Warren (1997) set T = 1 and found a pressure of 23.7 of this fluid; in nm
/// it has other units, and Monte Carlo no velocities.
static void test_simulate_ends_with_temperature_energy_and_pressure(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    assert_true(fabs(number_after(result.err, "T = ") - 1) < 0.05);
    assert_true(fabs(number_after(result.err, "pressure ") / 23.7 - 1) < 0.05);
    const double energy = results_number("out/summary.json", "potential_energy");
    assert_true(fabs(number_after(result.err, "U of a bead = ") / energy - 1) < 0.01);
    small_inputs_write(*state, "scene.json",
                       "{\"units\": \"nm-ps\", \"box\": [2, 2, 2], \"particles\": {\"count\": 20}, "
                       "\"temperature\": 300, \"conservative\": {\"law\": \"soft-repulsion\", "
                       "\"a\": 10, \"cutoff\": 0.7}, \"dynamics\": {\"integrator\": "
                       "\"monte-carlo\"}, \"measure\": {\"samples\": 20}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "walk");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "\nT = "));
    const char *line = strstr(result.err, "U of a bead = ");
    assert_true(line && strstr(line, " kJ/mol, pressure ") && strstr(line, " bar\n"));
}

static void test_simulate_leaves_a_table_for_each_pair_type_of_a_mixture(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_mixture, NULL, NULL);
    small_scenes_simulate(&result, "out");
    for (int k = 0; k < 3; k++) {
        char path[64];
        snprintf(path, sizeof path, "out/%s", small_scenes_mixture_tables[k]);
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
    results_assert_same("out", "again", small_scenes_mixture_tables);
    results_assert_same("out", "again", (const char *const[]){"used.json", NULL});
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "2 types: which curve a pair of the 3 kinds has");
}

/// The address sanitizer keeps a shadow of all memory, in which a limit of addresses leaves no
/// room, and which is counted as the program's.
static void skip_beside_a_shadow(void) {
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
}

/// A liquid of 43 places on the list of a particle.
static void test_simulate_says_what_memory_many_particles_take(void **state) {
    static const double least = 200, most = 700; // bytes
    static struct run_program_result result;
    double megabytes, bytes;
    skip_beside_a_shadow();
    small_inputs_write(*state, "scene.json",
                       "{\"box\": [49.2, 49.2, 49.2], \"particles\": {\"count\": 100000}, "
                       "\"temperature\": 0.7, \"time_step\": 0.005, "
                       "\"conservative\": {\"law\": \"lennard-jones\", \"cutoff\": 2.5}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    const char *line = strstr(result.out, "MB of memory");
    assert_non_null(line);
    while (line > result.out && line[-1] != '\n')
        line--;
    assert_int_equal(sscanf(line, "%lf MB of memory, %lf bytes a particle", &megabytes, &bytes), 2);
    assert_true(bytes >= least);
    assert_true(bytes <= most);
    assert_close_relative(1e6 * megabytes, 1e5 * bytes, 0.02);
}

/// Who asks what a run would cost has not the memory for it: 10^7 particles of the same liquid.
static void test_explain_of_many_particles_takes_no_gigabytes(void **state) {
    double megabytes, bytes;
    skip_beside_a_shadow();
    small_inputs_write(*state, "scene.json",
                       "{\"box\": [228.36, 228.36, 228.36], \"particles\": {\"count\": 10000000}, "
                       "\"temperature\": 0.7, \"time_step\": 0.005, "
                       "\"conservative\": {\"law\": \"lennard-jones\", \"cutoff\": 2.5}}",
                       NULL, NULL);
    assert_int_equal(system("ulimit -v 1000000; \"$MESOFIT\" simulate scene.json --explain > out"),
                     0);
    char *const text = temporary_folder_read("out"), *const line = strstr(text, "\nabout ");
    assert_contains(text, "10000000 particles");
    assert_non_null(line);
    assert_int_equal(
        sscanf(line, " about %lf MB of memory, %lf bytes a particle", &megabytes, &bytes), 2);
    assert_true(megabytes > 2000 && megabytes < 7000);
    assert_close_relative(1e6 * megabytes, 1e7 * bytes, 0.02);
    free(text);
}

static void test_simulate_takes_a_dissipative_law_for_each_pair_type(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_mixture, NULL, NULL);
    small_scenes_simulate(&result, "one");
    small_scenes_write(
        *state, small_scenes_mixture, "{\"law\": \"power\", \"sigma\": 2.1213}",
        "{\"A-A\": {\"law\": \"power\", \"sigma\": 2.1213}, \"B-B\": {\"law\": \"power\", "
        "\"sigma\": 2.1213}, \"A-B\": {\"law\": \"power\", \"sigma\": 2.1213}}");
    small_scenes_simulate(&result, "each");
    results_assert_same("one", "each", small_scenes_mixture_tables);
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "each");
    assert_true(temporary_folder_exists("each/rdf.tsv"));
    assert_false(temporary_folder_exists("each/rdf_A-B.tsv"));
}

static void test_simulate_measures_diffusion_when_asked(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "without");
    assert_false(temporary_folder_exists("without/motion.tsv"));
    small_scenes_write(*state, small_scenes_dpd, "\"units\"", SMALL_SCENES_MOTION "\"units\"");
    small_scenes_simulate(&result, "with");
    results_assert_same("without", "with", small_scenes_tables);
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
    results_assert_same("with", "again", small_scenes_moving_tables);
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
    small_scenes_write(*state, small_scenes_dpd, "\"units\"", SMALL_SCENES_MOTION "\"units\"");
    small_scenes_simulate(&result, "out");
    assert_true(temporary_folder_exists("out/figures/motion.svg"));
    assert_true(temporary_folder_exists("out/figures/motion.png"));
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

static void test_simulate_draws_its_figure_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_true(temporary_folder_exists("out/figures/simulation.svg"));
    assert_true(temporary_folder_exists("out/figures/simulation.png"));
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

/// As many points as the axis has pixels, whatever the run: 12,000 samples would be 1.8 MB.
static void test_figure_of_a_long_run_is_no_larger_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    static const char scene[] =
        "{\"box\": [2.2, 2.2, 2.2], \"particles\": {\"count\": 8}, \"time_step\": 0.02, "
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
        "\"dissipative\": {\"law\": \"power\"}, "
        "\"measure\": {\"equilibration\": 0, \"samples\": 12000, \"every\": 1}}";
    small_inputs_need_gnuplot();
    temporary_folder_write(*state, "scene.json", scene, strlen(scene));
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    char *figure = temporary_folder_read("out/figures/simulation.svg");
    assert_in_range(strlen(figure), 50000, 800000);
    free(figure);
}

static void test_simulate_draws_all_g_of_a_mixture_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    small_scenes_write(*state, small_scenes_mixture, NULL, NULL);
    small_scenes_simulate(&result, "out");
    char *figure = temporary_folder_read("out/figures/simulation.svg");
    assert_contains(figure, "A-A");
    assert_contains(figure, "A-B");
    assert_contains(figure, "B-B");
    free(figure);
    if (strstr(result.err, "warning"))
        fail_msg("%s", result.err);
}

/// Every stage of the engine has a line, on or off with the reason, and every observable that is
/// asked for; nothing is run or written.
static void test_explain_tells_what_is_on_and_off(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "300 particles: about ");
    assert_contains(result.out, "friction and noise                 on ");
    assert_contains(result.out, "its pairs are kept for aboba");
    assert_contains(result.out, "counted in a pass at the end of one step in 10");
    assert_null(strstr(result.out, "structure factor"));
    assert_null(strstr(result.out, "not asked for"));
    small_scenes_write(*state, small_scenes_dpd, "\"measure\"",
                       "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "counted in the force pass of one step in 10");
    small_scenes_write(*state, small_scenes_dpd, "\"measure\"",
                       SMALL_SCENES_FORCE_RDF "\"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "g(r) from forces                   on ");
    small_scenes_write(*state, small_scenes_nve, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "friction and noise                 off         no friction");
    assert_contains(result.out, "to 3.5, beyond the forces: a list of its own");
    assert_null(strstr(result.out, "g(r) from forces"));
    assert_false(temporary_folder_exists("out"));
    small_scenes_write(*state,
                       "{\"box\": [5, 5, 5], \"particles\": {\"count\": 100},\n"
                       "\"dissipative\": {\"law\": \"power\"}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "conservative force                 off         no potential");
    RUN_PROGRAM(&result, "simulate", "none.json", "--explain");
    run_program_assert_code(&result, 2);
}

static void test_unstable_scene_ends_with_step_and_force(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, "0.04", "4");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 1);
    assert_contains(result.err, "mesofit: unstable at step 1: ");
    assert_contains(result.err, "largest force ");
    assert_contains(result.err, "mesofit: warning: time_step: in 4 tau a bead moves 5.8 of");
    assert_int_equal(run_program_lines(result.err), 2);
    assert_false(temporary_folder_exists("out/summary.json"));
}

/// Friction too large for the time step: the velocities look right, the structure is wrong.
static void test_simulate_warns_when_only_the_kinetic_temperature_is_right(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "good");
    assert_null(strstr(result.err, "warning: the temperature"));
    small_scenes_write(
        *state,
        "{\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300},\n"
        "\"time_step\": 0.01, \"dynamics\": {\"integrator\": \"dpd-verlet\"},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 14.142}, " SMALL_SCENES_LONG_MEASURE
        "}\n",
        NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_contains(result.err, "mesofit: warning: the temperature is 1.0");
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "by the positions, not 1: lower");
    free(summary);
}

/// Steps that heat it to twice its temperature, which a quiet run tells as well, as a warning.
static void test_simulate_is_not_ok_when_its_temperature_is_another(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, "0.04", "0.15");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "hot", "--quiet");
    run_program_assert_code(&result, 1);
    assert_contains(result.err, "mesofit: the temperature is ");
    results_assert_text("hot/summary.json", "status", "unconverged");
    small_scenes_write(*state, small_scenes_dpd, "0.04", "0.115");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "warm", "--quiet");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "mesofit: warning: the temperature is ");
    assert_null(strstr(result.err, "steps"));
}

/// A lattice that was hot and cools down for as long as it is sampled: the error of such a mean
/// covers the scene's temperature, too, a third of it.
static void test_simulate_is_not_ok_when_it_cools_down_all_along(void **state) {
    static const char scene[] =
        "{\"seed\": 3, \"units\": \"nm-ps\", \"box\": [2.2, 2.2, 2.2], \"temperature\": 120,\n"
        "\"particles\": {\"count\": 220, \"mass\": 40}, \"time_step\": 0.005,\n"
        "\"conservative\": {\"law\": \"lennard-jones\", \"epsilon\": 1, \"sigma\": 0.34, "
        "\"cutoff\": 0.85},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"cutoff\": 0.5},\n"
        "\"measure\": {\"equilibration\": 1000, \"samples\": 60, \"every\": 50}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "cooling", "--quiet");
    run_program_assert_code(&result, 1);
    assert_contains(result.err, " K, not 120 K, and still changes: equilibrate for longer");
    results_assert_text("cooling/summary.json", "status", "unconverged");
}

/// A lattice whose potential energy becomes heat where nothing takes it away, and a gas without
/// forces, which keeps the temperature that it begins with.
static void test_simulate_ends_with_the_temperature_that_nothing_holds(void **state) {
    static const char lattice[] =
        "{\"seed\": 3, \"units\": \"nm-ps\", \"box\": [2.2, 2.2, 2.2], \"temperature\": 120,\n"
        "\"particles\": {\"count\": 220, \"mass\": 40}, \"time_step\": 0.005,\n"
        "\"conservative\": LAW,\n"
        "\"measure\": {\"equilibration\": 1000, \"samples\": 60, \"every\": 50}}\n";
    static const char words[] = "K, not 120 K: there is no thermostat";
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", lattice, "LAW",
                       "{\"law\": \"lennard-jones\", \"epsilon\": 1, \"sigma\": 0.34, "
                       "\"cutoff\": 0.85}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "hot");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, words);
    assert_true(results_number("hot/summary.json", "temperature") > 1.5 * 120);
    small_inputs_write(*state, "scene.json", lattice, "LAW",
                       "{\"law\": \"soft-repulsion\", \"a\": 1e-6, \"cutoff\": 0.3}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "gas");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, words));
}

/// Trimers whose beads have not yet moved apart, and the same after a while.
static void test_simulate_warns_when_it_has_not_settled(void **state) {
    static const char plan[] = "\"equilibration\": 0, \"samples\": 100, \"every\": 5";
    static const char trimers[] =
        "{\"seed\": 1, \"box\": [4.4, 4.4, 4.4], \"time_step\": 0.01,\n"
        "\"bonds\": {\"bond\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.8}},\n"
        "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 120}},\n"
        "\"molecules\": {\"trimer\": {\"count\": 60, \"chain\": {\"type\": \"A\", \"length\": 3,\n"
        "\"bond\": \"bond\", \"angle\": \"bend\"}}}, \"dissipative\": {\"law\": \"power\"},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 100, \"every\": 5}}\n";
    static struct run_program_result result;
    small_scenes_write(*state, trimers, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_contains(result.err, "mesofit: warning: the potential energy is 2.");
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "in the rest: the run was not in equilibrium; equilibrate for longer");
    free(summary);
    small_scenes_write(*state, trimers, plan,
                       "\"equilibration\": 2000, \"samples\": 100, \"every\": 50");
    small_scenes_simulate(&result, "long");
    assert_null(strstr(result.err, "equilibr"));
}

static void test_quiet_run_says_nothing(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, "");
    assert_string_equal(result.err, "");
}

/// A first line, a last one, two with the result, and between them one every five seconds. The
/// first has no temperature and no rate yet.
static void test_progress_in_a_pipe_is_a_few_plain_lines(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_in_range(run_program_lines(result.err), 2, 4 + (size_t)(result.seconds / 5));
    assert_null(strchr(result.err, '\r'));
    assert_null(strchr(result.err, '\033'));
    small_scenes_write(*state, small_scenes_dpd, "\"equilibration\": 100", "\"equilibration\": 0");
    small_scenes_simulate(&result, "unsettled");
    assert_contains(result.err, "step 0    0 %\n");
}

/// One sample has no error and no scatter, and is a result all the same.
static void test_one_sample_is_enough(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, "\"samples\": 20", "\"samples\": 1");
    small_scenes_simulate(&result, "out");
    results_assert_table("out/thermodynamics.tsv", 10, 1);
    results_assert_number("out/summary.json", "engine_steps", 110);
}

static void test_ideal_gas_has_no_configurational_temperature(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_nve, "\"conservative\": {\"law\": \"lennard-jones\"}",
                       "\"temperature\": 1");
    small_scenes_simulate(&result, "out");
    results_assert_text("out/summary.json", "status", "ok");
    char *table = temporary_folder_read("out/thermodynamics.tsv");
    assert_contains(table, "\tnan\t");
    assert_null(strstr(table, "-nan"));
    free(table);
}

/// Without friction and noise, and not with them or without velocities.
static void test_simulate_warns_when_nothing_holds_the_temperature(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *to;
        bool warned;
    } cases[] = {{"\"skin\": 0.3", true},
                 {"\"dissipative\": {\"law\": \"power\", \"sigma\": 3}", false},
                 {"\"dynamics\": {\"integrator\": \"brownian\"}, \"time_step\": 0.0001", false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "scene.json",
                           "{\"box\": [3, 3, 3], \"particles\": {\"count\": 81},\n"
                           "\"conservative\": {\"law\": \"soft-repulsion\"}, MORE,\n"
                           "\"measure\": {\"equilibration\": 1, \"samples\": 2}}",
                           "MORE", cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.err, "mesofit: warning: there is no thermostat: ") != NULL,
                         cases[k].warned);
    }
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"temperature\": 1",
                       "\"temperature\": 300");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_contains(result.err, "mesofit: warning: temperature: 300 in units of k_B T_0");
    assert_contains(result.err, "give kelvins in \"units\"");
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    static const char warning[] = "mesofit: warning: scene: there is no thermostat: ";
    small_inputs_write(*state, "run.json", small_inputs_run, "\"power\", \"sigma\": 2", "\"none\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit");
    assert_contains(result.err, warning);
    small_inputs_write(*state, "run.json", small_inputs_run,
                       ",\n    \"dissipative\": {\"law\": \"power\", \"sigma\": 2}", "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--force");
    assert_contains(result.err, "chosen: friction omega = ");
    assert_null(strstr(result.err, warning));
}

/// White friction of sigma 3 has D = 0.24; a memory of 0.002 had 0.12 with a step of 0.02, and one
/// of 1e-6 had 0.009.
static void test_simulate_warns_when_steps_do_not_follow_a_memory(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *mode;
        bool warned;
    } cases[] = {{"\"time\": 0.2, \"omega\": {\"law\": \"power\", \"sigma\": 3}", false},
                 {"\"time\": 0.002, \"omega\": {\"law\": \"power\", \"sigma\": 3}", true},
                 {"\"time\": 1e6, \"omega\": {\"law\": \"power\", \"sigma\": 3}", false},
                 {"\"time\": 0.2, \"omega\": {\"law\": \"power\", \"sigma\": 40}", true},
                 {"\"time\": 0.2, \"frequency\": 20, \"omega\": {\"law\": \"power\"}", false},
                 {"\"time\": 0.2, \"frequency\": 300, \"omega\": {\"law\": \"power\"}", true}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "scene.json",
                           "{\"box\": [3, 3, 3], \"particles\": {\"count\": 81},\n"
                           "\"conservative\": {\"law\": \"soft-repulsion\"}, \"time_step\": 0.02,\n"
                           "\"memory\": {\"slow\": {MODE}},\n"
                           "\"measure\": {\"equilibration\": 1, \"samples\": 2}}",
                           "MODE", cases[k].mode);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.err, "\"time_step\" is too long for \"memory\"") != NULL,
                         cases[k].warned);
    }
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
        TEST_WITHOUT_FIGURES(test_simulate_ends_with_temperature_energy_and_pressure),
        TEST_WITHOUT_FIGURES(test_simulate_leaves_a_table_for_each_pair_type_of_a_mixture),
        TEST_WITHOUT_FIGURES(test_simulate_says_what_memory_many_particles_take),
        TEST_WITHOUT_FIGURES(test_explain_of_many_particles_takes_no_gigabytes),
        TEST_WITHOUT_FIGURES(test_simulate_takes_a_dissipative_law_for_each_pair_type),
        TEST(test_figure_of_a_long_run_is_no_larger_when_gnuplot_is_there),
        TEST(test_simulate_draws_all_g_of_a_mixture_when_gnuplot_is_there),
        TEST_WITHOUT_FIGURES(test_explain_tells_what_is_on_and_off),
        TEST_WITHOUT_FIGURES(test_unstable_scene_ends_with_step_and_force),
        TEST_WITHOUT_FIGURES(test_simulate_warns_when_only_the_kinetic_temperature_is_right),
        TEST_WITHOUT_FIGURES(test_simulate_is_not_ok_when_its_temperature_is_another),
        TEST_WITHOUT_FIGURES(test_simulate_is_not_ok_when_it_cools_down_all_along),
        TEST_WITHOUT_FIGURES(test_simulate_ends_with_the_temperature_that_nothing_holds),
        TEST_WITHOUT_FIGURES(test_simulate_warns_when_nothing_holds_the_temperature),
        TEST_WITHOUT_FIGURES(test_simulate_warns_when_steps_do_not_follow_a_memory),
        TEST_WITHOUT_FIGURES(test_simulate_warns_when_it_has_not_settled),
        TEST_WITHOUT_FIGURES(test_one_sample_is_enough),
        TEST_WITHOUT_FIGURES(test_ideal_gas_has_no_configurational_temperature),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
