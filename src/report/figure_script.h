// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One figure, drawn by gnuplot with one of the scripts in plots/.
#pragma once

#include "base/status.h"
#include "io/output.h"
#include "report/program.h"

enum { FIGURE_SCRIPT_PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

/// Find the folder of the scripts. Fails: IO.
enum status mf_figure_script_find(char plots[FIGURE_SCRIPT_PATH_SIZE]) MUST_USE;

/// Draw figures/`figure`.svg and .png in `folder` with the script `plots`/`script`.gp, which finds
/// the names of the table and of the figure in MESOFIT_TABLE and MESOFIT_FIGURE, and what the names
/// of its files end with while it is drawn in MESOFIT_PARTIAL. A figure that fails is not there at
/// all. Fails: IO with one line, NO_MEMORY; as mf_tracked_files_claim. Tested: test_figures.
enum status mf_figure_script_draw(const char *folder, const char *plots, const char *script,
                                  const char *table, const char *figure) MUST_USE;

/// Run a script that makes files of its own, in `folder`. It is stopped after so many seconds, and
/// what it prints is heard.
/// Fails: IO with one line, NO_MEMORY. Tested: cli/test_film.
enum status mf_figure_script_run(const char *folder, const char *plots, const char *script,
                                 double seconds, const struct program_ear *ear) MUST_USE;
