// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The longest time steps that follow what a simulation has: the one rule by which fits,
/// their verifications and simulations choose a step, and doubt one that is given.
///
/// Integrators of Verlet's kind give an oscillator of angular frequency Ω the configurational
/// temperature T/(1 − (Ω Δt)²/4). Two beads oscillate with Ω² = 2 Φ''/m where Φ bends most up and
/// pairs come, and that temperature is to be right within 1 %; distributions of bonds, angles and
/// dihedrals within 0.3 % of their variance. What flies free moves a fiftieth of the way to its
/// neighbours; without velocities a step takes as long as the square of that of the time in which a
/// bead diffuses there.
#pragma once

#include "dynamics/simulation.h"

#include <math.h>

/// Whether the steps of an integrator are an approximation that can be made finer.
bool mf_usual_step_applies(const struct simulation_setup *setup);

/// [τ]; INFINITY: nothing asks for one.
struct usual_step {
    double free, pairs, bonds;
    double curvature, curvature_at; ///< Φ'' where it is largest [k_B T_0/λ²], and there r [λ]
    double fastest; ///< Ω of the fastest of bonds, angles and dihedrals; 0: none [1/τ]
};

/// Which of them is the least.
enum usual_step_limit { USUAL_STEP_FREE, USUAL_STEP_PAIRS, USUAL_STEP_BONDS };

/// By the laws of a setup, those of a group that has none yet aside. Tested: test_usual_step.
struct usual_step mf_usual_step_find(const struct simulation_setup *setup);

enum usual_step_limit mf_usual_step_limit(const struct usual_step *usual);
static inline double usual_step_least(const struct usual_step *usual) {
    return fmin(fmin(usual->free, usual->pairs), usual->bonds);
}

/// Why a step is no longer, for USUAL_STEP_FREE and USUAL_STEP_BONDS.
extern const char *const mf_usual_step_reason[];

/// The next lower of 1, 1.2, 1.5, 2, … times a power of 10.
double mf_usual_step_round(double value);

/// @name The parts of the rule

/// The least mass of a bead, and the time in which one flies, or diffuses, so far [τ].
double mf_usual_step_mass(const struct simulation_setup *setup);
double mf_usual_step_crossing(const struct simulation_setup *setup, double way);

double mf_usual_step_free(const struct simulation_setup *setup, double crossing);
double mf_usual_step_of_pairs(const struct simulation_setup *setup, double curvature, double mass);

/// Of terms whose fastest has this Ω. @param[in] integrator  that of the setup, or one to be
double mf_usual_step_of_bonds(const struct simulation_setup *setup,
                              const struct integrator *integrator, double fastest, double mass);

/// With inner steps of molecules: impulses of pairs resonate with half a period of the fastest
/// bond, Ω Δt = π, and stay far from it (docs/figures.md, time steps).
double mf_usual_step_of_impulses(double fastest);

/// Such inner steps in one, as many as aboba needs.
int64_t mf_usual_step_inner(double time_step, double fastest);

/// g of a pair type where the potential is looked at.
typedef double usual_step_density(const void *context, int pair, double r);

/// The largest Φ'' where pairs come: at g above 0.02 of its maximum. @param[out] at  r, or NULL
double mf_usual_step_curvature(const struct table *potential, usual_step_density *density,
                               const void *context, double *at);
