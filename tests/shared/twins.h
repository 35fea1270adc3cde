// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Twins: what a simulation of a known scene measures, for fits to find the scene again.
#pragma once

/// Simulate the scene of `file`, in the working folder, and leave the results in `out`. Each scene
/// is simulated once in a test program; tests that come later get a copy.
void twins_simulate(const char *file, const char *out);
