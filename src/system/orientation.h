// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Orientations of particles in the plane, as attributes of theirs.
///
/// A particle with an orientation θ has a polarity n = (cos θ, sin θ) that goes with it, and a
/// torque, which interactions add to. Where nobody asks there is nothing. Tested: test_active.
#pragma once

#include "system/particles.h"

#include <math.h>
#include <stdbool.h>

/// Shapes [count], good until the next sort; NULL without orientations.
struct orientation {
    double *angle;       ///< θ, not wrapped
    double *polarity[2]; ///< cos θ, sin θ
    double *heading[2];  ///< where a particle drives itself: n without noise that outlasts a step
    double *torque;      ///< [k_B T_0]
};

/// Give the particles orientations, uniform and the same for the same seed and ids, or those of an
/// attribute "orientation" that they have already. Fails: as mf_particles_add_attribute.
enum status mf_orientation_give(struct particles *particles, uint64_t seed) MUST_USE;

struct orientation mf_orientation_of(const struct particles *particles);

/// Torques are 0 from now on, if there are any.
void mf_orientation_clear_torques(const struct particles *particles);

/// cos θ and sin θ within 5e-15, for |θ| < 10⁶, in the lanes of a vector loop.
///
/// θ minus the nearest multiple of π, in two parts (W. J. Cody and W. Waite, Software Manual for
/// the Elementary Functions (1980)), then Taylor's series up to π/2 and the sign of the multiple.
static inline __attribute__((always_inline)) void orientation_polarity(double angle, double *cosine,
                                                                       double *sine) {
    const double shifted = angle * M_1_PI + 0x1.8p52; // its low bits are the multiple
    const double multiple = shifted - 0x1.8p52;
    const double x = (angle - multiple * 0x1.921fb54400000p+1) - multiple * 0x1.0b4611a626331p-33;
    const double s = x * x;
    const double odd = 2 * (0.5 * multiple - floor(0.5 * multiple)); // 0 or 1
    const double sign = 1 - 2 * odd;
    const double c =
        1 +
        s * (-1.0 / 2 +
             s * (1.0 / 24 +
                  s * (-1.0 / 720 +
                       s * (1.0 / 40320 + s * (-1.0 / 3628800 +
                                               s * (1.0 / 479001600 +
                                                    s * (-1.0 / 87178291200 +
                                                         s * (1.0 / 20922789888000 +
                                                              s * (-1.0 / 6402373705728000)))))))));
    const double n =
        x * (1 + s * (-1.0 / 6 +
                      s * (1.0 / 120 +
                           s * (-1.0 / 5040 +
                                s * (1.0 / 362880 +
                                     s * (-1.0 / 39916800 +
                                          s * (1.0 / 6227020800 +
                                               s * (-1.0 / 1307674368000 +
                                                    s * (1.0 / 355687428096000 +
                                                         s * (-1.0 / 121645100408832000))))))))));
    *cosine = sign * c;
    *sine = sign * n;
}
