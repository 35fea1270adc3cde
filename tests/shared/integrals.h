// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Integrals of Kirkwood and Buff in a twin: a simulation of the truth in the folder "truth",
/// whose g(r) is tilted within its errors, and whose integrals are targets.
#pragma once

#include "shared/temporary_folder.h"

#include <stddef.h>

/// What the integrals are of.
struct integrals {
    const char *pair[8]; ///< names, in their order
    size_t pairs;
    double error; ///< of each, as a target that is to be met
};

/// Write g_<pair>.tsv: g of truth/rdf_<pair>.tsv times `factor`, with the standard error `error`.
void integrals_tilt(struct temporary_folder *folder, const char *pair, double factor, double error);

/// Members of "kirkwood_buff": those of truth/summary.json, each with `error`.
void integrals_of_truth(const struct integrals *integrals, double error, char *text, size_t size);

/// The integral of a fit's folder that is farthest from its target, in standard errors of both.
double integrals_farthest(const struct integrals *integrals, const char *folder);
