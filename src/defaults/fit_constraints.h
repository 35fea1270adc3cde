// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bonds and angles whose distribution is so narrow that it is a constraint, or stands in so
/// few rows that it shows nothing but a width: a fit takes a harmonic law for them instead of
/// looking for one.
///
/// The law is as wide as the target, but not narrower than what a time step can follow
/// (mf_bonded_distribution_narrow). As a constraint is not met to its width, its target is left
/// out.
#pragma once

#include "io/json.h"
#include "observe/bonded_distribution.h"

enum { FIT_MAX_CONSTRAINTS = 2 * MOLECULES_MAX_GROUPS };

struct fit_constraint {
    int order;
    char name[TOPOLOGY_NAME_SIZE];
    struct bonded_moments moments;
    double deviation; ///< of the law
    double k;         ///< [k_B T_0/λ²] or [k_B T_0/rad²]
};

struct fit_constraints {
    size_t count;
    struct fit_constraint of[FIT_MAX_CONSTRAINTS];
};

struct fit_file;

/// Find those among the groups of a fit that was read and that looks for what has a target.
void mf_fit_constraints_find(struct fit_file *fit);

/// Give their groups the laws, take their targets out, and keep a line for each as the choices of a
/// fit. Fails: NO_MEMORY. Tested: cli/test_measure_own_targets.
enum status mf_fit_constraints_apply(struct fit_file *fit) MUST_USE;
