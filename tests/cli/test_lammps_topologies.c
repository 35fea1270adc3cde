// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules of scenes from data files of LAMMPS: one that LAMMPS has written, with the energy that
// it has for it; other styles beside LAMMPS itself (Debian's lmp, for ENGINES=1); our
// own export read again; and files that cannot be right.
#include "shared/is_close.h"
#include "shared/other_engine.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ATOMS = 49, DATA_SIZE = 16384 };

/// A step that moves nothing: the energy of the file.
static const char scene[] =
    "{\"seed\": 2, \"box\": [2.25, 2.25, 2.25], \"time_step\": 1e-9, \"units\": \"nm-ps\",\n"
    "  \"temperature\": 300, \"precision\": \"double\", \"particles\": {\"mass\": 40,\n"
    "    \"placement\": \"file\", \"file\": \"chains.data\"},\n"
    "  \"molecules\": {\"file\": \"chains.data\", \"units\": \"real\", \"exclude\": 2},\n"
    "  \"bond_lengths\": {}, \"measure\": {\"equilibration\": 0, \"samples\": 1, \"every\": 1}}\n";

static void read_fixture(char *text) {
    char path[1024];
    snprintf(path, sizeof path, "%s/tests/reference_data/lammps/chains.data",
             run_program_sources());
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    text[fread(text, 1, DATA_SIZE - 1, stream)] = '\0';
    fclose(stream);
}

/// Write chains.data with the first `from` exchanged, if there is any.
static void write_data(const char *text, const char *from, const char *to) {
    FILE *stream = fopen("chains.data", "w");
    const char *const at = from ? strstr(text, from) : text;
    assert_true(stream && at);
    if (from)
        fprintf(stream, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    else
        fputs(text, stream);
    fclose(stream);
}

/// U of all terms [kcal/mol], by the last row of a table.
static double energy_of(const char *folder) {
    char path[256], line[1024], last[1024] = "";
    snprintf(path, sizeof path, "%s/thermodynamics.tsv", folder);
    FILE *stream = fopen(path, "r");
    double energy = NAN;
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream))
        if (line[0] != '#')
            strcpy(last, line);
        else
            assert_non_null(
                strstr(line, "step\ttime[ps]\ttemperature[K]\tpotential_energy[kJ/mol]"));
    fclose(stream);
    assert_int_equal(sscanf(last, "%*s %*s %*s %lf", &energy), 1);
    return energy * ATOMS / 4.184;
}

static void simulate(const char *file, const char *folder, struct run_program_result *result) {
    RUN_PROGRAM(result, "simulate", file, "-o", folder);
    run_program_assert_code(result, 0);
}

/// As LAMMPS has it, to the digits of the table; and what the file says is in used.json, which runs
/// again.
static void test_a_file_of_write_data_has_the_energy_of_lammps(void **state) {
    static struct run_program_result result;
    static char text[DATA_SIZE];
    read_fixture(text);
    write_data(text, NULL, NULL);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    simulate("scene.json", "out", &result);
    const double theirs = 3.79307134008723 + 3.75641889726852 - 2.83381037191183;
    print_message("%.9g, LAMMPS %.9g kcal/mol\n", energy_of("out"), theirs);
    assert_close(energy_of("out"), theirs, 1e-6);
    const char *const used = "out/used.json";
    results_assert_number(used, "molecules.molecule-2.count", 6);
    results_assert_number(used, "molecules.molecule-1.count", 4);
    results_assert_number(used, "molecules.molecule-2.exclude", 2);
    results_assert_number(used, "particles.types.1", 5);
    assert_close_relative(results_number(used, "bonds.2.k"), 2 * 0.476929 * 418.4, 1e-9);
    assert_close_relative(results_number(used, "bonds.2.length"), 0.5, 1e-12);
    assert_close_relative(results_number(used, "dihedrals.1.c1"), 2.92119 * 4.184, 1e-9);
    simulate("out/used.json", "again", &result);
    results_assert_same("out", "again", (const char *const[]){"bond_lengths.tsv", NULL});
}

/// Other coefficients in the place of the file's.
static void exchange(const char *text, const char *coefficients, char *to) {
    const char *const begin = strstr(text, "Bond Coeffs"), *const end = strstr(text, "Atoms #");
    assert_true(begin && end);
    snprintf(to, DATA_SIZE, "%.*s%s\n%s", (int)(begin - text), text, coefficients, end);
}

static double run_lammps(const char *const style[3]) {
    char line[1024];
    double energy[3];
    bool there = false;
    FILE *stream = fopen("in.once", "w");
    assert_non_null(stream);
    fprintf(stream,
            "units real\natom_style molecular\nbond_style %s\nangle_style %s\ndihedral_style %s\n"
            "read_data chains.data\npair_style zero 8\npair_coeff * *\ncomm_modify cutoff 15\n"
            "special_bonds lj/coul 0 1 1\nthermo_style custom step ebond eangle edihed\n"
            "thermo_modify norm no format float %%.15g\nrun 0\n",
            style[0], style[1], style[2]);
    fclose(stream);
    if (system("lmp -in in.once >lmp.out 2>&1") != 0)
        fail_msg("LAMMPS failed: see lmp.out");
    stream = fopen("log.lammps", "r");
    assert_non_null(stream);
    while (!there && fgets(line, sizeof line, stream))
        there = strstr(line, "E_bond") && fgets(line, sizeof line, stream) &&
                sscanf(line, "%*d %lf %lf %lf", &energy[0], &energy[1], &energy[2]) == 3;
    fclose(stream);
    assert_true(there);
    return energy[0] + energy[1] + energy[2];
}

static void test_all_styles_have_the_energies_of_lammps(void **state) {
    static const struct {
        const char *style[3], *coefficients;
        const char *from, *to; ///< what LAMMPS reads in the place of a style that it may lack
    } cases[] = {
        {{"fene", "cosine", "charmm"},
         "Bond Coeffs # fene\n\n1 0.05 9 0 1\n2 0.07 10 0 1\n3 0.1 11 0 1\n\n"
         "Angle Coeffs # cosine\n\n1 2\n2 3\n3 1.5\n\n"
         "Dihedral Coeffs # charmm\n\n1 1.3 3 40 0.0\n2 0.7 2 -60 0.0\n",
         NULL,
         NULL},
        {{"harmonic", "harmonic", "harmonic"},
         "Bond Coeffs # harmonic\n\n1 1.4 3.5\n2 0.5 5\n3 3.6 4.5\n\n"
         "Angle Coeffs # harmonic\n\n1 2.4 110\n2 0.9 150\n3 8.9 120\n\n"
         "Dihedral Coeffs # harmonic\n\n1 1.3 -1 3\n2 0.7 1 2\n",
         NULL,
         NULL},
        {{"harmonic", "cosine/squared", "multi/harmonic"},
         "Bond Coeffs # harmonic\n\n1 1.4 3.5\n2 0.5 5\n3 3.6 4.5\n\n"
         "Angle Coeffs # cosine/squared\n\n1 2.4 110\n2 0.9 150\n3 8.9 120\n\n"
         "Dihedral Coeffs # nharmonic\n\n1 5 1 0.5 -2 0.3 0.7\n2 3 0.5 1 2\n",
         "nharmonic\n\n1 5 1 0.5 -2 0.3 0.7\n2 3 0.5 1 2",
         "multi/harmonic\n\n1 1 0.5 -2 0.3 0.7\n2 0.5 1 2 0 0"},
        {{"hybrid harmonic fene", "hybrid harmonic cosine", "opls"},
         "Bond Coeffs # hybrid\n\n1 harmonic 1.4 3.5\n2 fene 0.07 10 0 1\n3 harmonic 3.6 4.5\n\n"
         "Angle Coeffs # hybrid\n\n1 harmonic 2.4 110\n2 cosine 3\n3 cosine 1.5\n\n"
         "Dihedral Coeffs # opls\n\n1 1.3 -0.4 2.1 0.6\n2 -0.2 0.7 1 -1.5\n",
         NULL,
         NULL},
    };
    static struct run_program_result result;
    static char text[DATA_SIZE], changed[DATA_SIZE];
    other_engine_skip_without("lmp");
    read_fixture(text);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        char folder[16];
        snprintf(folder, sizeof folder, "out%zu", n);
        exchange(text, cases[n].coefficients, changed);
        write_data(changed, NULL, NULL);
        simulate("scene.json", folder, &result);
        write_data(changed, cases[n].from, cases[n].to);
        const double theirs = run_lammps(cases[n].style);
        print_message("%s, %s, %s: %.9g, LAMMPS %.9g kcal/mol\n", cases[n].style[0],
                      cases[n].style[1], cases[n].style[2], energy_of(folder), theirs);
        assert_close(energy_of(folder), theirs, 2e-6);
    }
}

/// Data files that we export have no coefficients: the scene gives laws to the types.
static void test_our_own_export_is_read_again(void **state) {
    static const char second[] =
        "{\"seed\": 2, \"box\": [2.25, 2.25, 2.25], \"time_step\": 1e-9, \"units\": \"nm-ps\",\n"
        "  \"temperature\": 300, \"precision\": \"double\", \"particles\": {\"mass\": 40,\n"
        "    \"placement\": \"file\", \"file\": \"lammps/data.mesofit\"},\n"
        "  \"bonds\": {\"1\": {\"law\": \"harmonic\", \"k\": 1197.285072, \"length\": 0.35},\n"
        "    \"2\": {\"law\": \"harmonic\", \"k\": 399.0941872, \"length\": 0.5},\n"
        "    \"3\": {\"law\": \"harmonic\", \"k\": 2993.208496, \"length\": 0.45}},\n"
        "  \"molecules\": {\"file\": \"lammps/data.mesofit\", \"units\": \"real\", \"exclude\": "
        "2},\n"
        "  \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 1, \"cutoff\": 0.6},\n"
        "  \"bond_lengths\": {}, \"measure\": {\"equilibration\": 0, \"samples\": 1, \"every\": "
        "1}}\n";
    static struct run_program_result result;
    static char text[DATA_SIZE];
    read_fixture(text);
    small_inputs_write(
        *state, "scene.json", scene, "\"bond_lengths",
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 1, \"cutoff\": 0.6}, "
        "\"bond_lengths");
    // Without angles and dihedrals.
    char *angles = strstr(text, "Angles\n");
    assert_non_null(angles);
    *angles = '\0';
    for (char *at = text; (at = strstr(at, "24 angles")) || (at = strstr(text, "18 dihedrals"));)
        memset(at, '0', 2);
    write_data(text, NULL, NULL);
    simulate("scene.json", "out", &result);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "second.json", second, NULL, NULL);
    simulate("second.json", "second", &result);
    print_message("%.9g, read again %.9g kcal/mol\n", energy_of("out"), energy_of("second"));
    assert_close(energy_of("second"), energy_of("out"), 1e-6);
    results_assert_same("out", "second", (const char *const[]){"bond_lengths.tsv", NULL});
}

/// Put `to` in the place of the first `from` of a text of DATA_SIZE bytes.
static void replace(char *text, const char *from, const char *to) {
    static char rest[DATA_SIZE];
    char *const at = strstr(text, from);
    assert_non_null(at);
    snprintf(rest, DATA_SIZE, "%s", at + strlen(from));
    snprintf(at, DATA_SIZE - (size_t)(at - text), "%s%s", to, rest);
}

/// LAMMPS of 2022 writes labels where it wrote numbers of types (manual, Howto_type_labels).
static void test_labels_stand_for_numbers_of_types(void **state) {
    static struct run_program_result result;
    static char text[DATA_SIZE];
    read_fixture(text);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    write_data(text, NULL, NULL);
    simulate("scene.json", "numbers", &result);
    replace(text, "\nMasses\n", "\nBond Type Labels\n\n1 A-B\n2 second\n3 c3*\n\nMasses\n");
    replace(text, "\n1 1.43079 3.5", "\nA-B 1.43079 3.5");
    replace(text, "\n1 1 14 36\n", "\n1 A-B 14 36\n");
    write_data(text, NULL, NULL);
    simulate("scene.json", "labels", &result);
    results_assert_same("numbers", "labels", (const char *const[]){"thermodynamics.tsv", NULL});
}

static void test_files_that_cannot_be_are_refused(void **state) {
    static const struct {
        const char *from, *to, *place, *what;
    } cases[] = {
        {"\n1 1 14 36\n", "\n1 1 14 77\n", "chains.data:145:", "there is no atom 77"},
        {"\n1 1 14 36\n", "\n1 1 14 14\n", "chains.data:145:", "the bond has an atom twice"},
        {"\n2 2 27 43\n", "\n2 2 36 14\n", "chains.data:146:", "the same bond as in line 145"},
        {"\n1 1 14 36\n", "\n1 9 14 36\n", "chains.data:145:", "\"9\" is not a type of a bond"},
        {"\n1 1 14 36\n", "\n1 1 14\n", "chains.data:145:", "3 words; expected in bonds 4"},
        {"34 bonds", "35 bonds", "chains.data:", "expected \"35 bonds\", found 34"},
        {"34 bonds", "34 bonds\n2 impropers", "chains.data:6:", "impropers are not known"},
        {"\nAngles\n", "\nImpropers\n", "chains.data:", "\"Impropers\" is not known"},
        {"Bond Coeffs # harmonic", "Bond Coeffs", "chains.data:24:", "unknown style: name it"},
        {"Bond Coeffs # harmonic", "Bond Coeffs # class2",
         "chains.data:24:", "style \"class2\" is not supported; use harmonic, fene"},
        {"1 1.43079 3.5", "1 1.43079", "chains.data:24:", "1 numbers, and harmonic has 2"},
        {"1 1.43079 3.5", "1 1.43079 x", "chains.data:24:", "expected a number, found \"x\""},
        {"1 1.43079 3.5", "1 1.43079 -3.5", "chains.data:24:", "cannot have these numbers"},
        {"1 1.43079 3.5", "2 1.43079 3.5", "chains.data:25:", "duplicate type 2"},
        {"1 1.43079 3.5", "", "chains.data:", "type 1 of bonds has no coefficients here"},
        {"49 atoms", "50 atoms", "chains.data", ""},
        {"0 22.5 xlo xhi", "0 23.5 xlo xhi", "chains.data", "its box is 2.35 x 2.25 x 2.25 nm"},
        {"zlo zhi", "zlo zhi\n3 0 0 xy xz yz", "chains.data", "the box is triclinic"},
    };
    static struct run_program_result result;
    static char text[DATA_SIZE];
    read_fixture(text);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_data(text, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_refused(&result, ".", cases[k].to, 1,
                                   (const char *const[]){cases[k].place, cases[k].what, NULL});
    }
    for (size_t part = 1; part < 8; part++) { // cut off
        char cut[DATA_SIZE];
        snprintf(cut, sizeof cut, "%.*s", (int)(strlen(text) * part / 8), text);
        write_data(cut, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_refused(&result, ".", "cut off", 1,
                                   (const char *const[]){"chains.data", NULL});
    }
}

/// A million numbers in a line, and a chain of a million atoms, are told at once.
static void test_what_is_far_too_long_is_refused(void **state) {
    enum { MANY = 1000000 };
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    for (int chain = 0; chain < 2; chain++) {
        FILE *stream = fopen("chains.data", "w");
        const int bonds = chain ? MANY - 1 : 1;
        assert_non_null(stream);
        fprintf(stream,
                "long\n\n%d atoms\n1 atom types\n%d bonds\n1 bond types\n0 22.5 xlo xhi\n"
                "0 22.5 ylo yhi\n0 22.5 zlo zhi\n\nBond Coeffs # harmonic\n\n1 1 1\n\n"
                "Atoms # bond\n\n",
                MANY, bonds);
        for (int k = 1; k <= MANY; k++)
            fprintf(stream, "%d 1 1 0 0 0\n", k);
        fprintf(stream, "\nBonds\n\n%s", chain ? "" : "1 1");
        for (int k = 1; k <= MANY - 1; k++)
            if (chain)
                fprintf(stream, "%d 1 %d %d\n", k, k, k + 1);
            else
                fprintf(stream, " %d", k);
        fprintf(stream, "\n");
        fclose(stream);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_refused(
            &result, ".", "long", 1,
            (const char *const[]){"chains.data",
                                  chain ? "has 1000000 atoms; the most are 20000"
                                        : "a line of more than 1048576 bytes",
                                  NULL});
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)
#define TEST_WITH_LAMMPS(name)                                                                     \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_file_of_write_data_has_the_energy_of_lammps),
        TEST_WITH_LAMMPS(test_all_styles_have_the_energies_of_lammps),
        TEST(test_our_own_export_is_read_again),
        TEST(test_what_is_far_too_long_is_refused),
        TEST(test_labels_stand_for_numbers_of_types),
        TEST(test_files_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
