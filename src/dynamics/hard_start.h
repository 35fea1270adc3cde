// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A start of hard discs or spheres without overlap.
#pragma once

#include "system/particles.h"

/// Move the particles of a random or disturbed start apart until no two overlap: again and again
/// each overlapping pair is moved to a distance a little above contact. Denser than by sequential
/// addition, which ends at η = 0.547 and 0.38; positions are not those of equilibrium.
/// @param[in] radius  shape [count], as the particles are sorted now  [λ]
/// @param[in] walls   bit d: axis d has walls at 0 and at the length of the box
/// Fails: NO_MEMORY; BAD_INPUT if the box has no room for the largest. What overlaps still is left
/// to mf_hard_start_check. Tested: test_hard_gas.
enum status mf_hard_start_part(struct particles *particles, const double *radius,
                               int walls) MUST_USE;

/// Fails: BAD_INPUT with the ids if two particles overlap, or one and a wall, or if the box has no
/// room for the largest; NO_MEMORY.
enum status mf_hard_start_check(const struct particles *particles, const double *radius,
                                int walls) MUST_USE;
