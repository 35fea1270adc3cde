// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The lines of a GROMACS topology as its preprocessor leaves them: without comments, joined
/// where they end with a backslash, with included files, by #ifdef, with defined words replaced.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

enum { GROMACS_LINE_SIZE = 4096, GROMACS_PATH_SIZE = 1024 };

/// A line that is not empty, and where it stands.
struct gromacs_line {
    const char *file;
    size_t number; ///< from 1 on
    char text[GROMACS_LINE_SIZE];
};

/// BAD_INPUT, "file:line: …".
enum status mf_gromacs_fail(const struct gromacs_line *line, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// Who takes lines, one after the other; the text may be changed.
typedef enum status gromacs_take(void *context, struct gromacs_line *line);

/// Read a file and all that it includes, at most 16 files deep and 256 of them. Included files are
/// looked for where the file is that includes them, then where GROMACS has its own.
/// Fails: as `take`; BAD_INPUT with file and line for an #include that is not there or endless, an
/// #else or #endif without its #ifdef, a line or a word that is too long; IO; NO_MEMORY.
/// Tested: cli/test_topologies.
enum status mf_gromacs_text_read(const char *file, gromacs_take *take, void *context) MUST_USE;
