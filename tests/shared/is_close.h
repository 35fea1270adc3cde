// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Comparison of floating-point numbers. Tested: test_is_close.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// |a − b| ≤ tolerance, for finite a and b only: NaN and infinities are close to nothing.
bool is_close(double a, double b, double tolerance);

/// |a − b| ≤ tolerance · max(|a|, |b|), for finite a and b only.
bool is_close_relative(double a, double b, double tolerance);

/// Same bits: tells −0 from 0, and a NaN is the same as itself.
bool is_identical(double a, double b);

/// cmocka checks that print the numbers when they fail.
#define assert_close(a, b, tolerance)                                                              \
    do {                                                                                           \
        if (!is_close((a), (b), (tolerance)))                                                      \
            fail_msg("%s = %.17g is not within %g of %.17g", #a, (double)(a), (double)(tolerance), \
                     (double)(b));                                                                 \
    } while (0)

#define assert_close_relative(a, b, tolerance)                                                     \
    do {                                                                                           \
        if (!is_close_relative((a), (b), (tolerance)))                                             \
            fail_msg("%s = %.17g is not within %g times %.17g", #a, (double)(a),                   \
                     (double)(tolerance), (double)(b));                                            \
    } while (0)

#define assert_identical(a, b)                                                                     \
    do {                                                                                           \
        if (!is_identical((a), (b)))                                                               \
            fail_msg("%s = %.17g differs from %.17g", #a, (double)(a), (double)(b));               \
    } while (0)
