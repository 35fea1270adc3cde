// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What g(r) of N particles differs by from g(r) of another number at the same densities, and
/// D of a periodic box from that of an infinite one.
///
/// In a closed system every g_ab, normalised by the possible pairs as observe/rdf.h does,
/// integrates to the volume, whereas that of the infinite system integrates to V + G_ab, G_ab being
/// its integral of Kirkwood and Buff. Hence
///   g_ab(r; N) ≈ g_ab(r; ∞) / (1 + G_ab/V),
/// whose tail 1 − G_ab/V is that of J. L. Lebowitz and J. K. Percus, Phys. Rev. 122, 1675 (1961),
/// for alike and unlike pairs; their terms in dg/dρ, which vanish where g is 1, and the next order
/// in 1/N are left out. With s_ab = 1 + ρ G_ab and the densities and numbers of *all* particles,
/// G_ab/V = (s_ab − 1)/N. One type has s = S(0), ρ k_B T times the compressibility: 0 of a liquid
/// that yields no more, 1 of an ideal gas, whose g needs no correction. Isotopes have the s of
/// the whole for every pair type, since each g_ab is then the g of the whole.
///
/// G_ab is that of all pairs, and ∫ g_ab is V with all pairs, too. Pairs of a molecule that a g
/// leaves out, E_ab of P_ab possible ones, make it smaller by V E_ab/P_ab. Left out there as well,
/// the unlike pairs of trimers A-B-A would be 1.3 % too many in a system of 64 from one of 512.
///
/// Left out, an inversion with 729 particles of a target from 2744 sees 0.001 too many pairs
/// everywhere, and makes a pressure of it: measured for SPC water, 35 instead of 22 k_B T/λ³.
#pragma once

#include "observe/rdf.h"
#include "system/topology.h"

/// What g_ab of a system of `from` particles of all types is to be multiplied by to compare with
/// one of `to` particles: (1 + (s − 1)/from) / (1 + (s − 1)/to).
/// Tested against the exact g of N hard rods: test_finite_size.
double mf_finite_size_factor(double s, double from, double to);

/// What g(r) are of: densities and shares of both systems.
struct finite_size_fluid {
    const struct box *box;
    const struct composition *composition;
    const struct topology *topology; ///< of molecules, or NULL
    bool intermolecular;             ///< g is of different molecules alone
};

/// What the pairs that g leaves out add to the G of a pair type [λ³].
double mf_finite_size_intramolecular(const struct finite_size_fluid *fluid, int pair);

/// The s of a pair type in a liquid that yields no more, whose molecules take the room of their
/// beads and mix as if they did not know each other: 0 of single beads. Of one kind of molecule no
/// number fluctuates: G_ab = −V/N_a for a = b, and 0 else.
double mf_finite_size_rigid(const struct finite_size_fluid *fluid, int pair);

/// The same with the s that g itself shows: 1 + ρG by mf_kirkwood_buff_integrate, drawn towards
/// s_0, that of a liquid which yields no more, by the share that its error has in the difference:
/// s_0 + (s − s_0) (1 − error²/(s − s_0)²), or s_0. The error is that by statistics and the scatter
/// of s with the range of the integral, since the last oscillations may be cut off. An s beyond
/// N/20 is one of types that have parted, for which the box is no part of a larger one: it counts
/// as s_0, and so does that in two dimensions.
/// @param[in] g, error    shape [bins.count], of this pair type in a system of `from` particles
/// @param[in] pair        pair type
double mf_finite_size_factor_of(const struct rdf_bins *bins, const double *g, const double *error,
                                const struct finite_size_fluid *fluid, int pair, double from,
                                double to);

/// What D of a periodic cube of this edge lacks [λ²/τ]: ξ k_B T/(6π (η + ρ_m D) L), ξ = 2.837297,
/// the correction of I.-C. Yeh and G. Hummer, J. Phys. Chem. B 108, 15873 (2004), for liquids,
/// where η is far above ρ_m D. A particle of a fluid as thin as those of dissipative particle
/// dynamics leaves its own eddy by diffusion, too: the vortices of wave number k that carry it
/// decay with (ν + D) k², as in the long-time tail of M. H. Ernst, E. H. Hauge and J. M. J. van
/// Leeuwen, Phys. Rev. Lett. 25, 1254 (1970). Momentum is conserved, and that of the whole box is
/// 0.
/// @param[in] viscosity  η [k_B T_0 τ/λ³]
/// @param[in] density    of mass, ρ_m [μ/λ³]
/// @param[in] diffusion  D as measured [λ²/τ]
/// @param[in] edge       L [λ]
/// Tested: test_finite_size, physics/test_viscosity.
double mf_finite_size_diffusion(double temperature, double viscosity, double density,
                                double diffusion, double edge);
