// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_resample.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/// Points that a cubic goes through, and with the next one; neighbours that tell the scatter.
enum { CUBIC = 4, NEXT = CUBIC + 1, AROUND = 6 };

static double mean_step(const struct target_rows *rows) {
    return (rows->x[rows->count - 1] - rows->x[0]) / (double)(rows->count - 1);
}

bool mf_target_resample_is_needed(const struct target_rows *rows) {
    static const double rounding = 0.01;
    bool needed = false;
    for (size_t k = 1; k < rows->count; k++)
        needed = needed || fabs((rows->x[k] - rows->x[k - 1]) / mean_step(rows) - 1) > rounding;
    return needed && rows->count >= NEXT;
}

/// Lagrange's weights of points in the polynomial through them at x.
static void find_weights(const struct target_rows *rows, const size_t *point, size_t count,
                         double x, double *weight) {
    for (size_t i = 0; i < count; i++) {
        weight[i] = 1;
        for (size_t j = 0; j < count; j++)
            if (j != i)
                weight[i] *= (x - rows->x[point[j]]) / (rows->x[point[i]] - rows->x[point[j]]);
    }
}

static double sum_of(const struct target_rows *rows, const size_t *point, const double *weight,
                     size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += weight[i] * rows->y[point[i]];
    return sum;
}

/// How far a point is from the quintic through its six neighbours, which a curve at such steps is
/// nearer to than noise is, squared and over the variance of that if each has 1; and the square of
/// how steep g is there, the mean over these points by the same variances.
struct difference {
    double square, steepness;
};

static double slope_of(const struct target_rows *rows, size_t k) {
    const size_t low = k > 0 ? k - 1 : 0, high = k + 1 < rows->count ? k + 1 : k;
    return (rows->y[high] - rows->y[low]) / (rows->x[high] - rows->x[low]);
}

/// Of all points where g is not in its core; returns how many there are.
static size_t find_differences(const struct target_rows *rows, struct difference *difference) {
    static const double min_g = 0.2;
    size_t count = 0;
    for (size_t k = 3; k + 3 < rows->count; k++) {
        const size_t point[AROUND] = {k - 3, k - 2, k - 1, k + 1, k + 2, k + 3};
        double weight[AROUND], variance = 1, steep = pow(slope_of(rows, k), 2);
        find_weights(rows, point, AROUND, rows->x[k], weight);
        for (size_t i = 0; i < AROUND; i++) {
            variance += weight[i] * weight[i];
            steep += pow(weight[i] * slope_of(rows, point[i]), 2);
        }
        if (rows->y[k - 3] > min_g && rows->y[k] > min_g)
            difference[count++] = (struct difference){
                pow(rows->y[k] - sum_of(rows, point, weight, AROUND), 2) / variance,
                steep / variance};
    }
    return count;
}

static int compare_steepness(const void *a, const void *b) {
    const double x = ((const struct difference *)a)->steepness,
                 y = ((const struct difference *)b)->steepness;
    return (x > y) - (x < y);
}

/// σ_r² of squares whose mean is σ_g² + σ_r² g'², by weighted least squares: each scatters as much
/// as it is. Squares beyond three standard deviations are left out.
static double find_variance_in_r(const struct difference *difference, size_t count,
                                 double variance) {
    enum { ROUNDS = 10 };
    static const double clip = 9, clipped_mean = 0.9733;
    double in_r = INFINITY; // at first all are weighted as if nothing else were
    for (int round = 0; round < ROUNDS; round++) {
        double excess = 0, weights = 0;
        for (size_t k = 0; k < count; k++) {
            const double steep = difference[k].steepness;
            const double expected = isinf(in_r) ? 1 : variance + in_r * steep;
            if (!isinf(in_r) && difference[k].square > clip * expected)
                continue;
            excess += steep * (difference[k].square / (isinf(in_r) ? 1 : clipped_mean) - variance) /
                      (expected * expected);
            weights += pow(steep / expected, 2);
        }
        in_r = weights > 0 ? fmax(0, excess / weights) : 0;
    }
    return in_r;
}

/// The errors of points in g and in r: the first by those where g is flat. Sorts the differences.
static enum status find_errors(struct difference *difference, size_t count,
                               struct target_resampling *done) {
    OWNED double *square = NULL;
    const size_t flat = (count + 1) / 2;
    qsort(difference, count, sizeof *difference, compare_steepness);
    TRY_ARRAY(square, flat);
    for (size_t k = 0; k < flat; k++)
        square[k] = difference[k].square;
    const double variance = mf_target_rows_robust_mean(square, flat);
    done->error = sqrt(variance);
    done->error_in_r = sqrt(find_variance_in_r(difference, count, variance));
    return STATUS_OK;
}

/// The errors of points by their scatter, or `assumed` if there is none.
static enum status set_errors(struct target_rows *rows, double assumed,
                              struct target_resampling *done) {
    enum { MIN = 24 };
    OWNED struct difference *difference = NULL;
    TRY_ARRAY(difference, rows->count);
    const size_t count = find_differences(rows, difference);
    if (count >= MIN)
        TRY(find_errors(difference, count, done));
    done->assumed = !(done->error > target_rows_min_scatter);
    if (done->assumed) {
        done->error = assumed;
        done->error_in_r = 0;
    }
    for (size_t k = 0; k < rows->count; k++)
        rows->error[k] = hypot(done->error, done->error_in_r * slope_of(rows, k));
    return STATUS_OK;
}

/// The last point at or before x, but for the last of all.
static size_t find_point(const struct target_rows *rows, double x) {
    size_t k = 0;
    while (k + 2 < rows->count && rows->x[k + 1] <= x)
        k++;
    return k;
}

/// Points about x in the order in which polynomials take them: the two beside it, then one more to
/// each side in turn, the nearer side first.
static void choose_points(const struct target_rows *rows, double x, size_t point[NEXT]) {
    size_t low = find_point(rows, x), high = low + 1, found = 0;
    bool left = x - rows->x[low] < rows->x[high] - x;
    point[found++] = low;
    point[found++] = high;
    while (found < NEXT) {
        if (left && low > 0)
            point[found++] = --low;
        else if (!left && high + 1 < rows->count)
            point[found++] = ++high;
        left = !left;
    }
}

/// g at x, its error by that of the points, and what the interpolation adds.
struct reading {
    double g, error, interpolation;
};

static struct reading read_at(const struct target_rows *rows, double x, double width) {
    size_t point[NEXT];
    double cubic[CUBIC], next[NEXT];
    choose_points(rows, x, point);
    find_weights(rows, point, CUBIC, x, cubic);
    find_weights(rows, point, NEXT, x, next);
    const size_t low = point[0], high = point[1];
    const double gap = rows->x[high] - rows->x[low];
    const double share = fmin(1, fmax(0, (x - rows->x[low]) / gap));
    struct reading reading = {.g = sum_of(rows, point, cubic, CUBIC)};
    reading.error =
        ((1 - share) * rows->error[low] + share * rows->error[high]) * sqrt(fmax(1, gap / width));
    reading.interpolation = fabs(sum_of(rows, point, next, NEXT) - reading.g);
    // In the core, and where a cubic swings below 0.
    if (reading.g <= 0 || (rows->y[low] == 0 && rows->y[high] == 0))
        reading = (struct reading){0};
    return reading;
}

/// Make one point of those that nearly coincide, between which a cubic would be steep by chance.
static void merge_close(struct target_rows *rows) {
    static const double close = 0.3;
    const double apart = close * mean_step(rows);
    size_t merged = 0;
    for (size_t k = 0, next; k < rows->count; k = next) {
        double r = 0, g = 0, squares = 0;
        for (next = k; next < rows->count && rows->x[next] - rows->x[k] <= apart; next++) {
            r += rows->x[next];
            g += rows->y[next];
            squares += rows->error[next] * rows->error[next];
        }
        const double points = (double)(next - k);
        rows->x[merged] = r / points;
        rows->y[merged] = g / points;
        rows->error[merged] = sqrt(squares) / points;
        rows->line[merged++] = rows->line[k];
    }
    rows->count = merged;
}

/// Where points are farther apart than this many mean steps, and not both in the core, g between
/// them is not known.
static enum status check_gaps(const struct target_rows *rows, const char *file) {
    static const double widest = 4;
    for (size_t k = 1; k < rows->count; k++) {
        const double steps = (rows->x[k] - rows->x[k - 1]) / mean_step(rows);
        if (steps > widest && rows->y[k] + rows->y[k - 1] > 0)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: a gap in r of %.2g mean steps: add rows in it, or end "
                                  "the target before it by \"cutoff\"",
                                  file, rows->line[k], steps);
    }
    return STATUS_OK;
}

/// Where equally spaced rows lie: as near to the points as they can on the whole, and within their
/// range; the first bin does not begin below 0.
static struct target_grid {
    double first, width;
    size_t count;
} find_grid(const struct target_rows *rows) {
    static const double beyond = 0.1, rounding = 0.01;
    const double width = mean_step(rows), begin = rows->x[0] - beyond * width,
                 end = rows->x[rows->count - 1] + beyond * width;
    double offset = 0;
    for (size_t k = 0; k < rows->count; k++)
        offset += (rows->x[k] - (double)k * width) / (double)rows->count;
    double first = offset - width * floor((offset - begin) / width);
    first += first < (0.5 - rounding) * width ? width : 0;
    return (struct target_grid){first, width, 1 + (size_t)floor((end - first) / width)};
}

static void describe(const struct target_rows *rows, struct target_resampling *done) {
    done->points = rows->count;
    done->shortest = INFINITY;
    for (size_t k = 1; k < rows->count; k++) {
        done->shortest = fmin(done->shortest, rows->x[k] - rows->x[k - 1]);
        done->longest = fmax(done->longest, rows->x[k] - rows->x[k - 1]);
    }
}

enum status mf_target_resample(struct target_rows *rows, const char *file, bool has_errors,
                               double assumed, struct target_resampling *done) {
    CLEARED_BY(mf_target_rows_clear) struct target_rows equal = {.dimensions = rows->dimensions};
    *done = (struct target_resampling){0};
    describe(rows, done);
    merge_close(rows);
    if (rows->count < NEXT)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu points at different r", file,
                              rows->count);
    TRY(check_gaps(rows, file));
    if (!has_errors)
        TRY(set_errors(rows, assumed, done));
    const struct target_grid grid = find_grid(rows);
    TRY(mf_target_rows_allocate(&equal, grid.count));
    for (size_t k = 0; k < grid.count; k++) {
        const double r = grid.first + (double)k * grid.width;
        const struct reading at = read_at(rows, r, grid.width);
        equal.x[k] = r;
        equal.y[k] = at.g;
        equal.error[k] = hypot(at.error, at.interpolation);
        equal.line[k] = rows->line[find_point(rows, r)];
        if (at.interpolation > done->interpolation) {
            done->interpolation = at.interpolation;
            done->interpolation_at = r;
        }
    }
    mf_target_rows_clear(rows);
    *rows = equal;
    equal = (struct target_rows){0};
    return STATUS_OK;
}
