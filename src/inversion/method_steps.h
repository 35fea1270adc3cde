// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The steps of the methods, for the known bins; each meets the pressure if it is asked for.
#pragma once

#include "base/status.h"

#include <stdbool.h>

struct inversion;
struct inversion_state;

/// k_B T ln(g/g*) of the known bins.
void mf_ibi_logarithms(const struct inversion_state *state, double *step);

/// The logarithms; where the target is not well known, of the counts nearest to it that are within
/// two standard errors of those of the samples. Tested: test_ibi.
void mf_ibi_step(const struct inversion_state *state, double *step);

/// The same with the slope of the hypernetted chain. Fails: NO_MEMORY.
enum status mf_hnc_step(const struct inversion_state *state, double *step) MUST_USE;

/// The regularised Newton step of the equations, or, with groups whose C is not known well enough,
/// that of mf_inversion_low_rank_step. `extra` are strength, misfit and directions, of the latter
/// 0. Sets `most_probable`. Fails: NO_MEMORY.
enum status mf_imc_step(struct inversion *inversion, double *step, double extra[3]) MUST_USE;

/// Whether C is known well enough for a Newton step in so many directions, or the targets are near.
/// Tested: test_inversion_keeps.
bool mf_imc_is_known(const struct inversion *inversion, double directions);

/// The variances of what C predicts. C is itself sampled: of n independent samples C_ab has the
/// variance (C_aa C_bb + C_ab²)/n (normal S), and so Σ_b C_ab x_b/k_B T has
///   (C_aa Σ_b C_bb x_b² + (Σ_b C_ab x_b)²)/(n (k_B T)²),
/// where C_aa is the part that is sampled (inversion_response.shared), the last sum is about the
/// excess, and x about the step of Boltzmann inversion. Several
/// pair types and groups have about as many bins as an iteration has independent samples: a step
/// that removed the excess as far as its own noise would follow the noise of C, by thousands of k_B
/// T.
/// @param[out] variance  shape [known]
/// Fails: NO_MEMORY.
enum status mf_imc_response_variance(const struct inversion_state *state,
                                     double *variance) MUST_USE;
