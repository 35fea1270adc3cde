// SPDX-License-Identifier: GPL-3.0-or-later
//
// Single simulations of a small soft fluid, and rounds of them.
#include "problem/evaluate.h"

#include "dynamics/brownian.h"
#include "matching/population.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 81, BINS = 20, VARIABLES = 4, CANDIDATES = 6 };

/// A fluid whose g(r) is to be 1 everywhere, which it is not.
struct made {
    struct fluid fluid;
    double g[BINS], error[BINS];
    struct inverse_problem problem;
    struct evaluate_parameters parameters;
};

static void begin(struct made *made) {
    *made = (struct made){.parameters = {.plan = {.equilibration = 20, .samples = 40, .every = 5},
                                         .temperature_tolerance = 0.9}};
    fluid_groot_warren(&made->fluid, COUNT, 0.02);
    for (int k = 0; k < BINS; k++) {
        made->g[k] = 1;
        made->error[k] = 0.01;
    }
    made->problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.05, BINS},
                    .target[TARGET_RDF] =
                        {.count = BINS, .value = made->g, .error = made->error, .weight = 0}},
        .unknown[UNKNOWN_OMEGA] =
            {.wanted = true, .parameters = {.coefficients = VARIABLES, .maximum = 6, .cutoff = 1}},
        .scene = made->fluid.setup,
        .seed = 3,
        .threads = 1};
}

static void measure(const struct made *made, double discard_above, double racing,
                    struct evaluate_result *result) {
    struct evaluate_parameters parameters = made->parameters;
    parameters.racing = racing;
    const struct evaluate_candidate candidate = {.potential = made->problem.scene.potential,
                                                 .omega = made->problem.scene.omega,
                                                 .discard_above = discard_above,
                                                 .threads = 1,
                                                 .seed = 11};
    assert_ok(mf_evaluate(&made->problem, &candidate, &parameters, NULL, NULL, NULL, result));
}

static void test_evaluate_stops_early_when_a_candidate_cannot_win(void **state) {
    (void)state;
    struct made made;
    struct evaluate_result whole, stopped;
    begin(&made);
    measure(&made, HUGE_VAL, 0, &whole);
    assert_false(whole.stopped);
    assert_int_equal(whole.engine_steps, 220);
    assert_true(whole.error > 0.1);
    measure(&made, 0.1 * whole.error, 2, &stopped);
    assert_true(stopped.stopped);
    assert_in_range(stopped.engine_steps, 20 + 4 * 5, 70);
    assert_true(stopped.error > 0.1 * whole.error);
    fluid_clear(&made.fluid);
}

/// Looking at a quarter of the samples does not change what comes of all of them.
static void test_evaluate_has_the_same_bits_when_it_is_not_stopped(void **state) {
    (void)state;
    struct made made;
    struct evaluate_result whole, raced;
    begin(&made);
    measure(&made, HUGE_VAL, 0, &whole);
    const struct evaluate_result expected = whole;
    measure(&made, 10 * whole.error, 2, &raced);
    assert_false(raced.stopped);
    assert_identical(raced.error, expected.error);
    assert_identical(raced.noise, expected.noise);
    assert_identical(raced.variance, expected.variance);
    assert_int_equal(raced.engine_steps, expected.engine_steps);
    measure(&made, 0.1 * whole.error, 0, &raced);
    assert_false(raced.stopped);
    measure(&made, HUGE_VAL, 2, &raced);
    assert_false(raced.stopped);
    fluid_clear(&made.fluid);
}

/// Fewer samples than parts of a race.
static void test_evaluate_races_with_fewer_samples_than_looks(void **state) {
    (void)state;
    struct made made;
    struct evaluate_result result;
    begin(&made);
    made.parameters.plan.samples = 1;
    measure(&made, 1e-9, 0.1, &result);
    assert_int_equal(result.engine_steps, 25);
    assert_true(isfinite(result.error));
    fluid_clear(&made.fluid);
}

/// One window of a VACF has no error of its own, and two have next to none: a simulation that may
/// stop when its error is well known goes on for four.
static void test_evaluate_sees_some_windows_before_it_stops(void **state) {
    (void)state;
    enum { LAGS = 10 };
    struct made made;
    struct evaluate_result result;
    double vacf[LAGS + 1], error[LAGS + 1], time[LAGS + 1];
    begin(&made);
    for (int k = 0; k <= LAGS; k++) {
        time[k] = 0.02 * k;
        vacf[k] = 0;
        error[k] = 0.001;
    }
    made.problem.targets.target[TARGET_RDF].count = 0;
    made.problem.targets.target[TARGET_VACF] =
        (struct target){.count = LAGS + 1, .x = time, .value = vacf, .error = error};
    made.problem.targets.motion_interval = 0.02;
    made.problem.targets.motion_lags = LAGS;
    made.parameters.precision = 1;
    measure(&made, HUGE_VAL, 0, &result);
    assert_true(result.stopped);
    assert_in_range(result.engine_steps, 20 + 4 * LAGS, 20 + 4 * LAGS + 15);
    assert_true(result.variance > 0);
    fluid_clear(&made.fluid);
}

/// With a time step of next to nothing a simulation ends where it begins.
static void test_evaluate_begins_where_it_is_told(void **state) {
    (void)state;
    struct made made;
    struct evaluate_result result;
    double from[3][COUNT], to[3][COUNT];
    begin(&made);
    made.problem.scene.time_step = 1e-9;
    made.parameters.plan = (struct measure_plan){.equilibration = 10, .samples = 1, .every = 1};
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < COUNT; k++)
            from[d][k] = (d == 0 ? k % 5 : d == 1 ? k / 5 % 5 : k / 25) * 0.6 + 0.1;
    const struct evaluate_candidate candidate = {
        .potential = made.problem.scene.potential,
        .omega = made.problem.scene.omega,
        .position = (const double *const[]){from[0], from[1], from[2]},
        .discard_above = HUGE_VAL,
        .threads = 1,
        .seed = 11};
    assert_ok(mf_evaluate(&made.problem, &candidate, &made.parameters, NULL, NULL,
                          (double *const[]){to[0], to[1], to[2]}, &result));
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < COUNT; k++)
            assert_close(to[d][k], from[d][k], 1e-6);
    fluid_clear(&made.fluid);
}

static void test_evaluate_fails_when_the_temperature_is_another(void **state) {
    (void)state;
    struct made made;
    struct evaluate_result result;
    begin(&made);
    made.parameters.temperature_tolerance = 1e-9;
    const struct evaluate_candidate candidate = {.potential = made.problem.scene.potential,
                                                 .omega = made.problem.scene.omega,
                                                 .discard_above = HUGE_VAL,
                                                 .threads = 1,
                                                 .seed = 11};
    assert_fails(
        mf_evaluate(&made.problem, &candidate, &made.parameters, NULL, NULL, NULL, &result),
        STATUS_UNSTABLE, "the temperature is");
    assert_int_equal(result.engine_steps, 20);
    assert_int_equal(result.failure, EVALUATE_TEMPERATURE);
    assert_close(result.temperature, 1, 0.5);
    fluid_clear(&made.fluid);
}

/// Without velocities the temperature is a ratio of noisy sums: for a few beads in a large box it
/// says little, and beads without Φ have none. Neither is the candidate's fault; a time step that
/// heats a dense fluid beyond all bounds is.
static void test_evaluate_knows_how_well_a_temperature_is_known(void **state) {
    (void)state;
    static const struct brownian_parameters parameters = {.friction = 1};
    enum { DILUTE, WITHOUT_PHI, HOT, CASES };
    for (int n = 0; n < CASES; n++)
        for (uint64_t seed = 1; seed <= 10; seed++) {
            struct made made;
            struct evaluate_result result;
            begin(&made);
            made.parameters.temperature_tolerance = 0.1;
            made.parameters.plan =
                (struct measure_plan){.equilibration = 2000, .samples = 4, .every = 5};
            struct simulation_setup *scene = &made.problem.scene;
            scene->omega = NULL;
            scene->integrator = &mf_brownian;
            scene->integrator_parameters = &parameters;
            scene->time_step = n == HOT ? 0.03 : 0.002;
            scene->potential = n == WITHOUT_PHI ? NULL : scene->potential;
            for (int d = 0; d < 3 && n == DILUTE; d++)
                scene->box.length[d] *= 2;
            const struct evaluate_candidate candidate = {.potential = scene->potential,
                                                         .discard_above = HUGE_VAL,
                                                         .threads = 1,
                                                         .seed = seed};
            const enum status found =
                mf_evaluate(&made.problem, &candidate, &made.parameters, NULL, NULL, NULL, &result);
            assert_int_equal(found, n == HOT ? STATUS_UNSTABLE : STATUS_OK);
            fluid_clear(&made.fluid);
        }
}

/// Mean over some seeds of the temperature after a candidate's short equilibration.
static double temperature_from(const struct made *made, const double *const *position) {
    enum { SEEDS = 16 };
    double sum = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const struct evaluate_candidate candidate = {.potential = made->problem.scene.potential,
                                                     .omega = made->problem.scene.omega,
                                                     .position = position,
                                                     .discard_above = HUGE_VAL,
                                                     .threads = 1,
                                                     .seed = 100 + seed};
        struct evaluate_result result;
        assert_ok(
            mf_evaluate(&made->problem, &candidate, &made->parameters, NULL, NULL, NULL, &result));
        sum += result.temperature;
    }
    return sum / SEEDS;
}

/// With little friction beads keep the heat of the lattice: D and VACF of candidates that begin
/// there are those of a hot fluid. False alarms: 1 in 10^4 for another seed.
static void test_evaluate_settle_leaves_no_heat_of_the_lattice(void **state) {
    (void)state;
    static double x[3][COUNT];
    double *const position[3] = {x[0], x[1], x[2]};
    struct made made;
    uint64_t steps = 0;
    begin(&made);
    const struct evaluate_candidate candidate = {.potential = made.problem.scene.potential,
                                                 .omega = made.problem.scene.omega,
                                                 .threads = 1,
                                                 .seed = 11};
    assert_true(fabs(temperature_from(&made, NULL) - 1) > 0.06);
    assert_ok(mf_evaluate_settle(&made.problem, &candidate, made.parameters.plan.equilibration,
                                 position, &steps));
    assert_in_range(steps, 2 * 8 * 20, 64 * 8 * 20);
    assert_close(temperature_from(&made, (const double *const *)position), 1, 0.06);
    fluid_clear(&made.fluid);
}

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// Errors and steps of two rounds of candidates, the second begun where the best of the first
/// ended.
struct rounds {
    double errors[2][CANDIDATES], positions[3 * COUNT];
    uint64_t steps;
};

static void measure_rounds(const struct made *made, int threads, struct rounds *rounds) {
    struct inverse_problem problem = made->problem;
    struct parametrisation parametrisation;
    struct population population;
    double variables[CANDIDATES * VARIABLES];
    const struct inverse_listener listener = {ignore, NULL};
    const struct optimiser_round round = {variables, CANDIDATES};
    const struct population_parameters parameters = {made->parameters, 1};
    problem.threads = threads;
    for (int k = 0; k < CANDIDATES * VARIABLES; k++)
        variables[k] = 0.2 + 0.03 * k;
    assert_ok(mf_parametrisation_init(&parametrisation, &problem));
    assert_ok(mf_population_init(&population, &parametrisation, &parameters));
    for (int n = 0; n < 2; n++) {
        const double discard_above = n == 0 ? HUGE_VAL : 0.5 * rounds->errors[0][0];
        assert_int_equal(population.totals.warm, n > 0);
        assert_ok(mf_population_measure(&population, &round, discard_above, &listener));
        memcpy(rounds->errors[n], population.errors, sizeof rounds->errors[n]);
        mf_population_next_round(&population);
    }
    memcpy(rounds->positions, population.position, sizeof rounds->positions);
    rounds->steps = population.totals.steps;
    assert_int_equal(population.totals.evaluations, 2 * CANDIDATES);
    mf_population_clear(&population);
    mf_parametrisation_clear(&parametrisation);
}

static void test_candidates_race_with_the_same_bits_for_any_threads(void **state) {
    (void)state;
    struct made made;
    struct rounds one = {0}, many = {0};
    begin(&made);
    made.parameters.racing = 1;
    measure_rounds(&made, 1, &one);
    // Those of the second round are all stopped within their first quarter.
    // Before them one settles in two windows.
    const uint64_t settled = (1 + 2) * 64 * 3;
    assert_in_range(one.steps - settled, CANDIDATES * (220 + 20 + 4 * 5), CANDIDATES * (220 + 70));
    for (int threads = 2; threads <= 3; threads++) {
        measure_rounds(&made, threads, &many);
        assert_int_equal(many.steps, one.steps);
        assert_memory_equal(many.errors, one.errors, sizeof one.errors);
        assert_memory_equal(many.positions, one.positions, sizeof one.positions);
    }
    fluid_clear(&made.fluid);
}

/// Where g(r) is 1 by nature, all that a measurement is off by is noise, of which the mean of n has
/// 1/sqrt(n).
static void test_checks_together_have_the_noise_of_their_mean(void **state) {
    (void)state;
    enum { CHECKS = 16 };
    struct made made;
    struct parametrisation parametrisation;
    struct population population;
    struct population_check check;
    double variables[VARIABLES] = {0.5, 0.5, 0.5, 0.5};
    begin(&made);
    made.problem.scene.potential = NULL;
    for (int k = 0; k < BINS; k++)
        made.error[k] = 0;
    const struct population_parameters parameters = {made.parameters, 0};
    assert_ok(mf_parametrisation_init(&parametrisation, &made.problem));
    assert_ok(mf_population_init(&population, &parametrisation, &parameters));
    assert_ok(mf_population_check(&population, variables, CHECKS, 1, &check));
    assert_close_relative(check.error / check.each[TARGET_RDF].rms, 0.25, 0.5);
    assert_close_relative(check.error / check.noise, 1, 0.5);
    assert_int_equal(population.surrogate.rows.added, CHECKS);
    assert_int_equal(population.totals.steps, CHECKS * 220);
    mf_population_clear(&population);
    mf_parametrisation_clear(&parametrisation);
    fluid_clear(&made.fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_evaluate_stops_early_when_a_candidate_cannot_win),
        cmocka_unit_test(test_evaluate_has_the_same_bits_when_it_is_not_stopped),
        cmocka_unit_test(test_evaluate_races_with_fewer_samples_than_looks),
        cmocka_unit_test(test_evaluate_sees_some_windows_before_it_stops),
        cmocka_unit_test(test_evaluate_begins_where_it_is_told),
        cmocka_unit_test(test_evaluate_fails_when_the_temperature_is_another),
        cmocka_unit_test(test_evaluate_knows_how_well_a_temperature_is_known),
        cmocka_unit_test(test_evaluate_settle_leaves_no_heat_of_the_lattice),
        cmocka_unit_test(test_candidates_race_with_the_same_bits_for_any_threads),
        cmocka_unit_test(test_checks_together_have_the_noise_of_their_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
