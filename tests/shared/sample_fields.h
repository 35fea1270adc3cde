// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A struct with a member of every type that a field table knows, and its table.
#pragma once

#include "base/fields.h"

struct sample {
    double strength;
    int64_t steps;
    uint64_t seed;
    double lengths[3];
    char name[FIELD_TEXT_SIZE], file[FIELD_TEXT_SIZE];
    int kind, kinds;
};

/// Choices of `kind` and of the set `kinds`, NULL-terminated.
extern const char *const sample_kinds[];

extern const struct field sample_fields[];
