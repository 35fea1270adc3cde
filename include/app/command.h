// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A subcommand of the program: one record, one file.
#pragma once

#include "run/run_folder.h"

#include <stddef.h>

enum { COMMAND_MAX_FILES = 64 };

/// The command line after the subcommand, parsed.
struct command_line {
    struct run_options options;
    const char *files[COMMAND_MAX_FILES];
    size_t file_count;
};

struct command {
    const char *name;
    const char *usage;   ///< arguments, such as "SCENE.json"
    const char *summary; ///< one line
    size_t least_files, most_files;
    enum status (*run)(const struct command_line *line);
};

extern const struct command cmd_simulate, cmd_fit, cmd_plot, cmd_compare, cmd_describe;
