// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Components of a system, as experiments know them: its kinds of molecules, and the types of
/// its single beads.
///
/// They are a composition of sites: kinds come first, in their order, a site a molecule, then the
/// types of which there are single beads. Without molecules components are types.
#pragma once

#include "system/topology.h"

/// Names of the components and how many sites each has. One component alone needs no name.
/// @param[in] beads     types and numbers of all beads; `count` of one type where it is not mixed
/// @param[in] topology  of the molecules, whose ids need not be known yet, or NULL
/// Fails: BAD_INPUT, without a place, for more than COMPOSITION_MAX_TYPES components, a kind whose
/// name is too long for one, or a name that two pairs of components have. Tested: test_components.
enum status mf_components_find(struct composition *components, const struct composition *beads,
                               size_t count, const struct topology *topology) MUST_USE;

/// How many single beads of a type there are. @param[in] beads, count, topology  as above
int64_t mf_components_single(const struct composition *beads, size_t count,
                             const struct topology *topology, int type);
