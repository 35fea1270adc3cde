// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_clients.h"

#include <string.h>
#include <sys/socket.h>

void mf_live_clients_init(struct live_clients *clients) {
    memset(clients, 0, sizeof *clients);
    pthread_mutex_init(&clients->lock, NULL);
}

void mf_live_clients_clear(struct live_clients *clients) {
    pthread_mutex_destroy(&clients->lock);
}

static struct live_client *find(struct live_clients *clients, int socket) {
    for (size_t k = 0; k < clients->count; k++)
        if (clients->client[k].socket == socket)
            return &clients->client[k];
    return NULL;
}

/// End the oldest connection that has not shown the token, if there are too many.
static void end_oldest(struct live_clients *clients) {
    struct live_client *oldest = NULL;
    size_t open = 0;
    for (size_t k = 0; k < clients->count; k++) {
        struct live_client *client = &clients->client[k];
        open += !client->ended;
        if (oldest == NULL && !client->ended && !client->known)
            oldest = client;
    }
    if (open < LIVE_CLIENTS_MAX || oldest == NULL)
        return;
    oldest->ended = true;
    shutdown(oldest->socket, SHUT_RDWR);
}

void mf_live_clients_add(struct live_clients *clients, int socket) {
    pthread_mutex_lock(&clients->lock);
    end_oldest(clients);
    if (clients->count < LIVE_GUESTS_ROOM)
        clients->client[clients->count++] = (struct live_client){.socket = socket};
    pthread_mutex_unlock(&clients->lock);
}

void mf_live_clients_set_known(struct live_clients *clients, int socket) {
    pthread_mutex_lock(&clients->lock);
    struct live_client *client = find(clients, socket);
    if (client)
        client->known = true;
    pthread_mutex_unlock(&clients->lock);
}

void mf_live_clients_remove(struct live_clients *clients, int socket) {
    pthread_mutex_lock(&clients->lock);
    struct live_client *client = find(clients, socket);
    if (client) {
        const size_t behind = (size_t)(clients->client + clients->count - client - 1);
        memmove(client, client + 1, behind * sizeof *client);
        clients->count--;
    }
    pthread_mutex_unlock(&clients->lock);
}
