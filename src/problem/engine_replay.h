// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Frames of another engine as a simulation: a step of it takes the next frame. What observes
/// simulations then observes those.
#pragma once

#include "dynamics/integrator.h"
#include "problem/sampling_engine.h"

/// Whose frames are taken; the integrator's parameters.
struct engine_replay {
    const struct sampling_engine *engine;
    struct engine_piece piece;
};

/// Temperature and pressure are those that the engine tells. Tested: cli/test_fit_engine.
extern const struct integrator mf_engine_replay;
