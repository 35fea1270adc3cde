// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "interactions" of a scene: what acts beside the pairs, an object for each by its name.
#pragma once

#include "dynamics/simulation.h"
#include "io/json.h"
#include "io/json_write.h"

/// Owns the numbers of the interactions that a scene names.
struct scene_interactions {
    struct interaction_choice choice[INTERACTION_MAX];
    void *parameters[INTERACTION_MAX];
    int count;
    int dimensions; ///< of the scene: how many numbers a vector has
};

/// Read them from the member "interactions" of `parent`, in the order of mf_interaction_list, and
/// give them to `setup`, whose box is known. Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_interactions_read(struct scene_interactions *interactions,
                                       struct json_object *parent,
                                       struct simulation_setup *setup) MUST_USE;
void mf_scene_interactions_clear(struct scene_interactions *interactions);

/// Write the member, if there are any.
void mf_scene_interactions_write(const struct scene_interactions *interactions,
                                 struct json_writer *writer);
