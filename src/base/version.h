// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which mesofit this is.
#pragma once

/// The release of include/mesofit.h, "0.3.0", and the commit where the build is of none:
/// "0.3.0+12.g1bc3e15" (version.sh).
extern const char mf_version[];
