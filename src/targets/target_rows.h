// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The rows of a measured curve, as a file has them; of a g(r) also how far they grow, joined
/// to wider bins, errors from scatter.
#pragma once

#include "base/status.h"
#include "io/json.h"

/// Of the file: columns in units of the scene, or a .dist.tgt of VOTCA.
enum { TARGET_ROWS_COLUMNS, TARGET_ROWS_VOTCA };

/// Values y at x, r and g of a g(r), in units of the scene.
struct target_rows {
    size_t count;
    int dimensions; ///< of space, for the volumes of shells
    double *x, *y, *error;
    size_t *line; ///< in the file, for messages
    bool has_errors;
};

enum status mf_target_rows_allocate(struct target_rows *rows, size_t count) MUST_USE;
void mf_target_rows_clear(struct target_rows *rows);

/// Where in a file rows stand, columns counted from 1, and what is found there.
struct target_columns {
    const char *file;
    const char *name;            ///< columns may be called so, and "name_error"; NULL: not by name
    const char *x_unit, *y_unit; ///< reduced; NULL: numbers that have none
    double min;                  ///< of x
    int64_t x, y;                ///< y 0: that of the name, or 2
    int64_t error; ///< 0: none; −1: that of the name, or 3, or none; a column of nan is none
    bool may_be_unknown;     ///< y may be nan
    const char *usual_error; ///< what programs call a column of errors
    bool is_usual_error;     ///< found: it is called so
    bool errors_of_samples;  ///< found: a comment says so, as `simulate` writes it
    bool numbered;           ///< found: x numbers the rows, and y grows as an argument does
    bool even;               ///< found: and does so by equal steps, before another column
};

/// Read rows whose x grows. The numbers of errors are as they are, be they nan. `columns` are those
/// that were found. Fails: BAD_INPUT, IO, NO_MEMORY.
enum status mf_target_rows_read(struct target_rows *rows, struct target_columns *columns,
                                const struct units *units) MUST_USE;

/// Read a table of VOTCA, in its units. Fails: BAD_INPUT, IO, NO_MEMORY.
enum status mf_target_rows_read_votca(struct target_rows *rows, const char *file) MUST_USE;

/// Make a fault of an object of a failure to read what its `key` names, or of it all if that is
/// NULL. Fails: NO_MEMORY.
enum status mf_target_rows_fault(struct json_object *object, const char *key,
                                 enum status status) MUST_USE;

/// How g ends.
struct target_tail {
    double mean;    ///< of g over the last quarter of the range
    double scatter; ///< standard deviation of g there, most of it oscillation
    bool grows;     ///< g never falls from the first row to the last
};

/// Needs at least one row. Tested: test_target_rows.
struct target_tail mf_target_rows_tail(const struct target_rows *rows);

/// The standard error of g at g = 1 in the last bin, from the scatter of neighbouring bins.
///
/// Counted pairs give the bins errors that are independent to a good part, with the variance
///   σ_k² = c² g_k/v_k,   v_k the volume of the shell.
/// The fourth difference d of five bins knows nothing of polynomials up to third order and has the
/// variance c² Σ b_j² g_j/v_j, b = 1, −4, 6, −4, 1. c² is the mean of d²/Σ b_j² g_j/v_j over all
/// bins with g above 0.2, without those beyond three standard deviations, where g is too steep.
/// What neighbours have in common, such as a temperature that drifts, is not seen: of the tables in
/// targets/, whose errors are known from blocks of time, 0.79 to 1.23 of it is found. NaN if there
/// are fewer than 12 differences, or if g scatters by less than 1e-5 as the digits of an exact
/// table do, which no counted pairs have. Needs bins of the same width. Fails: NO_MEMORY. Tested:
/// test_target_rows.
static const double target_rows_min_scatter = 1e-5;
enum status mf_target_rows_scatter(const struct target_rows *rows, double *error) MUST_USE;

/// The mean of `count` squares of normal numbers, some of which do not belong: without those beyond
/// three standard deviations. Sorts them.
double mf_target_rows_robust_mean(double *square, size_t count);

/// Set the errors that follow from `error`, that of the last bin at g = 1: σ_k = error sqrt(g_k
/// v/v_k), v the volume of the last bin. Tested: test_target_rows.
void mf_target_rows_set_errors(struct target_rows *rows, double error);

/// Join each `of` rows to one: r in the middle, g and the variance averaged by the volumes of the
/// shells. A rest at the end is dropped. Needs bins of the same width. Tested: test_target_rows.
void mf_target_rows_join(struct target_rows *rows, size_t of);
