// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/skin.h"

#include <math.h>

/// Costs of building a list, in units of what going once through an entry of it costs in the pair
/// loop (0.7 ns). Measured on Zen 5 with AVX-512: 28 ns a particle for sorting, 0.9 ns an entry.
/// The minimum is flat: from 0.15 to 0.35 the steps/s of the water scene change by 3 %.
static const double particle_cost = 40, entry_cost = 1.3;

/// Entries of a particle on a half list.
static double entries(const struct skin_scene *scene, double skin) {
    const double density = (double)scene->count / mf_box_volume(scene->box);
    return density * mf_box_shell_volume(scene->box, 0, scene->cutoff + skin) / 2;
}

/// Square root of the number of steps in which the fastest particle walks and drifts half the skin.
static double walk_roots(const struct skin_scene *scene, double fastest, double skin) {
    const double walk = scene->free_step * fastest, drift = scene->drift * scene->time_step;
    return skin / (walk + sqrt(walk * walk + 2 * drift * skin));
}

double mf_skin_interval(const struct skin_scene *scene, double skin) {
    const double fastest = 2 * log((double)scene->count + 1);
    if (scene->free_step > 0 || scene->drift > 0) // skin/2 = walk q + drift q² after q² steps
        return fmax(1, pow(walk_roots(scene, sqrt(fastest), skin), 2) + 0.5);
    const double speed = sqrt(2 * scene->temperature * log((double)scene->count + 1));
    // Half a step on average from the moment when the list runs out to its replacement.
    return fmax(1, skin / (2 * speed * scene->time_step) + 0.5);
}

static double step_cost(const struct skin_scene *scene, double skin) {
    const double listed = entries(scene, skin);
    return listed + (particle_cost + entry_cost * listed) / mf_skin_interval(scene, skin);
}

/// So far apart may particles drift that were neighbours in memory.
static const double sorted_spacings = 10;

static double spacing_of(const struct skin_scene *scene) {
    return pow(mf_box_volume(scene->box) / (double)scene->count, 1.0 / scene->box->dimensions);
}

double mf_skin_choose(const struct skin_scene *scene) {
    enum { CANDIDATES = 64 };
    // Without pairs the list only keeps in memory together what is near each other.
    if (scene->cutoff == 0)
        return fmin(sorted_spacings * spacing_of(scene), mf_box_shortest(scene->box) / 4);
    // No wider than the cutoff, nor than the nearest images allow.
    const double widest = fmin(scene->cutoff, mf_box_shortest(scene->box) / 2 - scene->cutoff);
    double best = 0;
    for (int k = 1; k <= CANDIDATES; k++) {
        const double skin = widest * k / CANDIDATES;
        if (step_cost(scene, skin) < step_cost(scene, best))
            best = skin;
    }
    return fmax(0, best);
}
