// SPDX-License-Identifier: GPL-3.0-or-later
//
// Flows whose transport coefficient is known: white noise, and Ornstein and Uhlenbeck's process.
#include "observe/green_kubo.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { COMPONENTS = 5, RUNS = 100 };

/// Standard normal numbers of a run.
static double normal(uint64_t run, uint32_t number, uint32_t component) {
    const struct rng_block block = mf_rng_philox(run, RNG_INITIAL, number, component, 0);
    const double u = (block.word[0] + 0.5) * 0x1p-32, angle = 2 * M_PI * 0x1p-32 * block.word[1];
    return sqrt(-2 * log(u)) * cos(angle);
}

/// x ← a x + sqrt(1 − a²) ξ: ⟨x_0 x_k⟩ = a^k, and I(∞) = ½ (1 + a)/(1 − a).
static struct green_kubo_summary simulate(uint64_t run, double a, size_t lags, size_t samples) {
    struct green_kubo green_kubo;
    double x[COMPONENTS] = {0};
    assert_ok(mf_green_kubo_init(&green_kubo, lags, COMPONENTS, samples));
    for (uint32_t c = 0; c < COMPONENTS; c++)
        x[c] = normal(run, UINT32_MAX, c);
    for (uint32_t n = 0; n < samples; n++) {
        for (uint32_t c = 0; c < COMPONENTS; c++)
            x[c] = a * x[c] + sqrt(1 - a * a) * normal(run, n, c);
        mf_green_kubo_add(&green_kubo, x);
    }
    const struct green_kubo_summary s = mf_green_kubo_result(&green_kubo, NULL);
    mf_green_kubo_clear(&green_kubo);
    return s;
}

/// A hundred runs: their mean, and how far they lie from the truth in their own errors.
static void check(double a, size_t lags, size_t samples) {
    const double truth = 0.5 * (1 + a) / (1 - a);
    double sum = 0, squares = 0, deviations = 0, errors = 0, reached = 0, window = 0;
    for (uint64_t run = 1; run <= RUNS; run++) {
        const struct green_kubo_summary s = simulate(run, a, lags, samples);
        sum += s.value / RUNS;
        squares += s.value * s.value / RUNS;
        errors += s.error / RUNS;
        deviations += pow((s.value - truth) / s.error, 2) / RUNS;
        reached += s.reached;
        window += (double)s.window / RUNS;
    }
    const double scatter = sqrt(squares - sum * sum);
    print_message("a = %g: %.4f, truth %.4f, scatter %.4f, error %.4f, rms deviation %.2f errors, "
                  "%.0f %% reached, window %.0f\n",
                  a, sum, truth, scatter, errors, sqrt(deviations), reached, window);
    assert_close(sum, truth, 4 * scatter / sqrt(RUNS) + 0.02 * truth);
    assert_in_range((int)(100 * sqrt(deviations)), 60, 130);
}

static void test_green_kubo_knows_white_noise_and_its_own_error(void **state) {
    (void)state;
    check(0, 64, 8000);
}

static void test_green_kubo_knows_a_decay_and_its_own_error(void **state) {
    (void)state;
    check(exp(-1.0 / 5), 128, 8000);
    check(exp(-1.0 / 5), 128, 1500);
}

/// Flows that forget in several times, with these parts of I(∞) = 1.
enum { MODES = 3 };
struct modes {
    const char *name;
    double part[MODES], time[MODES]; ///< [intervals]; 0: white noise
};

static struct green_kubo_summary simulate_modes(uint64_t run, const struct modes *modes,
                                                size_t lags, size_t samples) {
    enum { BEFORE = 500 };
    struct green_kubo green_kubo;
    double x[MODES][COMPONENTS] = {{0}};
    assert_ok(mf_green_kubo_init(&green_kubo, lags, COMPONENTS, samples));
    for (uint32_t n = 0; n < samples + BEFORE; n++) {
        double flow[COMPONENTS] = {0};
        for (uint32_t m = 0; m < MODES; m++) {
            const double a = modes->time[m] > 0 ? exp(-1 / modes->time[m]) : 0;
            for (uint32_t c = 0; c < COMPONENTS; c++) {
                x[m][c] = a * x[m][c] + sqrt(1 - a * a) * normal(run, n, c + 8 * m);
                flow[c] += x[m][c] * sqrt(modes->part[m] * 2 * (1 - a) / (1 + a));
            }
        }
        if (n >= BEFORE)
            mf_green_kubo_add(&green_kubo, flow);
    }
    const struct green_kubo_summary s = mf_green_kubo_result(&green_kubo, NULL);
    mf_green_kubo_clear(&green_kubo);
    return s;
}

/// What comes late is hidden by noise: no run may say with a small error that it is not there.
static void test_green_kubo_error_covers_a_tail_that_noise_hides(void **state) {
    (void)state;
    static const struct modes modes[] = {
        {"as stress of a soft fluid", {0.35, 0.35, 0.3}, {0, 4, 25}},
        {"noise and a slow tail", {0.7, 0.3, 0}, {0, 40, 0}},
    };
    enum { FLUIDS = 40 };
    for (int k = 0; k < 2; k++) {
        double squares = 0, worst = 0, sum = 0;
        for (uint64_t run = 1; run <= FLUIDS; run++) {
            const struct green_kubo_summary s = simulate_modes(run, &modes[k], 200, 4000);
            squares += pow((s.value - 1) / s.error, 2) / FLUIDS;
            worst = fmin(worst, (s.value - 1) / s.error);
            sum += s.value / FLUIDS;
        }
        print_message("%s: mean %.3f, rms deviation %.2f errors, lowest %.1f\n", modes[k].name, sum,
                      sqrt(squares), worst);
        assert_in_range((int)(100 * sqrt(squares)), 70, 130);
        assert_close(sum, 1, 0.1);
    }
}

/// Ten times the memory of a flow makes windows that know nothing more: of a decay with 4 the value
/// is hardly ever read at the end of the lags, and is known better than there, by its own error and
/// by scatter; of a short run, too.
static void test_green_kubo_does_not_read_the_end_of_long_lags(void **state) {
    (void)state;
    enum { FLUIDS = 40 };
    static const struct { size_t lags, samples; } runs[] = {{400, 4000}, {200, 1600}};
    static const struct modes modes = {"short", {0.5, 0.5, 0}, {0, 4, 0}};
    for (int k = 0; k < 2; k++) {
        const size_t lags = runs[k].lags, samples = runs[k].samples;
        double window = 0, squares = 0, error = 0, end = 0;
        for (uint64_t run = 1; run <= FLUIDS; run++) {
            const struct green_kubo_summary s = simulate_modes(run, &modes, lags, samples);
            window += (double)s.window / FLUIDS;
            squares += pow(s.value - 1, 2) / FLUIDS;
            error += s.error / FLUIDS;
            end += s.window == lags ? 1.0 / FLUIDS : 0;
        }
        // Of the whole window: I(k) of white noise has a variance of about 4 k/(5 n).
        const double whole = sqrt(4.0 * (double)lags / (COMPONENTS * (double)samples));
        print_message("window %.0f of %zu, %.0f %% at its end, scatter %.3f, error %.3f, of the "
                      "whole window %.3f\n",
                      window, lags, 100 * end, sqrt(squares), error, whole);
        assert_true(window < (double)lags / 3 && end < 0.2);
        assert_true(sqrt(squares) < 0.9 * whole && error < 0.9 * whole);
    }
}

static void test_green_kubo_tells_that_a_window_is_too_short(void **state) {
    (void)state;
    int reached = 0;
    for (uint64_t run = 1; run <= RUNS; run++)
        reached += simulate(run, exp(-1.0 / 100), 64, 20000).reached;
    print_message("%d of %d\n", reached, RUNS);
    assert_in_range(reached, 0, 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_green_kubo_knows_white_noise_and_its_own_error),
        cmocka_unit_test(test_green_kubo_knows_a_decay_and_its_own_error),
        cmocka_unit_test(test_green_kubo_error_covers_a_tail_that_noise_hides),
        cmocka_unit_test(test_green_kubo_does_not_read_the_end_of_long_lags),
        cmocka_unit_test(test_green_kubo_tells_that_a_window_is_too_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
