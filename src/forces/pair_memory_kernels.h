// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of pair_memory_loop.h, by instruction set.
#pragma once

#include "forces/pair_memory.h"

struct pair_memory_kernels {
    /// Append the pairs of a part of the list that may come into their range before the list is
    /// built again, of the particles as they were when it was built; returns how many there are
    /// then, also beyond the room for them.
    size_t (*collect)(struct pair_memory *memory, const struct particles *built,
                      const struct neighbours *neighbours, int part, size_t count);
    /// Change velocities, in kernel_force, and variables of a part; `transfer` may be NULL.
    void (*sweep)(struct pair_memory *memory, const struct particles *particles, uint64_t step,
                  int part, struct transfer *transfer);
};

extern const struct pair_memory_kernels mf_pair_memory_portable, mf_pair_memory_avx2,
    mf_pair_memory_avx512;

/// Those for the instruction set in use.
const struct pair_memory_kernels *mf_pair_memory_kernels(void);
