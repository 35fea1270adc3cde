// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All subcommands of the program, and what --help says of them.
#pragma once

#include "commands/command.h"

/// An option as it is written: "-o DIR", "--live[=PORT]".
const char *mf_command_option_text(const struct command_option *option,
                                   char text[COMMAND_OPTION_SIZE]);

extern const struct command cmd_live, cmd_plot, cmd_film, cmd_compare, cmd_describe, cmd_bench;

/// All subcommands, in the order of --help, up to NULL.
extern const struct command *const mf_command_list[];

/// What the program is for, and what its exit codes mean: for --help and for the man page.
extern const char mf_command_purpose[], mf_command_exit_codes[];

void mf_command_print_help(void);

/// What the program says without words: the three commands of a first day.
void mf_command_print_first(void);

/// What a single subcommand takes.
void mf_command_print_own_help(const struct command *command);

/// What --live of commands that run something does.
enum status mf_cmd_live_run(const char *file, const struct run_options *options,
                            const char *port) MUST_USE;
