// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What acts on the particles: the record of an interaction.
///
/// A simulation has a list of them. The pairs with their friction (forces/pairs.c) come first; a
/// scene may name others. To add one that scenes can name, write a file with its record and put its
/// name into INTERACTIONS below.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "forces/pair.h"

/// One pass over the list.
struct interaction_pass {
    const struct pair_law *law;          ///< of the pairs, with temperature, time step and seed
    struct particles *particles;         ///< at their present positions
    const struct neighbours *neighbours; ///< complete for the law and all ranges
    uint64_t step;                       ///< the counter of random numbers
    bool conservative;                   ///< potentials alone: no friction, no noise
    bool before_pairs;                   ///< forces go to the sums of the pair kernels
    enum pair_wants wants;
    struct pair_sums *sums; ///< to be added to, if `wants` asks for them
};

struct interaction {
    const char *name;
    const char *summary;        ///< the formula and its source, one line
    const struct field *fields; ///< of its parameters; NULL: no scene can name it
    size_t parameters_size;     ///< of the struct of its parameters
    size_t state_size;          ///< of what it keeps from step to step, zeroed at first; 0: nothing
    double cost;                ///< nanoseconds a particle and step, for --explain
    /// How far it looks for pairs [λ]: the neighbour list is complete for that. NULL: not at all.
    double (*range)(const void *parameters);
    /// Acts along or on the orientations of particles (system/orientation.h), which they then have,
    /// unless a pass is of potentials alone: it has none.
    bool oriented;
    /// Acts before the pairs in a pass of both, and then adds its forces to particles->kernel_force
    /// instead: the pairs hand over the sums of all.
    bool before_pairs;
    /// Is of beads that find each other, by the list or by particles->fraction: both are of the
    /// last step's end, and mean nothing in between (dynamics/respa.h).
    bool finds_pairs;
    /// Its forces follow from no potential: the energy is not conserved.
    bool does_work;
    /// Force on each particle that drives it for ever, in a direction of its own [k_B T_0/λ]. NULL:
    /// none.
    double (*push)(const void *parameters);
    /// Check the parameters and begin with the first positions. NULL: nothing to do.
    enum status (*begin)(const void *parameters, void *state, const struct particles *particles);
    void (*clear)(void *state); ///< frees what the state owns; NULL: nothing
    /// Give the law of the pairs what is found and acts within their own pass. NULL: nothing.
    void (*join)(void *state, struct pair_law *law);
    /// Add its forces to particles->force and, if they are wanted, its energy [k_B T_0] and virial
    /// Σ r·F [k_B T_0] to the sums. What pushes from outside has no virial: it is no part of the
    /// pressure. A step may take more than one pass, with the same number.
    enum status (*add)(const void *parameters, void *state, const struct interaction_pass *pass);
    /// Add Σ_i ∇_i² U [k_B T_0/λ²] to `sum`, after a pass at the same positions. NULL: it is not
    /// known. Tested: test_configurational.
    enum status (*laplacian)(const void *parameters, void *state,
                             const struct interaction_pass *pass, double *sum);
    /// List what of its state a checkpoint must keep; returns the number of spans, at most
    /// INTERACTION_SPANS. NULL: nothing.
    size_t (*spans)(void *state, struct memory_span *spans);
};

enum { INTERACTION_SPANS = 4 };

/// The interactions that a scene can name, in the order in which they act.
#define INTERACTIONS(EACH)                                                                         \
    EACH(mf_uniform_force)                                                                         \
    EACH(mf_harmonic_trap)                                                                         \
    EACH(mf_self_propulsion)                                                                       \
    EACH(mf_polar_alignment)                                                                       \
    EACH(mf_soft_discs)                                                                            \
    EACH(mf_shear_wave)

#define INTERACTION_DECLARE(record) extern const struct interaction record;
INTERACTIONS(INTERACTION_DECLARE)
#undef INTERACTION_DECLARE

/// The same, NULL-terminated.
extern const struct interaction *const mf_interaction_list[];

/// The Laplacian of what pushes alike everywhere, or has no potential: none.
enum status mf_interaction_no_laplacian(const void *parameters, void *state,
                                        const struct interaction_pass *pass, double *sum);

/// Φ and ω of the pairs, in one pass, which replaces the forces of the last step by the sums of the
/// pair kernels: the first of every simulation's list. Its numbers are those of the pass.
extern const struct interaction mf_pairs;

/// Bonds, angles and dihedrals of molecules (forces/molecules.h), which a scene gives by
/// itself.
extern const struct interaction mf_molecules;

/// How many a scene can have: all that it can name, molecules, and energies of local densities
/// (forces/many_body.h).
#define INTERACTION_COUNT(record) +1
enum { INTERACTION_MAX = INTERACTIONS(INTERACTION_COUNT) + 2 };
#undef INTERACTION_COUNT

/// An interaction and its numbers.
struct interaction_choice {
    const struct interaction *kind;
    const void *parameters; ///< borrowed
};
