// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit export` from outside: what is refused, told and spared, and where a fit lets another run
// begin. What stands in the tables: test_export.c.
#include "shared/other_engine.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void run_export(struct run_program_result *result, const char *engine, const char *folder) {
    RUN_PROGRAM(result, "export", "out", "--engine", engine, "-o", folder);
    run_program_assert_code(result, 0);
}

/// One line on stderr, exit code 2, and no folder.
static void assert_refused(const char *folder, const char *engine, const char *option,
                           const char *word) {
    static struct run_program_result result;
    struct stat found;
    RUN_PROGRAM(&result, "export", folder, "--engine", engine, "-o", "empty/to", option);
    run_program_assert_refused(&result, "empty", word, 1, (const char *const[]){word, NULL});
    assert_int_not_equal(stat("empty/to", &found), 0);
}

/// The README of an export of a small scene in nm and ps.
static void export_of(struct temporary_folder *folder, const char *mass, char **readme) {
    static const char text[] =
        "{\"units\": \"nm-ps\", \"box\": [3, 3, 3], \"particles\": {\"count\": 81 MASS},\n"
        "\"temperature\": 300, \"time_step\": 0.01, \"dissipative\": {\"law\": \"power\", "
        "\"sigma\": "
        "3, \"cutoff\": 1},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25, \"cutoff\": 1},\n"
        "\"measure\": {\"equilibration\": 10, \"samples\": 20, \"every\": 5}}\n";
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", text, "MASS", mass);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps", "--force");
    run_program_assert_code(&result, 0);
    *readme = temporary_folder_read("lammps/README");
}

/// Without a mass a density of 1 u a bead would be a false one.
static void test_density_in_grams_needs_a_mass(void **state) {
    char *readme;
    export_of(*state, ", \"mass\": 18", &readme);
    assert_contains(readme, "at 0.003 1/A^3 (0.08967 g/cm^3)");
    free(readme);
    export_of(*state, "", &readme);
    assert_contains(readme, "at 0.003 1/A^3, and so");
    assert_null(strstr(readme, "g/cm^3"));
    free(readme);
}

static void test_what_cannot_be_exported_is_one_line(void **state) {
    static struct run_program_result result;
    assert_int_equal(mkdir("empty", 0777), 0);
    assert_refused("nowhere", "lammps", NULL, "No such file");
    assert_refused("empty", "lammps", NULL, "used.json");
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_refused("out", "lamps", NULL, "lammps");
    assert_refused("out", "lammps", "--bands", "no errors");
    small_scenes_write(*state, small_scenes_dpd, "\"dissipative\"",
                       "\"interactions\": {\"uniform-force\": {\"force\": [1, 0, 0]}}, "
                       "\"dissipative\"");
    small_scenes_simulate(&result, "pushed");
    assert_refused("pushed", "lammps", NULL, "uniform-force");
    small_scenes_write(*state, small_scenes_dpd,
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}",
                       "\"dynamics\": {\"integrator\": \"brownian\"}");
    char *scene = temporary_folder_read("scene.json");
    small_scenes_write(*state, scene, "\"time_step\": 0.04", "\"time_step\": 0.001");
    free(scene);
    small_scenes_simulate(&result, "overdamped");
    assert_refused("overdamped", "gromacs", NULL, "without velocities");
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "pushed");
    assert_int_equal(result.code, 2);
    assert_contains(result.err, "holds a result");
    // What `measure` writes.
    temporary_folder_write(*state, "empty/target.json", "{}", 2);
    RUN_PROGRAM(&result, "export", "empty", "--engine", "lammps", "-o", "to");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "fit it first (mesofit fit --target empty -o fit)");
    RUN_PROGRAM(&result, "export", "out");
    assert_int_equal(result.code, 2);
    assert_contains(result.err, "--engine");
}

/// What stands in its place would be another friction, called the result's own: with memory all
/// of it is left out, and of engines that have none across pairs likewise.
static void test_friction_that_an_engine_has_not_is_left_out_and_told(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *instead, *engine, *out, *to, *left_out, *script;
    } cases[] = {
        {"\"memory\": {\"slow\": {\"time\": 0.3, \"omega\": {\"law\": \"power\", \"sigma\": 2}}}",
         "lammps", "slow", "to-slow", "Friction with memory is left out", "to-slow/in.mesofit"},
        {"\"dissipative_transverse\": {\"law\": \"power\", \"sigma\": 2},\n"
         "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}",
         "hoomd", "across", "to-across", "Friction across pairs is left out", "to-across/run.py"}};
    for (int k = 0; k < 2; k++) {
        char readme[64];
        small_scenes_write(*state, small_scenes_dpd,
                           "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}",
                           cases[k].instead);
        small_scenes_simulate(&result, cases[k].out);
        RUN_PROGRAM(&result, "export", cases[k].out, "--engine", cases[k].engine, "-o",
                    cases[k].to);
        run_program_assert_code(&result, 0);
        assert_contains(result.err, "warning");
        assert_contains(result.err, cases[k].left_out);
        assert_int_equal(strstr(result.err, "LAMMPS (dpd/ext/tstat) and ESPResSo") != NULL, k);
        snprintf(readme, sizeof readme, "%s/README", cases[k].to);
        char *text = temporary_folder_read(readme);
        assert_contains(text, cases[k].left_out);
        assert_null(strstr(text, "result's own omega"));
        free(text);
        text = temporary_folder_read(cases[k].script);
        assert_null(strstr(text, " dpd/ext")); // of LAMMPS
        assert_int_equal(strstr(text, "dpd = False") != NULL, k);
        free(text);
    }
}

/// gamma along and across, then both exponents; of ESPResSo one exponent.
static void test_friction_across_pairs_goes_to_engines_that_have_it(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd,
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}",
                       "\"dissipative_transverse\": {\"law\": \"power\", \"sigma\": 2, "
                       "\"exponent\": EXPONENT},\n"
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}");
    char *scene = temporary_folder_read("scene.json");
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "scene.json", scene, "EXPONENT", k ? "1.5" : "1");
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet", "--force");
        run_program_assert_code(&result, 0);
        RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps", "--force");
        run_program_assert_code(&result, 0);
        char *text = temporary_folder_read("lammps/in.mesofit");
        const char *at = strstr(text, "pair_coeff 1 1 dpd/ext/tstat ");
        double gamma[2], exponent[2], cutoff;
        assert_non_null(at);
        assert_int_equal(sscanf(at, "pair_coeff 1 1 dpd/ext/tstat %lf %lf %lf %lf %lf", &gamma[0],
                                &gamma[1], &exponent[0], &exponent[1], &cutoff),
                         5);
        assert_true(gamma[0] > 0 && fabs(gamma[1] / gamma[0] * 9 / 4 - 1) < 2e-3);
        assert_true(exponent[0] == 1 && fabs(exponent[1] - (k ? 1.5 : 1)) < 2e-3 && cutoff > 0);
        assert_null(strstr(text, "== exact")); // which has none across pairs
        free(text);
    }
    small_inputs_write(*state, "scene.json", scene, "EXPONENT", "1");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet", "--force");
    RUN_PROGRAM(&result, "export", "out", "--engine", "espresso", "-o", "espresso");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "friction   that of the result: dpd with weight_function 1");
    free(scene);
    char *text = temporary_folder_read("espresso/run.py");
    double gamma, cutoff[2], across;
    const char *at = strstr(text, "frictions[0, 0] = ");
    assert_non_null(at);
    assert_int_equal(sscanf(at,
                            "frictions[0, 0] = dict(k=1, gamma=%lf, r_cut=%lf, trans_gamma=%lf, "
                            "trans_r_cut=%lf)",
                            &gamma, &cutoff[0], &across, &cutoff[1]),
                     4);
    assert_true(gamma > 0 && fabs(across / gamma * 9 / 4 - 1) < 1e-4 && cutoff[0] == cutoff[1]);
    free(text);
}

static void test_title_stays_in_the_line_of_its_comment(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, "\"seed\": 5",
                       "\"seed\": 5, \"title\": \"soft\\nshell ls\"");
    small_scenes_simulate(&result, "out");
    run_export(&result, "lammps", "lammps");
    char *input = temporary_folder_read("lammps/in.mesofit");
    assert_null(strstr(input, "\nshell ls"));
    assert_contains(input, "# soft shell ls: written by mesofit");
    free(input);
}

static void write_types(struct temporary_folder *folder, const char *types) {
    char scene[1024];
    snprintf(scene, sizeof scene,
             "{\"seed\": 1, \"box\": [3, 3, 3], \"particles\": {\"types\": {%s}}, \"time_step\": "
             "0.01,\n\"conservative\": {\"law\": \"soft-repulsion\"}, \"measure\": "
             "{\"equilibration\": 5, \"samples\": 2, \"every\": 2}}\n",
             types);
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
}

/// Of GROMACS the names of two files, of DL_POLY eight letters of each name.
static void test_pairs_that_an_engine_would_take_for_one_are_refused(void **state) {
    static struct run_program_result result;
    write_types(*state, "\"A\": 20, \"B_C\": 20, \"A_B\": 20, \"C\": 20");
    assert_int_equal(mkdir("empty", 0777), 0);
    small_scenes_simulate(&result, "out");
    assert_refused("out", "gromacs", NULL,
                   "pairs A-B_C and A_B-C would have the same name, \"A_B_C\"");
    run_export(&result, "dl_poly", "dl_poly");
    write_types(*state, "\"LongNameAlpha1\": 40, \"LongNameAlpha2\": 40");
    small_scenes_simulate(&result, "out");
    assert_refused("out", "dl_poly", NULL, "the same name, \"LongName LongName\"");
    run_export(&result, "gromacs", "gromacs");
    write_types(*state, "\"LongNameAlpha\": 40, \"Short\": 40");
    small_scenes_simulate(&result, "out");
    run_export(&result, "dl_poly", "one-long");
    char *text = temporary_folder_read("one-long/FIELD");
    assert_contains(text, "\nLongName Short    tab\n");
    free(text);
}

/// What LAMMPS cannot have between its quotes does not stand in its input.
static void test_folders_may_have_quotes_in_their_names(void **state) {
    static struct run_program_result result;
    static const char *const folders[] = {"it's", "q\"q", "d$x", "\xc3\xbc", "plain one"};
    const bool runs = other_engine_runs("lmp");
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    for (int k = 0; k < 5; k++) {
        char path[64];
        run_export(&result, "lammps", folders[k]);
        snprintf(path, sizeof path, "%s/in.mesofit", folders[k]);
        char *input = temporary_folder_read(path);
        assert_int_equal(strstr(input, "shell cd") != NULL, k == 4);
        assert_contains(input, "start LAMMPS in the folder of this input'\" \"quit 1\"");
        free(input);
        assert_int_equal(chdir(folders[k]), 0);
        if (runs)
            assert_int_equal(system("lmp -in in.mesofit -var steps 10 -var equilibration 10 -var "
                                    "every 5 -log none >lmp.out 2>&1"),
                             0);
        assert_int_equal(chdir(".."), 0);
    }
}

/// Started above, LAMMPS cannot tell a copy from the folder that was written. What it writes is
/// where it was started, and the results of the first stay as they are.
static void test_a_copy_leaves_the_first_alone(void **state) {
    static struct run_program_result result;
    other_engine_skip_without("lmp");
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_int_equal(mkdir("deep", 0777), 0);
    run_export(&result, "lammps", "deep/the first");
    assert_int_equal(
        system("run() { lmp -in \"$1\" -var steps 10 -var equilibration 10 -var every 5 "
               "-var seed $2 -log none >lmp.out 2>&1; }\n"
               "(cd 'deep/the first' && run in.mesofit 1) && cp -r deep copy &&\n"
               "run 'copy/the first/in.mesofit' 2 && grep -q 'those in deep' lmp.out &&\n"
               "cmp 'deep/the first/rdf.dat' 'copy/the first/rdf.dat' &&\n"
               "! cmp -s 'deep/the first/rdf.dat' rdf.dat"),
        0);
    assert_int_equal(system("cd copy && lmp -in 'the first/in.mesofit' -log none >lmp.out 2>&1"),
                     256);
    char *said = temporary_folder_read("copy/lmp.out");
    assert_contains(said, "start LAMMPS in the folder of this input");
    free(said);
}

static void test_folders_of_others_are_spared(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    assert_int_equal(mkdir("gromacs", 0777), 0);
    temporary_folder_write(*state, "gromacs/topol.top", "mine", 4);
    RUN_PROGRAM(&result, "export", "out", "--engine", "gromacs");
    assert_int_equal(result.code, 2);
    assert_contains(result.err, "gromacs: the folder holds files that are not of an export");
    temporary_folder_write(*state, "gromacs/README", "of mine", 7);
    RUN_PROGRAM(&result, "export", "out", "--engine", "gromacs");
    assert_int_equal(result.code, 2);
    char *text = temporary_folder_read("gromacs/topol.top");
    assert_string_equal(text, "mine");
    free(text);
    run_export(&result, "gromacs", "again");
    run_export(&result, "gromacs", "again");
}

static void test_fit_leaves_where_another_run_begins(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit");
    results_assert_table("fit/configuration.tsv", 6, 0);
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "-o", "lammps", "--bands");
    run_program_assert_code(&result, 0);
    char *table = temporary_folder_read("lammps/mesofit.table");
    assert_contains(table, "PHI_A-A_lower");
    assert_contains(table, "PHI_A-A_upper");
    free(table);
    // The first particle of both files is in the same place.
    double x, start;
    char *text = temporary_folder_read("fit/configuration.tsv");
    assert_int_equal(sscanf(strchr(text, '\n'), "%lf", &x), 1);
    free(text);
    text = temporary_folder_read("lammps/data.mesofit");
    assert_int_equal(sscanf(strstr(text, "Atoms # atomic") + 14, "%*d %*d %lf", &start), 1);
    free(text);
    assert_true(fabs(x - start) < 1e-9);
}

/// A fit that speaks nm and ps: where its first bead is, in Å.
static void test_fit_in_nm_and_ps_is_exported(void **state) {
    static struct run_program_result result;
    static const char target[] = "# r[nm] g error\n0.05 0.3 0.1\n0.15 0.6 0.1\n0.25 0.8 0.1\n"
                                 "0.35 1.1 0.1\n0.45 1.0 0.1\n";
    static const char run[] =
        "{\"units\": \"nm-ps\", \"seed\": 1, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
        "\"scene\": {\"box\": [1.5, 1.5, 1.5], \"particles\": {\"count\": 81, \"mass\": 18},\n"
        "\"temperature\": 300, \"time_step\": 0.02,\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 9, \"cutoff\": 0.5}},\n"
        "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 1, \"samples\": 8, "
        "\"every\": 1, \"iterations\": 1},\n"
        "\"verification\": {\"replicas\": 1, \"equilibration\": 1, \"samples\": 2, \"every\": "
        "1}}\n";
    double x, start, friction;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", target, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_export(&result, "lammps", "lammps");
    char *text = temporary_folder_read("out/configuration.tsv");
    assert_contains(text, "x[nm]");
    assert_int_equal(sscanf(strchr(text, '\n'), "%lf", &x), 1);
    free(text);
    text = temporary_folder_read("lammps/data.mesofit");
    assert_int_equal(sscanf(strstr(text, "Atoms # atomic") + 14, "%*d %*d %lf", &start), 1);
    free(text);
    assert_true(fabs(10 * x - start) < 1e-8);
    text = temporary_folder_read("lammps/in.mesofit"); // 81 u/ps in kcal/mol fs/A²
    const char *found = strstr(text, "pair_coeff 1 1 dpd/tstat ");
    assert_non_null(found);
    friction = strtod(found + strlen("pair_coeff 1 1 dpd/tstat "), NULL);
    free(text);
    assert_true(fabs(friction / (81 * 1e-3 * 48.88821291 * 48.88821291) - 1) < 1e-5);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_density_in_grams_needs_a_mass),
        TEST(test_what_cannot_be_exported_is_one_line),
        TEST(test_friction_that_an_engine_has_not_is_left_out_and_told),
        TEST(test_friction_across_pairs_goes_to_engines_that_have_it),
        TEST(test_title_stays_in_the_line_of_its_comment),
        TEST(test_pairs_that_an_engine_would_take_for_one_are_refused),
        cmocka_unit_test_setup_teardown(test_a_copy_leaves_the_first_alone, small_inputs_enter,
                                        small_inputs_leave),
        TEST(test_folders_may_have_quotes_in_their_names),
        TEST(test_folders_of_others_are_spared),
        TEST(test_fit_leaves_where_another_run_begins),
        TEST(test_fit_in_nm_and_ps_is_exported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
