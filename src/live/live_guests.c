// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_guests.h"

#include <string.h>
#include <sys/socket.h>

void mf_live_guests_init(struct live_guests *guests) {
    memset(guests, 0, sizeof *guests);
    pthread_mutex_init(&guests->lock, NULL);
}

void mf_live_guests_clear(struct live_guests *guests) {
    pthread_mutex_destroy(&guests->lock);
}

static struct live_guest *find(struct live_guests *guests, int socket) {
    for (size_t k = 0; k < guests->count; k++)
        if (guests->guest[k].socket == socket)
            return &guests->guest[k];
    return NULL;
}

/// End the oldest connection that has not shown the token, if there are too many.
static void end_oldest(struct live_guests *guests) {
    struct live_guest *oldest = NULL;
    size_t open = 0;
    for (size_t k = 0; k < guests->count; k++) {
        struct live_guest *guest = &guests->guest[k];
        open += !guest->ended;
        if (oldest == NULL && !guest->ended && !guest->known)
            oldest = guest;
    }
    if (open < LIVE_GUESTS_MOST || oldest == NULL)
        return;
    oldest->ended = true;
    shutdown(oldest->socket, SHUT_RDWR);
}

void mf_live_guests_enter(struct live_guests *guests, int socket) {
    pthread_mutex_lock(&guests->lock);
    end_oldest(guests);
    if (guests->count < LIVE_GUESTS_ROOM)
        guests->guest[guests->count++] = (struct live_guest){.socket = socket};
    pthread_mutex_unlock(&guests->lock);
}

void mf_live_guests_know(struct live_guests *guests, int socket) {
    pthread_mutex_lock(&guests->lock);
    struct live_guest *guest = find(guests, socket);
    if (guest)
        guest->known = true;
    pthread_mutex_unlock(&guests->lock);
}

void mf_live_guests_leave(struct live_guests *guests, int socket) {
    pthread_mutex_lock(&guests->lock);
    struct live_guest *guest = find(guests, socket);
    if (guest) {
        const size_t behind = (size_t)(guests->guest + guests->count - guest - 1);
        memmove(guest, guest + 1, behind * sizeof *guest);
        guests->count--;
    }
    pthread_mutex_unlock(&guests->lock);
}
