// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where particles start.
#pragma once

#include "base/fields.h"
#include "system/particles.h"

#define PLACEMENT_JITTER 0.05

enum placement_kind { PLACEMENT_LATTICE, PLACEMENT_RANDOM, PLACEMENT_FILE };

/// Beginnings that are not those of equilibrium, on purpose: simulations that agree in spite of
/// them have forgotten where they began. A scene has none.
struct placement_bias {
    double stretch; ///< of molecules, forces/molecules_growth.h; below 0 they are coiled up
    double tilt;    ///< of a mixture, mf_placement_tilt
};

/// How the particles of a scene are placed.
struct placement {
    int64_t count;
    int kind;          ///< enum placement_kind
    double jitter;     ///< lattice: largest shift along an axis, as a fraction of the spacing;
                       ///< of a scene PLACEMENT_JITTER
    double separation; ///< random: least distance of any two [λ]
    double slab;       ///< lattice, random: part of the longest edge that is filled; 0: all
    int speeds;        ///< enum particles_speeds, unless the file has velocities
    struct placement_bias bias;
    char file[FIELD_TEXT_SIZE];
};

/// The number alone, which a mixture gives for each of its types, and all the rest.
extern const struct field mf_placement_count_fields[], mf_placement_fields[];

/// The site of particle k of `count` on a lattice of `sites` ≥ count, whose empty sites are spread
/// evenly: no site twice. In whole numbers, since the product exceeds the 53 bits of a double from
/// 10⁸ particles on.
static inline size_t placement_site(size_t k, size_t count, size_t sites) {
    return (size_t)((uint64_t)k * sites / count);
}

/// Simple cubic (square) lattice of the smallest size that holds all particles, filled evenly,
/// each particle shifted by a uniform random amount.
void mf_placement_lattice(struct particles *particles, double jitter, uint64_t seed);

/// Exchange the ids of all particles at random, so that the types of a mixture stand on the sites
/// of a lattice without order. Before velocities are drawn, which belong to ids.
void mf_placement_mix(struct particles *particles, uint64_t seed);

/// Exchange ids so that each type gathers in a part of the box of its own: drawn from
/// exp(tilt Σ cos 2π (x/L − id/count)), x along the axis of a slab. 0: nothing.
/// Tested: test_placement.
void mf_placement_tilt(struct particles *particles, double tilt, uint64_t seed);

/// Uniform random positions no two of which are nearer than `separation` (sequential addition).
/// Fails: BAD_INPUT when no place is found in 10,000 trials: the density is too high for it.
enum status mf_placement_random(struct particles *particles, double separation,
                                uint64_t seed) MUST_USE;

/// The axis of the longest edge, of equal ones the last: what stands across it is a slab.
int mf_placement_slab_axis(const struct box *box);

/// On a lattice or at random, as a placement says; with a slab in that part of the box, in the
/// middle of its longest edge, and nowhere else. Fails: as mf_placement_random.
/// Tested: test_placement.
enum status mf_placement_fill(struct particles *particles, const struct placement *placement,
                              uint64_t seed) MUST_USE;

/// Without order: at random, no two nearer than 0.7 of their mean distance, so that there is room
/// for all (sequential addition fills a box up to 0.9 of it) and moves soon undo the overlaps.
/// Fails: NO_MEMORY.
enum status mf_placement_disordered(struct particles *particles, uint64_t seed) MUST_USE;
