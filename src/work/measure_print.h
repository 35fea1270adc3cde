// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit measure` tells of its results.
#pragma once

#include "report/progress.h"
#include "work/measure_output.h"

/// Print a line for each thing that a person is to know. Fails: NO_MEMORY.
enum status mf_measure_print(struct progress *progress,
                             const struct measure_result *result) MUST_USE;
