// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/polarity.h"

#include "base/memory.h"
#include "base/statistics.h"

#include <math.h>

/// D_t, v_0² and D_r that fit an MSD.
struct law {
    double diffusion, square_speed, turning, misfit;
};

enum { MAX_BLOCKS = 64, GRID = 48, REFINED = 40 };

/// A curve of MSD without time 0, its times, and of a law its two basis functions.
struct displacements {
    size_t count;
    double *time, *msd, *walk, *persist;
};

/// The best law of this D_r: linear least squares of 4 D_t t + v_0² persistence(t), each over the
/// MSD, so that all points count alike.
static struct law fit_linear(const struct displacements *curve, double turning) {
    const struct brownian_free unit = {.speed = 1, .orientation_diffusion = turning};
    double ww = 0, wp = 0, pp = 0, w1 = 0, p1 = 0, misfit = 0;
    for (size_t k = 0; k < curve->count; k++) {
        const double w = 4 * curve->time[k] / curve->msd[k];
        const double p = mf_brownian_free_msd(&unit, curve->time[k]) / curve->msd[k];
        curve->walk[k] = w;
        curve->persist[k] = p;
        ww += w * w;
        wp += w * p;
        pp += p * p;
        w1 += w;
        p1 += p;
    }
    const double determinant = ww * pp - wp * wp;
    const bool apart = determinant > 1e-10 * ww * pp; // else both are lines
    struct law law = {.diffusion = apart ? (w1 * pp - p1 * wp) / determinant : w1 / ww,
                      .square_speed = apart ? (p1 * ww - w1 * wp) / determinant : 0,
                      .turning = turning};
    for (size_t k = 0; k < curve->count; k++)
        misfit += pow(law.diffusion * curve->walk[k] + law.square_speed * curve->persist[k] - 1, 2);
    law.misfit = misfit;
    return law;
}

/// The best of a grid of D_r, refined by golden sections.
static struct law fit_law(const struct displacements *curve) {
    static const double golden = 0.6180339887498949;
    const double low = log(0.01 / curve->time[curve->count - 1]), high = log(10 / curve->time[0]);
    const double width = (high - low) / (GRID - 1);
    struct law best = {.misfit = INFINITY};
    for (int n = 0; n < GRID; n++) {
        const struct law law = fit_linear(curve, exp(low + n * width));
        best = law.misfit < best.misfit ? law : best;
    }
    double left = log(best.turning) - width, right = log(best.turning) + width;
    for (int n = 0; n < REFINED && isfinite(best.misfit); n++) {
        const double a = right - golden * (right - left), b = left + golden * (right - left);
        const struct law first = fit_linear(curve, exp(a)), second = fit_linear(curve, exp(b));
        best = first.misfit < best.misfit ? first : best;
        best = second.misfit < best.misfit ? second : best;
        if (first.misfit < second.misfit)
            right = b;
        else
            left = a;
    }
    // At an end of the range the curve says no more than that D_r is beyond it.
    if (!(log(best.turning) > low && log(best.turning) < high))
        best = (struct law){.diffusion = NAN, .square_speed = NAN, .turning = NAN};
    return best;
}

/// The MSD of all blocks but one; `without` beyond them: of all.
static void take_curve(const struct motion *motion, size_t blocks, size_t without,
                       struct displacements *curve) {
    const size_t lags = (size_t)motion->plan.lags;
    const double used = (double)(without < blocks ? blocks - 1 : blocks);
    for (size_t lag = 1; lag <= lags; lag++) {
        double sum = 0;
        for (size_t b = 0; b < blocks; b++)
            sum += b == without ? 0 : motion->squares[b * (lags + 1) + lag];
        curve->msd[lag - 1] = sum / (used * (double)motion->each);
        curve->time[lag - 1] = (double)lag * (double)motion->plan.every * motion->time_step;
    }
}

static void find_numbers(const struct law *law, double number[3]) {
    number[0] = isnan(law->turning) ? NAN : sqrt(fmax(0, law->square_speed));
    number[1] = law->turning;
    number[2] = law->diffusion + law->square_speed / (2 * law->turning);
}

/// The pseudo-values of M. H. Quenouille (Biometrika 43, 353 (1956)) are a series like any other.
static void find_errors(const struct motion *motion, size_t blocks, struct displacements *curve,
                        const double number[3], double error[3]) {
    double series[3][MAX_BLOCKS], part[3];
    for (size_t b = 0; b < blocks; b++) {
        take_curve(motion, blocks, b, curve);
        const struct law law = fit_law(curve);
        find_numbers(&law, part);
        for (int n = 0; n < 3; n++)
            series[n][b] = (double)blocks * number[n] - ((double)blocks - 1) * part[n];
    }
    for (int n = 0; n < 3; n++)
        error[n] = mf_statistics_correlated_error(series[n], blocks, 1);
}

struct polarity_fit mf_polarity_fit(const struct polarity *polarity) {
    const struct motion *motion = &polarity->motion;
    const size_t blocks = mf_motion_blocks(motion), lags = (size_t)motion->plan.lags;
    double number[3] = {NAN, NAN, NAN}, error[3] = {NAN, NAN, NAN};
    double *memory = mf_memory_zeroed(4 * lags, sizeof *memory);
    if (memory && blocks >= 2) {
        struct displacements curve = {lags, memory, memory + lags, memory + 2 * lags,
                                      memory + 3 * lags};
        take_curve(motion, blocks, blocks, &curve);
        const struct law law = fit_law(&curve);
        find_numbers(&law, number);
        find_errors(motion, blocks, &curve, number, error);
    }
    mf_memory_free(memory);
    return (struct polarity_fit){number[0], error[0], number[1], error[1], number[2], error[2]};
}
