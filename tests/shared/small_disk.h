// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A disk that is full soon, in a name space of the test's process alone.
#pragma once

#include <stdbool.h>

/// Mount a file system of so many pages of 4096 bytes at an empty folder; false where the system
/// does not let us.
bool small_disk_mount(const char *path, int pages);
void small_disk_grow(const char *path, int pages);
void small_disk_unmount(const char *path);

/// Fill it but for so many pages, by the file "filler" in it.
void small_disk_fill(const char *path, int pages);
