// SPDX-License-Identifier: GPL-3.0-or-later
//
// "density_profile": a fluid is as dense everywhere, a slab is as dense as was put there and empty
// beside it; so is one in a trajectory, whose beads are counted here once more.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

// Of a trajectory ---------------------------------------------------------------------------------

enum { FRAMES = 40, BEADS = 60, HEAVY = 20, SLABS = 10, TEXT = 1 << 21 };

/// Count of each type in each slab, over the volume of a slab in its frame [1/nm³].
struct counted {
    double density[2][SLABS];
};

/// A number below 1 that looks like chance.
static double chance(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) * 0x1p-24;
}

/// Frames of a tilted box that breathes, each written so many times: light beads anywhere, heavy
/// ones in the lower half of the way along b, and atoms in any image.
static void write_frames(struct temporary_folder *folder, int times, struct counted *counted) {
    char *const text = calloc(TEXT, 1);
    size_t length = 0;
    unsigned seed = 7;
    *counted = (struct counted){0};
    for (int t = 0; t < FRAMES; t++) {
        const double scale = 1 + 0.05 * (t % 3);
        const double box[3][3] = {{20 * scale, 0, 0}, {6, 25, 0}, {-5, 4, 30 * scale}};
        const size_t begin = length;
        length += (size_t)snprintf(text + length, TEXT - length,
                                   "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX "
                                   "BOUNDS abc origin pp pp pp\n%g 0 0 0\n6 25 0 0\n-5 4 %g 0\n"
                                   "ITEM: ATOMS id element mass x y z\n",
                                   t, BEADS, box[0][0], box[2][2]);
        for (int k = 0; k < BEADS; k++) {
            const bool heavy = k < HEAVY;
            double share[3], x[3] = {0};
            for (int i = 0; i < 3; i++)
                share[i] = (i == 1 && heavy ? 0.5 : 1) * chance(&seed);
            counted->density[!heavy][(int)(SLABS * share[1])] +=
                SLABS / (0.02 * scale * 25 * 30 * scale) / FRAMES;
            for (int i = 0; i < 3; i++)
                for (int d = 0; d < 3; d++)
                    x[d] += (share[i] + (k + i) % 3 - 1) * box[i][d];
            length +=
                (size_t)snprintf(text + length, TEXT - length, "%d %s %g %.9f %.9f %.9f\n", k + 1,
                                 heavy ? "K" : "C", heavy ? 39.0 : 12.0, x[0], x[1], x[2]);
        }
        const size_t frame = length - begin;
        for (int n = 1; n < times; n++, length += frame)
            memcpy(text + length, text + begin, frame);
        assert_true(length < TEXT - TEXT / FRAMES);
    }
    temporary_folder_write(folder, "a.dump", text, length);
    free(text);
}

static void measure_frames(struct data_table *profile) {
    RUN_PROGRAM(&result, "measure", "a.dump", "--file-units", "real", "--static", "--temperature",
                "300", "--density-profile", "y", "--profile-bins", "10", "--quiet", "--force", "-o",
                "out");
    run_program_assert_code(&result, 0);
    assert_ok(mf_data_table_read(profile, "out/density_profile.tsv", 0));
    assert_int_equal(profile->rows, SLABS);
    assert_int_equal(profile->columns, 11);
}

/// Slabs lie along the height, which is that of b over the plane of a and c: 1 u/nm³ is 1.66054e-3
/// g/cm³.
static void test_trajectory_is_counted(void **state) {
    static const double gram = 1.66053907e-3;
    struct data_table profile;
    struct counted counted;
    write_frames(*state, 1, &counted);
    measure_frames(&profile);
    for (size_t k = 0; k < SLABS; k++) {
        const double heavy = counted.density[0][k], light = counted.density[1][k];
        const size_t K = 1, C = 3; // as the atoms stand
        assert_true(fabs(at(&profile, k, C) - light) < 2e-5 * light);
        assert_true(fabs(at(&profile, k, K) - heavy) < 2e-5 * heavy + 1e-12);
        assert_true(fabs(at(&profile, k, 7) - 12 * gram * light) < 2e-5);
        assert_true(fabs(at(&profile, k, 5) - 39 * gram * heavy) < 2e-5);
        assert_true(fabs(at(&profile, k, 9) - gram * (12 * light + 39 * heavy)) < 2e-5);
        for (size_t column = 2; column < 11; column += 2)
            assert_true(at(&profile, k, column) > 0);
    }
    assert_true(at(&profile, SLABS - 1, 0) < 2.5 && at(&profile, SLABS - 1, 0) > 2.2);
    mf_data_table_clear(&profile);
}

/// Frames that stand several times tell nothing new: where nothing was, the error stays, and beside
/// it that of what scatters. Independent beads come one by one: 1 in all frames.
static void test_empty_slabs_have_the_error_of_a_visit(void **state) {
    struct data_table once, often;
    struct counted counted;
    write_frames(*state, 1, &counted);
    measure_frames(&once);
    write_frames(*state, 8, &counted);
    measure_frames(&often);
    double sum = 0;
    for (size_t k = 0; k < SLABS; k++)
        sum += counted.density[0][k];
    for (size_t k = SLABS / 2; k < SLABS; k++) {
        assert_true(at(&once, k, 1) == 0 && at(&often, k, 1) == 0);
        const double one = sum / (HEAVY * FRAMES), ratio = at(&once, k, 2) / one;
        assert_true(ratio > 0.7 && ratio < 1.5);
        assert_true(fabs(log(at(&often, k, 2) / at(&once, k, 2))) < 0.5);
    }
    mf_data_table_clear(&once);
    mf_data_table_clear(&often);
}

static void test_profile_wants_an_axis_and_a_box(void **state) {
    struct counted counted;
    write_frames(*state, 1, &counted);
    RUN_PROGRAM(&result, "measure", "a.dump", "--density-profile", "w", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--density-profile takes x, y or z");
    RUN_PROGRAM(&result, "measure", "a.dump", "--profile-bins", "7", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--profile-bins is for --density-profile x|y|z");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_fluid_is_flat), TEST(test_slab_has_two_densities),
                                       TEST(test_trajectory_is_counted),
                                       TEST(test_empty_slabs_have_the_error_of_a_visit),
                                       TEST(test_profile_wants_an_axis_and_a_box)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
