// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the program says to a person.
///
/// Texts of files, folders and command lines may be anything, and a terminal obeys control
/// characters: it changes its title, its clipboard, what stands on it. So all that any part of the
/// program prints goes through one place, where they are shown like \x1b; ends of lines and tabs
/// alone stay.
#pragma once

#include "base/status.h"

#include <stdio.h>

/// From now on stdout and stderr are such streams. Fails: NO_MEMORY. Tested: test_escapes.
enum status mf_terminal_begin(void) MUST_USE;

struct terminal {
    int file;
    char begun[4]; ///< a character whose end has not been printed yet
    size_t size;
};

/// A stream that shows what is printed into it on an open file, which stays the caller's, as the
/// memory of `terminal` does until the stream is closed; NULL without memory. Tested:
/// test_terminal.
FILE *mf_terminal_open(struct terminal *terminal, int file);

/// Empty the line of stderr that the cursor is in, for one that changes. Of a terminal alone.
void mf_terminal_clear_line(void);
