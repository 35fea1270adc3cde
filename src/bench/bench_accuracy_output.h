// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a time step costs and what it spoils: errors of points against a reference, and the
/// diagram of them for people, for programs, and for gnuplot.
#pragma once

#include "bench/bench_point.h"

#include <stdio.h>

/// Numbers of a row. Of a change (the point minus the reference) the
/// error includes that of the reference.
enum bench_column {
    BENCH_TIME_STEP,
    BENCH_CPU,
    BENCH_CPU_ERROR,
    BENCH_CPU_TO_ERROR, ///< until the worst bin of g has the wanted standard error
    BENCH_G_LARGEST,    ///< |Δg| of the bin that is off most
    BENCH_G_LARGEST_ERROR,
    BENCH_G_NOISE, ///< what BENCH_G_LARGEST would be, on average, if there were noise alone
    BENCH_G_RMS,   ///< of Δg, what noise adds taken off
    BENCH_G_RMS_ERROR,
    BENCH_CHANGES,                                       ///< of each quantity, with its error
    BENCH_VALUES = BENCH_CHANGES + 2 * BENCH_QUANTITIES, ///< and the quantities themselves
    BENCH_COLUMNS = BENCH_VALUES + 2 * BENCH_QUANTITIES
};

struct bench_row {
    const char *method;
    double value[BENCH_COLUMNS];
};

/// Replace the reference, the point with the time step h, by its extrapolation to h = 0 with the
/// point of the same method at ρ h, for errors of order h²:
///   y_0 = y_h − (y_ρh − y_h)/(ρ² − 1).
/// Of the points, that with ρ nearest to 4 is taken; where there is none between 2.5 and 6,
/// nothing changes. Friction with ω² Δt of order 1 makes errors of lower order: then what is left
/// of the reference's error is up to four times as much as was moved. Tested: test_bench_errors.
struct bench_extrapolation {
    double partner; ///< ρ h, or 0 [τ]
    double moved;   ///< largest change of g
};
struct bench_extrapolation mf_bench_extrapolate(struct bench_point *reference,
                                                const struct bench_point *points, size_t count,
                                                size_t bins);

/// Errors of a point. @param[in] wanted  standard error for BENCH_CPU_TO_ERROR
/// Tested: test_bench_errors.
struct bench_row mf_bench_row_of(const struct bench_point *point,
                                 const struct bench_point *reference, size_t bins, double wanted);

/// Mean of the largest of |x_k|, x_k normal with standard deviations `error`: ∫ (1 − Π erf(x/√2
/// σ_k)) dx. Tested: test_bench_errors.
double mf_bench_expected_largest(const double *error, size_t count);

/// Largest time step of a method with an error |Δg| that is wanted.
struct bench_limit {
    const char *method; ///< NULL: not even the smallest has it
    double time_step, time_step_error;
    double cpu, cpu_error; ///< [s/τ]
    bool is_bounded;       ///< a larger time step was found too large
};

/// Climb the rows of one method, in the order of their time steps, to the first whose largest |Δg|
/// is above `wanted`, and interpolate between it and the last in logarithms.
/// Tested: test_bench_errors.
struct bench_limit mf_bench_limit_of(const struct bench_row *rows, size_t count, double wanted);

struct bench_diagram {
    const char *scene;
    size_t particles;
    double wanted;                            ///< |Δg|
    double time, reference_time;              ///< of a point, of the reference [τ]
    struct bench_extrapolation extrapolation; ///< of the reference
    const struct bench_row *row;              ///< one method after the other, time steps growing
    size_t rows;                              //
    struct bench_row reference;               ///< at its own time step: changes are 0
    const struct bench_limit *limit;          ///< of each method
    const char *const *method;                ///< their names
    size_t methods;
    bool has_omega;
};

/// Index of the method whose largest good time step costs least; `methods` if none has any.
/// Tested: test_bench_accuracy_output.
size_t mf_bench_cheapest(const struct bench_diagram *diagram);

/// Tables of errors and limits, and the recommendation. Tested: test_bench_accuracy_output.
void mf_bench_accuracy_table(FILE *stream, const struct bench_diagram *diagram);

/// A list of objects with "role": reference, point, limit or recommendation.
/// Fails: IO, NO_MEMORY. Tested: test_bench_accuracy.
enum status mf_bench_accuracy_json(FILE *stream, const struct bench_diagram *diagram) MUST_USE;

/// Tab-separated, a block a method, two empty lines between blocks. Tested: test_bench_accuracy.
void mf_bench_accuracy_tsv(FILE *stream, const struct bench_diagram *diagram);
