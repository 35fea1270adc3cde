// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The locale de_DE.UTF-8, made for one test where its sources are (Debian: locales).
#pragma once

#include "shared/temporary_folder.h"

/// Make it in the folder and set LOCPATH; false if there is nothing to make it of, which is said.
bool german_make(const struct temporary_folder *folder);
