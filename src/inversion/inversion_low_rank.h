// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The low-rank step of an inversion with groups far from its targets.
///
/// Several pair types and groups have as many bins as an iteration has independent samples, n. Then
/// C has no inverse; and as its elements have the variances (C_aa C_bb + C_ab²)/n of normal S, C x
/// has C_aa x·C x/n: what a step does is predicted with an error that is larger than what it does.
/// Of a few coefficients B, BᵀC B is known better. Boltzmann inversion takes S* for C, which is
/// right for what is narrow, and slow or too much for what is wide, as the ramp. So the part of its
/// step that the coefficients can make is made again with their BᵀC B, as by the coarse grid of a
/// two-grid method (W. Hackbusch, Multi-Grid Methods and Applications (1985), section 2).
#pragma once

#include "base/status.h"

#include <stdbool.h>

struct inversion;
struct inversion_state;

/// Make the coefficients. Fails: NO_MEMORY.
enum status mf_inversion_low_rank_init(struct inversion_state *state) MUST_USE;

/// Whether the next step is such a one: of a fit with groups whose targets are not near.
bool mf_inversion_is_low_rank(const struct inversion *inversion);

/// The part of a step u that coefficients can make, B T⁻¹Bᵀ S* u with T = Bᵀ S* B, is replaced by
/// B H⁻¹Bᵀ S* u. In the norm of T, where Boltzmann inversion has H = 1, the eigenvalues h of BᵀC B
/// of m coefficients and n independent samples scatter by sqrt(m/n) (V. A. Marchenko and L. A.
/// Pastur, Math. USSR Sb. 1, 457 (1967)), so those of H are λ + (1 − λ) h with λ = s/(1 + s), s =
/// sqrt(m/n), so that a step along what responds no more than an ideal gas is hardly more than
/// twice as long as the right one. Along an h above 1, as that of concentrations of a mixture, the
/// step is the one of which the true response leaves least: J. Baik and J. W. Silverstein, J.
/// Multivar. Anal. 97, 1382 (2006); D. L. Donoho, M. Gavish and I. M. Johnstone, Ann. Stat. 46,
/// 1742 (2018). So it is along all others, which have a part of such an eigenvector, as few samples
/// know it: that part is answered ℓ times. Of chains in a solvent, ℓ = 27 and 30 samples, it would
/// be more than what the step was to take off along ℓ itself; they go half of their way.
/// @param[in,out] step  u in the known bins, shape [points]. Fails: NO_MEMORY. Tested:
/// test_inversion_low_rank.
enum status mf_inversion_low_rank_respond(struct inversion_state *state, double *step) MUST_USE;

/// The step in the known bins; it does not look at the pressure.
/// @param[out] step  shape [points]. Fails: NO_MEMORY.
enum status mf_inversion_low_rank_step(struct inversion_state *state, double *step) MUST_USE;
