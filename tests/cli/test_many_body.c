// SPDX-License-Identifier: GPL-3.0-or-later
//
// "many_body" of a scene: read, written back, in other units, with molecules, and what is refused.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

#define MEASURE "\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}"

static const char scene[] =
    "{\"seed\": 1, \"box\": [3, 3, 4], \"time_step\": 0.01, \"temperature\": 1,\n"
    "\"particles\": {\"types\": {\"A\": 60, \"B\": 80, \"C\": 1}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": -20},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2},\n"
    "\"many_body\": {\n"
    "  \"crowd\": {\"weight\": {\"law\": \"many-body-dpd\", \"cutoff\": 0.75},\n"
    "            \"energy\": {\"law\": \"many-body-dpd\", \"b\": 25, \"cutoff\": 0.75}},\n"
    "  \"shell\": {\"central\": \"A\", \"neighbours\": \"B, C\",\n"
    "            \"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.4, \"cutoff\": 1.2},\n"
    "            \"energy\": {\"law\": \"expression\", \"formula\": \"rho^2/10\", \"maximum\": "
    "8}},\n"
    "  \"file\": {\"weight\": {\"law\": \"table\", \"file\": \"w.tsv\"},\n"
    "            \"energy\": {\"law\": \"table\", \"file\": \"f.tsv\"}}},\n" MEASURE "}\n";

static const char weight[] = "0 1\n0.2 0.8\n0.5 0.3\n0.9 0\n";
static const char energy[] = "0 0\n2 -0.3\n4 0.2\n6 1\n8 2\n";

static void write_all(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    small_inputs_write(folder, "w.tsv", weight, NULL, NULL);
    small_inputs_write(folder, "f.tsv", energy, NULL, NULL);
}

/// As where it was meant to be fitted.
static void test_a_polynomial_without_coefficients_is_told(void **state) {
    static const char from[] = "\"law\": \"expression\", \"formula\": \"rho^2/10\", \"maximum\": 8";
    write_all(*state, from, "\"law\": \"polynomial\", \"origin\": 3");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "none");
    run_program_assert_code(&result, 0);
    assert_contains(result.err,
                    "mesofit: warning: many_body.shell.energy: all its coefficients are 0");
    assert_null(strstr(result.err, "many_body.crowd"));
    write_all(*state, from, "\"law\": \"polynomial\", \"c4\": 0.01");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "some");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "coefficients are 0"));
}

/// What was used runs again to the same table, in pieces too, and a density beyond a table is told.
static void test_a_scene_is_read_and_written_back(void **state) {
    static const char *const tables[] = {"thermodynamics.tsv", NULL};
    write_all(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "mesofit: warning: many_body.shell.energy: densities were ");
    assert_contains(result.err, "and so beyond the table from 0 to 8: the energy was continued");
    assert_null(strstr(result.err, "many_body.crowd"));
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"many_body_warning\":\t\"many_body.shell.energy: densities were ");
    free(summary);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", tables);
    write_all(*state, "\"samples\": 4, \"every\": 1", "\"samples\": 400, \"every\": 5");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "long", "--threads", "2");
    run_program_assert_code(&result, 0);
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("long", "pieces", tables);
}

/// Another file of f is another simulation: a checkpoint of the one is none of the other's.
static void test_other_tables_have_other_energies(void **state) {
    write_all(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "f.tsv", energy, "4 0.2", "4 0.3");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "other");
    run_program_assert_code(&result, 0);
    results_assert_differ("out", "other", "thermodynamics.tsv");
}

/// Energy of a bead in a scene of the units, of which lengths are `length` and energies `unit`.
static double energy_in(struct temporary_folder *folder, const char *system, double length,
                        double unit) {
    char text[2048];
    snprintf(text, sizeof text,
             "{\"seed\": 4, \"units\": \"%s\", \"box\": [%g, %g, %g], \"temperature\": 300,\n"
             "\"time_step\": 1e-6, \"precision\": \"double\", \"rdf\": {\"range\": %g},\n"
             "\"particles\": {\"count\": 200, \"mass\": 20},\n"
             "\"many_body\": {\"a\": {\"weight\": {\"law\": \"lucy\", \"cutoff\": %g},\n"
             "  \"energy\": {\"law\": \"polynomial\", \"c1\": %.17g, \"c2\": %.17g}},\n"
             " \"b\": {\"weight\": {\"law\": \"many-body-dpd\", \"cutoff\": %g},\n"
             "  \"energy\": {\"law\": \"many-body-dpd\", \"b\": %.17g, \"cutoff\": %g}},\n"
             " \"c\": {\"weight\": {\"law\": \"sanyal-shell\", \"cutoff\": %g},\n"
             "  \"energy\": {\"law\": \"expression\", \"formula\": \"%.17g*exp(-rho/3)\",\n"
             "  \"maximum\": 90}}}, \"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
             "\"measure\": {\"equilibration\": 0, \"samples\": 1, \"every\": 1}}\n",
             system, 2 * length, 2 * length, 2.5 * length, length, 0.6 * length,
             3 * unit * pow(length, 3), 0.02 * unit * pow(length, 6), 0.7 * length,
             1.5 * unit * pow(length, 2), 0.7 * length, 0.8 * length, 12 * unit);
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", system);
    run_program_assert_code(&result, 0);
    char summary[64];
    snprintf(summary, sizeof summary, "%s/summary.json", system);
    return results_number(summary, "potential_energy") / unit;
}

static void test_units_of_a_file_are_those_of_its_densities(void **state) {
    const double here = energy_in(*state, "nm-ps", 1, 1);
    assert_true(fabs(here) > 1);
    assert_close_relative(energy_in(*state, "angstrom-fs", 10, 1 / 4.184), here, 1e-6);
}

/// Of two beads 0.2 nm apart, with λ = 0.5 nm: Lucy's weight, 105/(16π r_c³) (1 + 3x)(1 − x)³ with
/// x = r/r_c, r_c = 0.4 nm, is 10.2 per nm³ for each, beyond a table from 0 to 3 per nm³.
static void test_densities_beyond_a_table_are_told_in_the_units_of_the_file(void **state) {
    static const char pair[] =
        "{\"units\": {\"system\": \"nm-ps\", \"length\": 0.5, \"temperature\": 300, \"mass\": "
        "20},\n"
        "\"box\": [3, 3, 3], \"time_step\": 1e-9, \"temperature\": 300, \"rdf\": {\"range\": 1},\n"
        "\"particles\": {\"count\": 2, \"placement\": \"file\", \"file\": \"start.tsv\", \"mass\": "
        "20},\n"
        "\"many_body\": {\"pair\": {\"weight\": {\"law\": \"lucy\", \"cutoff\": 0.4},\n"
        "  \"energy\": {\"law\": \"expression\", \"formula\": \"rho\", \"maximum\": 3}}},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 1}}\n";
    static const char words[] =
        "many_body.pair.energy: densities were 10.2 to 10.2 1/nm^3, never in "
        "the table from 0 to 3: ";
    temporary_folder_write(*state, "start.tsv", "1 1 1\n1 1 1.2\n", 14);
    small_inputs_write(*state, "scene.json", pair, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, words);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, words); // a warning is no progress
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, words);
    free(summary);
}

/// Of a dimer 0.5 long with f = −2ρ, excluded or not: 0, or −2 w(0.5) for each bead.
static void test_excluded_pairs_do_not_count(void **state) {
    static const char dimer[] =
        "{\"box\": [8, 8, 8], \"time_step\": 1e-9, \"precision\": \"double\", \"rdf\": {\"range\": "
        "1},\n"
        "\"bonds\": {\"rod\": {\"law\": \"harmonic\", \"k\": 5, \"length\": 0.5}},\n"
        "\"molecules\": {\"dimer\": {\"count\": 1, \"exclude\": 1, \"chain\": {\"beads\": "
        "[\"A\", \"A\"], \"bond\": \"rod\"}}},\n"
        "\"particles\": {\"placement\": \"file\", \"file\": \"start.tsv\"},\n"
        "\"many_body\": {\"cohesion\": {\"weight\": {\"law\": \"sanyal-shell\", \"cutoff\": 1},\n"
        "  \"energy\": {\"law\": \"polynomial\", \"c1\": -2}}},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 1, \"every\": 1}}\n";
    static const char start[] = "1 1 1\n1 1 1.5\n";
    const double x = 0.25, w = 1 - x * x * (3 - 2 * x);
    temporary_folder_write(*state, "start.tsv", start, strlen(start));
    for (int excluded = 0; excluded < 2; excluded++) {
        small_inputs_write(*state, "scene.json", dimer, "\"exclude\": 1",
                           excluded ? "\"exclude\": 1" : "\"exclude\": 0");
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        assert_close(results_number("out/summary.json", "potential_energy"), excluded ? 0 : -2 * w,
                     1e-5);
    }
}

static void test_what_cannot_be_is_refused_in_one_line(void **state) {
    static const struct {
        const char *from, *to, *words[2];
    } cases[] = {
        {"\"inner_cutoff\": 0.4",
         "\"inner_cutoff\": 1.2",
         {"many_body.shell.weight: the inner_cutoff 1.2 is not below the cutoff 1.2", NULL}},
        {"{\"law\": \"table\", \"file\": \"w.tsv\"}",
         "{\"law\": \"expression\", \"formula\": \"2\", \"cutoff\": 1}",
         {"many_body.file.weight: the weight is 0 at all distances: it has no range", NULL}},
        {"\"weight\": {\"law\": \"table\", \"file\": \"w.tsv\"},\n",
         "",
         {"many_body.file.weight: missing", NULL}},
        {"\"cutoff\": 0.75},\n", "\"cutof\": 0.75},\n", {"many_body.crowd.weight.cutof", "cutoff"}},
        {"\"central\": \"A\"",
         "\"central\": \"A, D\"",
         {"many_body.shell.central: \"D\" is no type of \"particles\"", NULL}},
        {"\"central\": \"A\", \"neighbours\": \"B, C\"",
         "\"central\": \"C\", \"neighbours\": \"C\"",
         {"many_body.shell: no density occurs", NULL}},
        {"\"maximum\": 8",
         "\"maximum\": -1",
         {"many_body.shell.energy: the minimum 0 is not below the maximum -1", NULL}},
        {"rho^2/10", "1/(rho - 1)", {"many_body.shell.energy: the formula", "near rho = "}},
        {"rho^2/10", "r^2", {"unknown name: only rho, exp, sqrt,", NULL}},
        {"\"b\": 25, \"cutoff\": 0.75",
         "\"b\": 25, \"cutoff\": 0.8",
         {"many_body.crowd.energy: the cutoff 0.8 is not that of the weight, 0.75", NULL}},
        {"\"weight\": {\"law\": \"many-body-dpd\"",
         "\"weight\": {\"law\": \"lucy\"",
         {"many_body.crowd.energy: the law \"many-body-dpd\" needs the weight", "not \"lucy\""}},
        {"f.tsv", "g.tsv", {"many_body.file.energy.file", "g.tsv"}},
        {"\"cutoff\": 1.2", "\"cutoff\": 1.7", {"twice the cutoff 1.7", NULL}},
        {"\"dissipative\": {\"law\": \"power\", \"sigma\": 2}",
         "\"dynamics\": {\"integrator\": \"monte-carlo\"}",
         {"many_body: \"monte-carlo\" moves by the energy of pairs and molecules alone", NULL}},
        {"\"dissipative\": {\"law\": \"power\", \"sigma\": 2}",
         "\"dynamics\": {\"integrator\": \"event-driven\"}",
         {"event-driven", NULL}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_all(*state, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
        run_program_assert_refused(
            &result, ".", cases[k].to, 1,
            (const char *const[]){cases[k].words[0], cases[k].words[1], NULL});
    }
}

#define CASE(test) cmocka_unit_test_setup_teardown(test, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        CASE(test_a_scene_is_read_and_written_back),
        CASE(test_a_polynomial_without_coefficients_is_told),
        CASE(test_other_tables_have_other_energies),
        CASE(test_units_of_a_file_are_those_of_its_densities),
        CASE(test_densities_beyond_a_table_are_told_in_the_units_of_the_file),
        CASE(test_excluded_pairs_do_not_count),
        CASE(test_what_cannot_be_is_refused_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
