// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The shear viscosity η [k_B T_0 τ/λ³] of a fluid in three dimensions, by one of two ways.
///
/// At rest, by Green and Kubo, from the momentum G (forces/transfer.h) that is exchanged in
/// intervals of some steps: η = I/(V k_B T Δ), I as in observe/green_kubo.h, Δ the length of an
/// interval. If forces of pairs are along them, the stress is symmetric, and its five independent
/// components without trace count alike: xy, xz, yz, (xx − yy)/2, (2 zz − xx − yy)/√12 (P. J.
/// Daivis and D. J. Evans, J. Chem. Phys. 100, 541 (1994)). Friction across pairs makes it
/// unsymmetric: the six components beside the diagonal then give what a shear flow feels, in which
/// the friction of rotation has its share.
///
/// With the interaction shear-wave, from the flow: v_x = V cos(kz), η = ρ_m A/(k² V), with the mean
/// V = (2/N) Σ v_x cos(kz) over samples. It needs no stress, and so checks the first way.
#pragma once

#include "observe/observable.h"

struct shear_viscosity_summary {
    double value, error;
    bool driven;    ///< by a wave
    double blocks;  ///< that the error is from
    double density; ///< of mass [μ/λ³]
    // At rest.
    double window; ///< that was taken [τ]
    bool reached;  ///< the integral has come to rest within it
    // Driven.
    double wave_number;              ///< [1/λ]
    double velocity, velocity_error; ///< V [λ/τ]
    double temperature;              ///< kinetic, without that of the flow [k_B T_0]
    double settling;                 ///< ρ_m/(η k²), in which the flow comes about [τ]
};

extern const struct observable mf_shear_viscosity;

/// From a state of mf_shear_viscosity. Tested: physics/test_viscosity.
struct shear_viscosity_summary mf_shear_viscosity_result(const void *state);

/// D of an infinite box, from that of a periodic cube by mf_finite_size_diffusion, if the viscosity
/// is measured beside it, of a fluid at rest; else false.
/// @param[in,out] diffusion, error  [λ²/τ]; the error grows by that of the viscosity
bool mf_shear_viscosity_correct(const struct observable_results *results, double *diffusion,
                                double *error);
