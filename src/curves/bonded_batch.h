// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The geometry of bonded terms that are worked on together: from their arms to q, and from
/// dU/dq to forces on the arms.
///
/// The arms of a term are differences of its beads (struct bonded_kind). A force on an arm is one
/// on its first bead, and the opposite one on the other.
#pragma once

#include "base/lanes.h"
#include "base/memory.h"
#include "base/simd.h"
#include "curves/bonded_kind.h"

/// glibc has an atan2 of vectors (libmvec) since 2.35, at most 4 units of the last place off.
#if SIMD_X86 && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 35)
__attribute__((simd("notinbranch"))) extern double atan2(double y, double x);
#endif
#endif

/// Component d of number n is [d][n].
typedef double bonded_arms[3][BONDED_BATCH];

/// Forces on the arms take the place of the arms.
struct bonded_batch {
    _Alignas(MEMORY_ALIGNMENT) bonded_arms arm[BONDED_MAX_ARMS];
    double q[BONDED_BATCH], slope[BONDED_BATCH];
    int count; ///< of numbers
};

/// Where a sine, or a product of lengths that it is measured by, is below this there is no
/// direction: that of a cross product is then rounding.
#define BONDED_NO_DIRECTION 1e-9

LANES_INLINE double bonded_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

LANES_INLINE void bonded_cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE void bonded_take(const bonded_arms from, int n, double vector[3]) {
    for (int d = 0; d < 3; d++)
        vector[d] = from[d][n];
}
