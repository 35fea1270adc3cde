// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integrals of a fit's summary: ∫ (g − 1) d³r and S(0).
#pragma once

#include "report/fit_output.h"

/// Those of the target "kirkwood_buff" and of the result.
void mf_fit_integrals_write(struct json_writer *writer, const struct fit_file *fit,
                            const struct verification *v);

/// Those of the g(r) of target and result, in three dimensions and of beads that are alike: each at
/// its density, where that is a target, else at that of the scene.
void mf_fit_integrals_write_compressibility(struct json_writer *writer, const struct fit_file *fit,
                                            const struct verification *v);
