// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "particles" of a scene: how many, where, and what each of them has.
#pragma once

#include "scene/scene.h"

/// Read the member "particles" of `object` into the scene, whose box is known, with the file that
/// it may name. Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_particles_read(struct scene *scene, struct json_object *object,
                                    const struct scene_fitted *fitted) MUST_USE;

/// Composition and box of a count that was chosen after it; a fault if none was.
void mf_scene_particles_complete(struct scene *scene, struct json_object *object);

/// Write the member.
void mf_scene_particles_write(const struct scene *scene, struct json_writer *writer);

/// Add the columns of a placement file to the digest of a checkpoint.
void mf_scene_particles_digest(const struct scene *scene, uint64_t *digest);
