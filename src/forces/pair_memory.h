// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Friction that remembers: hidden variables of pairs, and white friction across them.
///
/// Each pair within the range of a mode has a hidden variable z; with e the unit vector from j to i
/// and u = e·(v_i − v_j), unit masses,
///   dv_i = Σ_j e g(r) z dt,   dz = −g(r) u dt − z dt/τ + sqrt(2 k_B T/τ) dW,   g = ω(r)/sqrt(τ),
/// so that a pair at rest feels a friction force with the kernel ω² exp(−t/τ)/τ, which is the white
/// friction ω² for τ → 0, and its noise. A mode with a frequency Ω has two variables,
///   dz = … + Ω y dt,   dy = −Ω z dt − y dt/τ + sqrt(2 k_B T/τ) dW',
/// and the kernel ω² exp(−t/τ) cos(Ω t)/τ. exp(−(H + Σ z²/2 + Σ y²/2)/k_B T) is stationary, so
/// that Φ and g(r) do not know of it; linear and angular momentum are conserved. The auxiliary
/// variables are those of Z. Li et al., J. Chem. Phys. 143, 243128 (2015), one a pair as in W. J.
/// Briels, Soft Matter 5, 4401 (2009).
///
/// Transverse friction ω_t(r) damps the velocities of a pair across e: C. Junghans, M. Praprotnik
/// and K. Kremer, Soft Matter 4, 156 (2008). It keeps no angular momentum.
///
/// A step does for each pair, one after the other and at fixed positions: the exact law of z and y
/// without u, the rotation of (u/√2, z) by √2 g Δt, and the exact decay of what is across e. Each
/// keeps the stationary law whatever Δt. A pair that comes into the range draws its z from it.
#pragma once

#include "base/memory.h"
#include "base/normal.h"
#include "curves/table.h"
#include "forces/transfer.h"
#include "system/composition.h"
#include "system/neighbours.h"

enum { PAIR_MEMORY_MAX_MODES = 4, PAIR_MEMORY_MAX_VARIABLES = 2 * PAIR_MEMORY_MAX_MODES };

struct pair_memory_mode {
    const struct table *omega; ///< ω(r), one or for each pair type; borrowed
    double time;               ///< τ [τ]
    double frequency;          ///< Ω [1/τ]; 0: none
};

/// All zero: nothing remembers.
struct pair_memory_law {
    int modes;
    struct pair_memory_mode mode[PAIR_MEMORY_MAX_MODES];
    const struct table *transverse; ///< ω_t(r), the same, or NULL; borrowed
};

static inline bool pair_memory_acts(const struct pair_memory_law *law) {
    return law->modes > 0 || law->transverse;
}

/// The largest distance at which it acts [λ].
double mf_pair_memory_range(const struct pair_memory_law *law);

/// Whether a step is too long to follow it: longer than half of a mode's τ, or of 1/Ω, or such that
/// the pairs that rub most turn by more than 1 rad. A pair's friction is then not that of its
/// kernel, however short the memory. An ω that is not known yet is left out.
/// Tested: cli/test_simulate.
bool mf_pair_memory_is_coarse(const struct pair_memory_law *law, double time_step);

/// What belongs to a simulation.
struct pair_memory_scene {
    struct composition composition;
    double temperature; ///< [k_B T_0]
    double time_step;   ///< [τ]
    uint64_t seed;
};

/// Pairs of a neighbour list, and their variables.
struct pair_memory_pairs {
    size_t count, capacity;
    /// Shape [capacity + PARTICLES_PADDING]: particles. Those of one first particle are together.
    int32_t *first, *second;
    uint32_t *first_id, *second_id; ///< the same shape: their ids
    uint32_t *source, *missing;     ///< shape [capacity + 1]: for pair_memory.c
    /// Shape [variables][capacity], in `unit` of pair_memory; NaN: the pair is out of range.
    /// There is room for one more, which `before` has for pairs that are new: it is NaN.
    float *value[PAIR_MEMORY_MAX_VARIABLES];
};

/// By particles: shape [particles].
struct pair_memory_index {
    struct particle_place *built; ///< where they were when the list was built
    uint32_t *begin, *end;        ///< pairs of `before` whose first particle has this id
    uint64_t *seen;               ///< bit n: of those, one has a second id of n more than 64 k
    uint32_t *mark;               ///< by id: where the first particle of now had a pair with it
};

struct pair_memory {
    struct pair_memory_law law;
    struct pair_memory_scene scene;
    double range[TABLE_MAX_CURVES]; ///< of each pair type; 0: nothing acts
    int variables;                  ///< of a pair
    double unit; ///< of these, sqrt(k_B T), or 1 if T is 0: they follow T [sqrt(k_B T_0)]
    struct {
        float (*half)[4];  ///< tan of half the angle of the rotation: rows of the table of ω
        int first;         ///< of its variables
        double keep, turn; ///< z ← keep z + turn y + noise ξ, y ← keep y − turn z + noise ξ'
        double noise;      ///< of z and y in `unit`
    } mode[PAIR_MEMORY_MAX_MODES];
    float (*root)[4]; ///< sqrt of the transverse damping: rows of its table
    struct normal_table normal;
    uint64_t builds;                        ///< of the neighbour list whose pairs these are
    struct pair_memory_pairs pairs, before; ///< of this list, and those of the last
    struct pair_memory_index index;
    size_t begin[NEIGHBOURS_MAX_PARTS], end[NEIGHBOURS_MAX_PARTS]; ///< of each part of the list
    int parts;
};

/// Prepare for a law that acts. Fails: NO_MEMORY.
enum status mf_pair_memory_init(struct pair_memory *memory, const struct pair_memory_law *law,
                                const struct pair_memory_scene *scene) MUST_USE;
void mf_pair_memory_clear(struct pair_memory *memory);

/// Go on with another temperature, above 0, and time step: variables follow the law that is
/// stationary then. Fails: NO_MEMORY.
enum status mf_pair_memory_change(struct pair_memory *memory, double temperature,
                                  double time_step) MUST_USE;

/// Take over the pairs of the neighbour list that was built as number `builds`, if it is another
/// one: pairs in range keep their variables. Fails: NO_MEMORY.
enum status mf_pair_memory_follow(struct pair_memory *memory, const struct particles *particles,
                                  const struct neighbours *neighbours, uint64_t builds) MUST_USE;

/// Change velocities and variables by one time step, pair after pair in an order that depends on
/// the list alone: the same bits for any number of threads.
/// @param[in] step          the counter of random numbers
/// @param[in,out] transfer  what the impulses are added to, or NULL
/// Tested: test_pair_memory, physics/test_memory.
void mf_pair_memory_sweep(struct pair_memory *memory, struct particles *particles, uint64_t step,
                          struct transfer *transfer);

/// @name Restart
/// The first span is `pairs.count`: read it before the others and call mf_pair_memory_reserve,
/// since their lengths depend on it. Afterwards the pairs follow the list again.
enum { PAIR_MEMORY_SPANS = 3 + PAIR_MEMORY_MAX_VARIABLES };
size_t mf_pair_memory_spans(struct pair_memory *memory, struct memory_span *spans);
enum status mf_pair_memory_reserve(struct pair_memory *memory) MUST_USE;
