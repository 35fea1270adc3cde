// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that are read.
#pragma once

#include "base/status.h"

#include <stdio.h>

/// Open a file or a pipe for reading. Fails: IO if it cannot be read, or is a folder, a device or a
/// socket: a device such as /dev/zero has no end. Tested: test_data_table, test_checkpoint.
enum status input_open(FILE **stream, const char *file) MUST_USE;
