// SPDX-License-Identifier: GPL-3.0-or-later
//
// The time step, where the run file leaves it to the program.
#include "defaults/fit_choice.h"
#include "defaults/fit_engine.h"
#include "dynamics/usual_step.h"
#include "dynamics/hybrid_step.h"
#include "inversion/inversions.h"
#include "observe/shear_viscosity.h"

#include <math.h>
#include <stdio.h>

// Bonds, angles and dihedrals ---------------------------------------------------------------------

/// Where a target falls to half of its peak, in bins, by a straight line from bin k, above it, to
/// the next one; the middle of k at an end of all bins.
static double find_half(const struct target_bonded *target, size_t k, int way, double half) {
    const bool last = way < 0 ? k == 0 : k + 1 == target->bins.count;
    const double *const value = target->value;
    if (last)
        return (double)k;
    const size_t next = way < 0 ? k - 1 : k + 1;
    return (double)k + way * (value[k] - half) / (value[k] - value[next]);
}

/// Mean and variance of a target's q, from its peak on as far as it is above half of that, as of a
/// normal distribution: the stiffest well of several. Bins make it wider by a twelfth of their
/// square.
static void find_well(const struct target_bonded *target, double *mean, double *variance) {
    const struct bonded_bins *bins = &target->bins;
    size_t peak = 0, low, high;
    for (size_t k = 0; k < bins->count; k++)
        peak = target->value[k] > target->value[peak] ? k : peak;
    const double half = 0.5 * target->value[peak], square = bins->width * bins->width / 12;
    for (low = peak; low > 0 && target->value[low - 1] > half; low--) {
    }
    for (high = peak; high + 1 < bins->count && target->value[high + 1] > half; high++) {
    }
    const double width = find_half(target, high, 1, half) - find_half(target, low, -1, half);
    *mean = bonded_bins_centre(bins, peak);
    *variance = fmax(pow(width * bins->width, 2) / (8 * log(2)) - square, square);
}

/// ω² of a group, by its target, or by its law if it has none.
static double fastest_of(const struct fit_choice *c, int order, size_t g, double length) {
    const struct target_groups *groups = target_files_groups(&c->fit->files, order);
    const struct bonded_curve *curve = &c->fit->scene.molecules.molecules.group[order][g].curve;
    const double temperature = c->fit->scene.setup.temperature;
    double mean, variance;
    if (target_groups_have(groups, g)) {
        find_well(&groups->member[g], &mean, &variance);
        variance *= mf_bonded_kinds[order]->scale * mf_bonded_kinds[order]->scale;
    } else {
        variance = mf_hybrid_step_variance(curve, order, temperature);
    }
    return mf_hybrid_step_squared_frequency(order, variance, length, temperature) / c->mass;
}

/// Where a group of bonds is most often, by its target or by its law [λ].
static double length_of(const struct fit_choice *c, size_t g) {
    const struct target_groups *bonds = target_files_groups(&c->fit->files, BONDED_BOND);
    double mean, variance;
    if (!target_groups_have(bonds, g))
        return mf_bonded_reach(&c->fit->scene.molecules.molecules.group[BONDED_BOND][g].curve,
                               c->fit->scene.setup.temperature);
    find_well(&bonds->member[g], &mean, &variance);
    return mean;
}

static double shortest_bond(const struct fit_choice *c) {
    double length = INFINITY;
    for (int g = 0; g < c->fit->scene.molecules.molecules.groups[BONDED_BOND]; g++)
        length = fmin(length, length_of(c, (size_t)g));
    return length;
}

double mf_fit_longest_molecule(const struct fit_choice *c) {
    const struct molecules *molecules = &c->fit->scene.molecules.molecules;
    double bond = 0, bonds = 0;
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++)
        bond = fmax(bond, length_of(c, (size_t)g));
    for (int k = 0; k < molecules->topology.kinds; k++)
        bonds = fmax(bonds, molecules->topology.kind[k].beads - 1);
    return bonds * bond;
}

static double find_fastest(const struct fit_choice *c) {
    const struct molecules *molecules = &c->fit->scene.molecules.molecules;
    const double length = shortest_bond(c);
    double fastest = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (size_t g = 0; g < (size_t)molecules->groups[order]; g++)
            fastest = fmax(fastest, fastest_of(c, order, g, length));
    return sqrt(fastest);
}

static double find_stiff_step(const struct fit_choice *c) {
    // Friction is chosen later, and then aboba is the default.
    const struct integrator *integrator =
        c->fit->scene.given.dynamics ? c->fit->scene.setup.integrator : &mf_aboba;
    return mf_usual_step_of_bonds(&c->fit->scene.setup, integrator, find_fastest(c), c->mass);
}

// The choice --------------------------------------------------------------------------------------

/// A whole fraction of the interval of targets at times, if there are any; else round in the units
/// of the file.
static double fit_interval(const struct fit_choice *c, double time_step) {
    const struct target_files *files = &c->fit->files;
    const double interval =
        files->given[TARGET_ETD]    ? target_files_etd(files)->interval
        : files->given[TARGET_VACF] ? target_files_curve(files, TARGET_VACF)->interval
        : files->given[TARGET_MSD]  ? target_files_curve(files, TARGET_MSD)->interval
                                    : 0;
    const double unit = mf_units_factor(&c->fit->scene.units, "tau");
    return interval > 0 ? interval / ceil(interval / time_step - 1e-9)
                        : mf_usual_step_round(time_step * unit) / unit;
}

/// A step that the file gives and no simulation follows.
static void doubt_time_step(struct fit_choice *c, double usual) {
    static const double many = 10;
    char given[FIT_CHOICE_TEXT_SIZE], own[FIT_CHOICE_TEXT_SIZE];
    if (c->time_step > (1 - 1e-9) * many * usual)
        snprintf(c->fit->choices.doubt, FIT_CHOICE_SIZE,
                 "scene.time_step: %s is %.0f times as long as the program would choose by this "
                 "target, %s: left out, it is chosen",
                 mf_fit_choice_text(c, "tau", c->time_step, given), c->time_step / usual,
                 mf_fit_choice_text(c, "tau", usual, own));
}

/// Whether the stress of all forces is asked for, step by step.
static bool asks_for_stress(const struct fit_choice *c) {
    struct observable_kind found;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++)
        if (found.observable == &mf_shear_viscosity && c->fit->files.given[kind])
            return true;
    return false;
}

/// Whether bonds, angles and dihedrals may have steps of their own: where nothing is said of
/// dynamics, all is simulated here, and nothing is to be followed in shorter steps.
static bool may_have_inner_steps(const struct fit_choice *c) {
    const struct scene_given *given = &c->fit->scene.given;
    return !given->dynamics && !given->memory && c->fit->engine.kind == ENGINE_NONE &&
           !(c->fit->verification_given & mf_fields_bit(mf_verify_fields, "time_step")) &&
           !asks_for_stress(c);
}

/// A step of the pairs, and the steps that molecules take in it, or 0.
static double find_time_step(const struct fit_choice *c, double of_pairs, double stiff,
                             int64_t *inner_steps) {
    const double fastest = find_fastest(c);
    const double step = fit_interval(c, fmin(of_pairs, mf_usual_step_of_impulses(fastest)));
    *inner_steps = 0;
    if (!may_have_inner_steps(c) || step <= stiff)
        return fit_interval(c, fmin(of_pairs, stiff));
    *inner_steps = mf_usual_step_inner(step, fastest);
    return step;
}

/// How the step was chosen.
static void note_time_step(const struct fit_choice *c, double bound, double free, double stiff) {
    char step[FIT_CHOICE_TEXT_SIZE], curvature[FIT_CHOICE_TEXT_SIZE], at[FIT_CHOICE_TEXT_SIZE];
    mf_fit_choice_text(c, "tau", c->time_step, step);
    mf_fit_choice_text(c, "k_B T_0/lambda^2", c->scales.curvature, curvature);
    mf_fit_choice_text(c, "lambda", c->scales.curvature_at, at);
    if (c->fit->inner_steps > 0)
        mf_fit_choice_note(c,
                           "time step %s, in which bonds, angles and dihedrals take %lld of their "
                           "own: their distributions are to be right within 0.3 %% of their "
                           "variance",
                           step, (long long)c->fit->inner_steps);
    else if (stiff <= fmin(free, bound))
        mf_fit_choice_note(c, "time step %s: %s", step, mf_usual_step_reason[USUAL_STEP_BONDS]);
    else if (bound < free)
        mf_fit_choice_note(c,
                           "time step %s: the curvature of -k_B T ln g is up to %s, at %s, and the "
                           "configurational temperature is to be right within 1 %%",
                           step, curvature, at);
    else
        mf_fit_choice_note(c, "time step %s: %s", step, mf_usual_step_reason[USUAL_STEP_FREE]);
}

/// Φ is at most as steep as −k_B T ln g where pairs come near.
void mf_fit_defaults_time_step(struct fit_choice *c) {
    const struct simulation_setup *setup = &c->fit->scene.setup;
    const double stiff = find_stiff_step(c);
    const double free = mf_usual_step_free(setup, c->crossing);
    const double bound = mf_usual_step_of_pairs(setup, c->scales.curvature, c->mass);
    int64_t inner_steps;
    const double usual = find_time_step(c, fmin(free, bound), stiff, &inner_steps);
    double *const time_step = &c->fit->scene.setup.time_step;
    c->time_step = *time_step;
    if (c->fit->scene.given.time_step) {
        doubt_time_step(c, usual);
        return;
    }
    c->time_step = usual;
    c->fit->inner_steps = inner_steps;
    *time_step = mf_fit_choice_number(c, "scene", mf_scene_fields, "time_step", c->time_step);
    if (!mf_fit_engine_moves(c->fit))
        note_time_step(c, bound, free, stiff);
}
