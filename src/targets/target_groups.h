// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Targets of one kind for the groups of a scene: {"backbone": {"file": …}, …}.
#pragma once

#include "targets/target_bonded.h"
#include "problem/targets.h"

/// By the numbers of the groups.
struct target_groups {
    int order;
    size_t groups; ///< of the scene; 0: the target is not given
    char name[MOLECULES_MOST_GROUPS][TOPOLOGY_NAME_SIZE];
    struct target_bonded *member;            ///< shape [groups]
    size_t first[MOLECULES_MOST_GROUPS + 1]; ///< value of each among those of all
    double *value, *error;                   ///< of all members, one behind the other
    size_t *block, blocks;                   ///< their blocks (mf_targets_blocks), and the end
};

/// Read the object of a kind; `molecules` are those of the scene, or NULL. Faults go to the
/// document. Fails: NO_MEMORY.
enum status mf_target_groups_read(struct target_groups *groups, int order,
                                  struct json_object *object, const struct molecules *molecules,
                                  const struct units *units, int dimensions) MUST_USE;
void mf_target_groups_clear(struct target_groups *groups);

/// Give the target of a group these bins, of which its own are some. What it has not seen has p = 0
/// and the error of its nearest bin. Fails: NO_MEMORY.
enum status mf_target_groups_widen(struct target_groups *groups, size_t group,
                                   const struct bonded_bins *bins) MUST_USE;

/// Whether a group of the scene has a target.
static inline bool target_groups_have(const struct target_groups *groups, size_t group) {
    return group < groups->groups && groups->member[group].bins.count > 0;
}

/// What the observable is to measure for them.
struct bonded_settings mf_target_groups_settings(const struct target_groups *groups);
