// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Completions of a command line in bash: subcommands, options and their choices, names that
/// `describe` knows, run and scene files, folders of runs. Tested: test_completion.
#pragma once

#include "app/cmd_describe.h"

#include <stdio.h>

/// Print the script that bash loads.
void mf_completion_print(FILE *stream, const struct topic *topics, size_t count);
