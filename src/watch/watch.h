// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit watch`: a run's folder on a terminal, drawn again when its tables change.
#pragma once

#include "base/status.h"

#include <stdio.h>

/// Show the folder until the key q or Ctrl-C. Fails: IO if there is no such folder; BAD_INPUT
/// without a terminal; NO_MEMORY. Tested: tests/live/test_watch.py.
enum status mf_watch(const char *folder) MUST_USE;

/// One screen of so many characters, its lines ended by `end`: a line about the run, one about how
/// far it is if it works for some time, then plots of the tables that are there. Fails: NO_MEMORY.
enum status mf_watch_write(const char *folder, int columns, int rows, const char *end,
                           FILE *stream) MUST_USE;
