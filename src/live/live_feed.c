// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_feed.h"

#include "base/clock.h"
#include "base/interrupt.h"

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

// What the page wishes ----------------------------------------------------------------------------

enum status mf_live_control_init(struct live_control *control) {
    *control = (struct live_control){0};
    if (pthread_mutex_init(&control->lock, NULL) != 0 ||
        pthread_cond_init(&control->changed, NULL) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no lock for the live view");
    return STATUS_OK;
}

void mf_live_control_clear(struct live_control *control) {
    free(control->order.text);
    pthread_cond_destroy(&control->changed);
    pthread_mutex_destroy(&control->lock);
}

static void leave(struct live_control *control) {
    pthread_cond_broadcast(&control->changed);
    pthread_mutex_unlock(&control->lock);
}

void mf_live_control_order(struct live_control *control, struct live_order *order) {
    pthread_mutex_lock(&control->lock);
    control->order = *order;
    control->ordered = control->going = true;
    order->text = NULL;
    leave(control);
}

void mf_live_control_pause(struct live_control *control, bool paused) {
    pthread_mutex_lock(&control->lock);
    control->paused = paused;
    control->steps = 0;
    leave(control);
}

void mf_live_control_step(struct live_control *control, int64_t steps) {
    pthread_mutex_lock(&control->lock);
    control->paused = true;
    control->steps = steps;
    leave(control);
}

void mf_live_control_stop(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    if (control->going) {
        control->stopped = true;
        control->paused = false;
        mf_interrupt_request(true);
    }
    leave(control);
}

void mf_live_control_speed(struct live_control *control, double speed) {
    pthread_mutex_lock(&control->lock);
    control->speed = speed;
    leave(control);
}

void mf_live_control_change(struct live_control *control, const struct live_change *change) {
    pthread_mutex_lock(&control->lock);
    control->change = *change;
    control->changes = true;
    leave(control);
}

/// Wait for a change, a tenth of a second at most: a signal may ask to stop meanwhile.
static void wait_briefly(struct live_control *control) {
    mf_clock_wait(&control->changed, &control->lock, clock_seconds() + 0.1);
}

bool mf_live_control_take(struct live_control *control, struct live_order *order) {
    pthread_mutex_lock(&control->lock);
    if (!control->ordered)
        wait_briefly(control);
    const bool taken = control->ordered;
    if (taken) {
        *order = control->order;
        control->order = (struct live_order){0};
        control->ordered = false;
    }
    pthread_mutex_unlock(&control->lock);
    return taken;
}

void mf_live_control_reset(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    control->going = control->paused = control->stopped = control->changes = false;
    control->steps = 0;
    mf_interrupt_request(false);
    pthread_mutex_unlock(&control->lock);
}

bool mf_live_control_stopped(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    const bool stopped = control->stopped;
    pthread_mutex_unlock(&control->lock);
    return stopped;
}

double mf_live_control_speed_now(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    const double speed = control->speed;
    pthread_mutex_unlock(&control->lock);
    return speed;
}

bool mf_live_control_take_change(struct live_control *control, struct live_change *change) {
    pthread_mutex_lock(&control->lock);
    const bool taken = control->changes;
    *change = control->change;
    control->changes = false;
    pthread_mutex_unlock(&control->lock);
    return taken;
}

struct live_pause mf_live_control_wait(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    if (control->paused && control->steps == 0 && !control->stopped)
        wait_briefly(control);
    const bool steps = control->paused && control->steps > 0;
    if (steps)
        control->steps--;
    const struct live_pause pause = {control->paused && !steps && !control->stopped, steps,
                                     control->speed};
    pthread_mutex_unlock(&control->lock);
    return pause;
}
