// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Counter-based random numbers.
///
/// Philox4x32-10: J. K. Salmon, M. A. Moraes, R. O. Dror and D. E. Shaw, SC'11 (2011).
/// A number is a function of (seed, stream, counters): there is no state to save, and the same
/// noise comes out for any thread count, neighbour list or order of the particles. The seed is
/// the key and is never added to a counter, so seed 43 does not replay seed 42 a step later.
#pragma once

#include <math.h>
#include <stdint.h>

/// What a number is for. Two uses never share a stream.
enum rng_stream {
    RNG_PAIR_NOISE,    ///< counters: step, smaller id, larger id
    RNG_VELOCITIES,    ///< counters: particle id
    RNG_PLACEMENT,     ///< counters: particle id, trial, 0; of an attribute: particle id, number, 1
    RNG_METROPOLIS,    ///< counters: move
    RNG_INITIAL,       ///< first population of an optimiser
    RNG_SELECTION,     ///< optimiser: generation, individual
    RNG_EVALUATION,    ///< seeds of simulations inside a fit: round, candidate
    RNG_VERIFICATION,  ///< seeds of the verification simulations
    RNG_MEAN_VELOCITY, ///< of a test of velocities; counters: step
    RNG_REMEASUREMENT, ///< seeds of fresh measurements in a fit: candidate, number
    RNG_MIXING,        ///< which sites of a lattice get which type; of molecules that grow:
                       ///< counters: molecule + 1, bead
    RNG_COLLISIONS,    ///< with a heat bath; counters: trajectory, particle id
    RNG_BROWNIAN,      ///< kicks of an integrator without velocities; counters: step, particle id
    RNG_SOLVENT,       ///< of collision dynamics; counters: step, cell or number, what it is for
    RNG_PAIR_MEMORY,   ///< hidden variables of pairs; counters: step, smaller id, larger id
    RNG_STATES,        ///< seeds of the states of a fit: number of the state
    RNG_EXCHANGE       ///< of beads of two types; counters: sweep, number
};

struct rng_block {
    uint32_t word[4];
};

/// Four independent 32-bit words for (seed, stream, a, b, c).
struct rng_block mf_rng_philox(uint64_t seed, enum rng_stream stream, uint32_t a, uint32_t b,
                               uint32_t c);

/// Seed of a simulation that is number (a, b) of `stream`, itself the child of `seed`.
uint64_t mf_rng_child_seed(uint64_t seed, enum rng_stream stream, uint32_t a, uint32_t b);

/// Two standard normal numbers from uniform ones, u in (0, 1) and v in [0, 1).
/// G. E. P. Box and M. E. Muller, Ann. Math. Stat. 29, 610 (1958).
static inline void rng_box_muller(double u, double v, double normal[2]) {
    const double angle = 2 * M_PI * v;
    const double radius = sqrt(-2 * log(u));
    normal[0] = radius * cos(angle);
    normal[1] = radius * sin(angle);
}

/// Four standard normal numbers (rng_box_muller).
void mf_rng_normal4(struct rng_block block, double normal[4]);

/// Uniform number in (0, 1), 52 bits from two words; never 0 and never 1.
double mf_rng_uniform(uint32_t high, uint32_t low);

/// A sequence of numbers for serial code: counter (a, b) fixed, c counting.
struct rng_sequence {
    uint64_t seed;
    enum rng_stream stream;
    uint32_t a, b, c;
    int used; ///< words of `block` already given out
    struct rng_block block;
};

struct rng_sequence mf_rng_sequence_begin(uint64_t seed, enum rng_stream stream, uint32_t a,
                                          uint32_t b);

/// Next uniform number in (0, 1).
double mf_rng_sequence_uniform(struct rng_sequence *sequence);

/// Next integer in 0 … count − 1, count ≥ 1.
uint32_t mf_rng_sequence_below(struct rng_sequence *sequence, uint32_t count);

#define RNG_PHILOX_MULTIPLIER0 0xD2511F53u
#define RNG_PHILOX_MULTIPLIER1 0xCD9E8D57u
#define RNG_PHILOX_STEP0 0x9E3779B9u ///< of the first word of the key, from round to round
#define RNG_PHILOX_STEP1 0xBB67AE85u

/// The same function on plain integers, in the lanes of a vector loop.
static inline __attribute__((always_inline)) void rng_philox_words(uint32_t key0, uint32_t key1,
                                                                   uint32_t c0, uint32_t c1,
                                                                   uint32_t c2, uint32_t c3,
                                                                   uint32_t word[4]) {
    for (uint32_t round = 0; round < 10; round++) {
        const uint64_t product0 = (uint64_t)c0 * RNG_PHILOX_MULTIPLIER0;
        const uint64_t product1 = (uint64_t)c2 * RNG_PHILOX_MULTIPLIER1;
        c0 = (uint32_t)(product1 >> 32) ^ c1 ^ (key0 + round * RNG_PHILOX_STEP0);
        c1 = (uint32_t)product1;
        c2 = (uint32_t)(product0 >> 32) ^ c3 ^ (key1 + round * RNG_PHILOX_STEP1);
        c3 = (uint32_t)product0;
    }
    word[0] = c0;
    word[1] = c1;
    word[2] = c2;
    word[3] = c3;
}

/// Its word 0, as the kernels compute it (rng_lanes.h). Tested against the library's in test_rng.
static inline uint32_t rng_philox_lane(uint32_t key0, uint32_t key1, uint32_t c0, uint32_t c1,
                                       uint32_t c2, uint32_t c3) {
    uint32_t word[4];
    rng_philox_words(key0, key1, c0, c1, c2, c3, word);
    return word[0];
}

/// Fourth counter word: the stream in the upper four bits, 28 bits of `extra` below.
static inline uint32_t rng_stream_word(enum rng_stream stream, uint32_t extra) {
    return (uint32_t)stream << 28 | (extra & 0x0FFFFFFFu);
}
