// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit export` of fits: numbers that were found stand in the tables, and so does a friction
// weight.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/// A soft fluid whose escape times are the target.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 60, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2}}\n";

static const char fit[] =
    "{\"seed\": 3, \"target\": {\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": "
    "\"target/etd_error.tsv\", \"r_minimum\": 0.4, \"r_maximum\": 0.9}},\n"
    "\"unknowns\": {UNKNOWNS},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}FRICTION},\n"
    "\"method\": {\"name\": \"genetic\", \"population\": 7, \"generations\": 2, "
    "\"equilibration\": 10, \"samples\": 4, \"every\": 8, \"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static void fit_and_export(struct temporary_folder *folder, const char *unknowns,
                           const char *friction) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, "UNKNOWNS", unknowns);
    char *text = temporary_folder_read("run.json");
    small_inputs_write(folder, "run.json", text, "FRICTION", friction);
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--force"); // that need not converge
    const bool good = result.code == 0;
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "-o", "lammps", "--force");
    run_program_assert_code(&result, 0);
    assert_int_equal(strstr(result.err, "warning: fit: the fit is ") == NULL, good);
}

/// The number after `words` in a file.
static double number_after(const char *path, const char *words) {
    char *text = temporary_folder_read(path);
    const char *found = strstr(text, words);
    if (found == NULL)
        fail_msg("%s has no %s", path, words);
    const double number = strtod(found + strlen(words), NULL);
    free(text);
    return number;
}

static void test_numbers_that_were_found_are_exported(void **state) {
    fit_and_export(*state,
                   "\"numbers\": {\"dissipative.sigma\": {\"minimum\": 1, \"maximum\": 8}, "
                   "\"conservative.a\": {\"minimum\": 10, \"maximum\": 60}}",
                   ", \"dissipative\": {\"law\": \"power\", \"sigma\": 5}");
    const double sigma = results_parameter("fit/summary.json", "dissipative.sigma", "value");
    const double a = results_parameter("fit/summary.json", "conservative.a", "value");
    const double gamma = number_after("lammps/in.mesofit", "pair_coeff 1 1 dpd/tstat ");
    assert_true(fabs(sigma - 5) > 1e-6 && fabs(gamma / (sigma * sigma) - 1) < 1e-6);
    // Φ of the first row, which is at r = 1e-4: ½ a (1 − r)².
    char *text = temporary_folder_read("lammps/mesofit.table");
    double phi;
    assert_int_equal(sscanf(strstr(text, "\n1 ") + 1, "%*d %*f %lf", &phi), 1);
    free(text);
    assert_true(fabs(phi / (0.5 * a * 0.9999 * 0.9999) - 1) < 1e-5);
}

static void test_friction_weight_that_was_found_is_exported(void **state) {
    fit_and_export(*state, "\"omega\": {\"coefficients\": 4, \"maximum\": 6}", "");
    // Both have straight pieces, of different length: at r = 0.5, between rows of both.
    char *text = temporary_folder_read("fit/omega.tsv");
    double r = 0, omega = 0, next_r = 0, next = 0, expected = NAN;
    for (char *line = strchr(text, '\n'); line && line[1]; line = strchr(line + 1, '\n')) {
        r = next_r, omega = next;
        assert_int_equal(sscanf(line + 1, "%lf %lf", &next_r, &next), 2);
        if (r <= 0.5 && next_r > 0.5)
            expected = omega + (next - omega) * (0.5 - r) / (next_r - r);
    }
    free(text);
    text = temporary_folder_read("lammps/mesofit.table");
    size_t rows;
    double low, high, found = NAN;
    char *section = strstr(text, "OMEGA_A-A\n");
    assert_non_null(section);
    assert_int_equal(sscanf(section, "OMEGA_A-A\nN %zu R %lf %lf", &rows, &low, &high), 3);
    assert_true(low == 0 && fabs(high - 1) < 0.2);
    next_r = 0, next = 0;
    for (char *line = strstr(section, "\n\n") + 1; line && line[1]; line = strchr(line + 1, '\n')) {
        r = next_r, omega = next;
        assert_int_equal(sscanf(line + 1, "%*d %lf %lf", &next_r, &next), 2);
        if (r <= 0.5 && next_r > 0.5)
            found = omega + (next - omega) * (0.5 - r) / (next_r - r);
    }
    free(text);
    assert_true(expected > 0 && fabs(found / expected - 1) < 1e-3);
}

/// What was found across pairs goes to engines that have it, as near as they do; memory to none,
/// and what tells how D changes is named.
static void test_memory_that_was_found_is_left_out_and_told(void **state) {
    static const char *const unknowns[] = {
        "\"omega\": {\"coefficients\": 4, \"maximum\": 6}, \"omega_transverse\": "
        "{\"coefficients\": 4, "
        "\"maximum\": 3}",
        "\"memory\": {\"slow\": {\"coefficients\": 4, \"maximum\": 6}}, \"numbers\": "
        "{\"memory.slow.time\": {\"minimum\": 0.1, \"maximum\": 1}}"};
    static const char *const scenes[] = {
        "", ", \"dissipative\": {\"law\": \"power\"}, \"memory\": {\"slow\": {\"time\": 0.3}}"};
    for (int k = 0; k < 2; k++) {
        fit_and_export(*state, unknowns[k], scenes[k]);
        char *text = temporary_folder_read("lammps/README");
        assert_contains(text, "; mesofit's own was 0.02 tau: the same, as");
        assert_contains(text, k ? "Friction with memory is left out" : "A-A, across pairs: gamma");
        assert_contains(text, "NOT that of the result");
        assert_contains(text, "export --dynamics simulates what D is");
        assert_contains(text, k ? "NOT that of the result: a Langevin bath" : "dpd/ext/tstat");
        free(text);
    }
}

/// A fit in the family of an engine needs no projection: γ is σ² of the style, s the exponent.
static void assert_runs_as_fitted(struct temporary_folder *folder, const char *exponent,
                                  const char *style) {
    char unknowns[256], coefficients[64];
    snprintf(unknowns, sizeof unknowns,
             "\"omega\": {\"curve\": \"power\", \"minimum\": 1, \"maximum\": 6, \"fixed\": "
             "{\"exponent\": %s, \"inner_cutoff\": 0}}",
             exponent);
    snprintf(coefficients, sizeof coefficients, "pair_coeff 1 1 %s ", style);
    fit_and_export(folder, unknowns, "");
    const double sigma = results_parameter("fit/summary.json", "sigma", "value");
    const double gamma = number_after("lammps/in.mesofit", coefficients);
    assert_true(sigma > 1 && fabs(gamma / (sigma * sigma) - 1) < 1e-3);
    assert_true(fabs(number_after("lammps/README", ", s = ") / strtod(exponent, NULL) - 1) < 1e-3);
    assert_true(number_after("lammps/README", "misfit of omega ") < 0.01);
}

static void test_fit_with_exponent_1_runs_as_dpd_tstat(void **state) {
    assert_runs_as_fitted(*state, "1", "dpd/tstat");
}

static void test_fit_with_another_exponent_runs_as_dpd_ext_tstat(void **state) {
    assert_runs_as_fitted(*state, "1.7", "dpd/ext/tstat");
}

static void simulate_with(struct temporary_folder *folder, const char *friction, const char *out) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", soft_fluid, "{\"law\": \"power\", \"sigma\": 3}",
                       friction);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out, "--quiet");
    run_program_assert_code(&result, 0);
}

static void project(const char *engine, const char *threads) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "--project", "--threads", threads);
    run_program_assert_code(&result, 0);
}

/// A projection that changes nothing costs nothing, but for statistics: a difference of five
/// standard errors is one in 2e6. What E of another seed differs by is near its noise.
static void test_projection_of_a_power_law_costs_nothing(void **state) {
    double value[2], error[2];
    simulate_with(*state, "{\"law\": \"power\", \"sigma\": 3}", "out");
    project("lammps", "2");
    char *text = temporary_folder_read("lammps/README");
    const char *at = strstr(text, "Omega is replaced by the law above");
    assert_non_null(at);
    for (int k = 0; k < 2; k++) {
        at = strstr(at, ", slope of the MSD ");
        assert_non_null(at);
        assert_int_equal(sscanf(at++, ", slope of the MSD %lf +- %lf", &value[k], &error[k]), 2);
    }
    free(text);
    assert_true(fabs(value[0] - value[1]) < 5 * sqrt(error[0] * error[0] + error[1] * error[1]));
    const double rms = number_after("lammps/README", "rms of the difference ");
    const double noise = number_after("lammps/README", "noise alone gives ");
    assert_true(rms > 0 && noise > 0 && rms < 3 * noise && noise < 0.05);
    assert_true(fabs(number_after("lammps/in.mesofit", "dpd/tstat ") - 1) <
                1e-12); // T of pair_style
    assert_true(fabs(number_after("lammps/in.mesofit", "1 1 dpd/tstat ") / 9 - 1) < 1e-6);
    text = temporary_folder_read("lammps/in.mesofit");
    assert_contains(text, "variable friction index dpd ");
    free(text);
}

/// A friction in a narrow shell, and the smooth one that is nearest: E differs by more than noise.
static void test_projection_is_made_for_the_engine_and_its_cost_is_told(void **state) {
    static const char *const files[] = {"projection.tsv", "README", NULL};
    simulate_with(*state,
                  "{\"law\": \"power\", \"sigma\": 40, \"inner_cutoff\": 0.8, \"exponent\": 0.5}",
                  "out");
    project("lammps", "1");
    results_assert_table("lammps/projection.tsv", 6, 0);
    assert_true(number_after("lammps/README", "misfit of omega ") > 0.1);
    const double rms = number_after("lammps/README", "rms of the difference ");
    assert_true(rms > 5 * number_after("lammps/README", "noise alone gives "));
    assert_int_equal(rename("lammps", "one"), 0);
    project("lammps", "2");
    results_assert_same("one", "lammps", files);
    project("hoomd", "2"); // which has no exponent but 1
    assert_true(number_after("hoomd/README", ", s = ") == 1);
    char *text = temporary_folder_read("hoomd/run.py");
    assert_contains(text, "dpd = True");
    free(text);
    project("espresso", "2"); // another family, which is high up to its end
    assert_true(number_after("espresso/README", ", s = ") > 2);
    assert_true(number_after("espresso/run.py", "dict(k=") > 2);
    assert_true(number_after("espresso/README", "misfit of omega ") <
                number_after("hoomd/README", "misfit of omega "));
}

static void assert_refused(const char *from, const char *engine, const char *option,
                           const char *word) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "export", from, "--engine", engine, "-o", "empty", option);
    run_program_assert_refused(&result, "empty", word, 1, (const char *const[]){word, NULL});
}

static void test_friction_that_cannot_be_written_is_one_line(void **state) {
    assert_int_equal(mkdir("empty", 0777), 0);
    simulate_with(*state, "{\"law\": \"power\", \"sigma\": 3}", "out");
    assert_refused("out", "votca", "--project", "no friction between pairs");
    simulate_with(*state, "{\"law\": \"none\"}", "free");
    assert_refused("free", "lammps", "--project", "no friction weight");
    simulate_with(*state, "{\"law\": \"power\"}, \"dissipative_transverse\": {\"law\": \"power\"}",
                  "across");
    assert_refused("across", "hoomd", "--project", "along pairs alone");
    simulate_with(*state,
                  "{\"law\": \"power\"}, \"memory\": {\"slow\": {\"time\": 0.3, \"omega\": "
                  "{\"law\": \"power\"}}}",
                  "slow");
    assert_refused("slow", "lammps", "--project",
                   "no friction weight"); // white friction is left out, too
}

/// What the program chose to hold the temperature is no result that an engine leaves out, and no D
/// follows from it; what the scene says is.
static void test_friction_that_was_chosen_is_not_left_out(void **state) {
    static const char friction[] = ",\n    \"dissipative\": {\"law\": \"power\", \"sigma\": 2}";
    static struct run_program_result result;
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    for (int own = 0; own < 2; own++) {
        small_inputs_write(*state, "run.json", small_inputs_run, friction, own ? friction : "");
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--force"); // that need not converge
        RUN_PROGRAM(&result, "export", "fit", "--engine", "gromacs", "-o", "gromacs", "--force");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.err, "friction   no result, but chosen to hold") == NULL,
                         own);
        assert_int_equal(strstr(result.err, "omega(r), conserved momentum and flow are left out") &&
                             strstr(result.err, "export --dynamics"),
                         own);
        // A fit of what used.json says knows no less.
        RUN_PROGRAM(&result, "fit", "fit/used.json", "-o", "again", "--force");
        RUN_PROGRAM(&result, "export", "again", "--engine", "hoomd", "-o", "hoomd", "--force");
        run_program_assert_code(&result, 0);
        char *readme = temporary_folder_read("hoomd/README");
        assert_contains(readme, own ? "friction   that of the result: hoomd.md.pair.DPD"
                                    : "friction   no result, but chosen to hold the temperature");
        assert_contains(readme, own ? "with A = 0, that of the result"
                                    : "with A = 0, chosen to hold the temperature, and no result");
        free(readme);
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_numbers_that_were_found_are_exported),
        TEST(test_friction_weight_that_was_found_is_exported),
        TEST(test_memory_that_was_found_is_left_out_and_told),
        TEST(test_fit_with_exponent_1_runs_as_dpd_tstat),
        TEST(test_fit_with_another_exponent_runs_as_dpd_ext_tstat),
        TEST(test_projection_of_a_power_law_costs_nothing),
        TEST(test_projection_is_made_for_the_engine_and_its_cost_is_told),
        TEST(test_friction_that_cannot_be_written_is_one_line),
        TEST(test_friction_that_was_chosen_is_not_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
