// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Arrays that grow as elements come.
#pragma once

#include "base/memory.h"

/// Make room for `wanted` elements of `size` bytes in an array of which the first `used` stay: at
/// least twice the room that there is, or that of `first`, so that it is made seldom.
/// @param[in,out] array     the address of the pointer to the array, which may be NULL
/// @param[in,out] capacity  of elements, 0 if the array is NULL
/// Fails: NO_MEMORY; all is then as before. Tested: test_growing.
enum status mf_growing_reserve(void *array, size_t *capacity, size_t used, size_t wanted,
                               size_t size, size_t first) MUST_USE;
