// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of many_body_loop.h, by instruction set and precision.
#pragma once

#include "forces/many_body.h"

/// What a pass works on. Arrays of particles are by place.
struct many_body_work {
    double *density; ///< ρ, shape [count]
    double *slope;   ///< f'(ρ) of central beads, else 0
    double *share;   ///< 1 for beads that count, else 0
    /// Pairs in range, kept by the first sweep in the places of the list: from j to i, and
    /// −w'(r)/r.
    float (*pair)[4];
    double (*precise)[4]; ///< the same of a simulation in double precision
    int32_t *i, *j;       ///< their places
    size_t capacity;
    size_t end[NEIGHBOURS_MAX_PARTS]; ///< of the pairs of a part, which begin where its list does
};

/// First sweep: adds the weights of the pairs of a part to the densities, and keeps these pairs.
typedef void many_body_densities(const struct many_body_term *term, struct many_body_work *work,
                                 const struct particles *particles,
                                 const struct neighbours *neighbours, int part);
/// Second sweep: adds the forces of the kept pairs of a part.
typedef void many_body_forces(const struct many_body_work *work,
                              const struct neighbours *neighbours, int part, double (*force)[4],
                              double *virial, double (*transfer)[3]);

/// [dimensions − 2][not all beads count]
struct many_body_kernels {
    many_body_densities *densities[2][2];
    many_body_forces *forces[2];
};
extern const struct many_body_kernels mf_many_body_portable, mf_many_body_avx2, mf_many_body_avx512,
    mf_many_body_portable_double, mf_many_body_avx2_double, mf_many_body_avx512_double;
