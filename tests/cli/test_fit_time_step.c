// SPDX-License-Identifier: GPL-3.0-or-later
//
// The time step of a verification follows from the potential that is verified, not from the target
// for which it was chosen.
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// One iteration leaves the potential with which it began: a wall of beads that is steeper than a
/// target whose g rises slowly lets one think.
#define STEP "\"time_step\": 0.05, "
static const char run[] =
    "{\"seed\": 2, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
    "\"unknowns\": {\"potential\": {\"start\": {\"law\": \"table\", \"file\": \"wall.tsv\"}}},\n"
    "\"scene\": {\"box\": [7, 7, 7], \"particles\": {\"count\": 200}, STEP\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"cutoff\": 2}},\n"
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 20, \"samples\": 10,\n"
    "\"iterations\": 1},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 200, \"samples\": 60, \"every\": 4}}\n";

/// @param[in] step  of the scene, or ""
static void write_inputs(struct temporary_folder *folder, const char *step) {
    enum { ROWS = 60 };
    char target[8192] = "", wall[8192] = "";
    int a = 0, b = 0;
    for (int k = 0; k < ROWS; k++) {
        const double r = (k + 0.5) * 0.05;
        a += snprintf(target + a, sizeof target - (size_t)a, "%.4f %.6f 0.005\n", r,
                      exp(-3 * exp(-r * r / 0.1)));
        b += snprintf(wall + b, sizeof wall - (size_t)b, "%.4f %.8f\n", r,
                      r < 1 ? 500 * pow(1 - r, 2) : 0);
    }
    small_inputs_write(folder, "target.tsv", target, NULL, NULL);
    small_inputs_write(folder, "wall.tsv", wall, NULL, NULL);
    small_inputs_write(folder, "run.json", run, "STEP", step);
}

static void test_step_that_was_left_to_the_program_is_shortened_until_it_holds(void **state) {
    static const char *const tables[] = {"rdf.tsv", "configuration.tsv", "used.json", NULL};
    static struct run_program_result result;
    write_inputs(*state, "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--threads", "1");
    print_message("%s", result.err);
    run_program_assert_code(&result, 1); // one iteration
    const double first = results_number("out/used.json", "scene.time_step");
    const double step = results_number("out/summary.json", "verification_time_step");
    assert_contains(result.err, "time step of the verification: ");
    assert_true(step <= first / 4 && step >= first / 16);
    // Within three standard errors of 120 samples.
    assert_true(fabs(results_number("out/summary.json", "temperature") - 1) < 0.05);
    assert_true(fabs(results_number("out/summary.json", "temperature_configurational") - 1) < 0.15);
    assert_null(strstr(result.err, "warning: the "));
    // As long a time in shorter steps.
    assert_true(results_number("out/summary.json", "verification_steps") ==
                2 * (200 + 60 * 4) * first / step);
    // What used.json says comes to the same, whatever the threads.
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 1);
    results_assert_same("out", "again", tables);
    assert_true(results_number("again/summary.json", "verification_time_step") == step);
    // An engine that is given the result takes the step that was found.
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    char *script = temporary_folder_read("lammps/in.mesofit");
    const char *of_engine = strstr(script, "timestep ");
    assert_non_null(of_engine);
    // As long, or shorter by the rule of the export.
    const double taken = strtod(of_engine + strlen("timestep "), NULL);
    print_message("time step of the engine %g\n", taken);
    assert_true(taken <= step * 1.001 && taken > step / 4);
    free(script);
}

static void test_step_that_the_file_gives_is_kept_and_what_would_hold_is_told(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "\"time_step\": 0.018, ");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--threads", "1");
    print_message("%s", result.err);
    run_program_assert_code(&result, 1);
    assert_contains(result.err,
                    "time step, 0.018 tau, is too long for this potential; use about 0.0");
    assert_true(results_number("out/summary.json", "verification_time_step") == 0.018);
    // The wall is 7 % too cold by the positions, and its pressure too low: the sign is known.
    assert_contains(result.err, "(at this time step; without it about 0.0");
    assert_true(results_number("out/summary.json", "pressure_of_time_step") < 0);
}

/// A friction weight is found by simulations of candidates, all with the step of the target.
static void test_fit_by_simulations_says_that_its_own_step_was_too_long(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "\"conservative\": {\"law\": \"table\", \"file\": \"wall.tsv\"}");
    small_inputs_change(*state, "run.json",
                        "\"potential\": {\"start\": {\"law\": \"table\", \"file\": \"wall.tsv\"}}",
                        "\"omega\": {\"coefficients\": 3, \"maximum\": 4, \"cutoff\": 2}");
    small_inputs_change(*state, "run.json",
                        "\n\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"cutoff\": 2}", "");
    small_inputs_change(*state, "run.json", "\"name\": \"imc\", \"replicas\": 2,",
                        "\"name\": \"genetic\", \"population\": 4, \"temperature_tolerance\": 1,");
    small_inputs_change(*state, "run.json", "\"iterations\": 1", "\"generations\": 1");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--threads", "1");
    print_message("%s", result.err);
    assert_contains(result.err, "the fit simulated its candidates with the longer time step");
}

/// What a newcomer types first speaks in nm and ps, and no warning stands beside its success.
static void test_first_fit_of_the_readme_has_a_step_that_is_right(void **state) {
    static struct run_program_result result;
    char command[2048], said[2048];
    snprintf(command, sizeof command,
             "PATH=/bin:/usr/bin; sed -n 's|.* && ./mesofit fit \\(.*\\)/run.json$|\\1|p' "
             "'%s/README.md' >named && "
             "mkdir -p runs/first && cp \"%s/$(cat named)/run.json\" runs/first && "
             "ln -s '%s/targets' targets",
             run_program_sources(), run_program_sources(), run_program_sources());
    (void)state;
    assert_int_equal(system(command), 0);
    if (!length_is_long())
        assert_int_equal(
            system("PATH=/bin:/usr/bin; sed -i 's/\"precision\": 0.002/\"precision\": 0.006/; "
                   "s/\"samples\": 100/\"samples\": 50/' runs/first/run.json"),
            0);
    RUN_PROGRAM(&result, "fit", "runs/first/run.json", "-o", "out");
    print_message("%s", result.err);
    run_program_assert_code(&result, 0);
    snprintf(said, sizeof said, "%.20s", result.err);
    assert_contains(said, "nm-ps: ");
    assert_contains(result.err, "result: success");
    assert_null(strstr(result.err, "too long for this potential"));
    assert_null(strstr(result.err, "warning: the"));
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_step_that_was_left_to_the_program_is_shortened_until_it_holds),
        TEST_WITHOUT_FIGURES(test_step_that_the_file_gives_is_kept_and_what_would_hold_is_told),
        TEST_WITHOUT_FIGURES(test_fit_by_simulations_says_that_its_own_step_was_too_long),
        TEST_WITHOUT_FIGURES(test_first_fit_of_the_readme_has_a_step_that_is_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
