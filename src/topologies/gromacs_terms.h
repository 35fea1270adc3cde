// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Terms of a GROMACS topology: what topologies/gromacs_topology.c reads it with.
#pragma once

#include "topologies/gromacs_functions.h"
#include "trajectory/gromacs_text.h"
#include "topologies/gromacs_topology.h"

enum { GROMACS_MAX_WORDS = 32, GROMACS_MAX_TYPES = 4096, GROMACS_WORD_SIZE = 32 };
enum { GROMACS_MAX_ATOMS = 20000, GROMACS_MAX_TERMS = 100000 }; ///< of a moleculetype

/// A line of [ bondtypes ] and the like.
struct gromacs_term_type {
    int order, number; ///< of terms, of the function
    char bead[BONDED_MAX_TERM_BEADS][GROMACS_WORD_SIZE];
    int words;
    double value[2 * GROMACS_MAX_PARAMETERS];
};

struct gromacs_reading {
    struct molecules *molecules;
    struct composition *composition;
    double length, energy; ///< λ [nm], k_B T_0 [kJ/mol]
    bool lawless;          ///< nobody needs laws: terms of any function are groups
    struct gromacs_note *note;
    int order;                      ///< of the section: of terms and their types
    bool constraints;               ///< the section is of bonds that are held
    struct gromacs_term_type *type; ///< shape [GROMACS_MAX_TYPES]
    size_t types;
    size_t atom_capacity, term_capacity[BONDED_KINDS]; ///< of the kind that is being read
};

/// The words of a line.
struct gromacs_words {
    char *word[GROMACS_MAX_WORDS];
    int count;
};

/// Whether a word is a whole number from `min` to `max`.
bool mf_gromacs_is_integer(const char *word, int64_t min, int64_t max, int64_t *value);

/// The moleculetype that is being read, or NULL.
struct topology_kind *mf_gromacs_last_kind(const struct gromacs_reading *reading);

/// Room for one more item of `size` bytes after `count`. Fails: NO_MEMORY.
enum status mf_gromacs_reserve(void **array, size_t count, size_t *capacity, size_t size) MUST_USE;

/// A line of [ bondtypes ] and the like, and one of [ bonds ] and the like, of reading->order.
/// Fails: BAD_INPUT with file and line; NO_MEMORY.
enum status mf_gromacs_add_type(struct gromacs_reading *reading, const struct gromacs_line *line,
                                const struct gromacs_words *words) MUST_USE;
enum status mf_gromacs_add_term(struct gromacs_reading *reading, const struct gromacs_line *line,
                                const struct gromacs_words *words) MUST_USE;
