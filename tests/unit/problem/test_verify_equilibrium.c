// SPDX-License-Identifier: GPL-3.0-or-later
//
// Verifications whose energy and pairs are made up.
#include "observe/rdf_observable.h"
#include "observe/thermodynamics.h"
#include "problem/verify_agreement.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>

enum { REPLICAS = 4, SAMPLES = 40, BLOCKS = 20, BINS = 30 };

struct made {
    struct measurement replicas[REPLICAS];
    struct thermodynamics thermodynamics[REPLICAS];
    struct rdf_observed observed[REPLICAS];
    double series[REPLICAS][THERMODYNAMICS_QUANTITIES * SAMPLES];
    double histogram[REPLICAS][BLOCKS * BINS], samples[BLOCKS];
};

/// With these changes along the samples: of the energy, in its deviations, and as a part of the
/// pairs.
static void make(struct made *made, gsl_rng *rng, double energy, double pairs) {
    for (size_t b = 0; b < BLOCKS; b++)
        made->samples[b] = 2;
    for (size_t k = 0; k < REPLICAS; k++) {
        made->thermodynamics[k] =
            (struct thermodynamics){.series = {.columns = THERMODYNAMICS_QUANTITIES,
                                               .count = SAMPLES,
                                               .capacity = SAMPLES,
                                               .values = made->series[k]}};
        made->observed[k] =
            (struct rdf_observed){.counted = {.bins = {.count = BINS},
                                              .pairs = 1,
                                              .blocks = {.planned = SAMPLES,
                                                         .count = BLOCKS,
                                                         .samples = made->samples,
                                                         .sums = made->histogram[k]}}};
        for (size_t n = 0; n < THERMODYNAMICS_QUANTITIES * SAMPLES; n++)
            made->series[k][n] =
                gsl_ran_gaussian(rng, 1) + energy * (double)(n % SAMPLES) / SAMPLES;
        for (size_t n = 0; n < BLOCKS * BINS; n++)
            made->histogram[k][n] =
                gsl_ran_poisson(rng, 100 * (1 + pairs * (double)(n / BINS) / BLOCKS));
        made->replicas[k] = (struct measurement){0};
        made->replicas[k].use[0] = (struct observable_use){
            .observable = &mf_thermodynamics_observable, .state = &made->thermodynamics[k]};
        made->replicas[k].use[1] =
            (struct observable_use){.observable = &mf_rdf_observable, .state = &made->observed[k]};
    }
}

static void test_verification_in_equilibrium_is_hardly_ever_told_of(void **state) {
    (void)state;
    enum { TRIALS = 1000 };
    static struct made made;
    char text[VERIFY_EQUILIBRIUM_SIZE];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int told = 0;
    for (int k = 0; k < TRIALS; k++) {
        make(&made, rng, 0, 0);
        assert_ok(mf_verify_equilibrium(made.replicas, REPLICAS, text));
        told += text[0] != '\0';
    }
    print_message("%d of %d\n", told, TRIALS);
    assert_in_range(told, 0, 6); // of 1 expected; more than 6 in 10⁴ seeds
    gsl_rng_free(rng);
}

static void test_verification_names_what_has_not_settled(void **state) {
    (void)state;
    static struct made made;
    char text[VERIFY_EQUILIBRIUM_SIZE];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 0, 0.1);
    assert_ok(mf_verify_equilibrium(made.replicas, REPLICAS, text));
    assert_contains(text, "g(r) still changes, ");
    make(&made, rng, 4, 0);
    assert_ok(mf_verify_equilibrium(made.replicas, REPLICAS, text));
    assert_contains(text, " still changes, ");
    make(&made, rng, 0, 0);
    for (size_t n = 0; n < BLOCKS * BINS; n++)
        made.histogram[2][n] *= 1.2; // frozen elsewhere
    assert_ok(mf_verify_equilibrium(made.replicas, REPLICAS, text));
    assert_contains(text, "g(r) differs between replicas, ");
    assert_ok(mf_verify_equilibrium(made.replicas, 1, text));
    assert_string_equal(text, "");
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verification_in_equilibrium_is_hardly_ever_told_of),
        cmocka_unit_test(test_verification_names_what_has_not_settled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
