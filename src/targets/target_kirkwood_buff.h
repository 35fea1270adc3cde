// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "kirkwood_buff" among the targets of a run file: a value and its error of each pair of
/// components (system/components.h) that is named, {"A-B": {"value": …, "error": …}, …}; of one
/// component {"value": …, "error": …}.
#pragma once

#include "system/components.h"

/// Tested: test_target_files.
struct target_kirkwood_buff {
    struct composition components;
    size_t pairs; ///< of the components; 0: not given
    /// By the numbers of the pairs; NaN: not named.
    double value[COMPOSITION_MAX_PAIRS], error[COMPOSITION_MAX_PAIRS];
};
