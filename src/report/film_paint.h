// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The colours of a film: few enough for a GIF's palette of 256.
#pragma once

#include "io/data_table.h"
#include "report/film_frame.h"
#include "system/composition.h"

#include <stdio.h>

enum { FILM_TYPES_MAX = COMPOSITION_MAX_TYPES + 1 }; ///< a solvent is one more

/// What a folder tells of its particles besides their snapshots.
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

/// What the colour stands for.
enum film_scale { FILM_TYPES, FILM_TURNS, FILM_RANGE };

enum { FILM_LAYERS = 12 }; ///< of depth

struct film_paint {
    enum film_scale scale;
    char colour[64];                ///< the quantity, as film_frame takes it
    double min, max;                ///< of a FILM_RANGE: what the ends of its colours are
    double size;                    ///< of particles without a radius
    const struct film_beads *beads; ///< borrowed
};

/// Choose from the first, the middle and the last frame: the quantity `wanted`, or NULL for
/// orientations if there are any, else types if there are several, else speeds.
/// Fails: as mf_film_frame_read. Tested: test_film.
enum status mf_film_paint_choose(struct film_paint *paint, const struct film_beads *beads,
                                 const char *const files[3], const char *wanted) MUST_USE;

/// A line for each particle that is shown, from the bottom up: x, y, radius, colour as a number;
/// what is far along z is pale. Where there are bonds, a block for each layer of depth, and before
/// it one of the halves of bonds: of each the corners, x, y, colour.
void mf_film_paint_frame(const struct film_paint *paint, const struct film_frame *frame,
                         FILE *stream);

/// Commands of gnuplot for the palette of a colour bar, where there is one.
void mf_film_paint_palette(const struct film_paint *paint, FILE *stream);
