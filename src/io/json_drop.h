// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Take out of a document what is not to be read.
#pragma once

#include "io/json.h"

/// Take the member `key` out of the object `parent.child` of `root`, and the child, too, if nothing
/// else is in it. What is not there is fine.
void mf_json_drop(const struct json_object *root, const char *parent, const char *child,
                  const char *key);
