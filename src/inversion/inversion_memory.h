// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long samples remember, as the longest run of them has shown.
#pragma once

#include <math.h>

/// Of one pair type or group.
struct inversion_memory {
    double sweeps;  ///< twice the correlation time; 0: none
    double seen_by; ///< sweeps of each replica of the run that has shown it
};

/// Samples that count as one independent, of a run in which so many were found to: what outlasts a
/// short run is hardly seen by it, and counts as a longer one has shown it, until one as long shows
/// less. With one correlation time τ, samples h apart have 1 + 2 Σ exp(−kh/τ), k from 1 on, which
/// is coth(h/2τ). Tested: test_inversion_memory.
/// @param[in] every  sweeps between samples
/// @param[in] run    sweeps of each replica
static inline double mf_inversion_memory_recall(struct inversion_memory *memory, double every,
                                                double run, double found) {
    const double known = memory->sweeps > 0 ? 1 / tanh(every / memory->sweeps) : 1;
    if (run < memory->seen_by && found < known)
        return known;
    *memory = (struct inversion_memory){found > 1 ? every / atanh(1 / found) : 0, run};
    return found;
}
