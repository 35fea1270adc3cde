// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `mesofit export` says of the dynamics that goes along: on the terminal, in the README and in
// the input file.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"exponent\": EXPONENT},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 200, \"every\": 10},\n"
    "\"motion\": {\"lags\": 50, \"every\": 5}}\n";

/// Beads that hardly see each other: what a bath makes of them is known.
static const char thin_gas[] =
    "{\"seed\": 5, \"box\": [10, 10, 10], \"particles\": {\"count\": 500}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 1e-6},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"exponent\": 0.5},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 50, \"every\": 10}}\n";

static void simulate(struct temporary_folder *folder, const char *scene, const char *exponent) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", scene, exponent ? "EXPONENT" : NULL, exponent);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet", "--force");
    run_program_assert_code(&result, 0);
}

static const char *export_to(const char *engine, const char *option) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "--force", option);
    run_program_assert_code(&result, 0);
    return result.err;
}

static double number_after(const char *text, const char *words) {
    const char *found = strstr(text, words);
    if (found == NULL)
        fail_msg("no %s in %s", words, text);
    return strtod(found + strlen(words), NULL);
}

/// Line of `text` that begins, after blanks and signs of a comment, with `word`.
static void find_line(const char *text, const char *word, char line[512]) {
    for (const char *at = text; at && *at; at = strchr(at, '\n') ? strchr(at, '\n') + 1 : NULL) {
        const char *first = at + strspn(at, " #;");
        if (strncmp(first, word, strlen(word)) == 0) {
            snprintf(line, 512, "%.*s", (int)strcspn(first, "\n"), first);
            return;
        }
    }
    fail_msg("no line %s in %s", word, text);
}

static void test_block_is_printed_and_stands_in_the_files(void **state) {
    static const char *const lines[] = {"friction", "D ", "E(t, r_0)"};
    char printed[512], other[512];
    simulate(*state, soft_fluid, "0.5");
    char *said = strdup(export_to("hoomd", "--dynamics"));
    const char *const files[] = {"hoomd/README", "hoomd/run.py"};
    for (int f = 0; f < 2; f++) {
        char *text = temporary_folder_read(files[f]);
        for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
            find_line(said, lines[k], printed);
            find_line(text, lines[k], other);
            assert_string_equal(printed, other);
        }
        free(text);
    }
    assert_contains(said, "NOT that of the result: a Langevin bath");
    // What takes the time is said before it begins, not on a terminal alone.
    const char *told = strstr(said, "steps of 81 beads, to tell what D is");
    assert_true(told && told < strstr(said, "What of the dynamics"));
    // The one D of the result is that of its summary; what a bath does to it is a share.
    find_line(said, "D ", printed);
    const double diffusion = results_number("out/summary.json", "motion.diffusion_msd");
    assert_true(diffusion > 0 && fabs(number_after(printed, "D ") / diffusion - 1) < 1e-3);
    assert_null(strstr(strstr(printed, "of the result, in that bath"), "+-"));
    free(said);
    // What the summary knows is told without a simulation, which is there for who asks.
    const char *short_one = export_to("gromacs", NULL);
    assert_contains(short_one, "integrator sd");
    assert_null(strstr(short_one, "simulating"));
    find_line(short_one, "D ", printed);
    assert_true(fabs(number_after(printed, "D ") / diffusion - 1) < 1e-3);
    assert_contains(short_one, "export --dynamics simulates what D is in that bath");
    char *settings = temporary_folder_read("gromacs/grompp.mdp");
    assert_contains(settings, "; friction   NOT that of the result");
    free(settings);
    assert_contains(export_to("votca", NULL), "tables are of the potential alone");
}

/// Nothing is simulated, and nothing is lost.
static void test_friction_that_an_engine_has_goes_along(void **state) {
    simulate(*state, soft_fluid, "1");
    const char *said = export_to("espresso", NULL);
    assert_contains(said, "friction   that of the result: dpd with weight_function 1");
    assert_true(strstr(said, " in that bath") == NULL && strstr(said, "NOT") == NULL);
    assert_null(strstr(said, "simulating"));
}

/// Where the configurational temperature is off by chance alone, the step is the result's; where
/// the step makes it wrong, as its samples know, it is shortened: 0.0166 ± 0.0012 by six seeds, 5
/// to 10 errors of 8000 samples; of 500 it is 1.3 to 3.4, which needs luck.
static void test_step_is_shortened_by_what_is_no_chance(void **state) {
    static const char *const measured[] = {"\"time_step\": 0.005, \"measure\": {\"equilibration\": "
                                           "100, \"samples\": 10, \"every\": 5}",
                                           "\"time_step\": 0.08, \"measure\": {\"equilibration\": "
                                           "100, \"samples\": 8000, \"every\": 4}"};
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "scene.json",
                           "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81},\n"
                           "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
                           "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, MEASURED}\n",
                           "MEASURED", measured[k]);
        static struct run_program_result result;
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet", "--force");
        const double off =
            fabs(results_number("out/summary.json", "temperature_configurational") - 1);
        assert_true(off > 0.01); // in both, so that the error alone tells them apart
        export_to("votca", NULL);
        char *readme = temporary_folder_read("votca/README");
        const double step = number_after(readme, "Time step ");
        const double own = number_after(readme, "mesofit's own was ");
        assert_contains(readme, k == 0 ? ": the same, as no temperature shows that it is long."
                                       : ": shorter, as its configurational temperature is off.");
        assert_true(k == 0 ? step == own : step < 0.8 * own);
        free(readme);
    }
}

/// D of the block is the slope of Ornstein's MSD, 2 (T/(m g²)) (g t − 1 + exp(−g t)) along an axis,
/// by least squares over the times that it names: within 4.5 of its errors.
static void test_diffusion_of_the_bath_is_that_of_ornstein(void **state) {
    enum { POINTS = 21 };
    char line[512];
    double sum_t = 0, sum_m = 0, sum_tt = 0, sum_tm = 0;
    simulate(*state, thin_gas, NULL);
    char *said = strdup(export_to("hoomd", "--dynamics"));
    find_line(said, "friction", line);
    const double rate = 1 / number_after(line, "m/gamma = ");
    find_line(said, "D ", line);
    const double from = number_after(line, "MSD from "), to = number_after(line, " to ");
    const double found = number_after(line, "of the result, ");
    const double error = number_after(strstr(line, "of the result, "), "+- ");
    for (int k = 0; k < POINTS; k++) {
        const double t = from + (to - from) * k / (POINTS - 1);
        const double msd = 2 / (rate * rate) * (rate * t - 1 + exp(-rate * t));
        sum_t += t, sum_m += msd, sum_tt += t * t, sum_tm += t * msd;
    }
    const double slope = (POINTS * sum_tm - sum_t * sum_m) / (POINTS * sum_tt - sum_t * sum_t) / 2;
    print_message("D of the bath %g(%g), by Ornstein %g\n", found, error, slope);
    assert_true(fabs(found - slope) < 4.5 * error && error < 0.1 * slope);
    free(said);
}

/// D has one unit in the outputs of a scene, whatever the units of an engine are.
static void test_diffusion_has_the_unit_of_the_scene(void **state) {
    static const char fluid[] =
        "{\"units\": \"nm-ps\", \"seed\": 5, \"box\": [3, 3, 3], \"temperature\": 300,\n"
        "\"particles\": {\"count\": 81, \"mass\": 18}, \"time_step\": 0.02,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 50, \"cutoff\": 1},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 20, \"cutoff\": 1},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 200, \"every\": 10},\n"
        "\"motion\": {\"lags\": 50, \"every\": 5}}\n";
    char line[512];
    simulate(*state, fluid, NULL);
    find_line(export_to("lammps", NULL), "D ", line);
    const double diffusion = results_number("out/summary.json", "motion.diffusion_msd");
    assert_true(diffusion > 0 && fabs(number_after(line, "D ") / diffusion - 1) < 1e-3);
    assert_contains(line, " nm^2/ps of the result");
}

/// A LAMMPS that lists some styles.
static void write_lammps(struct temporary_folder *folder, const char *styles) {
    char path[4096];
    small_inputs_write(folder, "lmp", "#!/bin/sh\necho '* Pair styles:\n\nSTYLES'\n", "STYLES",
                       styles);
    assert_int_equal(chmod("lmp", 0755), 0);
    assert_non_null(getcwd(path, sizeof path));
    setenv("PATH", path, 1);
}

static void test_what_the_lammps_here_lacks_is_told(void **state) {
    char path[4096];
    snprintf(path, sizeof path, "%s", getenv("PATH"));
    simulate(*state, soft_fluid, "0.5");
    const char *said = export_to("lammps", NULL);
    assert_contains(said, "DPD-BASIC; no lmp was found here");
    write_lammps(*state, "buck dpd/ext/tstat/gpu dpd/tstat soft");
    said = export_to("lammps", NULL);
    assert_contains(said,
                    "dpd/ext/tstat, of LAMMPS's package DPD-BASIC; the lmp of this machine lacks");
    assert_contains(said, "NOT that of the result");
    char *text = temporary_folder_read("lammps/in.mesofit");
    assert_contains(text, "variable friction index langevin ");
    free(text);
    write_lammps(*state, "buck dpd/ext/tstat soft");
    said = export_to("lammps", NULL);
    assert_contains(said, "DPD-BASIC; the lmp of this machine has it");
    assert_contains(said, "friction   that of the result: dpd/ext/tstat");
    text = temporary_folder_read("lammps/in.mesofit");
    assert_contains(text, "variable friction index dpd ");
    assert_contains(text, "# friction   that of the result");
    free(text);
    setenv("PATH", path, 1);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_block_is_printed_and_stands_in_the_files),
        TEST(test_friction_that_an_engine_has_goes_along),
        TEST(test_step_is_shortened_by_what_is_no_chance),
        TEST(test_diffusion_of_the_bath_is_that_of_ornstein),
        TEST(test_diffusion_has_the_unit_of_the_scene),
        TEST(test_what_the_lammps_here_lacks_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
