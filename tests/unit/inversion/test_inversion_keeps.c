// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which potentials an inversion goes on from.
#include "inversion/inversion.h"
#include "inversion/method_steps.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <math.h>

/// An inversion to g(r), and perhaps a pressure, that has no potential yet.
struct fit {
    struct inverse_problem problem;
    struct inversion_state state;
    struct inversion inversion;
};

/// At k_B T_0.
static const struct inverse_problem usual = {.scene.temperature = 1};

static struct inversion *begin(struct fit *fit, bool pressure) {
    *fit = (struct fit){
        .problem.targets.target = {[TARGET_RDF].count = 10, [TARGET_PRESSURE].count = pressure},
        .inversion = {.problem = &fit->problem, .state = &fit->state, .states = 1}};
    fit->inversion.course.progress.best.distance[TARGET_RDF].rms = INFINITY;
    fit->inversion.course.progress.chosen_damping = 1;
    return &fit->inversion;
}

/// Samples say that g is this far off; what is kept becomes the best, as in an iteration.
static bool keeps(struct inversion *inversion, double rms, double noise) {
    struct target_distance *distance = inversion->assessment.distance;
    struct inversion_best_samples *best = &inversion->course.progress.best;
    distance[TARGET_RDF] = (struct target_distance){.rms = rms, .noise = noise};
    const bool kept = mf_inversion_keeps(inversion);
    if (kept)
        memcpy(best->distance, distance, sizeof best->distance);
    return kept;
}

static void test_inversion_keeps_what_is_worse_by_chance(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = begin(&fit, false);
    assert_true(keeps(inversion, 0.2, 0.01));
    assert_true(keeps(inversion, 0.1, 0.01));
    assert_true(keeps(inversion, 0.119, 0.01));
    assert_true(keeps(inversion, 0.119, 0.01));
    assert_false(keeps(inversion, 0.121, 0.01));
    // An error of noise alone is kept.
    assert_true(keeps(inversion, 0.001, 0.002));
    assert_true(keeps(inversion, 0.0049, 0.002));
}

/// Samples end where their noise is a third of the error: each potential 1.6 times as far off as
/// the one before is within two noises of it.
static void test_inversion_keeps_no_slow_divergence(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = begin(&fit, false);
    double error = 0.01;
    int kept = 0;
    for (; kept < 20 && keeps(inversion, error, error / 3); kept++)
        error *= 1.6;
    assert_in_range(kept, 1, 3);
    assert_true(inversion->course.progress.best.distance[TARGET_RDF].rms <= 3 * 0.01);
    assert_true(inversion->course.progress.min[TARGET_RDF].rms == 0.01);
}

/// Several targets count in units of their noise; a new start starts again.
static void test_inversion_keeps_by_all_targets_since_its_start(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = begin(&fit, true);
    inversion->assessment.distance[TARGET_PRESSURE] = (struct target_distance){.rms = 1};
    inversion->assessment.bulk_reach = 1;
    assert_true(keeps(inversion, 0.01, 0.01));
    inversion->assessment.distance[TARGET_PRESSURE].rms = 3.1;
    assert_true(keeps(inversion, 0.01, 0.01)); // sqrt(1 + 9.6) of sqrt(2) + 2
    inversion->assessment.distance[TARGET_PRESSURE].rms = 3.4;
    assert_false(keeps(inversion, 0.01, 0.01));
    inversion->course.progress.best.distance[TARGET_RDF].rms = INFINITY;
    assert_true(keeps(inversion, 0.5, 0.01));
    assert_false(keeps(inversion, 0.6, 0.01));
}

/// Steps −2.2 Φ towards 0 swing about it and grow; the share that leads there is 1/2.2. Steps of
/// 0.4 of the way need no shorter ones, nor do those of 1.4, which leave two fifths.
static void test_inversion_shortens_steps_that_go_too_far(void **state) {
    (void)state;
    static const double slopes[] = {2.2, 0.4, 1.4};
    for (int k = 0; k < 3; k++) {
        size_t point = 0;
        bool well_known = true;
        const double slope = slopes[k];
        double best = 0.2, best_step = -slope * best, phi = best + best_step, step = -slope * phi;
        struct inversion_state made = {
            .problem = &usual,
            .grid = {.known = 1, .known_point = &point, .well_known = &well_known}};
        struct inversion inversion = {
            .state = &made,
            .states = 1,
            .assessment = {.sections = 1, .section[0] = {.misfit = 100, .probable = 2}},
            .course = {.phi = &phi,
                       .step = &step,
                       .best = {.phi = &best, .step = &best_step},
                       .progress = {.damping = 1, .chosen_damping = 1}}};
        mf_inversion_relax(&inversion);
        assert_close(inversion.course.progress.damping, k == 0 ? 1 / slope : 1, 1e-12);
        inversion.assessment.section[0].misfit = 1; // noise points anywhere
        inversion.course.progress.damping = 0.5;
        mf_inversion_relax(&inversion);
        assert_close(inversion.course.progress.damping, 0.75, 1e-12);
    }
}

/// Two bins whose S goes from 10 and 20 to 30 and 20 with a whole step: to be at 18 and 20 it is to
/// go two fifths of it, a half of it to be at 25, and an eighth at least. The part that is 40 has
/// a variance so large that it hardly counts.
static void test_inversion_goes_back_for_the_part_of_which_its_samples_tell(void **state) {
    (void)state;
    static const struct { double target, damping; } cases[] = {{18, 0.4}, {25, 0.5}, {9, 0.125}};
    for (int k = 0; k < 3; k++) {
        struct fit fit;
        struct inversion *inversion = begin(&fit, false);
        size_t bin[] = {0, 1};
        bool seen[] = {true, true}, kept;
        double now[] = {30, 40}, best[] = {10, 20}, variance[] = {1, 1e12};
        double target[] = {cases[k].target, 20};
        fit.state.grid = (struct potential_grid){.known = 2, .known_bin = bin, .seen = seen};
        fit.state.replicas.counts.mean = now;
        fit.state.target.counts = target;
        fit.state.variance = variance;
        inversion->course.best.counts = best;
        inversion->course.progress.damping = 1;
        assert_true(keeps(inversion, 0.1, 0.01));
        inversion->assessment.distance[TARGET_RDF].rms = 1;
        assert_ok(mf_inversion_course_accept(inversion, &kept));
        assert_false(kept);
        assert_close(inversion->course.progress.damping, cases[k].damping, 1e-6);
    }
}

/// A step of 50 k_B T is cut to one k_B T; when it was too far, half of that is next.
static void test_inversion_goes_back_from_a_step_that_was_cut(void **state) {
    (void)state;
    size_t point = 0;
    bool well_known = true;
    double best = 0, best_step = 50, phi = 0;
    struct inversion_state made = {
        .problem = &usual, .grid = {.known = 1, .known_point = &point, .well_known = &well_known}};
    struct inversion inversion = {.state = &made,
                                  .states = 1,
                                  .course = {.phi = &phi,
                                             .best = {.phi = &best, .step = &best_step},
                                             .progress.chosen_damping = 1}};
    for (double damping = 1; damping > mf_inversion_min_damping; damping /= 2) {
        inversion.course.progress.damping = damping;
        mf_inversion_take_step(&inversion);
        assert_close(phi, damping, 1e-12);
    }
    inversion.course.progress.damping = 0.5;
    inversion.course.progress.chosen_damping = 0.2;
    mf_inversion_take_step(&inversion);
    assert_close(phi, 0.1, 1e-12);
}

/// Whatever the unit of energy is: of states at 3 and 2 the colder one decides.
static void test_inversion_cuts_steps_by_the_coldest_state(void **state) {
    (void)state;
    static const struct inverse_problem warm = {.scene.temperature = 3},
                                        cold = {.scene.temperature = 2};
    size_t points[] = {0, 1};
    bool well_known[] = {true, false};
    double best[] = {0, 0}, best_step[] = {50, -300}, phi[2];
    struct inversion_state made[] = {
        {.problem = &warm, .grid = {.known = 2, .known_point = points, .well_known = well_known}},
        {.problem = &cold}};
    struct inversion inversion = {.state = made,
                                  .states = 2,
                                  .course = {.phi = phi,
                                             .best = {.phi = best, .step = best_step},
                                             .progress = {.damping = 1, .chosen_damping = 1}}};
    mf_inversion_take_step(&inversion);
    assert_close(phi[0], 2, 1e-12);
    assert_close(phi[1], -6, 1e-12);
}

/// A step of 50 that was cut to 1 went too far: from there one of 100 leads back, which is cut,
/// too. The straight line through both is 0 at a third of what was gone.
static void test_inversion_shortens_steps_that_were_cut(void **state) {
    (void)state;
    size_t point = 0;
    bool well_known = true;
    double best = 0, best_step = 50, phi = 0, step = -100;
    struct inversion_state made = {
        .problem = &usual, .grid = {.known = 1, .known_point = &point, .well_known = &well_known}};
    struct inversion inversion = {
        .state = &made,
        .states = 1,
        .assessment = {.sections = 1, .section[0] = {.misfit = 100, .probable = 2}},
        .course = {.phi = &phi,
                   .step = &step,
                   .best = {.phi = &best, .step = &best_step},
                   .progress = {.damping = 1, .chosen_damping = 1}}};
    mf_inversion_take_step(&inversion);
    assert_close(phi, 1, 1e-12);
    mf_inversion_relax(&inversion);
    best = phi;
    best_step = step;
    mf_inversion_take_step(&inversion);
    assert_close(phi, 1.0 / 3, 1e-12);
}

/// From where a step led, one twice as long leads back: both lead to a third of the way, whatever
/// damping a person has chosen.
static void test_inversion_relaxes_to_one_place_with_any_chosen_damping(void **state) {
    (void)state;
    for (double chosen = 1; chosen > 0.4; chosen /= 2) {
        size_t point = 0;
        bool well_known = true;
        double best = 0, best_step = 0.5, phi = 0, step = 0;
        struct inversion_state made = {
            .problem = &usual,
            .grid = {.known = 1, .known_point = &point, .well_known = &well_known}};
        struct inversion inversion = {
            .state = &made,
            .states = 1,
            .assessment = {.sections = 1, .section[0] = {.misfit = 100, .probable = 2}},
            .course = {.phi = &phi,
                       .step = &step,
                       .best = {.phi = &best, .step = &best_step},
                       .progress = {.damping = 1, .chosen_damping = chosen}}};
        mf_inversion_take_step(&inversion);
        step = -1; // from 0.5 chosen back: the target is at a third of the way there
        const double zero = phi / 3;
        mf_inversion_relax(&inversion);
        best = phi;
        best_step = step;
        mf_inversion_take_step(&inversion);
        assert_close(phi, zero, 1e-12);
    }
}

/// Of two states one is to go two fifths of the way and the other a fifth, as well known.
static void test_inversion_goes_back_for_the_part_that_all_states_tell(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = begin(&fit, false);
    size_t first[] = {0}, second[] = {1};
    bool seen[] = {true}, kept;
    double now[] = {30, 99, 40}, best[] = {10, 5, 20}, target[] = {18, 7, 24}, variance[] = {1};
    struct inversion_state both[] = {fit.state, fit.state};
    for (int s = 0; s < 2; s++) {
        both[s].bins = s == 0 ? 1 : 2;
        both[s].grid =
            (struct potential_grid){.known = 1, .known_bin = s == 0 ? first : second, .seen = seen};
        both[s].replicas.counts.mean = now + s;
        both[s].target.counts = target + s;
        both[s].variance = variance;
    }
    inversion->state = both;
    inversion->states = 2;
    inversion->course.best.counts = best;
    inversion->course.progress.damping = 1;
    assert_true(keeps(inversion, 0.1, 0.01));
    inversion->assessment.distance[TARGET_RDF].rms = 1;
    assert_ok(mf_inversion_course_accept(inversion, &kept));
    assert_false(kept);
    assert_close(inversion->course.progress.damping, 0.3, 1e-12);
}

/// A fiftieth of a step makes g worse by as much as it was off: so bad it was before, too, and the
/// fit goes on from there. It goes back where g is worse by no more than the noise, and from longer
/// steps, which may well make it worse.
static void test_inversion_goes_on_from_what_belies_the_best(void **state) {
    (void)state;
    static const struct {
        double damping, excess;
        bool kept;
    } cases[] = {{0.02, 60, true}, {0.02, 2, false}, {0.5, 60, false}};
    for (size_t n = 0; n < 3; n++) {
        struct fit fit;
        struct inversion *inversion = begin(&fit, false);
        size_t bin = 0;
        bool seen = true;
        double now = 100 - cases[n].excess, best = 100, target = 150, variance = 1;
        fit.state.bins = 1;
        fit.state.grid = (struct potential_grid){.known = 1, .known_bin = &bin, .seen = &seen};
        fit.state.replicas.counts.mean = &now;
        fit.state.target.counts = &target;
        fit.state.variance = &variance;
        inversion->course.best.counts = &best;
        assert_true(keeps(inversion, 0.1, 0.01));
        inversion->course.progress.damping = cases[n].damping;
        assert_int_equal(keeps(inversion, 0.2, 0.01), cases[n].kept);
        if (cases[n].kept) {
            assert_true(inversion->course.progress.damping == 1);
            assert_true(keeps(inversion, 0.21, 0.01));
        }
    }
}

/// With 900 independent samples less than 100 directions.
static void test_inversion_knows_directions_by_its_samples(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = begin(&fit, false);
    inversion->assessment.sections = 1;
    inversion->assessment.section[0] = (struct inversion_section){.misfit = 100, .probable = 2};
    fit.state.response.independent = 900;
    assert_true(mf_imc_is_known(inversion, 99));
    assert_false(mf_imc_is_known(inversion, 101));
    inversion->assessment.section[0].misfit = 1; // near
    assert_true(mf_imc_is_known(inversion, 101));
}

/// A state of one bin near its target, with 50 samples.
struct one_bin {
    size_t bin, point;
    double target_error, covariance, excess, variance, pooled, pooled_variance, phi, pooled_phi;
    struct inverse_problem problem;
    struct inversion_state state;
};

static void make_one_bin(struct one_bin *one, double response) {
    *one = (struct one_bin){.covariance = response, .problem.scene.temperature = 1};
    one->state = (struct inversion_state){
        .problem = &one->problem,
        .grid = {.known = 1,
                 .pairs_known = 1,
                 .points = 1,
                 .known_bin = &one->bin,
                 .known_point = &one->point},
        .assessment = {.sections = 1, .section[0] = {.misfit = 1, .probable = 2}},
        .target.error = &one->target_error,
        .response.covariance = &one->covariance,
        .excess = &one->excess,
        .variance = &one->variance,
        .pool = {.excess = &one->pooled,
                 .variance = &one->pooled_variance,
                 .phi = &one->pooled_phi},
        .phi = &one->phi,
        .replicas.counts.count = 50};
}

/// S = S* − 4 (Φ − 2)/k_B T without noise, of which two iterations tell a response twice as large:
/// what the third one knows better holds for all.
static void test_inversion_pool_is_moved_by_the_newest_response(void **state) {
    (void)state;
    static const double phi[] = {0, 1, 1.5}, response[] = {8, 8, 4};
    struct one_bin one;
    make_one_bin(&one, 0);
    for (int n = 0; n < 3; n++) {
        one.phi = phi[n];
        one.covariance = response[n];
        one.excess = -4 * (one.phi - 2);
        one.variance = 1;
        mf_inversion_pool(&one.state, false);
    }
    assert_close(one.excess, 2, 1e-12);
    assert_close(one.variance, 1.0 / 3, 1e-12);
}

/// One bin that responds as C says, S = S* − C Φ/k_B T + noise of unit variance, and full Newton
/// steps x = k_B T excess/C. Of such steps, of which each goes w of the way of its noise, the
/// variance of what is left is w/(2 − w) of that of one sample (an autoregressive process, G. E. P.
/// Box and G. M. Jenkins, Time Series Analysis): 1/5 for w = 1/3, and 1 without a pool. 30,000
/// steps whose correlation reaches five make the error of the variance 2 %; a false alarm in 10⁶
/// seeds at 10 %.
static void test_inversion_pool_steps_with_a_fifth_of_the_noise(void **state) {
    (void)state;
    enum { STEPS = 30000, FIRST = 100 };
    static const double response = 4;
    struct one_bin one;
    struct inversion_state *made = &one.state;
    double sum = 0;
    make_one_bin(&one, response);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int n = 0; n < STEPS; n++) {
        one.excess = -response * one.phi + gsl_ran_gaussian(rng, 1);
        one.variance = 1;
        mf_inversion_pool(made, false);
        if (n >= FIRST)
            sum += pow(response * one.phi, 2) / (STEPS - FIRST);
        one.phi += one.excess / response;
    }
    const double worth = made->pool.samples / made->replicas.counts.count;
    print_message("variance left %.4f, stated %.4f, worth %.3f samples\n", sum, one.variance,
                  worth);
    assert_close(sum, 0.2, 0.02);
    assert_close(one.variance, 0.2, 1e-6);
    assert_close(worth, 5, 1e-6);
    // What is far off starts again.
    made->assessment.section[0].misfit = 9.1;
    mf_inversion_pool(made, false);
    assert_true(made->pool.samples == 0);
    gsl_rng_free(rng);
}

/// Few coefficients may never come near to g: there the gradient says whether they are near.
static void test_inversion_pool_of_coefficients_goes_by_their_gradient(void **state) {
    (void)state;
    struct one_bin one;
    make_one_bin(&one, 4);
    one.state.assessment.section[0].misfit = 900;
    mf_inversion_pool(&one.state, false);
    assert_true(one.state.pool.samples == 0);
    one.state.basis.count = 1;
    for (int n = 1; n <= 2; n++) {
        one.state.gradient = 2.9;
        mf_inversion_pool(&one.state, false);
        assert_close(one.state.pool.samples, 50 * n, 1e-12);
    }
    one.state.gradient = 3.1;
    mf_inversion_pool(&one.state, false);
    assert_true(one.state.pool.samples == 0);
}

/// The result is what the last samples ask for, if the step is the most probable one; of a method
/// that forgets, the mean of three or more potentials near the target, unless g at the mean is off
/// by more; other methods end with the potential that was sampled.
static void test_inversion_ends_with_the_step_that_is_left_or_the_mean(void **state) {
    (void)state;
    const struct inversion_rule forgetting = {.memoryless = true}, other = {.memoryless = false};
    struct inverse_method method = {.own = &other};
    struct inverse_problem problem = usual;
    size_t known_point[] = {0, 1}, known_bin[] = {0, 1};
    bool well_known[] = {true, true};
    double phi[2], best[] = {2, 1}, best_step[] = {0.3, -0.1}, pooled_phi[] = {1.5, 1.25};
    double pooled[] = {0.1, 0.1}, variance[] = {1, 1}, mean[] = {10.1, 10.2}, target[] = {10, 10};
    struct inversion_state first = {.problem = &problem,
                                    .grid = {.known = 2,
                                             .points = 2,
                                             .known_point = known_point,
                                             .known_bin = known_bin,
                                             .well_known = well_known},
                                    .replicas.counts = {.count = 30, .mean = mean},
                                    .target.counts = target,
                                    .variance = variance,
                                    .pool = {.excess = pooled, .phi = pooled_phi, .samples = 100}};
    struct inversion inversion = {.method = &method,
                                  .problem = &problem,
                                  .state = &first,
                                  .states = 1,
                                  .course = {.phi = phi,
                                             .best = {.phi = best, .step = best_step},
                                             .progress = {.damping = 1, .chosen_damping = 1}}};
    assert_ok(mf_inversion_take_last_step(&inversion));
    assert_true(best[0] == 2 && best[1] == 1);
    inversion.course.most_probable = true;
    inversion.course.progress.chosen_damping = 0.1; // the end is as probable as ever
    assert_ok(mf_inversion_take_last_step(&inversion));
    assert_close(best[0], 2.3, 1e-15);
    assert_close(best[1], 0.9, 1e-15);
    inversion.course.most_probable = false;
    method.own = &forgetting;
    pooled[0] = 0.3;
    assert_ok(mf_inversion_take_last_step(&inversion));
    assert_close(best[0], 2.3, 1e-15);
    pooled[0] = 0.1;
    first.pool.samples = 60;
    assert_ok(mf_inversion_take_last_step(&inversion));
    assert_close(best[0], 2.3, 1e-15);
    first.pool.samples = 90;
    assert_ok(mf_inversion_take_last_step(&inversion));
    assert_true(best[0] == 1.5 && best[1] == 1.25);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_keeps_what_is_worse_by_chance),
        cmocka_unit_test(test_inversion_keeps_no_slow_divergence),
        cmocka_unit_test(test_inversion_keeps_by_all_targets_since_its_start),
        cmocka_unit_test(test_inversion_pool_steps_with_a_fifth_of_the_noise),
        cmocka_unit_test(test_inversion_pool_is_moved_by_the_newest_response),
        cmocka_unit_test(test_inversion_pool_of_coefficients_goes_by_their_gradient),
        cmocka_unit_test(test_inversion_ends_with_the_step_that_is_left_or_the_mean),
        cmocka_unit_test(test_inversion_shortens_steps_that_go_too_far),
        cmocka_unit_test(test_inversion_goes_back_for_the_part_of_which_its_samples_tell),
        cmocka_unit_test(test_inversion_goes_back_from_a_step_that_was_cut),
        cmocka_unit_test(test_inversion_cuts_steps_by_the_coldest_state),
        cmocka_unit_test(test_inversion_shortens_steps_that_were_cut),
        cmocka_unit_test(test_inversion_relaxes_to_one_place_with_any_chosen_damping),
        cmocka_unit_test(test_inversion_goes_back_for_the_part_that_all_states_tell),
        cmocka_unit_test(test_inversion_goes_on_from_what_belies_the_best),
        cmocka_unit_test(test_inversion_knows_directions_by_its_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
