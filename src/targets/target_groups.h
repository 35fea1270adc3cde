// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Targets of one kind for the groups of a scene: {"backbone": {"file": …}, …}.
#pragma once

#include "targets/target_bonded.h"
#include "problem/targets.h"

/// By the numbers of the groups.
struct target_groups {
    int order;
    size_t groups; ///< of the scene; 0: the target is not given
    char name[MOLECULES_MAX_GROUPS][TOPOLOGY_NAME_SIZE];
    struct target_bonded *member;           ///< shape [groups]
    size_t first[MOLECULES_MAX_GROUPS + 1]; ///< value of each among those of all
    double *value, *error;                  ///< of all members, one after the other
    size_t *block, blocks;                  ///< their blocks (mf_targets_blocks), and the end
};

/// Whether a group of the scene has a target.
static inline bool target_groups_have(const struct target_groups *groups, size_t group) {
    return group < groups->groups && groups->member[group].bins.count > 0;
}
