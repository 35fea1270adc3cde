// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules from outside: a scene of chains, rings and single beads, its restart and its used.json,
// what is measured of it, and files that cannot be right.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BACKBONE_OF(length)                                                                        \
    "\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": " length "}"
#define BACKBONE BACKBONE_OF("0.8")
#define SPRING "\"spring\": {\"law\": \"fene\", \"k\": 5}"
#define BEND "\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 120}"
#define TWIST "\"twist\": {\"law\": \"table\", \"file\": \"twist.tsv\"}"
#define CHAIN "\"beads\": [\"A\", \"B\", \"B\", \"A\"]"
#define RING "[[1, 2], [2, 3], [3, 1]]"
#define SINGLE "\"particles\": {\"types\": {\"W\": 60}, \"mass\": {\"A\": 2, \"B\": 1, \"W\": 1}}"

static const char scene[] =
    "{\"seed\": 3, \"box\": [6, 6, 6], \"time_step\": 0.01,\n"
    "\"bonds\": {" BACKBONE ", " SPRING "},\n"
    "\"angles\": {" BEND "}, \"dihedrals\": {" TWIST "},\n"
    "\"molecules\": {\"chain\": {\"count\": 50, \"chain\": {" CHAIN ",\n"
    "    \"bond\": \"backbone\", \"angle\": \"bend\", \"dihedral\": \"twist\"}},\n"
    "  \"ring\": {\"count\": 20, \"exclude\": 0, \"beads\": [\"A\", \"A\", \"A\"],\n"
    "    \"bonds\": {\"spring\": " RING "}}},\n" SINGLE ",\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 20}, \"bond_lengths\": {\"bins\": 50},\n"
    "\"intermolecular_rdf\": {\"range\": 2, \"bins\": 20}, \"kirkwood_buff\": {\"q_maximum\": 2},\n"
    "\"bond_angles\": {\"bins\": 30}, \"dihedral_angles\": {\"bins\": 36},\n"
    "\"molecule_sizes\": {\"lags\": 10}, \"snapshots\": {\"every\": 400, \"formats\": [\"json\",\n"
    "\"lammps-dump\"]},\n"
    "\"measure\": {\"equilibration\": 400, \"samples\": 60, \"every\": 20}}\n";

static const char *const tables[] = {
    "thermodynamics.tsv",  "rdf_A-A.tsv",        "rdf_W-A.tsv",
    "bond_lengths.tsv",    "bond_angles.tsv",    "end_to_end.tsv",
    "dihedral_angles.tsv", "molecule_sizes.tsv", "intermolecular_rdf_A-A.tsv",
    "configuration.tsv",   "used.json",          NULL};

static void write_inputs(struct temporary_folder *folder, const char *from, const char *to) {
    char twist[4096] = "# phi[degrees] U[k_B.T_0]\n";
    for (int phi = -180; phi <= 180; phi += 10)
        snprintf(twist + strlen(twist), sizeof twist - strlen(twist), "%d %.10g\n", phi,
                 2 + 2 * cos(3 * phi * M_PI / 180));
    small_inputs_write(folder, "twist.tsv", twist, NULL, NULL);
    small_inputs_write(folder, "scene.json", scene, from, to);
}

static void test_molecules_go_on_with_the_same_bits(void **state) {
    static const char *const integrals[] = {"kirkwood_buff_chain-chain", "kirkwood_buff_chain-W",
                                            "kirkwood_buff_error_ring-W"};
    static struct run_program_result result;
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
    for (size_t k = 0; k < sizeof integrals / sizeof *integrals; k++)
        results_assert_number("pieces/summary.json", integrals[k],
                              results_number("whole/summary.json", integrals[k]));
    RUN_PROGRAM(&result, "simulate", "whole/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "again", tables);
}

/// The file's rows without its comments: column `column`, at most `max` of them.
static size_t read_column(const char *file, int column, double *values, size_t max) {
    char line[4096];
    size_t rows = 0;
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    while (rows < max && fgets(line, sizeof line, stream)) {
        char *at = line;
        if (line[0] == '#')
            continue;
        for (int k = 0; k <= column; k++)
            values[rows] = strtod(at, &at);
        rows++;
    }
    fclose(stream);
    return rows;
}

static void test_distributions_are_normalised_and_lie_where_the_laws_are(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *file;
        int column;
        double rest, tolerance; ///< of the mean
    } expected[] = {
        {"out/bond_lengths.tsv", 1, 0.8, 0.05},
        {"out/bond_angles.tsv", 1, 117, 4},
        {"out/dihedral_angles.tsv", 1, 0, 15}, // symmetric
    };
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    for (size_t n = 0; n < sizeof expected / sizeof *expected; n++) {
        double q[100], p[100], sum = 0, mean = 0;
        const size_t rows = read_column(expected[n].file, 0, q, 100);
        assert_int_equal(read_column(expected[n].file, expected[n].column, p, 100), rows);
        for (size_t k = 0; k < rows; k++) {
            sum += p[k] * (q[1] - q[0]);
            mean += p[k] * q[k] * (q[1] - q[0]);
        }
        assert_close(sum, 1, 1e-6);
        assert_close(mean, expected[n].rest, expected[n].tolerance);
    }
    // The rings' first and last bead are bonded: their distance is a bond length, below 1.5.
    double ring[60];
    assert_int_equal(read_column("out/molecule_sizes.tsv", 4, ring, 60), 60);
    for (int k = 0; k < 60; k++)
        assert_true(ring[k] > 0.01 && ring[k] < 2.25);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "molecules                          on ");
    assert_contains(result.out, "bond angles                        on ");
}

/// A free joint prefers no direction: p(theta) is sin(theta)/2 a radian, and flat without its
/// Jacobian. 400 trimers of 40 samples leave an error of 3 % in the two rarest of nine bins, of 6 %
/// of the angles each.
static void test_a_free_joint_has_the_distribution_of_a_sphere(void **state) {
    static struct run_program_result result;
    small_inputs_write(
        *state, "joint.json",
        "{\"density\": 1, \"time_step\": 0.002, \"bonds\": {" BACKBONE "},\n"
        "\"angles\": {\"free\": {\"law\": \"harmonic\", \"k\": 0}}, \"molecules\": {\"trimer\":\n"
        "{\"count\": 400, \"chain\": {\"type\": \"A\", \"length\": 3, \"bond\": \"backbone\",\n"
        "\"angle\": \"free\"}}}, \"dynamics\": {\"integrator\": \"brownian\"}, \"rdf\":\n"
        "{\"range\": 2}, \"bond_angles\": {\"bins\": 9},\n"
        "\"measure\": {\"equilibration\": 2000, \"samples\": 40, \"every\": 200}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "joint.json", "-o", "joint");
    run_program_assert_code(&result, 0);
    double theta[9], p[9], flat[9], mean = 0;
    assert_int_equal(read_column("joint/bond_angles.tsv", 0, theta, 9), 9);
    assert_int_equal(read_column("joint/bond_angles.tsv", 1, p, 9), 9);
    assert_int_equal(read_column("joint/bond_angles.tsv", 3, flat, 9), 9);
    for (int k = 0; k < 9; k++)
        mean += flat[k] / 9;
    for (int k = 0; k < 9; k++) {
        const double exact = 0.5 * sin(theta[k] * M_PI / 180) * M_PI / 180;
        assert_close_relative(p[k], exact, 0.15);
        assert_close_relative(flat[k], mean, 0.15);
    }
}

/// The bonds beside the last configuration are those of 50 chains and 20 rings, by how far their
/// beads are apart; beads of a box of 6 that nothing binds are twice as far.
static void check_bonds(const char *file, const char *bonds_file) {
    enum { BONDS = 50 * 3 + 20 * 3, BEADS = 320 };
    double x[3][BEADS], ends[2][BONDS];
    for (int d = 0; d < 3; d++)
        assert_int_equal(read_column(file, d, x[d], BEADS), BEADS);
    for (int n = 0; n < 2; n++)
        assert_int_equal(read_column(bonds_file, n, ends[n], BONDS), BONDS);
    for (int k = 0; k < BONDS; k++) {
        double square = 0;
        for (int d = 0; d < 3; d++)
            square += pow(remainder(x[d][(int)ends[0][k] - 1] - x[d][(int)ends[1][k] - 1], 6), 2);
        assert_close(sqrt(square), 0.8, 0.55);
    }
}

/// Snapshots tell the molecules, and a run can begin where another ended.
static void test_configurations_carry_molecules_on(void **state) {
    static struct run_program_result result;
    char line[256] = "", first[64] = "";
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    FILE *dump = fopen("out/snapshots/trajectory.lammpstrj", "r");
    assert_non_null(dump);
    while (fgets(line, sizeof line, dump) && strncmp(line, "ITEM: ATOMS", 11) != 0)
        ;
    assert_string_equal(line,
                        "ITEM: ATOMS id mol type element typelabel mass x y z ix iy iz vx vy vz fx "
                        "fy fz\n");
    check_bonds("out/configuration.tsv", "out/configuration_bonds.tsv");
    // Types are W, A, B: the first of 60 single beads, after 70 molecules, is molecule 71.
    assert_non_null(fgets(first, sizeof first, dump));
    assert_int_equal(strncmp(first, "1 71 1 W W 1 ", 13), 0);
    fclose(dump);
    write_inputs(*state, SINGLE,
                 "\"particles\": {\"types\": {\"W\": 60}, \"placement\": \"file\", \"file\": "
                 "\"out/configuration.tsv\"}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "next");
    run_program_assert_code(&result, 0);
    double length[50], p[50];
    assert_int_equal(read_column("next/bond_lengths.tsv", 0, length, 50), 50);
    assert_int_equal(read_column("next/bond_lengths.tsv", 1, p, 50), 50);
    for (int k = 0; k < 50; k++) // bonds are still what they were
        if (fabs(length[k] - 0.8) > 0.55)
            assert_close(p[k], 0, 1e-12);
}

/// A rod of five beads 0.7 apart along a diagonal of the plane, across corners of the box, at rest.
static void test_sizes_of_a_rod_are_those_of_geometry(void **state) {
    static struct run_program_result result;
    char beads[1024] = "";
    for (int rod = 0; rod < 2; rod++)
        for (int k = 0; k < 5; k++)
            snprintf(beads + strlen(beads), sizeof beads - strlen(beads), "%.15g %.15g %d\n",
                     fmod(4.5 + 0.7 * k * sqrt(0.5), 6), fmod(4.8 + 0.7 * k * sqrt(0.5), 6),
                     1 + 3 * rod);
    small_inputs_write(*state, "beads.tsv", beads, NULL, NULL);
    small_inputs_write(
        *state, "rod.json",
        "{\"box\": [6, 6, 6], \"time_step\": 0.001, \"temperature\": 1e-12,\n"
        "\"bonds\": {" BACKBONE_OF(
            "0.7") "}, \"molecules\": {\"rod\": {\"count\": 2, \"chain\":\n"
                   "{\"type\": \"A\", \"length\": 5, \"bond\": \"backbone\"}}}, \"particles\":\n"
                   "{\"placement\": \"file\", \"file\": \"beads.tsv\"}, \"rdf\": {\"range\": 2},\n"
                   "\"molecule_sizes\": {\"lags\": 1},\n"
                   "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "rod.json", "-o", "rod");
    run_program_assert_code(&result, 0);
    double gyration[2], end[2], correlation[2];
    assert_int_equal(read_column("rod/molecule_sizes.tsv", 1, gyration, 2), 2);
    assert_int_equal(read_column("rod/molecule_sizes.tsv", 2, end, 2), 2);
    assert_int_equal(read_column("rod/end_to_end.tsv", 1, correlation, 2), 2);
    assert_close(end[0], 16 * 0.49, 1e-5);
    assert_close(gyration[0], 2 * 0.49, 1e-5); // (N^2 - 1)/12 = 2
    assert_close(correlation[1], 1, 1e-5);
}

static void test_a_pair_named_in_a_scene_of_one_type_is_refused(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "one.json",
                       "{\"box\": [6, 6, 6], \"particles\": {\"count\": 100}, \"conservative\":\n"
                       "{\"A-A\": {\"law\": \"soft-repulsion\"}}, \"rdf\": {\"range\": 2},\n"
                       "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "one.json", "-o", "bad");
    run_program_assert_refused(
        &result, ".", "A-A", 1,
        (const char *const[]){"conservative.A-A: pairs are named in mixtures",
                              "write \"conservative\": {\"law\"", NULL});
}

/// The mass of the only type is that of all beads, whichever way it is written.
static void test_a_mass_of_the_only_type_is_that_of_all(void **state) {
    static const char *const masses[] = {"2.5", "{\"W\": 2.5}"};
    static struct run_program_result result;
    char text[1024], *runs[2];
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text,
                 "{\"box\": [6, 6, 6], \"bonds\": {" BACKBONE "}, \"molecules\": {\"dimer\":\n"
                 "{\"count\": 20, \"chain\": {\"type\": \"W\", \"length\": 2, \"bond\": "
                 "\"backbone\"}}},\n\"particles\": {\"types\": {\"W\": 40}, \"mass\": %s},\n"
                 "\"conservative\": {\"law\": \"soft-repulsion\"}, \"time_step\": 0.01,\n"
                 "\"measure\": {\"equilibration\": 10, \"samples\": 5, \"every\": 1}}\n",
                 masses[k]);
        small_inputs_write(*state, "mass.json", text, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "mass.json", "-o", "mass", "--force");
        run_program_assert_code(&result, 0);
        runs[k] = temporary_folder_read("mass/thermodynamics.tsv");
    }
    assert_string_equal(runs[0], runs[1]);
    free(runs[0]);
    free(runs[1]);
}

/// aboba takes half of the inner steps in each half of a step, and its help says what that makes
/// of 3.
static void test_an_odd_number_of_inner_steps_is_made_even_as_the_help_says(void **state) {
    static struct run_program_result result;
    char text[1024], *runs[3];
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text,
                 "{\"box\": [6, 6, 6], \"bonds\": {" BACKBONE "}, \"molecules\": {\"dimer\":\n"
                 "{\"count\": 20, \"chain\": {\"type\": \"A\", \"length\": 2, \"bond\": "
                 "\"backbone\"}}},\n\"conservative\": {\"law\": \"soft-repulsion\"},\n"
                 "\"dissipative\": {\"law\": \"power\"}, \"time_step\": 0.02, \"dynamics\":\n"
                 "{\"integrator\": \"aboba\", \"inner_steps\": %d},\n"
                 "\"measure\": {\"equilibration\": 10, \"samples\": 5, \"every\": 1}}\n",
                 2 + k);
        small_inputs_write(*state, "inner.json", text, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "inner.json", "-o", "inner", "--force");
        run_program_assert_code(&result, 0);
        runs[k] = temporary_folder_read("inner/thermodynamics.tsv");
    }
    assert_string_not_equal(runs[0], runs[1]);
    assert_string_equal(runs[1], runs[2]);
    for (int k = 0; k < 3; k++)
        free(runs[k]);
    RUN_PROGRAM(&result, "describe", "aboba");
    assert_contains(result.out, "rounded up to even");
}

/// A dimer at rest across the box, and one of 2.5, more than three times 0.8.
static void test_a_table_with_stretched_bonds_is_refused(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "beads.tsv", "1 1 1\n1.8 1 1\n5.8 3 3\n2.3 3 3\n", NULL, NULL);
    small_inputs_write(
        *state, "dimer.json",
        "{\"box\": [6, 6, 6], \"bonds\": {" BACKBONE
        "}, \"molecules\": {\"dimer\": {\"count\": 2,\n"
        "\"chain\": {\"type\": \"A\", \"length\": 2, \"bond\": \"backbone\"}}}, \"particles\":\n"
        "{\"placement\": \"file\", \"file\": \"beads.tsv\"}, \"rdf\": {\"range\": 2},\n"
        "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "dimer.json", "-o", "bad");
    run_program_assert_refused(
        &result, ".", "beads.tsv", 1,
        (const char *const[]){"particles.file: ", "the bond of atoms 3 and 4, of dimer number 2",
                              "is 2.5 long, and at rest 0.8", NULL});
}

/// The end of a run is a beginning: a soft bond is often many times as long as at rest.
static void test_a_snapshot_of_soft_bonds_is_no_stretched_one(void **state) {
    static struct run_program_result result;
    static const char soft[] =
        "{\"box\": [5, 5, 5], \"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 4,\n"
        "  \"length\": 0.2}}, \"molecules\": {\"chain\": {\"count\": 30, \"exclude\": 0,\n"
        "  \"chain\": {\"type\": \"A\", \"length\": 8, \"bond\": \"spring\"}}},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": \"power\"},\n"
        "\"snapshots\": {\"every\": 100, \"formats\": [\"json\"]},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 5, \"every\": 20}}\n";
    small_inputs_write(*state, "first.json", soft, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "first.json", "-o", "first");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "second.json", soft, "\"box\"",
                       "\"particles\": {\"placement\": \"file\",\n"
                       "  \"file\": \"first/snapshots/step_000000200.json\"}, \"box\"");
    RUN_PROGRAM(&result, "simulate", "second.json", "-o", "second");
    run_program_assert_code(&result, 0);
}

// What cannot be ----------------------------------------------------------------------------------

static const struct fault {
    const char *from, *to, *words[4];
} faults[] = {
    {RING,
     "[[1, 2], [2, 4]]",
     {"scene.json: molecules.ring: the bond 2-4 has a bead 4, which is not there: beads are 1 to "
      "3"}},
    {RING, "[[1, 2], [2, 3], [2, 1]]", {"molecules.ring: duplicate bond 2-1"}},
    {RING, "[[1, 2], [2, 2]]", {"molecules.ring: the bond 2-2 has a bead twice"}},
    {RING,
     "[[1, 2], [2]]",
     {"molecules.ring.bonds.spring: expected a list of lists of 2 integers; number 2 is not one"}},
    {RING,
     "[[1, 2], [2, 2.5]]",
     {"molecules.ring.bonds.spring: expected a list of lists of 2 integers"}},
    {"\"bonds\": {\"spring\": " RING,
     "\"bonds\": {\"sprong\": " RING,
     {"molecules.ring.bonds.sprong: unknown key; did you mean \"spring\"?"}},
    {"\"bond\": \"backbone\"",
     "\"bond\": \"bakbone\"",
     {"molecules.chain.chain.bond: \"bakbone\" is not a group of \"bonds\"; did you mean "
      "\"backbone\"?"}},
    {", \"dihedral\": \"twist\"", "", {"dihedrals.twist: no molecule has such a dihedral"}},
    {BACKBONE,
     "\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 3}",
     {"scene.json: bonds.backbone: a bond of 3 is not shorter than half of the box, whose shortest "
      "edge is 6"}},
    {BACKBONE,
     "\"backbone\": {\"law\": \"harmonix\", \"k\": 100, \"length\": 0.8}",
     {"bonds.backbone.law", "did you mean \"harmonic\"?"}},
    {"\"k\": 20", "\"k\": -20", {"angles.bend.k: -20 is out of range"}},
    {"\"exclude\": 0", "\"exclude\": 4", {"molecules.ring.exclude: 4 is out of range"}},
    {"\"count\": 20", "\"count\": 0", {"molecules.ring.count: 0 is out of range"}},
    {CHAIN, "\"type\": \"A\"", {"molecules.chain.chain.length: missing"}},
    {CHAIN, CHAIN ", \"length\": 4", {"molecules.chain.chain.length: \"beads\" is given, too"}},
    {CHAIN, CHAIN ", \"type\": \"A\"", {"molecules.chain.chain.type: \"beads\" is given, too"}},
    {CHAIN,
     "\"type\": \"A\", \"length\": 1",
     {"molecules.chain.chain.length: 1 is out of range; allowed: 2 to"}},
    {CHAIN,
     "\"beads\": [\"A\", \"A\", \"B\"]",
     {"molecules.chain.chain.dihedral: a dihedral is of 4 beads, and the chain has 3"}},
    {CHAIN,
     "\"beads\": [\"A\", \"a b\"]",
     {"molecules.chain.chain.beads: \"a b\": expected a type name"}},
    {"\"types\": {\"W\": 60},",
     "\"count\": 60,",
     {"particles.count: with molecules single beads need types"}},
    {"\"box\": [6, 6, 6]",
     "\"dimensions\": 2, \"box\": [6, 6]",
     {"dihedrals: in two dimensions there are none"}},
    {"\"seed\": 3,",
     "\"seed\": 3, \"dynamics\": {\"integrator\": \"event-driven\"},",
     {"event-driven"}},
};

static void test_molecules_that_cannot_be_are_refused_in_one_line(void **state) {
    static struct run_program_result result;
    for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
        write_inputs(*state, faults[n].from, faults[n].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "bad");
        run_program_assert_refused(&result, ".", faults[n].to, 1, faults[n].words);
    }
}

static void test_tables_of_dihedrals_must_close(void **state) {
    static struct run_program_result result;
    static const char *const words[] = {"dihedrals.twist.file: ", "twist.tsv",
                                        "a dihedral's table spans 360 degrees, not 270", NULL};
    write_inputs(*state, NULL, NULL);
    small_inputs_write(*state, "twist.tsv", "# phi U\n-180 0\n-90 1\n0 2\n90 0\n", NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "bad");
    run_program_assert_refused(&result, ".", "table", 1, words);
}

static void test_what_looks_wrong_is_warned_of(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "\"exclude\": 0,", "\"exclude\": 1,");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fene");
    assert_null(strstr(result.err, "half of the box"));
    assert_contains(result.err, "molecules.ring: \"fene\" only pulls");
    write_inputs(*state, "\"bonds\": {\"spring\": " RING,
                 "\"angles\": {\"bend\": [[1, 2, 3]]}, \"bonds\": {\"spring\": [[1, 2]]");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "loose");
    assert_contains(result.err, "molecules.ring: angle 1-2-3 has no bond 2-3");
    assert_contains(result.err, "molecules.ring: it is in pieces: no bonds join its beads 1 and 3");
    // Half of the box is 3: one standard deviation of 0.1 beyond the rest.
    write_inputs(*state, BACKBONE, BACKBONE_OF("2.9"));
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "long");
    assert_contains(result.err,
                    "bonds.backbone: 18 % of them would be longer than half of the box");
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_molecules_go_on_with_the_same_bits),
        TEST(test_distributions_are_normalised_and_lie_where_the_laws_are),
        TEST(test_a_free_joint_has_the_distribution_of_a_sphere),
        TEST(test_configurations_carry_molecules_on),
        TEST(test_sizes_of_a_rod_are_those_of_geometry),
        TEST(test_molecules_that_cannot_be_are_refused_in_one_line),
        TEST(test_tables_of_dihedrals_must_close),
        TEST(test_an_odd_number_of_inner_steps_is_made_even_as_the_help_says),
        TEST(test_a_mass_of_the_only_type_is_that_of_all),
        TEST(test_a_pair_named_in_a_scene_of_one_type_is_refused),
        TEST(test_a_snapshot_of_soft_bonds_is_no_stretched_one),
        TEST(test_a_table_with_stretched_bonds_is_refused),
        TEST(test_what_looks_wrong_is_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
