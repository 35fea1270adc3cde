// SPDX-License-Identifier: GPL-3.0-or-later
#include "watch/watch_plot.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct range {
    double low, high;
};

/// What is drawn of a number, NaN if nothing is.
static double height(const struct watch_plot *plot, double y) {
    return !plot->logarithmic ? y : y > 0 ? log10(y) : NAN;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static size_t count_points(const struct watch_plot *plot) {
    size_t points = 0;
    for (size_t c = 0; c < plot->curves; c++)
        points += plot->curve[c].count;
    return points;
}

/// Ranges of all points that are drawn. Beyond four times the height of the lower half a curve is
/// cut, so that a core does not flatten the rest, but on a logarithmic axis, which has room for
/// all.
static enum status find_ranges(const struct watch_plot *plot, struct range *x, struct range *y) {
    enum status status = STATUS_OK;
    double *values = NULL;
    size_t n = 0;
    *x = (struct range){INFINITY, -INFINITY};
    NEW_ARRAY(values, count_points(plot) + 1);
    for (size_t c = 0; c < plot->curves; c++)
        for (size_t k = 0; k < plot->curve[c].count; k++) {
            const struct watch_curve *curve = &plot->curve[c];
            const double value = height(plot, curve->y[k * curve->stride]);
            if (!isfinite(value))
                continue;
            values[n++] = value;
            x->low = fmin(x->low, curve->x[k * curve->stride]);
            x->high = fmax(x->high, curve->x[k * curve->stride]);
        }
    qsort(values, n, sizeof *values, compare_numbers);
    *y = (struct range){0, 1};
    if (n > 0)
        *y = (struct range){values[0], values[n - 1]};
    const double middle = n > 0 ? values[n / 2] : 0, limit = middle + 4 * (middle - y->low);
    if (!plot->logarithmic && limit > y->low && y->high > limit + 2 * (limit - y->low))
        y->high = limit;
done:
    mf_memory_free(values);
    return status;
}

/// Where a number falls among `dots`, the first of which is 0.
static double place(double value, struct range range, int dots) {
    const double width = range.high - range.low;
    return (width > 0 ? (value - range.low) / width : 0.5) * (dots - 1);
}

/// Bits of the eight dots of a character: U+2800 and what is set (Unicode 15, Braille Patterns).
static unsigned bit_of(int across, int down) {
    static const unsigned char bits[4][2] = {{1, 8}, {2, 16}, {4, 32}, {64, 128}};
    return bits[down][across];
}

/// The dots of a plot.
struct canvas {
    int columns, rows; ///< characters
    unsigned char *cells;
};

static void set_dot(const struct canvas *canvas, double right, double up) {
    const int across = (int)lrint(right), down = 4 * canvas->rows - 1 - (int)lrint(up);
    if (across >= 0 && across < 2 * canvas->columns && down >= 0 && down < 4 * canvas->rows)
        canvas->cells[down / 4 * canvas->columns + across / 2] |=
            (unsigned char)bit_of(across % 2, down % 4);
}

/// A line from one point to the next, up to what is cut off far away.
static void set_line(const struct canvas *canvas, const double from[2], const double to[2]) {
    const double length = fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]));
    const int parts = length < 4000 ? (int)ceil(length) : 4000;
    for (int k = 1; k <= parts; k++)
        set_dot(canvas, from[0] + (to[0] - from[0]) * k / parts,
                from[1] + (to[1] - from[1]) * k / parts);
}

static void set_curve(const struct watch_plot *plot, const struct watch_curve *curve,
                      struct range x, struct range y, const struct canvas *canvas) {
    double before[2] = {0, NAN};
    for (size_t k = 0; k < curve->count; k++) {
        const double value = height(plot, curve->y[k * curve->stride]);
        const double now[2] = {place(curve->x[k * curve->stride], x, 2 * canvas->columns),
                               place(value, y, 4 * canvas->rows)};
        if (isfinite(value) && isfinite(before[1]))
            set_line(canvas, before, now);
        else if (isfinite(value))
            set_dot(canvas, now[0], now[1]);
        before[0] = now[0];
        before[1] = isfinite(value) ? now[1] : NAN;
    }
}

static void put_cells(const unsigned char *cells, int columns, char *line) {
    for (int k = 0; k < columns; k++) {
        *line++ = (char)0xe2;
        *line++ = (char)(0xa0 | cells[k] >> 6);
        *line++ = (char)(0x80 | (cells[k] & 63));
    }
    *line = '\0';
}

/// A text of ASCII, cut or filled with blanks.
static void put_text(const char *text, int columns, char *line) {
    snprintf(line, WATCH_LINE_SIZE(columns), "%-*.*s", columns, columns, text);
}

static void put_ranges(const struct watch_plot *plot, struct range x, struct range y, int columns,
                       char *line) {
    char text[160];
    const double low = plot->logarithmic ? pow(10, y.low) : y.low;
    const double high = plot->logarithmic ? pow(10, y.high) : y.high;
    snprintf(text, sizeof text, "x %.4g to %.4g   y %.4g to %.4g%s", x.low, x.high, low, high,
             plot->logarithmic ? " (log)" : "");
    put_text(text, columns, line);
}

enum status mf_watch_plot_draw(const struct watch_plot *plot, int columns, int rows, char *lines) {
    enum status status = STATUS_OK;
    const size_t size = WATCH_LINE_SIZE(columns);
    struct canvas canvas = {columns, rows - 2, NULL};
    struct range x, y;
    NEW_ARRAY(canvas.cells, (size_t)columns * (size_t)(rows > 2 ? rows - 2 : 1));
    CHECK(find_ranges(plot, &x, &y));
    for (size_t c = 0; c < plot->curves; c++)
        set_curve(plot, &plot->curve[c], x, y, &canvas);
    put_text(plot->title, columns, lines);
    for (int row = 0; row < rows - 2; row++)
        put_cells(canvas.cells + row * columns, columns, lines + (size_t)(row + 1) * size);
    put_ranges(plot, x, y, columns, lines + (size_t)(rows - 1) * size);
done:
    mf_memory_free(canvas.cells);
    return status;
}
