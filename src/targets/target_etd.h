// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured escape time distribution to be matched.
#pragma once

#include "io/json.h"
#include "observe/etd.h"

/// "etd" among the targets of a run file.
struct target_etd_parameters {
    char file[FIELD_TEXT_SIZE], error_file[FIELD_TEXT_SIZE]; ///< the latter "": no errors given
    int64_t time_column, first_column;                       ///< from 1
    double r_minimum, r_maximum;                             ///< [λ]
};

struct target_etd {
    struct target_etd_parameters parameters;
    struct etd_grid grid;
    double interval;          ///< between times [τ]
    double time;              ///< τ in the units of the file, for messages
    double *survival, *error; ///< shape [times, bins]; NaN: not known; error 0 without errors
    size_t left_out;          ///< cells that are not known
};

/// Read the members of {"file": …}: a time in each row, from 0 on and equally spaced, and from
/// first_column on E of one bin in each column, equal bins from r_minimum to r_maximum. The table
/// of standard errors has the same shape. Cells where either is nan are not known. What `mesofit
/// simulate` writes, etd.tsv and etd_error.tsv, needs no columns.
///
/// Faults (shape, times, values that are no survival probability, …) go to the document and leave
/// the target empty. Fails: NO_MEMORY. Tested: test_target_etd, test_simulate_pairs.
enum status mf_target_etd_read(struct target_etd *target, struct json_object *object) MUST_USE;
void mf_target_etd_clear(struct target_etd *target);
