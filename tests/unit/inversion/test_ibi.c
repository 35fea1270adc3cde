// SPDX-License-Identifier: GPL-3.0-or-later
//
// Steps of iterative Boltzmann inversion in bins of few counts, drawn by Poisson's law.
#include "base/rng.h"
#include "inversion/inversion_state.h"
#include "inversion/method_steps.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 2, SAMPLES = 200, DRAWS = 1000, RARE = 0, FULL = 1 };

/// Two bins whose targets have `rare` counts in all samples, and a thousand times as many, with
/// errors of a tenth.
struct scene {
    struct inverse_problem problem;
    struct inversion_state state;
    size_t place[BINS];
    bool seen[BINS], well_known[BINS];
    double ideal[BINS], min[BINS], target[BINS], error[BINS], mean[BINS];
    double comoment[BINS * BINS];
    double step[BINS], inefficiency[BINS];
};

static void make(struct scene *scene, double rare) {
    struct inversion_state *state = &scene->state;
    *scene = (struct scene){.problem.scene.temperature = 1.5,
                            .place = {RARE, FULL},
                            .seen = {true, true},
                            .well_known = {false, true},
                            .ideal = {1, 1},
                            .inefficiency = {1, 1}};
    for (int k = 0; k < BINS; k++) {
        scene->min[k] = 0.3 / SAMPLES;
        scene->target[k] = (k == RARE ? 1 : 1000) * rare / SAMPLES;
        scene->error[k] = 0.1 * scene->target[k];
    }
    *state = (struct inversion_state){.problem = &scene->problem,
                                      .grid = {.known = BINS,
                                               .known_point = scene->place,
                                               .known_bin = scene->place,
                                               .seen = scene->seen,
                                               .well_known = scene->well_known},
                                      .target = {.ideal = scene->ideal,
                                                 .min = scene->min,
                                                 .counts = scene->target,
                                                 .error = scene->error},
                                      .bin_inefficiency = scene->inefficiency};
    state->replicas.counts = (struct comoments){
        .size = BINS, .count = SAMPLES, .mean = scene->mean, .comoment = scene->comoment};
}

/// The step when the samples have so many counts in the rare bin.
static double step_of(struct scene *scene, double counts) {
    scene->mean[RARE] = counts / SAMPLES;
    scene->mean[FULL] = 1.1 * scene->target[FULL];
    for (int k = 0; k < BINS; k++)
        scene->comoment[k * (BINS + 1)] = scene->mean[k] * SAMPLES; // Poisson's
    mf_ibi_step(&scene->state, scene->step);
    return scene->step[RARE];
}

/// D. E. Knuth, The Art of Computer Programming, vol. 2, 3.4.1 F.
static int draw(double mean, uint32_t number) {
    double product = 1;
    for (uint32_t k = 0;; k++) {
        product *= mf_rng_philox(3, RNG_INITIAL, number, k, 0).word[0] / 4294967296.0;
        if (product < exp(-mean))
            return (int)k;
    }
}

/// Counts that agree with a target of 3 and of 10: by its logarithm alone the potential moved by
/// 0.77 k_B T rms of 3.
static void test_ibi_step_stays_where_it_is_when_few_counts_agree_with_the_target(void **state) {
    static const double means[] = {3, 10};
    struct scene scene;
    (void)state;
    for (int m = 0; m < 2; m++) {
        double squares = 0;
        make(&scene, means[m]);
        for (uint32_t k = 0; k < DRAWS; k++)
            squares += pow(step_of(&scene, draw(means[m], k)), 2);
        print_message("%g counts: %.3f k_B T rms\n", means[m], sqrt(squares / DRAWS) / 1.5);
        assert_true(sqrt(squares / DRAWS) < 0.1 * 1.5);
    }
}

/// A bin that is empty where ten are expected is so for a reason, and one with ten times the
/// counts.
static void test_ibi_step_fills_and_empties_bins_that_differ_for_certain(void **state) {
    struct scene scene;
    (void)state;
    make(&scene, 100);
    assert_in_range(lround(1e3 * step_of(&scene, 1000)), 3000, lround(1e3 * 1.5 * log(10)));
    assert_in_range(-lround(1e3 * step_of(&scene, 10)), 1000, lround(1e3 * 1.5 * log(10)));
    make(&scene, 30);
    assert_true(step_of(&scene, 0) < -0.5);
}

static void test_ibi_step_is_the_logarithm_where_the_target_is_well_known(void **state) {
    struct scene scene;
    (void)state;
    make(&scene, 3);
    step_of(&scene, 3);
    assert_close(scene.step[FULL], 1.5 * log(1.1), 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ibi_step_stays_where_it_is_when_few_counts_agree_with_the_target),
        cmocka_unit_test(test_ibi_step_fills_and_empties_bins_that_differ_for_certain),
        cmocka_unit_test(test_ibi_step_is_the_logarithm_where_the_target_is_well_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
