// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "dynamics" of a scene: the integrator, and whether it can move what the scene has.
#pragma once

#include "scene/scene.h"

/// Read the member "dynamics" of a scene, of which all else is read. Faults go to the document.
/// Fails: NO_MEMORY.
enum status mf_scene_dynamics_read(struct scene *scene, struct json_object *object) MUST_USE;

/// Take an integrator that was chosen, or, if that is NULL and the file names none, the usual one
/// of a scene to which friction came. Faults and failures are the same.
enum status mf_scene_dynamics_complete(struct scene *scene, struct json_object *object,
                                       const struct integrator *integrator) MUST_USE;
