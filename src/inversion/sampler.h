// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One source of configurations of the canonical ensemble, by single moves or by dynamics.
///
/// A sweep is a move of every particle (inversion/sampler_moves.c), or a trajectory of a few time
/// steps (inversion/sampler_trajectories.c). Which of them makes more of a second: lab/samplers.md.
#pragma once

#include "base/memory.h"
#include "dynamics/molecule_moves.h"
#include "forces/many_body.h"
#include "observe/bonded_distribution.h"
#include "observe/weighted_density.h"
#include "observe/kirkwood_buff.h"
#include "problem/sampling_engine.h"
#include "system/whole_molecules.h"

enum sampler_kind {
    SAMPLER_MONTE_CARLO,
    SAMPLER_DYNAMICS,
    SAMPLER_AUTO ///< single beads by moves, molecules and local densities by dynamics
};

/// Names in the order of enum sampler_kind, NULL-terminated.
extern const char *const mf_sampler_kinds[];

/// A group of bonds, angles or dihedrals that is counted, or local densities, and its bins.
struct sampler_group {
    int order;
    int group;
    struct bonded_bins bins;
    const struct weighted_density_settings *density; ///< NULL: of molecules
};

struct sampler_source;

struct sampler {
    const struct sampler_source *source; ///< inversion/sampler_source.h
    void *own;                           ///< of the source
    const struct molecules *molecules;   ///< NULL: single particles
    struct composition composition;
    double volume;                     ///< of the scene [λ^d]
    struct pair_histogram bins;        ///< of pairs; without counts
    const struct sampler_group *group; ///< shape [groups]
    size_t groups, integrals;
    bool waves; ///< the integrals are asked for
    struct kirkwood_buff_waves kirkwood_buff;
    struct whole_molecules whole;   ///< of molecules, for their sizes
    struct density_list *densities; ///< of a group of local densities; NULL: there is none
};

/// What is to be sampled. Borrowed: the potential, which may be exchanged before mf_sampler_begin,
/// molecules and groups.
struct sampler_system {
    const struct box *box;
    const struct composition *composition;
    const struct table *potential;
    double temperature;
    double low, width; ///< of the bins that count pairs, within the potential's cutoff [λ]
    size_t bins;       ///< of each pair type; 0: pairs are not counted
    const struct molecules *molecules; ///< or NULL; its laws may be exchanged as the potential may
    const struct many_body *many_body; ///< the same; of SAMPLER_DYNAMICS alone
    const struct sampler_group *group; ///< to be counted after the pairs, shape [groups]
    size_t groups;
    size_t integrals; ///< of Kirkwood and Buff: pairs of components, if they are asked for, or 0
    double q_maximum; ///< of their waves, as of mf_kirkwood_buff_waves_init [1/λ]
    const struct sampling_engine *engine; ///< that samples, or NULL: we
    size_t replica;                       ///< which of its replicas this is
    uint64_t seed;
    struct placement_bias bias; ///< of where it begins
    const atomic_bool *cancel;  ///< stops the sweeps once it is set, or NULL
};

/// Bins that are counted: of all pair types, and of the groups.
size_t mf_sampler_bins(const struct sampler_system *system);

/// Numbers of a sample: the bins, the sums, the integrals of all pairs of components, and the
/// stresses of local densities.
size_t mf_sampler_numbers(const struct sampler_system *system);

/// Particles on a lattice, molecules as a scene places them. Must be cleared. Fails: as
/// mf_metropolis_init, mf_hybrid_init and mf_kirkwood_buff_waves_init.
enum status mf_sampler_init(struct sampler *sampler, enum sampler_kind kind,
                            const struct sampler_system *system) MUST_USE;
void mf_sampler_clear(struct sampler *sampler);

/// Forget the configuration: the particles are placed again, without order. From a lattice, a
/// potential that favours a crystal would keep one. Fails: NO_MEMORY.
enum status mf_sampler_scatter(struct sampler *sampler) MUST_USE;

/// Begin with the potential as it is now: a run that continues and one that was reloaded go on with
/// the same bits. Fails: NO_MEMORY.
enum status mf_sampler_begin(struct sampler *sampler) MUST_USE;

/// Sweeps that are not counted and that tune the moves, or the time step. Fails: NO_MEMORY,
/// INTERRUPTED.
enum status mf_sampler_equilibrate(struct sampler *sampler, uint64_t sweeps) MUST_USE;

/// What follows the bins of a sample.
enum sampler_sum {
    SAMPLER_VIRIAL,   ///< Σ r·F [k_B T_0]
    SAMPLER_ENERGY,   ///< Σ Φ, and U of molecules [k_B T_0]
    SAMPLER_GYRATION, ///< Σ R_g² of the molecules, each bead with the same weight [λ²]
    SAMPLER_ENDS,     ///< Σ R_e² of the molecules, from one end to the other [λ²]
    SAMPLER_DENSITY,  ///< volume of the scene over that of the sample, 1 where boxes stay [1]
    SAMPLER_WAVES, ///< of a mixture Σ_a |ρ_a(q)|²/N_a of types a, q along the longest edge [1]
    SAMPLER_SUMS,
};

/// What will be asked for: a scatter or not, sweeps of equilibration, samples, sweeps between them.
/// Fails: as sampling_engine.announce.
enum status mf_sampler_announce(struct sampler *sampler, bool scatter, uint64_t lead,
                                uint64_t samples, uint64_t every) MUST_USE;

/// Sweeps, then a sample: S of each bin of each pair type and of each group, then the sums,
/// then the integrals of the configuration, then of the bins of each group of local densities the
/// stresses Σ_i Σ_j r w'(r_ij) of the beads i in them. Where boxes change, pairs have the weight
/// V/V_scene, so that the mean is that of g.
/// @param[out] sample  shape [mf_sampler_numbers]
/// Fails: NO_MEMORY, INTERRUPTED. Tested: test_monte_carlo_mixture.
enum status mf_sampler_sample(struct sampler *sampler, uint64_t sweeps, double *sample) MUST_USE;

/// Part of the moves, or of the trajectories, that were taken since mf_sampler_equilibrate; NaN
/// without any. Tested: test_replicas.
double mf_sampler_acceptance(const struct sampler *sampler);

/// The present configuration.
const struct particles *mf_sampler_particles(const struct sampler *sampler);

/// How often each kind of moves of molecules was taken, shape [MOLECULE_MOVES]; NULL: there are
/// none.
const struct molecule_tally *mf_sampler_tally(const struct sampler *sampler);

/// Count the pairs of the configuration that molecules exclude: what S leaves out of its bins.
/// Returns how many are nearer than the first bin.
/// @param[in,out] counts  shape [pair types, bins], added to
double mf_sampler_count_excluded(struct sampler *sampler, const struct composition *composition,
                                 double *counts);

/// What a checkpoint keeps between runs; returns the number of spans.
size_t mf_sampler_spans(struct sampler *sampler, struct memory_span *span);
