// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_assessment.h"

#include <math.h>

/// The error of what is near to its target, in units of its noise (the root of χ² by bin), and of
/// what stays near.
static const double near_noises = 2, still_near_noises = 3;

const struct inversion_section *
mf_inversion_assessment_worst(const struct inversion_assessment *assessment) {
    const struct inversion_section *worst = &assessment->section[0];
    for (int k = 1; k < assessment->sections; k++) {
        const struct inversion_section *section = &assessment->section[k];
        if (section->misfit * worst->probable > worst->misfit * section->probable)
            worst = section;
    }
    return worst;
}

bool mf_inversion_assessment_is_precise(const struct inversion_assessment *assessment) {
    for (int k = 0; k < assessment->sections; k++)
        if (assessment->section[k].own_noise > assessment->section[k].precision)
            return false;
    return true;
}

double mf_inversion_assessment_noises(const struct inversion_assessment *assessment,
                                      const struct targets *targets,
                                      const struct target_distance distance[TARGETS]) {
    double sum = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        const double noise = kind == TARGET_PRESSURE || kind == TARGET_DENSITY
                                 ? assessment->bulk_reach
                                 : assessment->distance[kind].noise;
        if (targets_ask(targets, kind) && noise > 0)
            sum += pow(distance[kind].rms / noise, 2);
    }
    return sqrt(sum);
}

bool mf_inversion_assessment_is_near(const struct inversion_assessment *assessment, bool stays) {
    const double noises = stays ? still_near_noises : near_noises;
    for (int k = 0; k < assessment->sections; k++)
        if (!(assessment->section[k].misfit < noises * noises) &&
            !inversion_section_agrees(&assessment->section[k]))
            return false;
    return true;
}
