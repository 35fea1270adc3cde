// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Texts and numbers of unknown origin in messages for a person.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// Bytes that the longest character is shown as.
enum { VISIBLE_MAX = 8 };

/// Bytes of the character of UTF-8 (RFC 3629) that these bytes begin with; 0 if it is none.
size_t mf_visible_character(const char *text, size_t size);

/// Whether these bytes may be the beginning of a character of UTF-8 that is longer.
bool mf_visible_is_begun(const char *text, size_t size);

/// How a character is shown: as it is, or if a terminal took it as a command like \x1b. Those are
/// the control characters of ASCII, of ISO 6429 (U+0080 to U+009F), and bytes that are no UTF-8.
/// @param[in] size  of the text, above 0
/// @param[in] kept  control characters that stay, as "\n"
/// @param[out] taken  bytes of the text that are shown
/// Returns how many bytes of `shown` they are shown as.
size_t mf_visible_show(const char *text, size_t size, const char *kept, char shown[VISIBLE_MAX],
                       size_t *taken);

/// Copy a text as it is shown; one that does not fit is cut.
/// Tested: test_visible.
void mf_visible_copy(char *copy, size_t size, const char *text, const char *kept);

/// The number, or NaN without the sign that it happens to carry: printf would show it.
double mf_visible_number(double number);
