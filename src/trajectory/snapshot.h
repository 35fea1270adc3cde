// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One configuration of a simulation as a file, for programs that show or analyse it.
///
/// To add a format, write a file with its record and put it into mf_snapshot_formats.
#pragma once

#include "base/status.h"
#include "io/data_table.h"
#include "system/composition.h"
#include "system/particles.h"

#include <stdbool.h>
#include <stdio.h>

/// Numbers of each particle: a scalar, or a vector with a component for each axis.
struct snapshot_column {
    char name[48];
    int components;
    bool vector;          ///< components belong to the axes
    bool whole;           ///< integers
    bool shared;          ///< solvent particles have it, too
    const double *values; ///< shape [components, count], by particle id
};

/// Position, velocity, force and image, the attributes, and the molecule.
enum { SNAPSHOT_MAX_COLUMNS = 6 + PARTICLES_MAX_ATTRIBUTES };

/// Particles that belong to an integrator, as a solvent does.
struct snapshot_solvent_particles {
    const char *name; ///< of their type; no longer than the snapshot is
    size_t count;
    double *const *position, *const *velocity; ///< shape [dimensions][count] [λ], [λ/τ]
    double mass;                               ///< of each [μ]
};

struct snapshot {
    size_t count;                  ///< of all particles
    size_t own;                    ///< of those of the scene, which come first
    const char *solvent_particles; ///< type of the others; NULL: there are none
    struct box box;
    const struct composition *composition; ///< borrowed
    const struct topology *topology;       ///< borrowed; NULL: there are no molecules
    uint64_t step;
    size_t number;             ///< of the snapshots of a run, from 0 on
    double time;               ///< [τ]
    const char *units;         ///< of all numbers, as trajectory_units.h names them
    double mass, solvent_mass; ///< of each where there is no column of masses [μ]; NAN: not known
    /// position [λ] in the box, velocity [λ/τ], force [k_B T_0/λ], image [boxes crossed], then all
    /// attributes by their names, then the number of the molecule, from 1 on, if there are any.
    struct snapshot_column column[SNAPSHOT_MAX_COLUMNS];
    int columns;
    double *memory; ///< shape [numbers]: all values
    size_t numbers;
};

/// Copy the present state of the particles, in the order of their ids, and after them that of
/// solvent particles as they are: only positions, velocities and masses are not 0 there.
/// @param[in] solvent_particles  or NULL
/// Fails: NO_MEMORY. Tested: test_snapshot, cli/test_snapshots.
enum status mf_snapshot_take(struct snapshot *snapshot, const struct particles *particles,
                             const struct composition *composition,
                             const struct snapshot_solvent_particles *solvent_particles,
                             uint64_t step, double time) MUST_USE;
void mf_snapshot_clear(struct snapshot *snapshot);

/// The column that is called so, or NULL.
const struct snapshot_column *mf_snapshot_find(const struct snapshot *snapshot, const char *name);

/// Mass of a particle: that of its column or, without one, that which all have; NAN: not known.
double mf_snapshot_mass(const struct snapshot *snapshot, size_t particle);
bool mf_snapshot_has_common_mass(const struct snapshot *snapshot); ///< known, and without a column
bool mf_snapshot_has_masses(const struct snapshot *snapshot);      ///< either

/// The reduced unit of a column: "lambda" of positions; "" of what the scene does not scale.
const char *mf_snapshot_unit(const struct snapshot_column *column);

/// A copy of what `from` holds, in the units of the file, or of a format that is in Å and fs.
/// @param[in,out] told  zero or an earlier copy, to be cleared
/// Fails: NO_MEMORY. Tested: cli/test_units.
enum status mf_snapshot_translate(struct snapshot *converted, const struct snapshot *from,
                                  const struct units *units, bool angstrom) MUST_USE;

/// Name of a component of a column: "velocity_x", "orientation"; those of positions are x, y, z.
#define SNAPSHOT_FOLDER "snapshots" ///< in that of a run
enum { SNAPSHOT_NAME_SIZE = 64 };
void mf_snapshot_component_name(const struct snapshot_column *column, int component,
                                char name[SNAPSHOT_NAME_SIZE]);

/// Number of a particle's type, solvent particles' being the last, and what it is called: "A" where
/// the scene's particles are of one type.
int mf_snapshot_type(const struct snapshot *snapshot, size_t particle);
const char *mf_snapshot_type_name(const struct snapshot *snapshot, size_t particle);

struct snapshot_format {
    const char *name;   ///< as a scene names it
    const char *suffix; ///< of its files
    bool appended;      ///< all snapshots go into one file
    bool angstrom;      ///< is in Å, fs and kcal/mol where the scene has units
    void (*print)(const struct snapshot *snapshot, FILE *stream);
    /// Forget frames from this number on, of a file that was cut where they began; NULL: it is
    /// right as it is.
    void (*cut)(const struct snapshot *snapshot, size_t frames, FILE *stream);
};

extern const struct snapshot_format mf_snapshot_vtp, mf_snapshot_json, mf_snapshot_xyz,
    mf_format_lammps_dump_snapshot, mf_gsd_snapshot, mf_format_xtc_snapshot;
enum { SNAPSHOT_FORMATS = 6 };

/// All formats, NULL-terminated, and their names.
extern const struct snapshot_format *const mf_snapshot_formats[];
extern const char *const mf_snapshot_format_names[];

/// Write a snapshot into `folder`: step_000001000.vtp, which appears whole or not at all, or a
/// frame after the first `size` bytes of trajectory.extxyz and what its format has behind frames.
/// Those are all that is kept of it, so that a run that goes on from an earlier step leaves the
/// file of one that was not interrupted.
/// @param[in,out] size  of the format's file of all snapshots [bytes]; others leave it alone
/// Fails: IO; the file is then as it was. Tested: test_snapshot, cli/test_snapshots.
enum status mf_snapshot_write(const struct snapshot *snapshot, const struct snapshot_format *format,
                              const char *folder, int64_t *size) MUST_USE;

/// Read positions, velocities if they are there, and what attributes.h lets a scene give, from a
/// snapshot in JSON, or from a tutorial's initial file ("system"): a table with the columns of a
/// placement file, and their names as its header. What is mixed has its particles' types, if it
/// tells them, in the order of the composition. Fails: BAD_INPUT with all faults, IO, NO_MEMORY.
/// Tested: cli/test_snapshots.
enum status mf_snapshot_read(struct data_table *table, const char *file, const struct box *box,
                             const struct composition *composition) MUST_USE;
