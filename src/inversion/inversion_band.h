// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How well the data of an inversion determine its potential.
///
/// The excess of S, with its covariance W = L Lᵀ by target and samples, determines the potential by
///   F = Bᵀ B,   B = L⁻¹ C/k_B T,
/// as in mf_imc_solve, whatever step led there. What the data leave open is held by the smoothness
/// prior there with the weight 1/(k_B T)²: a bend by k_B T within a tenth of λ, or by as much as
/// the reference changes there, or ten k_B T in all, counts as one standard error, of Φ less a
/// reference Φ_0 that the targets alone give (mf_inversion_reference). So the most probable
/// potential is one, wherever a fit begins, and the step to it x = H⁻¹ [Bᵀ L⁻¹ excess − DᵀD (Φ −
/// Φ_0)], H = F + DᵀD. With a prior of each step what a start lacked was not made up for: of a WCA
/// liquid, begun with soft beads, g was 3.5 times its target in the first bin, and Φ 1.6 k_B T too
/// low with an error of 0.2. The error is that which the excess has if the errors of a target are
/// each bin's own, V (inversion_noise.h), Σ = H⁻¹ (TᵀV T + DᵀD) H⁻¹ with T = W⁻¹C/k_B T. U of
/// groups may bend more where its target does, and the result is made as smooth as that
/// (inversion_smooth.h).
///
/// Where more of the excess is left than V says, χ² by bin above 1, V is that much larger: a fit
/// stops within 1.7 times the noise, and what it leaves is an error of Φ too.
///
/// What the most probable step from there would still change of the ramp is an error too. `imc` and
/// `auto` take this step near the noise, and end when it is below half of the errors of A and of
/// the pressure, with groups in the mean of three or more. They take it then, too; it still counts,
/// as the response is not exactly linear. So does the rms of that and of what the iteration before
/// asked for, if it is more: of two starts one ended with a drift of 0.1 errors after one of 3.
///
/// C of groups is that of inversion_response. Off over stated, U of bonds and angles: 0.98(4) and
/// 1.04(3) over 32 twins (lab/molecules.md).
///
/// In V the samples' part is correlated as S is; the errors of a target are each bin's own, but for
/// what the bins of a pair type have in common (inversion_noise.h).
///
/// Φ follows the target bin by bin, beginning with −ln g, and what noise a bin has there stays in
/// it, however smooth the prior, and so does that of the samples: where these have few counts, as
/// in the first bins of a core, the error of Φ is at least theirs (mf_inversion_poisson_error).
///
/// Φ of pairs ends at its range, whatever the law does; mf_inversion_band_add_range.
///
/// C is itself sampled, in few functions (inversion_covariance.h). What is least known follows the
/// smallest eigenvalues, and those of a sampled covariance come out too small: the band of few
/// samples is wider than by the exact C, and needs no correction.
#pragma once

#include "inversion/imc_solve.h"
#include "problem/inverse.h"

struct inversion;
struct inversion_state;
struct inversion_assessment;

/// The change of a number that the target hardly determines and still requires, and the standard
/// error by g(r) alone: that of the present samples, without this drift.
struct inversion_band_drift {
    double drift, open;
};

struct inversion_band {
    double *inverse;      ///< H⁻¹, shape [known, known]
    double *covariance;   ///< of Φ in the known bins, the same shape
    double *error;        ///< standard errors, shape [points]; 0 where Φ is set
    double *without_ramp; ///< if A of the ramp A (1 − r/r_c) were known, shape [points]
    double *beside_ramp;  ///< their squares by the range, shape [known]
    double
        *flat; ///< inverse_step.curve_flat, shape [INVERSE_FLAT, points] of pairs, then of groups
    struct inverse_ramp ramp;
    struct inversion_band_drifts {
        struct inversion_band_drift ramp, bulk[INVERSE_MAX_STATES];
    } drifts; ///< of A, and of what the ramp moves in each state (inversion/inversion_bulk.h)
};

/// Standard deviation of ln λ of a Poisson distribution with the mean λ of which so many were
/// counted: that of its posterior, a gamma distribution of the shape counts + ½ by H. Jeffreys's
/// prior; 0 of infinitely many. Tested: test_inversion_band.
double mf_inversion_poisson_error(double counts);

/// What the counts of the targets and those of the samples allow the error of Φ of a known bin to
/// be at least: both of all states together, of which some have none there, and exact targets
/// infinitely many; of groups what the errors of their bins have in common. Tested:
/// test_inversion_band.
double mf_inversion_band_min_error(const struct inversion *inversion, size_t a);

/// H⁻¹ = (F + prior)⁻¹.
/// @param[in]  system      size, blocks, C, variances and what bins have in common, temperature,
///                         spacing
/// @param[in]  birge       by which the covariance V of the excess is larger than the system says
/// @param[out] covariance  shape [size, size]
/// @param[out] directions  that the data determine: trace of F (F + prior)⁻¹
/// Fails: NO_MEMORY. Tested: test_inversion_band.
enum status mf_inversion_band_covariance(const struct imc_system *system, double birge,
                                         double *covariance, double *directions) MUST_USE;

/// Of the pressures of all states that with the largest drift over its error. Tested:
/// test_inversion_start.
struct inversion_band_drift mf_inversion_band_farthest(const struct inversion *inversion);

/// χ² by bin, if above 1: by so much the covariances of g are larger, as what is left of the excess
/// shows. R. T. Birge, Phys. Rev. 40, 207 (1932).
double mf_inversion_band_birge(const struct inversion_assessment *assessment);

/// Strength of mf_imc_solve's prior with which its step is the most probable one.
double mf_inversion_band_prior(const struct inversion *inversion);

/// Σ ← P Σ Pᵀ with P = 1 − v ℓᵀ: that of curves from which ℓ·x times the change v is taken off,
/// ℓ·v = 1; and x ← P x.
void mf_inversion_band_take_off(double *covariance, size_t n, const double *v, const double *l);
void mf_inversion_band_take_off_curve(double *x, size_t n, const double *v, const double *l);

/// U of a group is known but for a constant, which no distribution sees and the prior alone holds:
/// the errors are those of U less its mean over the target. And f of local densities is known but
/// for its slope: they are those of the convention. Takes both off a covariance of Φ, or a change.
/// @param[in,out] covariance  or NULL
/// @param[in,out] x           shape [known]; or NULL
/// Fails: NO_MEMORY.
enum status mf_inversion_band_take_conventions_off(const struct inversion *inversion,
                                                   double *covariance, double *x) MUST_USE;

/// Σ ← Σ + factor u uᵀ.
void mf_inversion_band_add_square(struct inversion *inversion, double factor, const double *u);

/// asked += Dᵀ of what the prior still asks, normal += DᵀD in its lower triangle.
/// @param[in,out] normal  or NULL
/// Fails: NO_MEMORY.
enum status mf_inversion_band_add_prior(const struct inversion *inversion, struct imc_system system,
                                        gsl_matrix *normal, gsl_vector *asked) MUST_USE;

/// Add to Σ what the samples scatter by along A and the pressures, where it is more than their bins
/// say: one inefficiency for all bins is that of many quick ones, and what g hardly sees is slow.
/// Each replica asks for a step of its own, H⁻¹ Bᵀ L⁻¹ S; their scatter is measured. Of
/// Lennard-Jones with a hill between two wells it is five times what the bins say.
/// @param[in] weight  of A, shape [known]
/// Fails: NO_MEMORY. Tested: test_inversion_band_samples.
enum status mf_inversion_band_add_samples(struct inversion *inversion, double birge,
                                          const double *weight) MUST_USE;

/// Whether the samples make more of the error of A, or of a pressure, than all else does, by half.
bool mf_inversion_band_is_noisy(const struct inversion_state *state);

/// The error that the samples of a state make of that number, over that of all else, as the last
/// iteration knew it. Tested: test_inversion_band_samples.
struct inverse_doubling mf_inversion_band_noise(const struct inversion_state *state);

/// What the error of the range is found from.
struct inversion_band_without {
    const struct imc_system *system;
    double birge;
    const double *step;   ///< the most probable one, shape [known]
    const double *weight; ///< of A, the same shape
    const double *meet;   ///< k of the pressure that is met, the same shape; or NULL
};

/// Add the error of the range to Σ: of a potential of pairs that ends at its range the law may go
/// on. What the equations make of one that ends at four fifths of the range, of which they then
/// know no more, less the most probable one, is δ. Of a law that falls as exp(−κr) or r^-6 what
/// lies beyond the range moves the pressure by (2s)² times that of its last fifth, within a third,
/// at most as much; s is the share of the height of the last fifth that the slope at the end alone
/// makes. So a law that ends there by itself, without a slope, leaves nothing. What noise alone
/// makes of the change of a pair type's ramp does not count. Of star polymers whose tail is cut at
/// 2.6, Φ was 8 of its other errors off, and 1.6 with 4.
/// Fails: NO_MEMORY. Tested: test_inversion_band_range, test_band_range.
enum status mf_inversion_band_add_range(struct inversion *inversion,
                                        const struct inversion_band_without *without) MUST_USE;

enum status mf_inversion_band_init(struct inversion_band *band, size_t known,
                                   size_t points) MUST_USE;
void mf_inversion_band_clear(struct inversion_band *band);

/// Fill the band of the present potential. Ramp and flat directions are those of the bins that the
/// target knows well: A is the best ramp over them, and a flat direction is what the whole curve
/// does, on average, when a principal component of them is off by one standard error.
/// Fails: NO_MEMORY.
enum status mf_inversion_band_find(struct inversion *inversion) MUST_USE;

enum { INVERSION_BAND_SPANS = 5 };
size_t mf_inversion_band_spans(struct inversion_band *band, size_t points,
                               struct memory_span *span);
