// SPDX-License-Identifier: GPL-3.0-or-later
//
// "density_profile": a fluid is as dense everywhere, a slab is as dense as was put there and empty
// beside it.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

static struct run_program_result result;

static double at(const struct data_table *table, size_t row, size_t column) {
    assert_true(column < table->columns);
    return table->values[row * table->columns + column];
}

static void simulate(struct temporary_folder *folder, const char *scene,
                     struct data_table *profile) {
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_ok(mf_data_table_read(profile, "out/density_profile.tsv", 0));
}

/// Of 192 and 96 particles in 4 x 4 x 6: 2 and 1. Errors are those of the scatter of bins.
static void test_fluid_is_flat(void **state) {
    enum { BINS = 8 };
    struct data_table profile;
    simulate(*state,
             "{\"seed\": 5, \"box\": [4, 4, 6], \"time_step\": 0.04,\n"
             "\"particles\": {\"types\": {\"A\": 192, \"B\": 96}},\n"
             "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": "
             "\"power\"},\n\"density_profile\": {\"bins\": 8},\n"
             "\"measure\": {\"equilibration\": 200, \"samples\": 400, \"every\": 5}}\n",
             &profile);
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("out", "pieces", (const char *const[]){"density_profile.tsv", NULL});
    assert_int_equal(profile.rows, BINS);
    for (size_t type = 0; type < 2; type++) {
        const double density = type ? 1 : 2;
        double sum = 0, squares = 0;
        for (size_t k = 0; k < BINS; k++) {
            const double mean = at(&profile, k, 1 + 2 * type);
            const double error = at(&profile, k, 2 + 2 * type);
            sum += mean / BINS;
            squares += (mean - density) * (mean - density) / (error * error) / BINS;
            assert_true(error > 0 && fabs(mean - density) < 6 * error);
            assert_close(at(&profile, k, 0), 0.375 + 0.75 * (double)k, 1e-6);
        }
        assert_close(sum, density, 1e-5);
        assert_true(squares > 0.05 && squares < 4);
    }
    mf_data_table_clear(&profile);
}

/// 40 particles from 1.2 to 2.4 along y, which do not move: in a fifth of the box.
static void test_slab_has_two_densities(void **state) {
    struct data_table profile;
    char places[4096] = "# x y z\n";
    for (int k = 0; k < 40; k++)
        snprintf(places + strlen(places), sizeof places - strlen(places), "%g %g %g\n",
                 fmod(1.7 * k, 4), 1.215 + 0.03 * k, fmod(0.9 * k, 5));
    small_inputs_write(*state, "places.tsv", places, NULL, NULL);
    simulate(*state,
             "{\"seed\": 5, \"box\": [4, 6, 5], \"time_step\": 1e-9,\n"
             "\"particles\": {\"count\": 40, \"placement\": \"file\", \"file\": \"places.tsv\"},\n"
             "\"conservative\": {\"law\": \"none\"},\n"
             "\"density_profile\": {\"axis\": \"y\", \"bins\": 10},\n"
             "\"measure\": {\"equilibration\": 0, \"samples\": 40, \"every\": 1}}\n",
             &profile);
    for (size_t k = 0; k < 10; k++)
        assert_close(at(&profile, k, 1), k == 2 || k == 3 ? 40 / (4 * 1.2 * 5) : 0, 1e-5);
    mf_data_table_clear(&profile);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_fluid_is_flat), TEST(test_slab_has_two_densities)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
