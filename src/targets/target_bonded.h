// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Measured distributions of bond lengths, angles or dihedrals, one for each group:
/// {"backbone": {"file": "bond.dist.tgt", "format": "votca"}, …}.
///
/// They are p(q) at the centres of equal bins, without a Jacobian taken out, and ∫ p dq = 1. Angles
/// are in degrees, in VOTCA's files in radians. Rows at both ends in which nothing was seen are
/// left out, but for two of them. Standard errors that a file does not give come from the scatter
/// of −ln(p/J), which is a smooth curve however stiff a bond is.
#pragma once

#include "io/json.h"
#include "io/units.h"
#include "observe/bonded_distribution.h"

struct target_bonded_parameters {
    char file[FIELD_TEXT_SIZE];
    int format;                                   ///< TARGET_ROWS_COLUMNS, TARGET_ROWS_VOTCA
    int64_t q_column, value_column, error_column; ///< as of struct target_curve_parameters
    int errors_of;                                ///< enum target_errors
};

extern const struct field mf_target_bonded_fields[];

/// Of one group.
struct target_bonded {
    struct target_bonded_parameters parameters;
    struct bonded_bins bins; ///< no bins: not given
    double *value, *error;   ///< shape [bins.count] [1/λ] or [1/degrees]
    size_t joined;           ///< rows of the file that make a bin
    double estimated_error;  ///< at the peak, in peaks, if the file has no errors, else 0
    bool assumed;            ///< and not even the scatter of the rows tells it
};

/// Read {"file": …} of a group called `name`, by which columns may be found. Faults go to the
/// document and leave the target empty: bins, negative p, an integral that is off 1 by more than
/// 1 %, angles in another unit. `units` are those of the scene, `dimensions` of space. Fails:
/// NO_MEMORY. Tested: test_target_bonded.
enum status mf_target_bonded_read(struct target_bonded *target, int order, const char *name,
                                  struct json_object *object, const struct units *units,
                                  int dimensions) MUST_USE;

/// Look for the faults of a file in VOTCA's format without a scene. Fails: BAD_INPUT, IO,
/// NO_MEMORY. Tested: cli/test_import.
enum status mf_target_bonded_check_votca(const char *file, int order) MUST_USE;

void mf_target_bonded_clear(struct target_bonded *target);
