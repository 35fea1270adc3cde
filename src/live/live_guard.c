// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_guard.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>

enum status mf_live_guard_make_token(char token[LIVE_TOKEN_SIZE]) {
    unsigned char bits[(LIVE_TOKEN_SIZE - 1) / 2];
    if (getrandom(bits, sizeof bits, 0) != (ssize_t)sizeof bits)
        return mf_status_fail(STATUS_IO, "no random bits for a token: %s", strerror(errno));
    for (size_t k = 0; k < sizeof bits; k++)
        snprintf(token + 2 * k, 3, "%02x", bits[k]);
    return STATUS_OK;
}

bool mf_live_guard_is_token(const char token[LIVE_TOKEN_SIZE], const char *given) {
    unsigned char difference = given == NULL || strlen(given) != LIVE_TOKEN_SIZE - 1;
    const char *compared = difference ? "00000000000000000000000000000000" : given;
    for (size_t k = 0; k < LIVE_TOKEN_SIZE - 1; k++)
        difference |= (unsigned char)(token[k] ^ compared[k]);
    return difference == 0;
}

/// What follows a name: nothing, or a port.
static bool is_end_of_host(const char *end) {
    const size_t digits = *end == ':' ? strspn(end + 1, "0123456789") : 0;
    return *end == '\0' || (digits >= 1 && digits <= 5 && end[1 + digits] == '\0');
}

bool mf_live_guard_is_host(const char *host) {
    static const char *const names[] = {"127.0.0.1", "localhost"};
    for (size_t k = 0; host && k < sizeof names / sizeof *names; k++)
        if (strncmp(host, names[k], strlen(names[k])) == 0 &&
            is_end_of_host(host + strlen(names[k])))
            return true;
    return false;
}

bool mf_live_guard_is_origin(const char *origin, const char *host) {
    static const char scheme[] = "http://";
    return origin == NULL || (strncmp(origin, scheme, strlen(scheme)) == 0 &&
                              strcmp(origin + strlen(scheme), host) == 0);
}

// Clients -----------------------------------------------------------------------------------------

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
