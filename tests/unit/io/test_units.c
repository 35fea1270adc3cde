// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

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

static void test_units_put_writes_results_in_physical_units(void **state) {
    const char *file = temporary_folder_file(*state, "a.json");
    struct json_writer *writer = mf_json_writer_create();
    mf_units_put(&water, writer, -2, 3);
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

static void test_units_put_writes_nothing_when_there_are_none(void **state) {
    const char *file = temporary_folder_file(*state, "a.json");
    const struct units none = {0};
    struct json_writer *writer = mf_json_writer_create();
    assert_false(mf_units_known(&none));
    assert_true(mf_units_known(&water));
    mf_units_put(&none, writer, -2, 3);
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
                     "a.json: units: no numbers can hold");
    assert_ok(read_text(state, UNITS("0.465", "298", "2.992e-26"), &units));
    assert_close(mf_units_time_ps(&units), 1.2540, 0.00005);
    assert_ok(read_text(state, "{}", &units));
    assert_false(mf_units_known(&units));
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units_of_water_are_those_of_the_literature),
        cmocka_unit_test(test_units_scale_as_their_formulas),
        TEST(test_units_read_refuses_when_no_number_can_hold_what_follows),
        TEST(test_units_put_writes_results_in_physical_units),
        TEST(test_units_put_writes_nothing_when_there_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
