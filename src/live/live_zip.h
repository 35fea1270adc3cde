// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A folder as one zip file, its members stored as they are: PKWARE's APPNOTE.TXT 6.3, 4.3.
#pragma once

#include "base/status.h"

#include <stdio.h>

/// Files of a folder and of the folders in it as a zip file, on a stream.
/// @param[in] root  an open folder; `path` beneath it, as of live_folder.h
/// Fails: BAD_INPUT if the path is not plain, or they are too many or too large (256 MiB); IO.
/// Tested: test_live_folder.
enum status mf_live_zip_write(int root, const char *path, FILE *stream) MUST_USE;
