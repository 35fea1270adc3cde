// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where LAMMPS finds the files of an input: where it was started, in their folder or above
/// it where the folder was written.
///
/// There it cannot tell the folder from a copy whose input it runs: the input says whose files it
/// reads, and leaves what it writes where LAMMPS was started. Tested: cli/test_export_folders.
#pragma once

#include <stdio.h>

/// Before the first file is read: go to the folder, or end.
void mf_export_lammps_print_place(const char *folder, FILE *stream);

/// After the last one: go back.
void mf_export_lammps_print_return(const char *folder, FILE *stream);
