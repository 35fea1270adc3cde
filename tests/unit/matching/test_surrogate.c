// SPDX-License-Identifier: GPL-3.0-or-later
//
// The linear model on data that are linear: y = A x + noise, with a target that is A x_true and
// noise of its own.
#include "matching/surrogate.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>
#include <stdlib.h>

enum { VARIABLES = 5, FEATURES = 30, CAPACITY = 60, REPETITIONS = 200 };

/// A made-up experiment. The last variable has no effect if `open`.
struct experiment {
    bool open;
    double spread;      ///< of the rows about the centre
    double noise;       ///< of a row
    double correlation; ///< part of the noise that all features of a row share
    double target_error;
    size_t rows;
};

struct data {
    double slope[FEATURES][VARIABLES], truth[VARIABLES], centre[VARIABLES];
    double target[FEATURES], error[FEATURES], excess[FEATURES];
    struct surrogate surrogate;
};

static double normal(struct rng_sequence *random) {
    const double u = mf_rng_sequence_uniform(random), v = mf_rng_sequence_uniform(random);
    return sqrt(-2 * log(u)) * cos(2 * acos(-1) * v);
}

/// Noise of all features, with the part that they share.
static void make_noise(const struct experiment *e, struct rng_sequence *random, double *noise) {
    const double common = normal(random);
    for (int j = 0; j < FEATURES; j++)
        noise[j] = e->correlation * common + sqrt(1 - pow(e->correlation, 2)) * normal(random);
}

static double answer(const struct data *data, int j, const double *x) {
    double sum = 0.3;
    for (int n = 0; n < VARIABLES; n++)
        sum += data->slope[j][n] * x[n];
    return sum;
}

static void add_row(struct data *data, const struct experiment *e, struct rng_sequence *random) {
    double x[VARIABLES], y[FEATURES], noise[FEATURES];
    for (int n = 0; n < VARIABLES; n++)
        x[n] = data->centre[n] + e->spread * normal(random);
    make_noise(e, random, noise);
    for (int j = 0; j < FEATURES; j++)
        y[j] = answer(data, j, x) + e->noise * noise[j];
    mf_surrogate_add(&data->surrogate, x, y);
}

/// The truth lies `offset` from the centre in every variable.
static void begin(struct data *data, const struct experiment *e, double offset, uint32_t number) {
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_INITIAL, number, 0);
    double noise[FEATURES];
    *data = (struct data){0};
    for (int n = 0; n < VARIABLES; n++) {
        data->centre[n] = 0.5;
        data->truth[n] = 0.5 + (n % 2 ? offset : -offset);
    }
    for (int j = 0; j < FEATURES; j++)
        for (int n = 0; n < VARIABLES; n++)
            data->slope[j][n] = e->open && n == VARIABLES - 1 ? 0 : normal(&random);
    make_noise(e, &random, noise);
    for (int j = 0; j < FEATURES; j++) {
        data->error[j] = e->target_error;
        data->target[j] = answer(data, j, data->truth) + e->target_error * noise[j];
    }
    assert_ok(mf_surrogate_init(&data->surrogate, VARIABLES, FEATURES, CAPACITY, data->target,
                                data->error, data->excess));
    for (size_t k = 0; k < e->rows; k++)
        add_row(data, e, &random);
}

/// Distance of the model's best from the truth in standard errors.
static double deviation(const struct data *data, const struct surrogate_model *model,
                        int variable) {
    return (model->best[variable] - data->truth[variable]) /
           sqrt(model->covariance[variable * (VARIABLES + 1)]);
}

static void fit(const struct data *data, double reach, struct surrogate_model *model) {
    bool known;
    assert_ok(mf_surrogate_fit(&data->surrogate, data->centre, reach, model, &known));
    assert_true(known);
}

static void test_surrogate_finds_the_truth_when_there_is_next_to_no_noise(void **state) {
    (void)state;
    const struct experiment e = {
        .spread = 0.1, .noise = 1e-6, .target_error = 1e-6, .rows = CAPACITY};
    struct data data;
    struct surrogate_model model;
    begin(&data, &e, 0.2, 0);
    fit(&data, 0.3, &model);
    for (int n = 0; n < VARIABLES; n++)
        assert_close(model.best[n], data.truth[n], 2e-3);
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

static void test_surrogate_meets_one_feature_exactly_when_it_is_a_constraint(void **state) {
    (void)state;
    const struct experiment e = {
        .spread = 0.1, .noise = 1e-6, .target_error = 0.1, .rows = CAPACITY};
    struct data data;
    struct surrogate_model model;
    begin(&data, &e, 0.1, 3);
    for (int met = 0; met < 2; met++) {
        data.surrogate.exact = met ? 2 : FEATURES;
        fit(&data, 0.3, &model);
        const double off = fabs(answer(&data, 2, model.best) - data.target[2]);
        // What the others say differs by their errors of 0.1; the model's slopes have a ridge of
        // 1e-3.
        assert_true(met ? off < 1e-3 : off > 1e-2);
        mf_surrogate_model_clear(&model);
    }
    // Where it cannot be met, the step stays within the reach.
    data.target[2] += 100;
    fit(&data, 0.3, &model);
    for (int n = 0; n < VARIABLES; n++)
        assert_true(fabs(model.best[n] - 0.5) < 0.3 * sqrt(VARIABLES));
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

/// The part of the variables of many experiments that lie within two standard errors: 0.954 if
/// these are right. They are estimates from some twenty rows, and may be off by a quarter.
static double coverage(const struct experiment *e, double offset) {
    size_t within = 0, all = 0;
    const int variables = e->open ? VARIABLES - 1 : VARIABLES;
    for (uint32_t number = 0; number < REPETITIONS; number++) {
        struct data data;
        struct surrogate_model model;
        begin(&data, e, offset, number);
        fit(&data, 0.3, &model);
        for (int n = 0; n < variables; n++, all++)
            within += fabs(deviation(&data, &model, n)) <= 2;
        mf_surrogate_model_clear(&model);
        mf_surrogate_clear(&data.surrogate);
    }
    return (double)within / (double)all;
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void test_surrogate_error_of_an_open_variable_is_about_that_of_no_knowledge(void **state) {
    (void)state;
    enum { EXPERIMENTS = 41 };
    static const double noises[] = {0.01, 0.1}, correlations[] = {0, 0.7};
    for (int k = 0; k < 4; k++) {
        double known[EXPERIMENTS], open[EXPERIMENTS];
        const struct experiment e = {.open = true,
                                     .spread = 0.1,
                                     .noise = noises[k / 2],
                                     .correlation = correlations[k % 2],
                                     .target_error = 0.01,
                                     .rows = CAPACITY};
        for (uint32_t number = 0; number < EXPERIMENTS; number++) {
            struct data data;
            struct surrogate_model model;
            begin(&data, &e, 0.1, number);
            fit(&data, 0.3, &model);
            known[number] = sqrt(model.covariance[0]);
            open[number] = sqrt(model.covariance[VARIABLES * VARIABLES - 1]);
            mf_surrogate_model_clear(&model);
            mf_surrogate_clear(&data.surrogate);
        }
        qsort(known, EXPERIMENTS, sizeof *known, by_size);
        qsort(open, EXPERIMENTS, sizeof *open, by_size);
        assert_true(open[EXPERIMENTS / 2] > 0.2 && open[EXPERIMENTS / 2] <= 0.3);
        assert_true(known[EXPERIMENTS / 2] < 0.2 * open[EXPERIMENTS / 2]);
    }
}

/// One row in ten is wild, as a candidate that has frozen is: errors hardly grow, and hold the
/// truth.
static void test_surrogate_errors_do_not_follow_a_few_wild_rows(void **state) {
    (void)state;
    enum { EXPERIMENTS = 100, WILD = CAPACITY / 10 };
    const struct experiment tame = {
        .spread = 0.1, .noise = 0.01, .target_error = 0.01, .rows = CAPACITY - WILD};
    const struct experiment wild = {.spread = 0.1, .noise = 3};
    double ratio = 0, squares = 0;
    for (uint32_t number = 0; number < EXPERIMENTS; number++) {
        struct data data;
        struct surrogate_model without, with;
        struct rng_sequence random = mf_rng_sequence_begin(11, RNG_INITIAL, number, 0);
        begin(&data, &tame, 0.1, number);
        fit(&data, 0.3, &without);
        for (int k = 0; k < WILD; k++)
            add_row(&data, &wild, &random);
        fit(&data, 0.3, &with);
        for (int n = 0; n < VARIABLES; n++) {
            ratio += sqrt(with.covariance[n * (VARIABLES + 1)] /
                          without.covariance[n * (VARIABLES + 1)]) /
                     (VARIABLES * EXPERIMENTS);
            squares += pow(deviation(&data, &without, n), 2) / (VARIABLES * EXPERIMENTS);
        }
        mf_surrogate_model_clear(&without);
        mf_surrogate_model_clear(&with);
        mf_surrogate_clear(&data.surrogate);
    }
    print_message("errors grow by %.2f; rms deviation without %.2f errors\n", ratio, sqrt(squares));
    assert_true(ratio < 1.5);
    assert_in_range((int)(100 * sqrt(squares)), 70, 130);
}

static void test_surrogate_is_not_known_when_there_are_too_few_rows(void **state) {
    (void)state;
    const struct experiment e = {.spread = 0.1, .noise = 0.01, .target_error = 0.01};
    struct data data;
    struct surrogate_model model;
    struct rng_sequence random = mf_rng_sequence_begin(9, RNG_INITIAL, 0, 0);
    bool known = true;
    begin(&data, &e, 0.1, 0);
    for (size_t k = 0; k + 1 < mf_surrogate_min_rows(VARIABLES); k++)
        add_row(&data, &e, &random);
    assert_ok(mf_surrogate_fit(&data.surrogate, data.centre, 0.3, &model, &known));
    assert_false(known);
    assert_null(model.best);
    mf_surrogate_model_clear(&model);
    add_row(&data, &e, &random);
    assert_ok(mf_surrogate_fit(&data.surrogate, data.centre, 0.3, &model, &known));
    assert_true(known);
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

/// Old rows of another experiment are gone once as many new ones have come as there is room for.
static void test_surrogate_forgets_the_oldest_rows_when_it_is_full(void **state) {
    (void)state;
    const struct experiment e = {.spread = 0.1, .noise = 0.01, .target_error = 0.01};
    const struct experiment wild = {.spread = 0.1, .noise = 10, .target_error = 0.01};
    struct data data, fresh;
    struct surrogate_model model, expected;
    begin(&data, &e, 0.1, 0);
    begin(&fresh, &e, 0.1, 0);
    struct rng_sequence old = mf_rng_sequence_begin(9, RNG_INITIAL, 0, 0);
    struct rng_sequence one = mf_rng_sequence_begin(9, RNG_INITIAL, 1, 0), two = one;
    for (int k = 0; k < 7; k++)
        add_row(&data, &wild, &old);
    for (int k = 0; k < CAPACITY; k++) {
        add_row(&data, &e, &one);
        add_row(&fresh, &e, &two);
    }
    assert_int_equal(data.surrogate.rows.added, CAPACITY + 7);
    fit(&data, 0.3, &model);
    fit(&fresh, 0.3, &expected);
    for (int n = 0; n < VARIABLES; n++)
        assert_close(model.best[n], expected.best[n], 1e-9);
    mf_surrogate_model_clear(&model);
    mf_surrogate_model_clear(&expected);
    mf_surrogate_clear(&data.surrogate);
    mf_surrogate_clear(&fresh.surrogate);
}

static void test_surrogate_stays_within_the_range_when_the_target_is_beyond(void **state) {
    (void)state;
    const struct experiment e = {
        .spread = 0.1, .noise = 0.001, .target_error = 0.001, .rows = CAPACITY};
    struct data data;
    struct surrogate_model model;
    begin(&data, &e, 0.9, 0);
    fit(&data, 3, &model);
    for (int n = 0; n < VARIABLES; n++)
        assert_close(model.best[n], n % 2 ? 1 : 0, 0);
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

static void test_surrogate_is_the_same_from_its_spans(void **state) {
    (void)state;
    const struct experiment e = {
        .spread = 0.1, .noise = 0.01, .target_error = 0.01, .rows = CAPACITY + 5};
    struct experiment empty = e;
    struct data data, copy;
    struct memory_span from[SURROGATE_SPANS], to[SURROGATE_SPANS];
    struct surrogate_model model, again;
    empty.rows = 0;
    begin(&data, &e, 0.1, 0);
    begin(&copy, &empty, 0.1, 0);
    assert_int_equal(mf_surrogate_spans(&data.surrogate, from), SURROGATE_SPANS);
    assert_int_equal(mf_surrogate_spans(&copy.surrogate, to), SURROGATE_SPANS);
    for (int k = 0; k < SURROGATE_SPANS; k++) {
        assert_int_equal(from[k].bytes, to[k].bytes);
        memcpy(to[k].memory, from[k].memory, from[k].bytes);
    }
    fit(&data, 0.3, &model);
    fit(&copy, 0.3, &again);
    for (int n = 0; n < VARIABLES * VARIABLES; n++)
        assert_identical(model.covariance[n], again.covariance[n]);
    mf_surrogate_model_clear(&model);
    mf_surrogate_model_clear(&again);
    mf_surrogate_clear(&data.surrogate);
    mf_surrogate_clear(&copy.surrogate);
}

static void test_surrogate_errors_hold_the_truth_as_often_as_they_say(void **state) {
    (void)state;
    static const double offsets[] = {0, 0.1, 0.2};
    static const double correlations[] = {0, 0.7};
    static const double target_errors[] = {0.003, 0.03, 0.3};
    for (int o = 0; o < 3; o++)
        for (int c = 0; c < 2; c++)
            for (int t = 0; t < 3; t++) {
                const struct experiment e = {.spread = 0.1,
                                             .noise = 0.1,
                                             .correlation = correlations[c],
                                             .target_error = target_errors[t],
                                             .rows = CAPACITY};
                const double found = coverage(&e, offsets[o]);
                if (found < 0.89 || found > 0.998)
                    fail_msg("%.3f within two standard errors: offset %g, correlation %g, target "
                             "%g",
                             found, offsets[o], e.correlation, e.target_error);
            }
}

/// What has been measured again and again at one place, or nearly so, says nothing of slopes.
static void test_surrogate_knows_nothing_when_all_rows_are_at_one_place(void **state) {
    (void)state;
    static const double spreads[] = {0, 1e-12, 1e-7};
    for (int k = 0; k < 3; k++) {
        const struct experiment e = {
            .spread = spreads[k], .noise = 0.01, .target_error = 0.01, .rows = CAPACITY};
        struct data data;
        struct surrogate_model model;
        begin(&data, &e, 0.1, 0);
        fit(&data, 0.3, &model);
        for (int n = 0; n < VARIABLES; n++) {
            const double error = sqrt(model.covariance[n * (VARIABLES + 1)]);
            assert_true(model.best[n] >= 0 && model.best[n] <= 1);
            assert_true(error > 0.15 && error <= 0.3);
        }
        mf_surrogate_model_clear(&model);
        mf_surrogate_clear(&data.surrogate);
    }
}

/// Two features alone depend on two variables, by slopes of the test's own, and are to be `target`.
static void begin_plain(struct data *data, double slope[2][2], const double target[2]) {
    const struct experiment e = {.spread = 0.05, .noise = 1e-6, .target_error = 1e-3};
    struct rng_sequence random = mf_rng_sequence_begin(9, RNG_INITIAL, 0, 0);
    begin(data, &e, 0, 0);
    memset(data->slope, 0, sizeof data->slope);
    for (int j = 0; j < FEATURES; j++) {
        for (int n = 0; n < 2 && j < 2; n++)
            data->slope[j][n] = slope[j][n];
        data->target[j] = j < 2 ? 0.3 + target[j] : 0.3;
    }
    for (int k = 0; k < CAPACITY; k++)
        add_row(data, &e, &random);
}

/// x + y is known much better than x − y, and both would be met at x = 1.4, y = 0. With x at its
/// bound of 1, y makes up for it: a step that is merely cut off would leave y where it was.
static void test_surrogate_steps_make_up_for_a_variable_at_its_bound(void **state) {
    (void)state;
    struct data data;
    struct surrogate_model model;
    begin_plain(&data, (double[2][2]){{4, 4}, {0.5, -0.5}}, (const double[2]){5.6, 0.7});
    data.error[0] = data.error[1] = 0.05;
    data.centre[0] = 0.9;
    data.centre[1] = 0.1;
    fit(&data, 1, &model);
    assert_close(model.best[0], 1, 1e-9);
    assert_close(model.best[1], 0.4, 0.02);
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

/// Two features want the same variable at 0.4 and at 0.6: by their statistics the sharper wins, by
/// weights of 1 and 1/2 of what is missed x = (4 · 0.4 + 0.6)/5.
static void test_surrogate_weighs_what_cannot_be_met_by_its_weight(void **state) {
    (void)state;
    struct data data;
    struct surrogate_model model;
    begin_plain(&data, (double[2][2]){{1, 0}, {1, 0}}, (const double[2]){0.4, 0.6});
    data.error[1] = 1e-4;
    fit(&data, 1, &model);
    assert_close(model.best[0], 0.6, 0.005);
    mf_surrogate_model_clear(&model);
    data.excess[0] = 0.01;
    data.excess[1] = 0.04;
    fit(&data, 1, &model);
    assert_close(model.best[0], 0.44, 0.02);
    mf_surrogate_model_clear(&model);
    mf_surrogate_clear(&data.surrogate);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_surrogate_finds_the_truth_when_there_is_next_to_no_noise),
        cmocka_unit_test(test_surrogate_meets_one_feature_exactly_when_it_is_a_constraint),
        cmocka_unit_test(test_surrogate_errors_hold_the_truth_as_often_as_they_say),
        cmocka_unit_test(test_surrogate_error_of_an_open_variable_is_about_that_of_no_knowledge),
        cmocka_unit_test(test_surrogate_errors_do_not_follow_a_few_wild_rows),
        cmocka_unit_test(test_surrogate_is_not_known_when_there_are_too_few_rows),
        cmocka_unit_test(test_surrogate_forgets_the_oldest_rows_when_it_is_full),
        cmocka_unit_test(test_surrogate_stays_within_the_range_when_the_target_is_beyond),
        cmocka_unit_test(test_surrogate_steps_make_up_for_a_variable_at_its_bound),
        cmocka_unit_test(test_surrogate_weighs_what_cannot_be_met_by_its_weight),
        cmocka_unit_test(test_surrogate_knows_nothing_when_all_rows_are_at_one_place),
        cmocka_unit_test(test_surrogate_is_the_same_from_its_spans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
