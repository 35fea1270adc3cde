// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Numbers of a scene that hardly any liquid has, as those in another unit are.
#pragma once

#include "scene/scene.h"

enum { SCENE_DOUBT_SIZE = 320 };

/// Takes a line that begins with the key.
struct scene_doubts_listener {
    void (*tell)(void *context, const char *line);
    void *context;
};

/// What beads of a scene go by: the mean distance ρ^(−1/d) [λ], and the time in which one flies so
/// far at the thermal velocity (without velocities: in which it diffuses there) [τ].
struct scene_scales {
    double distance, time;
};
struct scene_scales mf_scene_scales(const struct scene *scene);

/// Bonds are at most so many mean distances long.
static const double scene_longest_bond = 2.5;

/// Tell of a temperature in kelvins where none are meant, or in degrees Celsius; a time step
/// many times as long as beads, their potential or their bonds allow (dynamics/usual_step.h); a
/// bond that is longer than two and a half mean distances of the beads, or shorter than any between
/// atoms; an angle of at most π degrees; a potential with a well of more than 110 k_B T, or whose
/// force ends abruptly, with 20 k_B T over its cutoff. Tested: cli/test_doubts.
void mf_scene_doubts(const struct scene *scene, const struct scene_doubts_listener *listener);
