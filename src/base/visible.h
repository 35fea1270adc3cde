// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Texts and numbers of unknown origin in messages for a person.
#pragma once

#include <stddef.h>

/// Copy a text, with control characters as "\x1b": on a terminal they would be commands. Those of
/// ASCII, of ISO 6429 (U+0080 to U+009F), and no others; a text that does not fit is cut.
/// @param[in] kept  control characters that stay, as "\n"
/// Tested: test_visible.
void mf_visible_copy(char *copy, size_t size, const char *text, const char *kept);

/// The number, or NaN without the sign that it happens to carry: printf would show it.
double mf_visible_number(double number);
