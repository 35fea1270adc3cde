// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a run's folder tells of its particles besides their snapshots: what their types are
/// called, and which are bonded.
#pragma once

#include "io/data_table.h"
#include "report/film_frame.h"
#include "system/composition.h"

enum { FILM_TYPES_MAX = COMPOSITION_MAX_TYPES + 1 }; ///< a solvent is one more

struct film_beads {
    int types;
    char name[FILM_TYPES_MAX][COMPOSITION_NAME_SIZE];
    bool hidden[FILM_TYPES_MAX]; ///< left out
    struct data_table bonds;     ///< rows of two particles, from 1 on; none without molecules
    double length;               ///< of bonds, on average; 0 without any
};

/// Read them from configuration.tsv and configuration_bonds.tsv, as far as these are there, and the
/// number of types from the first snapshot.
/// @param[in] hide  the names of types to leave out, "A,B"; NULL: none
/// Fails: BAD_INPUT if there is no such type, none is left, or a file is damaged; IO, NO_MEMORY.
/// Tested: cli/test_film.
enum status mf_film_beads_read(struct film_beads *beads, const char *folder, const char *first,
                               const char *hide) MUST_USE;
void mf_film_beads_clear(struct film_beads *beads);

bool mf_film_beads_hides(const struct film_beads *beads, double type);

/// The two particles of bond number n, and the nearest way from the first one to the second; false
/// if the frame has no such particles.
bool mf_film_beads_bond(const struct film_beads *beads, size_t n, const struct film_frame *frame,
                        size_t bead[2], double way[3]);
