// SPDX-License-Identifier: GPL-3.0-or-later
//
// The linear step and the bands of several curves, one block each: where the blocks do not see each
// other, each is as it would be alone.
#include "inversion/imc_solve.h"

#include "inversion/inversion_band.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { FIRST = 14, SECOND = 10, SIZE = FIRST + SECOND };

static const double temperature = 1.5, spacing = 0.05;
static const size_t blocks[] = {FIRST, SECOND};

/// A system of both blocks, and each block's own.
struct pair_of_systems {
    double covariance[SIZE * SIZE], part_covariance[2][FIRST * FIRST];
    double excess[SIZE], variance[SIZE];
    struct imc_system whole, part[2];
};

static size_t begin_of(int block) {
    return block ? FIRST : 0;
}

static void make(struct pair_of_systems *s) {
    for (size_t a = 0; a < SIZE * SIZE; a++)
        s->covariance[a] = 0;
    for (size_t k = 0; k < SIZE; k++) {
        s->variance[k] = 1 + 0.2 * (double)k;
        s->excess[k] = 40 * sin(0.3 * (double)k) + 10;
    }
    for (int block = 0; block < 2; block++)
        for (size_t a = 0; a < blocks[block]; a++)
            for (size_t b = 0; b < blocks[block]; b++) {
                const double value = (10.0 + (double)a) * (10.0 + (double)b) * 0.1 *
                                     exp(-abs((int)a - (int)b) / (1.5 + block));
                s->part_covariance[block][a * blocks[block] + b] = value;
                s->covariance[(begin_of(block) + a) * SIZE + begin_of(block) + b] = value;
            }
    s->whole = (struct imc_system){.size = SIZE,
                                   .block = blocks,
                                   .blocks = 2,
                                   .covariance = s->covariance,
                                   .excess = s->excess,
                                   .variance = s->variance,
                                   .temperature = temperature,
                                   .spacing = spacing};
    for (int block = 0; block < 2; block++) {
        s->part[block] = s->whole;
        s->part[block].size = blocks[block];
        s->part[block].blocks = 0;
        s->part[block].covariance = s->part_covariance[block];
        s->part[block].excess = s->excess + begin_of(block);
        s->part[block].variance = s->variance + begin_of(block);
    }
}

static void test_imc_solve_of_two_blocks_is_each_of_them_alone(void **state) {
    (void)state;
    static const double strengths[] = {1e-3, 1, 1e4};
    struct pair_of_systems s;
    make(&s);
    for (int n = 0; n < 3; n++) {
        double x[SIZE], alone[FIRST], misfit = 0, directions = 0;
        struct imc_solution both, one;
        assert_ok(mf_imc_solve(&s.whole, strengths[n], x, &both));
        for (int block = 0; block < 2; block++) {
            assert_ok(mf_imc_solve(&s.part[block], strengths[n], alone, &one));
            for (size_t k = 0; k < blocks[block]; k++)
                assert_close(x[begin_of(block) + k], alone[k], 1e-10);
            misfit += one.misfit * (double)blocks[block] / SIZE;
            directions += one.directions;
        }
        assert_close_relative(both.misfit, misfit, 1e-9);
        assert_close(both.directions, directions, 1e-9);
    }
}

static void test_imc_solve_does_not_smooth_from_one_block_into_the_next(void **state) {
    (void)state;
    struct pair_of_systems s;
    double x[SIZE], as_one[SIZE];
    struct imc_solution solution;
    make(&s);
    assert_ok(mf_imc_solve(&s.whole, 1e3, x, &solution));
    s.whole.blocks = 0;
    assert_ok(mf_imc_solve(&s.whole, 1e3, as_one, &solution));
    assert_true(fabs(x[FIRST] - as_one[FIRST]) > 0.01);
}

static void test_imc_solve_prior_leaves_the_ramp_of_each_block_free(void **state) {
    (void)state;
    gsl_matrix *prior = gsl_matrix_alloc(2 * SIZE - 1, SIZE);
    assert_non_null(prior);
    mf_imc_solve_prior(&(struct imc_system){.spacing = spacing, .block = blocks, .blocks = 2},
                       prior);
    for (int ramp_of = 0; ramp_of < 2; ramp_of++)
        for (size_t row = 0; row < SIZE - 1; row++) {
            double sum = 0, size = 0;
            for (size_t k = 0; k < blocks[ramp_of]; k++) {
                const double shape = 1 - ((double)k + 0.5) / (double)blocks[ramp_of];
                sum += gsl_matrix_get(prior, row, begin_of(ramp_of) + k) * shape;
            }
            for (size_t k = 0; k < SIZE; k++)
                size += fabs(gsl_matrix_get(prior, row, k));
            assert_close(sum, 0, 1e-13);
            // Each block has one row less than numbers; the one between them is empty.
            assert_true((size > 0) == (row != FIRST - 1));
        }
    // Free but for the ridge, which all have.
    for (size_t k = 0; k < SIZE; k++)
        assert_close(gsl_matrix_get(prior, SIZE - 1 + k, k), 0.1, 1e-15);
    gsl_matrix_free(prior);
}

static void test_inversion_band_of_two_blocks_is_each_of_them_alone(void **state) {
    (void)state;
    struct pair_of_systems s;
    double both[SIZE * SIZE], alone[FIRST * FIRST], directions, sum = 0;
    make(&s);
    assert_ok(mf_inversion_band_covariance(&s.whole, 1, both, &directions));
    for (int block = 0; block < 2; block++) {
        double of_one;
        const size_t first = begin_of(block);
        assert_ok(mf_inversion_band_covariance(&s.part[block], 1, alone, &of_one));
        for (size_t a = 0; a < blocks[block]; a++)
            for (size_t b = 0; b < blocks[block]; b++)
                assert_close(both[(first + a) * SIZE + first + b], alone[a * blocks[block] + b],
                             1e-10);
        sum += of_one;
    }
    for (size_t a = 0; a < FIRST; a++)
        for (size_t b = FIRST; b < SIZE; b++)
            assert_close(both[a * SIZE + b], 0, 1e-12);
    assert_close(directions, sum, 1e-9);
}

/// A straight line has no bend with free ends, a constant none round a circle, and a wave round a
/// circle the same wherever it begins.
static void test_imc_solve_prior_of_groups_is_free_at_the_ends(void **state) {
    enum { FREE = 7, ROUND = 9, ALL = FREE + ROUND };
    (void)state;
    const struct imc_shape shapes[] = {{.bend = 2}, {.bend = 3, .periodic = true}};
    const struct imc_system system = {
        .spacing = 0.1, .block = (const size_t[]){FREE, ROUND}, .blocks = 2, .shape = shapes};
    gsl_matrix *rows = gsl_matrix_alloc(2 * ALL - 1, ALL);
    mf_imc_solve_prior(&system, rows);
    for (size_t row = 0; row < ALL - 1; row++) {
        double line = 0, constant = 0, parabola = 0;
        for (size_t k = 0; k < FREE; k++) {
            line += gsl_matrix_get(rows, row, k) * (3 + 2 * (double)k);
            parabola += gsl_matrix_get(rows, row, k) * (double)(k * k);
        }
        for (size_t k = FREE; k < ALL; k++)
            constant += gsl_matrix_get(rows, row, k) * 5;
        assert_close(line, 0, 1e-12);
        assert_close(constant, 0, 1e-12);
        // Of k² the second difference is 2, and a bend over two bins is four times that.
        assert_close(parabola, row + 2 < FREE ? 8 : 0, 1e-12);
    }
    // A row joins the ends of the circle.
    double seen = 0;
    for (size_t row = 0; row < ALL - 1; row++)
        seen += fabs(gsl_matrix_get(rows, row, FREE) * gsl_matrix_get(rows, row, ALL - 1));
    assert_true(seen > 0);
    gsl_matrix_free(rows);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_solve_of_two_blocks_is_each_of_them_alone),
        cmocka_unit_test(test_imc_solve_does_not_smooth_from_one_block_into_the_next),
        cmocka_unit_test(test_imc_solve_prior_leaves_the_ramp_of_each_block_free),
        cmocka_unit_test(test_inversion_band_of_two_blocks_is_each_of_them_alone),
        cmocka_unit_test(test_imc_solve_prior_of_groups_is_free_at_the_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
