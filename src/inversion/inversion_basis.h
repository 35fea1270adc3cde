// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Potentials that are made of few coefficients, Φ_a = Σ_k B_ak c_k in the known bins, and
/// what the samples of an inversion say of these.
///
/// Curves of pairs are cubic B-splines from the first known bin to the cutoff, where they are 0;
/// those of groups are as in problem/parametrisation.h, without what is added to.
///
/// The relative entropy of the target to the model, S_rel = ⟨ln(p_target/p_model)⟩_target, has the
/// derivatives
///   g_k = ∂S_rel/∂c_k = (⟨∂U/∂c_k⟩_target − ⟨∂U/∂c_k⟩)/k_B T = −Bᵀ(⟨S⟩ − S*)/k_B T,
///   H = BᵀC B/(k_B T)²,
/// and is convex in c: M. S. Shell, J. Chem. Phys. 129, 144108 (2008); A. Chaimovich and M. S.
/// Shell, J. Chem. Phys. 134, 094112 (2011), eqs. 12 and 15. Its Newton step H⁻¹g with a
/// coefficient for each bin is that of inverse Monte Carlo.
#pragma once

#include "problem/potential_grid.h"

struct inversion_state;

struct inversion_basis_size {
    int64_t coefficients, group_coefficients;
};

struct inversion_basis {
    size_t count;     ///< of coefficients, of all curves; 0: bins have values of their own
    double *value;    ///< B, shape [known, count]
    double *gradient; ///< Bᵀ(⟨S⟩ − S*), shape [count]
    double *hessian;  ///< BᵀC B, shape [count, count]
    double *noise;    ///< covariance of the gradient by the noise of target and samples
    double *inverse; ///< (BᵀC B + 1/n)⁻¹ for n independent samples: what these hardly see may move
                     ///< by k_B T in a step
    double *damped; ///< the same for steps: of few samples, C has eigenvalues far too small, which
                    ///< would make steps too long
    double *change; ///< the Newton step of the coefficients [k_B T_0], shape [count]
    double independent; ///< samples, by the scatter of the gradient: it follows all bins a little,
                        ///< and so what changes more slowly than each of them does
    double pooled;      ///< the same of the excess, of all iterations near the target
    double samples;     ///< the same of C
    double miss;        ///< gradient in units of its noise, rms over coefficients
    double decrement;   ///< g·H⁻¹g: twice the fall of S_rel that the step promises
    double chance;      ///< what noise alone makes of that
};

/// Make the basis: so many coefficients for each pair type and group, as far as there are bins.
/// Fails: NO_MEMORY.
enum status mf_inversion_basis_init(struct inversion_basis *basis,
                                    const struct potential_grid *grid,
                                    const struct inversion_basis_size *parameters) MUST_USE;
void mf_inversion_basis_clear(struct inversion_basis *basis);

/// Weights of the known bins, shape [known]: what the target has there, which is by how much each
/// one enters S_rel, and at least a hundredth of their mean, so that no coefficient is unseen where
/// a target is empty.
void mf_inversion_basis_weights(const struct inversion_state *state, double *weight);

/// Replace the known values of `phi`, shape [points], by the nearest that coefficients make, by
/// least squares with these weights of the known bins. Nothing is completed. Fails: NO_MEMORY.
enum status mf_inversion_basis_project(const struct inversion_basis *basis,
                                       const struct potential_grid *grid, const double *weight,
                                       double *phi) MUST_USE;

/// Hessian and independent samples, and the noise of the gradient by the target alone.
void mf_inversion_basis_respond(struct inversion_basis *basis, const struct inversion_state *state);

/// Gradient, Hessian and Newton step by the excess and C, near the target those of all iterations
/// since it was reached: by the present gradient, so that a fit does not end with the small step of
/// one that is still on its way.
/// @param[out] step  of the potential in the known bins, shape [points]
/// Tested: test_inversion_basis.
void mf_inversion_basis_measure(struct inversion_state *state, double *step);

/// Covariance of the potential in the known bins, shape [known, known]: (k_B T)² B A (N + 1/n²) A
/// Bᵀ with the inverse A above and the noise N of the gradient; and the directions that the samples
/// determine, the trace of A BᵀC B. Fails: NO_MEMORY.
enum status mf_inversion_basis_covariance(const struct inversion_state *state, double *covariance,
                                          double *directions) MUST_USE;
