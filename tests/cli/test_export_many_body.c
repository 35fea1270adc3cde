// SPDX-License-Identifier: GPL-3.0-or-later
//
// "many_body" of a scene in LAMMPS's format of local/density, read back by the rules of its manual,
// and what is refused. Beside LAMMPS itself: physics/test_export_lammps_many_body.
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
    "    \"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.4, \"cutoff\": 0.7},\n"
    "    \"energy\": {\"law\": \"expression\", \"formula\": \"-2*rho/(rho + 4)\", \"maximum\": "
    "20}}},\n"
    "\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}}\n";

static void simulate(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    small_inputs_write(folder, "w.tsv", "0 1\n0.2 0.8\n0.5 0.3\n0.7 0\n", NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
}

/// A line of types, from 1 on, as a sum of bits.
static int read_set(FILE *stream) {
    char line[256];
    int set = 0, type, read;
    assert_non_null(fgets(line, sizeof line, stream));
    for (const char *at = line; sscanf(at, "%d%n", &type, &read) == 1; at += read)
        set |= 1 << (type - 1);
    return set;
}

/// One file: cutoffs in A, types, range, rows of f in kcal/mol.
static void read_density(const char *path, const double cutoff[2], int central, int neighbours,
                         double (*energy)(double)) {
    FILE *stream = fopen(path, "r");
    char line[512];
    int terms, rows;
    double found[2], low, high, step, f;
    assert_non_null(stream);
    assert_non_null(fgets(line, sizeof line, stream));
    assert_string_equal(line, "# UNITS: real\n");
    assert_non_null(fgets(line, sizeof line, stream));
    assert_int_equal(line[0], '#');
    assert_int_equal(fscanf(stream, "%d %d", &terms, &rows), 2);
    assert_int_equal(terms, 1);
    assert_int_equal(fscanf(stream, "%lf %lf ", &found[0], &found[1]), 2);
    assert_close(found[0], cutoff[0], 1e-9);
    assert_close(found[1], cutoff[1], 1e-9);
    assert_int_equal(read_set(stream), central);
    assert_int_equal(read_set(stream), neighbours);
    assert_int_equal(fscanf(stream, "%lf %lf %lf", &low, &high, &step), 3);
    assert_true(low < 0 && high > 64);
    assert_close(low + step * (rows - 1), high, 1e-9 * high);
    for (int k = 0; k < rows; k++) {
        const double density = low + step * k;
        assert_int_equal(fscanf(stream, "%lf", &f), 1);
        if (density >= 0)
            assert_close(4.184 * f, energy(density), 1e-6);
    }
    fclose(stream);
}

static double crowd(double density) {
    const double x = density - 6;
    return -0.5 * x + 0.1 * x * x - (0.5 * 6 + 0.1 * 36);
}

/// Beyond 20 as a straight line, whose slope is −8/24².
static double shell(double density) {
    return density < 20 ? -2 * density / (density + 4) : -40.0 / 24 - 8.0 / 576 * (density - 20);
}

static void test_densities_are_what_lammps_reads(void **state) {
    simulate(*state, NULL, NULL);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    read_density("lammps/crowd.density", (double[]){0, 8}, 7, 7, crowd);
    read_density("lammps/shell.density", (double[]){4, 7}, 5, 2, shell);
    char *input = temporary_folder_read("lammps/in.mesofit");
    assert_contains(input, "\"pair_style hybrid/overlay table linear ");
    assert_contains(
        input, " local/density local/density\" &\n  \"pair_coeff 1 1 table mesofit.table PHI_A-A");
    assert_contains(input, " dpd/tstat ");
    assert_contains(
        input, "pair_style hybrid/overlay mesofit/table 300 ${seed} local/density local/density\"");
    int files = 0; // of bath, dpd and exact
    for (const char *at = input; (at = strstr(at, "* * local/density 2 shell.density")); at++)
        files++;
    assert_int_equal(files, 3);
    assert_contains(input, "# many_body  f of crowd in 1001 rows for rho from 0 to ");
    free(input);
}

static void assert_refused(const char *engine, const char *word) {
    struct stat found;
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "-o", "to");
    run_program_assert_refused(&result, NULL, word, 1, (const char *const[]){word, NULL});
    assert_int_not_equal(stat("to", &found), 0);
}

/// LAMMPS has one weight, and other engines none.
static void test_other_weights_and_engines_are_refused(void **state) {
    static const char *const weights[][2] = {
        {"\"law\": \"lucy\"", "not \"lucy\""},
        {"\"law\": \"many-body-dpd\"", "not \"many-body-dpd\""},
        {"\"law\": \"expression\", \"formula\": \"exp(-r)\"", "not \"expression\""},
        {"\"law\": \"table\", \"file\": \"w.tsv\"", "not \"table\""}};
    for (int k = 0; k < 4; k++) {
        char text[128];
        snprintf(text, sizeof text, "%s%s", weights[k][0], k < 3 ? ", \"cutoff\": 0.8" : "");
        simulate(*state, "\"law\": \"sanyal-shell\", \"cutoff\": 0.8", text);
        assert_refused("lammps", weights[k][1]);
        assert_contains(result.err, "many_body.crowd");
        assert_contains(result.err, "the weight \"sanyal-shell\" alone");
    }
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
                                       TEST(test_other_weights_and_engines_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
