// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All friction of a result, and what of it another engine could have.
#pragma once

#include "export/export_model.h"

/// Read what was fitted of it, and part it: model->own_omega and own_memory are all of it; the
/// setup keeps what is without memory, along pairs and across them. If any has memory the setup has
/// none, as what would be left of it is another friction. Fails: IO; BAD_INPUT; NO_MEMORY.
/// @param[in] unknown  a sum of scene_unknown: what the scene left to the fit
/// Tested: cli/test_export_fits, cli/test_export_folders.
enum status mf_export_friction_find(struct export_model *model, int unknown) MUST_USE;
void mf_export_friction_clear(struct export_model *model);
