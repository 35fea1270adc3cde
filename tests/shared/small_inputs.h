// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Small input files for tests of the program: a DPD fluid of 81 particles, and an IMC fit of
/// a made-up target.
#pragma once

#include "shared/temporary_folder.h"

/// cmocka setup and teardown: a temporary folder, and the working folder inside it, so that tests
/// name files and results as "scene.json" and "out".
int small_inputs_enter(void **state);
int small_inputs_enter_without_gnuplot(void **state); ///< figures would take most of the time
int small_inputs_leave(void **state);

/// Skip the test if the program cannot draw.
void small_inputs_need_gnuplot(void);

extern const char small_inputs_scene[];
extern const char small_inputs_run[];    ///< names target.tsv beside it
extern const char small_inputs_target[]; ///< for target.tsv

/// Write `text` to the file `name`, its first `from` replaced by `to`; `from` NULL: as it is.
void small_inputs_write(struct temporary_folder *folder, const char *name, const char *text,
                        const char *from, const char *to);

/// Replace `from` by `to` in a file that is there.
void small_inputs_change(struct temporary_folder *folder, const char *name, const char *from,
                         const char *to);
