// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "scene" of a measurement's target.json: which beads a fit simulates, and in what room.
#pragma once

#include "io/json_write.h"
#include "work/measure_output.h"

/// Fails: NO_MEMORY.
enum status mf_measure_scene_write(const struct measure_result *result,
                                   struct json_writer *writer) MUST_USE;
