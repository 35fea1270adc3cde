// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A subcommand: one record, one file. Those in this room are of the program and of the
/// library, the rest of the program alone (app/commands.h).
#pragma once

#include "report/run_folder.h"

#include <stddef.h>

enum { COMMAND_MAX_OPTIONS = 32, COMMAND_MAX_COMMANDS = 16, COMMAND_OPTION_SIZE = 64 };

/// An option of one subcommand. It may take the place of a common one.
struct command_option {
    const char *name; ///< such as "--json"
    /// What it takes, such as "FILE", choices such as "a|b", "[=PORT]" for what may follow its name
    /// in the same word, or NULL.
    const char *value;
    const char *help; ///< one line
};

/// What --live takes, of commands that run something.
#define COMMAND_LIVE_OPTION                                                                        \
    { "--live", "[=PORT]", "show the run in a browser, at the printed address" }

/// Run a scene or run file beside a page.
/// @param[in] port  the option's value, or its name: any port
/// Fails: as the run; BAD_INPUT, IO as the server.
typedef enum status command_live(const char *file, const struct run_options *options,
                                 const char *port);

/// The command line after the subcommand, parsed.
struct command_line {
    struct run_options options;
    command_live *live; ///< NULL: there is nobody who serves pages, or reads what is printed
    const char **files; ///< shape [file_count], owned
    size_t file_count;
    /// Of each of the subcommand's own options its value, or its name if it takes none; NULL if it
    /// was not given.
    const char *own[COMMAND_MAX_OPTIONS];
};

struct command {
    const char *name;
    const char *usage;                    ///< arguments, such as "SCENE.json"
    const char *summary;                  ///< one line
    size_t min_files, max_files;          ///< SIZE_MAX: any number
    const struct command_option *options; ///< its own, up to one without a name; NULL: none
    int threads;                          ///< unless --threads says more; 0: all processors
    enum status (*run)(const struct command_line *line);
};

extern const struct command mf_command_measure, mf_command_fit, mf_command_export,
    mf_command_simulate, mf_command_import;

/// Options that every subcommand takes, up to one without a name.
extern const struct command_option mf_command_common[];

/// The command of a list, up to NULL, that has this name. Fails: BAD_INPUT with the nearest one.
enum status mf_command_find(const struct command *const *list, const char *name,
                            const struct command **command) MUST_USE;

/// Take the words behind a command's name, which are borrowed, into a line that may have been
/// begun. Fails: BAD_INPUT with the line that the program prints; NO_MEMORY.
enum status mf_command_parse(const struct command *command, size_t count, const char *const *words,
                             struct command_line *line) MUST_USE;
void mf_command_line_clear(struct command_line *line);

/// Take the value of --box, three lengths or one of a cube; NULL leaves it alone. Fails: BAD_INPUT.
enum status mf_command_read_box(const char *text, double box[3]) MUST_USE;

/// Refuse an option of a line whose words go nowhere, and pages that nobody serves.
enum status mf_command_check_live(const struct command_line *line, const char *option) MUST_USE;
