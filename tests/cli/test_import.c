// SPDX-License-Identifier: GPL-3.0-or-later
//
// VOTCA's files: a map in XML measures what our own map does; settings become a run file that a fit
// takes, and what is missing or wrong in them is named.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static struct run_program_result result;

// Maps --------------------------------------------------------------------------------------------

enum { MOLECULES = 60, ATOMS = 4 };

/// Molecules of two residues, C-H and O-H, anywhere in a box.
static void write_configuration(void) {
    static const char *const name[ATOMS] = {"C", "H", "O", "H"};
    FILE *const stream = fopen("conf.gro", "w");
    assert_non_null(stream);
    srand(5);
    fprintf(stream, "atoms\n%d\n", MOLECULES * ATOMS);
    for (int m = 0; m < MOLECULES; m++) {
        double at[3];
        for (int d = 0; d < 3; d++)
            at[d] = 3.0 * rand() / RAND_MAX;
        for (int k = 0; k < ATOMS; k++) {
            at[k % 3] += 0.1 + 0.02 * rand() / RAND_MAX;
            fprintf(stream, "%5d%-5s%5s%5d%8.3f%8.3f%8.3f\n", 2 * m + k / 2 + 1,
                    k < 2 ? "ONE" : "TWO", name[k], m * ATOMS + k + 1, at[0], at[1], at[2]);
        }
    }
    fprintf(stream, "3.0 3.0 3.0\n");
    assert_int_equal(fclose(stream), 0);
}

static const char one_residue[] =
    "<cg_molecule><name>%s</name><topology><cg_beads><cg_bead><name>b</name><type>%s</type>"
    "<mapping>m</mapping><beads>%s</beads></cg_bead></cg_beads></topology>"
    "<maps><map><name>m</name><weights>%s</weights></map></maps></cg_molecule>";

static void measure(const char *map, const char *molecules, const char *folder) {
    RUN_PROGRAM(&result, "measure", "conf.gro", "--static", "--map", map, "--temperature", "300",
                "--q-range", "0", "-o", folder, molecules ? "--molecules" : NULL, molecules);
    run_program_assert_code(&result, 0);
}

static void assert_same(const char *first, const char *second) {
    char *const a = temporary_folder_read(first), *const b = temporary_folder_read(second);
    assert_string_equal(a, b);
    free(a);
    free(b);
}

static void write_text(void **state, const char *name, const char *text) {
    temporary_folder_write(*state, name, text, strlen(text));
}

static void test_a_map_in_xml_measures_what_ours_does(void **state) {
    char text[1024];
    write_configuration();
    snprintf(text, sizeof text, one_residue, "one", "A", "1:ONE:C 1:ONE:H", "12.011 1.008");
    write_text(state, "one.xml", text);
    snprintf(text, sizeof text, one_residue, "two", "B", "1:TWO:O 1:TWO:H", "15.999 1.008");
    write_text(state, "two.xml", text);
    write_text(state, "map.json",
               "{\"beads\": {\"A\": {\"residue\": \"ONE\"}, \"B\": {\"residue\": \"TWO\"}}}");
    measure("map.json", NULL, "ours");
    measure("one.xml;two.xml", NULL, "theirs");
    assert_same("ours/rdf_A-A.tsv", "theirs/rdf_A-A.tsv");
    assert_same("ours/rdf_A-B.tsv", "theirs/rdf_A-B.tsv");
    assert_same("ours/target.json", "theirs/target.json");
    RUN_PROGRAM(&result, "measure", "conf.gro", "--static", "--map", "one.xml;three.xml", "-o",
                "x");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "three.xml: No such file");
    RUN_PROGRAM(&result, "measure", "conf.gro", "--static", "--map", "one.xml;two.xml", "--beads",
                "two.xml", "--force", "-o", "x");
    run_program_assert_code(&result, 2); // and the map is still there
    measure("one.xml;two.xml", NULL, "theirs");
}

/// Both residues are one molecule, whose bond the map names.
static void test_bonds_of_a_map_are_measured(void **state) {
    write_configuration();
    write_text(state, "map.xml",
               "<cg_molecule><name>mol</name><ident>any</ident><topology><cg_beads>\n"
               "<cg_bead><name>a</name><type>A</type><mapping>m</mapping>"
               "<beads>1:ONE:C 1:ONE:H</beads></cg_bead>\n"
               "<cg_bead><name>b</name><type>B</type><mapping>n</mapping>"
               "<beads>2:TWO:O 2:TWO:H</beads></cg_bead></cg_beads>\n"
               "<cg_bonded><bond><name>stick</name><beads>a b</beads></bond></cg_bonded>\n"
               "</topology><maps><map><name>m</name><weights>12.011 1.008</weights></map>\n"
               "<map><name>n</name><weights>15.999 1.008</weights></map></maps></cg_molecule>\n");
    write_text(state, "map.json",
               "{\"beads\": {\"A\": {\"residue\": \"ONE\"}, \"B\": {\"residue\": \"TWO\"}}}");
    write_text(state, "molecules.json",
               "{\"molecules\": {\"mol\": {\"beads\": [\"A\", \"B\"], \"bonds\": {\"stick\": "
               "[[1, 2]]}}}}");
    measure("map.json", "molecules.json", "ours");
    measure("map.xml", NULL, "theirs");
    assert_same("ours/bond_lengths.tsv", "theirs/bond_lengths.tsv");
    assert_same("ours/rdf_A-B.tsv", "theirs/rdf_A-B.tsv");
    assert_same("ours/target.json", "theirs/target.json");
    measure("map.json", "map.xml", "again");
    assert_same("ours/bond_lengths.tsv", "again/bond_lengths.tsv");
}

// Settings ----------------------------------------------------------------------------------------

static const char settings[] =
    "<cg>\n"
    " <bonded>\n"
    "  <name>stick</name> <min>0.2</min> <max>0.4</max> <step>0.01</step>\n"
    "  <inverse><target>stick.dist.tgt</target>\n"
    "   <gromacs><table>table_b1.xvg</table></gromacs></inverse>\n"
    " </bonded>\n"
    " <non-bonded>\n"
    "  <name>A-A</name> <type1>A</type1> <type2>A</type2> <max>0.9</max>\n"
    "  <inverse><target>A-A.dist.tgt</target><p_target>1.5</p_target>\n"
    "   <post_update>pressure</post_update></inverse>\n"
    " </non-bonded>\n"
    " <inverse>\n"
    "  <kBT>2.49435</kBT> <method>ibi</method> <own>3</own>\n"
    "  <gromacs><equi_time>20</equi_time></gromacs>\n"
    " </inverse>\n"
    "</cg>\n";

/// One line each.
#define BONDED(name, table)                                                                        \
    "<bonded><name>" name "</name><inverse><target>stick.dist.tgt</target><gromacs><table>"        \
    "table_b" table ".xvg</table></gromacs></inverse></bonded>\n"
#define NON_BONDED(name, first, second, target)                                                    \
    "<non-bonded><name>" name "</name><type1>" first "</type1><type2>" second "</type2>"           \
    "<max>0.8</max><inverse><target>" target "</target></inverse></non-bonded>\n"

static const char topology[] =
    "[ defaults ]\n1 1 no 1.0 1.0\n[ atomtypes ]\nA 14.5 0.0 A 0 1\n[ moleculetype ]\ndimer 1\n"
    "[ atoms ]\n1 A 1 DIM A1 1 0.0 14.5\n2 A 1 DIM A2 1 0.0 14.5\n[ bonds ]\n1 2 8 1 1.0\n"
    "[ system ]\nx\n[ molecules ]\ndimer 500\n";

/// A step with a peak, as a fluid may have it; lengths about 0.3 nm.
static void write_tables(void) {
    FILE *stream = fopen("votca/A-A.dist.tgt", "w");
    for (int k = 0; k <= 100; k++)
        fprintf(stream, "%g %g i\n", 0.01 * k,
                k < 35 ? 0.0 : 1 + (k < 45 ? 0.5 : 0) - 0.01 * (k % 2));
    assert_int_equal(fclose(stream), 0);
    stream = fopen("votca/stick.dist.tgt", "w");
    for (int k = 25; k <= 35; k++)
        fprintf(stream, "%g %g i\n", 0.01 * k, k == 30 ? 40.0 : k > 27 && k < 33 ? 15.0 : 0.0);
    assert_int_equal(fclose(stream), 0);
}

/// The folder of somebody who used VOTCA, with one text of the settings in place of another.
static void write_settings(void **state, const char *from, const char *to) {
    (void)mkdir("votca", 0700);
    write_tables();
    write_text(state, "votca/topol.top", topology);
    write_text(state, "votca/conf.gro",
               "beads\n1\n    1DIM     A1    1   0.1   0.2   0.3\n4 4 5\n");
    small_inputs_write(*state, "votca/settings.xml", settings, from, to);
}

static void test_settings_become_a_run_file(void **state) {
    write_settings(state, NULL, NULL);
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "read: A-A: g(r) of A-A.dist.tgt, to 0.9 nm\n");
    assert_contains(result.out, "read: stick: bond with the distribution of stick.dist.tgt\n");
    assert_contains(result.out, "read: temperature 300 K\n");
    assert_contains(result.out, "read: pressure 1.5 bar\n");
    assert_contains(result.out, "read: box 4 4 5 nm of votca/conf.gro\n");
    assert_contains(result.out, "read: 1000 beads A of votca/topol.top\n");
    assert_null(strstr(result.out, "differ"));
    assert_contains(result.out, "left out: bonded.min, bonded.max, bonded.step: ranges");
    assert_contains(result.out, "left out: inverse.method: the method is chosen");
    assert_contains(result.out, "left out: inverse.own, inverse.gromacs: no other program");
    char *const run = temporary_folder_read("run/run.json");
    assert_contains(run, "\"cutoff\":\t0.9");
    assert_contains(run, "\"mass\":\t14.5");
    assert_contains(run, "\"stick\":\t[[1, 2]]");
    free(run);
    RUN_PROGRAM(&result, "fit", "run/run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "target bond_lengths.stick: ");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run", "--quiet");
    run_program_assert_code(&result, 0); // its own files are replaced
    assert_string_equal(result.out, "");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "votca");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "votca: the folder holds files that are not of an import");
}

static void test_a_pressure_of_all_is_no_target(void **state) {
    write_settings(state, "<own>3</own>", "<p_target>1</p_target>");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "left out: inverse.p_target: it is a target only inside "
                                "<non-bonded><inverse>, with <post_update>pressure\n");
}

/// Molecules of 14 and 15.5 u, and of 18 u: the mean over all beads is the whole mass by their
/// number, (200·14 + 200·15.5 + 100·18)/500.
static void test_masses_of_a_type_are_averaged(void **state) {
    write_settings(state, NULL, NULL);
    write_text(state, "votca/topol.top",
               "[ defaults ]\n1 1 no 1.0 1.0\n[ atomtypes ]\nA 14.5 0.0 A 0 1\n"
               "[ moleculetype ]\ndimer 1\n[ atoms ]\n1 A 1 DIM A1 1 0.0 14.0\n"
               "2 A 1 DIM A2 1 0.0 15.5\n[ bonds ]\n1 2 8 1 1.0\n"
               "[ moleculetype ]\nsingle 1\n[ atoms ]\n1 A 1 ONE A1 1 0.0 18\n"
               "[ system ]\nx\n[ molecules ]\ndimer 200\nsingle 100\n");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "masses of type A differ (14 to 18): their mean is taken\n");
    char *const run = temporary_folder_read("run/run.json");
    assert_contains(run, "\"mass\":\t15.4\n");
    free(run);
}

/// A table of the topology that no <bonded> has is a known potential.
static void test_a_table_without_a_target_is_known(void **state) {
    write_settings(state, "<target>stick.dist.tgt</target>", "");
    write_text(state, "votca/table_b1.xvg",
               "0.2 100 0\n0.25 25 0\n0.3 0 0\n0.35 25 0\n0.4 100 0\n");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "read: stick: bond with the known potential table_b1.xvg\n");
    RUN_PROGRAM(&result, "fit", "run/run.json", "--explain");
    run_program_assert_code(&result, 0);
}

/// Targets of the same name in different folders, one of them called as the run file is.
static void test_copies_are_named_by_interactions(void **state) {
    static const char *const file[] = {"a/t.tgt", "b/t.tgt", "run.json"};
    static const char *const copy[] = {"run/A-A.dist.tgt", "run/A-B.dist.tgt", "run/B-B.dist.tgt"};
    char text[64], path[64];
    write_settings(state, NULL, NULL);
    assert_int_equal(mkdir("votca/a", 0700) | mkdir("votca/b", 0700), 0);
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, "0.1 0 i\n0.3 1.%d i\n0.9 1 i\n", k);
        snprintf(path, sizeof path, "votca/%s", file[k]);
        write_text(state, path, text);
    }
    write_text(
        state, "votca/settings.xml",
        "<cg>" NON_BONDED("A-A", "A", "A", "a/t.tgt") NON_BONDED("A-B", "A", "B", "b/t.tgt")
            NON_BONDED("B-B", "B", "B", "run.json") "<inverse><kBT>2.5</kBT></inverse></cg>");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run", "--count",
                "A=20,B=30");
    run_program_assert_code(&result, 0);
    char *const run = temporary_folder_read("run/run.json");
    for (int k = 0; k < 3; k++) {
        snprintf(path, sizeof path, "votca/%s", file[k]);
        assert_same(path, copy[k]);
        assert_contains(run, copy[k] + strlen("run/"));
    }
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "votca", "--count",
                "A=20,B=30", "--force");
    run_program_assert_code(&result, 2); // nothing that is read is replaced, nothing written
    assert_contains(result.err, "votca/run.json");
    assert_same("votca/run.json", copy[2]);
    assert_false(temporary_folder_exists("votca/B-B.dist.tgt"));
    free(run);
}

/// Without files of GROMACS box and number come from the command line.
static void test_box_and_counts_can_be_told(void **state) {
    write_settings(state, NULL, NULL);
    char text[2048];
    snprintf(text, sizeof text, "<cg>\n%s", strstr(settings, " <non-bonded>"));
    write_text(state, "votca/settings.xml", text);
    assert_int_equal(remove("votca/conf.gro") | remove("votca/topol.top"), 0);
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "votca/settings.xml: nothing beside it (conf.gro) has a box: give "
                                "it by --box LX,LY,LZ [nm]");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run", "--box", "4");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "has beads of type \"A\": give their number by --count A=N");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run", "--box", "4",
                "--count", "A=x");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--count takes numbers of beads as A=100,B=50, not \"A=x\"");
    assert_false(temporary_folder_exists("run"));
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run", "--box", "4",
                "--count", "A=900");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run/run.json", "--explain");
    run_program_assert_code(&result, 0);
}

static void test_beads_without_targets_are_named(void **state) {
    write_settings(state, NULL, NULL);
    write_text(state, "votca/topol.top",
               "[ defaults ]\n1 1 no 1.0 1.0\n[ atomtypes ]\nA 14.5 0.0 A 0 1\nW 18 0.0 A 0 1\n"
               "[ moleculetype ]\ndimer 1\n[ atoms ]\n1 A 1 DIM A1 1 0.0 14.5\n"
               "2 A 1 DIM A2 1 0.0 14.5\n[ bonds ]\n1 2 8 1 1.0\n"
               "[ moleculetype ]\nwater 1\n[ atoms ]\n1 W 1 SOL W 1 0.0 18\n"
               "[ system ]\nx\n[ molecules ]\ndimer 200\nwater 100\n");
    RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "votca/settings.xml:1: <cg>: no <non-bonded> has a target for "
                                "beads W of votca/topol.top: add the pair W-W");
    assert_int_equal(run_program_lines(result.err), 1);
    assert_false(temporary_folder_exists("run"));
}

static void test_faults_are_named_with_their_lines(void **state) {
    static const struct {
        const char *from, *to, *part;
    } cases[] = {
        {"</cg>", "</c>", "votca/settings.xml:16:3: no XML: mismatched tag"},
        {"<kBT>2.49435</kBT>", "", "settings.xml:1: <cg>: <inverse><kBT> is missing"},
        {"2.49435", "-2", "settings.xml:13: <kBT>: \"-2\" is no number above 0"},
        {"<max>0.9</max>", "", "settings.xml:7: <non-bonded>: <max> is missing"},
        {"<max>0.9", "<max>x", "settings.xml:8: <max>: \"x\" is no number above 0"},
        {"<type2>A</type2>", "", "settings.xml:7: <non-bonded>: <type2> is missing"},
        {"<type1>A", "<type1>A B", "settings.xml:8: <type1>: \"A B\": expected a name of up to"},
        {"<p_target>1.5", "<p_target>?", "settings.xml:9: <p_target>: \"?\" is no number"},
        {">A-A.dist.tgt", ">B.tgt", "settings.xml:9: <target>: votca/B.tgt: No such file"},
        {"<target>A-A.dist.tgt</target>", "", "<cg>: no <non-bonded> has a target"},
        {"table_b1.xvg", "b.xvg", "settings.xml:2: <bonded>: nothing says whether \"stick\" is"},
        {"table_b1.xvg", "table_b2.xvg", "votca/topol.top: table_b1.xvg is not beside it, nor has"},
        {" <inverse>\n  <kBT>", BONDED("x", "1") " <inverse>\n  <kBT>",
         "settings.xml:12: <bonded>: that of line 2 has table_b1.xvg too: leave one"},
        {" <inverse>\n  <kBT>", BONDED("stick", "2") " <inverse>\n  <kBT>",
         "settings.xml:12: <bonded>: that of line 2 has the name stick too: each needs"},
        {" <inverse>\n  <kBT>", NON_BONDED("other", "A", "A", "A-A.dist.tgt") " <inverse>\n  <kBT>",
         "settings.xml:12: <non-bonded>: A-A has the target of line 9 already: leave one of them"},
        {" <inverse>\n  <kBT>", NON_BONDED("other", "B", "A", "A-A.dist.tgt") " <inverse>\n  <kBT>",
         "settings.xml:12: <non-bonded>: it has the type B, but no <non-bonded> has a target for "
         "the pair B-B: add it"},
        {"<target>stick.dist.tgt", "<target>A-A.dist.tgt",
         "settings.xml:4: <target>: votca/A-A.dist.tgt: the integral of p is 0.7"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_settings(state, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "import", "votca", "votca/settings.xml", "-o", "run");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, cases[k].part);
        assert_int_equal(run_program_lines(result.err), 1);
        assert_false(temporary_folder_exists("run"));
    }
    write_text(state, "map.xml", "<cg_molecule/>");
    RUN_PROGRAM(&result, "import", "votca", "map.xml");
    assert_contains(result.err, "map.xml:1: <cg_molecule>: no settings of VOTCA, which begin with "
                                "<cg>: this is a map, which measure --map takes");
    RUN_PROGRAM(&result, "import", "magic", "map.xml");
    assert_contains(result.err, "import: \"magic\" is no program whose settings are read");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_map_in_xml_measures_what_ours_does),
        TEST(test_bonds_of_a_map_are_measured),
        TEST(test_settings_become_a_run_file),
        TEST(test_a_pressure_of_all_is_no_target),
        TEST(test_masses_of_a_type_are_averaged),
        TEST(test_a_table_without_a_target_is_known),
        TEST(test_copies_are_named_by_interactions),
        TEST(test_box_and_counts_can_be_told),
        TEST(test_beads_without_targets_are_named),
        TEST(test_faults_are_named_with_their_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
