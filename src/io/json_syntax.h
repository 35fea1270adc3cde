// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Is a text JSON, and if not, where?
///
/// cJSON lets through what RFC 8259 forbids (01, 1., line breaks in texts) and cuts a text at an
/// escaped NUL without a word; its error position may be a character late and has no reason.
#pragma once

#include "base/status.h"

/// Check that `text` is one JSON value of RFC 8259 and nothing after it.
/// BAD_INPUT with "file:line:column: expected …, found …". Tested: test_json_syntax.
enum status mf_json_syntax_check(const char *file, const char *text) MUST_USE;
