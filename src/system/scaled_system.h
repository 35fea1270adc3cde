// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A system of another number of beads, at the same densities.
#pragma once

#include "system/topology.h"

struct scaled_system {
    struct composition composition;
    int64_t molecules[TOPOLOGY_MAX_KINDS]; ///< of each kind
    double distortion; ///< largest relative change of the share that a kind of molecules, or single
                       ///< beads of a type, have in all beads; that of one single bead does not
                       ///< count, which changes with any other number
};

/// About `particles` beads of the same mixture. Of each kind of molecules, and of single beads of
/// each type, there are two if there were, so that there are pairs of them, and one if there was no
/// more, so that there are none.
/// @param[in] topology  of the molecules, complete; NULL: all beads are single
/// Tested: test_scaled_system.
struct scaled_system mf_scaled_system(const struct composition *composition,
                                      const struct topology *topology, int64_t particles);

/// Whether g(r) of another number of beads is the same but for a factor of each pair type. That of
/// pairs within molecules is so of one kind of molecules alone; in a mixture it is one molecule's
/// share of all pairs, which goes by the numbers themselves: 100 chains of six among 2400 beads as
/// 23 among 560 have 1.017 times as much of it. So it is where g leaves all of them out.
bool mf_scaled_system_is_alike(const struct composition *composition,
                               const struct topology *topology);

/// The smallest number of beads from `particles` on that changes no share by more than
/// `distortion`; that of the composition if there is none near.
int64_t mf_scaled_system_min(const struct composition *composition, const struct topology *topology,
                             int64_t particles, double distortion);

/// The topology of a scaled system, complete, to be cleared also after a failure.
/// Fails: NO_MEMORY.
enum status mf_scaled_system_topology(const struct scaled_system *system,
                                      const struct topology *from, struct topology *to) MUST_USE;
