// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The known name that a mistyped one was probably meant to be.
#pragma once

#include <stddef.h>

/// Entry of `known` with the fewest edits (insert, delete, replace, swap neighbours) from `given`;
/// another case of letters is none. If even the nearest differs in more than a third of its
/// letters, the only one that begins so, as "sim" of "simulate", or NULL. Tested: test_nearest.
/// @param[in] known  shape [count]
const char *mf_nearest_name(const char *given, const char *const *known, size_t count);

/// Print `did you mean "seed"?`, or `known: a, b, c` when nothing is near, into `text`.
void mf_nearest_hint(const char *given, const char *const *known, size_t count, char *text,
                     size_t size);
