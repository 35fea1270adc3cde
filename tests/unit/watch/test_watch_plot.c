// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dots are counted by Unicode's numbering of Braille: 1 2 3 7 downwards on the left, 4 5 6 8.
#include "watch/watch_plot.h"
#include "shared/testing.h"

#include <math.h>

enum { COLUMNS = 2, ROWS = 4, WIDE = 40 };

static const char *line_of(const char *lines, int row, int columns) {
    return lines + (size_t)row * WATCH_LINE_SIZE(columns);
}

static void test_rising_line_goes_from_the_left_below_to_the_right_above(void **state) {
    static const double x[] = {0, 1, 2, 3}, y[] = {0, 1, 2, 7};
    const struct watch_plot plot = {.title = "a title", .curves = 1, .curve = {{"y", x, y, 4, 1}}};
    char lines[ROWS * WATCH_LINE_SIZE(COLUMNS)];
    (void)state;
    assert_ok(mf_watch_plot_draw(&plot, COLUMNS, ROWS, lines));
    assert_string_equal(line_of(lines, 0, COLUMNS), "a ");
    // Eight dots high. y = 0 and 1: left at the bottom (dot 7), right one above (dot 6), U+2860.
    // From y = 2 up to 7: dots 2 and 1 on the left, 7 of the line above, and 6, 5, 4 on the right.
    assert_string_equal(line_of(lines, 1, COLUMNS), "\u2800\u2878");
    assert_string_equal(line_of(lines, 2, COLUMNS), "\u2860\u2803");
}

static void test_lines_are_as_wide_as_asked_and_unknown_points_are_left_out(void **state) {
    static const double x[] = {0, 1, 2}, y[] = {NAN, 1, INFINITY};
    const struct watch_plot plot = {
        .title = "t", .logarithmic = true, .curves = 1, .curve = {{"y", x, y, 3, 1}}};
    char lines[ROWS * WATCH_LINE_SIZE(WIDE)];
    int dots = 0;
    (void)state;
    assert_ok(mf_watch_plot_draw(&plot, WIDE, ROWS, lines));
    assert_int_equal(strlen(line_of(lines, 0, WIDE)), WIDE);
    for (int row = 1; row < ROWS - 1; row++) {
        const char *line = line_of(lines, row, WIDE);
        assert_int_equal(strlen(line), 3 * WIDE);
        for (int k = 0; k < WIDE; k++)
            dots += memcmp(line + 3 * k, "\u2800", 3) != 0;
    }
    assert_int_equal(dots, 1);
    assert_contains(line_of(lines, ROWS - 1, WIDE), "(log)");
}

/// The error of a fit falls by decades and then lies flat: where it began must be seen.
static void test_logarithmic_curve_is_not_cut_off(void **state) {
    static const double x[] = {0, 1, 2, 3, 4, 5}, y[] = {1000, 50, 1.3, 1.2, 1.1, 1};
    const struct watch_plot plot = {
        .title = "t", .logarithmic = true, .curves = 1, .curve = {{"y", x, y, 6, 1}}};
    char lines[ROWS * WATCH_LINE_SIZE(WIDE)];
    (void)state;
    assert_ok(mf_watch_plot_draw(&plot, WIDE, ROWS, lines));
    assert_contains(line_of(lines, ROWS - 1, WIDE), "y 1 to 1000 (log)");
}

static void test_nothing_is_drawn_of_no_points(void **state) {
    const struct watch_plot plot = {.title = "t", .curves = 1, .curve = {{"y", NULL, NULL, 0, 1}}};
    char lines[ROWS * WATCH_LINE_SIZE(COLUMNS)];
    (void)state;
    assert_ok(mf_watch_plot_draw(&plot, COLUMNS, ROWS, lines));
    assert_string_equal(line_of(lines, 1, COLUMNS), "\u2800\u2800");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rising_line_goes_from_the_left_below_to_the_right_above),
        cmocka_unit_test(test_lines_are_as_wide_as_asked_and_unknown_points_are_left_out),
        cmocka_unit_test(test_logarithmic_curve_is_not_cut_off),
        cmocka_unit_test(test_nothing_is_drawn_of_no_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
