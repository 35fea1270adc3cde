// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the work publishes for whoever looks, the latest texts and particles, and what the
/// page wishes of the work: begin, pause, step, go on, stop, not so fast, another temperature.
///
/// The work replaces; threads of the server wait for what they have not seen. Whoever is slow
/// misses what was replaced meanwhile, and nobody waits for him. These threads put wishes; the work
/// takes them, in the calls of its watcher and between runs, where alone it waits. Tested:
/// test_live_feed.
#pragma once

#include "base/status.h"
#include "io/output.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum live_slot {
    LIVE_STATE,     ///< what is shown and what it does, JSON
    LIVE_PROGRESS,  ///< JSON
    LIVE_LOG,       ///< lines for the person
    LIVE_TABLES,    ///< files of the result, JSON
    LIVE_NUMBERS,   ///< of a run, JSON
    LIVE_CANDIDATE, ///< of a fit: what it has measured last, JSON
    LIVE_SLOTS
};

/// Bytes of one moment, counted.
struct live_bytes {
    unsigned char *bytes;
    size_t size, capacity;
    uint64_t serial; ///< 0: there are none
};

struct live_feed {
    pthread_mutex_t lock; ///< of all that follows
    pthread_cond_t changed;
    uint64_t serial;
    struct {
        char *text;
        uint64_t serial;
    } slot[LIVE_SLOTS];
    struct live_bytes particles;
    double particles_asked; ///< clock of the last request for them [s]
    double energies_asked;  ///< the same, with their energies
    int streams;            ///< that are open
    bool closed;
};

enum status mf_live_feed_init(struct live_feed *feed) MUST_USE;
void mf_live_feed_clear(struct live_feed *feed);

/// Nobody waits any more, now and later.
void mf_live_feed_close(struct live_feed *feed);

/// Replace a text. Without memory the old one stays.
void mf_live_feed_push(struct live_feed *feed, enum live_slot slot, const char *text);

/// A copy of a text, to be freed with free(); NULL if there is none.
char *mf_live_feed_get(struct live_feed *feed, enum live_slot slot);

/// Wait until there is a text newer than *seen, for so many seconds at most.
/// @param[in,out] seen  0 at first
/// @return server-sent events of all that is new, a comment if nothing is, to be freed with free();
/// NULL once the feed is closed, or without memory
char *mf_live_feed_wait(struct live_feed *feed, uint64_t *seen, double seconds);

/// Somebody listens, or (−1) no longer.
void mf_live_feed_count_stream(struct live_feed *feed, int change);
int mf_live_feed_streams(struct live_feed *feed);

/// Exchange the published particles for new ones: `bytes` is given away, and has afterwards the
/// memory of the old ones.
void mf_live_feed_push_particles(struct live_feed *feed, struct live_bytes *bytes);

/// A copy of the particles newer than `seen`, which notes that somebody wants them, perhaps with
/// their energies; size 0 if there are none. `bytes` is to be freed with free().
struct live_bytes mf_live_feed_get_particles(struct live_feed *feed, uint64_t seen, bool energies);

/// Whether somebody has asked for them, or for their energies, within the last second.
bool mf_live_feed_wants_particles(struct live_feed *feed);
bool mf_live_feed_wants_energies(struct live_feed *feed);

/// What is to be run.
struct live_order {
    char file[OUTPUT_PATH_SIZE];
    char *text;                    ///< of the file, as edited; to be freed with free()
    char folder[OUTPUT_PATH_SIZE]; ///< for the results; "": as the command line says
    bool resume, force;
};

/// What a run is to go on with, in units of its file; NaN: as it is.
struct live_change {
    double temperature, time_step; ///< of a simulation
    double damping;                ///< of a fit
};

struct live_control {
    pthread_mutex_t lock; ///< of all that follows
    pthread_cond_t changed;
    bool ordered; ///< there is an order that was not taken
    struct live_order order;
    bool going; ///< a run was ordered, and has not ended
    bool paused, stopped;
    int64_t steps; ///< that may pass though it is paused
    double speed;  ///< steps a second at most; 0: any
    bool changes;  ///< there is one that was not taken
    struct live_change change;
};

enum status mf_live_control_init(struct live_control *control) MUST_USE;

void mf_live_control_clear(struct live_control *control);

/// By threads of the server: put an order, whose text is given away; none may be waiting.
void mf_live_control_order(struct live_control *control, struct live_order *order);

void mf_live_control_pause(struct live_control *control, bool paused);

void mf_live_control_step(struct live_control *control, int64_t steps);

void mf_live_control_stop(struct live_control *control);

void mf_live_control_speed(struct live_control *control, double speed);

void mf_live_control_change(struct live_control *control, const struct live_change *change);

/// By the work: wait for an order, a tenth of a second at most; false if there is none.
bool mf_live_control_take(struct live_control *control, struct live_order *order);

/// A run has ended: forget what was wished of it, also that to stop.
void mf_live_control_reset(struct live_control *control);

/// Whether the last run was stopped from the page.
bool mf_live_control_stopped(struct live_control *control);

double mf_live_control_speed_now(struct live_control *control);

/// Take the change that was wished last; false if there is none.
bool mf_live_control_take_change(struct live_control *control, struct live_change *change);

/// What the work should do before its next step.
struct live_pause {
    bool paused;   ///< it waits
    bool stepping; ///< it is paused, but for this step
    double speed;
};

/// Wait while the run is paused, a tenth of a second at most, and take one step of those allowed.
struct live_pause mf_live_control_wait(struct live_control *control);
