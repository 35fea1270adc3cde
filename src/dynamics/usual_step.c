// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/usual_step.h"

#include "dynamics/aboba.h"
#include "dynamics/hybrid_step.h"
#include "dynamics/respa.h"

#include <math.h>

/// What the configurational temperature, and the variance of a bond, may be wrong by.
static const double allowed_of_pairs = 0.01, allowed_of_bonds = 0.003;

/// Of the way to the neighbours, in a step.
static const double share_of_way = 0.02;

const char *const mf_usual_step_reason[] = {
    [USUAL_STEP_FREE] = "beads move a fiftieth of the distance to their neighbours",
    [USUAL_STEP_BONDS] =
        "the distributions of bonds and angles are to be right within 0.3 % of their variance",
};

bool mf_usual_step_applies(const struct simulation_setup *setup) {
    const struct integrator *integrator = setup->integrator;
    return !integrator->events && !integrator->samples && !integrator->model_time_step &&
           integrator->solvent_particles == NULL;
}

double mf_usual_step_round(double value) {
    static const double steps[] = {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8};
    const double power = pow(10, floor(log10(value) + 1e-9));
    double rounded = power;
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        if (steps[k] * power <= value * (1 + 1e-9))
            rounded = steps[k] * power;
    return rounded;
}

double mf_usual_step_mass(const struct simulation_setup *setup) {
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    return masses.maximum > 0 ? masses.minimum : 1;
}

double mf_usual_step_crossing(const struct simulation_setup *setup, double way) {
    const double mobility = setup->integrator->mobility ? setup->integrator->mobility(setup) : 0;
    return mobility > 0 ? way * way / (2 * setup->temperature * mobility)
                        : way * sqrt(mf_usual_step_mass(setup) / setup->temperature);
}

double mf_usual_step_free(const struct simulation_setup *setup, double crossing) {
    return (setup->integrator->mobility ? share_of_way * share_of_way : share_of_way) * crossing;
}

/// Without velocities, with x = Δt Φ''/γ, Euler's steps give a variance of T/(Φ'' (1 − x/2)); those
/// of "brownian" the exact one, and a liquid of Lennard-Jones beads the temperature 1.002(4) with x
/// up to 0.8.
static double find_relaxing_step(const struct simulation_setup *setup, double curvature,
                                 double allowed) {
    static const double share_of_exact = 0.4;
    const double share = setup->integrator == &mf_brownian ? share_of_exact : 2 * allowed;
    return share / (curvature * setup->integrator->mobility(setup));
}

double mf_usual_step_of_pairs(const struct simulation_setup *setup, double curvature, double mass) {
    return setup->integrator->mobility ? find_relaxing_step(setup, 2 * curvature, allowed_of_pairs)
                                       : sqrt(4 * allowed_of_pairs * mass / (2 * curvature));
}

double mf_usual_step_of_bonds(const struct simulation_setup *setup,
                              const struct integrator *integrator, double fastest, double mass) {
    return integrator->mobility
               ? find_relaxing_step(setup, mass * fastest * fastest, allowed_of_bonds)
               : sqrt(allowed_of_bonds / mf_hybrid_step_wrong(integrator)) / fastest;
}

double mf_usual_step_of_impulses(double fastest) {
    static const double turn = 0.9;
    return turn / fastest;
}

int64_t mf_usual_step_inner(double time_step, double fastest) {
    const double step = sqrt(allowed_of_bonds / mf_hybrid_step_wrong(&mf_velocity_verlet));
    return 2 * (int64_t)ceil(time_step * fastest / (2 * step)); // as aboba has it
}

double mf_usual_step_curvature(const struct table *potential, usual_step_density *density,
                               const void *context, double *at) {
    static const double rare = 0.02;
    double largest = 0, place = 0;
    for (int pair = 0; pair < potential->curves; pair++) {
        const double spacing = 1 / mf_table_inverse_spacing(potential, pair);
        double highest = 0;
        for (int k = 0; k < TABLE_INTERVALS; k++)
            highest = fmax(highest, density(context, pair, (k + 0.5) * spacing));
        for (int k = 0; k < TABLE_INTERVALS; k++) {
            const double r = (k + 0.5) * spacing;
            double curvature;
            mf_table_evaluate_pair(potential, pair, r, NULL, NULL, &curvature);
            if (!(density(context, pair, r) > rare * highest) || !(curvature > largest))
                continue;
            largest = curvature;
            place = r;
        }
    }
    if (at)
        *at = place;
    return largest;
}

// Of a setup --------------------------------------------------------------------------------------

/// That of a gas.
static double density_of_gas(const void *context, int pair, double r) {
    const struct simulation_setup *setup = context;
    double phi;
    mf_table_evaluate_pair(setup->potential, pair, r, &phi, NULL, NULL);
    return exp(-phi / setup->temperature);
}

static double find_fastest(const struct simulation_setup *setup) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const double squared = molecules ? mf_hybrid_step_fastest(molecules, setup->temperature) : 0;
    return sqrt(squared / mf_usual_step_mass(setup));
}

static double find_bonded_step(const struct simulation_setup *setup, double fastest) {
    const struct integrator *integrator = setup->integrator;
    const double mass = mf_usual_step_mass(setup);
    if (!(fastest > 0))
        return INFINITY;
    if (!mf_respa_acts(setup))
        return mf_usual_step_of_bonds(setup, integrator, fastest, mass);
    const double inner = (double)mf_respa_inner_steps(integrator, setup->integrator_parameters) *
                         mf_usual_step_of_bonds(setup, &mf_velocity_verlet, fastest, mass);
    return fmin(inner, mf_usual_step_of_impulses(fastest));
}

struct usual_step mf_usual_step_find(const struct simulation_setup *setup) {
    const double density = (double)setup->placement.count / mf_box_volume(&setup->box);
    const double way = pow(density, -1.0 / setup->box.dimensions);
    struct usual_step usual = {.free =
                                   mf_usual_step_free(setup, mf_usual_step_crossing(setup, way)),
                               .pairs = INFINITY,
                               .bonds = INFINITY};
    if (!(setup->temperature > 0)) // nothing moves by itself
        return usual;
    if (setup->potential)
        usual.curvature =
            mf_usual_step_curvature(setup->potential, density_of_gas, setup, &usual.curvature_at);
    if (usual.curvature > 0)
        usual.pairs = mf_usual_step_of_pairs(setup, usual.curvature, mf_usual_step_mass(setup));
    usual.fastest = find_fastest(setup);
    usual.bonds = find_bonded_step(setup, usual.fastest);
    return usual;
}

enum usual_step_limit mf_usual_step_limit(const struct usual_step *usual) {
    const double least = usual_step_least(usual);
    return usual->bonds <= least   ? USUAL_STEP_BONDS
           : usual->pairs <= least ? USUAL_STEP_PAIRS
                                   : USUAL_STEP_FREE;
}
