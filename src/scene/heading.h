// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What stands at the top of every scene and run file.
#pragma once

#include "base/fields.h"
#include "io/json.h"

struct heading {
    char title[FIELD_TEXT_SIZE];
    uint64_t seed;
};

extern const struct field mf_heading_fields[];

/// A run file has a "scene" and a "target"; what is no run file and has a "box" is a scene file.
/// One line that says which command takes it, instead of a fault for each key. Fails: BAD_INPUT.
/// Tested: test_bad_input.
enum status mf_heading_check_scene(const struct json_object *root, const char *file) MUST_USE;
enum status mf_heading_check_run(const struct json_object *root, const char *file) MUST_USE;
