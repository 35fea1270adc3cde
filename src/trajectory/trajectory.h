// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Trajectories of other programs, frame by frame, in nm, ps and u.
///
///     while ((status = mf_trajectory_next(&trajectory, &frame, &more)) == STATUS_OK && more) {
///         TRY(mf_mapping_apply(&mapping, &frame, &beads));
///         observe(&beads);
///     }
///
/// To add a format, write a file with its `struct trajectory_format` and put its name into
/// TRAJECTORY_FORMATS below.
#pragma once

#include "base/status.h"
#include "trajectory/frame.h"
#include "trajectory/source.h"
#include "trajectory/structure.h"

/// Whose units a format is in.
enum trajectory_unit_source {
    TRAJECTORY_OWN_UNITS,  ///< the format says which, and nobody else
    TRAJECTORY_ANGSTROM,   ///< Å, fs and u, unless the user says otherwise
    TRAJECTORY_UNITS_GIVEN ///< the file may say it; else only the user knows
};

/// What one unit of a file is.
struct trajectory_scale {
    double length; ///< [nm]
    double time;   ///< [ps]
    double mass;   ///< [u]
    double speed;  ///< [nm/ps]
    double force;  ///< [kJ/mol/nm]
};

/// The unit styles of LAMMPS (manual, command `units`) by their names, NULL-terminated; in "lj"
/// lengths, times and masses stay the numbers that they are. "nm-ps" is ours, and GROMACS's.
extern const char *const mf_trajectory_unit_names[];

/// Fails: BAD_INPUT if there is no such style. Tested: test_trajectory_lammps.
enum status mf_trajectory_units_find(const char *name, struct trajectory_scale *scale) MUST_USE;

struct trajectory;
struct beads_file;

struct trajectory_format {
    const char *name;
    const char *const *extensions; ///< without the point, NULL-terminated
    const char *summary;           ///< what is read of it, and whose format it is: one line
    enum trajectory_unit_source unit_source; ///< whose units it is in
    bool unsorted;     ///< atoms come in any order, another in each frame, where no ids tell them
    size_t state_size; ///< of what it keeps from frame to frame, zeroed at first
    /// Whether the first bytes of a file look like this format.
    bool (*recognise)(const unsigned char *begin, size_t size);
    /// Take what stands before the first frame; NULL: nothing does.
    enum status (*open)(struct trajectory *trajectory);
    /// Give back what its state holds besides its own memory; NULL: nothing.
    void (*close)(struct trajectory *trajectory);
    /// Take the bytes of the next frame into frame->raw; `*more` is true, and becomes false if
    /// there is no further frame. Not called once all frames have been taken that the file says it
    /// has or, if it says nothing, once the source has no byte left.
    enum status (*fetch)(struct trajectory *trajectory, struct trajectory_frame *frame, bool *more);
    /// The time of a frame that was fetched [ps], without decoding it; NULL: it costs as much.
    double (*peek)(const struct trajectory_frame *frame);
    /// Make the structure from the first frame, which has been fetched; its atoms stand in the
    /// order of ids if there are ids.
    enum status (*describe)(struct trajectory *trajectory, struct trajectory_frame *first);
    /// Make positions, velocities, box and time from frame->raw. Several run at once. NULL: it has
    /// no coordinates, and is a structure beside a trajectory.
    enum status (*decode)(const struct trajectory *trajectory, struct trajectory_frame *frame);
    /// Print a frame of beads; NULL: the format is read only. Fails: BAD_INPUT for what it cannot
    /// hold.
    enum status (*print)(struct beads_file *file, const struct trajectory_frame *beads);
};

/// All formats; what is recognised first comes first.
#define TRAJECTORY_FORMATS(EACH)                                                                   \
    EACH(mf_format_xtc)                                                                            \
    EACH(mf_format_trr)                                                                            \
    EACH(mf_format_dcd)                                                                            \
    EACH(mf_format_gsd)                                                                            \
    EACH(mf_format_netcdf)                                                                         \
    EACH(mf_format_lammps_dump)                                                                    \
    EACH(mf_format_gro)                                                                            \
    EACH(mf_format_xyz)                                                                            \
    EACH(mf_format_pdb)                                                                            \
    EACH(mf_format_lammps_data)                                                                    \
    EACH(mf_format_psf)                                                                            \
    EACH(mf_format_top)                                                                            \
    EACH(mf_format_h5md)

#define TRAJECTORY_DECLARE(record) extern const struct trajectory_format record;
TRAJECTORY_FORMATS(TRAJECTORY_DECLARE)
#undef TRAJECTORY_DECLARE

/// The same, NULL-terminated.
extern const struct trajectory_format *const mf_trajectory_formats[];

/// What a file may not say itself; all zero says nothing.
struct trajectory_options {
    const char *units; ///< one of mf_trajectory_unit_names, for formats without their own; or NULL
    double time_step; ///< of the simulation [ps]: gives frames a time that have but a step; 0: none
    const char *group; ///< of particles, in a file that may have several; NULL: the only one
    double box[3];     ///< of frames that have none [nm]; 0: none
    bool forces;       ///< are to be read where there are any
};

struct trajectory {
    const struct trajectory_format *format;
    const char *file;           ///< borrowed
    struct structure structure; ///< what the file itself knows of its atoms
    struct trajectory_scale scale;
    double time_step;
    const char *group;    ///< borrowed
    double box[3];        ///< as told [nm]
    bool forces;          ///< are to be read where there are any
    uint64_t frames;      ///< in the file, where it says so; 0: they end with it
    char note[320];       ///< what was assumed of the file, a line for a person; "": nothing
    struct source source; ///< what follows is the readers' own
    struct trajectory_frame first;
    bool waiting; ///< the first frame is fetched and not yet given away
    void *state;
};

/// Open a trajectory, or a file with one configuration. The format is found by what the file begins
/// with, and only if that says nothing by the extension of its name.
/// Fails: BAD_INPUT for an unknown format, units that must be given, a damaged header or first
/// frame; IO; NO_MEMORY. What has failed is closed. Tested: test_trajectory_gromacs and the
/// others of tests/unit/trajectory.
enum status mf_trajectory_open(struct trajectory *trajectory, const char *file,
                               const struct trajectory_options *options) MUST_USE;

void mf_trajectory_close(struct trajectory *trajectory);

/// Read the next frame: fetch and decode. `*more` is false, and the positions as they were, after
/// the last one. Fails: BAD_INPUT with frame and byte or line, all frames before having been given
/// and none after to be had; IO; NO_MEMORY.
enum status mf_trajectory_next(struct trajectory *trajectory, struct trajectory_frame *frame,
                               bool *more) MUST_USE;

/// The two halves of it, for threads: one thread at a time takes frames from the file, in their
/// order; each is decoded by whoever has it, at the same time as others. A frame that is fetched
/// and not decoded is skipped.
enum status mf_trajectory_fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                                bool *more) MUST_USE;
enum status mf_trajectory_decode(const struct trajectory *trajectory,
                                 struct trajectory_frame *frame) MUST_USE;

/// Find the time of a frame that has been fetched, if that takes no decoding. @return whether it
/// does not.
bool mf_trajectory_peek(const struct trajectory *trajectory, struct trajectory_frame *frame);

/// What formats share -----------------------------------------------------------------------------

/// For describe: sort the structure by the ids that it has. Fails: BAD_INPUT with the frame.
enum status mf_trajectory_sort(struct trajectory *trajectory,
                               const struct trajectory_frame *first) MUST_USE;

/// For decode, before its atoms: clear which of them have been found. Fails: NO_MEMORY.
enum status mf_trajectory_begin_atoms(const struct trajectory *trajectory,
                                      struct trajectory_frame *frame) MUST_USE;

/// For decode: where the atom of an id that stands in `line` belongs. Fails: BAD_INPUT if the first
/// frame does not have it, or if it was found before.
enum status mf_trajectory_find_atom(const struct trajectory *trajectory,
                                    struct trajectory_frame *frame, const char *line, int64_t id,
                                    size_t *atom) MUST_USE;

/// For decode: an atom of the first frame is of another `type` in `line`, where beads are made by
/// the first. BAD_INPUT with both types and what is to be done.
enum status mf_trajectory_fail_type(const struct trajectory *trajectory,
                                    const struct trajectory_frame *frame, const char *line,
                                    size_t atom, const struct word *type) MUST_USE;

/// For fetch: read the number of atoms from the line taken last, which must be that of the first
/// frame.
enum status mf_trajectory_read_count(const struct trajectory *trajectory, const char *line,
                                     uint64_t *atoms) MUST_USE;

/// For a format's describe: the file itself says its units. Fails: BAD_INPUT if the user has given
/// others.
enum status mf_trajectory_found_units(struct trajectory *trajectory, const char *name) MUST_USE;
