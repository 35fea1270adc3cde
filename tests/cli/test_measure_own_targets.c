// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `mesofit measure` writes, `mesofit fit --target` takes: of one type of beads, of bonds of
// fixed length, of molecules of a topology, of a type with one bead,
// of a molecule in vacuum.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 20, TRIMERS = 100 };
static const double edge = 4; // nm

static struct run_program_result result;

static double uniform(void) {
    return (rand() + 0.5) / (RAND_MAX + 1.0);
}

static double normal(void) {
    return sqrt(-2 * log(uniform())) * cos(2 * M_PI * uniform());
}

/// Three at right angles, in any direction.
static void turn(double axis[2][3]) {
    double length = 0, along = 0;
    for (int d = 0; d < 3; d++) {
        axis[0][d] = normal();
        axis[1][d] = normal();
    }
    for (int d = 0; d < 3; d++)
        length += axis[0][d] * axis[0][d];
    for (int d = 0; d < 3; d++)
        axis[0][d] /= sqrt(length);
    for (int d = 0; d < 3; d++)
        along += axis[0][d] * axis[1][d];
    length = 0;
    for (int d = 0; d < 3; d++) {
        axis[1][d] -= along * axis[0][d];
        length += axis[1][d] * axis[1][d];
    }
    for (int d = 0; d < 3; d++)
        axis[1][d] /= sqrt(length);
}

/// How a trimer is made: its types, mean and deviation of its bonds [nm] and of its angle
/// [degrees].
struct trimer {
    const char *type[3];
    double bond, bond_deviation, angle, angle_deviation;
};

static void write_trimer(FILE *file, const struct trimer *trimer) {
    double axis[2][3], place[3][3];
    const double angle = (trimer->angle + trimer->angle_deviation * normal()) * M_PI / 180;
    const double first = trimer->bond + trimer->bond_deviation * normal(),
                 second = trimer->bond + trimer->bond_deviation * normal();
    turn(axis);
    for (int d = 0; d < 3; d++) {
        place[1][d] = edge * uniform();
        place[0][d] = place[1][d] + first * axis[0][d];
        place[2][d] = place[1][d] + second * (cos(angle) * axis[0][d] + sin(angle) * axis[1][d]);
    }
    for (int n = 0; n < 3; n++)
        fprintf(file, "%s %.9f %.9f %.9f\n", trimer->type[n], 10 * place[n][0], 10 * place[n][1],
                10 * place[n][2]);
}

/// A gas of them, in Å.
static void write_gas(const char *name, const struct trimer *trimer) {
    FILE *file = fopen(name, "w");
    srand(5);
    for (int t = 0; t < FRAMES; t++) {
        fprintf(file,
                "%d\nLattice=\"%g 0 0 0 %g 0 0 0 %g\" Properties=species:S:1:pos:R:3 Time=%d\n",
                3 * TRIMERS, 10 * edge, 10 * edge, 10 * edge, 1000 * t);
        for (int m = 0; m < TRIMERS; m++)
            write_trimer(file, trimer);
    }
    fclose(file);
}

static void measure(const char *trajectory, const char *molecules) {
    RUN_PROGRAM(&result, "measure", trajectory, "--molecules", molecules, "--bins", "36", "--range",
                "1.8", "--static", "--temperature", "300", "-o", "target", "--force");
    run_program_assert_code(&result, 0);
}

static void explain(void) {
    RUN_PROGRAM(&result, "fit", "--target", "target", "--explain");
    run_program_assert_code(&result, 0);
}

static void test_one_type_keeps_its_name(void **state) {
    write_gas("gas.xyz", &(struct trimer){{"A", "A", "A"}, 0.3, 0.02, 120, 8});
    small_inputs_write(
        *state, "kinds.json",
        "{\"molecules\": {\"trimer\": {\"chain\": {\"beads\": [\"A\", \"A\", \"A\"], "
        "\"bond\": \"AA\", \"angle\": \"AAA\"}}}}\n",
        NULL, NULL);
    measure("gas.xyz", "kinds.json");
    explain();
    assert_contains(result.out, "chosen: method \"auto\"");
    assert_null(strstr(result.out, "constraint"));
    small_inputs_write(*state, "kinds.json",
                       "{\"molecules\": {\"trimer\": {\"chain\": {\"type\": \"A\", \"length\": 3, "
                       "\"bond\": \"AA\", \"angle\": \"AAA\"}}}}\n",
                       NULL, NULL);
    measure("gas.xyz", "kinds.json");
    explain();
}

/// The number after a word in a text.
static double number_after(const char *text, const char *words) {
    const char *found = strstr(text, words);
    assert_non_null(found);
    return strtod(found + strlen(words), NULL);
}

/// Bonds of a deviation of 0.2 % of their length are a constraint: k_B T/(1 % of 0.15 nm)², with
/// 8.314462618 J/(mol K) and 300 K. The angle is found from its distribution.
static void test_constrained_bonds_are_a_known_law(void **state) {
    write_gas("gas.xyz", &(struct trimer){{"A", "B", "A"}, 0.15, 0.0003, 100, 5});
    small_inputs_write(
        *state, "kinds.json",
        "{\"molecules\": {\"trimer\": {\"chain\": {\"beads\": [\"A\", \"B\", \"A\"], "
        "\"bond\": \"AB\", \"angle\": \"ABA\"}}}}\n",
        NULL, NULL);
    measure("gas.xyz", "kinds.json");
    assert_contains(result.err, "bond \"AB\": a constraint (standard deviation 0.0003, mean");
    explain();
    assert_contains(result.out, "chosen: bond \"AB\": a constraint");
    assert_contains(result.out, "standard deviation 0.0015, 1 % of the mean");
    assert_close_relative(number_after(result.out, "a harmonic potential with k = "),
                          8.314462618e-3 * 300 / (0.0015 * 0.0015), 1e-3);
    assert_null(strstr(result.out, "target bond_lengths"));
    assert_contains(result.out, "target bond_angles.ABA");
}

static const char topology[] =
    "[ defaults ]\n1 1 no 1.0 1.0\n[ atomtypes ]\nA 15.0 0.0 A 0.0 1.0\nB 15.0 0.0 A 0.0 1.0\n"
    "[ moleculetype ]\ntrimer 2\n[ atoms ]\n1 A 1 T A1 1 0 15.0\n2 B 1 T B1 2 0 15.0\n"
    "3 A 1 T A2 3 0 15.0\n[ bonds ]\n1 2 8 1 1.0\n2 3 8 1 1.0\n[ angles ]\n1 2 3 8 1 1.0\n"
    "[ system ]\ntrimers\n[ molecules ]\ntrimer 100\n";

static const char run_of_topology[] =
    "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"A-A\": {\"file\": \"target/rdf_A-A.tsv\"},\n"
    "  \"A-B\": {\"file\": \"target/rdf_A-B.tsv\"}, \"B-B\": {\"file\": \"target/rdf_B-B.tsv\"}},\n"
    "  \"bond_lengths\": {\"A-B\": {\"file\": \"target/bond_lengths.tsv\"}},\n"
    "  \"bond_angles\": {\"A-B-A\": {\"file\": \"target/bond_angles.tsv\"}}},\n"
    "\"scene\": {\"box\": [4, 4, 4], \"temperature\": 300, \"molecules\": {\"file\": "
    "\"topol.top\"}}}\n";

/// Tables, as all models of VOTCA with bonds that were fitted have: their laws come from the
/// targets. With laws of its own the topology knows them, and the targets are compared with them,
/// unless "unknowns" asks for them.
static void test_groups_of_a_topology_have_one_name(void **state) {
    write_gas("gas.xyz", &(struct trimer){{"A", "B", "A"}, 0.3, 0.02, 120, 8});
    small_inputs_write(*state, "topol.top", topology, NULL, NULL);
    measure("gas.xyz", "topol.top");
    explain();
    assert_contains(result.out, "target bond_lengths.A-B: ");
    assert_contains(result.out, "target bond_angles.A-B-A: ");
    small_inputs_write(*state, "run.json", run_of_topology, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "target bond_lengths.A-B: ");
    small_inputs_write(*state, "topol.top", topology, "1 2 8 1 1.0\n2 3 8 1 1.0",
                       "1 2 1 0.3 3000\n2 3 1 0.3 3000");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "run.json", run_of_topology, "\"scene\"",
                       "\"unknowns\": {\"potential\": {}, \"bonds\": {\"A-B\": {}}, \"angles\": "
                       "{\"A-B-A\": {}}}, \"scene\"");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "run.json", run_of_topology, "\"A-B\": {\"file\": \"target/bond",
                       "\"A-B_2\": {\"file\": \"target/bond");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target.bond_lengths.A-B_2: no molecule has such a bond; known: "
                                "A-B");
}

/// One solute in a gas, whose beads are 0.2 nm apart at least.
static void write_solution(const char *name) {
    enum { BEADS = 150, SNAPSHOTS = 30 };
    static const double apart = 0.2, box = 2;
    double place[BEADS][3];
    FILE *file = fopen(name, "w");
    srand(6);
    for (int t = 0; t < SNAPSHOTS; t++) {
        fprintf(file,
                "%d\nLattice=\"%g 0 0 0 %g 0 0 0 %g\" Properties=species:S:1:pos:R:3 Time=%d\n",
                BEADS, 10 * box, 10 * box, 10 * box, t);
        for (int k = 0; k < BEADS;) {
            int other = 0;
            for (int d = 0; d < 3; d++)
                place[k][d] = box * uniform();
            for (; other < k; other++) {
                double square = 0;
                for (int d = 0; d < 3; d++)
                    square += pow(remainder(place[k][d] - place[other][d], box), 2);
                if (square < apart * apart)
                    break;
            }
            if (other < k)
                continue;
            fprintf(file, "%s %.9f %.9f %.9f\n", k ? "W" : "P", 10 * place[k][0], 10 * place[k][1],
                    10 * place[k][2]);
            k++;
        }
    }
    fclose(file);
}

/// There are no pairs of it: no g, no potential, nothing of it in the distance from the targets.
static void test_a_single_bead_of_a_type_is_fitted(void **state) {
    write_solution("solution.xyz");
    small_inputs_write(*state, "kinds.json",
                       "{\"molecules\": {\"solute\": {\"beads\": [\"P\"]}, \"water\": {\"beads\": "
                       "[\"W\"]}}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "measure", "solution.xyz", "--molecules", "kinds.json", "--bins", "18",
                "--range", "0.9", "--static", "--temperature", "300", "-o", "target");
    run_program_assert_code(&result, 0);
    explain();
    assert_null(strstr(result.out, "target rdf.P-P"));
    char *run = temporary_folder_read("target/target.json");
    char *brace = strrchr(run, '}');
    static char text[4096];
    snprintf(text, sizeof text,
             "%.*s, \"method\": {\"name\": \"ibi\", \"iterations\": 2, \"samples\": 20}, "
             "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 4, "
             "\"every\": 5}}\n",
             (int)(brace - run), run);
    free(run);
    small_inputs_write(*state, "target/run.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out");
    assert_true(result.code == 0 || result.code == 1);
    assert_true(results_number("out/summary.json", "rdf_rmse") > 0);
    assert_true(temporary_folder_exists("out/rdf_W-P.tsv") ||
                temporary_folder_exists("out/rdf_P-W.tsv"));
    assert_false(temporary_folder_exists("out/rdf_P-P.tsv"));
}

/// One trimer, in a box or without, of which there is no g(r).
static void write_alone(const char *name, bool box) {
    enum { SNAPSHOTS = 400 };
    const struct trimer trimer = {{"A", "A", "A"}, 0.3, 0.02, 120, 8};
    FILE *file = fopen(name, "w");
    srand(7);
    for (int t = 0; t < SNAPSHOTS; t++) {
        fprintf(file, "3\n%sProperties=species:S:1:pos:R:3 Time=%d\n",
                box ? "Lattice=\"40 0 0 0 40 0 0 0 40\" " : "", 1000 * t);
        write_trimer(file, &trimer);
    }
    fclose(file);
}

/// Nothing is between beads that are not bonded, so that the potentials are −k_B T ln(p/J), and the
/// first samples agree.
static void test_a_molecule_in_vacuum_is_fitted_by_its_bonds(void **state) {
    small_inputs_write(*state, "kinds.json",
                       "{\"molecules\": {\"trimer\": {\"chain\": {\"type\": \"A\", \"length\": 3, "
                       "\"bond\": \"AA\", \"angle\": \"AAA\"}}}}\n",
                       NULL, NULL);
    for (int box = 1; box >= 0; box--) {
        write_alone("alone.xyz", box);
        RUN_PROGRAM(&result, "measure", "alone.xyz", "--molecules", "kinds.json", "--temperature",
                    "300", "-o", "target", "--force");
        run_program_assert_code(&result, 0);
        assert_contains(result.err, box ? "a single molecule" : "there is no box");
        assert_true(temporary_folder_exists("target/rdf.tsv") == box);
        explain();
        assert_contains(result.out, "chosen: method \"auto\"");
        assert_contains(result.out, "dynamics \"monte-carlo\"");
    }
    RUN_PROGRAM(&result, "measure", "alone.xyz", "-o", "other");
    run_program_assert_code(&result, 2);
    assert_contains(
        result.err,
        "frame 0 has no box: g(r) needs the volume and its images; give it by --box; with "
        "--molecules bonds and angles are measured without");
    write_gas("gas.xyz", &(struct trimer){{"A", "A", "A"}, 0.3, 0.0003, 120, 0.01});
    RUN_PROGRAM(&result, "measure", "gas.xyz", "--molecules", "kinds.json", "--temperature", "300",
                "--static", "-o", "target", "--force");
    char *target = temporary_folder_read("target/target.json");
    char *rdf = strstr(target, "\"rdf\""), *rest = strstr(target, "\"bond_lengths\"");
    memmove(rdf, rest, strlen(rest) + 1);
    small_inputs_write(*state, "target/run.json", target, NULL, NULL);
    free(target);
    RUN_PROGRAM(&result, "fit", "target/run.json", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "nothing to fit: its target is that of a constraint");
}

/// Trimers A-B-A, all A before all B, which in the first frames are in an eighth of the box.
static void write_compressed(const char *name) {
    enum { MOLECULES = 30, SNAPSHOTS = 80, COMPRESSED = 10 };
    FILE *file = fopen(name, "w");
    srand(8);
    for (int t = 0; t < SNAPSHOTS; t++) {
        double middle[MOLECULES][3];
        fprintf(file,
                "%d\nLattice=\"%g 0 0 0 %g 0 0 0 %g\" Properties=species:S:1:pos:R:3:mol:I:1 "
                "Time=%d\n",
                3 * MOLECULES, 10 * edge, 10 * edge, 10 * edge, 1000 * t);
        for (int m = 0; m < MOLECULES; m++)
            for (int d = 0; d < 3; d++)
                middle[m][d] = (t < COMPRESSED ? 5 : 10) * edge * uniform();
        for (int k = 0; k < 3 * MOLECULES; k++) {
            const double *x = middle[k % MOLECULES];
            const double shift = k < MOLECULES ? 3 : k < 2 * MOLECULES ? -3 : 0;
            fprintf(file, "%s %.9f %.9f %.9f %d\n", shift == 0 ? "B" : "A", x[0] + shift, x[1],
                    x[2] + 0.1 * shift * normal(), k % MOLECULES + 1);
        }
    }
    fclose(file);
}

/// They are left out in a second reading, in which the types of the molecules' file have become
/// those of the map, whose order is another.
static void test_molecules_are_found_again_behind_frames_that_are_left_out(void **state) {
    write_compressed("gas.xyz");
    small_inputs_write(
        *state, "kinds.json",
        "{\"molecules\": {\"trimer\": {\"chain\": {\"beads\": [\"A\", \"B\", \"A\"], "
        "\"bond\": \"AB\", \"angle\": \"ABA\"}}}}\n",
        NULL, NULL);
    small_inputs_write(*state, "map.json",
                       "{\"beads\": {\"B\": {\"first\": 61, \"last\": 90, \"size\": 1}, \"A\": "
                       "{\"first\": 1, \"last\": 60, \"size\": 1}}, \"masses\": {\"A\": 1, \"B\": "
                       "1}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "measure", "gas.xyz", "--molecules", "kinds.json", "--map", "map.json",
                "--bins", "36", "--range", "1.8", "--static", "--temperature", "300", "-o",
                "target");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "frames are not in equilibrium");
    explain();
    assert_contains(result.out, "target bond_angles.ABA");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_one_type_keeps_its_name),
        TEST(test_constrained_bonds_are_a_known_law),
        TEST(test_groups_of_a_topology_have_one_name),
        TEST(test_a_single_bead_of_a_type_is_fitted),
        TEST(test_a_molecule_in_vacuum_is_fitted_by_its_bonds),
        TEST(test_molecules_are_found_again_behind_frames_that_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
