// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tables of laws as LAMMPS (manual, pair_style table) and GROMACS (reference manual, "Tabulated
// interaction functions") have them are the laws of the same r and energy in two columns.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>

enum { ROWS = 41, SIZE = 1 << 13 };
static struct run_program_result result;

static const char scene[] =
    "{\"seed\": 2, \"box\": [4, 4, 4], \"time_step\": 0.01, \"particles\": {\"count\": 150},\n"
    "\"conservative\": {\"law\": \"table\", \"file\": \"law.tsv\"},\n"
    "\"measure\": {\"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n";

static const char dimers[] =
    "{\"seed\": 2, \"box\": [4, 4, 4], \"time_step\": 0.01,\n"
    "\"bonds\": {\"spring\": {\"law\": \"table\", \"file\": \"law.tsv\"}},\n"
    "\"molecules\": {\"dimer\": {\"count\": 40, \"chain\": {\"beads\": [\"A\", \"A\"], \"bond\": "
    "\"spring\"}}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"measure\": {\"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n";

/// 12 (1 − r)², of which the table has every 40th of its range.
static double r_of(int k) {
    return 0.2 + 0.02 * k;
}

static double energy(double r) {
    return 12 * (1 - r) * (1 - r);
}

enum form { PLAIN, LAMMPS, GROMACS_C12, GROMACS_C6, GROMACS_CHARGES, NUMBERED, INDEXED, SECTIONS };

static int write_row(char *text, size_t size, enum form form, int k) {
    const double r = r_of(k), force = 24 * (1 - r);
    switch (form) {
    case PLAIN:
        return snprintf(text, size, "%.10g %.10g\n", r, energy(r));
    case GROMACS_C12:
        return snprintf(text, size, "%.10g 0 0 0 0 %.10g %.10g\n", r, energy(r), force);
    case GROMACS_C6:
        return snprintf(text, size, "%.10g 0 0 %.10g %.10g 0 0\n", r, energy(r), force);
    case GROMACS_CHARGES:
        return snprintf(text, size, "%.10g %.10g 1 0 0 %.10g %.10g\n", r, 1 / r, energy(r), force);
    default:
        return snprintf(text, size, "%d %.10g %.10g %.10g\n", k + (form != INDEXED), r, energy(r),
                        force);
    }
}

static void write_table(struct temporary_folder *folder, enum form form) {
    char text[SIZE];
    size_t length = 0;
    text[0] = '\0';
    if (form == LAMMPS || form == SECTIONS)
        length += (size_t)snprintf(text, SIZE,
                                   "# DATE: 2022-01-01 UNITS: lj\n\nAA\nN %d R 0.2 1.0\n\n", ROWS);
    if (form == GROMACS_C12) // what GROMACS has where nothing comes
        length += (size_t)snprintf(text, SIZE, "# by hand\n0 0 0 0 0 0 0\n0.02 0 0 0 0 0 0\n");
    for (int k = 0; k < ROWS; k++)
        length += (size_t)write_row(text + length, SIZE - length, form, k);
    if (form == SECTIONS)
        snprintf(text + length, SIZE - length, "\nAB\nN 3\n\n1 0.2 3 1\n2 0.3 2 1\n3 0.4 1 1\n");
    small_inputs_write(folder, "law.tsv", text, NULL, NULL);
}

static void simulate(struct temporary_folder *folder, const char *text, enum form form,
                     const char *out) {
    write_table(folder, form);
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out, "--quiet");
    run_program_assert_code(&result, 0);
}

static void refuse(struct temporary_folder *folder, const char *text, enum form form,
                   const char *words) {
    write_table(folder, form);
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "bad");
    run_program_assert_refused(&result, ".", words, 1,
                               (const char *const[]){"law.tsv", words, NULL});
}

static void test_tables_of_others_are_the_law_of_their_r_and_energy(void **state) {
    static const char *const same[] = {"rdf.tsv", "thermodynamics.tsv", NULL};
    simulate(*state, scene, PLAIN, "plain");
    simulate(*state, scene, LAMMPS, "lammps");
    results_assert_same("plain", "lammps", same);
    simulate(*state, scene, GROMACS_C12, "repulsive");
    results_assert_same("plain", "repulsive", same);
    simulate(*state, scene, GROMACS_C6, "attractive");
    results_assert_same("plain", "attractive", same);
    simulate(*state, dimers, PLAIN, "dimers");
    simulate(*state, dimers, LAMMPS, "of_lammps");
    results_assert_same("dimers", "of_lammps", same);
}

/// In nm and kJ/mol, of a table in Å and kcal/mol.
static void test_tables_of_lammps_have_the_units_that_they_say(void **state) {
    static const char physical[] =
        "{\"units\": \"nm-ps\", \"temperature\": 300, \"seed\": 2, \"box\": [4, 4, 4],\n"
        "\"time_step\": 0.001, \"particles\": {\"count\": 600, \"mass\": 20},\n"
        "\"conservative\": {\"law\": \"table\", \"file\": \"law.tsv\"},\n"
        "\"measure\": {\"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n";
    static const char *const begins[] =
        {"# r[A] U[kcal/mol] F\n", "# DATE: 2022-01-01 UNITS: real CONTRIBUTOR: x\nAA\nN 21\n\n"},
                             *const folders[] = {"named", "lammps"};
    for (int lammps = 0; lammps < 2; lammps++) {
        char text[SIZE];
        size_t length = (size_t)snprintf(text, SIZE, "%s", begins[lammps]);
        for (int k = 0; k <= 20; k++) {
            if (lammps)
                length += (size_t)snprintf(text + length, SIZE - length, "%d ", k + 1);
            length += (size_t)snprintf(text + length, SIZE - length, "%g %g %g\n", 2 + 0.2 * k,
                                       0.05 * (20 - k) * (20 - k), 0.5 * (20 - k));
        }
        small_inputs_write(*state, "law.tsv", text, NULL, NULL);
        small_inputs_write(*state, "scene.json", physical, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", folders[lammps], "--quiet");
        run_program_assert_code(&result, 0);
    }
    results_assert_same("named", "lammps",
                        (const char *const[]){"rdf.tsv", "thermodynamics.tsv", NULL});
}

static void test_tables_of_others_are_refused_when_they_say_too_little(void **state) {
    refuse(*state, scene, NUMBERED, "column 1 numbers the rows: leave it out, so that r is first");
    refuse(*state, dimers, NUMBERED, "column 1 numbers the rows: leave it out, so that r is first");
    refuse(*state, scene, INDEXED, "column 1 numbers the rows: leave it out, so that r is first");
    refuse(*state, scene, GROMACS_CHARGES,
           "write r and the potential, C6 g + C12 h, in two columns");
    static const char friction[] =
        "{\"box\": [4, 4, 4], \"time_step\": 0.01, \"particles\": {\"count\": 150},\n"
        "\"dissipative\": {\"law\": \"table\", \"file\": \"law.tsv\"}}\n";
    refuse(*state, friction, GROMACS_C12,
           "seven columns without names, as GROMACS has a potential of pairs, which this is not");
    refuse(*state, scene, SECTIONS, "law.tsv:48: a second section of LAMMPS begins");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

/// A curve of time and places, as a spreadsheet or pandas writes them.
static void test_numbered_rows_of_times_and_places_are_told(void **state) {
    static const char run[] =
        "{\"target\": {\"vacf\": {\"file\": \"law.tsv\"}}, \"unknowns\": {\"omega\": {\"maximum\": "
        "5}},\n"
        "\"scene\": {\"box\": [5, 5, 5], \"particles\": {\"count\": 300}, \"temperature\": 1},\n"
        "\"method\": {\"name\": \"gauss-newton\"}}\n";
    static const char placed[] =
        "{\"box\": [5, 5, 5], \"time_step\": 0.01,\n"
        "\"particles\": {\"count\": 3, \"placement\": \"file\", \"file\": \"places.tsv\"}}\n";
    small_inputs_write(*state, "law.tsv",
                       "1 0 1 0.01\n2 0.05 0.9 0.01\n3 0.1 0.7 0.01\n4 0.15 0.6 0.01\n", NULL,
                       NULL);
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "bad");
    assert_contains(result.err, "law.tsv: column 1 numbers the rows, and column 2 grows as a time "
                                "does: set \"time_column\" to 2");
    // From 0, where the first column could be times: those are equally far apart, values are not.
    small_inputs_write(*state, "law.tsv",
                       "0 0 1 0.01\n1 0.05 0.9 0.01\n2 0.1 0.7 0.01\n3 0.15 0.6 0.01\n", NULL,
                       NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "bad");
    assert_contains(result.err, "law.tsv: column 1 numbers the rows, and column 2 grows");
    small_inputs_write(*state, "run.json", run, "\"vacf\": {\"file\": \"law.tsv\"}",
                       "\"etd\": {\"file\": \"law.tsv\", \"r_maximum\": 1}");
    for (int from = 0; from < 2; from++) {
        small_inputs_write(*state, "law.tsv",
                           from ? "1 0 1 1\n2 0.05 0.9 0.8\n3 0.1 0.7 0.6\n"
                                : "0 0 1 1\n1 0.05 0.9 0.8\n2 0.1 0.7 0.6\n",
                           NULL, NULL);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "bad");
        assert_contains(result.err, "law.tsv: column 1 numbers the rows, and column 2 grows as a "
                                    "time does: set \"time_column\" to 2 and \"first_column\" to");
    }
    small_inputs_write(*state, "places.tsv", "0 1 2 3\n1 2 3 1\n2 3 4 2\n", NULL, NULL);
    small_inputs_write(*state, "scene.json", placed, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "bad");
    assert_contains(result.err, "places.tsv: column 1 numbers the rows: leave it out");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_tables_of_others_are_the_law_of_their_r_and_energy),
        TEST(test_tables_of_lammps_have_the_units_that_they_say),
        TEST(test_tables_of_others_are_refused_when_they_say_too_little),
        TEST(test_numbered_rows_of_times_and_places_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
