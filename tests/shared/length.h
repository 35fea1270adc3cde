// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tests that have a longer form, for `make check-long`: more cases, longer runs, targets
/// that are made again. The short form, in every other run, is of the same subject, and would find
/// the faults that the test is there for.
#pragma once

#include "shared/testing.h"

#include <stdbool.h>

/// Whether this is the longer form, by the environment variable LONG.
bool length_is_long(void);

/// A case of the longer form alone, for cmocka_unit_test and its like.
#define LENGTH_ONLY_LONG(...) length_only_long((struct CMUnitTest)__VA_ARGS__)

struct CMUnitTest length_only_long(struct CMUnitTest test);
