// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a data file of LAMMPS holds and where: manual, command `read_data`.
#pragma once

#include "base/status.h"
#include "trajectory/frame.h"
#include "trajectory/structure.h"

enum { LAMMPS_DATA_MAX_TYPES = 1 << 16, LAMMPS_DATA_WORDS = 10 };

/// Where an atom's words stand: after its id, and before its three images.
struct lammps_style {
    const char *name;
    int molecule, type, charge, position; ///< −1: nowhere
};

/// Bonds, angles and dihedrals.
struct lammps_data_terms {
    size_t count, types;
    const char *first, *labels, *coefficients; ///< lines of the sections; NULL: there is none
    char style[32];                            ///< of the coefficients, "" if it is not given
};

struct lammps_data {
    size_t atoms, types;
    double origin[3], box[3][3];
    bool is_text; ///< has the number of atoms and the bounds of x, or vector a, in words
    const char *masses, *atom, *velocities; ///< first lines of the sections; NULL: there is none
    const char *labels;                     ///< of the types of atoms
    const char *kinds;                      ///< of a template for "molecule": types of its atoms
    struct lammps_data_terms terms[STRUCTURE_TERM_KINDS];
    char style[32]; ///< comment of the section; "" if it has none
    char units[32]; ///< of the title; "" if it has none
    int64_t step;   ///< of the title; −1: not said
    const char
        *foreign; ///< a line of the header with terms or particles that are not read, or NULL
    const char *unknown; ///< heading of a section that is none of LAMMPS's that we know, or NULL
};

/// Find everything; lines end with NUL. Fails: BAD_INPUT with the line.
enum status mf_lammps_data_read(struct lammps_data *data,
                                const struct trajectory_frame *frame) MUST_USE;

/// Split a line of a section up to its comment; returns how many words it has, all those beyond
/// LAMMPS_DATA_WORDS being counted and not kept.
size_t mf_lammps_data_split(const char *line, struct word word[LAMMPS_DATA_WORDS]);

/// Whether a line that begins with a letter is of a section, and begins with a label: in headings
/// there are no numbers.
bool mf_lammps_data_is_labelled(const struct word *word, size_t count);

/// The names of `types` types by a section of labels, or else their numbers. Fails: BAD_INPUT for a
/// line that is no number and its label.
/// @param[out] name  shape [types + 1], by the number of the type
enum status mf_lammps_data_names(const struct trajectory_frame *frame, const char *labels,
                                 size_t types, char (*name)[STRUCTURE_NAME]) MUST_USE;

/// The number of a type that a word has as its number or its label; 0: there is none.
size_t mf_lammps_data_type(const struct word *word, size_t types,
                           const char (*name)[STRUCTURE_NAME]);

/// The style of the atoms, by its name, or else by how many words an atom has and whether the third
/// is always a whole number. Fails: BAD_INPUT for a style that is not read.
enum status mf_lammps_data_style(const struct lammps_data *data,
                                 const struct trajectory_frame *frame,
                                 const struct lammps_style **style) MUST_USE;
