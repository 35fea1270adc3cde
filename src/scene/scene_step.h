// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step of a simulation whose scene gives none.
#pragma once

#include "scene/scene.h"

enum { SCENE_STEP_SIZE = 384 };

/// Choose it, as a verification does (dynamics/usual_step.h), of an integrator whose steps can be
/// made finer; another one keeps its default. How, into `text`, or "". Tested: cli/test_doubts.
void mf_scene_step_choose(struct scene *scene, char text[SCENE_STEP_SIZE]);
