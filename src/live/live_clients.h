// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Connections to the server, so that those which say nothing never keep the page out.
///
/// A program of this machine that knows no token can open connections and send a byte now and then.
/// Where there are as many as may be, a new connection ends the oldest one that has not shown the
/// token. Threads: any number at once. Tested: test_live_server.
#pragma once

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Connections at one time, and those for which there is room until ended ones have left.
enum { LIVE_CLIENTS_MAX = 48, LIVE_GUESTS_ROOM = 160 };

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
