// SPDX-License-Identifier: GPL-3.0-or-later
//
// Genetic programming finds formulas that are known from points on them.
#include "base/rng.h"
#include "curves/expression_text.h"
#include "optimise/programming.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 60 };

/// Points on a curve.
struct sample {
    double r[POINTS], y[POINTS], weight[POINTS];
    struct programming_points points;
};

static void take(struct sample *sample, double (*curve)(double r), double low, double high,
                 double zero, double noise) {
    sample->points = (struct programming_points){
        POINTS, sample->r, sample->y, sample->weight, NULL, POINTS, NULL, zero, 0};
    for (int k = 0; k < POINTS; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(7, RNG_INITIAL, (uint32_t)k, 0, 0), normal);
        sample->r[k] = low + (high - low) * k / (POINTS - 1);
        sample->y[k] = curve(sample->r[k]) - (isnan(zero) ? 0 : curve(zero));
        // As of a potential by g(r): what is steep is known badly.
        const double error = 0.01 * (1 + fabs(sample->y[k]));
        sample->weight[k] = 1 / error;
        sample->y[k] += noise * error * normal[0];
    }
}

static double soft_repulsion(double r) {
    return 12.5 * (1 - r) * (1 - r);
}

static double lennard_jones(double r) {
    return 4 * (pow(r, -12) - pow(r, -6));
}

static double gaussian(double r) {
    return 2 * exp(-r * r);
}

static double morse(double r) {
    const double x = 1 - exp(-3 * (r - 1.2));
    return 1.5 * x * x;
}

static const struct programming_parameters usual = {12, 7, 8, 12, 1000};

static struct programming_member search(const struct sample *sample, uint64_t seed, int threads,
                                        const struct programming_parameters *parameters) {
    struct programming programming;
    struct programming_member front[PROGRAMMING_MOST_NODES];
    size_t members;
    assert_ok(mf_programming_init(&programming, &sample->points, parameters, seed, threads, NULL));
    for (int64_t round = 0; round < parameters->rounds; round++)
        assert_ok(mf_programming_round(&programming));
    assert_ok(mf_programming_front(&programming, front, &members));
    assert_true(members > 0);
    for (size_t k = 0; k < members; k++) {
        char text[EXPRESSION_TEXT_SIZE];
        mf_expression_print(&front[k].expression, EXPRESSION_PLAIN, text);
        if (getenv("SHOW"))
            printf("%3d %.4g  %s\n", front[k].expression.length, front[k].error, text);
        assert_true(k == 0 || front[k].error < front[k - 1].error);
        assert_true(front[k].expression.length <= parameters->nodes);
    }
    mf_programming_clear(&programming);
    return front[members - 1];
}

/// The last of the front is the curve itself, to 1e-6, and no longer than a person would write it.
static void assert_finds(double (*curve)(double r), double low, double high, double zero,
                         int length) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct sample sample;
        take(&sample, curve, low, high, zero, 0);
        const struct programming_member found = search(&sample, seed, 2, &usual);
        const double shift =
            isnan(zero) ? 0 : mf_expression_value(&found.expression, zero, NULL) - curve(zero);
        assert_true(found.expression.length <= length);
        for (double r = low; r < high; r += 0.01)
            assert_close(mf_expression_value(&found.expression, r, NULL) - shift, curve(r),
                         1e-6 * (1 + fabs(curve(r))));
    }
}

/// 12.5 (r − 1)²: seven nodes.
static void test_programming_finds_soft_repulsion_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(soft_repulsion, 0.05, 1, 1, 7);
}

/// 4 (r⁻¹² − r⁻⁶), or 4 (r⁻⁶ − ½)², which is the same but for the shift: nine nodes.
static void test_programming_finds_lennard_jones_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(lennard_jones, 0.85, 2.5, 2.5, 9);
}

/// 2 exp(−r²): eight nodes with the sign as a factor.
static void test_programming_finds_a_gaussian_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(gaussian, 0.05, 3, NAN, 8);
}

/// 1.5 (1 − 36.6 exp(−3 r))²: twelve nodes, and ten as 2009 (exp(−3 r) − 0.0273)².
static void test_programming_finds_morse_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(morse, 0.8, 3, 3, 12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_programming_finds_soft_repulsion_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_lennard_jones_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_a_gaussian_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_morse_when_its_points_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
