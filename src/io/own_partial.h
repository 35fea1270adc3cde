// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What killed processes had begun to write in a folder that has a list of its files.
#pragma once

#include "io/own_list.h"

/// Remove what they had begun of the files of a list, in the folder and in those that it names.
void mf_own_partial_remove(const struct own_list *list);
