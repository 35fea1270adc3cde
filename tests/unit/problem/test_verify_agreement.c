// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_agreement.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 100 };

/// One section of a g that is 1 by its target.
struct case_of {
    double wanted[BINS], target_error[BINS], value[BINS], error[BINS];
    struct targets targets;
    struct observed observed;
    struct verify_sections sections;
};

static void make(struct case_of *of, double target_error, double error, double independent) {
    *of = (struct case_of){0};
    for (int k = 0; k < BINS; k++) {
        of->wanted[k] = of->value[k] = 1;
        of->target_error[k] = target_error;
        of->error[k] = error;
    }
    of->targets.target[TARGET_RDF] =
        (struct target){.count = BINS, .value = of->wanted, .error = of->target_error};
    of->observed.value[TARGET_RDF] = of->value;
    of->observed.error[TARGET_RDF] = of->error;
    of->sections.count = 1;
    of->sections.section[0] = (struct verify_section){
        .kind = TARGET_RDF, .count = BINS, .known = {.numbers = independent, .freedom = 76}};
}

static bool holds(const struct case_of *of, double noise) {
    struct verify_agreement agreement[TARGETS];
    mf_verify_agree(&of->targets, &of->sections, &of->observed, noise, agreement);
    assert_true(agreement[TARGET_RDF].probable > 1);
    return verify_agreement_holds(&agreement[TARGET_RDF]);
}

/// All bins off by two of their noises: no chance if 50 of them are independent, and one in 15 if
/// they are off together.
static void test_agreement_depends_on_how_many_bins_are_independent(void **state) {
    struct case_of of;
    (void)state;
    make(&of, 0.003, 0.004, 50);
    for (int k = 0; k < BINS; k++)
        of.value[k] += k % 2 ? 0.01 : -0.01;
    assert_false(holds(&of, 0));
    of.sections.section[0].known.numbers = 1;
    assert_true(holds(&of, 0));
    // Errors that two values tell are no errors to judge by, and of one there are none.
    of.sections.section[0].known = (struct statistics_independence){50, 1};
    assert_true(holds(&of, 0));
    of.sections.section[0].known.freedom = 0;
    assert_true(holds(&of, 0));
}

static double normal_of(uint32_t trial, uint32_t bin) {
    double normal[4];
    mf_rng_normal4(mf_rng_philox(13, RNG_INITIAL, trial, bin, 0), normal);
    return normal[0];
}

/// One bin of a hundred that is off by eight noises makes χ² by bin 1.6, by chance up to 1.9.
static void test_agreement_looks_at_stretches(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.003, 0.004, 50);
    of.sections.section[0].known.freedom = 1e6;
    for (int k = 0; k < BINS; k++)
        of.value[k] += k % 2 ? 0.005 : -0.005;
    assert_true(holds(&of, 0));
    of.value[31] = 1 + 8 * 0.005;
    assert_false(holds(&of, 0));
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_true(agreement[TARGET_RDF].misfit < agreement[TARGET_RDF].probable);
    assert_true(agreement[TARGET_RDF].stretch.first <= 31 &&
                agreement[TARGET_RDF].stretch.first + 6 > 31);
}

/// A verification a thousand times as exact as the fit's samples sees what their noise made of the
/// potential, and nothing else.
static void test_agreement_knows_the_noise_of_the_fit(void **state) {
    struct case_of of;
    (void)state;
    make(&of, 1e-6, 3e-6, 50);
    for (uint32_t k = 0; k < BINS; k++)
        of.value[k] += 0.003 * normal_of(0, k);
    assert_false(holds(&of, 0));
    assert_false(holds(&of, 0.001));
    assert_true(holds(&of, 0.003));
}

/// A fit whose samples know the pressure four times worse than its verification: so far may the
/// result be from what is asked for.
static void test_agreement_knows_the_noise_of_the_fit_in_the_pressure(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    double wanted = 3, target_error = 3, value = 3.1, error = 4;
    (void)state;
    make(&of, 3, 4, 50);
    of.targets.target[TARGET_PRESSURE] =
        (struct target){.count = 1, .value = &wanted, .error = &target_error};
    of.observed.value[TARGET_PRESSURE] = &value;
    of.observed.error[TARGET_PRESSURE] = &error;
    of.sections.curve[TARGET_PRESSURE] = (struct statistics_independence){1, INFINITY};
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_close(agreement[TARGET_PRESSURE].distance.rms, 0.1, 1e-12);
    assert_close(agreement[TARGET_PRESSURE].distance.noise, 5, 1e-12);
    // 4 times 4 of the samples beside the target's 3, in units of that.
    mf_verify_agree(&of.targets, &of.sections, &of.observed, hypot(3, 16) / 3, agreement);
    assert_close(agreement[TARGET_PRESSURE].distance.noise, sqrt(9 + 17 * 16), 1e-6);
}

/// Bins that are sums of three neighbours out of white noise: 2 of 2000 such curves are told, while
/// 25 would be if all bins were independent.
static void test_agreement_is_wrong_in_one_of_a_thousand(void **state) {
    enum { TRIALS = 2000 };
    int wrong = 0;
    struct case_of of;
    (void)state;
    make(&of, 0.004, 0.003, 100.0 * 100 / (100 + 2 * (99 * 4 + 98) / 9.0));
    of.sections.section[0].known.freedom = 1e6;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double white[BINS + 2];
        for (uint32_t k = 0; k < BINS + 2; k++)
            white[k] = normal_of(trial, k) / sqrt(3);
        for (int k = 0; k < BINS; k++)
            of.value[k] = 1 + 0.005 * (white[k] + white[k + 1] + white[k + 2]);
        wrong += !holds(&of, 0);
    }
    assert_true(wrong >= 1 && wrong <= 9);
}

/// Two counts where twenty are expected: their error is that of twenty.
static void test_agreement_takes_the_error_of_the_counts_that_are_expected(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.01, 0, 50);
    of.wanted[0] = 0.002;
    of.target_error[0] = 0.002 / sqrt(2);
    of.value[0] = 0.02;
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_close(agreement[TARGET_RDF].misfit, pow(18 / sqrt(20), 2) / BINS, 1e-12);
}

/// No pair where the target expects two, as a short verification has in bins that few pairs reach:
/// the error is that of what is expected, not 0.
static void test_agreement_takes_the_error_of_expected_counts_where_there_are_none(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 1e-6, 0.01, 50); // of ten thousand counts
    of.targets.bins = (struct rdf_bins){.low = 0, .width = 0.01, .count = BINS};
    of.wanted[9] = 2e-4;
    of.value[9] = of.error[9] = 0;
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    const double expected = 2e-4 * 1e4 * pow(9.5 / 8.5, 2); // by the shell before it
    assert_true(fabs(agreement[TARGET_RDF].misfit * BINS - expected) < 0.01 * expected);
    assert_true(holds(&of, 0));
    of.wanted[9] = 0.1; // a thousand
    assert_false(holds(&of, 0));
}

/// A g that is too large by 1 % as a whole, of a factor that is known within 1 %: one deviation of
/// one number, and by its bins alone 50 deviations. A wave as large is no factor.
static void test_agreement_knows_that_the_factor_of_a_target_is_uncertain(void **state) {
    static const double one_percent = 0.01;
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.002, 0, 50);
    of.targets.target[TARGET_RDF].pairs = 1;
    for (int k = 0; k < BINS; k++)
        of.value[k] = 0.99;
    assert_false(holds(&of, 0));
    of.targets.target[TARGET_RDF].factor_error = &one_percent;
    assert_true(holds(&of, 0));
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_close(agreement[TARGET_RDF].misfit * BINS, 1, 1e-3);
    for (int k = 0; k < BINS; k += 2)
        of.value[k] = 1.01;
    assert_false(holds(&of, 0));
    // The noise of a fit has that error, too, and nothing of it is its samples'.
    make(&of, 1e-6, 1e-6, 50);
    of.targets.target[TARGET_RDF].pairs = 1;
    of.targets.target[TARGET_RDF].factor_error = &one_percent;
    for (int k = 0; k < BINS; k++)
        of.value[k] += k % 2 ? 1e-5 : -1e-5;
    assert_false(holds(&of, 0.01));
}

/// The noise of the fit counts whatever single values of the target are not known, as those of a
/// type with one bead.
static void test_agreement_knows_the_noise_of_the_fit_where_a_value_is_not_known(void **state) {
    static const double exact = 0;
    struct case_of of;
    (void)state;
    make(&of, 0.002, 1e-4, 50);
    of.targets.target[TARGET_RDF].pairs = 1;
    of.targets.target[TARGET_RDF].factor_error = &exact;
    for (int k = 0; k < BINS; k++)
        of.value[k] += k % 2 ? 0.01 : -0.01;
    of.wanted[3] = of.value[3] = NAN;
    assert_false(holds(&of, 0.002));
    assert_true(holds(&of, 0.01));
}

/// GSL's inverse of F has no answer for these, and a bound that is no number would hold anything.
static void test_agreement_is_bounded_where_the_inverse_of_f_fails(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.002, 0.002, 50);
    of.sections.section[0].known.numbers = 13.99;
    of.sections.section[0].known.freedom = 770.5;
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    print_message("bound %.4f\n", agreement[TARGET_RDF].probable);
    assert_true(fabs(agreement[TARGET_RDF].probable - 2.58) < 0.05);
    of.sections.section[0].known.freedom = 0.5; // hardly two values: nothing is known
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_true(isinf(agreement[TARGET_RDF].probable));
}

/// The farthest section is the one that is told, by its own measure.
static void test_agreement_is_of_the_least_probable_section(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.01, 0, 50);
    of.sections.count = 2;
    of.sections.section[1] = of.sections.section[0];
    of.sections.section[0].count = of.sections.section[1].first = 90;
    of.sections.section[1].count = 10;
    for (int k = 90; k < BINS; k++)
        of.value[k] -= 0.03;
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_close(agreement[TARGET_RDF].misfit, 9, 1e-12);
    assert_close(agreement[TARGET_RDF].distance.rms, 0.03, 1e-12);
    assert_int_equal(agreement[TARGET_RDF].distance.count, 10);
    assert_true(verify_agreement_holds(&agreement[TARGET_PRESSURE]));
}

/// Bins of width 0.05, of which the first 20 are a core: without pairs by a target in whose bins
/// one count is g = 0.01 at r = 1, as in those of the verification.
enum { CORE = 20 };
static const double one_count = 0.01;

static double count_of(int bin) {
    return one_count / pow(0.05 * (bin + 0.5), 2);
}

static void make_core(struct case_of *of) {
    make(of, 0, 0, 50);
    of->targets.bins = (struct rdf_bins){0, 0.05, BINS};
    for (int k = 0; k < BINS; k++) {
        of->wanted[k] = of->value[k] = k >= CORE;
        of->target_error[k] = of->error[k] = k >= CORE ? sqrt(count_of(k)) : 0;
    }
    of->sections.section[0].first = of->sections.section[0].core = CORE;
    of->sections.section[0].count = BINS - CORE;
    of->sections.section[0].threshold = 0.01;
    of->sections.section[0].known.freedom = 1e6;
}

static void set_counts(double *value, double *error, int bin, int counts) {
    value[bin] = counts * count_of(bin);
    error[bin] = sqrt(counts) * count_of(bin);
}

/// Pairs that a fit lets into a core, which no equation of it sees: a few are chance, and fewer
/// than the target has no fault.
static void test_agreement_sees_pairs_in_a_core(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make_core(&of);
    assert_true(holds(&of, 0));
    set_counts(of.value, of.error, 14, 3);
    assert_true(holds(&of, 0));
    set_counts(of.value, of.error, 14, 60);
    assert_false(holds(&of, 0));
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, agreement);
    assert_true(agreement[TARGET_RDF].stretch.core);
    assert_int_equal(agreement[TARGET_RDF].stretch.first, 14);
    assert_int_equal(agreement[TARGET_RDF].stretch.count, CORE - 14);
    // A hard wall lets them into the last bin alone; a shorter target would have seen none.
    set_counts(of.value, of.error, 14, 0);
    set_counts(of.value, of.error, CORE - 1, 60);
    assert_false(holds(&of, 0));
    for (int k = CORE; k < BINS; k++)
        of.target_error[k] *= sqrt(50);
    assert_true(holds(&of, 0));
    for (int k = CORE; k < BINS; k++)
        of.target_error[k] /= sqrt(50);
    // What is as good as none, however well it is known.
    of.value[CORE - 1] = 0.0099;
    of.error[CORE - 1] = 1e-5;
    assert_true(holds(&of, 0));
    // As few in each of many bins are one gap.
    for (int k = 0; k < CORE; k++)
        set_counts(of.value, of.error, k, 3);
    assert_false(holds(&of, 0));
    for (int k = 0; k < CORE; k++) {
        set_counts(of.wanted, of.target_error, k, 3);
        set_counts(of.value, of.error, k, 0);
    }
    assert_true(holds(&of, 0));
}

static int poisson_of(double mean, uint32_t trial, uint32_t bin) {
    double product = 1;
    int counts = -1;
    for (uint32_t n = 0; product > exp(-mean) || counts < 0; n++, counts++) {
        const struct rng_block block = mf_rng_philox(17, RNG_INITIAL, trial, bin, n);
        product *= mf_rng_uniform(block.word[0], block.word[1]);
    }
    return counts;
}

/// Target and verification of one law, which has few pairs in the core. Their errors are of counts,
/// so that a thousandth is the right order.
static void test_agreement_of_a_core_is_seldom_wrong(void **state) {
    enum { TRIALS = 4000 };
    struct case_of of;
    (void)state;
    for (int of_bin = 0; of_bin < 3; of_bin++) {
        static const double mean[] = {0.05, 0.3, 2};
        int wrong = 0;
        for (uint32_t trial = 0; trial < TRIALS; trial++) {
            make_core(&of);
            for (uint32_t k = 10; k < CORE; k++) {
                set_counts(of.wanted, of.target_error, (int)k, poisson_of(mean[of_bin], trial, k));
                set_counts(of.value, of.error, (int)k, poisson_of(mean[of_bin], trial, 100 + k));
            }
            wrong += !holds(&of, 0);
        }
        assert_true(wrong <= 8);
    }
}

enum { LAGS = 64, ROWS = 33, COLUMNS = 20, CELLS = ROWS * COLUMNS };

/// A VACF and escape times whose values and errors are given.
struct curves {
    double wanted[CELLS], target_error[CELLS], value[CELLS], error[CELLS];
    struct targets targets;
    struct observed observed;
    struct verify_sections sections;
};

static void make_curves(struct curves *of, int kind, double freedom, double numbers) {
    *of = (struct curves){0};
    const size_t count = kind == TARGET_ETD ? CELLS : LAGS;
    for (size_t k = 0; k < count; k++) {
        of->wanted[k] = of->value[k] = 0.5;
        of->target_error[k] = 0.0003;
        of->error[k] = 0.0004;
    }
    of->targets.target[kind] = (struct target){.count = count,
                                               .columns = kind == TARGET_ETD ? COLUMNS : 0,
                                               .value = of->wanted,
                                               .error = of->target_error};
    of->observed.value[kind] = of->value;
    of->observed.error[kind] = of->error;
    of->sections.curve[kind] = (struct statistics_independence){numbers, freedom};
}

static struct verify_agreement judge(const struct curves *of, int kind) {
    struct verify_agreement agreement[TARGETS];
    mf_verify_agree(&of->targets, &of->sections, &of->observed, 0, agreement);
    return agreement[kind];
}

/// A VACF that is right but in its second lag, six errors off: one hundredth of the mean of χ²,
/// which is 1.5. What was told by the mean alone agreed.
static void test_agreement_sees_a_misfit_at_short_times(void **state) {
    struct curves of;
    (void)state;
    make_curves(&of, TARGET_VACF, 200, 20);
    for (uint32_t k = 0; k < LAGS; k++)
        of.value[k] += 0.0005 * normal_of(3, k);
    const struct verify_agreement good = judge(&of, TARGET_VACF);
    assert_true(verify_agreement_holds(&good));
    of.value[1] = 0.5 + 6 * 0.0005;
    const struct verify_agreement bad = judge(&of, TARGET_VACF);
    assert_false(verify_agreement_holds(&bad));
    assert_int_equal(bad.part.column, 1);
    assert_int_equal(bad.part.columns, 1);
    assert_close(bad.misfit, 36, 1e-9);
}

/// Escape times that are off by six errors for a tenth of r_0, and at times from 8 to 15 alone.
static void test_agreement_sees_a_misfit_of_some_r_0(void **state) {
    struct curves of;
    (void)state;
    make_curves(&of, TARGET_ETD, 200, 100);
    for (size_t row = 8; row < 16; row++)
        for (size_t column = 4; column < 6; column++)
            of.value[row * COLUMNS + column] += 6 * 0.0005;
    const struct verify_agreement bad = judge(&of, TARGET_ETD);
    assert_false(verify_agreement_holds(&bad));
    assert_int_equal(bad.part.row, 8);
    assert_int_equal(bad.part.rows, 8);
    assert_int_equal(bad.part.column, 4);
    assert_int_equal(bad.part.columns, 2);
}

/// How many of 2000 right results are told to be off, if errors are known by `freedom` values and
/// neighbours are as correlated as `share` says: 0 not at all, 1 wholly.
static int count_alarms(int kind, double freedom, double share) {
    enum { TRIALS = 2000 };
    const size_t count = kind == TARGET_ETD ? CELLS : LAGS;
    int wrong = 0;
    struct curves of;
    double squares = (double)count;
    for (size_t k = 1; k < count; k++)
        squares += 2 * (double)(count - k) * pow(share, 2.0 * (double)k);
    make_curves(&of, kind, freedom, (double)(count * count) / squares);
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double last = normal_of(trial, 0), scatter = 0;
        for (uint32_t n = 0; n < (uint32_t)freedom && freedom < 200; n++)
            scatter += pow(normal_of(trial, 5000 + n), 2) / freedom;
        for (uint32_t k = 0; k < count; k++) {
            last = k == 0 ? last : share * last + sqrt(1 - share * share) * normal_of(trial, k);
            of.target_error[k] = 0;
            of.error[k] = 0.0005 * (freedom < 200 ? sqrt(scatter) : 1);
            of.value[k] = 0.5 + 0.0005 * last;
        }
        const struct verify_agreement found = judge(&of, kind);
        wrong += !verify_agreement_holds(&found);
    }
    print_message("of %d: %d, with %g degrees of freedom, correlation %g\n", TRIALS, wrong, freedom,
                  share);
    return wrong;
}

/// All parts and the whole together are exceeded by noise in one of a thousand, however neighbours
/// are correlated.
static void test_agreement_of_all_parts_is_wrong_in_one_of_a_thousand(void **state) {
    (void)state;
    static const double shares[] = {0, 0.7, 0.97, 1};
    for (int k = 0; k < 4; k++) {
        assert_true(count_alarms(TARGET_VACF, 1e6, shares[k]) <= 6);
        assert_true(count_alarms(TARGET_VACF, 30, shares[k]) <= 6);
        assert_true(count_alarms(TARGET_ETD, 1e6, shares[k]) <= 6);
    }
}

/// What is only compared: a curve whose values are 2.3 of their errors off has no chance if thirty
/// of them are independent, a single number has one in fifty.
static void test_agreement_judges_what_is_only_compared(void **state) {
    struct case_of of;
    struct verify_agreement agreement[TARGETS], fitted[TARGETS];
    struct targets compared;
    double wanted = 3, target_error = 0.3, value = 3 + 2.3 * 0.5, error = 0.4;
    double open[TARGETS] = {[TARGET_RDF] = INFINITY}; // it is fitted
    (void)state;
    make(&of, 0.003, 0.004, 30);
    compared = of.targets;
    compared.target[TARGET_VACF] = of.targets.target[TARGET_RDF];
    compared.target[TARGET_PRESSURE] =
        (struct target){.count = 1, .value = &wanted, .error = &target_error};
    of.observed.value[TARGET_VACF] = of.value;
    of.observed.error[TARGET_VACF] = of.error;
    of.observed.value[TARGET_PRESSURE] = &value;
    of.observed.error[TARGET_PRESSURE] = &error;
    of.sections.curve[TARGET_VACF] = (struct statistics_independence){30, 76};
    of.sections.curve[TARGET_PRESSURE] = (struct statistics_independence){1, INFINITY};
    mf_verify_compare(&compared, &of.sections, &of.observed, 0, open, agreement);
    assert_true(verify_agreement_holds(&agreement[TARGET_VACF]));
    for (int k = 0; k < BINS; k++)
        of.value[k] += k % 2 ? 2.3 * 0.005 : -2.3 * 0.005;
    mf_verify_compare(&compared, &of.sections, &of.observed, 0, open, agreement);
    assert_close(agreement[TARGET_VACF].misfit, 2.3 * 2.3, 1e-9);
    assert_false(verify_agreement_holds(&agreement[TARGET_VACF]));
    assert_true(verify_agreement_holds(&agreement[TARGET_PRESSURE]));
    // What g(r) leaves open of a pressure, or all of it, is no misfit.
    value = 3 + 10 * 0.5;
    mf_verify_compare(&compared, &of.sections, &of.observed, 0, open, agreement);
    assert_false(verify_agreement_holds(&agreement[TARGET_PRESSURE]));
    open[TARGET_PRESSURE] = 6;
    mf_verify_compare(&compared, &of.sections, &of.observed, 0, open, agreement);
    assert_close(agreement[TARGET_PRESSURE].misfit, 25 / (36 + 0.25), 1e-9);
    assert_true(verify_agreement_holds(&agreement[TARGET_PRESSURE]));
    open[TARGET_PRESSURE] = INFINITY;
    mf_verify_compare(&compared, &of.sections, &of.observed, 0, open, agreement);
    assert_true(agreement[TARGET_PRESSURE].probable == 0);
    assert_false(verify_agreement_holds(&agreement[TARGET_VACF]));
    // Each is of one of the two.
    assert_true(agreement[TARGET_RDF].probable == 0);
    mf_verify_agree(&of.targets, &of.sections, &of.observed, 0, fitted);
    assert_true(fitted[TARGET_VACF].probable == 0 && fitted[TARGET_PRESSURE].probable == 0);
}

/// g of two pair types as one curve: one factor is too large by its error, the other too small.
static void test_agreement_knows_that_each_pair_type_has_its_factor(void **state) {
    static const double one_percent[] = {0.01, 0.01}, open[TARGETS] = {0};
    struct case_of of;
    struct verify_agreement agreement[TARGETS];
    (void)state;
    make(&of, 0.002, 0, 2);
    of.targets.target[TARGET_RDF].pairs = 2;
    of.targets.target[TARGET_RDF].factor_error = one_percent;
    of.sections.curve[TARGET_RDF] = (struct statistics_independence){2, INFINITY};
    for (int k = 0; k < BINS; k++)
        of.value[k] = k < BINS / 2 ? 0.99 : 1.01;
    mf_verify_compare(&of.targets, &of.sections, &of.observed, 0, open, agreement);
    assert_true(verify_agreement_holds(&agreement[TARGET_RDF]));
    of.value[0] = of.value[1] = 1.05;
    mf_verify_compare(&of.targets, &of.sections, &of.observed, 0, open, agreement);
    assert_false(verify_agreement_holds(&agreement[TARGET_RDF]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_agreement_depends_on_how_many_bins_are_independent),
        cmocka_unit_test(test_agreement_looks_at_stretches),
        cmocka_unit_test(test_agreement_knows_the_noise_of_the_fit),
        cmocka_unit_test(test_agreement_knows_the_noise_of_the_fit_in_the_pressure),
        cmocka_unit_test(test_agreement_is_wrong_in_one_of_a_thousand),
        cmocka_unit_test(test_agreement_takes_the_error_of_the_counts_that_are_expected),
        cmocka_unit_test(test_agreement_takes_the_error_of_expected_counts_where_there_are_none),
        cmocka_unit_test(test_agreement_knows_that_the_factor_of_a_target_is_uncertain),
        cmocka_unit_test(test_agreement_knows_the_noise_of_the_fit_where_a_value_is_not_known),
        cmocka_unit_test(test_agreement_is_bounded_where_the_inverse_of_f_fails),
        cmocka_unit_test(test_agreement_is_of_the_least_probable_section),
        cmocka_unit_test(test_agreement_sees_pairs_in_a_core),
        cmocka_unit_test(test_agreement_of_a_core_is_seldom_wrong),
        cmocka_unit_test(test_agreement_sees_a_misfit_at_short_times),
        cmocka_unit_test(test_agreement_sees_a_misfit_of_some_r_0),
        cmocka_unit_test(test_agreement_of_all_parts_is_wrong_in_one_of_a_thousand),
        cmocka_unit_test(test_agreement_judges_what_is_only_compared),
        cmocka_unit_test(test_agreement_knows_that_each_pair_type_has_its_factor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
