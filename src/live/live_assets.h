// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The page's files, which are in the program: share/live, and Chart.js of Debian.
#pragma once

struct live_asset {
    const char *path; ///< "/style.css"
    const char *type; ///< of its contents
    const unsigned char *bytes, *end;
};

/// The file at a path, or NULL.
const struct live_asset *mf_live_assets_find(const char *path);
