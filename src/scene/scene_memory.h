// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Friction of a scene that remembers, and friction across pairs.
///
/// "memory": {"slow": {"time": 0.5, "omega": {"law": …}}, "rattle": {"time": 0.05, "frequency": 30,
/// "omega": {…}}}: modes under names that the file chooses; "dissipative_transverse": {"law": …}.
/// forces/pair_memory.h says what they are.
#pragma once

#include "dynamics/simulation.h"
#include "scene/scene_law.h"

enum { SCENE_MEMORY_NAME_SIZE = 32 };

/// The fields of a mode beside its ω.
struct scene_memory_mode {
    double time, frequency;
};
extern const struct field mf_scene_memory_fields[];

/// Owns its laws; `law` borrows them.
struct scene_memory {
    int modes;
    char name[PAIR_MEMORY_MAX_MODES][SCENE_MEMORY_NAME_SIZE];
    struct scene_memory_mode mode[PAIR_MEMORY_MAX_MODES];
    struct scene_law omega[PAIR_MEMORY_MAX_MODES];
    struct scene_law transverse;
};

/// Read both objects of `scene`, if they are there.
/// @param[in] open  whether modes may have no ω, which is to be found
/// Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_memory_read(struct scene_memory *memory, struct json_object *scene,
                                 const struct composition *composition, const struct units *units,
                                 bool open) MUST_USE;
void mf_scene_memory_clear(struct scene_memory *memory);

/// What a simulation takes of it; borrowed.
struct pair_memory_law mf_scene_memory_law(const struct scene_memory *memory);

void mf_scene_memory_write(const struct scene_memory *memory, const struct composition *composition,
                           struct json_writer *writer);

/// Add the tables to the digest of a checkpoint.
void mf_scene_memory_digest(const struct scene_memory *memory, uint64_t *digest);
