// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a mapping is made: which atoms are which bead, and their masses.
#pragma once

#include "trajectory/mapping.h"

/// Find types, beads and their atoms, with weights that are 0 or, for centres of geometry, 1/count.
enum status mf_mapping_build(struct mapping *mapping, const struct mapping_plan *plan,
                             const struct structure *structure) MUST_USE;

/// Find the masses of beads, and the weights for centres of mass; note what was guessed.
enum status mf_mapping_build_masses(struct mapping *mapping, const struct mapping_plan *plan,
                                    const struct structure *structure) MUST_USE;

/// The element that an atom seems to be, or NULL.
const char *mf_mapping_element(const struct structure *structure, size_t atom);

/// Note how many beads of which type there are, of how many atoms.
enum status mf_mapping_build_notes(struct mapping *mapping) MUST_USE;

/// Add a line to the notes.
enum status mf_mapping_note(struct mapping *mapping, const char *format, ...)
    __attribute__((format(printf, 2, 3), warn_unused_result));
