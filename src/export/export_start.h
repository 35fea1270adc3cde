// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where another engine lets the particles of a result begin.
#pragma once

#include "export/export_model.h"

/// Find positions, velocities and masses of a model whose setup and types are known: where the
/// result's own simulation ended, or else as our own simulation of its scene would have them start.
/// Fails: BAD_INPUT for a configuration that does not fit, or masses that differ within a type; IO;
/// NO_MEMORY. Tested: test_export_model.
enum status mf_export_start_find(struct export_model *model) MUST_USE;
