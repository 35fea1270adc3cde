// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Units of the programs that write trajectories.
#pragma once

#include "base/status.h"

/// Whose units a format is in.
enum trajectory_unit_source {
    TRAJECTORY_OWN_UNITS,  ///< the format says which, and nobody else
    TRAJECTORY_ANGSTROM,   ///< Å, fs and u, unless the user says otherwise
    TRAJECTORY_UNITS_GIVEN ///< the file may say it; else only the user knows
};

/// What one unit of a file is.
struct trajectory_scale {
    double length; ///< [nm]
    double time;   ///< [ps]
    double mass;   ///< [u]
    double speed;  ///< [nm/ps]
};

/// The unit styles of LAMMPS (manual, command `units`) by their names, NULL-terminated; in "lj"
/// lengths, times and masses stay the numbers that they are. "nm-ps" is ours, and GROMACS's.
extern const char *const mf_trajectory_unit_names[];

/// Fails: BAD_INPUT if there is no such style. Tested: test_trajectory_lammps.
enum status mf_trajectory_units_find(const char *name, struct trajectory_scale *scale) MUST_USE;
