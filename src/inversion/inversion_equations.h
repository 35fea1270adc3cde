// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The linear equations that a step is made of.
///
/// Those of one state are its own as they stand, whose pressure is met as a constraint
/// (mf_imc_solve). Of several states, or of one with integrals of Kirkwood and Buff, the rows B_s x
/// = b_s of the states, each over the covariance of its excess, and below each state's those of its
/// pressure and its integrals, if they are asked for, stand one below the other. A QR decomposition
/// leaves as many rows as unknowns, with the same least squares, so that the strength of the
/// regularisation, the band and its ramp are found as of one state. A bin that a state has not seen
/// has no row of that state. Birge's factor, by which the band widens the variances, is of g: the
/// rows of the others are that much narrower before.
#pragma once

#include "inversion/imc_solve.h"
#include "inversion/inversion_noise.h"
#include "problem/inverse.h"

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

struct inversion_state;

/// What a reduced system is made of; its variances are 1.
struct inversion_rows {
    double *covariance, *excess, *variance;
};

struct inversion_equations {
    const struct inversion_state *state; ///< shape [states]; borrowed
    size_t states;
    bool reduced; ///< to as many as one state has; pressures and integrals are among them
    struct imc_system system;      ///< with the noise of the excess
    struct imc_system of_response; ///< of fits with groups: with that of the response, too
    struct inversion_rows rows, rows_of_response;
    enum inversion_noise_kind kind[INVERSE_MAX_STATES]; ///< of the excess of each state
    double *scatter; ///< what Bᵀ L⁻¹ excess of `system` scatters by, if the errors of
                     ///< targets are each bin's own, shape [known, known]
    double *noise;   ///< of mf_inversion_noise_find, shape [known, known]
    double *noise_of_response; ///< the same with mf_imc_response_variance; NULL without groups
    double *response_variance; ///< shape [known]; NULL without groups
};

/// Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_inversion_equations_init(struct inversion_equations *equations,
                                        const struct inversion_state *state,
                                        size_t states) MUST_USE;
void mf_inversion_equations_clear(struct inversion_equations *equations);

/// Fill them from the present samples of all states.
/// @param[in] birge  mf_inversion_band_birge
/// Fails: NO_MEMORY. Tested: test_inversion_equations, test_fit_states, test_fit_kirkwood_buff.
enum status mf_inversion_equations_fill(struct inversion_equations *equations,
                                        double birge) MUST_USE;

/// The normal equations of all rows without those of some bins, which their own and those after
/// them in one state's noise then know nothing of: Bᵀ B/birge, of which the lower triangle is
/// filled, and Bᵀ L⁻¹ excess/birge.
/// @param[in] without  shape [known]
/// Fails: NO_MEMORY. Tested: test_inversion_equations.
enum status mf_inversion_equations_without(const struct inversion_equations *equations,
                                           double birge, const bool *without, gsl_matrix *normal,
                                           gsl_vector *asked) MUST_USE;

/// q = W⁻¹ C x/k_B T of a state, 0 in bins that it has not seen: x·Bᵀ L⁻¹ excess is Σ q·excess over
/// the states.
/// @param[out] q  shape [known]
/// Tested: test_inversion_band_samples.
void mf_inversion_equations_weigh(struct inversion_equations *equations, size_t s, const double *x,
                                  double *q);

/// The equations of one state as they stand, without the pressure.
struct imc_system mf_inversion_equations_of(const struct inversion_state *state);
