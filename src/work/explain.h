// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene will pay for: every stage of a step, on or off and why.
#pragma once

#include "observe/etd.h"
#include "observe/motion.h"

#include <stdio.h>

/// What is measured of a simulation.
struct explain_measured {
    bool has_potential;   ///< of its own or to be fitted
    double cutoff;        ///< of the forces [λ]
    double rdf_range;     ///< 0: no g(r) [λ]
    bool rdf_force;       ///< g(r) from forces as well
    bool rdf_force_alone; ///< … and not counted, if the potential has a barrier
    bool sums;            ///< energy, pressure, temperatures
    bool force_covariance;
    int64_t every;                    ///< steps between samples
    const struct motion_plan *motion; ///< NULL: no diffusion
    const struct etd_grid *etd_grid;  ///< NULL: no escape times
    const struct etd_plan *etd_plan;
};

/// Print the stages of a step with the share of the time that each is expected to take, from costs
/// measured on one processor: shares are good to some percent of the whole.
void mf_explain_scene(FILE *out, const struct simulation_setup *setup,
                      const struct explain_measured *measured);
