// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A film of a run: its snapshots one after the other.
#pragma once

#include "base/status.h"
#include "scene/run_options.h"

#include <stdbool.h>

struct film_options {
    const char *colour; ///< type, speed, orientation, stiffness, …; NULL: chosen
    const char *hide;   ///< names of types that are left out, "A,B"; NULL: none
    int frames;         ///< at most so many, evenly chosen
    enum run_words quiet;
    bool force; ///< replace a film that somebody has changed
};

/// Make figures/film.mp4 in the folder of a run where ffmpeg is installed, figures/film.gif
/// elsewhere, of the snapshots that the run has left as VTP or JSON, with the bonds that its folder
/// tells.
/// @param[out] made  the path, of OUTPUT_PATH_SIZE bytes
/// Fails: BAD_INPUT without snapshots of these kinds; IO without gnuplot; NO_MEMORY. What is left
/// unfinished is removed. Tested: cli/test_film.
enum status mf_film_make(const char *folder, const struct film_options *options,
                         char *made) MUST_USE;
