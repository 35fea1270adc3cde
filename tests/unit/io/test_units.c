// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

/// SPC water, one bead a molecule.
static const struct units water = {.length = 0.465, .temperature = 298, .mass = 2.992e-26};

static void test_units_of_water_are_those_of_the_literature(void **state) {
    (void)state;
    assert_close(mf_units_time_ps(&water), 1.2540, 0.00005);
    assert_close(mf_units_energy_kj_per_mol(&water), 2.47771, 0.000005);
    // 1.380649e-23 J/K · 298 K / (0.465e-9 m)³ = 4.0920e7 Pa.
    assert_close_relative(mf_units_pressure_bar(&water), 409.20, 1e-4);
}

/// time ∝ length · sqrt(mass / temperature), energy ∝ temperature, pressure ∝ temperature /
/// length³.
static void test_units_scale_as_their_formulas(void **state) {
    (void)state;
    const struct units other = {
        .length = 2 * water.length, .temperature = 4 * water.temperature, .mass = 9 * water.mass};
    assert_close_relative(mf_units_time_ps(&other), 3 * mf_units_time_ps(&water), 1e-12);
    assert_close_relative(mf_units_energy_kj_per_mol(&other),
                          4 * mf_units_energy_kj_per_mol(&water), 1e-12);
    assert_close_relative(mf_units_pressure_bar(&other), 0.5 * mf_units_pressure_bar(&water),
                          1e-12);
}

static void test_units_write_results_writes_results_in_physical_units(void **state) {
    const char *file = temporary_folder_file(*state, "a.json");
    struct json_writer *writer = mf_json_writer_create();
    mf_units_write_results(&water, writer, -2, 3);
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    assert_close(results_number(file, "physical.length_unit_nm"), 0.465, 0);
    assert_close(results_number(file, "physical.time_unit_ps"), 1.2540, 0.00005);
    assert_close(results_number(file, "physical.energy_unit_kJ_per_mol"), 2.47771, 0.000005);
    assert_close(results_number(file, "physical.potential_energy_kJ_per_mol"), -4.95542, 0.00001);
    assert_close_relative(results_number(file, "physical.pressure_bar"), 3 * 409.20, 1e-4);
    // (0.465e-7 cm)² / 1.2540e-12 s
    assert_close_relative(results_number(file, "physical.diffusion_unit_cm2_per_s"), 1.7243e-3,
                          1e-4);
}

static void test_units_write_results_writes_nothing_when_there_are_none(void **state) {
    const char *file = temporary_folder_file(*state, "a.json");
    const struct units none = {0};
    struct json_writer *writer = mf_json_writer_create();
    assert_false(mf_units_known(&none));
    assert_true(mf_units_known(&water));
    mf_units_write_results(&none, writer, -2, 3);
    assert_ok(mf_json_write(writer, file));
    mf_json_writer_free(writer);
    struct json_document *document;
    assert_ok(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    assert_false(mf_json_has(&root, "physical"));
    assert_ok(mf_json_close(document, STATUS_OK));
}

static enum status read_text(void **state, const char *text, struct units *units) {
    struct json_document *document;
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, strlen(text))));
    struct json_object root = mf_json_root(document);
    mf_units_read(units, &root);
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

#define UNITS(length, temperature, mass)                                                           \
    "{\"units\": {\"length\": " length ", \"temperature\": " temperature ", \"mass\": " mass "}}"

/// Each number is a number, but what follows from it is not.
static void test_units_read_refuses_when_no_number_can_hold_what_follows(void **state) {
    static const char *const bad[] = {UNITS("0.5", "300", "1e308"), UNITS("1e150", "300", "1e-26"),
                                      UNITS("1.7e308", "300", "1e-26"),
                                      UNITS("1e-120", "300", "1e-26"),
                                      UNITS("0.5", "1e308", "1e-300")};
    struct units units;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_fails(read_text(state, bad[k], &units), STATUS_BAD_INPUT,
                     "a.json: units: the resulting units");
    assert_ok(read_text(state, UNITS("0.465", "298", "2.992e-26"), &units));
    assert_close(mf_units_time_ps(&units), 1.2540, 0.00005);
    assert_ok(read_text(state, "{}", &units));
    assert_false(mf_units_known(&units));
}

#define MOLECULES(system, box, particles, molecules)                                               \
    "{\"units\": \"" system "\", \"temperature\": 300, \"box\": " box                              \
    ", \"particles\": {" particles "}, \"molecules\": " molecules "}"

/// With molecules λ is 1 nm in all systems, and μ is the mean mass of all beads.
static void test_units_are_those_of_molecules(void **state) {
    static const char *const texts[] = {
        MOLECULES("nm-ps", "[4, 4, 4]", "\"mass\": {\"A\": 10, \"B\": 25}",
                  "{\"m\": {\"count\": 8, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"]}}}"),
        MOLECULES("angstrom-fs", "[40, 40, 40]", "\"mass\": {\"A\": 10, \"B\": 25}",
                  "{\"m\": {\"count\": 8, \"beads\": [\"A\", \"B\", \"A\"]}}"),
        MOLECULES("nm-ps", "[4, 4, 4]", "\"mass\": 15",
                  "{\"m\": {\"count\": 8, \"chain\": {\"type\": \"A\", \"length\": 3}}}"),
        MOLECULES("nm-ps", "[4, 4, 4]", "\"types\": {\"W\": 12}, \"mass\": {\"W\": 18, \"A\": 12}",
                  "{\"m\": {\"count\": 4, \"chain\": {\"type\": \"A\", \"length\": 3}}}")};
    struct units units;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        // There is no reader of the scene here.
        assert_fails(read_text(state, texts[k], &units), STATUS_BAD_INPUT, "unknown");
        assert_close(units.length, 1, 1e-12);
        assert_close(units.mass / UNITS_ATOMIC_MASS, 15, 1e-12);
    }
    // In a file that is not read yet it is unknown how many there are.
    assert_fails(
        read_text(state,
                  MOLECULES("angstrom-fs", "[40, 40, 40]", "\"mass\": 15", "{\"file\": \"a.top\"}"),
                  &units),
        STATUS_BAD_INPUT, "unknown");
    assert_close(units.length, 1, 1e-12);
}

/// The 15 digits in which a file says a number.
static const char *number(double value) {
    static char text[32];
    snprintf(text, sizeof text, "%.15g", value);
    return text;
}

// What engines and tables of constants say of their units, and not this program.
static const struct units argon = {
    .length = 0.34, .temperature = 120, .mass = 39.948 * UNITS_ATOMIC_MASS, .system = UNITS_NM_PS};

/// k_B = 0.0083144626 kJ/mol/K (GROMACS's manual) and 0.0019872043 kcal/mol/K; 1 kJ/mol/nm^3 is
/// 16.6054 bar (GROMACS); "real" of LAMMPS: mvv2e = 48.88821291^2, the kcal/mol of
/// 1 g/mol (angstrom/fs)^2, and nktv2p = 68568.415, the atm of 1 kcal/mol/angstrom^3.
static void test_units_factor_is_that_of_engines(void **state) {
    (void)state;
    struct units units = argon;
    assert_close_relative(mf_units_factor(&units, "k_B T_0"), 120 * 0.0083144626, 1e-8);
    assert_close_relative(mf_units_factor(&units, "k_B.T_0/lambda^d"),
                          mf_units_factor(&units, "k_B T_0/lambda^2") / 0.34 * 16.6054, 1e-5);
    // Of argon, tau = 2.15 ps with its Lennard-Jones parameters (M. P. Allen, D. J. Tildesley).
    assert_close_relative(mf_units_factor(&units, "tau"), 2.15, 3e-3);
    assert_close_relative(mf_units_factor(&units, "mu/tau"), 39.948 / 2.15, 3e-3);
    assert_close_relative(mf_units_factor(&units, "T_0"), 120, 0);
    const double velocity = mf_units_factor(&units, "lambda/tau");
    assert_close_relative(39.948 * velocity * velocity, mf_units_factor(&units, "k_B T_0"), 1e-12);
    units.system = UNITS_ANGSTROM_FS;
    const double energy = mf_units_factor(&units, "k_BT_0");
    assert_close_relative(mf_units_factor(&units, "lambda"), 3.4, 1e-15);
    assert_close_relative(energy, 120 * 0.0019872043, 1e-7);
    const double faster = mf_units_factor(&units, "lambda/tau");
    assert_close_relative(39.948 * faster * faster * 48.88821291 * 48.88821291, energy, 1e-6);
    assert_close_relative(mf_units_factor(&units, "k_B T_0/lambda^3"),
                          energy / (3.4 * 3.4 * 3.4) * 68568.415, 1e-6);
}

static void test_units_factor_is_1_for_what_no_scene_sets(void **state) {
    (void)state;
    struct units reduced = argon;
    reduced.system = UNITS_REDUCED;
    assert_close(mf_units_factor(&reduced, "lambda"), 1, 0);
    assert_close(mf_units_factor(NULL, "lambda"), 1, 0);
    static const char *const as_they_are[] = {"",  "1",  "steps",  "degrees",
                                              "K", "nm", "parsec", "1/s"};
    char name[UNITS_NAME_SIZE];
    for (size_t k = 0; k < sizeof as_they_are / sizeof *as_they_are; k++) {
        assert_close(mf_units_factor(&argon, as_they_are[k]), 1, 0);
        assert_string_equal(mf_units_name(&argon, as_they_are[k], name), as_they_are[k]);
    }
}

static void test_units_name_is_what_a_person_would_write(void **state) {
    (void)state;
    static const char *const names[][3] = {
        {"lambda", "nm", "angstrom"},
        {"1/lambda", "1/nm", "1/angstrom"},
        {"1/lambda^d", "1/nm^3", "1/angstrom^3"},
        {"k_B T_0", "kJ/mol", "kcal/mol"},
        {"k_B.T_0/lambda", "kJ/mol/nm", "kcal/mol/angstrom"},
        {"k_B T_0/lambda^d", "bar", "atm"},
        {"T_0", "K", "K"},
        {"sqrt(mu/tau)", "sqrt(u/ps)", "sqrt(g/mol/fs)"},
        {"lambda^2/tau^2", "nm^2/ps^2", "angstrom^2/fs^2"},
        {"k_B.T_0.mu/tau", "kJ/mol.u/ps", "kcal/mol.g/mol/fs"},
        {"lambda/mu", "nm/u", "angstrom/(g/mol)"},
    };
    struct units other = argon;
    char name[UNITS_NAME_SIZE];
    other.system = UNITS_ANGSTROM_FS;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        assert_string_equal(mf_units_name(&argon, names[k][0], name), names[k][1]);
        assert_string_equal(mf_units_name(&other, names[k][0], name), names[k][2]);
    }
    other = argon;
    other.dimensions = 2;
    assert_string_equal(mf_units_name(&other, "k_B T_0/lambda^d", name), "kJ/mol/nm^2");
}

/// In a message a pure number has no unit, a density has that of the file, and so has its number.
static void test_units_measured_has_the_unit_of_the_file(void **state) {
    (void)state;
    struct units units = argon;
    char text[UNITS_MEASURED_SIZE];
    units.length = 0.5;
    assert_string_equal(mf_units_measured(&units, "1", 4.5828, 0.0054, text), "4.5828(54)");
    assert_string_equal(mf_units_measured(&units, "1/lambda^3", 0.5, 0.01, text),
                        "4.000(80) 1/nm^3");
}

/// Numbers with the mark of a unit: of argon λ is 0.34 nm, T_0 120 K and k_B T_0 0.9977 kJ/mol.
static void test_units_convert_text_has_numbers_in_those_of_the_file(void **state) {
    (void)state;
    static const char marked[] = "an edge of 5" STATUS_LENGTH ", at -1.50e+02" STATUS_TEMPERATURE
                                 " (limit inf" STATUS_TEMPERATURE "), 12 " STATUS_ENERGY
                                 ", 3 steps, {\"a\": 2}, cut" STATUS_LENGTH " 7\x1flamb";
    char text[256];
    snprintf(text, sizeof text, "%s", marked);
    mf_units_convert_text(&argon, text, sizeof text);
    assert_string_equal(text, "an edge of 1.7 nm, at -1.8e+04 K (limit inf K), 12 , 3 steps, "
                              "{\"a\": 2}, cut 7");
    snprintf(text, sizeof text, "%s", marked);
    mf_units_convert_text(NULL, text, sizeof text);
    assert_string_equal(text, "an edge of 5, at -1.50e+02 (limit inf), 12 , 3 steps, {\"a\": 2}, "
                              "cut 7");
    mf_status_fail(STATUS_BAD_INPUT, "%s", "an edge of 5" STATUS_LENGTH);
    assert_string_equal(mf_status_message(), "an edge of 5");
    mf_status_prefix(STATUS_BAD_INPUT, "f.json");
    mf_units_convert_message(&argon, STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "f.json: an edge of 1.7 nm");
}

/// A spoken name, read again as the unit of a heading, is one over the factor.
static void test_units_from_takes_back_what_name_gives(void **state) {
    (void)state;
    static const char *const reduced[] = {"lambda",           "tau",           "mu/tau",
                                          "k_B T_0/lambda^d", "T_0",           "sqrt(mu/tau)",
                                          "1/lambda^d",       "k_B.T_0.mu/tau"};
    struct units units = argon;
    char name[UNITS_NAME_SIZE];
    double factor;
    for (int system = UNITS_NM_PS; system <= UNITS_ANGSTROM_FS; system++)
        for (size_t k = 0; k < sizeof reduced / sizeof *reduced; k++) {
            units.system = system;
            mf_units_name(&units, reduced[k], name);
            assert_ok(mf_units_from(&units, name, reduced[k], &factor));
            assert_close_relative(factor * mf_units_factor(&units, reduced[k]), 1, 1e-9);
        }
    assert_ok(mf_units_from(&units, "angstrom", "lambda", &factor));
    assert_close_relative(factor, 1 / 3.4, 1e-12);
    assert_fails(mf_units_from(&units, "ps", "lambda", &factor), STATUS_BAD_INPUT,
                 "\"ps\" is not a unit of");
    assert_fails(mf_units_from(&units, "parsec", "lambda", &factor), STATUS_BAD_INPUT,
                 "unknown unit");
}

/// Whatever number a file says is written again, as short as it was, and reads to the same bits.
static void test_units_file_value_is_what_was_read(void **state) {
    (void)state;
    const double factors[] = {0.465, 1.2540123, 2.4777, 39.948, 1.0 / 3};
    for (size_t f = 0; f < sizeof factors / sizeof *factors; f++)
        for (int k = 1; k < 2000; k++) {
            const double said = strtod(number(k * 0.001), NULL), read = said / factors[f];
            assert_close(mf_units_file_value(read, factors[f]), said, 0);
            assert_close(mf_units_file_value(read, factors[f]) / factors[f], read, 0);
        }
}

static enum status read_scene(void **state, const char *text, struct units *units) {
    struct json_document *document;
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, strlen(text))));
    struct json_object root = mf_json_root(document);
    mf_units_read(units, &root);
    return mf_json_close(document, STATUS_OK);
}

/// Three beads in λ³, in two dimensions in λ²; the mean of all masses; 1 u where there are none.
static void test_units_follow_from_the_scene_when_the_file_does_not_say_them(void **state) {
    static const struct {
        const char *text;
        double length, temperature, mass;
    } scenes[] = {
        {"{\"units\": \"nm-ps\", \"box\": [2, 3, 4], \"particles\": {\"count\": 576, \"mass\": "
         "18}, "
         "\"temperature\": 298}",
         0.5, 298, 18},
        {"{\"units\": \"angstrom-fs\", \"box\": [20, 30], \"particles\": {\"count\": 200}, "
         "\"temperature\": 350}",
         0.3, 350, 1},
        {"{\"units\": \"nm-ps\", \"box\": [1, 1, 1], \"particles\": {\"types\": {\"A\": 2, \"B\": "
         "1}, "
         "\"mass\": {\"A\": 10, \"B\": {\"minimum\": 30, \"maximum\": 50}}}, \"temperature\": 300}",
         1, 300, 20},
        {"{\"units\": {\"system\": \"nm-ps\", \"length\": 0.7, \"temperature\": 250, \"mass\": 9}, "
         "\"box\": [1, 1, 1], \"particles\": {\"count\": 3, \"mass\": 18}, \"temperature\": 300}",
         0.7, 250, 9},
    };
    struct units units;
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        assert_ok(read_scene(state, scenes[k].text, &units));
        assert_close_relative(units.length, scenes[k].length, 1e-14);
        assert_close_relative(units.temperature, scenes[k].temperature, 0);
        assert_close_relative(units.mass / UNITS_ATOMIC_MASS, scenes[k].mass, 1e-14);
        assert_int_equal(units.chosen, k < 3);
    }
    assert_fails(read_scene(state,
                            "{\"units\": \"nm-ps\", \"box\": [1e200, 1e200, 1e200], "
                            "\"particles\": {\"count\": 3}, \"temperature\": 300}",
                            &units),
                 STATUS_BAD_INPUT, "units: the resulting units");
    assert_ok(read_scene(state, "{\"units\": \"reduced\"}", &units));
    assert_false(mf_units_are_physical(&units));
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units_of_water_are_those_of_the_literature),
        cmocka_unit_test(test_units_scale_as_their_formulas),
        cmocka_unit_test(test_units_factor_is_that_of_engines),
        cmocka_unit_test(test_units_factor_is_1_for_what_no_scene_sets),
        cmocka_unit_test(test_units_name_is_what_a_person_would_write),
        cmocka_unit_test(test_units_measured_has_the_unit_of_the_file),
        cmocka_unit_test(test_units_convert_text_has_numbers_in_those_of_the_file),
        cmocka_unit_test(test_units_from_takes_back_what_name_gives),
        cmocka_unit_test(test_units_file_value_is_what_was_read),
        TEST(test_units_are_those_of_molecules),
        TEST(test_units_read_refuses_when_no_number_can_hold_what_follows),
        TEST(test_units_follow_from_the_scene_when_the_file_does_not_say_them),
        TEST(test_units_write_results_writes_results_in_physical_units),
        TEST(test_units_write_results_writes_nothing_when_there_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
