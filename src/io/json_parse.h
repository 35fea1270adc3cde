// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From a text to cJSON's tree, or to the words that say what is wrong with the text.
#pragma once

#include "base/status.h"

struct cJSON;

/// Parse one JSON value with nothing after it. What cJSON reads beyond RFC 8259 (01, 1., -.5, line
/// breaks in texts) keeps its value and is let through; what it would cut without a word, a text at
/// an escaped NUL, is refused.
/// @param[out] root  to be freed with cJSON_Delete; NULL on failure
/// Fails: NO_MEMORY; BAD_INPUT with "file:line:column: expected …, found …". Tested:
/// test_json_parse.
enum status mf_json_parse(const char *file, const char *text, struct cJSON **root) MUST_USE;
