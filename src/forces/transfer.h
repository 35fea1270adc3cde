// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Momentum that the particles have carried and given each other, for the shear viscosity.
///
///   G_ab = ∫ (Σ_i m v_ia v_ib + Σ_pairs r_a F_b) dt,   r from j to i, F on i,
///
/// is the stress times the volume, integrated over time: of the momentum along b what has gone
/// along a: E. Helfand, Phys. Rev. 119, 1 (1960), with separations of pairs in the place of
/// positions, as S. Viscardy, J. Servantie and P. Gaspard, J. Chem. Phys. 126, 184512 (2007). F is
/// all that acts within a pair, with its friction and noise. Impulses that a sweep gives to
/// velocities are added as they are, so that noise needs no stress of its own, which would be
/// infinite: the formulas for that are in M. H. Ernst and R. Brito, Europhys. Lett. 73, 183 (2006),
/// and G. Jung and F. Schmid, J. Chem. Phys. 144, 204104 (2016). What acts across a pair makes G
/// unsymmetric. Who wants G hands a simulation one of these (`transfer` of an observable); without
/// one nothing is summed.
#pragma once

#include "system/neighbours.h"
#include "system/particles.h"

#include <math.h>

struct transfer {
    double sum[3][3];                        ///< G [k_B T_0 τ]
    double part[NEIGHBOURS_MAX_PARTS][3][3]; ///< of the parts of a list, in one pass or sweep
};

/// Add an impulse [μ λ/τ] on the first of a pair, r = distance · e.
static inline void transfer_add(double sum[3][3], double distance, const float e[4],
                                const double impulse[3]) {
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            sum[a][b] += distance * e[a] * impulse[b];
}

/// Add what the parts have found, times `scale`, in their order, and clear it. NULL: nothing.
void mf_transfer_collect(struct transfer *transfer, int parts, double scale);

/// Add what particles carry in a time: Σ m v v relative to the centre of mass. NULL: nothing.
void mf_transfer_carry(struct transfer *transfer, const struct particles *particles, double time);
