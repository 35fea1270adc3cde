// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_step.h"

#include "dynamics/usual_step.h"

#include <stdio.h>

/// Why it is no longer.
static void describe(const struct usual_step *usual, const struct units *units,
                     char reason[SCENE_STEP_SIZE]) {
    const enum usual_step_limit limit = mf_usual_step_limit(usual);
    char unit[UNITS_NAME_SIZE], length[UNITS_NAME_SIZE];
    if (limit == USUAL_STEP_PAIRS)
        snprintf(reason, SCENE_STEP_SIZE,
                 "the curvature of the potential is up to %.4g %s, at %.4g %s, and the "
                 "configurational temperature is to be right within 1 %%",
                 mf_units_factor(units, "k_B T_0/lambda^2") * usual->curvature,
                 mf_units_name(units, "k_B T_0/lambda^2", unit),
                 mf_units_factor(units, "lambda") * usual->curvature_at,
                 mf_units_name(units, "lambda", length));
    else
        snprintf(reason, SCENE_STEP_SIZE, "%s", mf_usual_step_reason[limit]);
}

/// Forces that the rule does not know.
static void describe_others(const struct simulation_setup *setup, char others[SCENE_STEP_SIZE]) {
    size_t used = 0;
    others[0] = '\0';
    for (int k = 0; k < setup->interactions && used < SCENE_STEP_SIZE; k++)
        if (setup->interaction[k].kind != &mf_molecules)
            used += (size_t)snprintf(others + used, SCENE_STEP_SIZE - used, "%s\"%s\"",
                                     used > 0 ? ", " : "; not looked at are the forces of ",
                                     setup->interaction[k].kind->name);
}

void mf_scene_step_choose(struct scene *scene, char text[SCENE_STEP_SIZE]) {
    struct simulation_setup *setup = &scene->setup;
    // In a reduced file numbers have the names of its units, as what a fit chooses.
    const struct units *units = scene->units.system == UNITS_REDUCED ? NULL : &scene->units;
    const double factor = mf_units_factor(units, "tau");
    char reason[SCENE_STEP_SIZE], others[SCENE_STEP_SIZE], unit[UNITS_NAME_SIZE];
    text[0] = '\0';
    if (scene->given.time_step || !mf_usual_step_applies(setup))
        return;
    const struct usual_step usual = mf_usual_step_find(setup);
    const double least = usual_step_least(&usual);
    if (!(least > 0) || !isfinite(least)) // as of beads that nothing moves
        return;
    const double step = mf_usual_step_round(factor * least);
    setup->time_step = step / factor;
    describe(&usual, units, reason);
    describe_others(setup, others);
    snprintf(text, SCENE_STEP_SIZE, "chosen: time step %.4g %s: %.200s%.100s", step,
             mf_units_name(units, "tau", unit), reason, others);
}
