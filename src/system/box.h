// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The periodic box.
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { BOX_MAX_DIMENSIONS = 3 };

/// A rectangular periodic box with one corner at the origin.
struct box {
    int dimensions;                    ///< 2 or 3
    double length[BOX_MAX_DIMENSIONS]; ///< [λ]; length[2] is 1 in two dimensions
};

/// Volume, or area in two dimensions [λ^d].
double mf_box_volume(const struct box *box);

/// Shortest edge [λ].
double mf_box_shortest(const struct box *box);

/// Longest edge [λ].
double mf_box_longest(const struct box *box);

/// The same shape with `volume_share` times the volume.
struct box mf_box_scaled(const struct box *box, double volume_share);

/// A cube of that volume.
struct box mf_box_cube(double volume);

/// Volume of the shell (ring) low ≤ r < high: exact [λ^d].
double mf_box_shell_volume(const struct box *box, double low, double high);

/// Separation a − b of the nearest images along one axis [λ].
static inline double box_nearest(double separation, double length) {
    return separation - length * rint(separation / length);
}

/// Position as a fraction of the box edge in units of 2⁻³².
///
/// The difference of two such integers, taken with wrap-around, is the separation of the nearest
/// images: the minimum image comes free, without branches, at a resolution of 2⁻³² of the box
/// (2e-9 λ at 10 λ) everywhere in it. Adding 1.5·2⁵² puts the integer part of x·2³²/L into the low
/// bits of the sum for any |x| < 2¹⁹ L.
static inline int32_t box_fraction(double x, double inverse_length) {
    const double shifted = x * inverse_length * 0x1p32 + 0x1.8p52;
    int64_t bits;
    memcpy(&bits, &shifted, sizeof bits);
    return (int32_t)(uint32_t)bits;
}

/// Wrap-around difference a − b of two fractions.
static inline int32_t box_fraction_difference(int32_t a, int32_t b) {
    return (int32_t)((uint32_t)a - (uint32_t)b);
}
