// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step of a simulation whose scene gives none.
#pragma once

#include "scene/scene.h"

enum { SCENE_STEP_SIZE = 448 };

/// Choose it, as a verification does (dynamics/usual_step.h), of an integrator whose steps can be
/// made finer; another one keeps its default. Where the file says nothing of dynamics, bonds may
/// take inner steps in it. How, into `text`, or "". Tested: cli/test_doubts, cli/test_molecules.
/// @param[in] whole  whether something is measured that follows all forces step by step: then bonds
///                   take no steps of their own
void mf_scene_step_choose(struct scene *scene, bool whole, char text[SCENE_STEP_SIZE]);
