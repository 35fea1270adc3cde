// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_step.h"

#include "dynamics/respa.h"
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

/// The longest step with inner steps for the bonds, of a scene that says nothing of dynamics; 0:
/// they are not worth it. Memory takes short steps anyhow.
static double find_outer_step(const struct scene *scene, const struct usual_step *usual) {
    const double step =
        fmin(fmin(usual->free, usual->pairs), mf_usual_step_of_impulses(usual->fastest));
    const bool may = !scene->given.dynamics && !scene->given.memory && usual->fastest > 0;
    return may && step > usual->bonds ? step : 0;
}

/// Give them to the integrator that the scene has by default. Returns `text`.
enum { INNER_SIZE = 64 };
static const char *take_inner_steps(struct scene *scene, const struct usual_step *usual,
                                    char text[INNER_SIZE]) {
    const int64_t inner_steps = mf_usual_step_inner(scene->setup.time_step, usual->fastest);
    mf_respa_set(scene->setup.integrator, scene->integrator_parameters, inner_steps);
    snprintf(text, INNER_SIZE, ", in which bonds take %lld of their own", (long long)inner_steps);
    return text;
}

void mf_scene_step_choose(struct scene *scene, bool whole, char text[SCENE_STEP_SIZE]) {
    struct simulation_setup *setup = &scene->setup;
    // In a reduced file numbers have the names of its units, as what a fit chooses.
    const struct units *units = scene->units.system == UNITS_REDUCED ? NULL : &scene->units;
    const double factor = mf_units_factor(units, "tau");
    char reason[SCENE_STEP_SIZE], others[SCENE_STEP_SIZE], unit[UNITS_NAME_SIZE];
    char inner[INNER_SIZE];
    text[0] = '\0';
    if (scene->given.time_step || !mf_usual_step_applies(setup))
        return;
    struct usual_step usual = mf_usual_step_find(setup);
    const double least = usual_step_least(&usual);
    if (!(least > 0) || !isfinite(least)) // as of beads that nothing moves
        return;
    const double outer = whole ? 0 : find_outer_step(scene, &usual);
    const double step = mf_usual_step_round(factor * fmax(least, outer));
    const bool splits = step / factor > least;
    setup->time_step = step / factor;
    if (splits) // the least of the others
        usual.bonds = mf_usual_step_of_impulses(usual.fastest);
    describe(&usual, units, reason);
    describe_others(setup, others);
    snprintf(text, SCENE_STEP_SIZE, "chosen: time step %.4g %s%s: %.200s%.100s", step,
             mf_units_name(units, "tau", unit),
             splits ? take_inner_steps(scene, &usual, inner) : "", reason, others);
}
