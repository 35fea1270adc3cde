// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The program from outside: start it with some words, catch what it says.
///
/// The environment variable MESOFIT is the path of the program, from the root. Both streams are
/// pipes, so that a limit on the size of files does not reach them.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// How to run it; zeros are the plain way. Its time is the processor time of all its threads: what
/// a test does is the same on a busy machine.
struct run_program_how {
    long largest_file;         ///< RLIMIT_FSIZE of the program [bytes]; 0: none
    int interrupt_with;        ///< signal that it is sent; 0: none
    double interrupt_after;    ///< when it has worked so long since its first words [s]
    bool interrupt_from_start; ///< count that time from its start
    double work_limit;         ///< the test fails if it works longer [s]; 0: five minutes
};

struct run_program_result {
    int code;       ///< exit code, or −n if it died of signal n
    double seconds; ///< that it took, by the clock on the wall
    double worked;  ///< processor time [s]
    char out[65536], err[65536];
};

/// Run the program with `words`, NULL-terminated, and wait for its end. A text that does not fit, a
/// program that cannot be started, and one that has not worked at all for ten minutes fail the
/// test.
void run_program(struct run_program_result *result, const struct run_program_how *how,
                 const char *const *words);

/// run_program the plain way: RUN_PROGRAM(&result, "simulate", file).
#define RUN_PROGRAM(result, ...)                                                                   \
    run_program((result), &(struct run_program_how){0}, (const char *const[]){__VA_ARGS__, NULL})

/// The folder of the sources, above that of the program, however deep in it the build is.
const char *run_program_sources(void);

/// The program ended with `expected`; its words are shown if not.
void run_program_assert_code(const struct run_program_result *result, int expected);

/// There is no *.partial in `folder` and its folders.
void run_program_assert_no_partial(const char *folder);

/// The program refused: exit code 2, nothing on stdout, `lines` lines on stderr that begin with
/// "mesofit: " and contain each of `words`, and in `folder` no *.partial and no summary.json.
/// @param[in] what  names the case when the check fails
void run_program_assert_refused(const struct run_program_result *result, const char *folder,
                                const char *what, size_t lines, const char *const *words);

/// Run with `words`, interrupt it soon after its first words, go on with --resume for twice as
/// long, and so on until it ends by itself; its exit code must be `code`. A program that is done
/// before the first signal gets the signal sooner. Returns how many runs were interrupted, at least
/// one.
int run_program_in_pieces(int code, const char *const *words);

/// Lines of a text; one without an end counts too.
size_t run_program_lines(const char *text);
