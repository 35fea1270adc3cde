// SPDX-License-Identifier: GPL-3.0-or-later
//
// U of a bond whose target has few counts, drawn by Poisson's law.
#include "base/rng.h"
#include "inversion/inversion.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 41, DRAWS = 200 };

/// A bond of known U, its target and what a fit has found; S of a potential U is as exp(−U).
struct scene {
    double peak; ///< counts expected at the least U
    double truth[BINS];
    double target[BINS], expected[BINS];
    struct inverse_problem problem;
    struct inversion_rule rule;
    struct inverse_method method;
    struct potential_group group;
    struct inversion_state state;
    struct inversion inversion;
    struct imc_shape shape;
    size_t place[BINS];
    bool seen[BINS];
    double p[BINS], ideal[BINS], min[BINS], error[BINS], mean[BINS], variance[BINS], phi[BINS];
};

static double parabola(double x) {
    return 8 * x * x;
}

/// Wells at −0.5 and 0.5.
static double wells(double x) {
    return 3 * pow(4 * x * x - 1, 2);
}

static void make(struct scene *scene, double (*truth)(double), double peak) {
    *scene = (struct scene){.peak = peak, .problem.scene.temperature = 1.5};
    scene->problem.group[0] =
        (struct bonded_unknown){BONDED_BOND, 0, {100, 0.01, BINS}, 0, {0}}; // r² is a constant
    scene->group.own = (struct bonded_grid){.unknown = scene->problem.group,
                                            .target = scene->p,
                                            .temperature = 1.5,
                                            .dimensions = 3,
                                            .known = BINS,
                                            .seen = BINS,
                                            .points = BINS};
    scene->method = (struct inverse_method){.own = &scene->rule};
    scene->shape.bend = 0.1 * BINS;
    for (size_t k = 0; k < BINS; k++) {
        scene->truth[k] = 1.5 * truth(2 * (double)k / (BINS - 1) - 1);
        scene->place[k] = k;
        scene->seen[k] = true;
        scene->ideal[k] = 1;
        scene->min[k] = 0.3;
        scene->expected[k] = peak * exp(-scene->truth[k] / 1.5);
    }
    scene->inversion = (struct inversion){.method = &scene->method,
                                          .problem = &scene->problem,
                                          .state = &scene->state,
                                          .states = 1,
                                          .course.phi = scene->phi};
    scene->state = (struct inversion_state){.problem = &scene->problem,
                                            .grid = {.blocks = 1,
                                                     .groups = 1,
                                                     .group = &scene->group,
                                                     .known = BINS,
                                                     .points = BINS,
                                                     .known_point = scene->place,
                                                     .known_bin = scene->place,
                                                     .seen = scene->seen},
                                            .target = {.shape = &scene->shape,
                                                       .ideal = scene->ideal,
                                                       .min = scene->min,
                                                       .counts = scene->target,
                                                       .error = scene->error},
                                            .variance = scene->variance};
    scene->state.replicas.counts.mean = scene->mean;
}

/// D. E. Knuth, The Art of Computer Programming, vol. 2, 3.4.1 F; above 50 as normal.
static double draw(double mean, uint32_t number, uint32_t bin) {
    double product = 1;
    if (mean > 50) {
        const struct rng_block block = mf_rng_philox(5, RNG_INITIAL, number, bin, 0);
        const double u = (block.word[0] + 1.0) / 4294967297.0, v = block.word[1] / 4294967296.0;
        return round(mean + sqrt(-2 * log(u) * mean) * cos(2 * M_PI * v));
    }
    for (uint32_t k = 0;; k++) {
        product *= mf_rng_philox(5, RNG_INITIAL, number, bin, k + 1).word[0] / 4294967296.0;
        if (product < exp(-mean))
            return k;
    }
}

/// A target, and the fit that agrees with it but for `off` where it has few counts.
static void draw_target(struct scene *scene, uint32_t number, double off) {
    for (size_t k = 0; k < BINS; k++) {
        scene->target[k] = scene->p[k] = draw(scene->expected[k], number, (uint32_t)k);
        scene->error[k] = sqrt(fmax(1, scene->target[k]));
        const bool few = scene->target[k] < 0.1 * scene->peak;
        const double counts = fmax(1, scene->target[k]);
        scene->phi[k] = -1.5 * (log(counts) + (few ? off : 0));
        scene->mean[k] = counts * exp(few ? off : 0);
        scene->variance[k] = fmax(counts, scene->mean[k]);
    }
    mf_memory_free(scene->inversion.smoothness);
    assert_ok(mf_inversion_smooth_init(&scene->inversion));
}

/// Σ of what has the mean 0 over the counts that are expected.
static void find_errors(struct scene *scene, double error[BINS]) {
    static double c[BINS * BINS], covariance[BINS * BINS], half[BINS];
    struct imc_shape shape;
    const size_t size = BINS;
    double directions, all = 0, twice = 0;
    mf_inversion_smooth_shapes(&scene->inversion, &shape);
    for (size_t k = 0; k < BINS; k++)
        c[k * (BINS + 1)] = scene->mean[k];
    const struct imc_system system = {.size = size,
                                      .block = &size,
                                      .blocks = 1,
                                      .shape = &shape,
                                      .covariance = c,
                                      .variance = scene->variance,
                                      .temperature = 1.5,
                                      .spacing = 1};
    assert_ok(mf_inversion_band_covariance(&system, 1, covariance, &directions));
    for (size_t a = 0; a < BINS; a++) {
        all += scene->expected[a];
        half[a] = 0;
        for (size_t b = 0; b < BINS; b++)
            half[a] += covariance[a * BINS + b] * scene->expected[b];
    }
    for (size_t a = 0; a < BINS; a++)
        twice += half[a] * scene->expected[a] / (all * all);
    for (size_t a = 0; a < BINS; a++)
        error[a] = sqrt(covariance[a * (BINS + 1)] - 2 * half[a] / all + twice);
}

/// rms of U − U_true over its stated error, in the bins where 2 to 100 counts are expected.
static double find_deviation(struct scene *scene, double off, bool smooth) {
    double squares = 0, count = 0, error[BINS];
    for (uint32_t n = 0; n < DRAWS; n++) {
        double mean = 0, all = 0;
        draw_target(scene, n, off);
        if (smooth)
            assert_ok(mf_inversion_smooth(&scene->inversion));
        find_errors(scene, error);
        for (size_t k = 0; k < BINS; k++) {
            mean += scene->expected[k] * (scene->phi[k] - scene->truth[k]);
            all += scene->expected[k];
        }
        for (size_t k = 0; k < BINS; k++)
            if (scene->expected[k] > 2 && scene->expected[k] < 100) {
                squares += pow((scene->phi[k] - scene->truth[k] - mean / all) / error[k], 2);
                count++;
            }
    }
    print_message("off by %.3f stated errors\n", sqrt(squares / count));
    return sqrt(squares / count);
}

/// As the samples leave it, U of few counts is off by twice what is stated; smooth, by as much.
static void test_result_is_within_its_band_where_the_target_has_few_counts(void **state) {
    static struct scene scene;
    (void)state;
    make(&scene, parabola, 400);
    assert_true(find_deviation(&scene, 0, false) > 1.8);
    const double smooth = find_deviation(&scene, 0, true);
    assert_true(smooth > 0.8);
    assert_true(smooth < 1.25);
    mf_memory_free(scene.inversion.smoothness);
}

/// ibi has left U where its counts are within two errors: 0.5 k_B T too low, all in one direction.
static void test_result_of_a_method_that_forgets_goes_the_rest_of_the_way(void **state) {
    static struct scene scene;
    struct inversion_rule *rule = &scene.rule;
    (void)state;
    make(&scene, parabola, 400);
    assert_true(find_deviation(&scene, 0.5, true) > 1.5);
    rule->memoryless = true;
    assert_true(find_deviation(&scene, 0.5, true) < 1.25);
    mf_memory_free(scene.inversion.smoothness);
}

/// A target of one count where three are expected, of nine where three are, and of 90 of 100.
static void test_error_of_few_counts_is_that_of_those_expected(void **state) {
    enum { THREE = 3 };
    size_t bin[] = {0, 1, 2}, known_of[] = {THREE};
    bool seen[] = {true, true, true}, well_known[] = {false, false, true};
    double target[] = {1, 9, 90}, error[] = {1, 3, 9}, mean[] = {3, 3, 100}, unit[] = {1, 1, 1};
    double comoment[THREE * THREE] = {0}, excess[THREE], variance[THREE], inefficiency[THREE];
    struct inverse_problem problem = {0};
    struct inversion_parameters parameters = {0};
    struct inversion_memory memory = {0};
    struct inversion_state made = {
        .problem = &problem,
        .parameters = &parameters,
        .grid = {.blocks = 1,
                 .known_of = known_of,
                 .known = THREE,
                 .known_bin = bin,
                 .seen = seen,
                 .well_known = well_known},
        .assessment = {.sections = 1,
                       .section[0] = {.kind = mf_bonded_distribution_kind(BONDED_BOND),
                                      .bins = THREE,
                                      .known_count = THREE,
                                      .peak = 100}},
        .target = {.ideal = unit, .unit = unit, .counts = target, .error = error},
        .excess = excess,
        .variance = variance,
        .bin_inefficiency = inefficiency,
        .memory = &memory};
    (void)state;
    made.replicas.counts =
        (struct comoments){.size = THREE, .count = 1e6, .mean = mean, .comoment = comoment};
    mf_inversion_assess(&made);
    assert_close(variance[0], 3, 1e-9);
    assert_close(variance[1], 9, 1e-9);
    assert_close(variance[2], 90, 1e-9);
    // (s² + s⁴/(2 e²))/n of the samples' own s² = 1e-12.
    assert_close(made.assessment.distance[mf_bonded_distribution_kind(BONDED_BOND)].variance,
                 1e-12 / THREE, 1e-3 * 1e-12);
}

/// A parabola is smooth as the prior has it; wells bend more, and stay what they are.
static void test_smoothness_is_that_of_the_target(void **state) {
    static struct scene scene;
    double largest = 0;
    (void)state;
    make(&scene, parabola, 400);
    draw_target(&scene, 1, 0);
    assert_true(scene.inversion.smoothness[0] == 1);
    mf_memory_free(scene.inversion.smoothness);
    make(&scene, wells, 4000);
    draw_target(&scene, 1, 0);
    print_message("smoothness of wells: %g\n", scene.inversion.smoothness[0]);
    assert_true(scene.inversion.smoothness[0] < 0.5);
    assert_ok(mf_inversion_smooth(&scene.inversion));
    for (size_t k = BINS / 4; k < BINS - BINS / 4; k++)
        largest = fmax(largest, fabs(scene.phi[k] - scene.phi[BINS / 2] - scene.truth[k] +
                                     scene.truth[BINS / 2]));
    print_message("off by up to %.3f\n", largest);
    assert_true(largest < 0.3);
    mf_memory_free(scene.inversion.smoothness);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_result_is_within_its_band_where_the_target_has_few_counts),
        cmocka_unit_test(test_result_of_a_method_that_forgets_goes_the_rest_of_the_way),
        cmocka_unit_test(test_error_of_few_counts_is_that_of_those_expected),
        cmocka_unit_test(test_smoothness_is_that_of_the_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
