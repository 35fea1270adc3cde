// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the page draws: the particles of a simulation, as bytes, and the candidate of a fit.
#pragma once

#include "dynamics/simulation.h"
#include "io/json_write.h"
#include "live/live_feed.h"
#include "report/watcher.h"

/// What is sent of each particle besides its position.
enum live_particles_parts {
    LIVE_PARTICLES_POLARITY = 1,
    LIVE_PARTICLES_ENERGY = 2,
    LIVE_PARTICLES_POTENTIAL = 4, ///< not sent, but energies are available on request
};

enum { LIVE_PARTICLES_HEAD = 64 };

/// Write a head and then, of all particles by their ids, single-precision numbers in the order of
/// this machine's bytes:
///   head: "MFP1"; count, dimensions, parts, types, bonds, five words of 32 bits; step and time,
///   doubles; box, three numbers; and zeros up to LIVE_PARTICLES_HEAD;
///   counts of the types, COMPOSITION_MAX_TYPES words; places, shape [count, 3] within the box;
///   speeds [count], NaN without velocities; with LIVE_PARTICLES_POLARITY polarities [count, 2];
///   with LIVE_PARTICLES_ENERGY energies [count] of mf_live_particles_energies [k_B T_0]; the ids
///   of bonded particles, words of shape [bonds, 2]; at last the names of the types,
///   COMPOSITION_MAX_TYPES of COMPOSITION_NAME_SIZE bytes, empty in a one-component system.
/// @param[in]     energies  tell them if there is a potential of pairs
/// @param[in,out] bytes     grows as needed; afterwards of size 0 if there is no memory
/// Tested: tests/live/test_live.py, by the colours of the page; test_particles.py.
void mf_live_particles_write(const struct simulation *simulation, bool energies,
                             struct live_bytes *bytes);

/// Energy that each particle has of its pairs: half of Φ of each of them.
/// @param[in] neighbours  half list, complete for the cutoff of the potential
/// @param[out] energy     by id, shape [count] [k_B T_0]
/// Tested: test_live_particles.
void mf_live_particles_energies(const struct table *potential,
                                const struct composition *composition,
                                const struct particles *particles,
                                const struct neighbours *neighbours, float *energy);

/// The candidate of a fit that was measured last: its curves, its error, its temperature, and g(r)
/// beside the target. Returns NULL without memory. Tested: tests/live/test_candidate.py.
struct json_writer *mf_live_candidate_write(const struct watcher_run *run,
                                            const struct inverse_candidate *candidate);
