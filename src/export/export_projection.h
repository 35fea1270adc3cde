// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What it costs to replace a friction weight ω by the power law that another engine has,
/// measured by two simulations: that of the result and one with the power law.
#pragma once

#include "export/export_power.h"
#include "observe/measure.h"

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

/// Simulate a model from its start with its own ω and with the power laws of its pairs: twenty
/// windows, of a small model up to two hundred, after three for equilibration, each of 3 ρ^(−1/d)
/// sqrt(μ/k_B T), in which pairs of neighbours part. The noise is the sqrt of the likewise weighted
/// mean of both squared standard errors.
/// @param[in] power     shape [pairs]
/// @param[in] listener  gets both simulations as one; NULL: none
/// Fails: as mf_simulation_run; BAD_INPUT for a box too small for E; NO_MEMORY. Same bits for any
/// number of threads. Tested: cli/test_export_fits.
enum status mf_export_project(const struct export_model *model, const struct export_power *power,
                              int threads, const struct measure_listener *listener,
                              struct export_projection *projection) MUST_USE;
