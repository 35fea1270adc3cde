// SPDX-License-Identifier: GPL-3.0-or-later
//
// "slab" in a scene and in what is measured: a liquid that begins in the middle of the box, what is
// written of it, and that it goes on where it was interrupted; a box without an interface; and what
// has none of its pressure along each axis.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct run_program_result result;

static const char scene[] =
    "{\"seed\": 5, \"box\": [6, 6, 24], \"temperature\": 0.75, \"time_step\": 0.005,\n"
    "\"particles\": {\"types\": {\"A\": 200, \"B\": 100}, \"slab\": 0.5},\n"
    "\"conservative\": {\"law\": \"lennard-jones\", \"cutoff\": 2.5},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2, \"cutoff\": 2.5},\n"
    "\"slab\": {\"bins\": 60},\n"
    "\"measure\": {\"equilibration\": 1000, \"samples\": 100, \"every\": 10}}\n";

static void simulate(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force", "-o", "out");
}

static double at(const struct data_table *table, size_t row, const char *name) {
    const size_t column = mf_data_table_find(table, name);
    assert_true(column > 0);
    return table->values[row * table->columns + column - 1];
}

static void test_slab_is_written_and_resumed(void **state) {
    struct data_table table;
    double beads = 0, mixed = 0;
    simulate(*state, NULL, NULL);
    run_program_assert_code(&result, 0);
    results_assert_numbers("out/summary.json",
                           (const char *const[]){"liquid_density", "liquid_density_error",
                                                 "vapour_density", "vapour_density_error",
                                                 "interface_width", "interface_width_error",
                                                 "surface_tension", "surface_tension_error",
                                                 "pressure_normal", "pressure_normal_error", NULL});
    assert_ok(mf_data_table_read(&table, "out/slab.tsv", 0));
    assert_int_equal(table.rows, 60);
    for (size_t k = 0; k < table.rows; k++) {
        beads += at(&table, k, "density") * 6 * 6 * 24 / 60;
        mixed += (at(&table, k, "density_A") + at(&table, k, "density_B")) * 6 * 6 * 24 / 60;
        assert_close(at(&table, k, "z"), 0.4 * (double)k - 11.8, 1e-4);
    }
    assert_close(beads, 300, 0.01);
    assert_close(mixed, 300, 0.01);
    assert_true(at(&table, 30, "fit") > 0.5 && at(&table, 0, "fit") < 0.1);
    mf_data_table_clear(&table);
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("out", "pieces", (const char *const[]){"slab.tsv", NULL});
}

static void test_box_without_an_interface_is_told(void **state) {
    simulate(*state, "\"temperature\": 0.75", "\"temperature\": 3");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    assert_non_null(strstr(summary, "no interface found"));
    assert_null(strstr(summary, "surface_tension"));
    free(summary);
}

/// Two of 150 beads, with 3.6 between them on the one side and 8.4 on the other.
static void test_two_slabs_are_told(void **state) {
    FILE *file = fopen(temporary_folder_file(*state, "places.tsv"), "w");
    assert_non_null(file);
    for (int k = 0; k < 300; k++) {
        const int layer = k / 25;
        fprintf(file, "%g %g %g\n", 1.2 * (k % 5), 1.2 * (k / 5 % 5),
                3 + 1.2 * layer + (layer < 6 ? 0 : 2.4));
    }
    fclose(file);
    small_inputs_write(*state, "scene.json", scene, "\"slab\": 0.5",
                       "\"placement\": \"file\", \"file\": \"places.tsv\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force", "-o", "out");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    assert_non_null(strstr(summary, "no interface found: more than one slab, or a hole"));
    assert_null(strstr(summary, "surface_tension"));
    free(summary);
}

static void refuse(struct temporary_folder *folder, const char *from, const char *to,
                   const char *what) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, what));
}

static void test_slab_is_refused_where_it_makes_no_sense(void **state) {
    small_inputs_write(*state, "places.tsv", "# x y z\n1 1 1\n", NULL, NULL);
    refuse(*state, "\"slab\": 0.5",
           "\"placement\": \"file\", \"file\": \"places.tsv\", \"slab\": 0.5", "slab");
    refuse(*state, "\"slab\": 0.5", "\"slab\": 1.5", "slab");
    refuse(*state, "\"slab\": 0.5",
           "\"radius\": 0.6}, \"interactions\": {\"soft-discs\": {\"strength\": 1}",
           "along each axis");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_slab_is_written_and_resumed), TEST(test_box_without_an_interface_is_told),
        TEST(test_two_slabs_are_told), TEST(test_slab_is_refused_where_it_makes_no_sense)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
