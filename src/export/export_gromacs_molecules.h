// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The molecules of a result in the files for GROMACS, whose atoms stand molecule after
/// molecule, kind after kind, and single beads after them.
#pragma once

#include "export/export_engine.h"

/// Whether GROMACS has a law as it is: all but tables and k (1 + cos θ).
bool mf_export_gromacs_has_law(const struct bonded_curve *curve);

/// Write conf.gro, topol.top, index.ndx with a group for each type, and the tables of laws. Fails:
/// IO, NO_MEMORY.
enum status mf_export_gromacs_molecules(const struct export_job *job) MUST_USE;
