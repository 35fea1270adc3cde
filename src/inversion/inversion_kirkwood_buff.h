// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integrals of an inversion's samples, and how they follow the
/// potential.
#pragma once

#include "base/status.h"
#include "system/composition.h"

#include <stddef.h>

struct inversion_state;

/// By pairs of components, as the target has them.
struct inversion_kirkwood_buff {
    size_t pairs;     ///< 0: not asked for
    double q_maximum; ///< of the waves, as the target has it [1/λ]
    double value[COMPOSITION_MAX_PAIRS], error[COMPOSITION_MAX_PAIRS]; ///< [λ^d]
    double *slope; ///< ∂G/∂Φ_b, shape [pairs, known]
};

/// Make room if the problem asks for the integrals. Fails: NO_MEMORY.
enum status mf_inversion_kirkwood_buff_init(struct inversion_state *state) MUST_USE;
void mf_inversion_kirkwood_buff_clear(struct inversion_kirkwood_buff *kb);

/// Values and errors of the present samples, and the distance: that of the integral that is
/// farthest off by its noise.
void mf_inversion_kirkwood_buff_measure(struct inversion_state *state);

/// Slopes ∂G/∂Φ_b = −cov(G, S_b)/k_B T, G that of a configuration
/// (observe/kirkwood_buff.h), of which the present samples make this share, and those before
/// the rest: as of C. They are noisier than C: a few long waves have little to do with the energy
/// of all pairs.
void mf_inversion_kirkwood_buff_respond(struct inversion_state *state, double share);

/// The error of an integral, and how small the samples are to make it near to the target's g: as
/// that of its target, or half of what it is off. Of the one that is farthest from that; 0 of 1
/// without integrals, and far from g.
struct inverse_doubling mf_inversion_kirkwood_buff_noise(const struct inversion_state *state);
