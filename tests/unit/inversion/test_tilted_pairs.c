// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pairs in a strongly tilted box, against all images.
#include "inversion/tilted_pairs.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { COUNT = 240, BINS = 20 };

/// Vectors as LAMMPS has them at most, tilted by half a box each, turned into those of the box.
static const double vector[3][3] = {{6, 0, 0}, {2.9, 5, 0}, {-2.8, 2.4, 5.5}};

static struct box_vectors make_box(void) {
    struct box_vectors box = {.volume = 1};
    for (int a = 0; a < 3; a++) {
        box.volume *= vector[a][a];
        for (int b = 0; b < 3; b++)
            box.edge[a][b] = vector[a][b];
    }
    for (int a = 0; a < 3; a++) { // the volume over the area of the other two
        const double *u = vector[(a + 1) % 3], *v = vector[(a + 2) % 3];
        const double area =
            sqrt(pow(u[1] * v[2] - u[2] * v[1], 2) + pow(u[2] * v[0] - u[0] * v[2], 2) +
                 pow(u[0] * v[1] - u[1] * v[0], 2));
        box.height[a] = box.volume / area;
    }
    return box;
}

/// The distance of the nearest of 125 images.
static double nearest(double *const share[3], size_t i, size_t j) {
    double least = INFINITY;
    for (int n = 0; n < 125; n++) {
        const int shift[3] = {n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2};
        double square = 0;
        for (int d = 0; d < 3; d++) {
            double x = 0;
            for (int a = 0; a < 3; a++)
                x += (share[a][i] - share[a][j] - rint(share[a][i] - share[a][j]) + shift[a]) *
                     vector[a][d];
            square += x * x;
        }
        least = fmin(least, sqrt(square));
    }
    return least;
}

static void test_pairs_of_a_tilted_box_are_those_of_all_images(void **state) {
    (void)state;
    static double shares[3][COUNT];
    double *share[3] = {shares[0], shares[1], shares[2]};
    struct fluid fluid;
    struct pair_sums sums = {0};
    double energy = 0, counts[3 * BINS] = {0};
    fluid_groot_warren(&fluid, COUNT, 0.02);
    const struct box_vectors box = make_box();
    const struct composition mixture = {
        .types = 2, .count = {COUNT / 3, COUNT - COUNT / 3}, .name = {"A", "B"}};
    const struct pair_histogram bins = {.low = 0.1, .width = 0.08, .bins = BINS, .pairs = 3};
    unsigned seed = 7;
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < COUNT; k++)
            share[d][k] = 3.0 * rand_r(&seed) / RAND_MAX - 1; // wrapped or not
    struct tilted_pairs pairs = {0};
    for (int again = 0; again < 2; again++)
        assert_ok(
            mf_tilted_pairs_count(&pairs, &box, share, &mixture, &fluid.potential, &bins, &sums));
    for (size_t i = 0; i < COUNT; i++)
        for (size_t j = 0; j < i; j++) {
            const double r = nearest(share, i, j), bin = (r - bins.low) / bins.width;
            const int pair = mf_composition_pair_of_ids(&mixture, (uint32_t)i, (uint32_t)j);
            double phi = 0;
            if (r < table_cutoff(&fluid.potential, pair))
                mf_table_evaluate_pair(&fluid.potential, pair, r, &phi, NULL, NULL);
            energy += phi;
            if (bin >= 0 && bin < BINS)
                counts[pair * BINS + (int)bin]++;
        }
    for (int k = 0; k < 3 * BINS; k++)
        assert_int_equal((int)pairs.counts[k], (int)counts[k]);
    assert_true(energy > 100);
    assert_close(sums.energy, energy, 1e-5 * energy);
    const struct pair_histogram far = {.low = 0, .width = 0.2, .bins = BINS, .pairs = 3};
    assert_int_equal(
        mf_tilted_pairs_count(&pairs, &box, share, &mixture, &fluid.potential, &far, &sums),
        STATUS_BAD_INPUT);
    mf_tilted_pairs_clear(&pairs);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_of_a_tilted_box_are_those_of_all_images),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
