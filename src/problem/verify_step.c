// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_step.h"

#include "dynamics/usual_step.h"

#include <math.h>

/// What a temperature may be off, relative, beside its errors.
static const double allowed = 0.01, errors = 3;

/// What is not known within this says nothing of a step.
static const double vague = 0.1;

struct density {
    const struct inverse_problem *problem;
    const struct table *potential;
};

/// That of the target, or of a gas.
static double density_at(const void *context, int pair, double r) {
    const struct density *of = context;
    const struct inverse_problem *problem = of->problem;
    const struct rdf_bins *bins = &problem->compared.bins;
    const size_t k = (size_t)(r / bins->width);
    double phi;
    if (mf_targets_have_pair(&problem->compared, (size_t)pair))
        return k < bins->count
                   ? problem->compared.target[TARGET_RDF].value[(size_t)pair * bins->count + k]
                   : 1;
    mf_table_evaluate_pair(of->potential, pair, r, &phi, NULL, NULL);
    return exp(-phi / problem->scene.temperature);
}

double mf_verify_step_of_potential(const struct inverse_problem *problem,
                                   const struct table *potential) {
    const struct simulation_setup *scene = &problem->scene;
    if (potential == NULL || !simulation_has_velocities(scene))
        return INFINITY;
    const double largest =
        mf_usual_step_curvature(potential, density_at, &(struct density){problem, potential}, NULL);
    return mf_usual_step_of_pairs(scene, largest, mf_usual_step_mass(scene));
}

struct verify_step mf_verify_step_begin(const struct inverse_problem *problem,
                                        const struct table *potential, double first,
                                        bool shortens) {
    const double holds = mf_verify_step_of_potential(problem, potential);
    struct verify_step step = {.used = first, .first = first, .would_hold = holds};
    step.shortens = shortens && mf_usual_step_applies(&problem->scene);
    while (step.shortens && step.halvings < VERIFY_STEP_HALVINGS && step.used > M_SQRT2 * holds) {
        step.used *= 0.5;
        step.halvings++;
    }
    step.tried = step.used;
    return step;
}

/// Whether what is left is more than half of what there was with twice the step, and not by chance:
/// of an error of the step a quarter would be left, or less.
static bool is_not_the_cause(const struct thermodynamics_off *before,
                             const struct thermodynamics_off *now) {
    static const double deviations = 2, small = 0.3; // where an error is as a power of the step
    const double chance = hypot(now->error, 0.5 * before->error);
    return before->known && before->kinetic == now->kinetic && fabs(before->share) < small &&
           fabs(now->share) - 0.5 * fabs(before->share) > deviations * chance;
}

/// By an error as Δt², or where it is too large for that the potential's curvature.
static void find_what_would_hold(struct verify_step *step) {
    static const double small = 0.1;
    const double share = fabs(step->off.share);
    if (!step->blew_up && share < small)
        step->would_hold = step->used * sqrt(allowed / share);
    step->would_hold = fmin(step->would_hold, 0.9 * step->used);
}

static enum verify_step_result assess(const struct verify_step *step,
                                      const struct thermodynamics_off *before) {
    const struct thermodynamics_off *now = &step->off;
    if (step->blew_up)
        return VERIFY_STEP_LONG;
    if (!now->known)
        return VERIFY_STEP_UNKNOWN;
    if (fabs(now->share) <= fmax(allowed, errors * now->error))
        return errors * now->error > vague ? VERIFY_STEP_UNKNOWN : VERIFY_STEP_HOLDS;
    return step->halvings > 0 && is_not_the_cause(before, now) ? VERIFY_STEP_NOT_THE_CAUSE
                                                               : VERIFY_STEP_LONG;
}

bool mf_verify_step_again(struct verify_step *step, const struct thermodynamics_off *off,
                          bool blew_up) {
    const struct thermodynamics_off before = step->off;
    step->off = *off;
    step->blew_up = blew_up;
    if (step->used >= step->tried) {
        step->first_off = *off;
        step->first_blew_up = blew_up;
    }
    step->result = assess(step, &before);
    if (step->result != VERIFY_STEP_LONG)
        return false;
    if (!step->shortens || step->halvings == VERIFY_STEP_HALVINGS) {
        find_what_would_hold(step);
        return false;
    }
    step->used *= 0.5;
    step->halvings++;
    return true;
}
