// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "many_body" of a scene: energies of local densities, under names that the file chooses.
///
/// "many_body": {"cohesion": {"central": "A", "neighbours": "A B", "weight": {"law": …}, "energy":
/// {"law": …}}, …}. forces/many_body.h says what they are.
#pragma once

#include "dynamics/simulation.h"
#include "forces/many_body.h"
#include "io/json.h"
#include "io/json_write.h"

/// The fields of a term beside its laws.
struct scene_many_body_types {
    char central[FIELD_TEXT_SIZE], neighbours[FIELD_TEXT_SIZE];
};
extern const struct field mf_scene_many_body_fields[];

/// Owns its laws and their tables, which a setup borrows.
struct scene_many_body {
    struct many_body *law; ///< NULL: there is none
    struct curve weight[MANY_BODY_MAX_TERMS], energy[MANY_BODY_MAX_TERMS];
    struct scene_many_body_types types[MANY_BODY_MAX_TERMS];
};

/// Read the member "many_body" of `scene`, if it is there, and let it act in `setup`, whose box and
/// composition are known. Faults go to the document. Fails: NO_MEMORY.
/// @param[in] fitted  an energy may be left out, which is 0 then, and to be found
enum status mf_scene_many_body_read(struct scene_many_body *many_body, struct json_object *scene,
                                    struct simulation_setup *setup, bool fitted) MUST_USE;

/// Whether the energy of a term is to be found.
static inline bool scene_many_body_is_fitted(const struct scene_many_body *many_body, int term) {
    return many_body->energy[term].family == NULL;
}
void mf_scene_many_body_clear(struct scene_many_body *many_body);

/// Give a term the energy that was left out: a table of ρ and f. Fails: BAD_INPUT, naming the file;
/// IO; NO_MEMORY.
enum status mf_scene_many_body_give_energy(struct scene_many_body *many_body, int term,
                                           const char *file, const struct units *units) MUST_USE;

/// What a term was found to do beyond the ends of its table since the begin, or that its energy is
/// 0, in one line that names it, with densities in the unit of the file; false: nothing.
/// @param[in] state  of the interaction
enum { SCENE_MANY_BODY_REMARK_SIZE = 320 };
bool mf_scene_many_body_remark(const struct scene_many_body *many_body, const void *state, int term,
                               const struct units *units, char line[SCENE_MANY_BODY_REMARK_SIZE]);

/// Write the member, if there are any.
void mf_scene_many_body_write(const struct scene_many_body *many_body, struct json_writer *writer);

/// Add the tables to the digest of a checkpoint.
void mf_scene_many_body_digest(const struct scene_many_body *many_body, uint64_t *digest);
