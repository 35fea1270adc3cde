// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured curve, or a number, to be matched: for every target that needs no reader of its
/// own.
#pragma once

#include "io/json.h"
#include "observe/observable.h"

/// x grows from row to row; times begin at 0 and are equally spaced to the digits of the file.
/// Tested: test_target_files.
struct target_curve {
    struct target_curve_parameters {
        char file[FIELD_TEXT_SIZE];
        int64_t x_column, value_column,
            error_column; ///< from 1; value_column 0, error_column −1: by name; error_column 0:
                          ///< none
    } parameters;
    size_t points;             ///< 0: not given
    double interval;           ///< between times [τ]; 0: of a curve that is no function of time
    double time;               ///< τ in the units of the file, for messages
    double *x, *value, *error; ///< shape [points]
};

/// BAD_INPUT with the time steps that would do if the interval between the times of a file [τ] is
/// not a whole number of steps to 0.1 %: what moves is measured as often as it was.
/// @param[in] time  τ in the units of the file, for messages
enum status mf_target_curve_check_steps(const char *file, double interval, double time,
                                        double time_step) MUST_USE;

/// A measured number: the pressure, or D.
struct target_number {
    double value, error;
    double window; ///< of D: the slope of the MSD over its second half; 0: of other targets [τ]
};
