// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "numbers" of "unknowns": scalars of the scene by their paths.
#pragma once

#include "scene/scene.h"
#include "problem/numbers.h"

/// Read {"dissipative.sigma": {"minimum": 1, "maximum": 10}, …} of the object "unknowns". A path is
/// that of a key in the scene: any number there that can change from simulation to simulation.
/// Faults go to the document: paths that the scene does not know (with the nearest), what is no
/// number, what cannot change, and ranges that are none. Fails: NO_MEMORY. Tested:
/// test_fit_numbers.
enum status mf_fit_numbers_read(struct json_object *unknowns, const struct scene *scene,
                                struct inverse_number number[INVERSE_MAX_NUMBERS],
                                size_t *count) MUST_USE;

/// Begin with what the scene has, or in the middle of the range, where the file does not say with
/// what. Fails: NO_MEMORY.
enum status mf_fit_numbers_complete(const struct scene *scene, struct inverse_number *number,
                                    size_t count) MUST_USE;

/// Lend a problem the laws of the scene that numbers may belong to.
void mf_fit_numbers_lend(const struct scene *scene, struct inverse_problem *problem);
