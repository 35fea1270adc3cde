// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The trajectory of beads that a map makes, as a file for other programs: of every format
/// that has a `print`.
#pragma once

#include "io/output.h"
#include "trajectory/mapping.h"
#include "trajectory/trajectory.h"

#include <stdio.h>

/// A file being written: it appears whole with mf_beads_file_commit or, all zero, is none. It must
/// not be moved.
struct beads_file {
    const struct trajectory_format *format;
    const struct mapping *mapping;        ///< borrowed
    const struct structure *structure;    ///< of its atoms, borrowed
    size_t *order;                        ///< shape [beads]: as the atoms stand, and not by type
    bool has_velocities;                  ///< of GSD, whose frames all have them or none
    bool has_images;                      ///< likewise
    size_t frames;                        ///< that were written
    const struct trajectory_frame *beads; ///< that are being written, borrowed
    struct output output;
};

/// Begin the file whose name's ending tells its format: .gro, .xtc, .gsd (nm, ps), .xyz and
/// .extxyz, .lammpstrj and .dump (both in Å and fs). Beads stand by their molecules, in these by
/// their first atoms. Fails: BAD_INPUT for another ending; IO, NO_MEMORY.
enum status mf_beads_file_open(struct beads_file *file, const char *path,
                               const struct mapping *mapping,
                               const struct structure *structure) MUST_USE;

/// Add a frame of mf_mapping_apply. Fails: BAD_INPUT for what the format cannot hold. What cannot
/// be written fails at the end. Tested: cli/test_measure_beads.
enum status mf_beads_file_add(struct beads_file *file,
                              const struct trajectory_frame *beads) MUST_USE;

/// Begin again without the frames so far.
enum status mf_beads_file_restart(struct beads_file *file) MUST_USE;

/// Fails: IO; there is no file then.
enum status mf_beads_file_commit(struct beads_file *file) MUST_USE;

/// Give up what was not committed; of all zero too.
void mf_beads_file_clear(struct beads_file *file);

// What formats share ------------------------------------------------------------------------------

/// Å in a nm, fs in a ps, and Å/fs in a nm/ps: of formats that have those units.
static const double beads_file_angstrom = 10, beads_file_femtosecond = 1e3,
                    beads_file_angstrom_per_femtosecond = 1e-2;

/// Whether all masses are known.
bool mf_beads_file_has_masses(const struct beads_file *file);

static inline const char *beads_file_type_name(const struct beads_file *file, size_t bead) {
    return file->mapping->type_name[file->mapping->bead[bead].type];
}

/// Where steps must grow: those of the simulation, or numbers of frames.
static inline long long beads_file_step(const struct beads_file *file,
                                        const struct trajectory_frame *beads) {
    return beads->step >= 0 ? (long long)beads->step : (long long)file->frames;
}

static inline void beads_file_print_vector(FILE *stream, const double vector[3], double scale) {
    for (int d = 0; d < 3; d++)
        fprintf(stream, " %.9g", vector[d] * scale);
}
