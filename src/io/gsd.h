// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Layout of GSD files (gsd.readthedocs.io, file layer): bytes of the head, of an entry of
/// the index and of a name, and the types of numbers.
#pragma once

enum { GSD_HEAD = 256, GSD_ENTRY = 32, GSD_NAME = 64 };

enum gsd_type {
    GSD_UINT8 = 1,
    GSD_UINT32 = 3,
    GSD_UINT64 = 4,
    GSD_INT8 = 5,
    GSD_INT32 = 7,
    GSD_FLOAT = 9,
    GSD_CHARACTER = 11
};
