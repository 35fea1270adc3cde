// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Units of H5MD files: products of powers, "nm ps-1", by symbols of the module "units" (P.
/// de Buyl, P. H. Colberg and F. Höfling, Comput. Phys. Commun. 185, 1546 (2014);
/// https://h5md.nongnu.org).
#pragma once

#include "base/status.h"

/// What a unit may be of.
enum h5md_kind { H5MD_LENGTH, H5MD_TIME, H5MD_SPEED, H5MD_MASS };

/// How many nm, ps, nm/ps or u a unit is. Fails: BAD_INPUT, without a place, for a symbol that is
/// not known, or a unit of something else. Tested: test_trajectory_h5md.
enum status mf_h5md_unit_find(const char *unit, enum h5md_kind kind, double *factor) MUST_USE;
