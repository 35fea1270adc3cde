// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A subcommand of the program: one record, one file.
#pragma once

#include "report/run_folder.h"

#include <stddef.h>

enum {
    COMMAND_MAX_FILES = 64,
    COMMAND_MAX_OPTIONS = 24,
    COMMAND_MAX_COMMANDS = 16,
    COMMAND_OPTION_SIZE = 64
};

/// An option of one subcommand. It may take the place of a common one.
struct command_option {
    const char *name; ///< such as "--json"
    /// What it takes, such as "FILE", choices such as "a|b", "[=PORT]" for what may follow its name
    /// in the same word, or NULL.
    const char *value;
    const char *help; ///< one line
};

/// The command line after the subcommand, parsed.
struct command_line {
    struct run_options options;
    const char *files[COMMAND_MAX_FILES];
    size_t file_count;
    /// Of each of the subcommand's own options its value, or its name if it takes none; NULL if it
    /// was not given.
    const char *own[COMMAND_MAX_OPTIONS];
};

struct command {
    const char *name;
    const char *usage;   ///< arguments, such as "SCENE.json"
    const char *summary; ///< one line
    size_t min_files, max_files;
    const struct command_option *options; ///< its own, up to one without a name; NULL: none
    int threads;                          ///< unless --threads says more; 0: all processors
    enum status (*run)(const struct command_line *line);
};

/// An option as it is written: "-o DIR", "--live[=PORT]".
const char *mf_command_option_text(const struct command_option *option,
                                   char text[COMMAND_OPTION_SIZE]);

extern const struct command cmd_measure, cmd_fit, cmd_export, cmd_simulate, cmd_live, cmd_plot,
    cmd_film, cmd_compare, cmd_describe, cmd_bench;

/// All subcommands, in the order of --help, up to NULL.
extern const struct command *const mf_command_list[];

/// Options that every subcommand takes, up to one without a name.
extern const struct command_option mf_command_common[];

/// What the program is for, and what its exit codes mean: for --help and for the man page.
extern const char mf_command_purpose[], mf_command_exit_codes[];

void mf_command_print_help(void);

/// What a single subcommand takes.
void mf_command_print_own_help(const struct command *command);
