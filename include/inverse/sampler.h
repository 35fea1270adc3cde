// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One source of configurations of the canonical ensemble: a Markov chain or a simulation.
///
/// Both count in sweeps: a sweep of moves over all particles, or SAMPLER_STEPS time steps. Which of
/// them makes more of a second: docs/samplers.md.
#pragma once

#include "base/memory.h"
#include "dynamics/metropolis.h"
#include "dynamics/simulation.h"

enum sampler_kind { SAMPLER_MONTE_CARLO, SAMPLER_DYNAMICS };

/// Names in the order of enum sampler_kind, NULL-terminated.
extern const char *const sampler_kinds[];

/// Time steps of a sweep.
enum { SAMPLER_STEPS = 5 };

struct sampler {
    enum sampler_kind kind;
    struct metropolis chain;      ///< of SAMPLER_MONTE_CARLO
    struct simulation simulation; ///< of SAMPLER_DYNAMICS
    double *before[3];            ///< positions when a simulation began with its potential
    uint32_t *counts;             ///< shape [bins + 1]; of a simulation [parts, bins + 1]
    struct pair_histogram histogram;
};

/// What is to be sampled. Borrowed: the potential, which may be exchanged before sampler_begin.
struct sampler_system {
    const struct box *box;
    size_t particles;
    const struct table *potential;
    double temperature;
    double low, width; ///< of the bins that count pairs, within the potential's cutoff
    size_t bins;
    uint64_t seed;
};

/// Particles on a lattice. Fails: as metropolis_init and simulation_init; cleared then.
enum status sampler_init(struct sampler *sampler, enum sampler_kind kind,
                         const struct sampler_system *system) MUST_USE;
void sampler_clear(struct sampler *sampler);

/// Begin with the potential as it is now, from the positions (and velocities) alone: a run that
/// continues and one that was reloaded go on with the same bits. Fails: NO_MEMORY.
enum status sampler_begin(struct sampler *sampler) MUST_USE;

/// Sweeps that are not counted, and during which a chain finds the length of its moves. Fails:
/// NO_MEMORY, INTERRUPTED; UNSTABLE, after which the simulation is back where it began.
enum status sampler_equilibrate(struct sampler *sampler, uint64_t sweeps) MUST_USE;

/// Sweeps, then a sample: S of each bin, and behind them the virial Σ r·F [k_B T_0].
/// @param[out] sample  shape [bins + 1]
/// Fails: as sampler_equilibrate.
enum status sampler_sample(struct sampler *sampler, uint64_t sweeps, double *sample) MUST_USE;

/// Time step at which the structure is right within the noise of any fit [τ]: a share of the time of
/// the fastest pair, π/ω with ω² = 2 Φ'' where pairs of ten k_B T get to.
double sampler_time_step(const struct table *potential, double temperature);

enum { SAMPLER_SPANS = 8 };

/// What a checkpoint keeps between runs; returns the number of spans.
size_t sampler_spans(struct sampler *sampler, struct memory_span *span);
