// SPDX-License-Identifier: GPL-3.0-or-later
//
// MSD, VACF and D of the windows that are complete.
#include "base/memory.h"
#include "base/statistics.h"
#include "observe/motion.h"

#include <math.h>

// What is read of a curve is linear in it: its mean over blocks is that of the mean curve.

static double read_lag(const struct motion *motion, const double *curve, size_t lag) {
    (void)motion;
    return curve[lag];
}

/// The line on the MSD begins at half of the window.
static size_t fit_first(const struct motion_plan *plan) {
    return (size_t)(plan->lags + 1) / 2;
}

static double lag_time(const struct motion *motion, size_t lag) {
    return (double)lag * (double)motion->plan.every * motion->time_step;
}

/// Slope of the line a + b t of least squares between two lags, over 2d.
static double find_slope(const struct motion *motion, const double *curve, size_t first,
                         size_t last) {
    const double middle = 0.5 * (lag_time(motion, first) + lag_time(motion, last));
    double above = 0, below = 0;
    for (size_t lag = first; lag <= last; lag++) {
        const double t = lag_time(motion, lag) - middle;
        above += t * curve[lag];
        below += t * t;
    }
    return above / below / (2 * motion->dimensions);
}

static double read_slope(const struct motion *motion, const double *curve, size_t unused) {
    (void)unused;
    return find_slope(motion, curve, fit_first(&motion->plan), (size_t)motion->plan.lags);
}

/// What the slope changes by from the first half of the line to the second, over as many lags.
static double read_bend(const struct motion *motion, const double *curve, size_t unused) {
    (void)unused;
    const size_t first = fit_first(&motion->plan), last = (size_t)motion->plan.lags;
    const size_t half = (last - first) / 2;
    return half == 0 ? NAN
                     : find_slope(motion, curve, last - half, last) -
                           find_slope(motion, curve, first, first + half);
}

/// Trapezoids over the whole window, over d.
static double read_integral(const struct motion *motion, const double *curve, size_t unused) {
    (void)unused;
    const size_t last = (size_t)motion->plan.lags;
    double sum = 0.5 * (curve[0] + curve[last]);
    for (size_t lag = 1; lag < last; lag++)
        sum += curve[lag];
    return sum * lag_time(motion, 1) / motion->dimensions;
}

/// Trapezoids between two lags, each over `every` intervals, over d.
static double integrate(const struct motion *motion, const double *curve, size_t from, size_t to,
                        size_t every) {
    double sum = 0;
    for (size_t lag = from; lag + every <= to; lag += every)
        sum += 0.5 * (curve[lag] + curve[lag + every]);
    return sum * lag_time(motion, every) / motion->dimensions;
}

/// What trapezoids of twice the width differ by.
static double read_coarser(const struct motion *motion, const double *curve, size_t unused) {
    (void)unused;
    const size_t even = (size_t)motion->plan.lags / 2 * 2;
    return integrate(motion, curve, 0, even, 2) - integrate(motion, curve, 0, even, 1);
}

static double read_second_half(const struct motion *motion, const double *curve, size_t unused) {
    (void)unused;
    const size_t last = (size_t)motion->plan.lags;
    return integrate(motion, curve, last / 2, last, 1);
}

static void average(const struct motion *motion, const double *sums,
                    double (*read)(const struct motion *motion, const double *curve, size_t lag),
                    size_t lag, double *mean, double *error) {
    double values[MOTION_MAX_BLOCKS];
    struct running_mean all = {0};
    const size_t blocks = mf_motion_blocks(motion), curve = (size_t)motion->plan.lags + 1;
    for (size_t b = 0; b < blocks; b++) {
        values[b] = read(motion, sums + b * curve, lag) / (double)motion->each;
        mf_statistics_add(&all, values[b]);
    }
    *mean = blocks > 0 ? all.mean : NAN;
    *error = mf_statistics_correlated_error(values, blocks, 1);
}

/// What D of the VACF may be off besides its statistical error.
static void find_systematic(const struct motion *motion, struct motion_summary *s) {
    double coarser, half, error, start, next;
    average(motion, motion->products, read_coarser, 0, &coarser, &error);
    s->green_kubo_sampling = fabs(coarser) / 3;
    average(motion, motion->products, read_second_half, 0, &half, &error);
    s->green_kubo_truncation = isnan(half) ? NAN : fmax(0, fabs(half) - (isnan(error) ? 0 : error));
    average(motion, motion->products, read_lag, 0, &start, &error);
    average(motion, motion->products, read_lag, 1, &next, &error);
    s->vacf_drop = 1 - next / start;
}

/// Its error is that of both ends together, block by block: what makes one of them large makes the
/// other large, too, and their ratio is known much better than either.
static void find_growth(const struct motion *motion, struct motion_summary *s) {
    const size_t first = fit_first(&motion->plan), last = (size_t)motion->plan.lags;
    const size_t blocks = mf_motion_blocks(motion);
    const double way = log((double)last / (double)first);
    double begin, end, unused, deviations[MOTION_MAX_BLOCKS];
    average(motion, motion->squares, read_lag, first, &begin, &unused);
    average(motion, motion->squares, read_lag, last, &end, &unused);
    for (size_t b = 0; b < blocks; b++) {
        const double *const sums = motion->squares + b * (last + 1);
        deviations[b] = (sums[last] / end - sums[first] / begin) / (double)motion->each / way;
    }
    s->growth = log(end / begin) / way;
    average(motion, motion->squares, read_bend, 0, &s->bend, &s->bend_error);
    s->bend /= s->msd;
    s->bend_error /= fabs(s->msd);
    s->sizes = motion->gyration[0] > 0 ? begin * motion->gyration[1] / motion->gyration[0] : 0;
    s->growth_error = mf_statistics_correlated_error(deviations, blocks, 1);
}

struct motion_summary mf_motion_result(const struct motion *motion,
                                       const struct motion_curves *curves) {
    struct motion_summary s = {0};
    const size_t lags = (size_t)motion->plan.lags;
    for (size_t lag = 0; curves && lag <= lags; lag++) {
        average(motion, motion->squares, read_lag, lag, &curves->msd[lag], &curves->msd_error[lag]);
        average(motion, motion->products, read_lag, lag, &curves->vacf[lag],
                &curves->vacf_error[lag]);
    }
    average(motion, motion->squares, read_slope, 0, &s.msd, &s.msd_error);
    average(motion, motion->products, read_integral, 0, &s.green_kubo, &s.green_kubo_error);
    find_systematic(motion, &s);
    s.blocks = (double)mf_motion_blocks(motion);
    s.fit_begin = lag_time(motion, fit_first(&motion->plan));
    s.fit_end = lag_time(motion, lags);
    find_growth(motion, &s);
    s.maxwell = mf_maxwell_result(&motion->maxwell);
    return s;
}

enum status mf_motion_table(const struct motion *motion, double **columns) {
    const size_t rows = (size_t)motion->plan.lags + 1;
    double *column[MOTION_COLUMNS] = {NULL};
    *columns = NULL;
    TRY_ARRAY(*columns, MOTION_COLUMNS * rows);
    for (size_t n = 0; n < MOTION_COLUMNS; n++)
        column[n] = *columns + n * rows;
    mf_motion_result(motion, &(struct motion_curves){column[1], column[2], column[3], column[4]});
    mf_statistics_mark_unknown_errors(column[2], rows);
    mf_statistics_mark_unknown_errors(column[4], rows);
    for (size_t k = 0; k < rows; k++)
        column[0][k] = lag_time(motion, k);
    return STATUS_OK;
}
