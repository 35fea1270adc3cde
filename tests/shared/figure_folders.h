// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Folders of tables below one temporary root, and the figures that are drawn of them.
#pragma once

#include <stdbool.h>

enum { FIGURE_PATH = 512 };

/// @name Tables as runs write them: rdf.tsv and history.tsv of a fit, and its timing.tsv.

extern const char figure_folders_fit_rdf[], figure_folders_imc_history[], figure_folders_timing[];

/// @name For cmocka_run_group_tests: make the root, and remove it with all that is in it.

int figure_folders_begin(void **state);
int figure_folders_end(void **state);

/// Path of the root.
const char *figure_folders_root(void);

/// A new folder of that name below the root, for the caller's `path`.
void figure_folders_make(char path[FIGURE_PATH], const char *name);

void figure_folders_write(const char *folder, const char *name, const char *text);

/// Draw all figures of a folder; none fails.
void figure_folders_draw(const char *folder);

/// True if the figure has that word: a legend, say.
bool figure_folders_print(const char *folder, const char *name, const char *word);

/// Both files of a figure are there, and no text of it is a piece of its script.
bool figure_folders_drawn(const char *folder, const char *name);

void figure_folders_skip_without_gnuplot(void);
