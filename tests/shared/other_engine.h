// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tests in which LAMMPS or GROMACS runs, for ENGINES=1: they take minutes more, and a
/// machine that happens to have one of them does not.
#pragma once

#include <stdbool.h>

/// Whether a program, lmp or gmx, is to run: there is one, and ENGINES=1. Says so if it is not.
bool other_engine_runs(const char *program);

/// Skip the test where it is not.
void other_engine_skip_without(const char *program);
