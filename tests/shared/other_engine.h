// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tests in which LAMMPS or GROMACS runs, for ENGINES=1: they take minutes more, and a
/// machine that happens to have one of them does not.
#pragma once

/// Skip the test, and say why, without ENGINES=1 or where there is no such program: lmp or gmx.
void other_engine_skip_without(const char *program);
