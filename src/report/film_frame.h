// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One snapshot of a run, read back from its file for a film.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

struct film_frame {
    double time;
    double box[3];        ///< the third 0 in two dimensions
    size_t count;         ///< particles, those of a solvent among them, which come last
    double *position;     ///< shape [count, 3]
    double *type;         ///< shape [count]: numbers from 0 on
    double *radius;       ///< shape [count], 0 where they have none; NULL: none has one
    double *colour;       ///< shape [count]: the quantity that was asked for
    bool mixed, oriented; ///< there are several types; particles have orientations
};

/// Read a snapshot in VTP or JSON, as this program writes them.
/// @param[in] colour  "type", "speed", or a number that the particles have; NULL: none
/// Fails: BAD_INPUT if it is damaged or has no such number, IO, NO_MEMORY. Tested: test_film.
enum status mf_film_frame_read(struct film_frame *frame, const char *file,
                               const char *colour) MUST_USE;
void mf_film_frame_clear(struct film_frame *frame);
