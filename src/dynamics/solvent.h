// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The solvent of collision dynamics: point particles in cells, sorted by cell.
///
/// Streaming, sorting and collisions are three passes over arrays (solvent_stream.c,
/// solvent_sort.c, solvent_collide.c). Particles of a cell follow each other, in an order
/// that does not depend on threads; so do all sums.
#pragma once

#include "base/rng.h"
#include "dynamics/collision_dynamics.h"
#include "system/cells.h"
#include "system/particles.h"
#include "system/placement.h"

#include <stdbool.h>

/// Passes are divided into parts, and mf_parallel_for gives out things by SOLVENT_STRETCH.
enum { SOLVENT_MAX_PARTS = 64, SOLVENT_STRETCH = 16 };

/// Momenta are summed in whole numbers of this, so that their sum is the same in any order.
#define SOLVENT_IMPULSE 0x1p-30

struct solvent {
    struct collision_dynamics_parameters parameters;
    struct box box;
    double temperature; ///< [k_B T_0]
    double time;        ///< Δt, from collision to collision [τ]
    uint64_t seed;
    size_t count;
    double *position[3], *velocity[3]; ///< shape [count], sorted by cell [λ], [λ/τ]
    double *spare[6];                  ///< shape [count]: where they are sorted to
    uint32_t *cell;                    ///< shape [count], before they are sorted
    int cells[3];                      ///< along the axes; with plates one more along y
    size_t cell_total;
    uint32_t *start;                       ///< shape [cell_total + 1]: first particle of a cell
    uint32_t *places[SOLVENT_MAX_PARTS];   ///< shape [cell_total]: of a part's particles
    int64_t impulse[SOLVENT_MAX_PARTS][3]; ///< given to the obstacle by a part, in SOLVENT_IMPULSE
    int64_t given[3];                      ///< the same in all since the start
    bool trapped[SOLVENT_MAX_PARTS];       ///< a particle met walls without end
    int parts;                             ///< into which passes are divided
    double shift[3];                       ///< of the grid, 0 to a [λ]
    int32_t *first_bead; ///< shape [cell_total]: chains of the beads in the collisions; NULL: none
    int32_t *next_bead;  ///< shape [beads]: cells_enter
};

/// Place the solvent at random where there is room, with Maxwell's velocities that have exactly
/// the temperature and the drift.
/// @param[in] beads    number of particles that take part
/// @param[in] threads  the most that will share a pass
/// Fails: BAD_INPUT if cells do not divide the box, an obstacle is not inside, or particles fly too
/// far in a step; NO_MEMORY.
enum status mf_solvent_init(struct solvent *solvent, const struct particles *beads,
                            int threads) MUST_USE;
void mf_solvent_clear(struct solvent *solvent);

/// Beads that begin inside the obstacle, and molecules that reach into it or through a plate, get
/// other places, at random, as a whole, where no other bead is nearer than the placement's
/// separation, and in which there is some room.
/// Fails: BAD_INPUT if they are from a file, which also knows of no place beyond a plate, or if
/// there is no room. Tested: cli/test_simulate_solvent.
enum status mf_solvent_part_beads(const struct solvent *solvent, struct particles *beads,
                                  const struct placement *placement) MUST_USE;

/// Number of solvent particles of a setup: M in each cell's volume of free space.
double mf_solvent_count(const struct collision_dynamics_parameters *parameters,
                        const struct box *box);

/// Free flight for Δt between walls and obstacle, and the cell of each particle in the grid of
/// `step`. Fails: UNSTABLE.
enum status mf_solvent_stream(struct solvent *solvent, uint64_t step, int threads) MUST_USE;

/// Sort by cell.
void mf_solvent_sort(struct solvent *solvent, int threads);

/// One collision in each cell, in which beads take part.
void mf_solvent_collide(struct solvent *solvent, struct particles *beads, uint64_t step,
                        int threads);

/// Fly from `position` with `velocity` and acceleration `g` for a time, turned back by the plates
/// and the obstacle; the position is not wrapped along periodic axes.
/// @param[out] impulse  added to: velocities given to the obstacle; NULL: not wanted
/// @return false if the particle met walls without end
bool mf_solvent_propagate(const struct solvent *solvent, double position[3], double velocity[3],
                          const double g[3], double time, double impulse[3]);

/// The cell of a point, which may be outside the box.
uint32_t mf_solvent_cell(const struct solvent *solvent, const double position[3]);

/// Whether a point is outside the obstacle.
bool mf_solvent_is_free(const struct solvent *solvent, const double position[3]);

/// What cuts a cell, or fills it; the obstacle, if both do.
enum solvent_cut { SOLVENT_UNCUT, SOLVENT_CUT_BY_PLATE, SOLVENT_CUT_BY_OBSTACLE };
enum solvent_cut mf_solvent_cut(const struct solvent *solvent, size_t cell);

/// What random numbers are for: the last word of their counter, with the step's upper part.
enum solvent_noise {
    SOLVENT_SHIFT,
    SOLVENT_ROTATION,
    SOLVENT_THERMOSTAT,
    SOLVENT_VIRTUAL,
    SOLVENT_PLACE,
    SOLVENT_VELOCITY,
    SOLVENT_BEAD,
    SOLVENT_ANEW
};

static inline struct rng_block solvent_noise(const struct solvent *solvent, uint64_t step,
                                             size_t number, enum solvent_noise purpose,
                                             uint32_t trial) {
    return mf_rng_philox(solvent->seed, RNG_SOLVENT, (uint32_t)step, (uint32_t)number,
                         (uint32_t)purpose << 28 | (trial & 0xFF) << 20 |
                             ((uint32_t)(step >> 32) & 0xFFFFF));
}

/// Part of a pass over `count` things: where part number `part` of solvent->parts begins.
static inline size_t solvent_part(const struct solvent *solvent, size_t count, int part) {
    return count * (size_t)part / (size_t)solvent->parts;
}
