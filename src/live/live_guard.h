// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Who may use the server: whoever knows the token, from a page of the server's own.
///
/// A page of another site can make a browser send requests to this machine. It does not know the
/// token; its Origin is its own; and if it has made its name point here (DNS rebinding), the Host
/// is that name. Tested: test_live_guard.
#pragma once

#include "base/status.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// 128 random bits as hexadecimal digits.
enum { LIVE_TOKEN_SIZE = 33 };

/// A new token. Fails: IO if the system gives no random bits.
enum status mf_live_guard_make_token(char token[LIVE_TOKEN_SIZE]) MUST_USE;

/// Whether what was given is the token, in a time that does not depend on where they differ.
/// @param[in] given  NULL: nothing
bool mf_live_guard_is_token(const char token[LIVE_TOKEN_SIZE], const char *given);

/// Whether a Host is a name of this machine's loopback, 127.0.0.1 or localhost, with any port: an
/// ssh tunnel may have another one.
bool mf_live_guard_is_host(const char *host);

/// Whether an Origin is the page that Host serves; NULL, as with requests of the page by GET, is.
bool mf_live_guard_is_origin(const char *origin, const char *host);

/// Connections at one time, and those for which there is room until ended ones have left.
enum { LIVE_CLIENTS_MAX = 48, LIVE_GUESTS_ROOM = 160 };

/// Connections. A program of this machine that knows no token can open some and send a byte now and
/// then: where there are as many as may be, a new one ends the oldest that has not shown the token.
/// Threads: any number at once. Tested: test_live_server.
struct live_clients {
    pthread_mutex_t lock;
    size_t count;
    struct live_client {
        int socket;
        bool known; ///< has shown the token
        bool ended;
    } client[LIVE_GUESTS_ROOM]; ///< the oldest first
};

void mf_live_clients_init(struct live_clients *clients);
void mf_live_clients_clear(struct live_clients *clients);

/// A connection begins. Without room nothing is remembered of it.
void mf_live_clients_add(struct live_clients *clients, int socket);

/// It has shown the token.
void mf_live_clients_set_known(struct live_clients *clients, int socket);

/// It is about to be closed.
void mf_live_clients_remove(struct live_clients *clients, int socket);
