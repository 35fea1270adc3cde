// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a JSON file lacks, put into its text before it is read.
#pragma once

#include "io/json.h"
#include "base/status.h"

#include <stddef.h>

struct json_filling {
    const char *key;
    double value;
    const char *text; ///< in place of the number; NULL: the number
};

/// The text of a file with these put into one of its objects, which is made if it is missing, or
/// with `object` NULL at its top; the caller frees it (mf_memory_free). Fails: BAD_INPUT as
/// mf_json_open, or if the object has one of the keys itself; IO; NO_MEMORY. Tested:
/// cli/test_fit_target.
enum status mf_json_fill(const char *file, const char *object, const struct json_filling *filling,
                         size_t count, char **text) MUST_USE;
