// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lists in a parsed document. Items are those of cJSON. Tested: test_json.
#pragma once

#include "io/json.h"

/// A list of at least one choice of a field as a set, a bit each; false and a fault otherwise.
bool mf_json_list_choices(struct json_object *object, const struct field *field, const void *item,
                          int *chosen);
