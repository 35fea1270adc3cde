// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The colours of a film: few enough for a GIF's palette of 256.
#pragma once

#include "report/film_beads.h"

#include <stdio.h>

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
