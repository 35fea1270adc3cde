// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene will pay for: every stage of a step, on or off and why.
#pragma once

#include "observe/observable.h"
#include "scene/scene.h"

#include <stdio.h>

/// Print the scale of a scene whose file has physical units.
void mf_explain_scale(FILE *out, const struct units *units);

/// Print what a person should know of a scene before it is simulated.
void mf_explain_doubts(FILE *out, const struct scene *scene);

/// Print the stages of a step with the share of the time that each is expected to take, from costs
/// measured on one processor: shares are good to some percent of the whole.
/// @param[in] uses   what is measured, with its settings, ended by one without an observable
/// @param[in] every  steps between samples
void mf_explain_scene(FILE *out, const struct simulation_setup *setup, const struct units *units,
                      const struct observable_use *uses, int64_t every);

/// Seconds of a sweep of Monte Carlo of so many beads with a potential of that range [λ], by one
/// thread of a processor of 2024.
double mf_explain_sweep(const struct simulation_setup *setup, double particles, double range);

/// The same of a trajectory of hybrid Monte Carlo (dynamics/hybrid.h) of molecules: five times what
/// its passes over the pairs take, with lists, counts, and inner steps of bonds. Of rings, chains
/// of six and stiff chains of ten it was 4.7 to 6.4 times.
double mf_explain_trajectory(const struct simulation_setup *setup, double particles, double range);
