// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "kirkwood_buff" among the targets of a run file: a value and its error of each pair of
/// components (system/components.h) that is named, {"A-B": {"value": …, "error": …}, …}; of one
/// component {"value": …, "error": …}.
#pragma once

#include "base/fields.h"
#include "io/json.h"
#include "system/components.h"

/// Of one pair [λ^d].
struct target_kirkwood_buff_number {
    double value, error;
};

struct target_kirkwood_buff {
    struct composition components;
    size_t pairs; ///< of the components; 0: not given
    /// By the numbers of the pairs; NaN: not named.
    double value[COMPOSITION_MOST_PAIRS], error[COMPOSITION_MOST_PAIRS];
};

/// Read the members of the object but those of struct target_use and of the observable, which are
/// read before. Faults, as a pair that is not there or no error, go to the document.
/// @param[in] topology  of the scene's molecules, or NULL
/// Tested: test_target_files.
void mf_target_kirkwood_buff_read(struct target_kirkwood_buff *target, struct json_object *object,
                                  const struct composition *composition,
                                  const struct topology *topology);
