// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What stands at the top of every scene and run file.
#pragma once

#include "base/fields.h"

struct heading {
    char title[FIELD_TEXT_SIZE];
    uint64_t seed;
};

extern const struct field heading_fields[];
