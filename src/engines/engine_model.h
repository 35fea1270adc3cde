// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The scene of a fit with the potentials of a piece, as the writers of `export` take it.
#pragma once

#include "engines/engine.h"
#include "export/export_model.h"

/// Fill in all but the start of the scene; there is no friction. What it points to is borrowed.
void mf_engine_model(const struct engine_run *run, const struct engine_piece *piece,
                     struct export_model *model);
