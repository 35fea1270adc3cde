// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a field is, in words, for all that tell of it.
#pragma once

#include "base/fields.h"

#include <stddef.h>

/// The type of a field, such as "number", or its choices, "a|b".
void mf_fields_type_text(const struct field *field, char *text, size_t size);

/// The default of a field, "none" or "required".
void mf_fields_default_text(const struct field *field, char *text, size_t size);
