// SPDX-License-Identifier: GPL-3.0-or-later
//
// Atoms to beads: centres of small molecules that are known, broken across tilted boxes, and maps
// that do not fit.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/mapping.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>

enum { ATOMS = 11 };

/// Two methanols, a water, a sodium ion.
static const struct {
    const char *name, *residue;
    int number;
} atoms[ATOMS] = {{"C", "MET", 1},   {"H", "MET", 1}, {"O", "MET", 1},  {"C", "MET", 2},
                  {"H", "MET", 2},   {"O", "MET", 2}, {"OW", "SOL", 3}, {"HW1", "SOL", 3},
                  {"HW2", "SOL", 3}, {"NA", "NA", 4}, {"CL1", "LIG", 5}};

static struct structure structure;
static struct mapping mapping;
static struct mapping_plan plan;

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

static enum status read_plan(void **state, const char *json) {
    const char *file = temporary_folder_write(*state, "map.json", json, strlen(json));
    return mf_mapping_plan_read(&plan, file);
}

static enum status try_map(void **state, const char *json) {
    TRY(read_plan(state, json));
    const enum status status = mf_mapping_init(&mapping, &plan, &structure);
    mf_mapping_plan_clear(&plan);
    return status;
}

static void clear(void) {
    mf_mapping_clear(&mapping);
    mf_structure_clear(&structure);
}

static void test_default_map_is_a_bead_a_residue(void **state) {
    (void)state;
    make_structure();
    assert_ok(mf_mapping_plan_default(&plan));
    assert_ok(mf_mapping_init(&mapping, &plan, &structure));
    mf_mapping_plan_clear(&plan);
    assert_int_equal(mapping.beads, 5);
    assert_int_equal(mapping.types, 4);
    assert_string_equal(mapping.type_name[0], "MET");
    assert_string_equal(mapping.type_name[2], "NA");
    assert_true(fabs(mapping.bead[1].mass - (12.011 + 1.008 + 15.999)) < 1e-12);
    assert_true(fabs(mapping.bead[3].mass - 22.990) < 1e-12);
    assert_true(fabs(mapping.bead[4].mass - 35.45) < 1e-12);
    const char *const notes = (const char *)mapping.notes.data;
    assert_contains(notes, "guessed by its name: \"HW1\" of \"SOL\" is H, 1.008 u\n");
    assert_contains(notes, "guessed by its name: \"NA\" of \"NA\" is Na, 22.99 u\n");
    assert_contains(notes, "MET: 2 beads of 3 atoms, the first of 29.018 u\n");
    clear();
}

/// Neighbouring rows of one name and number are one residue, as where a file numbers none.
static void test_residues_of_one_name_and_other_numbers_of_atoms_are_warned_of(void **state) {
    (void)state;
    make_structure();
    for (int k = 0; k < ATOMS; k++) {
        structure.atom[k].residue_number = 1;
        if (k >= 6) // the water, the sodium ion and the ligand
            snprintf(structure.atom[k].residue_name, STRUCTURE_NAME, "%s", k == 8 ? "MET" : "SOL");
    }
    assert_ok(mf_structure_number_residues(&structure));
    assert_ok(mf_mapping_plan_default(&plan));
    assert_ok(mf_mapping_init(&mapping, &plan, &structure));
    mf_mapping_plan_clear(&plan);
    assert_contains((const char *)mapping.notes.data,
                    "mesofit: warning: MET: 2 beads of 1 to 6 atoms: a bead is a residue (name and "
                    "number) unless --map says more: does the file number them?\n");
    clear();
}

/// Beads stand by types, whatever the order of the atoms; centres are Σ m r/Σ m, or Σ r/n.
static void test_map_has_several_beads_a_residue(void **state) {
    struct trajectory_frame frame = {.has_box = false}, beads = {0};
    make_structure();
    assert_ok(try_map(state,
                      "{\"beads\": {\"OH\": {\"residue\": \"MET\", \"atoms\": \"O H\"},"
                      "\"CH\": {\"residue\": \"MET\", \"atoms\": \"C\"},"
                      "\"W\": {\"first\": 7, \"last\": 9, \"centre\": \"geometry\"},"
                      "\"more\": {\"type\": \"CH\", \"first\": 10, \"last\": 11, \"size\": 1}},"
                      "\"masses\": {\"O\": 3, \"H\": 1}}"));
    assert_int_equal(mapping.beads, 7);
    assert_int_equal(mapping.types, 3);
    static const size_t type[] = {0, 0, 1, 1, 1, 1, 2}, molecule[] = {0, 1, 0, 1, 3, 4, 2};
    for (int k = 0; k < 7; k++) {
        assert_int_equal(mapping.bead[k].type, type[k]);
        assert_int_equal(mapping.bead[k].molecule, molecule[k]);
    }
    assert_true(mapping.bead[0].mass == 4);
    assert_ok(mf_frame_reserve(&frame, ATOMS, true));
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++) {
            frame.position[k][d] = k * k + d;
            frame.velocity[k][d] = -k * k;
        }
    frame.time = 5;
    assert_ok(mf_mapping_apply(&mapping, &frame, &beads));
    assert_true(beads.time == 5 && beads.atoms == 7 && beads.has_velocities);
    assert_true(fabs(beads.position[0][2] - ((3 * 4 + 1 * 1) / 4.0 + 2)) < 1e-14);
    assert_true(fabs(beads.velocity[1][0] + (3 * 25 + 1 * 16) / 4.0) < 1e-14);
    assert_true(beads.position[3][1] == 10);
    assert_true(fabs(beads.position[6][0] - (36 + 49 + 64) / 3.0) < 1e-13);
    mf_frame_clear(&frame);
    mf_frame_clear(&beads);
    clear();
}

/// A molecule that is whole, and each of its atoms in any image of a tilted box: the same centre,
/// but for whole vectors of the box. Along what is not periodic nothing is an image.
static void test_molecules_are_made_whole_in_tilted_boxes(void **state) {
    static const double box[3][3] = {{4, 0, 0}, {1.9, 3, 0}, {-1.5, 1.2, 3.5}};
    struct trajectory_frame frame = {0}, whole = {0}, broken = {0};
    uint64_t random = 3;
    make_structure();
    assert_ok(try_map(state, "{\"beads\": {\"A\": {}}}"));
    assert_ok(mf_frame_reserve(&frame, ATOMS, false));
    mf_frame_set_box(&frame, box);
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++)
            frame.position[k][d] = 0.4 * k + 0.3 * ((k * (d + 3)) % 5);
    assert_ok(mf_mapping_apply(&mapping, &frame, &whole));
    for (int k = 0; k < ATOMS; k++)
        for (int i = 0; i < 3; i++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const int images = (int)(random >> 33) % 5 - 2;
            for (int d = 0; d < 3; d++)
                frame.position[k][d] += images * box[i][d];
        }
    assert_ok(mf_mapping_apply(&mapping, &frame, &broken));
    for (size_t k = 0; k < mapping.beads; k++) {
        double difference[3];
        for (int d = 0; d < 3; d++)
            difference[d] = broken.position[k][d] - whole.position[k][d];
        for (int i = 2; i >= 0; i--) {
            const double images = rint(difference[i] / box[i][i]);
            for (int d = 0; d < 3; d++)
                difference[d] -= images * box[i][d];
        }
        for (int d = 0; d < 3; d++)
            assert_true(fabs(difference[d]) < 1e-12);
    }
    frame.periodic[2] = false;
    frame.position[1][2] = frame.position[0][2] + 100;
    assert_ok(mf_mapping_apply(&mapping, &frame, &broken));
    assert_true(broken.position[0][2] - frame.position[0][2] > 100 * 1.008 / 29.1);
    frame.atoms--;
    assert_int_equal(mf_mapping_apply(&mapping, &frame, &broken), STATUS_BAD_INPUT);
    mf_frame_clear(&frame);
    mf_frame_clear(&whole);
    mf_frame_clear(&broken);
    clear();
}

static void assert_refused(void **state, const char *json, const char *part) {
    assert_int_equal(try_map(state, json), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "map.json: ");
    assert_contains(mf_status_message(), part);
}

static void test_map_is_refused_when_it_does_not_fit_the_atoms(void **state) {
    make_structure();
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"MET\"}}}",
                   "atom 7, \"OW\" of residue 3 \"SOL\", belongs to no bead");
    assert_refused(state, "{\"beads\": {\"A\": {}, \"B\": {\"residue\": \"NA\"}}}",
                   "atom 10, \"NA\" of residue 4 \"NA\", belongs to two beads");
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"ETH\"}}}",
                   "\"A\": there is no residue \"ETH\"");
    structure.has_residues = false; // as in a file of LAMMPS
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"ETH\"}}}",
                   "these atoms have no residues; a .gro or .pdb by -s has");
    structure.has_residues = true;
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"MET\", \"atoms\": \"C N\"}}}",
                   "residue 1 \"MET\" (atom 1) has 0 atoms \"N\"");
    assert_refused(state, "{\"beads\": {\"A\": {\"first\": 1, \"last\": 12}}}",
                   "\"A\" includes atom 12, but there are 11 atoms");
    snprintf(structure.atom[5].residue_name, STRUCTURE_NAME, "SOL");
    assert_ok(mf_structure_number_residues(&structure));
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"MET\"}}, \"rest\": \"ignore\"}",
                   "residue 2 \"MET\" (atom 4) has 2 atoms, the first of its name has 3");
    snprintf(structure.atom[6].name, STRUCTURE_NAME, "QQ");
    assert_refused(state, "{\"beads\": {\"A\": {}}}", "unknown mass of atom 7, \"QQ\"");
    assert_ok(try_map(state, "{\"beads\": {\"A\": {}}, \"masses\": {\"QQ\": 0}}"));
    assert_true(fabs(mapping.bead[3].mass - 2 * 1.008) < 1e-12); // of a water with such a site
    mf_mapping_clear(&mapping);
    assert_ok(try_map(state, "{\"beads\": {\"A\": {\"first\": 7, \"last\": 8}}, "
                             "\"rest\": \"ignore\", \"masses\": {\"QQ\": 0, \"HW1\": 0}}"));
    assert_true(isnan(mapping.bead[0].mass) && mapping.weight[0] == 0.5 &&
                mapping.weight[1] == 0.5);
    assert_contains((const char *)mapping.notes.data, "the bead of \"QQ\" has no mass");
    mf_mapping_clear(&mapping);
    structure.atom[6].mass = 5;
    assert_ok(try_map(state, "{\"beads\": {\"A\": {}}}"));
    assert_contains((const char *)mapping.notes.data, // of which all but an OH are left out here
                    "the mass of carbon is taken for \"C\" of \"MET\"");
    clear();
}

/// TIP4P of Jorgensen et al., J. Chem. Phys. 79, 926 (1983): M, of which a topology says 0, is as
/// if it were not there; a file where all masses are 0 does not know them.
static void test_sites_without_mass_do_not_count(void **state) {
    static const char *const name[] = {"O", "H", "H", "C"}; // as which M must not be taken
    static const double mass[] = {15.9994, 1.008, 1.008, 0};
    struct trajectory_frame frame = {0}, beads = {0};
    (void)state;
    for (int known = 0; known < 2; known++) {
        assert_ok(mf_structure_init(&structure, 4));
        structure.has_names = structure.has_residues = structure.has_masses = true;
        for (int k = 0; k < 4; k++) {
            snprintf(structure.atom[k].name, STRUCTURE_NAME, "%s", name[k]);
            structure.atom[k].mass = known ? mass[k] : 0;
        }
        assert_ok(mf_structure_number_residues(&structure));
        assert_ok(mf_mapping_plan_default(&plan));
        assert_ok(mf_mapping_init(&mapping, &plan, &structure));
        mf_mapping_plan_clear(&plan);
        assert_true(fabs(mapping.bead[0].mass - (known ? 18.0154 : 15.999 + 2 * 1.008 + 12.011)) <
                    1e-9);
        if (!known)
            clear();
    }
    assert_ok(mf_frame_reserve(&frame, 4, false));
    memset(frame.position, 0, 4 * sizeof *frame.position);
    frame.position[1][0] = 0.09, frame.position[2][0] = -0.03, frame.position[3][0] = 7;
    assert_ok(mf_mapping_apply(&mapping, &frame, &beads));
    assert_true(fabs(beads.position[0][0] - 0.06 * 1.008 / 18.0154) < 1e-14);
    mf_frame_clear(&frame);
    mf_frame_clear(&beads);
    clear();
}

/// One molecule of these atoms, by names apart by blanks.
static void try_molecule(void **state, const char *names, const char *masses) {
    char text[128], json[128], *rest, *name;
    size_t count = 0;
    snprintf(text, sizeof text, "%s", names);
    assert_ok(mf_structure_init(&structure, strlen(names)));
    structure.has_names = structure.has_residues = true;
    for (name = strtok_r(text, " ", &rest); name; name = strtok_r(NULL, " ", &rest)) {
        snprintf(structure.atom[count].name, STRUCTURE_NAME, "%s", name);
        snprintf(structure.atom[count++].residue_name, STRUCTURE_NAME, "MOL");
    }
    structure.atoms = count;
    assert_ok(mf_structure_number_residues(&structure));
    snprintf(json, sizeof json, "{\"beads\": {\"A\": {}}%s%s}", masses ? ", \"masses\": " : "",
             masses ? masses : "");
    assert_ok(try_map(state, json));
}

/// Molecules of chemistry with all their atoms, and such as force fields of united atoms have them.
static void test_united_atoms_are_warned_of(void **state) {
    static const char *const all[] = {
        "C O O",                                       // carbon dioxide
        "C O",                                         // carbon monoxide
        "C N H",                                       // hydrogen cyanide
        "C H1 H2 H3 OH HO",                            // methanol
        "CH3 HH31 HH32 HH33 C O N H",                  // acetamide, as in AMBER
        "C1 C2 H1 H2",                                 // acetylene
        "C O1 O2 HO H",                                // formic acid
        "C1 C2 C3 C4 C5 C6 H1 H2 H3 H4 H5 H6",         // benzene
        "CL1 CL2 CL3 CL4 C",                           // tetrachloromethane
        "C1 C2 N H1 H2 H3",                            // acetonitrile
        "C1 O1 O2 C2 H1 H2 H3",                        // an acetate
        "N H CA HA CB HB1 HB2 HB3 C O",                // alanine in a protein
        "C1 C2 C3 C4 N1 C5 C6 H1 H2 H3 H4 H5 H6 H7 S", // a ring with sulphur
    };
    static const struct {
        const char *atoms, *first, *last;
    } united[] = {
        {"C1 C2 C3 C4", "\"C1\"", "\"C4\""}, // butane
        {"CH3 O H", "\"CH3\"", "\"CH3\""},   // methanol
        {"C O H", "\"C\"", "\"C\""},
        {"CT3 CT2 CT2 CT3", "\"CT3\"", "\"CT2\""},
        {"CA C O CB", "\"CA\"", "\"CB\""},                 // acetone
        {"C1 C2 O H", "\"C1\"", "\"C2\""},                 // ethanol
        {"C", "\"C\"", "\"C\""},                           // methane
        {"C CL1 CL2 CL3", "\"C\"", "\"C\""},               // chloroform
        {"CB1 CB2 CB3 CB4 CB5 CB6", "\"CB1\"", "\"CB6\""}, // benzene
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        try_molecule(state, all[k], NULL);
        if (strstr((const char *)mapping.notes.data, "united"))
            fail_msg("%s: %s", all[k], (const char *)mapping.notes.data);
        clear();
    }
    for (size_t k = 0; k < sizeof united / sizeof *united; k++) {
        try_molecule(state, united[k].atoms, NULL);
        const char *warning = strstr((const char *)mapping.notes.data, "mesofit: warning: ");
        if (warning == NULL)
            fail_msg("%s: no warning", united[k].atoms);
        assert_contains(warning, united[k].first);
        assert_contains(warning, united[k].last);
        assert_contains(warning, "are these united atoms?");
        clear();
    }
    try_molecule(state, "CH3 O H", "{\"CH3\": 15.035}");
    assert_null(strstr((const char *)mapping.notes.data, "united"));
    clear();
}

static void test_map_file_is_refused_when_its_keys_are_wrong(void **state) {
    make_structure();
    assert_refused(state, "{\"beads\": {}}", "names 0 kinds of beads");
    assert_refused(state, "{}", "beads: missing");
    assert_refused(state, "{\"beads\": {\"A\": {\"residu\": \"SOL\"}}}",
                   "did you mean \"residue\"?");
    assert_refused(state, "{\"beads\": {\"A\": {\"residue\": \"SOL\", \"first\": 1}}}", "not both");
    assert_refused(state, "{\"beads\": {\"A\": {\"first\": 3, \"last\": 2}}}", "from \"first\" to");
    assert_refused(state, "{\"beads\": {\"A\": {\"first\": 1, \"last\": 7, \"size\": 2}}}",
                   "7 atoms are not a whole number of beads of 2");
    assert_refused(state, "{\"beads\": {\"A\": {}}, \"masses\": {\"O\": -1}}", "masses.O");
    assert_refused(state, "{\"beads\": {\"A\": {\"atoms\": \"  \"}}}", "names no atom");
    clear();
}

/// Where nothing is known of residues, each atom is a bead, and needs no mass.
static void test_atoms_are_beads_when_there_are_no_residues(void **state) {
    (void)state;
    assert_ok(mf_structure_init(&structure, 3));
    assert_ok(mf_structure_number_residues(&structure));
    assert_ok(mf_mapping_plan_default(&plan));
    assert_ok(mf_mapping_init(&mapping, &plan, &structure));
    assert_int_equal(mapping.beads, 3);
    assert_string_equal(mapping.type_name[0], "A");
    assert_true(isnan(mapping.bead[2].mass) && mapping.weight[2] == 1);
    assert_contains((const char *)mapping.notes.data, "beads of 1 atom, of unknown mass");
    mf_mapping_plan_clear(&plan);
    clear();
}

/// Without names of residues a bead has the name of its only atom, and molecules are of one type if
/// their atoms have the same names.
static void test_types_of_the_file_are_types_of_beads(void **state) {
    static const char *const name[ATOMS] = {"O", "H", "H", "A", "O", "H", "H", "Kr", "H", "H", "A"};
    static const int molecule[ATOMS] = {1, 1, 1, 0, 2, 2, 2, 3, 4, 4, 5};
    static const char *const types[] = {"A", "B", "Kr", "C"};
    static const size_t type[] = {0, 0, 1, 1, 2, 3};
    (void)state;
    assert_ok(mf_structure_init(&structure, ATOMS));
    structure.has_names = structure.has_molecules = true;
    for (int k = 0; k < ATOMS; k++) {
        snprintf(structure.atom[k].name, STRUCTURE_NAME, "%s", name[k]);
        structure.atom[k].molecule = molecule[k];
        structure.atom[k].mass = 1;
    }
    assert_ok(mf_structure_number_residues(&structure));
    assert_ok(mf_mapping_plan_default(&plan));
    assert_ok(mf_mapping_init(&mapping, &plan, &structure));
    assert_int_equal(mapping.types, 4);
    assert_int_equal(mapping.beads, 6);
    for (int k = 0; k < 4; k++)
        assert_string_equal(mapping.type_name[k], types[k]);
    for (int k = 0; k < 6; k++)
        assert_int_equal(mapping.bead[k].type, type[k]);
    mf_mapping_plan_clear(&plan);
    clear();
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_default_map_is_a_bead_a_residue),
        cmocka_unit_test(test_residues_of_one_name_and_other_numbers_of_atoms_are_warned_of),
        TEST(test_map_has_several_beads_a_residue),
        TEST(test_molecules_are_made_whole_in_tilted_boxes),
        TEST(test_map_is_refused_when_it_does_not_fit_the_atoms),
        TEST(test_united_atoms_are_warned_of),
        cmocka_unit_test(test_sites_without_mass_do_not_count),
        TEST(test_map_file_is_refused_when_its_keys_are_wrong),
        cmocka_unit_test(test_atoms_are_beads_when_there_are_no_residues),
        cmocka_unit_test(test_types_of_the_file_are_types_of_beads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
