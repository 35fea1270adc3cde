// SPDX-License-Identifier: GPL-3.0-or-later
//
// What has not settled of samples that are made up.
#include "inversion/inversion.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <math.h>

enum { REPLICAS = 8, BINS = 12, NUMBERS = BINS + SAMPLER_SUMS };

struct made {
    struct inversion inversion;
    struct inversion_unsettled found;
    size_t known_bin[BINS];
    double block[REPLICAS][REPLICAS_BLOCKS * NUMBERS];
    double mean[NUMBERS], comoment[NUMBERS * NUMBERS];
};

/// Blocks of unit variance; one number changes along them, by so much in all.
static void make(struct made *made, gsl_rng *rng, size_t number, double change) {
    *made = (struct made){
        .inversion = {
            .bins = BINS, .grid.known = BINS, .sections = 1, .section[0] = {.known_count = BINS}}};
    struct replicas *replicas = &made->inversion.replicas;
    *replicas = (struct replicas){
        .bins = BINS,
        .numbers = NUMBERS,
        .count = REPLICAS,
        .counts = {.size = NUMBERS, .count = 10, .mean = made->mean, .comoment = made->comoment}};
    made->inversion.grid.known_bin = made->known_bin;
    for (size_t n = 0; n < NUMBERS; n++)
        made->comoment[n * NUMBERS + n] = 10;
    for (size_t n = 0; n < BINS; n++)
        made->known_bin[n] = n;
    for (size_t k = 0; k < REPLICAS; k++) {
        replicas->member[k].block = made->block[k];
        for (size_t n = 0; n < REPLICAS_BLOCKS * NUMBERS; n++)
            made->block[k][n] =
                gsl_ran_gaussian(rng, 1) +
                (n % NUMBERS == number ? change * (double)(n / NUMBERS) / REPLICAS_BLOCKS : 0);
    }
}

static void test_settled_samples_are_hardly_ever_found_not_to_be(void **state) {
    (void)state;
    enum { TRIALS = 2000 };
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int found = 0;
    for (int k = 0; k < TRIALS; k++) {
        make(&made, rng, 0, 0);
        assert_ok(mf_inversion_settled_judge(&made.inversion, &made.found));
        found += made.found.found;
    }
    print_message("%d of %d\n", found, TRIALS);
    assert_in_range(found, 0, 8); // of 2 expected; more than 8 in 4000 seeds
    gsl_rng_free(rng);
}

static void test_what_has_not_settled_is_named(void **state) {
    (void)state;
    static struct made made;
    static const struct {
        size_t number;
        const char *name;
    } kind[] = {{BINS + SAMPLER_VIRIAL, "the pressure"},
                {BINS + SAMPLER_ENERGY, "the energy"},
                {BINS + SAMPLER_GYRATION, "R_g^2 of the molecules"},
                {BINS + SAMPLER_ENDS, "R_e^2 of the molecules"},
                {3, "g(r)"}};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (size_t k = 0; k < sizeof kind / sizeof *kind; k++) {
        make(&made, rng, kind[k].number, 12);
        assert_ok(mf_inversion_settled_judge(&made.inversion, &made.found));
        assert_true(made.found.found && made.found.drifts);
        assert_string_equal(made.found.quantity, kind[k].name);
    }
    make(&made, rng, 0, 0);
    for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
        made.block[5][b * NUMBERS + BINS + SAMPLER_ENERGY] += 12;
    assert_ok(mf_inversion_settled_judge(&made.inversion, &made.found));
    assert_true(made.found.found && !made.found.drifts);
    assert_string_equal(made.found.quantity, "the energy");
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_settled_samples_are_hardly_ever_found_not_to_be),
        cmocka_unit_test(test_what_has_not_settled_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
