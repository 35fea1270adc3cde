// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A scene: what a JSON file says of a simulation, read, checked and written back.
#pragma once

#include "dynamics/simulation.h"
#include "scene/scene_law.h"
#include "scene/scene_many_body.h"
#include "scene/scene_memory.h"
#include "scene/scene_molecules.h"

/// What a fit looks for, and the scene therefore does not say.
enum scene_unknown {
    SCENE_FITS_NOTHING = 0,
    SCENE_FITS_POTENTIAL = 1,  ///< no "conservative"
    SCENE_FITS_OMEGA = 2,      ///< no "dissipative"; there will be friction
    SCENE_FITS_TRANSVERSE = 4, ///< no "dissipative_transverse"; the same
    SCENE_FITS_MEMORY = 8,     ///< modes of "memory" without "omega"
};

/// Owns the numbers of the interactions that a scene names.
struct scene_interactions {
    struct interaction_choice choice[INTERACTION_MAX];
    void *parameters[INTERACTION_MAX];
    int count;
    int dimensions; ///< of the scene: how many numbers a vector has
};

/// What of it the file says. A fit chooses what is left out.
struct scene_given {
    bool time_step, count, conservative, dissipative, transverse, memory, dynamics;
};

/// Owns its laws and arrays; `setup` borrows them.
struct scene {
    struct scene_given given;
    struct simulation_setup setup;
    struct scene_law potential, omega;
    struct scene_law known; ///< what acts beside a potential that is looked for
    struct scene_memory memory;
    struct scene_many_body many_body;
    struct scene_interactions interactions;
    struct scene_molecules molecules;
    struct units units;
    struct simulation_start start; ///< arrays of a placement file
    double density;                ///< in the place of a box; 0: there is one [1/λ^d]
    int unknown;                   ///< as it was read
    double *start_values;
    void *integrator_parameters;
};

/// Fields of the scene itself, for `mesofit describe`.
extern const struct field mf_scene_fields[], mf_scene_density_fields[];

/// Read the objects of a scene from `object`, but for what `unknown`, a sum of scene_unknown, says,
/// and the laws of the groups that are `fitted`, or NULL. With units, a mass density or a
/// temperature that no matter has is a fault.
/// Faults go to its document; *scene may then be incomplete but is safe to clear. Fails: NO_MEMORY.
enum status mf_scene_read(struct scene *scene, struct json_object *object, int unknown,
                          const struct scene_fitted *fitted) MUST_USE;
void mf_scene_clear(struct scene *scene);

/// Let follow what does from a count of beads, a friction law or an unknown that were chosen after
/// the scene was read: composition and box, table, integrator. Faults as in mf_scene_read, such as
/// of a count that nobody has chosen. Fails: NO_MEMORY.
/// @param[in] integrator   that was chosen, or NULL: the file's, or the usual one
/// @param[in] inner_steps  that were chosen for it, or 0: the file's
enum status mf_scene_complete(struct scene *scene, struct json_object *object,
                              const struct integrator *integrator, int64_t inner_steps) MUST_USE;

/// Mass of the beads over the volume of the box [g/cm³], for a scene of three dimensions with
/// units.
double mf_scene_mass_density(const struct scene *scene);

/// What a person should know before the scene is simulated, one line: what its integrator says of
/// its parameters, or, without friction and noise, that nothing holds the temperature; NULL:
/// nothing.
const char *mf_scene_warning(const struct scene *scene);

/// Write everything that mf_scene_read reads, defaults filled in.
void mf_scene_write(const struct scene *scene, struct json_writer *writer);

/// Add the tables that a scene only names to the digest of a checkpoint.
void mf_scene_digest(const struct scene *scene, uint64_t *digest);
