// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The normal equations of force matching: F. Ercolessi and J. B. Adams, Europhys. Lett. 26,
/// 583 (1994); S. Izvekov and G. A. Voth, J. Phys. Chem. B 109, 2469 (2005).
///
/// The force on a bead is written as Σ_k c_k X_k, with −dΦ/dr of a pair, −dU/dq of a bond, an
/// angle or a dihedral, or −df/dρ of the energy of a local density (forces/many_body.h), whose
/// force between two beads is −[f'(ρ_i) + f'(ρ_j)] w'(r), a straight line between nodes, at which
/// it is c_k. Over all beads and
/// frames the squares of what is left of the forces are least where G c = b, with
/// G_kl = Σ X_k·X_l and b_k = Σ X_k·F. Their pressure is ρ k_B T + ⟨w⟩·c, w_k being the virial of
/// X_k by d V. Neighbouring frames are joined to blocks, twice as many in each whenever all blocks
/// are taken, so that memory does not grow with the trajectory; the scatter of the blocks tells the
/// noise.
#pragma once

#include "base/status.h"
#include "curves/bonded_kind.h"
#include "system/composition.h"

#include <stdbool.h>
#include <stddef.h>

/// Of pairs and of a local density, beside the orders of bonded terms.
enum { FORCES_OF_PAIRS = -1, FORCES_OF_DENSITY = BONDED_KINDS };

enum {
    FORCES_MAX_CURVES = 128,
    FORCES_MAX_NODES = 600, ///< of all curves
    FORCES_BLOCKS = 16,
    FORCES_NAME_SIZE = 64,
};

/// The force of a pair type or group: nodes at equal distances.
struct force_curve {
    int order;                   ///< FORCES_OF_PAIRS, FORCES_OF_DENSITY or one of BONDED_LIST
    int number;                  ///< pair type, or group of the order
    char name[FORCES_NAME_SIZE]; ///< of that; "-": pairs of beads that are all alike; of a density
                                 ///< r_0 and r_c of its weight in nm, "0.3,0.7"
    double inner_cutoff, cutoff; ///< of a density [λ]
    double low, width;           ///< the first node, and between two [λ], [rad], of a density 1
    size_t first, nodes;         ///< among all unknowns; a circle's last node is before its first
    bool left_out;               ///< its forces are none: of a density in a scene without
    bool held;                   ///< it is not looked for, and makes up for no pressure
};

/// Whether its last node is before its first.
static inline bool force_curve_is_circle(const struct force_curve *curve) {
    return curve->order >= 0 && curve->order < BONDED_KINDS &&
           mf_bonded_kinds[curve->order]->periodic;
}

struct force_equations {
    size_t curves, size; ///< size: of all nodes
    struct force_curve *curve;
    size_t frames, each; ///< frames so far; of a block
    double beads;        ///< in a frame
    double square;       ///< Σ F² of all frames
    double *gram;        ///< shape [FORCES_BLOCKS, size (size + 1)/2]: k (k + 1)/2 + l, l ≤ k
    double *product;     ///< b, shape [FORCES_BLOCKS, size]
    double *virial; ///< w [1/λ²; of angles and densities 1/λ³], shape [FORCES_BLOCKS, size]
};

/// Entries of G.
static inline size_t force_equations_entries(const struct force_equations *equations) {
    return equations->size * (equations->size + 1) / 2;
}

/// Blocks with frames; the last may have fewer.
static inline size_t force_equations_blocks(const struct force_equations *equations) {
    return equations->each ? (equations->frames + equations->each - 1) / equations->each : 0;
}

/// Put the nodes of the curves one after the other, and make room. Fails: NO_MEMORY.
enum status mf_force_equations_init(struct force_equations *equations,
                                    const struct force_curve *curve, size_t curves) MUST_USE;
void mf_force_equations_clear(struct force_equations *equations);

/// Where a q is among the nodes: it has the share 1 − *share of *node, and *share of *next; a
/// bonded term beyond all nodes is on the line of the last two. False of a pair that is beyond
/// them.
bool mf_force_equations_find(const struct force_curve *curve, double q, size_t *node, size_t *next,
                             double *share);

/// Add a frame. @param[in] gram, product, virial, square  of it
void mf_force_equations_add(struct force_equations *equations, const double *gram,
                            const double *product, const double *virial, double square);

/// Write b and w with the nodes as `file`, and G as `gram_file`, in nm and kJ/mol: rows are
/// unknowns or entries, columns blocks. Fails: IO, NO_MEMORY.
enum status mf_force_equations_write(const struct force_equations *equations, const char *file,
                                     const char *gram_file) MUST_USE;

/// Read them. Numbers of curves are not set, as only their names are there. Fails: BAD_INPUT, IO,
/// NO_MEMORY. Tested: test_force_equations.
enum status mf_force_equations_read(struct force_equations *equations, const char *file,
                                    const char *gram_file) MUST_USE;

/// From nm and kJ/mol to lengths and energies that are so many of these.
void mf_force_equations_scale(struct force_equations *equations, double length, double energy);
