// SPDX-License-Identifier: GPL-3.0-or-later
//
// What has not settled of samples that are made up.
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REPLICAS = 8, BINS = 12, NUMBERS = BINS + SAMPLER_SUMS };

struct made {
    struct inversion_state state;
    struct inversion_unequilibrated found;
    size_t known_bin[BINS];
    double block[REPLICAS][REPLICAS_BLOCKS * NUMBERS];
    double mean[NUMBERS], comoment[NUMBERS * NUMBERS];
};

/// Blocks of unit variance; one number changes along them, by so much in all.
static void make(struct made *made, gsl_rng *rng, size_t number, double change) {
    *made = (struct made){
        .state = {.bins = BINS,
                  .grid.known = BINS,
                  .assessment = {.sections = 1, .section[0] = {.known_count = BINS}}}};
    struct replicas *replicas = &made->state.replicas;
    *replicas = (struct replicas){
        .bins = BINS,
        .numbers = NUMBERS,
        .count = REPLICAS,
        .counts = {.size = NUMBERS, .count = 10, .mean = made->mean, .comoment = made->comoment}};
    made->state.grid.known_bin = made->known_bin;
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

static void test_equilibrium_samples_are_hardly_ever_found_not_to_be(void **state) {
    (void)state;
    enum { TRIALS = 2000 };
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int found = 0;
    for (int k = 0; k < TRIALS; k++) {
        make(&made, rng, 0, 0);
        assert_ok(mf_inversion_equilibrium_check(&made.state, &made.found));
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
        bool beside_sizes;
    } kind[] = {{BINS + SAMPLER_VIRIAL, "the pressure", true},
                {BINS + SAMPLER_ENERGY, "the energy", true},
                {BINS + SAMPLER_GYRATION, "R_g^2 of the molecules", false},
                {BINS + SAMPLER_ENDS, "R_e^2 of the molecules", false},
                {BINS + SAMPLER_WAVES, "the longest waves of the types", true},
                {3, "g(r)", true}};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (size_t k = 0; k < sizeof kind / sizeof *kind; k++) {
        make(&made, rng, kind[k].number, 12);
        assert_ok(mf_inversion_equilibrium_check(&made.state, &made.found));
        assert_true(made.found.found && made.found.drifts);
        assert_string_equal(made.found.quantity, kind[k].name);
        assert_true(made.found.beside_sizes == kind[k].beside_sizes);
    }
    make(&made, rng, 0, 0);
    for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
        made.block[5][b * NUMBERS + BINS + SAMPLER_ENERGY] += 12;
    assert_ok(mf_inversion_equilibrium_check(&made.state, &made.found));
    assert_true(made.found.found && !made.found.drifts);
    assert_string_equal(made.found.quantity, "the energy");
    gsl_rng_free(rng);
}

/// What differs between replicas is noise after they have been alike once since they were placed;
/// what changes along the samples never is.
static void test_what_replicas_remember_is_noise_once_they_have_mixed(void **state) {
    (void)state;
    static struct made made;
    struct inversion_unequilibrated *unequilibrated = &made.state.assessment.unequilibrated;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int mixed = 0; mixed < 2; mixed++) {
        make(&made, rng, 0, 0);
        for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
            made.block[5][b * NUMBERS + 3] += 12;
        made.state.work.mixed = mixed;
        assert_ok(mf_inversion_equilibrium_check(&made.state, unequilibrated));
        mf_inversion_equilibrium_reset(&made.state);
        assert_true(unequilibrated->found == !mixed);
        make(&made, rng, 3, 12);
        made.state.work.mixed = mixed;
        assert_ok(mf_inversion_equilibrium_check(&made.state, unequilibrated));
        mf_inversion_equilibrium_reset(&made.state);
        assert_true(unequilibrated->found);
    }
    make(&made, rng, 0, 0);
    assert_ok(mf_inversion_equilibrium_check(&made.state, unequilibrated));
    mf_inversion_equilibrium_reset(&made.state);
    assert_true(made.state.work.mixed);
    gsl_rng_free(rng);
}

/// What replicas that began on both sides remember for ever does not matter where they scatter by
/// much less than what was asked for; where they drift or are apart, or began alike, it does.
static void test_what_is_remembered_may_be_too_little_to_matter(void **state) {
    (void)state;
    static const struct {
        double noise; ///< of a precision of 0.003
        bool sides, drifts, apart, settled;
    } cases[] = {{0.0009, true, false, false, true},
                 {0.0011, true, false, false, false},
                 {0.0009, false, false, false, false},
                 {0.0009, true, true, false, false},
                 {0.0009, true, false, true, false}};
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct inversion_section *section = &made.state.assessment.section[0];
        struct inversion_unequilibrated *is = &made.state.assessment.unequilibrated;
        make(&made, rng, 0, 0);
        made.state.replicas.begins[REPLICAS_STRETCH] = cases[k].sides;
        section->own_noise = cases[k].noise;
        section->precision = 0.003;
        *is = (struct inversion_unequilibrated){
            .found = true, .drifts = cases[k].drifts, .apart = cases[k].apart};
        mf_inversion_equilibrium_reset(&made.state);
        assert_int_equal(is->found, !cases[k].settled);
    }
    gsl_rng_free(rng);
}

/// Replicas that remember for a part of their samples (Ornstein and Uhlenbeck), and began on both
/// sides of what they have come to.
static void make_slow(struct made *made, gsl_rng *rng, double time, double side) {
    enum { STEPS = 64 };
    make(made, rng, 0, 0);
    made->state.replicas.begins[REPLICAS_STRETCH] = made->state.replicas.begins[REPLICAS_TILT] =
        true;
    const double decay = exp(-1 / (time * REPLICAS_BLOCKS * STEPS));
    for (size_t k = 0; k < REPLICAS; k++) {
        double x = gsl_ran_gaussian(rng, 1);
        for (size_t b = 0; b < REPLICAS_BLOCKS; b++) {
            double *mean = &made->block[k][b * NUMBERS + BINS + SAMPLER_WAVES];
            *mean = side * replicas_side(k, REPLICAS_TILT);
            for (int step = 0; step < STEPS; step++) {
                *mean += x / STEPS;
                x = decay * x + gsl_ran_gaussian(rng, sqrt(1 - decay * decay));
            }
        }
    }
}

/// How many of 500 such samples are taken as they are; of how many the halves are apart.
static int count_mixed(gsl_rng *rng, double time, double side, int *apart) {
    static struct made made;
    struct inversion_unequilibrated *unequilibrated = &made.state.assessment.unequilibrated;
    int mixed = 0;
    *apart = 0;
    for (int trial = 0; trial < 500; trial++) {
        make_slow(&made, rng, time, side);
        assert_ok(mf_inversion_equilibrium_check(&made.state, unequilibrated));
        mf_inversion_equilibrium_reset(&made.state);
        mixed += !unequilibrated->found;
        *apart += unequilibrated->apart;
        assert_false(unequilibrated->apart && !unequilibrated->found);
    }
    return mixed;
}

static void test_replicas_are_draws_of_equilibrium_when_they_forgot_where_they_began(void **state) {
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static const double times[] = {0.1, 0.25, 0.5, 1, 2, 4};
    int mixed[6], apart;
    for (int k = 0; k < 6; k++) {
        mixed[k] = count_mixed(rng, times[k], 0, &apart);
        print_message("%g of the samples: %d of 500, apart %d\n", times[k], mixed[k], apart);
        assert_in_range(apart, 1, 25); // 0.05 at most
    }
    const int far = count_mixed(rng, 0.25, 2, &apart);
    print_message("but four times their scatter apart: %d, apart %d\n", far, apart);
    assert_in_range(apart, 450, 500);
    assert_true(mixed[0] > 450 && mixed[1] > 430);
    assert_true(mixed[4] < 60 && mixed[5] < 10);
    assert_true(far < 25);
    gsl_rng_free(rng);
}

/// One value of each replica is left of what lasts longer than its samples.
static void test_slowest_number_is_told_with_its_independent_samples(void **state) {
    (void)state;
    enum { TRIALS = 200 };
    static struct made made;
    struct inverse_slowest slowest, of_other = {.quantity = "g(r)", .independent = 1};
    double sum = 0;
    int named = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < TRIALS; trial++) {
        make_slow(&made, rng, 16, 0);
        made.state.replicas.counts.count = 1000;
        for (size_t n = 0; n < NUMBERS; n++)
            made.comoment[n * NUMBERS + n] = 1000;
        slowest = (struct inverse_slowest){0};
        mf_inversion_equilibrium_slowest(&made.state, &slowest);
        named += strcmp(slowest.quantity, "the longest waves of the types") == 0;
        sum += 1 / slowest.independent;
    }
    mf_inversion_equilibrium_slowest(&made.state, &of_other); // another state's is slower
    made.state.open.independent = slowest.independent / 2;
    mf_inversion_equilibrium_slowest(&made.state, &slowest);
    assert_string_equal(slowest.quantity, "the potential's ramp");
    assert_true(of_other.independent == 1 && strcmp(of_other.quantity, "g(r)") == 0);
    print_message("%.2f independent samples, named in %d of %d\n", TRIALS / sum, named, TRIALS);
    assert_true(named > 0.8 * TRIALS);
    assert_true(fabs(TRIALS / sum - 8) < 1.5);
    gsl_rng_free(rng);
}

/// Replicas whose means scatter by 2 about the truth, with blocks of unit variance: the mean of all
/// is off by sqrt((4 + 1/4)/8). By blocks alone it would be known twice as well.
static void test_error_of_samples_is_that_of_replicas_that_remember(void **state) {
    (void)state;
    enum { TRIALS = 400 };
    static struct made made;
    double blocks = 0, whole = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < TRIALS; trial++) {
        make(&made, rng, 0, 0);
        for (size_t k = 0; k < REPLICAS; k++)
            for (size_t n = 0; n < BINS; n++) {
                const double off = gsl_ran_gaussian(rng, 2);
                for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
                    made.block[k][b * NUMBERS + n] += off;
            }
        const struct replicas *replicas = &made.state.replicas;
        blocks += mf_replicas_inefficiency(replicas, REPLICAS_BLOCKS, made.known_bin, BINS) /
                  replicas->counts.count / TRIALS;
        whole += mf_replicas_inefficiency(replicas, 1, made.known_bin, BINS) /
                 replicas->counts.count / TRIALS;
    }
    print_message("variance %.3f by replicas, %.3f by blocks; 4.25/8 is right\n", whole, blocks);
    assert_true(fabs(whole - 4.25 / 8) < 0.02);
    assert_true(blocks < 0.5 * whole);
    gsl_rng_free(rng);
}

/// A change of a number along the samples is how far it may be off, and so is the standard error of
/// its mean by replicas of which one is elsewhere, 12/8; noise alone, of unit variance in each
/// block, is none on average: its squares are 0.4 and 1/32, and of 2000 the mean has an error of
/// 0.013.
static void test_shift_is_the_way_along_the_samples_and_the_scatter_of_replicas(void **state) {
    (void)state;
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 3, 12);
    const struct replicas *replicas = &made.state.replicas;
    double noise = 0, apart = 0;
    assert_true(fabs(sqrt(mf_inversion_equilibrium_shift(replicas, 3)) - 12) < 2);
    enum { TRIALS = 2000 };
    for (int k = 0; k < TRIALS; k++) {
        make(&made, rng, 0, 0);
        noise += mf_inversion_equilibrium_shift(replicas, 4) / TRIALS;
        for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
            made.block[5][b * NUMBERS + 4] += 12;
        apart += mf_inversion_equilibrium_shift(replicas, 4) / TRIALS;
    }
    print_message("noise %.3f, apart %.3f\n", noise, apart);
    assert_true(fabs(noise) < 0.07);
    assert_true(fabs(apart - 1.5 * 1.5) < 0.15);
    gsl_rng_free(rng);
}

/// One of twelve bins changes by 12 along the samples: rms 3.5.
static void
test_samples_tell_the_way_to_a_target_that_is_far_from_what_has_not_settled(void **state) {
    (void)state;
    static struct made made;
    double variance[BINS], wanted = 0;
    bool seen[BINS];
    struct inverse_problem problem = {.targets.target[TARGET_RDF].count = BINS};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 3, 12);
    struct inversion_state *samples = &made.state;
    struct inversion_section *section = &samples->assessment.section[0];
    samples->problem = &problem;
    samples->variance = variance;
    samples->grid.seen = seen;
    samples->gradient = INFINITY;
    samples->box = (struct box){3, {1, 1, 1}};
    for (size_t n = 0; n < BINS; n++)
        variance[n] = seen[n] = 1;
    section->probable = 1;
    section->misfit = 6 * 6;
    assert_false(mf_inversion_is_far_beyond_drift(samples));
    section->misfit = 8 * 8;
    assert_true(mf_inversion_is_far_beyond_drift(samples));
    samples->basis.count = 1; // g may be off for want of coefficients
    assert_false(mf_inversion_is_far_beyond_drift(samples));
    samples->basis.count = 0;
    section->misfit = 1; // agreement of what may be elsewhere tells nothing
    assert_false(mf_inversion_is_far_beyond_drift(samples));
    section->misfit = 14 * 14;
    // The pressure changes by 12/(3 V).
    for (size_t k = 0; k < REPLICAS; k++)
        for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
            made.block[k][b * NUMBERS + BINS + SAMPLER_VIRIAL] +=
                12.0 * (double)b / REPLICAS_BLOCKS;
    problem.targets.target[TARGET_PRESSURE] = (struct target){.count = 1, .value = &wanted};
    samples->bulk.value = -6;
    assert_false(mf_inversion_is_far_beyond_drift(samples));
    samples->bulk.value = -16;
    assert_true(mf_inversion_is_far_beyond_drift(samples));
    gsl_rng_free(rng);
}

/// Of twelve bins the first six have the one that changes by 12, 24 of a squared noise on average,
/// and the others none to speak of: half of them are far from their targets, and half agree.
static void test_a_section_that_agrees_is_waited_for_only_where_it_drifts(void **state) {
    (void)state;
    static struct made made;
    double variance[BINS];
    bool seen[BINS];
    struct inverse_problem problem = {.targets.target[TARGET_RDF].count = BINS};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 3, 12);
    struct inversion_state *samples = &made.state;
    struct inversion_section *section = samples->assessment.section;
    samples->assessment.sections = 2;
    samples->problem = &problem;
    samples->variance = variance;
    samples->grid.seen = seen;
    samples->gradient = INFINITY;
    samples->box = (struct box){3, {1, 1, 1}};
    for (size_t n = 0; n < BINS; n++) {
        variance[n] = n < 6 ? 1 : 10;
        seen[n] = 1;
    }
    for (size_t far = 0; far < 2; far++) { // which of them has its number first is no matter
        section[far] = (struct inversion_section){
            .known = 0, .known_count = 6, .probable = 1, .misfit = 14 * 14};
        section[1 - far] =
            (struct inversion_section){.known = 6, .known_count = 6, .probable = 1, .misfit = 0.9};
        assert_true(mf_inversion_is_far_beyond_drift(samples));
        section[1 - far].misfit = 0.01; // of its noise, not of its misfit
        assert_true(mf_inversion_is_far_beyond_drift(samples));
        section[far].misfit = 0.9; // nothing is off
        assert_false(mf_inversion_is_far_beyond_drift(samples));
        section[1 - far].misfit = 14 * 14; // what drifts agrees
        assert_false(mf_inversion_is_far_beyond_drift(samples));
    }
    gsl_rng_free(rng);
}

// Samples of an iteration -------------------------------------------------------------------------

enum { POINTS = 12, SOFT_REPLICAS = 8, FIRST = 8, MAX = 200 * FIRST, SEEDS = 16 };

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// Soft beads from disorder: sweeps of a replica until the samples had settled. Returns the energy
/// of all.
static double observe(uint64_t seed, int64_t equilibration, double *sweeps) {
    static const double repulsion = 6;
    double g[POINTS], error[POINTS];
    struct fluid fluid;
    struct inversion *inversion = calloc(1, sizeof *inversion);
    assert_non_null(inversion);
    fluid_ideal_gas(&fluid, 3, 150, 0.01);
    for (int k = 0; k < POINTS; k++) {
        const double r = 0.1 * (k + 0.5);
        g[k] = exp(-repulsion * exp(-r * r / 0.25));
        error[k] = 1; // nothing is to be doubled, nor far off
    }
    const struct inverse_problem problem = {
        .targets = {.bins = {0, 0.1, POINTS},
                    .target[TARGET_RDF] = {.count = POINTS, .value = g, .error = error}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = seed,
        .threads = 1};
    const struct inversion_parameters settings = {.replicas = SOFT_REPLICAS,
                                                  .equilibration = equilibration,
                                                  .samples = FIRST,
                                                  .every = 1,
                                                  .iterations = 2,
                                                  .damping = 1,
                                                  .precision = 1,
                                                  .start = INVERSION_FROM_MEAN_FORCE};
    assert_ok(mf_inversion_create(inversion, &mf_imc, &problem, &settings));
    assert_ok(mf_inversion_observe(inversion, &(struct inverse_listener){ignore, NULL}));
    assert_false(inversion->assessment.unequilibrated.found);
    *sweeps = (double)inversion->state->work.sweeps / SOFT_REPLICAS;
    const double energy = mf_replicas_mean(&inversion->state->replicas, SAMPLER_ENERGY, 1).mean;
    mf_inversion_destroy(inversion);
    free(inversion);
    fluid_clear(&fluid);
    return energy;
}

static void test_samples_are_equilibration_until_they_have_settled(void **state) {
    (void)state;
    double difference = 0, sweeps = 0;
    for (uint64_t seed = 5; seed < 5 + SEEDS; seed++) {
        double soon, late;
        const double at_once = observe(seed, 8, &soon), equilibrated = observe(seed, 100, &late);
        difference += (at_once / equilibrated - 1) / SEEDS;
        sweeps += soon / SEEDS;
    }
    print_message("%.1f sweeps, energy off by %.2f %%\n", sweeps, 100 * difference);
    assert_true(sweeps > 3 * FIRST && sweeps < MAX);
    assert_true(fabs(difference) < 0.01);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equilibrium_samples_are_hardly_ever_found_not_to_be),
        cmocka_unit_test(test_what_has_not_settled_is_named),
        cmocka_unit_test(test_what_replicas_remember_is_noise_once_they_have_mixed),
        cmocka_unit_test(test_what_is_remembered_may_be_too_little_to_matter),
        cmocka_unit_test(test_replicas_are_draws_of_equilibrium_when_they_forgot_where_they_began),
        cmocka_unit_test(test_slowest_number_is_told_with_its_independent_samples),
        cmocka_unit_test(test_error_of_samples_is_that_of_replicas_that_remember),
        cmocka_unit_test(test_shift_is_the_way_along_the_samples_and_the_scatter_of_replicas),
        cmocka_unit_test(
            test_samples_tell_the_way_to_a_target_that_is_far_from_what_has_not_settled),
        cmocka_unit_test(test_a_section_that_agrees_is_waited_for_only_where_it_drifts),
        cmocka_unit_test(test_samples_are_equilibration_until_they_have_settled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
