// SPDX-License-Identifier: GPL-3.0-or-later
//
// The noise inside the pair kernels (shared/probes.h) is white: moments, and covariances with what
// must not replay it.
#include "base/memory.h"
#include "shared/probes.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

/// Numbers behind every quantity that is compared with its expectation.
static const double draws = 1e7;

/// Standard errors by which a quantity may differ from its expectation: one false alarm in 16,000.
/// There are 44 such quantities, twice (both precisions see the same numbers), so that the file
/// would fail once in 360 times with a new seed.
static const double deviations = 4;

/// The same rate for the histogram's χ².
static const double false_alarm_rate = 6.3e-5;

/// `value` is the mean of `count` independent numbers of variance `variance`.
static void check(const char *what, double value, double expected, double variance, double count) {
    const double error = sqrt(variance / count), off = (value - expected) / error;
    print_message("  %-44s %9.6f, expected %g: %+.2f errors\n", what, value, expected, off);
    if (!(fabs(off) < deviations))
        fail_msg("%s is %.7g, but should be %g(%.2g)", what, value, expected, error);
}

static double dot(const double *a, const double *b, size_t count) {
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

enum { HISTOGRAM = 64 };

/// Sums over single ζ.
struct moments {
    double count, sum[5], largest;
    double step_squares; ///< Σ over steps of (Σ over pairs ζ)²/pairs
    double steps, histogram[HISTOGRAM];
};

static void add_moments(struct moments *moments, const double *zeta, size_t count) {
    double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
#pragma omp simd reduction(+ : m1, m2, m3, m4)
    for (size_t k = 0; k < count; k++) {
        const double square = zeta[k] * zeta[k];
        m1 += zeta[k];
        m2 += square;
        m3 += zeta[k] * square;
        m4 += square * square;
    }
    moments->sum[1] += m1;
    moments->sum[2] += m2;
    moments->sum[3] += m3;
    moments->sum[4] += m4;
    for (size_t k = 0; k < count; k++) {
        moments->largest = fmax(moments->largest, fabs(zeta[k]));
        const double u = 0.5 + zeta[k] / sqrt(12);
        moments->histogram[(int)fmin(fmax(u * HISTOGRAM, 0), HISTOGRAM - 1)]++;
    }
    moments->count += (double)count;
    moments->step_squares += m1 * m1 / (double)count;
    moments->steps++;
}

/// Uniform of mean 0 and variance 1: E ζ⁴ = 9/5, E ζ⁶ = 27/7, E ζ⁸ = 9, |ζ| ≤ √3.
static void check_moments(const struct moments *moments) {
    const double n = moments->count;
    check("mean", moments->sum[1] / n, 0, 1, n);
    check("variance", moments->sum[2] / n, 1, 9. / 5 - 1, n);
    check("third moment", moments->sum[3] / n, 0, 27. / 7, n);
    check("fourth moment", moments->sum[4] / n, 9. / 5, 9 - 81. / 25, n);
    assert_true(moments->largest < sqrt(3) + probes_tolerance);
    double chi2 = 0;
    for (int k = 0; k < HISTOGRAM; k++) {
        const double off = moments->histogram[k] - n / HISTOGRAM;
        chi2 += off * off / (n / HISTOGRAM);
    }
    const double p = gsl_cdf_chisq_Q(chi2, HISTOGRAM - 1);
    print_message("  %-44s %9.2f, p = %.3f\n", "chi2 of a uniform histogram of 64 bins", chi2, p);
    assert_true(p > false_alarm_rate);
    // The covariances of all pairs of pairs at once: if any number of ζ of a step are the same, the
    // variance of their sum shows it. A sum is all but normal, so that its square scatters by 2.
    check("variance of a step's sum", moments->step_squares / moments->steps, 1, 2, moments->steps);
}

/// What must not replay ζ(seed, step).
enum replay {
    NEXT_STEP,
    NEXT_SEED,
    NEXT_SEED_A_STEP_BEFORE,
    NEXT_SEED_A_STEP_LATER,
    UPPER_WORD_OF_STEP,
    UPPER_WORD_OF_SEED,
    REPLAYS
};

static const char *const replays[REPLAYS] = {
    [NEXT_STEP] = "covariance with step + 1",
    [NEXT_SEED] = "covariance with seed + 1",
    [NEXT_SEED_A_STEP_BEFORE] = "covariance with seed + 1, step - 1",
    [NEXT_SEED_A_STEP_LATER] = "covariance with seed + 1, step + 1",
    [UPPER_WORD_OF_STEP] = "covariance with step + 2^32",
    [UPPER_WORD_OF_SEED] = "covariance with seed + 2^32",
};

/// All about ζ of dimers, over steps that end beyond 2³².
static void check_dimers(struct probes *scene) {
    const uint64_t steps = (uint64_t)(draws / (double)scene->pairs) + 2, seed = 0x57EED;
    const size_t n = scene->pairs;
    double *now = probes_numbers(n), *before = probes_numbers(n), *other = probes_numbers(n),
           *other_before = probes_numbers(n), *far = probes_numbers(n);
    double sum[REPLAYS] = {0}, count = 0;
    struct moments moments = {0};
    for (uint64_t k = 0; k < steps; k++) {
        const uint64_t step = probes_carry - steps / 2 + k;
        probes_draw(scene, seed, step, now);
        probes_draw(scene, seed + 1, step, other);
        if (k > 0) {
            add_moments(&moments, now, n);
            sum[NEXT_STEP] += dot(now, before, n);
            sum[NEXT_SEED] += dot(now, other, n);
            sum[NEXT_SEED_A_STEP_BEFORE] += dot(now, other_before, n);
            sum[NEXT_SEED_A_STEP_LATER] += dot(before, other, n);
            probes_draw(scene, seed, step + probes_carry, far);
            sum[UPPER_WORD_OF_STEP] += dot(now, far, n);
            probes_draw(scene, seed + probes_carry, step, far);
            sum[UPPER_WORD_OF_SEED] += dot(now, far, n);
            count += (double)n;
        }
        double *spare = before;
        before = now;
        now = spare;
        spare = other_before;
        other_before = other;
        other = spare;
    }
    assert_true(count >= draws);
    check_moments(&moments);
    for (int k = 0; k < REPLAYS; k++)
        check(replays[k], sum[k] / count, 0, 1, count);
    mf_memory_free(now);
    mf_memory_free(before);
    mf_memory_free(other);
    mf_memory_free(other_before);
    mf_memory_free(far);
}

/// ζ of the sides of triangles, which share their lowest, middle or highest particle.
static void check_triangles(struct probes *scene) {
    const size_t motifs = scene->pairs / PROBES_SIDES;
    const uint64_t steps = (uint64_t)(draws / (double)motifs) + 1;
    double *zeta = probes_numbers(scene->pairs);
    double low = 0, middle = 0, high = 0, product = 0;
    struct moments moments = {0};
    for (uint64_t k = 0; k < steps; k++) {
        probes_draw(scene, 0xC0FFEE, probes_carry - steps / 2 + k, zeta);
        add_moments(&moments, zeta, scene->pairs);
        for (size_t m = 0; m < motifs; m++) {
            const double *side = zeta + PROBES_SIDES * m;
            low += side[PROBES_LOW_MIDDLE] * side[PROBES_LOW_HIGH];
            middle += side[PROBES_LOW_MIDDLE] * side[PROBES_MIDDLE_HIGH];
            high += side[PROBES_LOW_HIGH] * side[PROBES_MIDDLE_HIGH];
            product += side[PROBES_LOW_MIDDLE] * side[PROBES_LOW_HIGH] * side[PROBES_MIDDLE_HIGH];
        }
    }
    const double count = (double)(steps * motifs);
    assert_true(count >= draws);
    check("covariance of pairs that share the low id", low / count, 0, 1, count);
    check("covariance of pairs that share the middle id", middle / count, 0, 1, count);
    check("covariance of pairs that share the high id", high / count, 0, 1, count);
    check("mean product around a triangle", product / count, 0, 1, count);
    check_moments(&moments);
    mf_memory_free(zeta);
}

/// The first instruction set in both precisions, with ids in order and shuffled. The others draw
/// the same numbers, which another test says.
static void check_statistics(enum probes_motif motif, void (*check_scene)(struct probes *scene)) {
    struct variant variants[VARIANTS_MAX];
    variants_find(variants);
    for (int v = 0; v < 2; v++)
        for (int ids = PROBES_IN_ORDER; ids <= PROBES_SHUFFLED; ids++) {
            const struct probes_plan plan = {
                .motif = motif, .ids = (enum probes_ids)ids, .dimensions = 3, .sites = 15};
            struct probes scene;
            probes_make(&scene, &plan);
            scene.law.precision = variants[v].precision;
            print_message("%s, ids %s:\n", variants[v].name,
                          ids == PROBES_SHUFFLED ? "shuffled" : "in order");
            check_scene(&scene);
            probes_clear(&scene);
        }
}

static void test_pair_noise_is_white_when_steps_and_seeds_change(void **state) {
    (void)state;
    check_statistics(PROBES_DIMERS, check_dimers);
}

static void test_pair_noise_is_independent_when_pairs_share_a_particle(void **state) {
    (void)state;
    check_statistics(PROBES_TRIANGLES, check_triangles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pair_noise_is_white_when_steps_and_seeds_change),
        cmocka_unit_test(test_pair_noise_is_independent_when_pairs_share_a_particle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
