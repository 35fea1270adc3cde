// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a look at the targets sees before a fit: g(r) of real fluids passes and is told in a line;
// wrong columns, units, densities and temperatures are refused with the key, or a warning names
// them.
#include "shared/propane.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Where the tests are started, with targets/ and runs/.
static char root[512];

/// The SPC water of targets/, λ = 1 nm: columns r_low, r, r_high, r reduced, g, error, counts of
/// pairs, neighbours.
#define COLUMNS "\"r_column\": 2, \"g_column\": 5"
#define ERRORS ", \"error_column\": 6"
#define BOX "4.384"
#define BEADS "2744"
#define LENGTH "\"length\": 1"
#define MASS "\"mass\": 2.992e-26"
#define METHOD "\"name\": \"imc\""
static const char water[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"water.txt\", " COLUMNS ERRORS "}},\n"
    "\"scene\": {\"box\": [" BOX ", " BOX ", " BOX "], \"particles\": {\"count\": " BEADS "},\n"
    "\"temperature\": 1, \"dissipative\": {\"law\": \"power\", \"cutoff\": 0.5},\n"
    "\"units\": {" LENGTH ", \"temperature\": 298, " MASS "}},\n"
    "\"method\": {" METHOD "}}\n";

/// A name in the working folder for a file of the repository.
static void link_to(const char *file, const char *name) {
    char from[1024];
    snprintf(from, sizeof from, "%s/%s", root, file);
    assert_int_equal(symlink(from, name), 0);
}

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    link_to("targets/spc-water/spc298_rdf_com_1.0nm_100.txt", "water.txt");
    return 0;
}

enum { MAX_WORDS = 5 };

/// A mistake: `from` of the good file becomes `to`, and the lines on stderr or stdout have `words`.
struct mistake {
    const char *what, *from, *to;
    const char *words[MAX_WORDS];
};

#define MISTAKE(name, old, new, ...)                                                               \
    {                                                                                              \
        .what = (name), .from = (old), .to = (new), .words = { __VA_ARGS__ }                       \
    }

static const struct mistake refused[] = {
    MISTAKE("numbers of neighbours as g", COLUMNS, "\"r_column\": 2, \"g_column\": 8",
            "run.json: target.rdf.g_column: ", "water.txt is 93.92, not 1",
            "as a number of neighbours"),
    MISTAKE("counts as g", COLUMNS, "\"r_column\": 2, \"g_column\": 7",
            "target.rdf.g_column: ", "7.883e+06, not 1", "counts of pairs"),
    MISTAKE("errors as g", COLUMNS ERRORS, "\"r_column\": 2, \"g_column\": 6",
            "target.rdf.g_column: ", "water.txt is 0.0003556, not 1"),
    MISTAKE("numbers of neighbours as errors", ERRORS, ", \"error_column\": 8", "target.rdf.file: ",
            "column 8 cannot be the standard error of g: it increases", "\"error_column\""),
    MISTAKE("no column of errors among many", ERRORS, "",
            "target.rdf.file: ", "column 3 cannot be the standard error of g",
            "set \"error_column\" to another, or to 0"),
    MISTAKE("a column of errors that is not there", ERRORS, ", \"error_column\": 9",
            "water.txt:9: 8 columns, at least 9 are needed for \"error_column\""),
    MISTAKE("ten times the beads", BEADS, "27440", "run.json: target.rdf: ",
            "nearer than 0.25 lambda", "325.7 nm^-3 = 9.74 g/cm^3", "closest packing"),
    MISTAKE("five times the beads", BEADS, "13720", "run.json: target.rdf: ", "rho d^3 = 2.54"),
    MISTAKE("a temperature in K", "\"temperature\": 1,", "\"temperature\": 298,",
            "run.json: scene.temperature: ", "88804 K"),
    MISTAKE("a mass in u", MASS, "\"mass\": 32.042",
            "run.json: scene.units.mass: ", "it is in kg: 32.042 u would be 5.3207e-26"),
    MISTAKE("a mass in g", MASS, "\"mass\": 2.992e-23", "scene.units.mass: ", "974 g/cm^3"),
};

/// It is one of the table, too, whose heading says nm.
static const struct mistake too_small =
    MISTAKE("a unit of length ten times too small", LENGTH, "\"length\": 0.1",
            "scene.units.mass: ", "974 g/cm^3", "the unit of length", "column 2 is in nm");

static const struct mistake doubted[] = {
    MISTAKE("a tenth of the beads", BEADS, "274", "mesofit: warning: target.rdf: it has the layers",
            "3.252 nm^-3 = 0.0973 g/cm^3", "neighbours up to the second one",
            "the number of particles"),
    MISTAKE("nm taken for the unit of length of 0.465 nm", BOX ", " BOX ", " BOX,
            "9.428, 9.428, 9.428", "mesofit: warning: target.rdf: it has the layers",
            "the unit of length"),
    MISTAKE("twice the beads", BEADS, "5488",
            "mesofit: warning: target.rdf: its integral gives a negative", "1 + rho G = -0.87(",
            "3 %"),
    MISTAKE("a temperature in K without units",
            "\"temperature\": 1, \"dissipative\": {\"law\": \"power\", \"cutoff\": 0.5},\n"
            "\"units\": {" LENGTH ", \"temperature\": 298, " MASS "}",
            "\"temperature\": 298, \"dissipative\": {\"law\": \"power\", \"cutoff\": 0.5}",
            "mesofit: warning: scene.temperature: 298", "kelvins"),
};

static void test_fit_refuses_targets_and_scenes_that_cannot_be(void **state) {
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
        small_inputs_write(*state, "run.json", water, refused[k].from, refused[k].to);
        RUN_PROGRAM(&result, "fit", "run.json");
        run_program_assert_refused(&result, ".", refused[k].what, 1, refused[k].words);
        assert_false(temporary_folder_exists("out"));
    }
    small_inputs_write(*state, "run.json", water, too_small.from, too_small.to);
    RUN_PROGRAM(&result, "fit", "run.json");
    run_program_assert_refused(&result, ".", too_small.what, 2, too_small.words);
}

static void test_simulate_refuses_units_that_cannot_be(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"time_step\"",
                       "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 32.042},\n"
                       "  \"time_step\"");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "a mass in u", 1,
                               (const char *[]){"scene.json: units.mass: ", "in kg", NULL});
    // 18.02 u as the unit, and 18.02 units: 18.02² u is no bead of water.
    static const char twice[] =
        "{\"units\": {\"length\": 0.46, \"temperature\": 300, \"mass\": 2.992e-26},\n"
        "\"box\": [8, 8, 8], \"particles\": {\"count\": 1536, \"mass\": 18.02},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"}, \"conservative\":\n"
        "{\"law\": \"soft-repulsion\", \"a\": 25}, \"measure\": {\"samples\": 2, \"every\": 1}}\n";
    small_inputs_write(*state, "scene.json", twice, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "a mass told twice", 1,
                               (const char *[]){"scene.json: particles.mass: ", "sets mu to 18.01",
                                                "a bead would have 324.", NULL});
}

static void test_fit_warns_of_targets_that_hardly_can_be(void **state) {
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof doubted / sizeof *doubted; k++) {
        small_inputs_write(*state, "run.json", water, doubted[k].from, doubted[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        for (size_t word = 0; word < MAX_WORDS && doubted[k].words[word]; word++)
            assert_contains(result.out, doubted[k].words[word]);
    }
}

/// 1 atm in Pa, where the file has bar: 74 times an ideal gas's; coarse water's 9900 bar are 7
/// times.
static void test_fit_warns_of_a_pressure_that_no_fluid_has(void **state) {
    static const char run[] =
        "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"file\": \"water.txt\", " COLUMNS ERRORS
        "},\n"
        "    \"pressure\": {\"value\": 101325, \"error\": 100}},\n"
        "\"scene\": {\"density\": 32.57, \"temperature\": 298, \"particles\": {\"mass\": "
        "18.015}}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out,
                    "warning: target.pressure: 101325 bar is 75.6 times the pressure of an ideal "
                    "gas of this density and temperature, 1340 bar: no fluid has more than some 50 "
                    "times as much; is it in bar, and not in Pa or another unit?");
    small_inputs_write(*state, "run.json", run, "101325", "9900");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    assert_null(strstr(result.out, "target.pressure"));
}

/// Whoever leaves out rows of 0 may leave out more.
static void test_fit_warns_of_a_table_that_begins_within_its_core(void **state) {
    static struct run_program_result result;
    static const char run[] = "{\"target\": {\"rdf\": {\"file\": \"part.tsv\"}}, \"scene\": "
                              "{\"density\": 0.8, \"temperature\": 1}}\n";
    link_to("targets/lennard-jones/rdf.tsv", "whole.tsv");
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    char *const whole = temporary_folder_read("whole.tsv");
    for (int from = 0; from < 2; from++) {
        const char *const rest = strstr(whole, from ? "\n0.95\t" : "\n0.81\t");
        assert_non_null(rest);
        small_inputs_write(*state, "part.tsv", rest + 1, NULL, NULL);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out,
                                "warning: target.rdf: its first row, at 0.95 lambda, "
                                "has g = 0.274: nearer pairs are taken for none") != NULL,
                         from);
    }
    free(whole);
}

/// The water with its g times a factor, and errors of so much, or those of the file times it if
/// that is 0.
static void write_water(struct temporary_folder *folder, double factor, double error) {
    char *const text = temporary_folder_read("water.txt"), *rest;
    static char changed[16384];
    size_t length = (size_t)snprintf(changed, sizeof changed, "# r[nm] g[1] g_error[1]\n");
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        double r, g, own;
        if (sscanf(line, "%*f %lf %*f %*f %lf %lf", &r, &g, &own) == 3)
            length += (size_t)snprintf(changed + length, sizeof changed - length, "%g %g %g\n", r,
                                       factor * g, error > 0 ? error : factor * own);
    }
    temporary_folder_write(folder, "changed.tsv", changed, length);
    free(text);
}

static const char changed_run[] =
    "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"file\": \"changed.tsv\"}},\n"
    "\"scene\": {\"density\": 32.57, \"temperature\": 298, \"particles\": {\"mass\": "
    "18.015}}}\n";

/// Any potential has such a g(r), and any fit of it is a success.
static void test_fit_warns_of_errors_in_per_cent(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", changed_run, NULL, NULL);
    for (int k = 0; k < 3; k++) {
        write_water(*state, 1, 0.75 * k);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, "warning: target.rdf: changed.tsv: its errors are ") &&
                             strstr(result.out, "are they in per cent, or another column?"),
                         k > 0);
    }
}

/// A factor of 1.05 is found, and one of 1.1 is not.
static void test_fit_warns_of_g_that_does_not_end_at_1(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", changed_run, NULL, NULL);
    static const double factors[] = {1, 1.05, 1.1};
    for (int k = 0; k < 3; k++) {
        write_water(*state, factors[k], 0);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, "in the last tenth of its range, g is ") != NULL,
                         k >= 2);
    }
}

static void test_fit_warns_of_a_cutoff_beyond_the_table(void **state) {
    static const char *const cutoffs[] = {"0.9", "1.0", "1.5"};
    static struct run_program_result result;
    for (int k = 0; k < 3; k++) {
        char with[64];
        snprintf(with, sizeof with, ERRORS ", \"cutoff\": %s", cutoffs[k]);
        small_inputs_write(*state, "run.json", water, ERRORS, with);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(
            strstr(result.out, "target.rdf.cutoff: 1.5 nm is beyond the end of the table: g(r) and "
                               "the potential end at 1 nm") != NULL,
            k == 2);
    }
}

/// Water beside which target.json says where it was measured.
static void test_fit_warns_of_a_state_that_is_not_the_measured_one(void **state) {
    static const struct {
        const char *density, *temperature, *line;
    } cases[] = {
        {"32.566", "298", NULL},
        {"32.3", "297", NULL},
        {"30", "298", "at 30 nm^-3, not 32.57: is"},
        {"32.566", "350", "at 350 K, not 298: is"},
        {"3.2566", "24.85", "at 3.257 nm^-3, not 32.57, and at 24.85 K, not 298: is"},
    };
    static const char measured[] = "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"file\": "
                                   "\"rdf.tsv\"}}, \"scene\": {\"density\": HERE, "
                                   "\"temperature\": THERE}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", water, NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        char half[512];
        snprintf(half, sizeof half, "%.*s%s%s", (int)(strstr(measured, "HERE") - measured),
                 measured, cases[k].density, strstr(measured, "HERE") + 4);
        small_inputs_write(*state, "target.json", half, "THERE", cases[k].temperature);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        const char *const said = strstr(result.out, "target.json, beside the table of g(r), says");
        assert_int_equal(said != NULL, cases[k].line != NULL);
        if (said)
            assert_non_null(strstr(said, cases[k].line));
    }
    assert_int_equal(unlink("target.json"), 0);
}

/// What `measure` warned of, and `fit` would forget.
static void test_fit_says_again_what_the_measurement_warned_of(void **state) {
    static const char *const words = "target: summary.json, beside the table of g(r), says that "
                                     "the trajectory is not in equilibrium";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", water, NULL, NULL);
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "summary.json",
                           k ? "{\"method\": \"measure\", \"warning\": \"the trajectory is not in "
                               "equilibrium\", \"frames\": 80}\n"
                             : "{\"method\": \"measure\", \"frames\": 80}\n",
                           NULL, NULL);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, words) != NULL, k);
    }
    assert_int_equal(unlink("summary.json"), 0);
}

/// Gaussian-core particles have no packing that is too dense, but ten times the density asks for
/// less than no fluctuations; hard spheres a thousandth of their close packing are a gas.
static void test_fit_looks_at_densities_of_fluids_without_layers(void **state) {
    static struct run_program_result result;
    link_to("targets/gaussian-core/rdf.tsv", "target.tsv");
    small_inputs_write(*state, "run.json", small_inputs_run,
                       "[3, 3, 3],\n    \"particles\": {\"count\": 81}",
                       "[8.842, 8.842, 8.842],\n    \"particles\": {\"count\": 1728}");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_refused(&result, ".", "Gaussian core", 1,
                               (const char *[]){"run.json: target.rdf: ", "2.5 lambda^-3",
                                                "negative compressibility, 1 + rho G = -9.", NULL});
    assert_int_equal(unlink("target.tsv"), 0);
    small_inputs_write(*state, "target.tsv", "0.1 0 0\n0.3 0 0\n0.5 1 0.1\n0.7 1 0.1\n0.9 1 0.1\n",
                       NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, "[3, 3, 3]", "[10, 10, 10]");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out,
                    "mesofit: warning: target.rdf: a dilute gas: the density of the scene is "
                    "0.081 lambda^-3, and the beads are 0.4 lambda wide");
}

/// In a mixture the pair type is named: ten times the beads of one type leave no room for them.
static void test_fit_names_the_pairs_of_a_mixture_that_cannot_be(void **state) {
    static struct run_program_result result;
    static const char mixture[] =
        "{\"seed\": 3, \"target\": {\"rdf\": {\"A-A\": {\"file\": \"AA\"}, \"A-B\": {\"file\": "
        "\"AB\"}, "
        "\"B-B\": {\"file\": \"BB\"}}}, \"scene\": {\"box\": [11.8, 11.8, 11.8], \"particles\": "
        "{\"types\": {\"A\": 700, \"B\": 7000}}, \"dissipative\": {\"law\": \"power\"}}, "
        "\"method\": {\"name\": \"imc\"}}";
    link_to("targets/lennard-jones-mixture/rdf_A-A.tsv", "AA");
    link_to("targets/lennard-jones-mixture/rdf_A-B.tsv", "AB");
    link_to("targets/lennard-jones-mixture/rdf_B-B.tsv", "BB");
    small_inputs_write(*state, "run.json", mixture, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_refused(
        &result, ".", "mixture", 1,
        (const char *[]){"run.json: target.rdf.B-B: ", "closest packing", NULL});
    assert_null(strstr(result.err, "demixed"));
    small_inputs_write(*state, "run.json", mixture, "7000", "700");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out,
                    "target rdf.A-B: g from 0.0125 to 2.487 lambda, peak 2.63 at 1.037");
}

/// Two types whose beads push each other off four times as much as their own, at a density of 3,
/// demix: R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997), find two phases from an
/// excess of about 8 on.
static void test_fit_names_demixing_where_the_integrals_say_so(void **state) {
    static struct run_program_result result;
    small_inputs_write(
        *state, "scene.json",
        "{\"seed\": 51, \"box\": [5, 5, 5], \"particles\": {\"types\": {\"A\": 188, \"B\": 187}},\n"
        "\"time_step\": 0.04, \"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": "
        "25},\n"
        "\"A-B\": {\"law\": \"soft-repulsion\", \"a\": 100},\n"
        "\"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"rdf\": {\"range\": 2, \"bins\": "
        "40},\n"
        "\"measure\": {\"equilibration\": 2000, \"samples\": 50, \"every\": 20}}",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "target", "--quiet");
    run_program_assert_code(&result, 0);
    small_inputs_write(
        *state, "run.json",
        "{\"target\": {\"rdf\": {\"A-A\": {\"file\": \"target/rdf_A-A.tsv\"},\n"
        "\"A-B\": {\"file\": \"target/rdf_A-B.tsv\"}, \"B-B\": {\"file\": "
        "\"target/rdf_B-B.tsv\"}}},\n"
        "\"scene\": {\"box\": [5, 5, 5], \"particles\": {\"types\": {\"A\": 188, \"B\": 187}},\n"
        "\"dissipative\": {\"law\": \"power\"}}, \"method\": {\"name\": \"imc\"}}",
        NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "run.json: target.rdf.A-A.g_column: ");
    assert_contains(result.err, "; or have A and B demixed? Their integrals of g - 1 are ");
    assert_int_equal(run_program_lines(result.err), 1);
}

/// Dumbbells that have come apart into a liquid and its vapour: g stays above 1 up to the box.
static void test_fit_warns_of_dumbbells_of_two_phases(void **state) {
    static struct run_program_result result;
    (void)state;
    link_to("runs/standard-set/dumbbells/rdf.tsv", "rdf.tsv");
    link_to("runs/standard-set/dumbbells/bond_lengths.tsv", "bond_lengths.tsv");
    link_to("runs/standard-set/dumbbells/run.json", "run.json");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "and g ends at 1.022: of two phases, or near a critical point?");
    assert_int_equal(unlink("run.json"), 0);
    assert_int_equal(unlink("rdf.tsv"), 0);
    link_to("runs/standard-set/lennard-jones-critical/rdf.tsv", "rdf.tsv");
    link_to("runs/standard-set/lennard-jones-critical/run.json", "run.json");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.out, "two phases"));
}

/// 32.57 molecules in a cubic nanometre and 0.974 g/cm³, as the target's own head says; the first
/// peak of its README.
static const char line[] =
    "target rdf: g from 0.005 to 0.995 nm, peak 2.79 at 0.275 nm, tail 0.997(6); "
    "density 32.57 nm^-3 = 0.974 g/cm^3, 1 + rho G = 0.07(1)\n";

static void test_fit_tells_its_target_in_a_line_unless_quiet(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", water, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, line);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json");
    assert_in_range(result.code, 0, 1);
    assert_contains(result.err,
                    "target rdf: g from 0.1 to 0.9 lambda, peak 1.1 at 0.7 lambda, tail ");
    assert_contains(result.err, "; density 3 lambda^-3, 1 + rho G = ");
    assert_null(strstr(result.err, "no errors given"));
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_null(strstr(result.err, "target rdf"));
}

static void test_fit_tells_where_errors_and_bins_come_from(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", water, ERRORS, ", \"error_column\": 0");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out,
                    "target rdf: no errors given: 0.00041 at g = 1 in the last bin, from");
    small_inputs_write(*state, "run.json", water, ERRORS, ERRORS ", \"bin_width\": 0.02");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    assert_contains(result.out, "target rdf: 2 rows of the file make a bin of 0.02 nm");
    small_inputs_write(*state, "target.tsv", "r,g\n0.1,0.3\n0.3,0.6\n0.5,0.8\n0.7,1.1\n0.9,1.0\n",
                       NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out,
                    "target rdf: no errors given, and no scatter to estimate them: 0.002 at");
}

/// Every target of the repository, as its run has it, passes without a warning.
static void test_fit_has_nothing_against_the_targets_of_the_repository(void **state) {
    (void)state;
    static const char *const runs[] = {"gaussian-core-imc",         "lennard-jones-imc",
                                       "lennard-jones-mixture-imc", "spc-water-imc",
                                       "spc-water-joint",           "spce-votca"};
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        char file[1024];
        snprintf(file, sizeof file, "%s/runs/%s/run.json", root, runs[k]);
        RUN_PROGRAM(&result, "fit", file, "--explain");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, "target rdf");
        assert_null(strstr(result.out, "warning"));
    }
}

/// A cutoff in the middle of the first peak, after it or in the first minimum leaves too little to
/// judge what the whole file shows to be right.
static void test_fit_has_nothing_against_short_cutoffs(void **state) {
    static const char *const cutoffs[] = {"0.28", "0.3", "0.35", "0.5", "0.7"};
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cutoffs / sizeof *cutoffs; k++) {
        char members[128];
        snprintf(members, sizeof members, ERRORS ", \"cutoff\": %s", cutoffs[k]);
        small_inputs_write(*state, "run.json", water, ERRORS, members);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_null(strstr(result.out, "warning"));
    }
}

/// Beads that bind two neighbours each and keep the others off by a barrier, as molecules of
/// methanol do.
static void write_bonds(struct temporary_folder *folder) {
    char text[4096] = "";
    for (int k = 0; k < 150; k++) {
        const double r = 0.5 + 0.01 * k;
        snprintf(text + strlen(text), sizeof text - strlen(text), "%.2f %.5f\n", r,
                 pow(0.75 / r, 12) + 1.5 * exp(-pow((r - 0.9625) / 0.075, 2)) -
                     0.45 * exp(-pow((r - 1.2) / 0.15, 2)));
    }
    temporary_folder_write(folder, "bonds.tsv", text, strlen(text));
}

/// g(r) of soft fluids and gases as the programs' own simulations give it: none has a core, a
/// density of liquids or layers, and none is refused or doubted.
static void test_fit_has_nothing_against_soft_fluids_and_gases(void **state) {
    static const struct {
        const char *law;
        double edge;
    } fluids[] = {
        {"{\"law\": \"soft-repulsion\", \"a\": 25}", 6},     // DPD, density 3
        {"{\"law\": \"soft-repulsion\", \"a\": 75}", 4.762}, // 6
        {"{\"law\": \"gaussian\", \"epsilon\": 2, \"sigma\": 1, \"cutoff\": 2.2}", 5.061}, // 5
        {"{\"law\": \"gaussian\", \"epsilon\": 0.01, \"sigma\": 1, \"cutoff\": 2.2}", 9},  // ideal
        {"{\"law\": \"lennard-jones\", \"epsilon\": 0.5, \"sigma\": 1}", 18.64}, // gas of 0.1
        {"{\"law\": \"table\", \"file\": \"bonds.tsv\"}", 8.84},
    };
    static struct run_program_result result;
    write_bonds(*state);
    for (size_t k = 0; k < sizeof fluids / sizeof *fluids; k++) {
        char text[2048], edge[128];
        snprintf(edge, sizeof edge, "[%g, %g, %g]", fluids[k].edge, fluids[k].edge, fluids[k].edge);
        snprintf(text, sizeof text,
                 "{\"seed\": 5, \"box\": %s, \"particles\": {\"count\": 648}, \"time_step\": 0.01, "
                 "\"conservative\": %s, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}, "
                 "\"measure\": {\"equilibration\": 300, \"samples\": 60, \"every\": 20}, "
                 "\"rdf\": {\"range\": 2.25, \"bins\": 45}}",
                 edge, fluids[k].law);
        small_inputs_write(*state, "scene.json", text, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fluid", "--quiet", "--threads", "1");
        run_program_assert_code(&result, 0);
        snprintf(text, sizeof text,
                 "{\"seed\": 5, \"target\": {\"rdf\": {\"file\": \"fluid/rdf.tsv\"}}, \"scene\": "
                 "{\"box\": %s, \"particles\": {\"count\": 648}, \"dissipative\": {\"law\": "
                 "\"power\"}}, \"method\": {\"name\": \"imc\"}}",
                 edge);
        small_inputs_write(*state, "run.json", text, NULL, NULL);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        // A range that costs time is no fault of the fluid.
        const char *warning = strstr(result.out, "warning");
        assert_true(warning == NULL || strstr(warning, "which makes the fit slow"));
    }
}

/// The program says what mf_fit_print_state tells: see test_fit_print for all that it warns of.
static void test_fit_of_molecules_warns_of_g_that_ends_beside_1(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", propane_run_small, NULL, NULL);
    for (int k = 0; k < 2; k++) {
        for (int pair = 0; pair < PROPANE_PAIRS; pair++)
            propane_write_target(*state, root, pair, pair == 0 && k == 1 ? 1.05 : 1);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, "target rdf.A-A: ");
        if (k == 1)
            assert_contains(result.out,
                            "target.rdf.A-A: over the last quarter of its range g is 1.05");
        else
            assert_null(strstr(result.out, "not 1"));
    }
}

/// p, flat from `first` to `last` degrees in bins of 4.
static void write_flat(struct temporary_folder *folder, const char *name, int first, int last) {
    char text[4096];
    size_t length = 0;
    for (int at = first; at < last; at += 4)
        length += (size_t)snprintf(text + length, sizeof text - length, "%d %.6f 0.0001\n", at + 2,
                                   1.0 / (last - first));
    temporary_folder_write(folder, name, text, length);
}

static void test_fit_warns_of_dihedrals_about_angles_in_a_line(void **state) {
    static const char run[] =
        "{\"units\": \"nm-ps\", \"target\": {\n"
        "\"rdf\": {\"file\": \"A-A.dist.tgt\", \"format\": \"votca\", \"normalisation\": 1, "
        "\"cutoff\": 1.5},\n"
        "\"bond_angles\": {\"bend\": {\"file\": \"bend.tsv\"}},\n"
        "\"dihedral_angles\": {\"twist\": {\"file\": \"twist.tsv\"}}},\n"
        "\"scene\": {\"box\": " PROPANE_SMALL_BOX ", \"temperature\": 200,\n"
        "\"particles\": {\"mass\": 14.7}, \"bonds\": {\"bond\": {\"law\": \"harmonic\", \"k\": "
        "50000, \"length\": 0.17}},\n"
        "\"molecules\": {\"butane\": {\"count\": 150, \"chain\": {\"type\": \"A\", \"length\": 4, "
        "\"bond\": \"bond\", \"angle\": \"bend\", \"dihedral\": \"twist\"}}}}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    propane_write_target(*state, root, 0, 1);
    write_flat(*state, "twist.tsv", -180, 180);
    for (int last = 160; last <= 180; last += 20) {
        write_flat(*state, "bend.tsv", 100, last);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        const bool warned = strstr(result.out, "10 % of the angles \"bend\" are within 10 degrees");
        assert_int_equal(warned, last == 180);
        if (warned)
            assert_contains(result.out, "write \"exclude\": 3 into the molecule");
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)

int main(void) {
    if (getcwd(root, sizeof root) == NULL)
        return 1;
    const struct CMUnitTest tests[] = {
        TEST(test_fit_refuses_targets_and_scenes_that_cannot_be),
        TEST(test_simulate_refuses_units_that_cannot_be),
        TEST(test_fit_warns_of_targets_that_hardly_can_be),
        TEST(test_fit_warns_of_a_pressure_that_no_fluid_has),
        TEST(test_fit_warns_of_a_table_that_begins_within_its_core),
        TEST(test_fit_warns_of_errors_in_per_cent),
        TEST(test_fit_warns_of_g_that_does_not_end_at_1),
        TEST(test_fit_warns_of_a_cutoff_beyond_the_table),
        TEST(test_fit_warns_of_a_state_that_is_not_the_measured_one),
        TEST(test_fit_says_again_what_the_measurement_warned_of),
        TEST(test_fit_looks_at_densities_of_fluids_without_layers),
        TEST(test_fit_names_the_pairs_of_a_mixture_that_cannot_be),
        TEST(test_fit_names_demixing_where_the_integrals_say_so),
        TEST(test_fit_warns_of_dumbbells_of_two_phases),
        TEST(test_fit_warns_of_dihedrals_about_angles_in_a_line),
        TEST(test_fit_of_molecules_warns_of_g_that_ends_beside_1),
        TEST(test_fit_tells_its_target_in_a_line_unless_quiet),
        TEST(test_fit_tells_where_errors_and_bins_come_from),
        TEST(test_fit_has_nothing_against_the_targets_of_the_repository),
        TEST(test_fit_has_nothing_against_short_cutoffs),
        TEST(test_fit_has_nothing_against_soft_fluids_and_gases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
