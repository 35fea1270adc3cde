// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an iteration tells while it doubles its samples, on the ideal gas that meets its target: all
// that is off is noise, which each doubling makes sqrt(2) times smaller.
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 10, PARTICLES = 100, REPLICAS = 4, MAX_WORDS = 64 };

struct told {
    struct inverse_progress word[MAX_WORDS];
    int words;
    double memory;   ///< of the samples before [sweeps]; 0: there were none
    uint64_t sweeps; ///< of all replicas
};

static void hear(void *context, const struct inverse_progress *progress) {
    struct told *told = context;
    assert_true(told->words < MAX_WORDS);
    told->word[told->words++] = *progress;
}

/// What is told of one iteration whose target is this g, 1 of the ideal gas, and that asks for this
/// noise of it, and for a pressure with such an error, if it is not 0; returns the noise that is
/// left.
/// @param[in,out] pressure  what is asked for, then that of the samples
static double observe_with(double target, double precision, double *pressure, double pressure_error,
                           struct told *told) {
    double g[BINS], error[BINS];
    struct fluid fluid;
    struct inversion *inversion = calloc(1, sizeof *inversion);
    assert_non_null(inversion);
    fluid_ideal_gas(&fluid, 3, PARTICLES, 0.01);
    for (int k = 0; k < BINS; k++) {
        g[k] = target;
        error[k] = 1e-4;
    }
    const struct inverse_problem problem = {
        .targets = {.bins = {0, 0.2, BINS},
                    .target = {[TARGET_RDF] = {.count = BINS, .value = g, .error = error},
                               [TARGET_PRESSURE] = {.count = pressure_error > 0,
                                                    .value = pressure,
                                                    .error = &pressure_error}}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 1};
    const struct inversion_parameters settings = {.replicas = REPLICAS,
                                                  .equilibration = 10,
                                                  .samples = 8,
                                                  .every = 8,
                                                  .iterations = 2,
                                                  .damping = 1,
                                                  .precision = precision,
                                                  .start = INVERSION_FROM_MEAN_FORCE};
    *told = (struct told){.memory = told->memory};
    assert_ok(mf_inversion_create(inversion, &mf_imc, &problem, &settings));
    inversion->state->work.memory = told->memory;
    inversion->course.progress.from_disorder = !(told->memory > 0);
    assert_ok(mf_inversion_observe(inversion, &(struct inverse_listener){hear, told}));
    const double noise = inversion->assessment.own_noise;
    told->sweeps = inversion->state->work.sweeps;
    if (pressure)
        *pressure = inversion->state->bulk.pressure;
    mf_inversion_destroy(inversion);
    free(inversion);
    fluid_clear(&fluid);
    return noise;
}

static double observe(double target, double precision, struct told *told) {
    return observe_with(target, precision, NULL, 0, told);
}

static void test_no_doubling_is_told_where_the_first_samples_are_enough(void **state) {
    (void)state;
    static struct told told;
    observe(1, 1, &told);
    assert_int_equal(told.words, REPLICAS);
    for (int k = 0; k < told.words; k++)
        assert_int_equal(told.word[k].doubling.number, 0);
}

static void test_doublings_tell_a_noise_that_falls_to_what_is_wanted(void **state) {
    (void)state;
    static struct told told;
    const double first = observe(1, 1, &told), wanted = first / 3;
    const double left = observe(1, wanted, &told);
    print_message("noise %.4f, wanted %.4f, left %.4f\n", first, wanted, left);
    assert_true(left <= wanted);
    int number = 0;
    for (int k = REPLICAS; k < told.words; k++) {
        const struct inverse_doubling *now = &told.word[k].doubling;
        // Once before the doubling, once after each replica.
        assert_int_equal(now->number, 1 + (k - REPLICAS) / (1 + REPLICAS));
        assert_in_range(now->number, 1, now->max);
        // A third of what is off, which is the noise of now, while that is more.
        assert_true(now->wanted >= wanted && now->wanted < 2 * wanted);
        assert_true(now->noise > now->wanted);
        const double expected = first / pow(2, (now->number - 1) / 2.0);
        assert_true(now->noise > expected / 1.7 && now->noise < expected * 1.7);
        assert_string_equal(now->unit, "");
        number = now->number;
    }
    // Of a third of the noise: 9 times as many samples.
    assert_in_range(number, 3, 5);
}

static void test_doublings_end_with_the_last_that_was_told(void **state) {
    (void)state;
    static struct told told;
    const double wanted = 1e-6, left = observe(1, wanted, &told);
    const struct inverse_doubling *last = &told.word[told.words - 1].doubling;
    assert_int_equal(last->number, last->max);
    assert_true(left > wanted);
    assert_int_equal(told.words, REPLICAS + last->max * (1 + REPLICAS));
}

/// Replicas that go on with another potential forget the one before: four memories, or the 10
/// sweeps of the parameters if these are fewer, but never less than one and a half; from disorder
/// twice the parameters.
static void test_replicas_forget_for_as_long_as_they_remember(void **state) {
    static const struct {
        double memory;
        uint64_t equilibration;
    } cases[] = {{0, 20}, {1, 4}, {5, 10}, {8, 12}, {100, 150}};
    enum { SAMPLED = 8 * 8 };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct told told = {.memory = cases[k].memory};
        observe(1, 1, &told);
        assert_int_equal(told.sweeps, REPLICAS * (SAMPLED + cases[k].equilibration));
    }
}

/// The innermost bin has so few pairs that its noise, over all bins, is more than a third of what g
/// is off; the others tell that it is off, and by how much.
static void test_bins_with_few_pairs_do_not_decide(void **state) {
    (void)state;
    static struct told told;
    const double noise = observe(0.86, 1e-6, &told);
    print_message("noise %.3f of 0.14\n", noise);
    assert_true(noise > 0.14 / 3);
    assert_int_equal(told.words, REPLICAS);
}

/// Where g asks for no more samples, a pressure does, until its error is that of its target; what
/// is asked for more exactly than all samples tell costs a few doublings.
static void test_a_pressure_doubles_samples(void **state) {
    enum { MOST = 4 };
    (void)state;
    static struct told told;
    double pressure = 1;
    observe_with(0.99, 1, &pressure, 10, &told);
    assert_int_equal(told.words, REPLICAS);
    const double wanted = pressure; // so that the first samples meet it
    observe_with(0.99, 1, &pressure, 1e-9, &told);
    assert_int_equal(told.words, REPLICAS + MOST * (1 + REPLICAS));
    for (int k = REPLICAS; k < told.words; k++)
        assert_string_equal(told.word[k].doubling.unit, "k_B T_0/lambda^d");
    const double error = told.word[REPLICAS].doubling.noise;
    pressure = wanted;
    observe_with(0.99, 1, &pressure, error / 1.7, &told);
    print_message("error of the pressure %.3g, %d words\n", error, told.words);
    assert_in_range(told.words, REPLICAS + 1 + REPLICAS, REPLICAS + 3 * (1 + REPLICAS));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_doubling_is_told_where_the_first_samples_are_enough),
        cmocka_unit_test(test_doublings_tell_a_noise_that_falls_to_what_is_wanted),
        cmocka_unit_test(test_doublings_end_with_the_last_that_was_told),
        cmocka_unit_test(test_replicas_forget_for_as_long_as_they_remember),
        cmocka_unit_test(test_bins_with_few_pairs_do_not_decide),
        cmocka_unit_test(test_a_pressure_doubles_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
