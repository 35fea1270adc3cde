// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A JSON Schema (draft 7) of run files, scene files and maps, made of their field tables: by
/// it editors complete keys and mark what is unknown. What rests on other numbers of the file, or
/// on its units, is left to the program. Tested: test_schema (python/tests).
#pragma once

#include "app/cmd_describe.h"
#include "base/status.h"

#include <stdio.h>

/// Print it whole. Fails: NO_MEMORY, IO.
enum status mf_schema_print(FILE *stream, const struct topic *topics, size_t count) MUST_USE;
