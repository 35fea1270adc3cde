// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The stream function of a flow in a periodic plane.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// ψ at the points of a grid, shape [ny, nx], spacing `width` along x and y, that is nearest to a
/// flow in least squares: v_x = ∂ψ/∂y, v_y = −∂ψ/∂x. Of each Fourier mode
///   ψ_k = i (k_x v_y − k_y v_x)_k/k²,
/// which is −ω = ∇²ψ, with the vorticity ω; and U y − V x of the mean flow, so that ψ itself is not
/// periodic. What of the flow is not free of divergence is left out. Fails: NO_MEMORY.
/// Tested: test_stream_function.
enum status mf_stream_function(double *psi, const double *vx, const double *vy,
                               const size_t bins[2], const double width[2]) MUST_USE;
