// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Outside of these a number is written with a power of ten.
static const double largest = 1e6, smallest = 1e-4;

/// Power of ten of a number's first digit once it is rounded to two: that of 0.0996 is −1.
static int first_digit(double number) {
    char rounded[32];
    snprintf(rounded, sizeof rounded, "%.1e", number);
    return atoi(strchr(rounded, 'e') + 1);
}

void mf_number_text(double value, double error, char text[NUMBER_TEXT_SIZE]) {
    const double size = fmax(fabs(value), error);
    if (!(error > 0) || !isfinite(value + error)) {
        snprintf(text, NUMBER_TEXT_SIZE, "%.4g", value);
        return;
    }
    const int power = size >= largest || size < smallest ? first_digit(size) : 0;
    const double unit = pow(10, power);
    const int last = first_digit(error / unit) - 1; // digit of both, after the point if below 0
    const int decimals = last < 0 ? -last : 0;
    // An error of one and more is written out: 23.6(1.3).
    const bool written_out = last >= -1;
    const int length =
        snprintf(text, NUMBER_TEXT_SIZE, "%.*f(%.*f)", decimals, value / unit,
                 written_out ? decimals : 0, error / unit * (written_out ? 1 : pow(10, decimals)));
    if (power != 0)
        snprintf(text + length, NUMBER_TEXT_SIZE - (size_t)length, "e%d", power);
}
