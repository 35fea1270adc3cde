// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The server: HTTP on 127.0.0.1 for one page, by libmicrohttpd.
///
/// It checks the client (live_guard.h) and the size of its request, and passes requests to an
/// answerer, which several threads call at once. Without libmicrohttpd at build time there is none,
/// and starting it says how to get it. Tested: test_live_server.
#pragma once

#include "base/status.h"
#include "live/live_guard.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Bytes of a request's body, and seconds of silence until a connection is dropped.
enum { LIVE_SERVER_LARGEST = 16 << 20, LIVE_SERVER_PATIENCE = 30 };

/// A request that may be answered.
struct live_request {
    const char *path;
    bool post;
    const char *body; ///< of `size` bytes and a NUL
    size_t size;
    void *connection;
};

/// The value of an argument after the "?", decoded, or NULL.
const char *mf_live_server_argument(const struct live_request *request, const char *name);

/// Pieces of a stream without an end: the next one, to be freed with free(), or NULL at the end. It
/// may wait.
struct live_stream {
    void *context;
    char *(*next)(void *context);
    void (*close)(void *context);
};

/// An answer: zeros but for what there is.
struct live_answer {
    unsigned code;        ///< 0: 200
    const char *type;     ///< of the contents; NULL: plain text
    const char *name;     ///< to save it under, or NULL; borrowed until it is sent
    const void *constant; ///< contents of `size` bytes that stay,
    void *bytes;          ///< or that are freed with free(),
    int file;             ///< or an open file's, closed then; 0: none
    size_t size;
    struct live_stream stream; ///< or a stream's
    uint64_t serial;           ///< of the contents, in the head; 0: none
};

/// Who answers. `open` says whether the path needs no token.
struct live_answerer {
    void *context;
    bool (*open)(void *context, const struct live_request *request);
    void (*answer)(void *context, const struct live_request *request, struct live_answer *answer);
};

struct live_server {
    const char *token;
    struct live_answerer answerer;
    int port; ///< that it listens on
    struct live_clients clients;
    void *daemon; ///< of libmicrohttpd
};

/// Listen on a port of 127.0.0.1; 0: any that is free. Fails: IO if it is taken; BAD_INPUT if this
/// program was built without a server.
enum status mf_live_server_start(struct live_server *server, int port) MUST_USE;

/// Wait for the end of all answers. Streams must have come to an end.
void mf_live_server_stop(struct live_server *server);
