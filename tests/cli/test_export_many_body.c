// SPDX-License-Identifier: GPL-3.0-or-later
//
// "many_body" of a scene in LAMMPS's format of eam/fs, read back by the rules of its manual, and
// what is refused. Beside LAMMPS itself: physics/test_export_lammps_many_body.
#include "curves/weight.h"
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static struct run_program_result result;

/// In nm, ps and kJ/mol.
static const char scene[] =
    "{\"seed\": 1, \"units\": \"nm-ps\", \"box\": [2.4, 2.5, 2.6], \"time_step\": 0.01,\n"
    "\"temperature\": 300, \"particles\": {\"types\": {\"A\": 40, \"B\": 50, \"C\": 60}, \"mass\": "
    "18},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 8, \"cutoff\": 0.6},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 20, \"cutoff\": 0.6},\n"
    "\"many_body\": {\n"
    "  \"crowd\": {\"weight\": {\"law\": \"sanyal-shell\", \"cutoff\": 0.8},\n"
    "    \"energy\": {\"law\": \"polynomial\", \"c1\": -0.5, \"c2\": 0.1, \"origin\": 6}},\n"
    "  \"shell\": {\"central\": \"C A\", \"neighbours\": \"B\",\n"
    "    \"weight\": {\"law\": \"lucy\", \"cutoff\": 0.7},\n"
    "    \"energy\": {\"law\": \"expression\", \"formula\": \"-2*rho/(rho + 4)\", \"maximum\": "
    "20}}},\n"
    "\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}}\n";

static void simulate(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
}

/// Rows of numbers: `unit` times a curve of places `step` apart, as far as they are below `end`.
static void read_rows(FILE *stream, int rows, double step, double end, double unit,
                      double (*curve)(double)) {
    for (int k = 0; k < rows; k++) {
        double value;
        assert_int_equal(fscanf(stream, "%lf", &value), 1);
        if (step * k <= end * (1 + 1e-9))
            assert_close(value, unit * curve(step * k), 1e-6 * (1 + fabs(value)));
    }
}

static double nothing(double x) {
    (void)x;
    return 0;
}

/// One file of three types: cutoff in A, f in kcal/mol, w of each neighbour at each type.
static void read_density(const char *path, double cutoff, int central, int neighbours,
                         double (*energy)(double), double (*weight)(double)) {
    FILE *stream = fopen(path, "r");
    char line[512];
    int rows[2];
    double step[2], found, mass;
    assert_non_null(stream);
    assert_non_null(fgets(line, sizeof line, stream));
    assert_string_equal(line, "# UNITS: real\n");
    for (int k = 0; k < 2; k++)
        assert_int_equal(fgets(line, sizeof line, stream)[0], '#');
    assert_string_equal(fgets(line, sizeof line, stream), "3 T1 T2 T3\n");
    assert_int_equal(
        fscanf(stream, "%d %lf %d %lf %lf", &rows[0], &step[0], &rows[1], &step[1], &found), 5);
    assert_close(found, cutoff, 1e-9);
    assert_true(step[1] * (rows[1] - 3) > cutoff * (1 - 1e-9));
    for (int type = 0; type < 3; type++) {
        const bool has_energy = central >> type & 1, counts = neighbours >> type & 1;
        assert_int_equal(fscanf(stream, "%*d %lf %*d none", &mass), 1);
        assert_close(mass, 18, 1e-9);
        read_rows(stream, rows[0], step[0], step[0] * rows[0], 1 / 4.184,
                  has_energy ? energy : nothing);
        for (int at = 0; at < 3; at++)
            read_rows(stream, rows[1], step[1], cutoff, 1,
                      counts && central >> at & 1 ? weight : nothing);
    }
    for (int pair = 0; pair < 6; pair++)
        read_rows(stream, rows[1], step[1], cutoff, 1, nothing);
    assert_int_equal(fscanf(stream, "%lf", &found), EOF);
    fclose(stream);
}

static double crowd(double density) {
    const double x = density - 6;
    return -0.5 * x + 0.1 * x * x - (0.5 * 6 + 0.1 * 36);
}

/// Of 1/A^3. Beyond 20 1/nm^3 as a straight line, whose slope is −8/24².
static double shell(double per_cubic_angstrom) {
    const double density = 1000 * per_cubic_angstrom;
    return density < 20 ? -2 * density / (density + 4) : -40.0 / 24 - 8.0 / 576 * (density - 20);
}

static double crowd_weight(double r) {
    return weight_sanyal_shell(r * r, 0, 64);
}

/// Lucy's, in 1/A^3.
static double shell_weight(double r) {
    return 105 / (16 * M_PI * 343) * (1 + 3 * r / 7) * pow(1 - r / 7, 3);
}

static void test_densities_are_what_lammps_reads(void **state) {
    simulate(*state, NULL, NULL);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    read_density("lammps/crowd.eam.fs", 8, 7, 7, crowd, crowd_weight);
    read_density("lammps/shell.eam.fs", 7, 5, 2, shell, shell_weight);
    char *input = temporary_folder_read("lammps/in.mesofit");
    assert_contains(input, "\"pair_style hybrid/overlay table linear ");
    assert_contains(input, " eam/fs eam/fs\" &\n  \"pair_coeff 1 1 table mesofit.table PHI_A-A");
    assert_contains(input, " dpd/tstat ");
    assert_contains(input, "pair_style hybrid/overlay mesofit/table 300 ${seed} eam/fs eam/fs\"");
    int files = 0; // of bath, dpd and exact
    for (const char *at = input; (at = strstr(at, "* * eam/fs 2 shell.eam.fs T1 T2 T3")); at++)
        files++;
    assert_int_equal(files, 3);
    assert_contains(input, "# many_body  f of crowd in 2001 rows for rho from 0 to ");
    free(input);
}

static void assert_refused(const char *engine, const char *word) {
    struct stat found;
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "-o", "to");
    run_program_assert_refused(&result, NULL, word, 1, (const char *const[]){word, NULL});
    assert_int_not_equal(stat("to", &found), 0);
}

static void test_negative_weights_and_other_engines_are_refused(void **state) {
    simulate(*state, "\"law\": \"sanyal-shell\", \"cutoff\": 0.8",
             "\"law\": \"expression\", \"formula\": \"(0.8 - r)*(0.3 - r)\", \"cutoff\": 0.8");
    assert_refused("lammps", "many_body.crowd.weight is below 0 somewhere");
    simulate(*state, NULL, NULL);
    static const char *const engines[] = {"hoomd",   "espresso", "openmm",
                                          "gromacs", "dl_poly",  "votca"};
    for (int k = 0; k < 6; k++)
        assert_refused(engines[k], "local densities (\"many_body\"); LAMMPS has them");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_densities_are_what_lammps_reads),
                                       TEST(test_negative_weights_and_other_engines_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
