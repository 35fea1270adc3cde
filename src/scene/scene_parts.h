// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parts of a scene, each read by a file of its own.
#pragma once

#include "scene/scene.h"
#include "io/data_table.h"

/// @name "particles": how many, where, and what each of them has
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

/// @name "dynamics": the integrator, and whether it can move what the scene has
/// Read the member "dynamics" of a scene, of which all else is read. Faults go to the document.
/// Fails: NO_MEMORY.
enum status mf_scene_dynamics_read(struct scene *scene, struct json_object *object) MUST_USE;

/// Take an integrator that was chosen, or, if that is NULL and the file names none, the usual one
/// of a scene to which friction came; with inner steps that were chosen for it, unless they are 0.
/// Faults and failures are the same.
enum status mf_scene_dynamics_complete(struct scene *scene, struct json_object *object,
                                       const struct integrator *integrator,
                                       int64_t inner_steps) MUST_USE;

/// @name Masses, radii and so on of the particles: numbers, ranges, columns of a file
/// Read those members of "particles" that are attributes; the types must be known. Faults go to the
/// document.
void mf_scene_attributes_read(struct scene *scene, struct json_object *particles);

/// The first column of a placement file after those of positions and velocities: the last ones
/// that are called by an attribute in the line of names.
size_t mf_scene_attributes_first_column(const struct data_table *table);

/// Make the numbers of such a column reduced. Fails: BAD_INPUT.
enum status mf_scene_attributes_convert(struct data_table *table, const char *file, size_t column,
                                        const struct units *units) MUST_USE;

/// The name of a column in the line of names; false if that has not as many names as there are
/// columns.
bool mf_scene_attributes_column_name(const struct data_table *table, size_t column, char *name,
                                     size_t size);

/// Take such a column; `values`, shape [rows], are its numbers and live as long as the scene.
/// Faults go to the document.
void mf_scene_attributes_column(struct scene *scene, struct json_object *particles,
                                const struct data_table *table, size_t column,
                                const double *values);

/// Write what mf_scene_attributes_read has read.
void mf_scene_attributes_write(const struct scene *scene, struct json_writer *writer);

/// @name "placement": "file": where the beads of a topology are, "conf.gro"
/// Whether a file of coordinates is one of GROMACS or LAMMPS, by its name.
bool mf_scene_coordinates_are_of_engine(const char *file);

/// Read the places, and velocities if there are any, of a .gro file, or of the data file of LAMMPS
/// that the molecules are from, into scene->start: molecule
/// after molecule, kind after kind, then single beads, type after type. With units nm and ps become
/// λ and τ; without, these are 1 nm and 1 ps.
/// Faults go to the document, one line: another number of atoms, another box, a bond that is more
/// than three times as long as at rest, by more than 30 k_B T, or longer than it can be.
/// Fails: NO_MEMORY. Tested: cli/test_topologies.
enum status mf_scene_coordinates_read(struct scene *scene, struct json_object *particles) MUST_USE;

/// A fault for the first bond of a scene's first coordinates that is as long as
/// mf_scene_coordinates_read refuses.
/// @param[in] number  shape [beads]: of each id in the file; NULL: the ids themselves
void mf_scene_coordinates_check_bonds(const struct scene *scene, struct json_object *particles,
                                      const size_t *number);
