// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The noise inside the pair kernels, number by number. Particles at rest with ω alone feel
/// nothing else, so that each ζ_ij comes back from a force:
///   F_i · r̂ = sqrt(2 k_B T / Δt) ω(r) ζ_ij
/// The scenes are pairs, and right-angled triangles in which every side acts, each far from all
/// others: along one axis, one corner of a triangle feels one side only.
#pragma once

#include "forces/pair.h"

/// Of ζ between instruction sets and precisions: a dozen roundings of 6e-8, and two of r in an ω
/// whose r |dω/dr| is up to 2.3 times as much as itself. Measured: 4e-7.
extern const double probes_tolerance;

/// 2³². Steps around it: so the upper word of the step counts changes within every series.
extern const uint64_t probes_carry;

enum probes_motif { PROBES_DIMERS, PROBES_TRIANGLES };
enum probes_ids { PROBES_IN_ORDER, PROBES_SHUFFLED };

/// Sides of a triangle by the ranks of their ids. Any two share a particle.
enum probes_side { PROBES_LOW_MIDDLE, PROBES_LOW_HIGH, PROBES_MIDDLE_HIGH, PROBES_SIDES };

/// Where a ζ is read: ζ = factor × force[axis][particle].
struct probe {
    uint32_t particle; ///< its id first, its place in the arrays once these are sorted
    int axis;
    double factor;
};

struct probes {
    struct particles particles;
    struct neighbours neighbours;
    struct table omega;
    struct pair_law law;
    size_t pairs;
    struct probe *probe;  ///< shape [pairs]
    struct probe *mirror; ///< the same ζ on the other particle; of PROBES_DIMERS
};

/// What a scene is made of.
struct probes_plan {
    enum probes_motif motif;
    enum probes_ids ids;
    int dimensions, sites; ///< sites along an axis, one motif each
    bool exchanged;        ///< the particles of each dimer have changed places
    bool reversed;         ///< the arrays began in the opposite order
};

/// Place the particles of a plan and build their list. probes_clear frees it.
void probes_make(struct probes *scene, const struct probes_plan *plan);
void probes_clear(struct probes *scene);

/// The ζ that stand in the present forces: shape [pairs].
/// @param[in] probe  those of the scene, or its mirror
void probes_read(const struct probes *scene, const struct probe *probe, double *zeta);

/// The ζ of all pairs at a step, as kernels see it: shape [pairs].
void probes_draw(struct probes *scene, uint64_t seed, uint64_t step, double *zeta);

/// An array of zeros, for mf_memory_free.
double *probes_numbers(size_t count);
