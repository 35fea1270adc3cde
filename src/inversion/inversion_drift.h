// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The ramp A (1 − r/r_c) that grows from iteration to iteration and helps nothing.
///
/// g(r) hardly sees it, so that a target which no potential makes, as one with a wrong
/// normalisation or density, drives it on and on: of water with g times 0.992 by one k_B T an
/// iteration, which is as far as an inversion steps, while the error of g stays.
#pragma once

#include <stdbool.h>

enum { INVERSION_DRIFT_MEMORY = 5 };

/// Amplitude of the ramp [k_B T_0] and error of g of the last iterations.
struct inversion_drift {
    int count; ///< of iterations since the start
    double amplitude[INVERSION_DRIFT_MEMORY], error[INVERSION_DRIFT_MEMORY];
};

void mf_inversion_drift_add(struct inversion_drift *drift, double amplitude, double error);

/// How far the ramp has gone over the iterations in memory, if always the same way.
double mf_inversion_drift_way(const struct inversion_drift *drift);

/// Whether it has gone by several k_B T and the error of g has not become less by a quarter.
/// Tested: test_inversion_drift.
bool mf_inversion_drifts(const struct inversion_drift *drift, double temperature);
