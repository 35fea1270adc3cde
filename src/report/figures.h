// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Figures of a run, drawn by gnuplot from the tables in the run's folder.
///
/// The scripts are those of plots/, found from the place of the program: in a folder `plots` or
/// `share/mesofit/plots` of the program's folder or of any folder above it. A failure is worth a
/// warning and no more: the tables are there, and the figures can be drawn later.
#pragma once

#include "base/status.h"

#include <stdbool.h>

/// Draw every figure whose tables are in `folder`, to figures/<name>.svg and .png in it.
/// IO with one line if gnuplot is missing or a figure fails; the others are drawn all the same.
/// Threads: one at a time, since the environment is changed. Tested: test_figures.
enum status mf_figures_draw(const char *folder) MUST_USE;

/// The same for a person who asks for them, in the folder of a run: figures that are of the run and
/// that nobody has changed are replaced, others with `force` alone. BAD_INPUT if there is no table
/// to draw. Tested: test_bad_lines_are_refused_with_a_hint, test_tracked_files.
enum status mf_figures_draw_again(const char *folder, bool force) MUST_USE;

/// Draw figures/compare.svg and .png, and compare_dynamics if there are E or VACF, from the tables
/// that mf_compare_folders wrote to `folder`.
enum status mf_figures_draw_comparison(const char *folder) MUST_USE;

/// Draw the figure of a table of `mesofit bench accuracy` or `stability`, folder/NAME.tsv, with the
/// script of that name to folder/figures/NAME.svg and .png. Tested: test_bench_accuracy.
enum status mf_figures_draw_table(const char *table, const char *script);

/// Refuse to replace one that is there. Fails: BAD_INPUT.
enum status mf_figures_check_table(const char *table) MUST_USE;
