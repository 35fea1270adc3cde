// SPDX-License-Identifier: GPL-3.0-or-later
//
// Maps of VOTCA: centres by weights that are not masses, molecules of several residues, bonds as
// JSON, and every fault with its line.
#include "base/memory.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/mapping.h"
#include "trajectory/votca_map.h"

#include <math.h>
#include <stdio.h>

/// Two molecules of two residues, and an ion between them, of which no map tells.
enum { ATOMS = 9 };
static const struct {
    const char *name, *residue;
    int number;
} atoms[ATOMS] = {{"C", "ONE", 1}, {"H", "ONE", 1}, {"C", "TWO", 2},
                  {"O", "TWO", 2}, {"NA", "NA", 3}, {"C", "ONE", 4},
                  {"H", "ONE", 4}, {"C", "TWO", 5}, {"O", "TWO", 5}};

static const char map[] =
    "<cg_molecule>\n"
    "  <name>mol</name> <ident>Protein</ident>\n"
    "  <topology>\n"
    "    <cg_beads>\n"
    "      <cg_bead><name>b1</name><type>B</type><mapping>two</mapping>\n"
    "        <beads>\n 1:ONE:H\t2:TWO:O </beads></cg_bead>\n"
    "      <cg_bead><name>a1</name><type>A</type><symmetry>1</symmetry><mapping>one</mapping>\n"
    "        <beads>1:ONE:C</beads></cg_bead>\n"
    "    </cg_beads>\n"
    "    <cg_bonded>\n"
    "      <bond><name>stick</name><beads> b1\n a1 </beads></bond>\n"
    "    </cg_bonded>\n"
    "  </topology>\n"
    "  <maps>\n"
    "    <map><name>one</name><weights>7</weights></map>\n"
    "    <map><name>two</name><weights>1 3</weights></map>\n"
    "  </maps>\n"
    "</cg_molecule>\n";

static struct structure structure;
static struct mapping mapping;
static struct mapping_plan plan;
static char *json;

static void make_structure(void) {
    assert_ok(mf_structure_init(&structure, ATOMS));
    structure.has_names = structure.has_residues = true;
    for (int k = 0; k < ATOMS; k++) {
        snprintf(structure.atom[k].name, STRUCTURE_NAME, "%s", atoms[k].name);
        snprintf(structure.atom[k].residue_name, STRUCTURE_NAME, "%s", atoms[k].residue);
        structure.atom[k].residue_number = atoms[k].number;
    }
    assert_ok(mf_structure_number_residues(&structure));
}

/// Write the map with one text in place of another.
static const char *write_map(void **state, const char *from, const char *to) {
    static char text[4096];
    const char *const at = strstr(map, from);
    assert_non_null(at);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - map), map, to, at + strlen(from));
    return temporary_folder_write(*state, "map.xml", text, strlen(text));
}

static enum status try_map(void **state, const char *from, const char *to) {
    TRY(mf_mapping_plan_read(&plan, write_map(state, from, to)));
    const enum status status = mf_mapping_init(&mapping, &plan, &structure);
    mf_mapping_plan_clear(&plan);
    return status;
}

static void test_beads_are_at_the_centres_of_their_weights(void **state) {
    struct trajectory_frame frame = {.has_box = false}, beads = {0};
    make_structure();
    assert_ok(try_map(state, "", ""));
    assert_int_equal(mapping.beads, 4);
    assert_string_equal(mapping.type_name[0], "B");
    assert_true(fabs(mapping.bead[0].mass - (1.008 + 15.999)) < 1e-12);
    assert_true(mapping.bead[0].molecule == mapping.bead[2].molecule);
    assert_true(mapping.bead[0].molecule != mapping.bead[1].molecule);
    assert_true(mapping.broken);
    assert_ok(mf_frame_reserve(&frame, ATOMS, false));
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++)
            frame.position[k][d] = k * k + d;
    assert_ok(mf_mapping_apply(&mapping, &frame, &beads));
    assert_true(fabs(beads.position[0][0] - (1 + 3 * 9) / 4.0) < 1e-14);
    assert_true(fabs(beads.position[1][1] - ((36 + 3 * 64) / 4.0 + 1)) < 1e-13);
    assert_true(beads.position[3][2] == 25 + 2);
    mf_frame_clear(&frame);
    mf_frame_clear(&beads);
    mf_mapping_clear(&mapping);
    mf_structure_clear(&structure);
}

/// One bead a molecule with the weights of water, which are nearly masses: its velocity tells the
/// temperature.
static void test_weights_that_are_masses_do_not_break_a_molecule(void **state) {
    static const char water[] = "<cg_molecule><name>W</name><topology><cg_beads><cg_bead>"
                                "<name>W</name><type>W</type><mapping>m</mapping><beads>%s</beads>"
                                "</cg_bead></cg_beads></topology><maps><map><name>m</name>"
                                "<weights>%s</weights></map></maps></cg_molecule>";
    static const char *const weights[] = {"16 12", "1 1"};
    char text[1024];
    make_structure();
    for (int k = 0; k < 2; k++) {
        snprintf(text, sizeof text, water, "1:TWO:O 1:TWO:C", weights[k]);
        assert_ok(mf_mapping_plan_read(
            &plan, temporary_folder_write(*state, "map.xml", text, strlen(text))));
        assert_ok(mf_mapping_init(&mapping, &plan, &structure));
        assert_int_equal(mapping.broken, k);
        mf_mapping_plan_clear(&plan);
        mf_mapping_clear(&mapping);
    }
    mf_structure_clear(&structure);
}

static void test_bonds_are_those_of_all_maps(void **state) {
    static const char ion[] =
        "<cg_molecule><name>ion</name><topology><cg_beads><cg_bead><name>I</name><type>Na</type>"
        "<mapping>m</mapping><beads>1:NA:NA</beads></cg_bead></cg_beads></topology>"
        "<maps><map><name>m</name><weights>1</weights></map></maps></cg_molecule>";
    char files[2048];
    snprintf(files, sizeof files, "%s;", write_map(state, "", ""));
    strcat(files, temporary_folder_write(*state, "ion.xml", ion, strlen(ion)));
    assert_ok(mf_votca_map_bonds(&json, files));
    assert_contains(json, "\"beads\":\t[\"B\", \"A\"]");
    assert_contains(json, "\"stick\":\t[[1, 2]]");
    assert_contains(json, "\"Na\":\t0");
    mf_memory_free(json);
    make_structure();
    assert_ok(mf_mapping_plan_read(&plan, files));
    assert_ok(mf_mapping_init(&mapping, &plan, &structure));
    assert_int_equal(mapping.beads, 5);
    mf_mapping_plan_clear(&plan);
    mf_mapping_clear(&mapping);
    mf_structure_clear(&structure);
    assert_ok(mf_votca_map_bonds(&json, temporary_folder_write(*state, "i.xml", ion, strlen(ion))));
    assert_null(json);
    char twice[4096];
    const char *const path = write_map(state, "", "");
    snprintf(twice, sizeof twice, "%.1000s;%.1000s", path, path);
    assert_fails(mf_mapping_plan_read(&plan, twice), STATUS_BAD_INPUT,
                 "map.xml:2: <name>: another map has the molecule \"mol\"");
}

static void test_faults_are_named_with_their_lines(void **state) {
    static const struct {
        const char *from, *to, *part;
    } cases[] = {
        {"<name>mol</name>", "", "map.xml:1: <cg_molecule>: <name> is missing or empty"},
        {"mol</name>", "a long name of it</name>",
         "map.xml:2: <name>: \"a long name of it\" is no"},
        {"<type>B</type>", "", "map.xml:5: <cg_bead>: <type> is missing"},
        {"<symmetry>1", "<symmetry>2", "map.xml:8: <symmetry>: \"2\" is neither 1"},
        {"a1</name>", "b1</name>", "map.xml:8: <cg_bead>: there are two beads \"b1\""},
        {"1:ONE:C<", "<", "map.xml:8: <cg_bead>: <beads> is missing or names no atom"},
        {"1:ONE:C<", "C<", "map.xml:9: <beads>: \"C\" is no atom as 1:SOL:OW"},
        {"1:ONE:C<", "0:ONE:C<", "map.xml:9: <beads>: residue \"0\" of \"C\""},
        {"1:ONE:C<", "x:ONE:C<", "map.xml:9: <beads>: residue \"x\" of \"C\""},
        {"1:ONE:C<", "1:TWO:C<", "residue 1 is called \"ONE\" and \"TWO\""},
        {"<mapping>one", "<mapping>uno", "map.xml:8: <mapping>: <maps> has no <map> \"uno\""},
        {"<weights>7</weights>", "", "map.xml:17: <map>: <weights> is missing"},
        {">7<", ">x<", "map.xml:17: <weights>: \"x\" is no weight"},
        {">7<", ">-1<", "map.xml:17: <weights>: \"-1\" is no weight"},
        {">7<", ">0<", "map.xml:17: <weights>: the sum of the weights is 0"},
        {">7<", ">7 1<", "map.xml:17: <weights>: 2 weights, but bead \"a1\" has 1 atoms"},
        {"cg_beads>", "beads>", "no XML"},
        {"1:ONE:C<", "1:ONE:N<", "residue 1 \"ONE\" (atom 1) has 0 atoms \"N\""},
        {"1:ONE:C<", "3:TRE:C<", "molecule \"mol\": there is no residue \"ONE\" that its other"},
        {"1:ONE:C<", "1:ONE:H<", "atom 2, \"H\" of residue 1 \"ONE\", belongs to two beads"},
    };
    make_structure();
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_fails(try_map(state, cases[k].from, cases[k].to), STATUS_BAD_INPUT, cases[k].part);
    static const struct {
        const char *from, *to, *part;
    } bonds[] = {
        {"<name>stick</name>", "", "map.xml:12: <bond>: <name> is missing"},
        {" b1\n a1 ", "b1 c1", "map.xml:12: <bond>: <cg_beads> has no bead \"c1\""},
        {" b1\n a1 ", "b1", "map.xml:12: <bond>: <beads> names 1 beads"},
        {" b1\n a1 ", "", "map.xml:12: <bond>: <beads> names 0 beads"},
        {"</bond>", "</bond>\n<bond><name>stick</name><beads>b1 a1</beads></bond>",
         "map.xml:14: <bond>: that of line 12 has the name \"stick\" too: give it another"},
    };
    for (size_t k = 0; k < sizeof bonds / sizeof *bonds; k++)
        assert_fails(mf_votca_map_bonds(&json, write_map(state, bonds[k].from, bonds[k].to)),
                     STATUS_BAD_INPUT, bonds[k].part);
    assert_fails(mf_mapping_plan_read(&plan, temporary_folder_write(*state, "s.xml", "<cg/>", 5)),
                 STATUS_BAD_INPUT, "s.xml:1: <cg>: no map of VOTCA");
    assert_int_equal(mf_mapping_plan_read(&plan, "nowhere.xml"), STATUS_IO);
    mf_structure_clear(&structure);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_beads_are_at_the_centres_of_their_weights),
        TEST(test_weights_that_are_masses_do_not_break_a_molecule),
        TEST(test_bonds_are_those_of_all_maps),
        TEST(test_faults_are_named_with_their_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
