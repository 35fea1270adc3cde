// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the server answers: a table of paths, one function each. docs/cluster-and-live.md
/// lists them.
#pragma once

#include "live/live_server.h"
#include "live/live_view.h"

#include <stdio.h>

/// Answers from a view, which lives as long as the server.
struct live_answerer mf_live_routes(struct live_view *view);

/// A request of one path. Messages of a status that is not OK become the answer.
struct live_route {
    const char *path;
    bool post;
    enum status (*answer)(struct live_view *view, const struct live_request *request,
                          struct live_answer *answer);
};

/// Those about files, up to one without a path.
extern const struct live_route mf_live_routes_files[];

/// An answer of bytes that are freed with free().
enum status mf_live_routes_give(struct live_answer *answer, const char *type, char *bytes) MUST_USE;

/// Files of a folder and of the folders in it as a zip file, its members stored as they are
/// (PKWARE's APPNOTE.TXT 6.3, 4.3), on a stream.
/// @param[in] root  an open folder; `path` beneath it, as of live_folder.h
/// Fails: BAD_INPUT if the path is not plain, or they are too many or too large (256 MiB); IO.
/// Tested: test_live_folder.
enum status mf_live_zip_write(int root, const char *path, FILE *stream) MUST_USE;
