// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Fluids with energies of local densities.
#pragma once

#include "forces/many_body.h"
#include "shared/fluids.h"

/// A fluid with them; `fluid.setup` points to both, so that it must stay where it is.
struct many_bodies {
    struct fluid fluid;
    struct many_body law;
};

/// One more term of a law, from a weight and an energy, whose parameters stay the caller's.
void many_bodies_add(struct many_body *law, const char *name, uint32_t central, uint32_t neighbours,
                     const struct curve *weight, const struct curve *energy);

/// Many-body dissipative particle dynamics: Φ = −20 (1 − r)², B = 25, r_d = 0.75, density 6, in two
/// or three dimensions. P. B. Warren, Phys. Rev. E 68, 066702 (2003).
void many_bodies_dpd(struct many_bodies *many, int dimensions, int64_t count);

/// Three types at density 3 with terms of all kinds: A among B by Sanyal and Shell's weight with a
/// flat middle and a formula, all among all by Lucy's and a polynomial, B and C among A by a
/// formula and a polynomial.
void many_bodies_mixture(struct many_bodies *many, int dimensions, int64_t count);

/// One term alone, of all beads: Sanyal and Shell's weight between these distances, and f = c (ρ −
/// origin)². To be cleared with mf_many_body_clear.
void many_bodies_crowd(struct many_body *law, double inner_cutoff, double cutoff, double c,
                       double origin, const struct composition *composition);

void many_bodies_clear(struct many_bodies *many);
