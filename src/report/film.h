// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A film of a run: its snapshots one after the other.
#pragma once

#include "base/status.h"

#include <stdbool.h>

struct film_options {
    const char *colour; ///< type, speed, orientation, stiffness, …; NULL: chosen
    int frames;         ///< at most so many, evenly chosen
    bool force;         ///< replace a film that somebody has changed
};

/// Make figures/film.mp4 in the folder of a run where ffmpeg is installed, figures/film.gif
/// elsewhere, of the snapshots that the run has left as VTP or JSON.
/// @param[out] made  the path, of OUTPUT_PATH_SIZE bytes
/// Fails: BAD_INPUT without snapshots of these kinds; IO without gnuplot; NO_MEMORY. What is left
/// unfinished is removed. Tested: cli/test_film.
enum status mf_film_make(const char *folder, const struct film_options *options,
                         char *made) MUST_USE;
