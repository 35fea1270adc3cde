// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the pair kernels do not find: energies of particles; and slow twins of the
/// configurational temperature and of local densities.
#pragma once

#include "forces/many_body.h"

/// Energy that each particle has of its pairs: half of Φ of each of them.
/// @param[in] neighbours  half list, complete for the cutoff of the potential
/// @param[out] energy     by id, shape [count] [k_B T_0]
/// Tested: test_pair_energies.
void mf_reference_energies(const struct table *potential, const struct composition *composition,
                           const struct particles *particles, const struct neighbours *neighbours,
                           float *energy);

/// Configurational temperature Σ_i |F_i|² / Σ_i ∇_i² U [k_B T_0] from the potential alone.
///   Σ_i ∇_i² U = 2 Σ_pairs [Φ''(r) + (d − 1) Φ'(r)/r]
/// and, where the force of a pair type ends abruptly at its cutoff, the jump of the slope
/// there, which needs to know the temperature roughly. H. H. Rugh, Phys. Rev. Lett. 78, 772 (1997);
/// O. G. Jepps, G. Ayton and D. J. Evans, Phys. Rev. E 62, 4757 (2000), eq. 37. It sees positions
/// only, so it shows errors of the time step that the kinetic temperature hides.
/// Where potentials act beside the pairs whose ∇²U is known (and added by the caller), F is of
/// both; where others do, with forces F', Σ F·(F + F') stands for Σ|F|²: the general expression of
/// Jepps et al. with the ∇U that is known for its vector field.
/// @param[in] neighbours  half list, complete for the cutoff of the potential
/// @param[in] known, others  forces beside the pairs, of both kinds, shape [dimensions][count], or
///                           both NULL: there are none
/// @param[out] squares    Σ F·(F + F') [(k_B T_0/λ)²]
/// @param[out] laplacian  Σ ∇_i² U [k_B T_0/λ²]; the temperature is ⟨squares⟩ / ⟨laplacian⟩
/// Fails: NO_MEMORY.
enum status mf_reference_configurational(const struct table *potential,
                                         const struct composition *composition, double temperature,
                                         const struct particles *particles,
                                         const struct neighbours *neighbours, double *const *known,
                                         double *const *others, double *squares,
                                         double *laplacian) MUST_USE;

/// @name Of a force that ends abruptly

/// Where the shell inside the cutoff begins in which pairs are counted [λ].
double mf_reference_shell_begin(const struct table *potential, int pair);

/// What a pair in the shell says of the density of pairs at the cutoff, where Φ = 0: those nearer
/// have less room, and are rarer or more frequent by exp(−Φ/k_B T).
double mf_reference_density_at_cutoff(const struct table *potential, int pair, double r,
                                      double temperature, int dimensions);

/// Σ∇²U of the cutoff: the slope jumps to 0 there, which is a Dirac peak of Φ'' seen by the pairs
/// that are just there, of which `density` are so many in a length [1/λ].
double mf_reference_edge_laplacian(const struct table *potential, int pair, double density);

/// Energies, forces and virials of local densities by two loops over all pairs, in double
/// precision: what the vector kernels must find.
/// @param[out] force  shape [dimensions][count], to be added to [k_B T_0/λ]
/// @param[out] sums   to be added to
/// Fails: NO_MEMORY.
enum status mf_reference_many_body(const struct many_body *many_body,
                                   const struct particles *particles, double *const *force,
                                   struct pair_sums *sums) MUST_USE;
