// SPDX-License-Identifier: GPL-3.0-or-later
//
// Genetic programming finds formulas that are known from points on them.
#include "base/rng.h"
#include "curves/expression_text.h"
#include "optimise/programming.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { POINTS = 60 };

/// Points on a curve.
struct sample {
    double r[POINTS], y[POINTS], weight[POINTS];
    struct programming_points points;
};

static void take(struct sample *sample, double (*curve)(double r), double low, double high,
                 double zero, double noise) {
    sample->points = (struct programming_points){POINTS, sample->r, sample->y, sample->weight, NULL,
                                                 POINTS, NULL,      zero,      NULL,           0};
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

static const struct programming_parameters usual = {12, 8, 6, 1000}, longer = {10, 8, 24, 1000};

static struct programming_member search(const struct sample *sample, uint64_t seed, int threads,
                                        const struct programming_parameters *parameters) {
    struct programming programming;
    struct programming_member front[PROGRAMMING_MAX_NODES];
    size_t members;
    assert_ok(mf_programming_init(&programming, &sample->points, parameters, seed, threads, NULL));
    for (int64_t round = 0; round < parameters->rounds; round++)
        assert_ok(mf_programming_round(&programming));
    assert_ok(mf_programming_front(&programming, front, &members));
    assert_true(members > 0);
    for (size_t k = 0; k < members; k++) {
        char text[EXPRESSION_TEXT_SIZE];
        mf_expression_print(&front[k].expression, EXPRESSION_PLAIN, text);
        print_message("%3d %.4g  %s\n", front[k].expression.length, front[k].error, text);
        assert_true(k == 0 || front[k].error < front[k - 1].error);
        assert_true(front[k].expression.length <= parameters->nodes);
    }
    mf_programming_clear(&programming);
    return front[members - 1];
}

/// The last of the front is the curve itself, to 1e-6, and as long as it is known to be.
static void assert_finds(double (*curve)(double r), double low, double high, double zero,
                         int length, uint64_t seeds,
                         const struct programming_parameters *parameters) {
    for (uint64_t seed = 1; seed <= seeds; seed++) {
        struct sample sample;
        take(&sample, curve, low, high, zero, 0);
        const struct programming_member found = search(&sample, seed, 2, parameters);
        const double shift =
            isnan(zero) ? 0 : mf_expression_value(&found.expression, zero, NULL) - curve(zero);
        assert_int_equal(found.expression.length, length);
        for (double r = low; r < high; r += 0.01)
            assert_close(mf_expression_value(&found.expression, r, NULL) - shift, curve(r),
                         1e-6 * (1 + fabs(curve(r))));
    }
}

/// 12.5 (r − 1)²: seven nodes.
static void test_programming_finds_soft_repulsion_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(soft_repulsion, 0.05, 1, 1, 7, 3, &usual);
}

/// 4 (r⁻¹² − r⁻⁶): nine nodes.
static void test_programming_finds_lennard_jones_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(lennard_jones, 0.85, 2.5, 2.5, 9, 3, &usual);
}

/// exp(0.693 − r²), which is 2 exp(−r²): six nodes.
static void test_programming_finds_a_gaussian_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(gaussian, 0.05, 3, NAN, 6, 3, &usual);
}

/// 1.5 (1 − exp(−3 (r − 1.2)))² is also 2009 (exp(−3 r) − 0.0273)²: ten nodes..
static void test_programming_finds_morse_when_its_points_are_exact(void **state) {
    (void)state;
    assert_finds(morse, 0.8, 3, 3, 10, 1, &longer);
}

/// Noise of 1 % leaves the structure, and the constants within their errors: σ₆, σ₁₂ whole. What is
/// longer than the truth describes noise, and is better by little.
static void test_programming_finds_lennard_jones_when_its_points_are_noisy(void **state) {
    (void)state;
    struct sample sample;
    struct programming programming;
    struct programming_member front[PROGRAMMING_MAX_NODES];
    size_t members, found = 0;
    take(&sample, lennard_jones, 0.85, 2.5, 2.5, 1);
    assert_ok(mf_programming_init(&programming, &sample.points, &usual, 1, 2, NULL));
    for (int64_t round = 0; round < usual.rounds; round++)
        assert_ok(mf_programming_round(&programming));
    assert_ok(mf_programming_front(&programming, front, &members));
    while (found < members && front[found].expression.length < 9)
        found++;
    assert_true(found < members && front[found].expression.length == 9);
    // The truth's own error is that of 60 normal numbers, 1.0(1).
    assert_in_range((uint64_t)(100 * front[found].error), 70, 130);
    assert_true(front[found - 1].error > 5);
    const double shift = mf_expression_value(&front[found].expression, 2.5, NULL);
    assert_close(mf_expression_value(&front[found].expression, 1.122462, NULL) - shift,
                 -1 - lennard_jones(2.5), 0.02);
    mf_programming_clear(&programming);
}

/// One round, and two: the spans carry all of the state.
static void test_programming_gives_the_same_bits_for_any_threads_and_after_a_restart(void **state) {
    (void)state;
    static const struct programming_parameters few = {9, 3, 2, 100};
    struct sample sample;
    struct programming programming[3];
    struct memory_span from[3], to[3];
    take(&sample, lennard_jones, 0.85, 2.5, 2.5, 1);
    for (int k = 0; k < 3; k++)
        assert_ok(mf_programming_init(&programming[k], &sample.points, &few, 5, k + 1, NULL));
    for (int round = 0; round < 2; round++) {
        assert_ok(mf_programming_round(&programming[0]));
        assert_ok(mf_programming_round(&programming[1]));
        if (round == 0) {
            const size_t count = mf_programming_spans(&programming[0], from);
            assert_int_equal(mf_programming_spans(&programming[2], to), count);
            for (size_t n = 0; n < count; n++)
                memcpy(to[n].memory, from[n].memory, from[n].bytes);
        } else {
            assert_ok(mf_programming_round(&programming[2]));
        }
    }
    for (int length = 1; length <= 9; length++)
        for (int k = 1; k < 3; k++) {
            assert_identical(programming[k].best[length].error, programming[0].best[length].error);
            assert_memory_equal(&programming[k].best[length].expression,
                                &programming[0].best[length].expression, sizeof(struct expression));
        }
    for (int k = 0; k < 3; k++)
        mf_programming_clear(&programming[k]);
}

/// Of a response R residuals are R (f − y): a direction that it does not see is free. Here it sees
/// differences of neighbours alone, so that a number added to the points changes nothing.
static void test_programming_does_not_see_what_the_response_does_not_see(void **state) {
    (void)state;
    static double response[POINTS * POINTS];
    struct sample sample;
    struct programming_member member = {.error = 0};
    take(&sample, soft_repulsion, 0.05, 1, NAN, 0);
    for (int k = 0; k + 1 < POINTS; k++) {
        response[k * POINTS + k] = -1;
        response[k * POINTS + k + 1] = 1;
        sample.y[k] += 7;
    }
    sample.y[POINTS - 1] += 7;
    sample.points.weight = NULL;
    sample.points.response = response;
    assert_ok(mf_expression_parse(&member.expression, "3*(r - 0.8)^2"));
    assert_ok(mf_programming_polish(&sample.points, &member));
    assert_close(member.error, 0, 1e-7);
    assert_close(member.expression.node[0].constant, 12.5, 1e-6);
    assert_close(member.expression.node[2].constant, -1, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_programming_finds_soft_repulsion_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_lennard_jones_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_a_gaussian_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_morse_when_its_points_are_exact),
        cmocka_unit_test(test_programming_finds_lennard_jones_when_its_points_are_noisy),
        cmocka_unit_test(test_programming_gives_the_same_bits_for_any_threads_and_after_a_restart),
        cmocka_unit_test(test_programming_does_not_see_what_the_response_does_not_see),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
