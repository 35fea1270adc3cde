// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The tables of a finished fit or simulation, read back.
#pragma once

#include "report/result.h"

#include <stdbool.h>

/// Read the tables of `folder` as far as they are there; those of a fit's course have to be.
/// Fails: BAD_INPUT or IO with one line that names the file. Tested: test_compare.
enum status mf_result_tables_read(struct result *result, const char *folder,
                                  bool simulated) MUST_USE;
