// SPDX-License-Identifier: GPL-3.0-or-later
//
// When g(r) agrees with its target but for noise: of counts that are made up.
#include "inversion/inversion_state.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <math.h>

enum { BINS = 40, SAMPLES = 400 };

/// Pairs per sample in each bin, and what is made of them: a target of `frames` frames with errors
/// by its own counts, and the samples of a potential.
struct made {
    struct inverse_problem problem;
    struct inversion_parameters parameters;
    struct inversion_state state;
    size_t known_bin[BINS], known_of[1];
    bool seen[BINS];
    double expected[BINS], sampled[BINS]; ///< by the truth, and by the potential
    double mean[BINS], comoment[BINS * BINS], unit[BINS], target[BINS], error[BINS];
    double excess[BINS], variance[BINS], inefficiency[BINS];
    struct inversion_memory memory[2];
};

/// Bins from r = 0 on, so that the first ones have few pairs; those of a wrong potential are off by
/// a part of them.
static void make(struct made *made, gsl_rng *rng, double frames, double wrong) {
    *made = (struct made){.known_of = {BINS}};
    struct inversion_state *state = &made->state;
    *state = (struct inversion_state){.problem = &made->problem,
                                      .parameters = &made->parameters,
                                      .bins = BINS,
                                      .grid = {.blocks = 1,
                                               .known_of = made->known_of,
                                               .known = BINS,
                                               .pairs_known = BINS,
                                               .known_bin = made->known_bin,
                                               .seen = made->seen},
                                      .assessment = {.sections = 1,
                                                     .section[0] = {.kind = TARGET_RDF,
                                                                    .bins = BINS,
                                                                    .known_count = BINS,
                                                                    .peak = 1}},
                                      .target = {.ideal = made->unit,
                                                 .unit = made->unit,
                                                 .counts = made->target,
                                                 .error = made->error},
                                      .excess = made->excess,
                                      .variance = made->variance,
                                      .bin_inefficiency = made->inefficiency,
                                      .memory = made->memory};
    for (size_t k = 0; k < BINS; k++) {
        made->known_bin[k] = k;
        made->seen[k] = true;
        made->unit[k] = 0.08 * (double)(1 + 3 * k * k);
        made->expected[k] = 0.3 * made->unit[k];
        made->sampled[k] = made->expected[k] * (1 + wrong * sin(0.3 * (double)k));
        const double counts = gsl_ran_poisson(rng, frames * made->expected[k]);
        made->target[k] = counts / frames;
        made->error[k] = sqrt(fmax(counts, 1)) / frames;
        made->mean[k] = gsl_ran_poisson(rng, SAMPLES * made->sampled[k]) / (double)SAMPLES;
        made->comoment[k * (BINS + 1)] = SAMPLES * made->sampled[k];
    }
    state->replicas = (struct replicas){
        .bins = BINS,
        .numbers = BINS,
        .counts = {.size = BINS, .count = SAMPLES, .mean = made->mean, .comoment = made->comoment}};
    mf_inversion_assess(state);
}

/// Of the first bin 2.4 counts are expected, of all others 10 to 10,000: the share of targets that
/// the truth agrees with.
static double count_agreements(int trials, double wrong) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    static struct made made;
    double agree = 0;
    for (int k = 0; k < trials; k++) {
        make(&made, rng, 100, wrong);
        agree += inversion_section_agrees(mf_inversion_assessment_worst(&made.state.assessment)) /
                 (double)trials;
    }
    gsl_rng_free(rng);
    return agree;
}

static void test_truth_agrees_with_its_target_whatever_the_counts_of_one_bin(void **state) {
    (void)state;
    const double agree = count_agreements(2000, 0);
    print_message("the truth: %.4f\n", agree);
    assert_true(agree > 0.995);
}

/// A wave of 5 % is 5 standard errors of the largest bins, and hardly any of the first ones, which
/// make most of the rms.
static void
test_wrong_potential_does_not_agree_though_the_noise_of_rare_pairs_is_larger(void **state) {
    (void)state;
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0.05);
    const struct inversion_section *section = &made.state.assessment.section[0];
    print_message("rms %.3f of a noise of %.3f, chi^2 by bin %.2f of %.2f\n", section->rms,
                  section->noise, section->misfit, section->probable);
    assert_true(section->rms < 1.7 * section->noise);
    assert_true(section->misfit > section->probable);
    gsl_rng_free(rng);
    const double agree = count_agreements(500, 0.05);
    print_message("5 %% off: %.4f\n", agree);
    assert_true(agree < 0.01);
}

/// Bins that are independent, whose samples are correlated by chance: what a thousandth of chi^2 of
/// 40 degrees of freedom exceeds is 73.40 (tables of the distribution), and with bins that are
/// pairs of the same counts, of 20, 45.31.
static double mean_bound(uint32_t samples, uint32_t alike) {
    enum { TRIALS = 40 };
    static struct made made;
    struct comoments moments;
    double sum = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0);
    for (int trial = 0; trial < TRIALS; trial++) {
        assert_ok(mf_comoments_init(&moments, BINS));
        for (uint32_t n = 0; n < samples; n++) {
            double value[BINS], last = 0;
            for (uint32_t k = 0; k < BINS; k++)
                value[k] = last = k % alike == 0 ? 5 + gsl_ran_gaussian(rng, 1) : last;
            mf_comoments_add(&moments, value);
        }
        made.state.replicas.counts = moments;
        mf_inversion_assess(&made.state);
        sum += made.state.assessment.section[0].probable / TRIALS;
        mf_comoments_clear(&moments);
    }
    gsl_rng_free(rng);
    return sum;
}

static void test_bound_of_agreement_is_that_of_the_bins_not_of_few_samples(void **state) {
    (void)state;
    const double few = mean_bound(25, 1), many = mean_bound(400, 1), pairs = mean_bound(25, 2);
    print_message("%.3f and %.3f of %.3f, of pairs %.3f of %.3f\n", few, many, 73.402 / 40, pairs,
                  45.315 / 20);
    assert_true(fabs(few - 73.402 / 40) < 0.06);
    assert_true(fabs(many - 73.402 / 40) < 0.03);
    assert_true(fabs(pairs - 45.315 / 20) < 0.09);
}

/// Poisson counts: an error of 2 counts where 5 are expected is that of 5.
static void test_noise_of_a_bin_is_that_of_the_counts_that_are_expected(void **state) {
    (void)state;
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0);
    made.target[0] = 0.02;
    made.error[0] = sqrt(2) / 100;
    made.mean[0] = 0.05;
    mf_inversion_assess(&made.state);
    const double sampled = made.comoment[0] / SAMPLES / (SAMPLES / made.state.inefficiency);
    assert_true(fabs(made.variance[0] - sampled - 5e-4) < 1e-9);
    gsl_rng_free(rng);
}

/// Replicas that differ by three times what their samples let expect count a tenth, and only the
/// pair type that does.
static void test_noise_is_that_of_each_pair_type(void **state) {
    (void)state;
    enum { REPLICAS = 8, HALF = BINS / 2 };
    static struct made made;
    static double block[REPLICAS][REPLICAS_BLOCKS * BINS];
    size_t known_of[] = {HALF, HALF};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0);
    struct replicas *replicas = &made.state.replicas;
    made.state.grid.blocks = 2;
    made.state.grid.known_of = known_of;
    replicas->count = REPLICAS;
    for (size_t k = 0; k < REPLICAS; k++) {
        const double apart = 3 * gsl_ran_gaussian(rng, 1);
        replicas->member[k].block = block[k];
        for (size_t n = 0; n < REPLICAS_BLOCKS * BINS; n++) {
            const size_t a = n % BINS;
            const double whole = sqrt(made.sampled[a] * REPLICAS / SAMPLES);
            block[k][n] = made.mean[a] + whole * (sqrt(REPLICAS_BLOCKS) * gsl_ran_gaussian(rng, 1) +
                                                  (a < HALF ? 0 : apart));
        }
    }
    mf_inversion_assess(&made.state);
    print_message("%.2f and %.2f samples as one\n", made.inefficiency[0], made.inefficiency[HALF]);
    assert_true(made.inefficiency[0] < 1.3);
    assert_true(made.inefficiency[HALF] > 3 && made.inefficiency[HALF] < 30);
    assert_true(made.inefficiency[HALF - 1] == made.inefficiency[0]);
    assert_true(made.inefficiency[BINS - 1] == made.inefficiency[HALF]);
    gsl_rng_free(rng);
}

/// Variances of the target of 9 and 1 are 5 in the mean: the bins of 9 bear 9/5 of what is asked
/// of the others, which bear no more than that.
static void test_noise_of_samples_counts_by_that_of_the_target(void **state) {
    (void)state;
    static struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0);
    for (size_t k = 0; k < BINS; k++) {
        made.unit[k] = 1;
        made.mean[k] = made.target[k] = 100;
        made.error[k] = k < BINS / 2 ? 3 : 1;
        made.comoment[k * (BINS + 1)] = SAMPLES * (k < BINS / 2 ? 1.8 : 1);
    }
    mf_inversion_assess(&made.state);
    assert_true(fabs(made.state.assessment.section[0].own_noise - 1 / sqrt(SAMPLES)) < 1e-9);
    gsl_rng_free(rng);
}

/// 3 % more of all pairs are 3 standard errors in the mean of the bins, unless the target's factor
/// may be off by as much; then the factor is found by what it makes, and by nothing else.
static void test_target_that_is_off_as_a_whole_agrees_where_its_factor_may_be(void **state) {
    (void)state;
    static struct made made;
    double common[BINS];
    const double prior = 0.03, moved = 1.03;
    const size_t known_of[] = {BINS};
    struct inversion_factor factor;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made, rng, 100, 0);
    made.problem.targets.target[TARGET_RDF].factor_error = &prior;
    made.state.grid.pairs = made.state.grid.blocks = 1;
    made.state.grid.known_of = (size_t *)known_of;
    for (size_t k = 0; k < BINS; k++) {
        made.target[k] *= moved;
        made.error[k] *= moved;
        common[k] = prior * made.target[k];
    }
    mf_inversion_assess(&made.state);
    print_message("without: %.2f\n", made.state.assessment.section[0].misfit);
    assert_false(inversion_section_agrees(&made.state.assessment.section[0]));
    made.state.target.common = common;
    mf_inversion_assess(&made.state);
    mf_inversion_find_factor(&made.state, &factor);
    print_message("with: %.2f of %.2f; factor %.4f\n", made.state.assessment.section[0].misfit,
                  made.state.assessment.section[0].probable, factor.missing);
    assert_true(inversion_section_agrees(&made.state.assessment.section[0]));
    assert_true(fabs(factor.missing - (1 / moved - 1)) < 0.003);
    gsl_rng_free(rng);
}

/// Targets of the truth whose factor is off by chance: what the factor does not explain scatters as
/// the noise has it, which is that without a factor, and the whole distance as the whole
/// noise.
static void test_error_of_a_factor_is_no_noise_of_bins(void **state) {
    enum { TRIALS = 400 };
    (void)state;
    static struct made made;
    double common[BINS], squares = 0, noise = 0, alone = 0, whole = 0, all = 0;
    const double prior = 0.03;
    const size_t known_of[] = {BINS};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int trial = 0; trial < TRIALS; trial++) {
        make(&made, rng, 1000, 0);
        alone += pow(made.state.assessment.section[0].noise, 2) / TRIALS;
        made.problem.targets.target[TARGET_RDF].factor_error = &prior;
        made.state.grid.pairs = made.state.grid.blocks = 1;
        made.state.grid.known_of = (size_t *)known_of;
        made.state.target.common = common;
        const double moved = 1 + gsl_ran_gaussian(rng, prior);
        for (size_t k = 0; k < BINS; k++) {
            made.target[k] *= moved;
            common[k] = prior * made.target[k];
        }
        mf_inversion_assess(&made.state);
        const struct target_distance *distance = &made.state.assessment.distance[TARGET_RDF];
        squares += pow(made.state.assessment.section[0].rms, 2) / TRIALS;
        noise += pow(made.state.assessment.section[0].noise, 2) / TRIALS;
        whole += distance->rms * distance->rms / TRIALS;
        all += distance->noise * distance->noise / TRIALS;
    }
    gsl_rng_free(rng);
    print_message("%.3g of %.3g, %.3g without a factor; the whole %.3g of %.3g\n", squares, noise,
                  alone, whole, all);
    assert_true(fabs(squares / noise - 1) < 0.1);
    assert_true(fabs(noise / alone - 1) < 0.05);
    assert_true(fabs(whole / all - 1) < 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_truth_agrees_with_its_target_whatever_the_counts_of_one_bin),
        cmocka_unit_test(
            test_wrong_potential_does_not_agree_though_the_noise_of_rare_pairs_is_larger),
        cmocka_unit_test(test_target_that_is_off_as_a_whole_agrees_where_its_factor_may_be),
        cmocka_unit_test(test_bound_of_agreement_is_that_of_the_bins_not_of_few_samples),
        cmocka_unit_test(test_error_of_a_factor_is_no_noise_of_bins),
        cmocka_unit_test(test_noise_of_samples_counts_by_that_of_the_target),
        cmocka_unit_test(test_noise_is_that_of_each_pair_type),
        cmocka_unit_test(test_noise_of_a_bin_is_that_of_the_counts_that_are_expected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
