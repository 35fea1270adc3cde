// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of soft_discs_loop.h, by instruction set and precision.
#pragma once

#include "forces/soft_discs_cells.h"

/// One pass over the discs.
struct soft_discs_pass {
    const struct soft_discs_cells *cells;
    struct particles *particles; ///< whose forces are added to
    double strength;
    double *energy, *virial; ///< shape [count] by place, half of each pair's; NULL: not wanted
};

/// Forces on the discs of the blocks begin … end − 1.
typedef void soft_discs_kernel(void *pass, size_t begin, size_t end);

/// By whether they are spheres, in three dimensions, and by whether sums are wanted.
typedef soft_discs_kernel *const soft_discs_kernels[2][2];
extern soft_discs_kernels mf_soft_discs_portable, mf_soft_discs_avx2, mf_soft_discs_avx512,
    mf_soft_discs_portable_double, mf_soft_discs_avx2_double, mf_soft_discs_avx512_double;
