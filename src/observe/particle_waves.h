// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The density's waves (observe/density_waves.h) of the sites of components
/// (system/component_sites.h) in a rectangular box.
#pragma once

#include "observe/density_waves.h"
#include "system/component_sites.h"

struct particle_waves {
    struct density_waves waves;
    struct component_sites sites;
    double unit[3]; ///< 2π/L [1/λ]; 0 along what is no dimension
};

/// List the waves up to q_maximum [1/λ] of a box, in so many bins. `count` beads are of one type
/// where the composition is not mixed.
/// @param[in] topology  of molecules that are one site each, or NULL: of beads
/// Must be cleared, also after a failure. Fails: as mf_density_waves_list and mf_components_find;
/// NO_MEMORY.
enum status mf_particle_waves_init(struct particle_waves *waves, const struct box *box,
                                   const struct composition *composition, size_t count,
                                   const struct topology *topology, double q_maximum,
                                   size_t bins) MUST_USE;
void mf_particle_waves_clear(struct particle_waves *waves);

/// Find ρ of all waves of a configuration. The same bits for any number of threads.
/// Tested: test_kirkwood_buff_waves.
void mf_particle_waves_find(struct particle_waves *waves, const struct particles *particles,
                            int threads);
