// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Hard spheres of diameter 1 by Percus and Yevick's equation, which is solved exactly:
/// M. S. Wertheim, Phys. Rev. Lett. 10, 321 (1963); J.-P. Hansen and I. R. McDonald, Theory of
/// Simple Liquids (4th ed., 2013), section 4.4. `eta` is the packing fraction πρ/6.
#pragma once

double hard_spheres_density(double eta);

/// Direct correlations: a polynomial within the diameter, 0 beyond.
double hard_spheres_c(double eta, double r);

/// h(r) = g(r) − 1, from the transform of c.
double hard_spheres_h(double eta, double r);

/// S(0) = (1 − η)⁴/(1 + 2η)².
double hard_spheres_compressibility(double eta);
