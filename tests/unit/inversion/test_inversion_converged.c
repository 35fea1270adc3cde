// SPDX-License-Identifier: GPL-3.0-or-later
//
// When a fit has come to its end.
#include "inversion/inversion.h"

#include "base/rng.h"
#include "shared/testing.h"

#include <math.h>

/// A fit of pairs, and perhaps of groups, that agrees with its targets and has settled.
struct end {
    struct inverse_problem problem;
    struct inversion_state state;
    struct inversion inversion;
};

/// χ² by bin of what is no longer near its target.
static const double far = 100;

static struct inversion *make_end(struct end *end, size_t groups) {
    static size_t none[] = {0};
    *end = (struct end){
        .state = {.problem = &end->problem,
                  .replicas.count = 8,
                  .grid = {.pairs = 1, .groups = groups, .known_of = none}},
        .inversion = {.problem = &end->problem,
                      .state = &end->state,
                      .states = 1,
                      .parameters.iterations = 100,
                      .assessment = {.sections = 1, .section[0] = {.misfit = 1.5, .probable = 2}},
                      .course = {.most_probable = true,
                                 .band.drifts = {.ramp = {.drift = -0.009, .open = 0.1},
                                                 .bulk[0] = {.drift = 0.05, .open = 1}},
                                 .progress.best.precise = true}}};
    return &end->inversion;
}

static void test_fit_of_pairs_ends_when_it_agrees_once(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 0);
    inversion->assessment.section[0].misfit = far;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->assessment.section[0].misfit = 1.5;
    assert_false(mf_inversion_has_converged(inversion, false));
    inversion->course.band.drifts.ramp.drift = -0.06;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = 0.04;
    inversion->course.band.drifts.bulk[0].drift = 1;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = -0.04;
    inversion->course.band.drifts.bulk[0].drift = -0.4;
    assert_true(mf_inversion_has_converged(inversion, true));
    inversion = make_end(&end, 0);
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Drifts that are small and keep their direction are those of a way: of star polymers each was a
/// quarter of the error, and what was left 2 errors.
static void test_fit_goes_on_while_its_drifts_keep_their_direction(void **state) {
    static const double drift[] = {0.06, 0.045, 0.04, 0.03, 0.02, 0.012};
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 0);
    for (size_t k = 0; k < sizeof drift / sizeof *drift; k++) {
        inversion->course.band.drifts.ramp.drift = drift[k];
        assert_false(mf_inversion_has_converged(inversion, true));
        assert_true(inversion->course.progress.on_its_way == (k > 0));
    }
    struct inversion_drifts *const drifts = &inversion->course.progress.drifts;
    const struct inversion_drifts before = *drifts;
    inversion->course.band.drifts.ramp.drift = -0.03; // back
    assert_true(mf_inversion_has_converged(inversion, true));
    *drifts = before;
    inversion->course.band.drifts.ramp.drift = 0.009; // hardly anything
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Where the samples leave more open than all else does, they are longer from there on, but for the
/// last iteration that there may be.
static void test_fit_whose_samples_hide_what_is_open_takes_longer_ones(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 0);
    end.state.open.rest = 1;
    end.state.open.samples = 1.4;
    end.state.open.independent = 100;
    assert_true(mf_inversion_has_converged(inversion, true));
    inversion = make_end(&end, 0);
    end.state.open.rest = 1;
    end.state.open.samples = 1.6;
    end.state.open.independent = 100;
    end.state.work.sweeps = 8000;
    assert_false(mf_inversion_has_converged(inversion, true));
    assert_int_equal(inversion->course.progress.refine_sweeps, 1000);
    inversion->course.band.drifts.ramp.drift *= -1; // else it is on its way
    end.state.work.sweeps = 16000;
    assert_true(mf_inversion_has_converged(inversion, true));
    assert_int_equal(inversion->course.progress.refine_sweeps, 1000);
    inversion = make_end(&end, 0);
    end.state.open.rest = 1;
    end.state.open.samples = 1.6;
    end.state.open.independent = 100;
    inversion->parameters.iterations = 1;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Samples of which each replica has seen what is open but once or twice are longer, too, where
/// they leave as much open as matters.
static void test_fit_ends_only_when_its_replicas_have_seen_what_is_open(void **state) {
    static const struct {
        double samples, seen; // by each replica
        bool ends;
    } cases[] = {{0.7, 2, false}, {0.7, 4, true}, {0.3, 1, true}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct end end;
        struct inversion *inversion = make_end(&end, 0);
        end.state.open.rest = 1;
        end.state.open.samples = cases[k].samples;
        end.state.open.independent = cases[k].seen * (double)end.state.replicas.count;
        end.state.work.sweeps = 8000;
        assert_true(mf_inversion_has_converged(inversion, true) == cases[k].ends);
        assert_true((inversion->course.progress.refine_sweeps > 0) == !cases[k].ends);
    }
}

/// A way that is over once may be so by chance; what goes on goes on in one direction.
static void test_fit_with_groups_ends_when_the_ways_of_three_iterations_cancel(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = -0.07;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = 0.04;
    assert_false(mf_inversion_has_converged(inversion, false)); // back to the one before
    inversion->assessment.section[0].misfit = far;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->assessment.section[0].misfit = 1.5;
    inversion->course.band.drifts.ramp.drift = -0.2;
    inversion->course.band.drifts.bulk[0].drift = 0.7;
    for (int k = 0; k < 4; k++)
        assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = 0.12;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.bulk[0].drift = 0.3;
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = -0.15; // the last three
    inversion->course.band.drifts.bulk[0].drift = -0.3;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// By the noise of C every other iteration misses its bound, and still asks for its part.
static void test_fit_with_groups_ends_though_its_misfit_swings(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    inversion->course.band.drifts.ramp.drift = 0.01;
    for (int k = 0; k < 2; k++) {
        inversion->assessment.section[0].misfit = 1.5;
        assert_false(mf_inversion_has_converged(inversion, true));
        inversion->assessment.section[0].misfit = 2.1;
        assert_false(mf_inversion_has_converged(inversion, true));
    }
    inversion->assessment.section[0].misfit = 1.5;
    assert_true(mf_inversion_has_converged(inversion, true));
    // What went on between those that agree has not settled.
    inversion = make_end(&end, 1);
    for (int k = 0; k < 6; k++) {
        inversion->course.band.drifts.ramp.drift = k % 2 ? 0.01 : 0.2;
        inversion->assessment.section[0].misfit = k % 2 ? 1.5 : 2.1;
        assert_false(mf_inversion_has_converged(inversion, true));
    }
}

/// The pressures of two states that take turns in being the farthest do not cancel each other.
static void test_pressure_of_each_state_must_settle(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    struct inversion_band_drift *pressure = inversion->course.band.drifts.bulk;
    struct inversion_state two[2] = {end.state, end.state};
    inversion->state = two;
    inversion->states = 2;
    inversion->course.band.drifts.ramp.drift = 0;
    pressure[1].open = 1;
    for (int k = 0; k < INVERSION_MAX_DRIFTS - 1; k++) {
        pressure[0].drift = k % 2 ? 0.6 : 0.7;
        pressure[1].drift = k % 2 ? -0.7 : -0.6;
        assert_false(mf_inversion_has_converged(inversion, true));
    }
    inversion->course.progress.drifts = (struct inversion_drifts){0};
    for (int k = 0; k < 2; k++) {
        pressure[0].drift = pressure[1].drift = k % 2 ? 0.7 : -0.7;
        assert_false(mf_inversion_has_converged(inversion, true));
    }
    pressure[0].drift = pressure[1].drift = 0.1;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Iterations that meet the targets and walk on are no end, however many they are.
static void test_fit_with_groups_goes_on_while_it_walks_on(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    inversion->course.band.drifts.ramp.drift = -0.06;
    for (int n = 0; n < 3 * INVERSION_MAX_DRIFTS; n++)
        assert_false(mf_inversion_has_converged(inversion, true));
    inversion->course.band.drifts.ramp.drift = 0.02; // with the two before, a mean below 0.05
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// A pressure among the targets holds what g hardly sees, and groups alone have no ramp.
static void test_fit_with_groups_ends_at_once_where_nothing_must_settle(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    end.state.grid.pairs = 0;
    inversion->course.band.drifts.ramp.drift = 1;
    assert_true(mf_inversion_has_converged(inversion, true));
    inversion = make_end(&end, 1);
    end.problem.targets.target[TARGET_PRESSURE].count = 1;
    inversion->course.band.drifts.ramp.drift = 1;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Samples that have not settled count, and the fit does not end with them: if they did not, those
/// that need not settle yet would be waited for by those that end it.
static void test_fit_ends_with_samples_that_have_settled(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 1);
    inversion->assessment.unequilibrated.found = true;
    for (int k = 0; k < 4; k++) {
        inversion->course.band.drifts.ramp.drift *= -1;
        assert_false(mf_inversion_has_converged(inversion, true));
    }
    inversion->assessment.unequilibrated.found = false;
    inversion->course.band.drifts.ramp.drift *= -1;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Samples of an iteration that cannot be the last need not be as good as the last ones: whether it
/// can is told before it, and the same as after it.
static void test_fit_knows_before_an_iteration_whether_it_may_end(void **state) {
    static const struct inversion_rule goes_on = {0}, forgets = {.memoryless = true};
    static const struct inverse_method most_probable = {.own = &goes_on};
    static const struct inverse_method memoryless = {.own = &forgets};
    (void)state;
    struct end end;
    for (size_t groups = 0; groups < 2; groups++) {
        struct inversion *inversion = make_end(&end, groups);
        int iterations = 0;
        bool ended = false, may_end = false;
        inversion->method = &most_probable;
        for (; !ended; iterations++) {
            may_end = mf_inversion_may_end(inversion);
            inversion->course.band.drifts.ramp.drift *= -1; // there and back
            ended = mf_inversion_has_converged(inversion, true);
            assert_true(may_end == ended);
        }
        assert_int_equal(iterations, groups > 0 ? 3 : 1);
        inversion->course.progress.drifts.met = 0;
        inversion->method = &memoryless;
        assert_true(mf_inversion_may_end(inversion));
        inversion->method = &most_probable;
        end.problem.targets.target[TARGET_PRESSURE].count = 1;
        assert_true(mf_inversion_may_end(inversion));
    }
}

/// Each section must agree: a stiff bond with many counts hides nothing of a soft one.
static void test_fit_ends_when_all_sections_agree(void **state) {
    (void)state;
    struct end end;
    struct inversion *inversion = make_end(&end, 0);
    inversion->assessment.sections = 2;
    inversion->assessment.section[1] = (struct inversion_section){.misfit = 2.5, .probable = 2.4};
    assert_false(mf_inversion_has_converged(inversion, true));
    inversion->assessment.section[1].misfit = 2.3;
    assert_true(mf_inversion_has_converged(inversion, true));
}

/// Present samples are off by chance where the mean of three potentials near the target is not.
static void test_fit_that_forgets_ends_when_its_mean_or_its_last_potential_agrees(void **state) {
    (void)state;
    const struct inversion_rule rule = {.memoryless = true};
    const struct inverse_method method = {.own = &rule};
    size_t known_bin[] = {0};
    bool seen[] = {true};
    double mean[] = {15}, target[] = {10}, pooled[] = {2.8}, variance[] = {4};
    struct end end;
    struct inversion *inversion = make_end(&end, 0);
    inversion->method = &method;
    inversion->course.most_probable = false;
    inversion->assessment.section[0] =
        (struct inversion_section){.misfit = 2.5, .probable = 2, .known_count = 1, .bins = 1};
    end.state.assessment = inversion->assessment;
    end.state.grid.known = 1;
    end.state.grid.known_bin = known_bin;
    end.state.grid.seen = seen;
    end.state.target.counts = target;
    end.state.replicas.counts = (struct comoments){.count = 30, .mean = mean};
    end.state.pool.excess = pooled;
    end.state.variance = variance;
    end.state.pool.samples = 60;
    assert_false(mf_inversion_has_converged(inversion, true)); // of two: the present one
    end.state.pool.samples = 90;
    assert_true(mf_inversion_has_converged(inversion, true));
    pooled[0] = 2.9; // χ² of 2.1
    assert_false(mf_inversion_has_converged(inversion, true));
    // The mean follows a slow fit at a distance: ibi of soft beads met its target for eight
    // iterations, and its mean, which has less noise, did not.
    inversion->assessment.section[0].misfit = 1.5;
    assert_true(mf_inversion_has_converged(inversion, true));
}

enum { BINS = 40, DRAWS = 2000 };

/// A curve of bins that scatter by themselves, with excesses of normal noise, and one more.
struct curve_of_bins {
    struct end end;
    size_t known_of[1], known_bin[BINS], known_point[BINS];
    bool seen[BINS];
    double place[BINS], target[BINS], error[BINS], excess[BINS], variance[BINS];
    struct comoments counts;
};

static struct inversion *make_curve(struct curve_of_bins *curve) {
    struct inversion *inversion = make_end(&curve->end, 0);
    struct inversion_state *one = &curve->end.state;
    assert_ok(mf_comoments_init(&curve->counts, BINS));
    for (uint32_t sample = 0; sample < DRAWS; sample++) {
        double value[BINS];
        for (uint32_t k = 0; k < BINS; k += 4)
            mf_rng_normal4(mf_rng_philox(3, RNG_INITIAL, sample, k, 0), value + k);
        mf_comoments_add(&curve->counts, value);
    }
    curve->known_of[0] = BINS;
    for (size_t k = 0; k < BINS; k++) {
        curve->known_bin[k] = curve->known_point[k] = k;
        curve->place[k] = 0.01 * (double)k;
        curve->seen[k] = true;
        curve->target[k] = 1000;
        curve->error[k] = sqrt(0.9);
        curve->variance[k] = 1; // a tenth is that of the samples
    }
    one->grid.blocks = 1;
    one->grid.pairs_known = BINS;
    one->grid.known_point = curve->known_point;
    one->grid.r = curve->place;
    one->grid.known_of = curve->known_of;
    one->grid.known_bin = curve->known_bin;
    one->grid.seen = curve->seen;
    one->replicas.counts = curve->counts;
    one->target.counts = curve->target;
    one->target.error = curve->error;
    one->excess = curve->excess;
    one->variance = curve->variance;
    one->assessment.sections = 1;
    one->assessment.section[0] =
        (struct inversion_section){.known_count = BINS, .bins = BINS, .inefficiency = 1};
    return inversion;
}

static void draw_excess(struct curve_of_bins *curve, uint32_t draw) {
    for (uint32_t k = 0; k < BINS; k += 4)
        mf_rng_normal4(mf_rng_philox(5, RNG_INITIAL, draw, k, 0), curve->excess + k);
}

/// A bin that is seven errors off makes χ² of forty bins 2.2, and the fit does not end: false
/// alarms are one of a thousand, the power with five, six and seven errors what χ² of six says.
static void test_fit_does_not_end_where_a_stretch_of_its_curve_is_off(void **state) {
    (void)state;
    static struct curve_of_bins curve;
    struct inversion *inversion = make_curve(&curve);
    size_t found[4] = {0};
    struct inversion_stretch off;
    for (uint32_t draw = 0; draw < DRAWS; draw++)
        for (int errors = 0; errors < 4; errors++) {
            draw_excess(&curve, draw);
            curve.excess[7] += errors > 0 ? 4 + errors : 0;
            found[errors] += mf_inversion_find_stretch(inversion, &off);
        }
    print_message("of %d: %zu without, %zu, %zu, %zu with 5, 6, 7 errors\n", DRAWS, found[0],
                  found[1], found[2], found[3]);
    assert_true(found[0] <= DRAWS / 200);
    assert_true(found[2] > DRAWS / 2);
    assert_true(found[3] > 0.9 * DRAWS);
    for (size_t k = 0; k < BINS; k++)
        curve.excess[k] = k == 7 ? 7 : 0;
    assert_true(mf_inversion_find_stretch(inversion, &off));
    assert_true(off.first <= 0.07 && off.last >= 0.07);
    // Of two the one that is farther off.
    curve.excess[30] = 9;
    assert_true(mf_inversion_find_stretch(inversion, &off));
    assert_true(off.first <= 0.3 && off.last >= 0.3);
    curve.excess[30] = 0;
    assert_false(mf_inversion_has_converged(inversion, true));
    curve.seen[7] = false;
    assert_true(mf_inversion_has_converged(inversion, true));
    // A stretch that the state has not seen is none.
    for (size_t k = 6; k < 15; k++)
        curve.seen[k] = false;
    assert_true(mf_inversion_has_converged(inversion, true));
    mf_comoments_clear(&curve.counts);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_does_not_end_where_a_stretch_of_its_curve_is_off),
        cmocka_unit_test(test_fit_of_pairs_ends_when_it_agrees_once),
        cmocka_unit_test(test_fit_goes_on_while_its_drifts_keep_their_direction),
        cmocka_unit_test(test_fit_whose_samples_hide_what_is_open_takes_longer_ones),
        cmocka_unit_test(test_fit_ends_only_when_its_replicas_have_seen_what_is_open),
        cmocka_unit_test(test_fit_with_groups_ends_when_the_ways_of_three_iterations_cancel),
        cmocka_unit_test(test_fit_with_groups_ends_though_its_misfit_swings),
        cmocka_unit_test(test_pressure_of_each_state_must_settle),
        cmocka_unit_test(test_fit_with_groups_goes_on_while_it_walks_on),
        cmocka_unit_test(test_fit_with_groups_ends_at_once_where_nothing_must_settle),
        cmocka_unit_test(test_fit_ends_with_samples_that_have_settled),
        cmocka_unit_test(test_fit_knows_before_an_iteration_whether_it_may_end),
        cmocka_unit_test(test_fit_ends_when_all_sections_agree),
        cmocka_unit_test(test_fit_that_forgets_ends_when_its_mean_or_its_last_potential_agrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
