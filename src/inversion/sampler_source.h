// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where a sampler's configurations come from: a record each, in a file of its own.
#pragma once

#include "inversion/sampler.h"

/// The pairs of the present configuration.
struct sampler_pairs {
    const uint32_t *counts; ///< in each bin, shape [pair types, bins]; borrowed
    struct pair_sums sums;
};

/// One source; `own` is memory of its size, zeroed before init. A sweep is what it makes of a
/// configuration until the next one may be asked for.
struct sampler_source {
    size_t size;
    /// Place the beads. @param[in] bins  in which pairs are counted
    enum status (*init)(void *own, const struct sampler_system *system,
                        const struct pair_histogram *bins);
    void (*clear)(void *own);
    /// Place them again, without order; as mf_sampler_scatter.
    enum status (*scatter)(void *own);
    /// With the potential as it is now; as mf_sampler_begin.
    enum status (*begin)(void *own);
    /// Sweeps that are not counted and tune what there is to tune.
    enum status (*equilibrate)(void *own, uint64_t sweeps);
    /// What will be asked for, before any replica is sampled: scatter or not, sweeps of
    /// equilibrate, samples and sweeps between them; NULL: nobody wants to know.
    enum status (*announce)(void *own, bool scatter, uint64_t lead, uint64_t samples,
                            uint64_t every);
    /// Sweeps, then the pairs of the configuration that they lead to.
    enum status (*run)(void *own, uint64_t sweeps, struct sampler_pairs *pairs);
    /// Part of what was tried that was taken, since equilibrate.
    double (*acceptance)(const void *own);
    const struct particles *(*particles)(const void *own);
    /// What a checkpoint keeps; returns the number of spans.
    size_t (*spans)(void *own, struct memory_span *span);
};

/// Single moves (dynamics/metropolis.h), trajectories (dynamics/hybrid.h), another program
/// (problem/sampling_engine.h).
extern const struct sampler_source mf_sampler_moves, mf_sampler_trajectories, mf_sampler_engine;

/// Positions and ids of the particles, in their order; returns the number of spans.
size_t mf_sampler_place_spans(struct particles *particles, struct memory_span *span);
