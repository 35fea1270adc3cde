// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules of scenes from topologies of GROMACS: what the preprocessor and the sections say, our
// own export read again, and files that cannot be right.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <string.h>

static const char scene[] =
    "{\"seed\": 2, \"box\": [5, 5, 5], \"time_step\": 0.002, \"units\": {\"length\": 0.5,\n"
    "  \"temperature\": 300, \"mass\": 5e-26}, \"molecules\": {\"file\": \"topol.top\"},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"}, \"bond_lengths\": {},\n"
    "\"measure\": {\"equilibration\": 20, \"samples\": 2, \"every\": 10}}\n";

/// kJ/mol in k_B T at 300 K, by CODATA's constants.
static const double energy = 1 / (8.31446261815324e-3 * 300);

static const char topology[] =
    "; a comment\n"
    "#define STIFF 0.4 \\\n  2000.0\n"
    "#include \"types.itp\"\n"
    "#ifdef FLEXIBLE\n#include \"nowhere.itp\"\n#else\n"
    "[ moleculetype ]\nhexane 2 ; nrexcl\n#endif\n"
    "[ atoms ]\n; nr type\n1 C1 1 HEX A 1 0.0 42.0\n2 C2 1 HEX B 2\n3 "
    "C1 1 HEX A 3\n4 C1 1 HEX A 4\n"
    "[ bonds ]\n1 2 1\n2 3 1 STIFF\n3 4 7 0.8 500\n"
    "[angles]\n1 2 3 1 110 30.0\n2 3 4 2 120.0 45\n"
    "[ dihedrals ]\n1 2 3 4 9 180 2.5 3\n"
    "4 3 2 1 3 1 2 3 4 5 6 ; the same beads in another group\n"
    "[ moleculetype ]\nW 1\n[ atoms ]\n1 C2 1 W W 1\n"
    "[ moleculetype ]\nION 1\n[ atoms ]\n1 Na 1 ION Na 1\n2 Na 1 ION Na 2\n"
    "[ bonds ]\n1 2 1 0.9 77\n"
    "[ system ]\nany words\n[ molecules ]\nhexane 20\nW 5\nhexane 10\n";
static const char types[] = "[ defaults ]\n1 1\n[ atomtypes ]\nC1 42.0 0.0 A 0.0 0.0\n"
                            "[ bondtypes ]\nC2 C1 1 0.38 1500\n[ nonbond_params ]\nC1 C1 1 0 0\n";

static void write_inputs(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "types.itp", types, NULL, NULL);
    small_inputs_write(folder, "topol.top", topology, from, to);
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
}

/// λ = 0.5 nm. A line goes on after a backslash, a bond without numbers has those of its types,
/// and counts of one name add up.
static void test_a_topology_says_what_molecules_are(void **state) {
    static struct run_program_result result;
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    const char *const used = "out/used.json";
    results_assert_number(used, "molecules.hexane.count", 30);
    results_assert_number(used, "molecules.hexane.exclude", 2);
    results_assert_number(used, "molecules.W.count", 5);
    FILE *stream = fopen(used, "r"); // nothing is left of what there is none of
    char line[1024];
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream))
        assert_true(strstr(line, "Na") == NULL && strstr(line, "ION") == NULL);
    fclose(stream);
    assert_close_relative(results_number(used, "bonds.C1-C2.k"), 1500 * energy * 0.25, 1e-6);
    assert_close_relative(results_number(used, "bonds.C1-C2.length"), 0.76, 1e-12);
    assert_close_relative(results_number(used, "bonds.C2-C1.k"), 2000 * energy * 0.25, 1e-6);
    results_assert_text(used, "bonds.C1-C1.law", "fene");
    assert_close_relative(results_number(used, "bonds.C1-C1.longest"), 1.6, 1e-12);
    assert_close_relative(results_number(used, "angles.C1-C2-C1.k"), 30 * energy, 1e-6);
    results_assert_number(used, "angles.C1-C2-C1.angle", 110);
    results_assert_text(used, "angles.C2-C1-C1.law", "cosine-squared");
    results_assert_number(used, "dihedrals.C1-C2-C1-C1.multiplicity", 3);
    results_assert_number(used, "dihedrals.C1-C2-C1-C1.phase", 180);
    results_assert_text(used, "dihedrals.C1-C1-C2-C1.law", "ryckaert-bellemans");
    assert_close_relative(results_number(used, "dihedrals.C1-C1-C2-C1.c5"), 6 * energy, 1e-6);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", (const char *const[]){"bond_lengths.tsv", NULL});
}

/// Sections of such a text were one long comment.
static void test_a_topology_may_have_the_lines_of_old_macs(void **state) {
    static struct run_program_result result;
    static char text[sizeof topology];
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    memcpy(text, topology, sizeof text);
    for (char *at = text; (at = strchr(at, '\n')); at++)
        *at = '\r';
    temporary_folder_write(*state, "topol.top", text, strlen(text));
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "mac", "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "mac", (const char *const[]){"bond_lengths.tsv", "used.json", NULL});
}

/// It takes beads nowhere, before the first step.
static void test_a_coefficient_beyond_numbers_is_unstable(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "1 2 3 4 5 6 ; the same", "1 2 3 4 5 1e308 ; the same");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 1);
    assert_contains(result.err, "scene.json: unstable at step 0: a position is nan");
}

static void test_what_is_not_taken_is_told(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "3 4 7 0.8 500", "3 4 1 0.4 500");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "types.itp:8: parameters of pairs are not used");
}

/// 1-2 and 2-3 are bonded, and the angle 1-3-2 begins with a pair that is not.
static void test_an_angle_without_its_bonds_is_warned_of(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "1 2 3 1 110 30.0", "1 3 2 1 110 30.0");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_contains(result.err,
                    "molecules.hexane: angle 1-3-2 has no bond 1-3; molecules.hexane: \"fene\"");
}

/// What is exported is read again with the same laws.
static void test_our_own_export_is_read_again(void **state) {
    static struct run_program_result result;
    write_inputs(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "gromacs", "-o", "gromacs");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "second.json", scene, "topol.top", "gromacs/topol.top");
    RUN_PROGRAM(&result, "simulate", "second.json", "-o", "second");
    run_program_assert_code(&result, 0);
    static const char *const keys[] = {"bonds.C1-C2.k",
                                       "bonds.C2-C1.length",
                                       "bonds.C1-C1.k",
                                       "angles.C1-C2-C1.k",
                                       "dihedrals.C1-C2-C1-C1.k",
                                       "dihedrals.C1-C1-C2-C1.c3",
                                       "molecules.hexane.exclude",
                                       "molecules.W.count",
                                       NULL};
    for (int k = 0; keys[k]; k++)
        assert_close_relative(results_number("second/used.json", keys[k]),
                              results_number("out/used.json", keys[k]), 1e-8);
}

static void test_topologies_that_cannot_be_are_refused(void **state) {
    static const struct {
        const char *from, *to, *place, *what;
    } cases[] = {
        {"3 4 7 0.8 500", "3 5 7 0.8 500", "topol.top:20:", "no atom 5: hexane has 1 to 4"},
        {"3 4 7 0.8 500", "2 1 1 0.8 500", "topol.top:20:", "duplicate bond 2-1"},
        {"3 4 7 0.8 500", "3 4 5 0.8 500", "topol.top:20:", "function 5 of a bond"},
        {"3 4 7 0.8 500", "3 4 7 0.8", "topol.top:20:", "1 numbers after"},
        {"3 4 7 0.8 500", "3 4 7", "topol.top:20:", "no parameters"},
        {"3 4 7 0.8 500", "3 4 7 0.8 -5", "topol.top:20:", "k of the law \"fene\" cannot be"},
        {"3 4 7 0.8 500", "3 4 7 0.8 5x", "topol.top:20:", "expected a number, found \"5x\""},
        {"hexane 2 ;", "hexane 5 ;", "topol.top:9:", "nrexcl is 0 to 3, not 5"},
        {"\"types.itp\"", "\"topol.top\"", "topol.top:", "include: more than"},
        {"\"types.itp\"", "\"other.itp\"", "topol.top:4:", "there is no file other.itp"},
        {"#endif", "", "topol.top:", "#ifdef has no #endif"},
        {"[ system ]", "[ settles ]", "topol.top:", "[ settles ] is not known"},
        {"hexane 20", "octane 20", "topol.top:", "no moleculetype octane"},
        {"hexane 20", "hexane 99999999999", "topol.top:", "to 1e8"},
        {"hexane 20", "hexane 100000000", "molecules", "the most are 1e+08"},
        {"4 C1 1 HEX A 4", "5 C1 1 HEX A 4", "topol.top:16:", "expected atom number 4"},
        {"2 C2 1 HEX B 2", "2 C* 1 HEX B 2", "topol.top:14:", "expected a type name"},
        {"hexane 20\nW 5\nhexane 10", "hexane 0", "topol.top", "[ molecules ] is empty"},
        {"; a comment", "[ bondtypes ]\nC1 C2 1 0.4 900", "topol.top:", "2 lines have parameters"},
        {"; a comment", "word", "topol.top:1:", "expected a section"},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_inputs(*state, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_refused(&result, ".", cases[k].to, 1,
                                   (const char *const[]){cases[k].place, cases[k].what, NULL});
    }
}

static void test_laws_beside_a_topology_are_refused(void **state) {
    static struct run_program_result result;
    static const char *const laws[] = {
        "\"bonds\": {\"C1-C2\": {\"law\": \"harmonic\", \"k\": 9, \"length\": 0.8}}, \"molecules\"",
        "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 9, \"angle\": 120}}, \"molecules\""};
    static const char *const keys[] = {
        "scene.json: bonds.C1-C2: the topology of \"molecules\" has its law",
        "scene.json: angles.bend: no molecule has such an angle"};
    write_inputs(*state, NULL, NULL);
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "scene.json", scene, "\"molecules\"", laws[k]);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_refused(&result, ".", laws[k], 1, (const char *const[]){keys[k], NULL});
    }
}

/// A table's law is told by the scene, under the name of its types.
static void test_a_table_of_a_topology_has_a_law_of_the_scene(void **state) {
    static struct run_program_result result;
    static const char law[] =
        "\"bonds\": {\"C1-C1\": {\"law\": \"harmonic\", \"k\": 9, \"length\": 0.8}}, \"molecules\"";
    write_inputs(*state, "3 4 7 0.8 500", "3 4 8 1 1.0");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_refused(
        &result, ".", "a table", 1,
        (const char *const[]){"the bond \"C1-C1\" is a table in the topology, which is not read: "
                              "give it by that name in \"scene.bonds\"",
                              NULL});
    small_inputs_write(*state, "scene.json", scene, "\"molecules\"", law);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    results_assert_text("out/used.json", "bonds.C1-C1.law", "harmonic");
    assert_close(results_number("out/used.json", "bonds.C1-C1.k"), 9, 1e-12);
}

/// Nothing is allocated for 10^11 pairs: it is told in less time than that would take.
static void test_what_has_no_room_in_memory_is_refused(void **state) {
    static struct run_program_result result;
    write_inputs(*state, "hexane 20", "hexane 900000");
    small_inputs_write(*state, "scene.json", scene,
                       "\"units\": {\"length\": 0.5,\n  \"temperature\": 300, \"mass\": 5e-26}, ",
                       "");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_int_equal(result.code, 2);
    assert_contains(result.err, "3600045 particles with ");
    assert_contains(result.err, "is the box too small?");
}

static const char counts[] = "hexane 20\nW 5\nhexane 10";
static const char placed[] = "\"topol.top\"}, \"particles\": {\"placement\": \"file\", \"file\": "
                             "\"conf.gro\"},";

/// All places and velocities are the same but for their last decimals.
static void compare_coordinates(const char *first, const char *second) {
    FILE *one = fopen(first, "r"), *other = fopen(second, "r");
    char a[256], b[256];
    int rows = 0;
    assert_true(one && other);
    while (fgets(a, sizeof a, one) && fgets(b, sizeof b, other)) {
        double x[6], y[6];
        if (strlen(a) < 90)
            continue;
        for (int k = 0; k < 6; k++) {
            assert_int_equal(sscanf(a + 20 + 12 * k, "%12lf", &x[k]), 1);
            assert_int_equal(sscanf(b + 20 + 12 * k, "%12lf", &y[k]), 1);
            assert_close(x[k], y[k], 3e-7);
        }
        assert_memory_equal(a, b, 20);
        rows++;
    }
    fclose(one);
    fclose(other);
    assert_int_equal(rows, 125);
}

/// A start is exported, read with its topology, and exported again.
static void test_coordinates_come_with_a_topology(void **state) {
    static struct run_program_result result;
    write_inputs(*state, counts, "hexane 30\nW 5");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "out", "--engine", "gromacs", "-o", "gromacs");
    run_program_assert_code(&result, 0);
    assert_int_equal(rename("gromacs/conf.gro", "conf.gro"), 0);
    small_inputs_write(*state, "scene.json", scene, "\"topol.top\"},", placed);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "placed");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "placed", "--engine", "gromacs", "-o", "second");
    run_program_assert_code(&result, 0);
    compare_coordinates("conf.gro", "second/conf.gro");
    // A soft bond at four times its rest, for 2.4 k_B T, is no other bead's.
    small_inputs_write(*state, "types.itp", types, "0.38 1500", "0.1 150");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "soft");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "types.itp", types, NULL, NULL);
    static const struct {
        const char *file, *text, *from, *to, *what;
    } cases[] = {
        {"topol.top", topology, NULL, NULL, "each moleculetype only once"},
        {"topol.top", topology, counts, "hexane 29\nW 5", "125 atoms; the scene has 121"},
        {"topol.top", topology, counts, "hexane 30\nW 5", NULL},
        {"types.itp", types, "0.38 1500", "0.1 2500",
         "the bond of atoms 1 and 2, of hexane number 1"},
        {"types.itp", types, NULL, NULL, NULL},
        {"conf.gro", "beads\n1\n    1HEX     C1    1   1.000   1.000\n", NULL, NULL, "conf.gro:3"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, cases[k].file, cases[k].text, cases[k].from, cases[k].to);
        if (cases[k].what == NULL)
            continue;
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
        assert_int_equal(result.code, 2);
        assert_int_equal(run_program_lines(result.err), 1);
        assert_contains(result.err, cases[k].what);
        assert_contains(result.err, "particles.file: conf.gro");
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_topology_says_what_molecules_are),
        TEST(test_a_topology_may_have_the_lines_of_old_macs),
        TEST(test_a_coefficient_beyond_numbers_is_unstable),
        TEST(test_what_is_not_taken_is_told),
        TEST(test_an_angle_without_its_bonds_is_warned_of),
        TEST(test_our_own_export_is_read_again),
        TEST(test_laws_beside_a_topology_are_refused),
        TEST(test_a_table_of_a_topology_has_a_law_of_the_scene),
        TEST(test_coordinates_come_with_a_topology),
        TEST(test_what_has_no_room_in_memory_is_refused),
        TEST(test_topologies_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
