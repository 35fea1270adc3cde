// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests about files: list, read, write, download.
#include "live/live_routes.h"

#include "live/live_folder.h"
#include "live/live_zip.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Types of what a browser shows; the rest is text.
static const struct {
    const char *end, *type;
} types[] = {{".json", "application/json"},
             {".png", "image/png"},
             {".svg", "image/svg+xml"},
             {".bin", "application/octet-stream"}};

static const char *find_type(const char *path) {
    const char *end = strrchr(path, '.');
    for (size_t k = 0; end && k < sizeof types / sizeof *types; k++)
        if (strcmp(end, types[k].end) == 0)
            return types[k].type;
    return "text/plain; charset=utf-8";
}

/// The path of a request, "" without one.
static const char *find_path(const struct live_request *request) {
    const char *path = mf_live_server_argument(request, "path");
    return path ? path : "";
}

static int find_root(struct live_view *view, const struct live_request *request) {
    return mf_live_view_root(view, mf_live_server_argument(request, "in"));
}

/// What is written about a path into a stream, in memory: `bytes` is to be freed with free().
static enum status collect(struct live_view *view, const struct live_request *request,
                           enum status (*write)(int root, const char *path, FILE *stream),
                           char **bytes, size_t *size) {
    const int root = find_root(view, request);
    if (root < 0)
        return STATUS_IO;
    FILE *stream = open_memstream(bytes, size);
    enum status status = stream ? write(root, find_path(request), stream)
                                : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    close(root);
    if (stream && fclose(stream) != 0 && status == STATUS_OK)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    if (status != STATUS_OK) {
        free(*bytes);
        *bytes = NULL;
    }
    return status;
}

static enum status list(struct live_view *view, const struct live_request *request,
                        struct live_answer *answer) {
    char *text = NULL;
    size_t size;
    TRY(collect(view, request, mf_live_folder_list, &text, &size));
    return mf_live_routes_give(answer, "application/json", text);
}

static enum status read_file(struct live_view *view, const struct live_request *request,
                             struct live_answer *answer) {
    const char *path = find_path(request);
    const int root = find_root(view, request);
    if (root < 0)
        return STATUS_IO;
    answer->file = mf_live_folder_read(root, path, &answer->size);
    close(root);
    if (answer->file < 0) {
        answer->file = 0;
        return STATUS_IO;
    }
    answer->type = find_type(path);
    return STATUS_OK;
}

/// Into the working folder alone: results are the program's.
static enum status write_file(struct live_view *view, const struct live_request *request,
                              struct live_answer *answer) {
    const char *replace = mf_live_server_argument(request, "replace");
    const int root = mf_live_view_root(view, NULL);
    if (root < 0)
        return STATUS_IO;
    const enum status status =
        mf_live_folder_write(root, find_path(request), request->body, request->size,
                             replace && strcmp(replace, "1") == 0);
    close(root);
    TRY(status);
    return mf_live_routes_give(answer, NULL, strdup("written"));
}

static enum status zip(struct live_view *view, const struct live_request *request,
                       struct live_answer *answer) {
    char *bytes = NULL;
    TRY(collect(view, request, mf_live_zip_write, &bytes, &answer->size));
    answer->type = "application/zip";
    answer->name = "results.zip";
    answer->bytes = bytes;
    return STATUS_OK;
}

const struct live_route mf_live_routes_files[] = {
    {"/api/files", false, list},
    {"/api/file", false, read_file},
    {"/api/file", true, write_file},
    {"/api/zip", false, zip},
    {NULL, false, NULL},
};
