// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bins of bonds, angles and dihedrals that several states share.
#pragma once

#include "defaults/fit_file.h"

/// Give the targets of each group that is to be found the bins of all states: what one state has
/// not seen has p = 0 there. Fails: BAD_INPUT if the states do not look for the same groups, or
/// their bins do not meet; NO_MEMORY.
enum status mf_fit_states_widen(struct fit_file *fit, const char *file) MUST_USE;
