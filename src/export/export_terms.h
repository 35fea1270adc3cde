// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules for the engines that a Python script drives: terms, exclusions and tables as
/// columns of numbers, and the laws as lines of Python.
#pragma once

#include "export/export_engine.h"

/// Write bonds.txt, angles.txt, dihedrals.txt (group and beads, from 0 on), exclusions.txt (two
/// beads) and for each law that the engine has not its rows q, U, −dU/dq as bond0.txt, angle0.txt,
/// dihedral0.txt, …; lengths and angles [rad]. Without molecules nothing is written. Fails: IO.
enum status mf_export_terms_files(const struct export_job *job) MUST_USE;

/// Print the lines that read them: `terms`, for each kind that there is its groups (name, law, its
/// numbers by the names of our scenes) and its rows, and `excluded`. Angles are in radians; a table
/// has a "file".
void mf_export_terms_head(const struct export_job *job, FILE *stream);
