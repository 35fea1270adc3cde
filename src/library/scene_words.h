// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A scene of the caller's, as words of a scene file.
#pragma once

#include "io/json.h"
#include "scene/scene.h"
#include "mesofit/simulation.h"

/// Its seed and the members of its object, all but the laws of the caller's own: of a scene file,
/// or of the run file of a fit. Returns how many there are. They borrow from the scene.
enum { SCENE_WORDS = 9 };
size_t mf_scene_words(const struct mesofit_scene *scene, bool of_fit,
                      struct json_word words[SCENE_WORDS]);

/// Put the laws of the caller's own, which the words leave out, into the scene that was read.
/// Fails: BAD_INPUT if a value is not finite, or a cutoff not positive; NO_MEMORY.
enum status mf_scene_words_add_own(const struct mesofit_scene *from, struct scene *scene) MUST_USE;
