// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure` with molecules: what a simulation has measured of itself is measured of its
// trajectory again; a trajectory in a skewed box, whose molecules are cut by its faces, against a
// count over all images; molecules that the trajectory has not.
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char scene[] =
    "{\"seed\": 3, \"box\": [6, 6, 6], \"time_step\": 0.01,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.8},\n"
    "  \"spring\": {\"law\": \"harmonic\", \"k\": 50, \"length\": 0.9}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 120}},\n"
    "\"dihedrals\": {\"twist\": {\"law\": \"periodic\", \"k\": 2, \"multiplicity\": 3}},\n"
    "\"molecules\": {\"chain\": {\"count\": 50, \"chain\": {\"beads\": [\"A\", \"B\", \"B\", "
    "\"A\"],\n"
    "    \"bond\": \"backbone\", \"angle\": \"bend\", \"dihedral\": \"twist\"}},\n"
    "  \"ring\": {\"count\": 20, \"exclude\": 0, \"beads\": [\"A\", \"A\", \"A\"],\n"
    "    \"bonds\": {\"spring\": [[1, 2], [2, 3], [3, 1]]}}},\n"
    "\"particles\": {\"types\": {\"W\": 60}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": \"power\"},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 20}, \"intermolecular_rdf\": {\"range\": 2, \"bins\": 20},\n"
    "\"bond_angles\": {}, \"dihedral_angles\": {}, \"molecule_sizes\": {\"lags\": 10},\n"
    "\"snapshots\": {\"every\": 20, \"formats\": [\"lammps-dump\"]},\n"
    "\"measure\": {\"equilibration\": 400, \"samples\": 60, \"every\": 20}}\n";

/// The number in a row, from 0 on without comments, and column of a table; NAN if there is none.
static double cell(const char *file, int row, int column) {
    char line[4096];
    double value = NAN;
    FILE *stream = fopen(file, "r");
    if (stream == NULL)
        fail_msg("%s is not there", file);
    while (row >= 0 && fgets(line, sizeof line, stream)) {
        char *at = line;
        if (line[0] == '#' || row-- > 0)
            continue;
        for (int k = 0; k <= column; k++)
            value = strtod(at, &at);
    }
    fclose(stream);
    return value;
}

/// A column is the same in both folders to the digits of snapshots; a quarter is not 0.
static void compare(const char *name, int column, int rows) {
    char first[64], second[64];
    int found = 0;
    snprintf(first, sizeof first, "out/%s", name);
    snprintf(second, sizeof second, "target/%s", name);
    for (int row = 0; row < rows; row++) {
        const double a = cell(first, row, column), b = cell(second, row, column);
        if (!(fabs(a - b) <= 1e-6 * (1 + fabs(a))))
            fail_msg("%s, row %d: %.9g of the simulation, %.9g of its trajectory", name, row, a, b);
        found += a != 0;
    }
    assert_true(4 * found > rows);
}

/// What was measured is a run file: all groups and pairs are to be found, motion is compared with.
static void check_target(void) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.lammpstrj", "--file-units", "lj",
                "--molecules", "out/used.json", "--range", "2", "--bins", "20", "--temperature",
                "300", "-o", "fitted");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "without --molecules a fit has no bonds"));
    RUN_PROGRAM(&result, "fit", "fitted/target.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "chosen: method");
}

/// Ids go by types, so that molecules are found by their numbers and types.
static void test_a_simulation_is_measured_again(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.lammpstrj", "--file-units", "lj",
                "--molecules", "out/used.json", "--range", "2", "--bins", "20", "--begin", "4.1",
                "-o", "target");
    run_program_assert_code(&result, 0);
    compare("rdf_A-A.tsv", 1, 20);
    compare("rdf_A-B.tsv", 1, 20);
    compare("rdf_W-A.tsv", 1, 20);
    compare("intermolecular_rdf_A-A.tsv", 1, 20);
    compare("intermolecular_rdf_A-B.tsv", 1, 20);
    for (int column = 1; column <= 3; column += 2) {
        compare("bond_angles.tsv", column, 100);
        compare("dihedral_angles.tsv", column, 100);
    }
    for (int column = 1; column <= 4; column++)
        compare("molecule_sizes.tsv", column, 60);
    compare("end_to_end.tsv", 1, 10);
    compare("end_to_end.tsv", 3, 10);
    check_target();
}

// All images --------------------------------------------------------------------------------------

enum { FRAMES = 50, CHAINS = 12, BEADS = 3, COUNT = CHAINS * BEADS };
static const double lattice[3][3] = {{2.2, 0, 0}, {0.7, 2.1, 0}, {-0.5, 0.6, 2.3}};
static double place[FRAMES][COUNT][3];

static double uniform(void) {
    return rand() / (RAND_MAX + 1.0);
}

/// Chains A-B-A that begin anywhere, all beads put into the box by its faces.
static void make_frames(void) {
    srand(7);
    for (int frame = 0; frame < FRAMES; frame++)
        for (int k = 0; k < COUNT; k++) {
            double x[3], s[3];
            for (int d = 0; d < 3; d++)
                x[d] = k % BEADS ? place[frame][k - 1][d] + 0.6 * (uniform() - 0.5) : 2 * uniform();
            for (int i = 2; i >= 0; i--) { // lower triangular
                s[i] = floor(x[i] / lattice[i][i]);
                for (int d = 0; d < 3; d++)
                    x[d] -= s[i] * lattice[i][d];
            }
            memcpy(place[frame][k], x, sizeof x);
        }
}

static void write_frames(void) {
    FILE *file = fopen("chains.xyz", "w");
    assert_non_null(file);
    for (int frame = 0; frame < FRAMES; frame++) {
        fprintf(file, "%d\nLattice=\"", COUNT);
        for (int n = 0; n < 9; n++)
            fprintf(file, "%s%.9g", n ? " " : "", 10 * lattice[n / 3][n % 3]);
        fprintf(file, "\" Properties=species:S:1:pos:R:3 Time=%d pbc=\"T T T\"\n", 1000 * frame);
        for (int k = 0; k < COUNT; k++)
            fprintf(file, "%s %.9f %.9f %.9f\n", k % BEADS == 1 ? "B" : "A",
                    10 * place[frame][k][0], 10 * place[frame][k][1], 10 * place[frame][k][2]);
    }
    fclose(file);
}

/// The shortest of the separations of two beads over their images.
static double nearest(int frame, int a, int b, double separation[3]) {
    double min = INFINITY;
    for (int n = 0; n < 125; n++) {
        double x[3], square = 0;
        for (int d = 0; d < 3; d++) {
            x[d] = place[frame][a][d] - place[frame][b][d] + (n % 5 - 2) * lattice[0][d] +
                   (n / 5 % 5 - 2) * lattice[1][d] + (n / 25 - 2) * lattice[2][d];
            square += x[d] * x[d];
        }
        if (square < min * min) {
            min = sqrt(square);
            memcpy(separation, x, sizeof x);
        }
    }
    return min;
}

/// Pairs of A and A in a bin of 0.1 nm: those of different molecules, and all that are not bonded.
static void count_pairs(int bin, double *apart, double *all) {
    *apart = *all = 0;
    for (int frame = 0; frame < FRAMES; frame++)
        for (int a = 0; a < COUNT; a++)
            for (int b = a + 1; b < COUNT; b++) {
                double separation[3];
                const bool same = a / BEADS == b / BEADS;
                if (a % BEADS == 1 || b % BEADS == 1)
                    continue;
                if ((int)(nearest(frame, a, b, separation) / 0.1) == bin) {
                    *apart += !same;
                    *all += 1;
                }
            }
}

static void check_pairs(void) {
    const double volume = lattice[0][0] * lattice[1][1] * lattice[2][2];
    const double possible = 0.5 * (2 * CHAINS) * (2 * CHAINS - 1);
    for (int bin = 1; bin < 6; bin += 2) {
        double apart, all;
        count_pairs(bin, &apart, &all);
        const double shell = 4 * M_PI / 3 * (pow(0.1 * (bin + 1), 3) - pow(0.1 * bin, 3)) / volume;
        assert_true(all > apart && apart > 0);
        assert_close_relative(cell("target/intermolecular_rdf_A-A.tsv", bin, 1),
                              apart / (FRAMES * possible * shell), 1e-6);
        assert_close_relative(cell("target/rdf_A-A.tsv", bin, 1), all / (FRAMES * possible * shell),
                              1e-6);
    }
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Lengths and angles in the bins that the tables have, and ⟨R_e²⟩.
static void check_bonds(void) {
    double lengths[100] = {0}, angles[100] = {0}, end = 0;
    const double width =
        cell("target/bond_lengths.tsv", 1, 0) - cell("target/bond_lengths.tsv", 0, 0);
    for (int frame = 0; frame < FRAMES; frame++)
        for (int first = 0; first < COUNT; first += BEADS) {
            double u[3], v[3], across = 0;
            const double a = nearest(frame, first, first + 1, u);
            const double b = nearest(frame, first + 2, first + 1, v);
            const int bins[] = {(int)(a / width), (int)(b / width)};
            for (int k = 0; k < 2; k++)
                if (bins[k] < 100)
                    lengths[bins[k]]++;
            angles[(int)(acos(dot(u, v) / (a * b)) / M_PI * 100)]++;
            for (int d = 0; d < 3; d++)
                across += (u[d] - v[d]) * (u[d] - v[d]);
            end += across / (CHAINS * FRAMES);
        }
    for (int bin = 0; bin < 100; bin++) {
        assert_close(cell("target/bond_lengths.tsv", bin, 1),
                     lengths[bin] / (2 * CHAINS * FRAMES * width), 1e-5);
        assert_close(cell("target/bond_angles.tsv", bin, 1), angles[bin] / (CHAINS * FRAMES * 1.8),
                     1e-7);
    }
    double sum = 0;
    for (int frame = 0; frame < FRAMES; frame++)
        sum += cell("target/molecule_sizes.tsv", frame, 2) / FRAMES;
    assert_close_relative(sum, end, 1e-6);
    assert_close(cell("target/end_to_end.tsv", 0, 0), 0, 0);
    assert_close(cell("target/molecule_sizes.tsv", 3, 0), 3, 1e-9); // ps
}

static const char kinds[] =
    "{\"molecules\": {\"trimer\": {\"exclude\": 1, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"
    "  \"bond\": \"AB\", \"angle\": \"ABA\"}}}}\n";

static const char topology[] =
    "[ moleculetype ]\ntrimer 1\n[ atoms ]\n1 A 1 T A 1\n2 B 1 T B 2\n3 A 1 T A 3\n"
    "[ bonds ]\n1 2 1 0.3 1\n2 3 1 0.3 1\n[ angles ]\n1 2 3 1 90 1\n[ molecules ]\ntrimer 12\n";

/// The same molecules by a topology of GROMACS.
static void check_topology(struct temporary_folder *folder) {
    static struct run_program_result result;
    small_inputs_write(folder, "kinds.top", topology, NULL, NULL);
    RUN_PROGRAM(&result, "measure", "chains.xyz", "--molecules", "kinds.top", "--range", "0.9",
                "--bins", "9", "--static", "-o", "other");
    run_program_assert_code(&result, 0);
    assert_null(fopen("other/end_to_end.tsv", "r")); // of known times alone
    for (int bin = 0; bin < 100; bin++) {
        assert_close(cell("other/bond_lengths.tsv", bin, 1),
                     cell("target/bond_lengths.tsv", bin, 1), 0);
        assert_close(cell("other/bond_angles.tsv", bin, 1), cell("target/bond_angles.tsv", bin, 1),
                     0);
    }
}

/// Nothing says which atoms are a molecule: they follow each other.
static void test_cut_molecules_in_a_skewed_box_are_whole(void **state) {
    static struct run_program_result result;
    make_frames();
    write_frames();
    small_inputs_write(*state, "kinds.json", kinds, NULL, NULL);
    RUN_PROGRAM(&result, "measure", "chains.xyz", "--molecules", "kinds.json", "--range", "0.9",
                "--bins", "9", "-o", "target");
    run_program_assert_code(&result, 0);
    check_pairs();
    check_bonds();
    check_topology(*state);
}

// Bins --------------------------------------------------------------------------------------------

/// Molecules A-B-A along x with a bond of 0.15 nm and one of 0.6 nm, which is
/// evenly spread by 9 %.
static void write_stiff(struct temporary_folder *folder, double spread) {
    enum { MOLECULES = 40 };
    static char text[8192];
    size_t length = (size_t)snprintf(text, sizeof text, "stiff\n%d\n", 3 * MOLECULES);
    for (int m = 0; m < MOLECULES; m++) {
        const double share = 2 * (m + 0.5) / MOLECULES - 1;
        const double x[3] = {1, 1 + 0.15 * (1 + spread * share), 1.75 + 0.6 * 0.09 * share};
        for (int n = 0; n < 3; n++)
            length += (size_t)snprintf(text + length, sizeof text - length,
                                       "%5dTRI  %5s%5d%9.4f%9.4f%9.4f\n", m + 1, n == 1 ? "B" : "A",
                                       3 * m + n + 1, x[n], 0.1 * m, 1.0);
    }
    length += (size_t)snprintf(text + length, sizeof text - length, " 5.0 5.0 5.0\n");
    temporary_folder_write(folder, "stiff.gro", text, length);
}

/// A bond of 0.15 nm beside one of 0.6 nm was in two bins of 0.012 nm, too few for a fit. Of 40
/// bonds a standard deviation has two bins, or somewhat more, as a whole number makes the range.
/// Bonds of fixed length, which no bins resolve, have those of a hundredth of their length.
static void test_lengths_have_bins_for_the_narrowest_bond(void **state) {
    static const char stiff_kinds[] =
        "{\"molecules\": {\"trimer\": {\"beads\": [\"A\", \"B\", \"A\"],\n"
        "  \"bonds\": {\"short\": [[1, 2]], \"long\": [[2, 3]]}}}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "kinds.json", stiff_kinds, NULL, NULL);
    for (int stiff = 0; stiff < 2; stiff++) {
        const double spread = stiff ? 0.03 : 0, deviation = 0.15 * spread / sqrt(3);
        write_stiff(*state, spread);
        RUN_PROGRAM(&result, "measure", "stiff.gro", "--molecules", "kinds.json", "-o", "stiff");
        run_program_assert_code(&result, 0);
        const double width =
            cell("stiff/bond_lengths.tsv", 1, 0) - cell("stiff/bond_lengths.tsv", 0, 0);
        const double wanted = stiff ? deviation / 2 : 0.01 * 0.15 / 2;
        assert_true(width < 1.02 * wanted && width > 0.75 * wanted);
        assert_true((strstr(result.err, "bond \"short\": a constraint") != NULL) == !stiff);
        assert_null(strstr(result.err, "bond \"long\""));
    }
}

/// A-B-B-A, and a slip: A-B-A-B, which has as many of each type.
static void test_beads_in_another_order_than_their_atoms_are_told(void **state) {
    static const char atoms[] = "a chain\n4\n"
                                "    1OCT     C1    1   0.100   0.100   0.100\n"
                                "    1OCT     C2    2   0.300   0.100   0.100\n"
                                "    1OCT     C3    3   0.500   0.100   0.100\n"
                                "    1OCT     C4    4   0.700   0.100   0.100\n"
                                "   4.0 4.0 4.0\n";
    static const char map[] =
        "{\"beads\": {\"A1\": {\"type\": \"A\", \"residue\": \"OCT\", \"atoms\": \"C1\"},\n"
        "\"B1\": {\"type\": \"B\", \"residue\": \"OCT\", \"atoms\": \"C2\"},\n"
        "\"B2\": {\"type\": \"B\", \"residue\": \"OCT\", \"atoms\": \"C3\"},\n"
        "\"A2\": {\"type\": \"A\", \"residue\": \"OCT\", \"atoms\": \"C4\"}},\n"
        "\"masses\": {\"C1\": 1, \"C2\": 1, \"C3\": 1, \"C4\": 1}}\n";
    static const char *const beads[] = {"\"A\", \"B\", \"B\", \"A\"", "\"A\", \"B\", \"A\", \"B\""};
    static struct run_program_result result;
    temporary_folder_write(*state, "chain.gro", atoms, sizeof atoms - 1);
    temporary_folder_write(*state, "map.json", map, sizeof map - 1);
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "kinds.json", kinds, "\"A\", \"B\", \"A\"", beads[k]);
        RUN_PROGRAM(&result, "measure", "chain.gro", "--map", "map.json", "--molecules",
                    "kinds.json", "-o", "target");
        run_program_assert_code(&result, 0);
        const char *const told = strstr(
            result.err, "trimer: its beads are not in the order of the atoms: they begin with the "
                        "atoms 1, 2, 4, 3");
        assert_true(k == 0 ? strstr(result.err, "order of the atoms") == NULL : told != NULL);
    }
}

/// Pairs in a box of 4 nm, each of 0.3 nm: bead after bead, or all first beads before all others.
static void write_pairs(bool in_order) {
    enum { PAIRS = 150 };
    FILE *stream = fopen("pairs.gro", "w");
    assert_non_null(stream);
    srand(5);
    double at[PAIRS][3];
    for (int k = 0; k < PAIRS; k++)
        for (int d = 0; d < 3; d++)
            at[k][d] = 0.01 + 3.6 * uniform();
    fprintf(stream, "pairs\n%d\n", 2 * PAIRS);
    for (int n = 0; n < 2 * PAIRS; n++) {
        const int pair = in_order ? n / 2 : n % PAIRS, second = in_order ? n % 2 : n / PAIRS;
        fprintf(stream, "%5dDIM      A%5d%8.3f%8.3f%8.3f\n", n + 1, n + 1,
                at[pair][0] + 0.3 * second, at[pair][1], at[pair][2]);
    }
    fprintf(stream, "   4.0 4.0 4.0\n");
    fclose(stream);
}

static void test_bonds_of_beads_in_another_order_are_told(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "dimers.json",
                       "{\"molecules\": {\"dimer\": {\"beads\": [\"A\", \"A\"],\n"
                       "\"bonds\": {\"AA\": [[1, 2]]}}}}\n",
                       NULL, NULL);
    for (int k = 0; k < 2; k++) {
        write_pairs(k == 0);
        RUN_PROGRAM(&result, "measure", "pairs.gro", "--molecules", "dimers.json", "-o", "target");
        run_program_assert_code(&result, 0);
        // Half the box is 2 nm.
        const char *const told = strstr(result.err, "warning: bonds \"AA\" are 1.");
        assert_true((told != NULL) == (k == 1));
        assert_true(told == NULL || strstr(told, "in the order of the trajectory?"));
    }
}

/// Ten frames of trimers along x with bonds of some 0.3 nm, and `astray` of each ten with an
/// end 1.8 nm away.
static void write_trimers(int astray) {
    FILE *stream = fopen("trimers.gro", "w");
    assert_non_null(stream);
    srand(5);
    for (int frame = 0; frame < 10; frame++) {
        fprintf(stream, "trimers\n600\n");
        for (int k = 0; k < 200; k++) {
            const double at[3] = {0.1 + 3 * uniform(), 0.1 + 2 * uniform(), 0.1 + 3 * uniform()};
            double x = at[0];
            for (int bead = 0; bead < 3; bead++, x += 0.28 + 0.04 * uniform())
                fprintf(stream, "%5dTRI      A%5d%8.3f%8.3f%8.3f\n", k + 1, 3 * k + bead + 1, x,
                        at[1] + (bead == 2 && k % 10 < astray ? 1.8 : 0), at[2]);
        }
        fprintf(stream, "   4.0 4.0 4.0\n");
    }
    fclose(stream);
}

/// Ten bonds in a frame leave bins empty by chance.
static void test_few_bonds_are_not_of_two_lengths(void **state) {
    static struct run_program_result result;
    FILE *stream = fopen("few.gro", "w");
    assert_non_null(stream);
    srand(5);
    fprintf(stream, "dimers\n20\n");
    for (int k = 0; k < 20; k++)
        fprintf(stream, "%5dDIM      A%5d%8.3f%8.3f%8.3f\n", k / 2 + 1, k + 1,
                1 + k % 2 * (0.1 + 0.4 * uniform()), 0.2 * (k / 2), 1.0);
    fprintf(stream, "   4.0 4.0 4.0\n");
    fclose(stream);
    small_inputs_write(*state, "few.json",
                       "{\"molecules\": {\"dimer\": {\"beads\": [\"A\", \"A\"],\n"
                       "\"bonds\": {\"AA\": [[1, 2]]}}}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "measure", "few.gro", "--molecules", "few.json", "-o", "target");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "the beads of --molecules"));
}

/// A middle that is named as an end makes bonds of 0.3 and of 0.6 nm one group; of trimers that
/// lost an end a part is longer than any bins.
static void test_bonds_of_two_lengths_are_told(void **state) {
    static const struct {
        const char *bonds, *says;
        int astray;
    } cases[] = {{"[[1, 2], [2, 3]]", NULL, 0},
                 {"[[1, 2], [1, 3]]", "warning: bonds \"AA\" are either some 0.3 or some 0.", 0},
                 {"[[1, 2], [2, 3]]", "warning: 5 % of the bonds \"AA\" are longer than 0.", 1}};
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_trimers(cases[k].astray);
        small_inputs_write(*state, "trimers.json",
                           "{\"molecules\": {\"three\": {\"beads\": [\"A\", \"A\", \"A\"],\n"
                           "\"bonds\": {\"AA\": BONDS}}}}\n",
                           "BONDS", cases[k].bonds);
        RUN_PROGRAM(&result, "measure", "trimers.gro", "--molecules", "trimers.json", "--static",
                    "-o", "target");
        run_program_assert_code(&result, 0);
        if (cases[k].says)
            assert_contains(result.err, cases[k].says);
        else
            assert_null(strstr(result.err, "the beads of --molecules"));
    }
}

static void test_molecules_that_are_not_there_are_refused(void **state) {
    static const struct {
        const char *from, *to, *words[3];
    } cases[] = {
        {"\"A\", \"B\", \"A\"",
         "\"A\", \"A\", \"B\"",
         {"kinds.json: molecules.trimer", "bead 2 of number 1", "atom 2"}},
        {"\"exclude\"",
         "\"count\": 13, \"exclude\"",
         {"kinds.json: molecules.trimer", "number 13", "ends"}},
        {"\"A\", \"B\", \"A\"", "\"A\", \"C\", \"A\"", {"kinds.json", "atom 2, \"B\"", "--map"}},
        {"\"bond\": \"AB\"", "\"bond\": \"A B\"", {"kinds.json", "groups", "letters"}},
        {"\"molecules\"", "\"mole\"", {"kinds.json", "molecules", "molecules"}},
    };
    static struct run_program_result result;
    make_frames();
    write_frames();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "kinds.json", kinds, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "measure", "chains.xyz", "--molecules", "kinds.json", "-o", "target");
        assert_int_equal(result.code, 2);
        assert_null(fopen("target/summary.json", "r"));
        for (int word = 0; word < 3; word++)
            assert_contains(result.err, cases[k].words[word]);
    }
}

/// Four molecules A-B of a dump without masses, in a box of 2 nm.
static void write_dump_without_masses(struct temporary_folder *folder) {
    char text[4096];
    int length = 0;
    for (int frame = 0; frame < 3; frame++) {
        length +=
            snprintf(text + length, sizeof text - (size_t)length,
                     "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n8\nITEM: BOX BOUNDS pp pp pp\n"
                     "0 20\n0 20\n0 20\nITEM: ATOMS id mol type x y z\n",
                     frame);
        for (int k = 0; k < 8; k++)
            length += snprintf(text + length, sizeof text - (size_t)length, "%d %d %d %d %d %.1f\n",
                               k + 1, k / 2 + 1, k % 2 + 1, 3 * k % 20, 5 * (k / 2),
                               2.0 * (k % 2) + 0.1 * frame);
    }
    small_inputs_write(folder, "foreign.lammpstrj", text, NULL, NULL);
}

/// Masses that the trajectory does not have are those of the scene.
static void test_masses_are_those_of_the_scene(void **state) {
    static const char dumbbells[] =
        "{UNITS \"bonds\": {\"b\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.3}},\n"
        "\"molecules\": {\"pair\": {\"beads\": [\"A\", \"B\"], \"bonds\": {\"b\": [[1, 2]]}}},\n"
        "\"particles\": {\"mass\": {\"A\": 20, \"B\": 30}}}\n";
    static const struct {
        const char *units, *file, *says;
    } cases[] = {{"\"units\": \"nm-ps\",", "real", "B: 4 beads of 1 atom, the first of 30 u"},
                 {"\"units\": {\"length\": 1, \"temperature\": 300, \"mass\": 3.32107813e-27},",
                  "real", "B: 4 beads of 1 atom, the first of 60 u"},
                 {"", "lj", "B: 4 beads of 1 atom, the first of 30 u"},
                 {"", "real", "B: 4 beads of 1 atom, of unknown mass"}};
    static struct run_program_result result;
    write_dump_without_masses(*state);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "scene.json", dumbbells, "UNITS", cases[k].units);
        RUN_PROGRAM(&result, "measure", "foreign.lammpstrj", "--molecules", "scene.json",
                    "--file-units", cases[k].file, "--static", "-o", "of-scene", "--force");
        run_program_assert_code(&result, 0);
        assert_contains(result.err, cases[k].says);
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_simulation_is_measured_again),
        TEST(test_cut_molecules_in_a_skewed_box_are_whole),
        TEST(test_lengths_have_bins_for_the_narrowest_bond),
        TEST(test_beads_in_another_order_than_their_atoms_are_told),
        TEST(test_bonds_of_beads_in_another_order_are_told),
        TEST(test_bonds_of_two_lengths_are_told),
        TEST(test_few_bonds_are_not_of_two_lengths),
        TEST(test_molecules_that_are_not_there_are_refused),
        TEST(test_masses_are_those_of_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
