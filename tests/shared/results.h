// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Checks of what a run leaves in its folder. They fail the test with the file's name.
#pragma once

#include <stddef.h>

/// A table of numbers: one comment line, the header, first; every line has as many columns.
/// @param[in] columns, rows  expected; 0: any number but none
void results_assert_table(const char *file, size_t columns, size_t rows);

/// The files `names`, NULL-terminated, have the same bytes in the folders `first` and `second`.
void results_assert_same(const char *first, const char *second, const char *const *names);
void results_assert_differ(const char *first, const char *second, const char *name);

/// The finite number at `key` of a JSON file; "physical.pressure_bar" is in an object, and so on.
double results_number(const char *file, const char *key);
void results_assert_number(const char *file, const char *key, double expected);

/// There are finite numbers at all `keys`, NULL-terminated.
void results_assert_numbers(const char *file, const char *const *keys);
void results_assert_text(const char *file, const char *key, const char *expected);

/// A number of the object "parameters" in a summary, as of "conservative.a" its "value"; NaN if
/// there is no such key.
double results_parameter(const char *file, const char *name, const char *key);
