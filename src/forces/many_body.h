// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Energies of local densities: what no potential of pairs can say.
///
///   U = Σ_terms Σ_i f(ρ_i),  ρ_i = Σ_{j≠i} w(r_ij),
///   force on i from j: −[f'(ρ_i) w'(r) + f'(ρ_j) w'(r)] r̂,
///
/// where a term has an energy for beads of its central types alone, and neighbours of its
/// neighbouring types alone count. I. Pagonabarraga and D. Frenkel, J. Chem. Phys. 115, 5015
/// (2001); T. Sanyal and M. S. Shell, J. Chem. Phys. 145, 034109 (2016). Each force is one of a
/// pair, so that momentum is conserved and the virial is Σ r·F of the pairs. Excluded pairs of
/// molecules are on no list, and do not count.
#pragma once

#include "curves/density_energy.h"
#include "curves/weight.h"
#include "forces/interaction.h"

enum { MANY_BODY_MAX_TERMS = 16, MANY_BODY_NAME_SIZE = 32 };

/// One density and its energy. Owns its tables.
struct many_body_term {
    char name[MANY_BODY_NAME_SIZE];
    uint32_t central, neighbours; ///< sets of types, a bit each
    struct weight_table weight;
    struct density_energy energy;
};

/// Parameters of the interaction.
struct many_body {
    int terms;
    struct many_body_term term[MANY_BODY_MAX_TERMS];
    struct composition composition;
};

void mf_many_body_clear(struct many_body *many_body);

/// Those among the interactions of a scene, or NULL.
const struct many_body *mf_many_body_find(const struct interaction_choice *interactions, int count);

/// Whether a term was beyond the ends of its table since the begin.
/// @param[in]  state    of the interaction
/// @param[out] extreme  the smallest and the largest density that occurred [1/λ^d, or 1]
bool mf_many_body_was_beyond(const struct many_body *many_body, const void *state, int term,
                             double extreme[2]);

/// ρ of all beads in a term, by place, shape [count], as of the last pass. Of beads that are not
/// central it is the density that they would have.
/// @param[in] state  of the interaction
const double *mf_many_body_density(const void *state, int term);

extern const struct interaction mf_many_body;
