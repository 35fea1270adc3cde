// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/is_close.h"

#include <math.h>
#include <string.h>

bool is_close(double a, double b, double tolerance) {
    return isfinite(a) && isfinite(b) && isfinite(tolerance) && fabs(a - b) <= tolerance;
}

bool is_close_relative(double a, double b, double tolerance) {
    return is_close(a, b, tolerance * fmax(fabs(a), fabs(b)));
}

bool is_identical(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0;
}
