// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What killed processes had begun to write in a folder that has a list of its files.
#pragma once

#include "io/manifest.h"

/// Remove what they had begun of the files of a list, in the folder and in those that it names.
void mf_partial_file_remove(const struct manifest *list);
