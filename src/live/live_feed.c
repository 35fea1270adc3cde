// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_feed.h"

#include "base/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[LIVE_SLOTS] = {"state",  "progress", "log",
                                              "tables", "numbers",  "candidate"};

/// Who asked for particles so long ago has gone [s].
static const double particles_patience = 1;

enum status mf_live_feed_init(struct live_feed *feed) {
    *feed = (struct live_feed){.particles_asked = -particles_patience,
                               .energies_asked = -particles_patience};
    return pthread_mutex_init(&feed->lock, NULL) == 0 &&
                   pthread_cond_init(&feed->changed, NULL) == 0
               ? STATUS_OK
               : mf_status_fail(STATUS_NO_MEMORY, "no lock for the live view");
}

void mf_live_feed_clear(struct live_feed *feed) {
    for (int slot = 0; slot < LIVE_SLOTS; slot++)
        free(feed->slot[slot].text);
    free(feed->particles.bytes);
    pthread_cond_destroy(&feed->changed);
    pthread_mutex_destroy(&feed->lock);
}

void mf_live_feed_close(struct live_feed *feed) {
    pthread_mutex_lock(&feed->lock);
    feed->closed = true;
    pthread_cond_broadcast(&feed->changed);
    pthread_mutex_unlock(&feed->lock);
}

void mf_live_feed_push(struct live_feed *feed, enum live_slot slot, const char *text) {
    char *copy = strdup(text);
    if (copy == NULL)
        return;
    pthread_mutex_lock(&feed->lock);
    char *old = feed->slot[slot].text;
    feed->slot[slot].text = copy;
    feed->slot[slot].serial = ++feed->serial;
    pthread_cond_broadcast(&feed->changed);
    pthread_mutex_unlock(&feed->lock);
    free(old);
}

char *mf_live_feed_get(struct live_feed *feed, enum live_slot slot) {
    pthread_mutex_lock(&feed->lock);
    char *copy = feed->slot[slot].text ? strdup(feed->slot[slot].text) : NULL;
    pthread_mutex_unlock(&feed->lock);
    return copy;
}

static bool has_news(const struct live_feed *feed, uint64_t seen) {
    for (int slot = 0; slot < LIVE_SLOTS; slot++)
        if (feed->slot[slot].serial > seen)
            return true;
    return false;
}

/// An event of the text/event-stream of HTML's section 9.2: each line of the text is a line "data".
static void insert_event(FILE *stream, const char *name, const char *text) {
    fprintf(stream, "event: %s\n", name);
    for (const char *line = text; line;) {
        const char *end = strchr(line, '\n');
        const int length = end ? (int)(end - line) : (int)strlen(line);
        fprintf(stream, "data: %.*s\n", length, line);
        line = end ? end + 1 : NULL;
    }
    fputc('\n', stream);
}

static char *events_since(const struct live_feed *feed, uint64_t seen) {
    char *events = NULL;
    size_t size;
    FILE *stream = open_memstream(&events, &size);
    if (stream == NULL)
        return NULL;
    for (int slot = 0; slot < LIVE_SLOTS; slot++)
        if (feed->slot[slot].serial > seen)
            insert_event(stream, names[slot], feed->slot[slot].text);
    if (fclose(stream) == 0)
        return events;
    free(events);
    return NULL;
}

char *mf_live_feed_wait(struct live_feed *feed, uint64_t *seen, double seconds) {
    const double until = clock_seconds() + seconds;
    char *events = NULL;
    pthread_mutex_lock(&feed->lock);
    while (!feed->closed && !has_news(feed, *seen))
        if (!mf_clock_wait(&feed->changed, &feed->lock, until))
            break;
    if (has_news(feed, *seen))
        events = events_since(feed, *seen);
    else if (!feed->closed)
        events = strdup(": nothing new\n\n");
    *seen = feed->serial;
    pthread_mutex_unlock(&feed->lock);
    return events;
}

void mf_live_feed_count_stream(struct live_feed *feed, int change) {
    pthread_mutex_lock(&feed->lock);
    feed->streams += change;
    pthread_mutex_unlock(&feed->lock);
}

int mf_live_feed_streams(struct live_feed *feed) {
    pthread_mutex_lock(&feed->lock);
    const int streams = feed->streams;
    pthread_mutex_unlock(&feed->lock);
    return streams;
}

void mf_live_feed_push_particles(struct live_feed *feed, struct live_bytes *bytes) {
    pthread_mutex_lock(&feed->lock);
    const struct live_bytes old = feed->particles;
    feed->particles = *bytes;
    feed->particles.serial = old.serial + 1;
    pthread_mutex_unlock(&feed->lock);
    *bytes = old;
}

struct live_bytes mf_live_feed_get_particles(struct live_feed *feed, uint64_t seen, bool energies) {
    struct live_bytes copy = {0};
    pthread_mutex_lock(&feed->lock);
    const struct live_bytes *now = &feed->particles;
    feed->particles_asked = clock_seconds();
    if (energies)
        feed->energies_asked = feed->particles_asked;
    if (now->serial > seen && (copy.bytes = malloc(now->size))) {
        memcpy(copy.bytes, now->bytes, now->size);
        copy.size = now->size;
        copy.serial = now->serial;
    }
    pthread_mutex_unlock(&feed->lock);
    return copy;
}

static bool is_recent(struct live_feed *feed, const double *asked) {
    pthread_mutex_lock(&feed->lock);
    const bool recent = clock_seconds() - *asked < particles_patience;
    pthread_mutex_unlock(&feed->lock);
    return recent;
}

bool mf_live_feed_wants_particles(struct live_feed *feed) {
    return is_recent(feed, &feed->particles_asked);
}

bool mf_live_feed_wants_energies(struct live_feed *feed) {
    return is_recent(feed, &feed->energies_asked);
}
