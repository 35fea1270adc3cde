// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit export` from outside. Tables are read back by readers of their own, written from the
// rules of each engine's source (lab/export.md), and compared with the formula of the
// potential: Φ = ½ a k_B T (1 − r/r_c)², a = 25, r_c = 0.7 nm, T = 300 K.
#include "shared/is_close.h"
#include "shared/other_engine.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <gsl/gsl_spline.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

static const double thermal = 8.31446261815324e-3 * 300; // k_B T [kJ/mol]
static const double cutoff = 0.7;                        // [nm]

enum { MAX = 600000 };

/// A table as it stands in a file, in units of the file.
struct rows {
    size_t count;
    double low, high, spacing;
    double *r, *phi, *force;
};

static void init(struct rows *rows) {
    *rows = (struct rows){.r = calloc(MAX, sizeof(double)),
                          .phi = calloc(MAX, sizeof(double)),
                          .force = calloc(MAX, sizeof(double))};
}

static void clear(struct rows *rows) {
    free(rows->r);
    free(rows->phi);
    free(rows->force);
}

static FILE *open_text(const char *path) {
    FILE *file = fopen(path, "r");
    if (file == NULL)
        fail_msg("%s is not there", path);
    return file;
}

static void run_export(const char *engine, const char *folder) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "export", "out", "--engine", engine, "-o", folder);
    run_program_assert_code(&result, 0);
    run_program_assert_no_partial(folder);
}

/// Φ and F that an engine reads are those of the formula: within 1e-4 k_B T and 1e-3 of the largest
/// force, a/r_c.
/// @param[in] energy, length  units of the file in kJ/mol and nm
static void assert_reads(void (*value)(const struct rows *, double, double *, double *),
                         const struct rows *rows, double energy, double length) {
    for (int k = 0; k < 20000; k++) {
        const double r = cutoff * (0.02 + 0.9795 * (k + 0.5) / 20000), rest = 1 - r / cutoff;
        double phi, force;
        value(rows, r / length, &phi, &force);
        const double phi_error = phi * energy / thermal - 12.5 * rest * rest;
        const double force_error = force * energy / length / thermal * cutoff - 25 * rest;
        if (!(fabs(phi_error) < 1e-4) || !(fabs(force_error) < 25e-3))
            fail_msg("at r = %g nm: phi is wrong by %g k_B T, the force by %g of the largest", r,
                     phi_error, force_error / 25);
    }
}

/// pair_table.cpp: rows equally far apart in r², if N is that of pair_style and r_hi the cutoff;
/// linear in r² of energy and force/r.
static void read_lammps(struct rows *rows, const char *path, const char *section) {
    FILE *file = open_text(path);
    char line[256], word[64];
    while (fgets(line, sizeof line, file) &&
           (sscanf(line, "%63s", word) != 1 || strcmp(word, section) != 0))
        ;
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(sscanf(line, "N %zu RSQ %lf %lf", &rows->count, &rows->low, &rows->high), 3);
    assert_string_equal(fgets(line, sizeof line, file), "\n"); // reader.skip_line()
    for (size_t k = 0; k < rows->count; k++) {
        size_t number;
        assert_int_equal(
            fscanf(file, "%zu %lf %lf %lf", &number, &rows->r[k], &rows->phi[k], &rows->force[k]),
            4);
        assert_int_equal(number, k + 1);
        const double low = rows->low * rows->low, high = rows->high * rows->high;
        const double r = sqrt(low + (high - low) * (double)k / (double)(rows->count - 1));
        assert_true(fabs(rows->r[k] - r) < 1e-6 * r); // EPSILONR
    }
    fclose(file);
}

static void lammps_value(const struct rows *rows, double r, double *phi, double *force) {
    const double inner = rows->low * rows->low;
    const double delta = (rows->high * rows->high - inner) / (double)(rows->count - 1);
    const size_t k = (size_t)((r * r - inner) / delta);
    const double fraction = (r * r - (inner + (double)k * delta)) / delta;
    assert_true(k < rows->count - 1);
    *phi = rows->phi[k] + fraction * (rows->phi[k + 1] - rows->phi[k]);
    const double here = rows->force[k] / rows->r[k], next = rows->force[k + 1] / rows->r[k + 1];
    *force = r * (here + fraction * (next - here));
}

static void test_lammps_reads_the_potential(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    char style[64];
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("lammps", "lammps");
    init(&rows);
    read_lammps(&rows, "lammps/mesofit.table", "PHI_A-A");
    assert_reads(lammps_value, &rows, 4.184, 0.1);
    for (double r = 1.01 * rows.low; r < 0.02 * rows.high; r *= 1.1) { // no pole near r = 0
        double phi, force;
        lammps_value(&rows, r, &phi, &force);
        assert_true(force >= 0 && force < 1.1 * 25 * thermal / 4.184 / 7);
    }
    char *input = temporary_folder_read("lammps/in.mesofit");
    snprintf(style, sizeof style, "table linear %zu\"", rows.count);
    assert_contains(input, style);
    assert_contains(input, "units real");
    // gamma = sigma² of s = 1: 4.5 μ/τ, which is 4.5 sqrt(μ k_B T)/λ, in kcal/mol fs/A².
    const double seconds = 0.7e-9 * sqrt(9e-26 / (1.380649e-23 * 300));
    const double gamma = 4.49991 * thermal / 4.184 * seconds * 1e15 / 49;
    const char *found = strstr(input, "pair_coeff 1 1 dpd/tstat ");
    assert_non_null(found);
    assert_true(fabs(strtod(found + strlen("pair_coeff 1 1 dpd/tstat "), NULL) / gamma - 1) < 1e-4);
    assert_contains(input, "comm_modify vel yes");
    free(input);
    clear(&rows);
}

/// The same fluid, its file in nm, ps and u, with a lambda that the program chooses.
static void test_result_in_nm_and_ps_is_exported_alike(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    char text[1024];
    const double mass = 9e-26 * 6.02214076e26, picoseconds = 0.7 * sqrt(mass / thermal);
    snprintf(text, sizeof text,
             "{\"units\": \"nm-ps\", \"seed\": 5, \"box\": [3.248, 3.248, 3.248], \"temperature\": "
             "300,\n\"particles\": {\"count\": 300, \"mass\": %.15g}, \"time_step\": %.15g,\n"
             "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": %.15g, \"cutoff\": 0.7},\n"
             "\"dissipative\": {\"law\": \"power\", \"sigma\": %.15g, \"cutoff\": 0.7},\n"
             "\"measure\": {\"equilibration\": 10, \"samples\": 2, \"every\": 10}}\n",
             mass, 0.04 * picoseconds, 25 * thermal / 0.7, 2.1213 * sqrt(mass / picoseconds));
    small_inputs_write(*state, "scene.json", text, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("lammps", "lammps");
    init(&rows);
    read_lammps(&rows, "lammps/mesofit.table", "PHI_A-A");
    assert_reads(lammps_value, &rows, 4.184, 0.1);
    clear(&rows);
    char *input = temporary_folder_read("lammps/in.mesofit");
    const char *found = strstr(input, "pair_coeff 1 1 dpd/tstat ");
    assert_non_null(found);
    const double gamma = 4.49991 * thermal / 4.184 * picoseconds * 1e3 / 49;
    assert_true(fabs(strtod(found + strlen("pair_coeff 1 1 dpd/tstat "), NULL) / gamma - 1) < 1e-4);
    free(input);
    // Of a script's pressures, kJ/mol/nm³, and temperatures, kJ/mol, come those of the README.
    static const char *const scripts[] = {"hoomd", "espresso"};
    for (int k = 0; k < 2; k++) {
        char path[32];
        run_export(scripts[k], scripts[k]);
        snprintf(path, sizeof path, "%s/run.py", scripts[k]);
        input = temporary_folder_read(path);
        assert_contains(input, "print(\"# step, temperature [K], pressure [bar], potential energy");
        found = strstr(input, "pressure_unit = ");
        assert_non_null(found);
        assert_true(fabs(strtod(found + strlen("pressure_unit = "), NULL) - 16.6053907) < 1e-6);
        assert_contains(input, k == 0 ? "state.pressure * pressure_unit" : "] * pressure_unit");
        assert_contains(input, " * temperature / kT");
        assert_int_equal(strstr(input, "always_compute_pressure = True") == NULL, k);
        free(input);
    }
}

/// Three columns r, Φ, F; both ends are among the rows.
static void read_columns(struct rows *rows, const char *path) {
    FILE *file = open_text(path);
    char line[256];
    rows->count = 0;
    while (fgets(line, sizeof line, file))
        if (line[0] != '#') {
            const size_t k = rows->count++;
            assert_int_equal(
                sscanf(line, "%lf %lf %lf", &rows->r[k], &rows->phi[k], &rows->force[k]), 3);
        }
    fclose(file);
    rows->low = rows->r[0];
    rows->high = rows->r[rows->count - 1];
}

/// EvaluatorPairTable.h: spacing (r_cut − r_min)/width; after the last row all is 0.
static void hoomd_value(const struct rows *rows, double r, double *phi, double *force) {
    const double place = (r - rows->low) / ((cutoff - rows->low) / (double)rows->count);
    const size_t k = (size_t)floor(place);
    const bool last = k + 1 >= rows->count;
    const double f = place - (double)k;
    *phi = rows->phi[k] + f * ((last ? 0 : rows->phi[k + 1]) - rows->phi[k]);
    *force = rows->force[k] + f * ((last ? 0 : rows->force[k + 1]) - rows->force[k]);
}

/// TabulatedPotential.hpp: linear interpolation of energy and force between min and max.
static void espresso_value(const struct rows *rows, double r, double *phi, double *force) {
    const double step = (rows->high - rows->low) / (double)(rows->count - 1);
    const size_t k = (size_t)((r - rows->low) / step);
    const double f = (r - rows->low) / step - (double)k;
    *phi = (1 - f) * rows->phi[k] + f * rows->phi[k + 1];
    *force = (1 - f) * rows->force[k] + f * rows->force[k + 1];
}

static gsl_spline *natural;

/// SplineFitter.cpp, createNaturalSpline: what GSL calls cspline.
static void openmm_value(const struct rows *rows, double r, double *phi, double *force) {
    (void)rows;
    *phi = gsl_spline_eval(natural, r, NULL);
    *force = -gsl_spline_eval_deriv(natural, r, NULL);
}

static void test_python_engines_read_the_potential(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    init(&rows);
    run_export("hoomd", "hoomd");
    read_columns(&rows, "hoomd/A-A.txt");
    assert_true(rows.high < cutoff * (1 - 0.5 / (double)rows.count));
    assert_reads(hoomd_value, &rows, 1, 1);
    run_export("espresso", "espresso");
    read_columns(&rows, "espresso/A-A.txt");
    assert_true(fabs(rows.high / cutoff - 1) < 1e-12 && rows.low == 0);
    assert_reads(espresso_value, &rows, 1, 1);
    run_export("openmm", "openmm");
    read_columns(&rows, "openmm/A-A.txt");
    natural = gsl_spline_alloc(gsl_interp_cspline, rows.count);
    gsl_spline_init(natural, rows.r, rows.phi, rows.count);
    assert_reads(openmm_value, &rows, 1, 1);
    gsl_spline_free(natural);
    clear(&rows);
    results_assert_table("openmm/start.txt", 7, 300);
}

/// forcetable.cpp, read_tables: seven columns from r = 0 on, to the cutoff and a nanometre more;
/// cubics by value and −derivative.
static void gromacs_value(const struct rows *rows, double r, double *phi, double *force) {
    const double h = rows->spacing;
    const size_t k = (size_t)(r / h);
    const double eps = r / h - (double)k, y = rows->phi[k], f = -h * rows->force[k];
    const double g = 3 * (rows->phi[k + 1] - y) - 2 * f + h * rows->force[k + 1];
    const double last = -2 * (rows->phi[k + 1] - y) + f - h * rows->force[k + 1];
    *phi = y + eps * (f + eps * (g + eps * last));
    *force = -(f + eps * (2 * g + 3 * eps * last)) / h;
}

static void test_gromacs_reads_the_potential(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("gromacs", "gromacs");
    char *readme = temporary_folder_read("gromacs/README");
    assert_int_equal(strncmp(readme, "GROMACS up to 2019 runs this", 28), 0);
    assert_contains(readme, "gmx grompp -f pressure.mdp");
    // No compressibility is known: the check is at the result's own pressure.
    char *settings = temporary_folder_read("gromacs/pressure.mdp"), held[64];
    const char *const stated = strstr(readme, "The result has "),
                      *const pressure = strstr(settings, "pcoupl = Berendsen\nref-p = ");
    assert_non_null(pressure);
    assert_non_null(stated);
    snprintf(held, sizeof held, "%.4g", strtod(pressure + 27, NULL));
    assert_close(strtod(stated + 15, NULL), strtod(held, NULL), 1e-3 * strtod(held, NULL));
    free(readme);
    free(settings);
    init(&rows);
    FILE *file = open_text("gromacs/table_A_A.xvg");
    char line[256];
    while (fgets(line, sizeof line, file)) {
        const size_t k = rows.count;
        double unused[4];
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf %lf %lf %lf %lf %lf", &rows.r[k], &unused[0],
                                &unused[1], &unused[2], &unused[3], &rows.phi[k], &rows.force[k]),
                         7);
        rows.count++;
    }
    fclose(file);
    rows.spacing = rows.r[1];
    assert_true(rows.r[0] == 0 && rows.r[rows.count - 1] >= cutoff + 1);
    assert_reads(gromacs_value, &rows, 1, 1);
    clear(&rows);
}

/// vdw.F90, vdw_table_read: title; spacing, range, number of rows; names; four numbers a line,
/// energies and then −r dΦ/dr, at multiples of the spacing from 1 on. Rows are taken over as they
/// are if the spacing is cutoff/(rows − 4); vdw_forces interpolates three of them.
static void dl_poly_value(const struct rows *rows, double r, double *phi, double *force) {
    const size_t l = (size_t)(r / rows->spacing);
    const double ppp = r / rows->spacing - (double)l;
    const double *table[2] = {rows->phi - 1, rows->force - 1};
    double found[2];
    for (int n = 0; n < 2; n++) {
        const double vk = table[n][l], vk1 = table[n][l + 1], vk2 = table[n][l + 2];
        const double t1 = vk + (vk1 - vk) * ppp, t2 = vk1 + (vk2 - vk1) * (ppp - 1);
        found[n] = t1 + (t2 - t1) * ppp * 0.5;
    }
    *phi = found[0];
    *force = found[1] / r;
}

static void test_dl_poly_reads_the_potential(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    char line[256], a[16], b[16];
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("dl_poly", "dl_poly");
    init(&rows);
    FILE *file = open_text("dl_poly/TABLE");
    assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(fscanf(file, "%lf %lf %zu", &rows.spacing, &rows.high, &rows.count), 3);
    assert_true(rows.high >= 7 && rows.count < MAX);
    assert_true(fabs(rows.spacing - 7 / (double)(rows.count - 4)) <= 1e-8);
    assert_int_equal(fscanf(file, "%15s %15s %*f %*f", a, b), 2);
    for (size_t k = 0; k < rows.count; k++)
        assert_int_equal(fscanf(file, "%lf", &rows.phi[k]), 1);
    for (size_t k = 0; k < rows.count; k++)
        assert_int_equal(fscanf(file, "%lf", &rows.force[k]), 1);
    fclose(file);
    assert_reads(dl_poly_value, &rows, 1, 0.1);
    clear(&rows);
}

static void test_votca_reads_the_potential(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("votca", "votca");
    FILE *file = open_text("votca/A-A.pot");
    double r, phi;
    char flag;
    int rows = 0;
    for (; fscanf(file, "%lf %lf %c", &r, &phi, &flag) == 3; rows++) {
        assert_true(fabs(phi / thermal - 12.5 * pow(1 - r / cutoff, 2)) < 1e-4);
        assert_int_equal(flag, r < 0.02 * cutoff ? 'o' : 'i');
    }
    fclose(file);
    assert_true(rows > 100);
}

/// Φ and force at r = 0, the last numbers of the first row of a table.
static void first_row(const char *file, double *phi, double *force) {
    char line[512];
    FILE *stream = open_text(file);
    do
        assert_non_null(fgets(line, sizeof line, stream));
    while (line[0] == '#');
    fclose(stream);
    char *last = strrchr(line, ' ');
    assert_non_null(last);
    *force = strtod(last, NULL);
    *last = 0;
    last = strrchr(line, ' ');
    assert_non_null(last);
    *phi = strtod(last, NULL);
}

/// Each pair type of the mixture has its own law, a r_c/2 and a at r = 0.
static void assert_tables_of_pairs(const char *engine, const char *format) {
    static const char *const type[][2] = {{"A", "A"}, {"A", "B"}, {"B", "B"}};
    static const double expected[][2] = {{12.5, 25}, {13.5, 30}, {0, 0}};
    for (int pair = 0; pair < 3; pair++) {
        char name[64], file[128];
        double phi, force;
        snprintf(name, sizeof name, format, type[pair][0], type[pair][1]);
        snprintf(file, sizeof file, "%s/%s", engine, name);
        first_row(file, &phi, &force);
        assert_true(fabs(phi - expected[pair][0]) < 1e-6);
        assert_true(fabs(force - expected[pair][1]) < 1e-6);
    }
}

/// The same of DL_POLY's sections, whose first value is at the first row.
static void assert_sections_of_pairs(void) {
    static const char *const head[] = {"A        A", "A        B", "B        B"};
    static const double expected[] = {12.5, 13.5, 0};
    char *table = temporary_folder_read("dl_poly/TABLE");
    for (int pair = 0; pair < 3; pair++) {
        const char *section = strstr(table, head[pair]);
        assert_non_null(section);
        assert_true(fabs(strtod(strchr(section, '\n'), NULL) - expected[pair]) < 0.05);
    }
    free(table);
}

static void test_mixture_has_a_table_for_each_pair_type(void **state) {
    static struct rows rows;
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_mixture, NULL, NULL);
    small_scenes_simulate(&result, "out");
    run_export("lammps", "lammps");
    init(&rows);
    read_lammps(&rows, "lammps/mesofit.table", "PHI_A-B"); // reduced: a = 30, cutoff 0.9
    assert_true(fabs(rows.high - 0.9) < 1e-12);
    double phi, force;
    lammps_value(&rows, 0.45, &phi, &force);
    assert_true(fabs(phi - 0.5 * 30 * 0.9 * 0.25) < 1e-4 && fabs(force - 15) < 0.03);
    read_lammps(&rows, "lammps/mesofit.table", "PHI_B-B");
    lammps_value(&rows, 0.5, &phi, &force);
    assert_true(phi == 0 && force == 0);
    clear(&rows);
    char *input = temporary_folder_read("lammps/in.mesofit");
    assert_contains(input, "units lj");
    assert_contains(input, "pair_coeff 1 2 table mesofit.table PHI_A-B${band}");
    free(input);
    static const char *const engines[] = {"hoomd", "espresso", "openmm", "gromacs", "dl_poly"};
    for (size_t k = 0; k < sizeof engines / sizeof *engines; k++)
        run_export(engines[k], engines[k]);
    assert_tables_of_pairs("hoomd", "%s-%s.txt");
    assert_tables_of_pairs("espresso", "%s-%s.txt");
    assert_tables_of_pairs("openmm", "%s-%s.txt");
    assert_tables_of_pairs("gromacs", "table_%s_%s.xvg");
    assert_sections_of_pairs();
}

/// `lmp -in lammps/in.mesofit` where the folder was written: a short run whose g(r) is ours within
/// 0.02; it was 0.013. tests/physics/test_export_lammps.c has the long one.
static void test_lammps_runs_what_was_written(void **state) {
    static struct run_program_result result;
    other_engine_skip_without("lmp");
    small_scenes_write(*state, small_scenes_dpd, "\"samples\": 20", "\"samples\": 400");
    small_scenes_simulate(&result, "out");
    run_export("lammps", "lammps");
    assert_int_equal(system("lmp -in lammps/in.mesofit -var steps 4000 -var equilibration 500 "
                            "-log none >lmp.out 2>&1"),
                     0);
    FILE *ours = open_text("out/rdf.tsv"), *theirs = open_text("rdf.dat");
    char line[512], other[512];
    double squares = 0;
    int rows = 0;
    for (int k = 0; k < 4; k++) // three comments and the step
        assert_non_null(fgets(other, sizeof other, theirs));
    for (; fgets(line, sizeof line, ours); rows += line[0] != '#') {
        double r, g, their_r, their_g;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf", &r, &g), 2);
        assert_non_null(fgets(other, sizeof other, theirs));
        assert_int_equal(sscanf(other, "%*d %lf %lf", &their_r, &their_g), 2);
        assert_true(fabs(their_r - 7 * r) < 1e-5); // A
        squares += (g - their_g) * (g - their_g);
    }
    fclose(ours);
    fclose(theirs);
    assert_int_equal(rows, 100);
    print_message("rms of g - ours: %.4f\n", sqrt(squares / rows));
    assert_true(sqrt(squares / rows) < 0.02);
}

#define TEST_WITH_PATH(name)                                                                       \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)
#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITH_PATH(test_lammps_runs_what_was_written),
        TEST(test_lammps_reads_the_potential),
        TEST(test_result_in_nm_and_ps_is_exported_alike),
        TEST(test_python_engines_read_the_potential),
        TEST(test_gromacs_reads_the_potential),
        TEST(test_dl_poly_reads_the_potential),
        TEST(test_votca_reads_the_potential),
        TEST(test_mixture_has_a_table_for_each_pair_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
