// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A small plot of text: dots of Braille, two across and four down in a character.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/// A curve; points that are not finite are left out.
struct watch_curve {
    const char *name;
    const double *x, *y;  ///< shape [count]
    size_t count, stride; ///< numbers from one point to the next
};

enum { WATCH_MOST_CURVES = 2, WATCH_TITLE_SIZE = 96 };

struct watch_plot {
    char title[WATCH_TITLE_SIZE];
    bool logarithmic; ///< y, of numbers above 0
    size_t curves;
    struct watch_curve curve[WATCH_MOST_CURVES];
};

/// Bytes of a line of `columns` characters of UTF-8, with its NUL.
#define WATCH_LINE_SIZE(columns) (3 * (size_t)(columns) + 8)

/// Draw into `rows` lines of WATCH_LINE_SIZE(columns) bytes each: title, dots, and a line with the
/// ranges. All lines are `columns` characters wide. A few high values, as of a core, are cut off
/// unless y is logarithmic.
/// Fails: NO_MEMORY. Tested: test_watch_plot.
enum status mf_watch_plot_draw(const struct watch_plot *plot, int columns, int rows,
                               char *lines) MUST_USE;
