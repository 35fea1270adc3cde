// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Other programs: start one, wait for its end, keep what it says; and the files of this one.
#pragma once

#include "base/status.h"

#include <stdatomic.h>
#include <stddef.h>

/// What to keep of what a program says.
enum program_says {
    PROGRAM_ERRORS,     ///< stderr; stdout goes nowhere
    PROGRAM_EVERYTHING, ///< both, as they come
};

/// Run words[0], found in PATH, with `words`, NULL-terminated, in `folder`, without input, under
/// the locale C.UTF-8: what it writes does not depend on the user's language.
/// @param[in] seconds  it is stopped, with all that it has started, if it takes longer; 0: any time
/// @param[out] text  the last size − 1 bytes of what it says
/// @param[in]  size  above 512
/// Fails: NO_MEMORY; IO with one line that names the program: not installed, ended by a signal,
/// stopped as too slow, or failed with the last line that it said. Tested: test_program.
enum status mf_program_run(const char *folder, const char *const *words, enum program_says says,
                           double seconds, char *text, size_t size) MUST_USE;

/// Who hears what a program says, while it runs.
struct program_ear {
    void (*hear)(void *context, const char *text); ///< all of it so far, as far as it is kept
    void *context;
};

/// The same, heard. @param[in] ear  NULL: nobody hears
enum status mf_program_hear(const char *folder, const char *const *words, enum program_says says,
                            double seconds, const struct program_ear *ear, char *text,
                            size_t size) MUST_USE;

/// Run a command as its user would type it, words[0], with the words after it, in `folder`. It is
/// stopped, with all that it has started, if the user asks this program to stop or `cancel` is set,
/// and told to end if this program ends. What it says is kept, both streams.
/// Fails: as mf_program_run; INTERRUPTED. Tested: test_program.
enum status mf_program_command(const char *folder, const char *const *words,
                               const atomic_bool *cancel, char *text, size_t size) MUST_USE;

/// Find a folder that ships with this program, such as "plots", by a file that it must have.
///
/// A program that is being built lies one or more folders below the source tree; one that is
/// installed lies in bin beside share: `name` or `share/mesofit/name`, in the program's folder or
/// in any folder above it.
/// @param[out] path  of `size` bytes
/// Fails: IO. Tested: test_program.
enum status mf_program_find_folder(char *path, size_t size, const char *name,
                                   const char *file) MUST_USE;

/// Begin this program again, with other waiting: threads of libgomp wait for each other turning in
/// circles, for so long that two of them on busy cores are 15 to 60 times slower than one. A
/// thousand turns, a dozen microseconds, bridge what one thread of an idle machine is behind
/// another; then they sleep. libgomp reads this when it is loaded, so the program begins again,
/// once, unless the user has chosen. Without /proc it goes on as it is. Tested: test_waiting;
/// measured by tests/bench/busy_cores.sh.
void mf_program_begin_again(char **words);
