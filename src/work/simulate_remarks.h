// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where local densities of a simulation went beyond what their energies are tabulated for,
/// or have none.
#pragma once

#include "report/progress.h"
#include "scene/scene.h"

void mf_simulate_remarks_print(const struct scene *scene, const struct simulation *simulation,
                               struct progress *progress);
void mf_simulate_remarks_write(const struct scene *scene, const struct simulation *simulation,
                               struct json_writer *writer);
