// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Fits of the propane of VOTCA's tutorial, whose g(r) are in targets/.
#pragma once

#include "shared/temporary_folder.h"

enum { PROPANE_PAIRS = 3 }; ///< A-A, A-B, B-B

/// Run files of 1000 molecules, and of 300 at the same density with g(r) up to 1.5 nm: they name
/// A-A.dist.tgt and so on beside them.
extern const char propane_run[], propane_run_small[];
#define PROPANE_SMALL_BOX "[3.32264, 3.44033, 3.02842]"

/// Write the target of a pair type, with all its values times `factor`.
/// @param[in] root  of the repository
void propane_write_target(struct temporary_folder *folder, const char *root, int pair,
                          double factor);
