// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A work-precision diagram for people, for programs, and for gnuplot.
#pragma once

#include "bench/bench_errors.h"

#include <stdio.h>

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

/// "0.0312(14)": as many digits as the error allows; "-" if there is no number.
/// Tested: test_bench_accuracy_output.
void mf_bench_number_text(char *text, size_t size, double value, double error);

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
