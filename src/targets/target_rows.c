// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_rows.h"

#include "base/memory.h"
#include "system/box.h"

#include <math.h>
#include <stdlib.h>

/// Where g is below, it is too steep for the scatter to be told from its slope.
static const double least_g = 0.2;

/// Fourth differences and how many are needed.
enum { TAPS = 5, LEAST_DIFFERENCES = 12 };
static const double taps[TAPS] = {1, -4, 6, -4, 1};

/// Differences beyond three standard deviations are left out; the mean square of what a normal
/// distribution has within them, and the median square of all of it.
static const double clip = 9, clipped_mean = 0.9733, median_square = 0.4549;

void mf_target_rows_clear(struct target_rows *rows) {
    mf_memory_free(rows->r);
    mf_memory_free(rows->g);
    mf_memory_free(rows->error);
    mf_memory_free(rows->line);
    *rows = (struct target_rows){0};
}

enum status mf_target_rows_allocate(struct target_rows *rows, size_t count) {
    enum status status = STATUS_OK;
    rows->count = count;
    NEW_ARRAY(rows->r, count);
    NEW_ARRAY(rows->g, count);
    NEW_ARRAY(rows->error, count);
    NEW_ARRAY(rows->line, count);
done:
    return status;
}

struct target_tail mf_target_rows_tail(const struct target_rows *rows) {
    const double from = 0.75 * rows->r[rows->count - 1];
    double count = 0, sum = 0, squares = 0;
    struct target_tail tail = {.grows = rows->g[rows->count - 1] > rows->g[0]};
    for (size_t k = 0; k < rows->count; k++) {
        tail.grows = tail.grows && (k == 0 || rows->g[k] >= rows->g[k - 1]);
        if (rows->r[k] <= from)
            continue;
        count++;
        sum += rows->g[k];
        squares += rows->g[k] * rows->g[k];
    }
    tail.mean = sum / count;
    tail.scatter = sqrt(fmax(0, squares / count - tail.mean * tail.mean));
    return tail;
}

static double width_of(const struct target_rows *rows) {
    return (rows->r[rows->count - 1] - rows->r[0]) / (double)(rows->count - 1);
}

/// Of the shell of row k; a centre that the file rounds may bring its begin below 0.
static double volume(const struct target_rows *rows, size_t k, double width) {
    const struct box space = {.dimensions = rows->dimensions == 2 ? 2 : 3};
    return mf_box_shell_volume(&space, fmax(0, rows->r[k] - 0.5 * width), rows->r[k] + 0.5 * width);
}

/// d²/Σ b_j² g_j/v_j of all differences where g is large enough; returns how many.
static size_t differences(const struct target_rows *rows, double *square) {
    const double width = width_of(rows);
    size_t count = 0;
    for (size_t k = 0; k + TAPS <= rows->count; k++) {
        double difference = 0, variance = 0, least = INFINITY;
        for (size_t j = 0; j < TAPS; j++) {
            difference += taps[j] * rows->g[k + j];
            variance += taps[j] * taps[j] * rows->g[k + j] / volume(rows, k + j, width);
            least = fmin(least, rows->g[k + j]);
        }
        if (least > least_g)
            square[count++] = difference * difference / variance;
    }
    return count;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double mf_target_rows_robust_mean(double *square, size_t count) {
    enum { ROUNDS = 5 };
    qsort(square, count, sizeof *square, compare);
    double variance = square[count / 2] / median_square;
    for (int round = 0; round < ROUNDS; round++) {
        double sum = 0;
        size_t within = 0;
        while (within < count && square[within] <= clip * variance)
            sum += square[within++];
        variance = within > 0 ? sum / (double)within / clipped_mean : 0;
    }
    return variance;
}

enum status mf_target_rows_scatter(const struct target_rows *rows, double *error) {
    enum status status = STATUS_OK;
    double *square = NULL;
    *error = NAN;
    NEW_ARRAY(square, rows->count);
    const size_t count = differences(rows, square);
    if (count < LEAST_DIFFERENCES)
        goto done;
    const double variance = mf_target_rows_robust_mean(square, count);
    const double scatter = sqrt(variance / volume(rows, rows->count - 1, width_of(rows)));
    if (scatter > target_rows_least_scatter)
        *error = scatter;
done:
    mf_memory_free(square);
    return status;
}

void mf_target_rows_set_errors(struct target_rows *rows, double error) {
    const double width = width_of(rows), last = volume(rows, rows->count - 1, width);
    for (size_t k = 0; k < rows->count; k++)
        rows->error[k] = error * sqrt(rows->g[k] * last / volume(rows, k, width));
}

void mf_target_rows_join(struct target_rows *rows, size_t of) {
    const double width = width_of(rows);
    const size_t count = rows->count / of;
    for (size_t n = 0; n < count; n++) {
        double r = 0, whole = 0, g = 0, squares = 0;
        for (size_t k = n * of; k < (n + 1) * of; k++) {
            const double part = volume(rows, k, width);
            r += rows->r[k] / (double)of;
            whole += part;
            g += part * rows->g[k];
            squares += pow(part * rows->error[k], 2);
        }
        rows->r[n] = r;
        rows->g[n] = g / whole;
        rows->error[n] = sqrt(squares) / whole;
        rows->line[n] = rows->line[n * of];
    }
    rows->count = count;
}
