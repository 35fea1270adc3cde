// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The colours of a film: few enough for a GIF's palette of 256.
#pragma once

#include "report/film_frame.h"

#include <stdio.h>

/// What the colour stands for.
enum film_scale { FILM_TYPES, FILM_TURNS, FILM_RANGE };

struct film_paint {
    enum film_scale scale;
    char colour[64]; ///< the quantity, as film_frame takes it
    double min, max; ///< of a FILM_RANGE: what the ends of its colours are
    int types;       ///< of FILM_TYPES, the solvent among them
    double size;     ///< of particles without a radius
};

/// Choose from the first, the middle and the last frame: the quantity `wanted`, or NULL for
/// orientations if there are any, else types if there are several, else speeds.
/// Fails: as mf_film_frame_read. Tested: test_film.
enum status mf_film_paint_choose(struct film_paint *paint, const char *const files[3],
                                 const char *wanted) MUST_USE;

/// A line for each particle, from the bottom up: x, y, radius, colour as a number; what is far
/// along z is pale.
void mf_film_paint_frame(const struct film_paint *paint, const struct film_frame *frame,
                         FILE *stream);

/// Commands of gnuplot for the palette of a colour bar, where there is one.
void mf_film_paint_palette(const struct film_paint *paint, FILE *stream);
