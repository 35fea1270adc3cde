// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/normal.h"

#include <math.h>
#include <string.h>

/// The number that a normal one exceeds with probability p ≤ ½: Newton's method on the logarithm of
/// the tail, which is nearly straight in z², from the left.
static double quantile(double p) {
    double z = 0;
    for (int n = 0; n < 40; n++) {
        const double tail = 0.5 * erfc(z * M_SQRT1_2);
        const double density = exp(-0.5 * z * z) * M_SQRT1_2 / sqrt(M_PI);
        const double step = log(tail / p) * tail / density;
        z += step;
        if (fabs(step) < 1e-15)
            break;
    }
    return z;
}

/// The cubic that meets the quantile at Chebyshev's four nodes of a piece, by divided differences.
static void fit_piece(double begin, double width, double coefficient[4]) {
    double place[4], slope[4];
    for (int n = 0; n < 4; n++) {
        place[n] = 0.5 - 0.5 * cos(M_PI * (2 * n + 1) / 8);
        slope[n] = quantile((begin + place[n] * width) * 0x1p-32);
    }
    for (int order = 1; order < 4; order++)
        for (int n = 3; n >= order; n--)
            slope[n] = (slope[n] - slope[n - 1]) / (place[n] - place[n - order]);
    memset(coefficient, 0, 4 * sizeof *coefficient);
    for (int n = 3; n >= 0; n--) {
        for (int power = 3; power > 0; power--)
            coefficient[power] = coefficient[power - 1] - place[n] * coefficient[power];
        coefficient[0] = slope[n] - place[n] * coefficient[0];
    }
}

void mf_normal_table_init(struct normal_table *table) {
    memset(table, 0, sizeof *table);
    for (int row = 0; row < NORMAL_ROWS - 1; row++) {
        const double octave = ldexp(0.5, row / NORMAL_PIECES), width = octave / NORMAL_PIECES;
        fit_piece(octave + row % NORMAL_PIECES * width, width, table->precise[row]);
        for (int n = 0; n < 4; n++)
            table->single[row][n] = (float)table->precise[row][n];
    }
}
