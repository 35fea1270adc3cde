// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The friction weights that other engines have, which of them is nearest to a given ω, and
/// what it costs to replace a friction weight ω by what another engine has, a power law or a bath
/// of each bead, measured by two simulations: that of the result and one with the other.
#pragma once

#include "curves/table.h"
#include "export/export_model.h"
#include "observe/measure.h"

/// What friction between pairs an engine has: none; ω = A (1 − r/r_c); A (1 − r/r_c)^s, as LAMMPS's
/// dpd/ext/tstat; A (1 − (r/r_c)^s), as ESPResSo.
enum export_friction { EXPORT_NO_FRICTION, EXPORT_LINEAR, EXPORT_POWER, EXPORT_RISING };

struct export_power {
    enum export_friction family;
    double amplitude; ///< A [sqrt(μ/τ)]
    double exponent;  ///< s
    double cutoff;    ///< r_c [λ]
    double misfit;    ///< sqrt(Σ w (ω − law)² / Σ w ω²), w = r² exp(−Φ/k_B T)
};

/// A misfit below which the two count as the same friction: dynamics differ by less than they can
/// be measured in a run of some minutes.
#define EXPORT_POWER_BOUND 0.01

/// Least squares of a pair type's ω, weighted as pairs of a dilute gas are; s = 1, which engines
/// know best, if it is good enough. All zero where ω is.
/// @param[in] form  the family; an exponent and a cutoff, 0: to be found, and that of ω
/// Tested: test_export_model.
struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature,
                                        const struct export_power *form);

enum { EXPORT_BINS = 12, EXPORT_TIMES = 21 };

/// Means and standard errors of one simulation.
struct export_measured {
    struct export_number temperature; ///< [T_0]
    struct export_number diffusion; ///< slope of the MSD over the second half of a window [λ²/τ]
    double survival[EXPORT_TIMES * EXPORT_BINS], error[EXPORT_TIMES * EXPORT_BINS]; ///< E(t, r_0)
    uint64_t pairs[EXPORT_BINS]; ///< that began in a bin of r_0
};

struct export_projection {
    struct export_measured result, projected;
    double interval; ///< between times of E [τ]
    double
        r_maximum; ///< where bins of r_0, equally wide from 0 on, end, and pairs have escaped [λ]
    int64_t steps; ///< of each simulation, after its equilibration
    double rms;    ///< of E(projected) − E(result) at t > 0, each bin weighted with its pairs
    double noise;  ///< what it would be on average if the two frictions were the same
};

/// What stands for the friction of the result.
struct export_substitute {
    const struct export_power *power;  ///< shape [pairs]; NULL: a bath of each bead
    const struct export_power *across; ///< the same across pairs; with `power`
    double rate;                       ///< γ/m of the bath [1/τ]
};

/// Particles times steps that a simulation takes in passing, a minute of one core at most.
#define EXPORT_IN_PASSING 3e8

/// Simulate a model from its start with its own friction and with what stands for it, for windows
/// of 3 ρ^(−1/d) sqrt(μ/k_B T), in which pairs of neighbours part: twenty, of a small model up to
/// two hundred, after three for equilibration; in passing ten and sixty. The noise is the sqrt of
/// the likewise weighted mean of both squared standard errors.
/// @param[in] listener  gets both simulations as one; NULL: none
/// Fails: as mf_simulation_run; BAD_INPUT for a box too small for E, and in passing for a model
/// that takes more than EXPORT_IN_PASSING; NO_MEMORY. Same bits for any number of threads. Tested:
/// cli/test_export_fits.
enum status mf_export_project(const struct export_model *model,
                              const struct export_substitute *substitute, bool in_passing,
                              int threads, const struct measure_listener *listener,
                              struct export_projection *projection) MUST_USE;
