// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A scene of the caller's, written as the text of a scene file.
#pragma once

#include "scene/scene.h"
#include "mesofit/simulation.h"

#include <stdio.h>

/// Write the members of a scene file's object, all but the laws of the caller's own.
void mf_scene_text_write(const struct mesofit_scene *scene, FILE *stream);

/// Put the laws of the caller's own, which the text leaves out, into the scene that was read.
/// Fails: BAD_INPUT if a value is not finite, or a cutoff not positive; NO_MEMORY.
enum status mf_scene_text_add_own(const struct mesofit_scene *from, struct scene *scene) MUST_USE;
