// SPDX-License-Identifier: GPL-3.0-or-later
//
// A verification that ends when it knows enough.
#include "problem/verify.h"
#include "shared/fluids.h"
#include "shared/testing.h"

#include <math.h>

enum { PARTICLES = 600, BINS = 100, SAMPLES = 240, EVERY = 20, SEEDS = 12 };
static const double time_step = 0.02;

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

static const struct inverse_listener listener = {ignore, NULL};

/// Against a target that is off by `off` everywhere.
static void verify(const double target[BINS], uint64_t seed,
                   const struct verify_parameters *parameters, struct verification *verification) {
    static double errors[BINS];
    double wanted[BINS];
    struct fluid fluid = {0};
    for (int k = 0; k < BINS; k++)
        wanted[k] = target[k];
    fluid_groot_warren(&fluid, PARTICLES, time_step);
    struct inverse_problem problem = {.scene = fluid.setup, .seed = seed, .threads = 2};
    problem.compared.bins = (struct rdf_bins){0, 0.01, BINS};
    problem.compared.target[TARGET_RDF] =
        (struct target){.count = BINS, .value = wanted, .error = errors};
    assert_ok(mf_verify(&problem, &fluid.potential, fluid.setup.omega, parameters, &listener,
                        verification));
    fluid_clear(&fluid);
}

static struct verify_parameters plan(int replicas, bool end_early) {
    return (struct verify_parameters){
        .replicas = replicas,
        .end_early = end_early,
        .plan = {.equilibration = 500, .samples = SAMPLES, .every = EVERY}};
}

/// g of another simulation, twice as long, wrong by a wave.
static void make_target(double wave, double target[BINS]) {
    static const double zero[BINS];
    struct verification verification;
    verify(zero, 99, &(struct verify_parameters){.replicas = 8, .plan = plan(8, false).plan},
           &verification);
    for (int k = 0; k < BINS; k++)
        target[k] = verification.observed.value[TARGET_RDF][k] + wave * cos(0.2 * k);
    mf_verify_clear(&verification);
}

/// What it promises of its errors is judged by how its results scatter: standard deviations over 12
/// seeds are beyond 1.5 of the true ones in 1 of 100.
static void test_verification_ends_when_it_knows_enough(void **state) {
    (void)state;
    const struct verify_parameters parameters = plan(4, true);
    double target[BINS], rms = 0, rms_squares = 0, temperature = 0, temperature_squares = 0;
    uint64_t steps = 0;
    make_target(0.04, target);
    for (int seed = 0; seed < SEEDS; seed++) {
        struct verification verification;
        verify(target, (uint64_t)seed + 1, &parameters, &verification);
        const double own = verification.distance[TARGET_RDF].rms;
        rms += own / SEEDS;
        rms_squares += own * own / SEEDS;
        const double kinetic = verification.thermodynamics.temperature;
        temperature += kinetic / SEEDS;
        temperature_squares += kinetic * kinetic / SEEDS;
        steps += verification.engine_steps;
        mf_verify_clear(&verification);
    }
    const double unbiased = (double)SEEDS / (SEEDS - 1);
    const double rms_scatter = sqrt(unbiased * (rms_squares - rms * rms));
    const double scatter = sqrt(unbiased * (temperature_squares - temperature * temperature));
    const double all = 4.0 * SEEDS * (500 + (double)SAMPLES * EVERY);
    print_message("rms %.4f, scatter %.4f of 0.1 of it; T %.4f, scatter %.5f of 0.00333; %.2f of "
                  "all steps\n",
                  rms, rms_scatter / rms, temperature, scatter, (double)steps / all);
    assert_true(rms_scatter < 1.5 * 0.1 * rms);
    assert_true(scatter < 1.5 / 300);
    assert_true((double)steps < 0.8 * all);
}

/// A sixth of the samples does not know the temperature within a third of a per cent: all are
/// taken.
static void test_verification_that_does_not_know_goes_to_its_end(void **state) {
    (void)state;
    struct verify_parameters few = plan(4, true);
    double target[BINS];
    make_target(0.04, target);
    few.plan.samples = SAMPLES / 6;
    for (int seed = 0; seed < 3; seed++) {
        struct verification verification;
        verify(target, (uint64_t)seed + 1, &few, &verification);
        assert_int_equal(verification.engine_steps,
                         4 * (few.plan.equilibration + few.plan.samples * EVERY));
        mf_verify_clear(&verification);
    }
}

/// Of many bins the rms of noise alone is known soon. It says nothing of the target, and more
/// samples make it less: all are taken.
static void test_noise_is_not_known(void **state) {
    (void)state;
    const struct verify_parameters parameters = plan(4, true);
    struct verification verification;
    double target[BINS];
    make_target(0, target);
    verify(target, 1, &parameters, &verification);
    print_message("rms %.4f(%.0f)\n", verification.distance[TARGET_RDF].rms,
                  1e4 * verification.distance_error[TARGET_RDF]);
    assert_true(verification.distance_error[TARGET_RDF] <
                0.1 * verification.distance[TARGET_RDF].rms);
    assert_int_equal(verification.engine_steps,
                     4 * (parameters.plan.equilibration + parameters.plan.samples * EVERY));
    mf_verify_clear(&verification);
}

/// Looks change no bit: a single simulation never knows its error, and goes to its end.
static void test_looks_leave_no_trace(void **state) {
    (void)state;
    static const double zero[BINS];
    struct verification whole, looked;
    const struct verify_parameters at_once = plan(1, false), in_parts = plan(1, true);
    verify(zero, 3, &at_once, &whole);
    verify(zero, 3, &in_parts, &looked);
    assert_int_equal(whole.engine_steps, looked.engine_steps);
    assert_memory_equal(whole.observed.value[TARGET_RDF], looked.observed.value[TARGET_RDF],
                        BINS * sizeof(double));
    assert_true(whole.thermodynamics.temperature == looked.thermodynamics.temperature);
    mf_verify_clear(&whole);
    mf_verify_clear(&looked);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verification_ends_when_it_knows_enough),
        cmocka_unit_test(test_verification_that_does_not_know_goes_to_its_end),
        cmocka_unit_test(test_noise_is_not_known),
        cmocka_unit_test(test_looks_leave_no_trace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
