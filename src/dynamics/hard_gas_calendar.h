// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The calendar of events: a bucket for each short time, the buckets of a year used again and
/// again.
///
///   R. Brown, Commun. ACM 31, 1220 (1988); for hard spheres G. Paul, J. Comput. Phys. 221, 615
///   (2007).
/// An entry goes to the front of its bucket, which takes the same time for any number of bodies,
/// and stays there if the body gets another event before: an entry whose time is not that of its
/// body's event is void. Only the present bucket is in order: its entries are a skew heap (D. D.
/// Sleator and R. E. Tarjan, SIAM J. Comput. 15, 52 (1986)) by time and, at the same time, by body,
/// so that what happens does not depend on what else the calendar holds.
#pragma once

#include "dynamics/hard_gas.h"
#include "dynamics/hard_gas_fetch.h"

/// Number of the bucket of a time, counted from the epoch's begin through all years.
static inline int64_t hard_gas_calendar_number(const struct hard_gas *gas, double time) {
    const double number = time * gas->now.bucket_density;
    return (int64_t)(number < 0x1p62 ? number : 0x1p62); // never: INFINITY
}

static inline int32_t *hard_gas_calendar_bucket(const struct hard_gas_calendar *calendar,
                                                int64_t number) {
    return &calendar->first[number & (calendar->buckets - 1)];
}

/// Join two heaps: the right branches are merged, and all branches on the way change sides.
static inline int32_t hard_gas_calendar_merge(struct hard_gas_entry *entry, int32_t a, int32_t b) {
    int32_t top, *place = &top;
    while (a >= 0 && b >= 0) {
        if (entry[b].time < entry[a].time ||
            (entry[b].time == entry[a].time && entry[b].body < entry[a].body)) {
            const int32_t c = a;
            a = b;
            b = c;
        }
        const int32_t right = entry[a].other;
        *place = a;
        entry[a].other = entry[a].next;
        place = &entry[a].next;
        a = right;
    }
    *place = a >= 0 ? a : b;
    return top;
}

static inline void hard_gas_calendar_insert_entry(struct hard_gas *gas, int32_t body) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    const double time = gas->event[body].time;
    const int64_t number = hard_gas_calendar_number(gas, time);
    const int32_t k = calendar->unused;
    struct hard_gas_entry *entry = &calendar->entry[k];
    calendar->unused = entry->next;
    *entry = (struct hard_gas_entry){.time = time, .body = body, .next = -1, .other = -1};
    if (number <= calendar->present) {
        calendar->heap = hard_gas_calendar_merge(calendar->entry, calendar->heap, k);
        return;
    }
    int32_t *first = hard_gas_calendar_bucket(calendar, number);
    entry->next = *first;
    *first = k;
}

enum status mf_hard_gas_calendar_init(struct hard_gas *gas) MUST_USE;
void mf_hard_gas_calendar_clear(struct hard_gas_calendar *calendar);

/// Empty the calendar, and put the events of all bodies into it.
void mf_hard_gas_calendar_fill(struct hard_gas *gas);

/// Put in those that wait; the calendar has all of them, and no void ones, if it must be filled.
static inline void hard_gas_calendar_insert_waiting(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    for (int n = 0; n < calendar->waits; n++) {
        if (calendar->unused < 0) {
            mf_hard_gas_calendar_fill(gas);
            break;
        }
        hard_gas_calendar_insert_entry(gas, calendar->waiting[n]);
    }
    calendar->waits = 0;
}

/// Put in the event of a body, or, if it is not of the present bucket, let it wait while its bucket
/// is fetched from memory.
static inline void hard_gas_calendar_insert(struct hard_gas *gas, int32_t body) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    calendar->waiting[calendar->waits++] = body;
    if (calendar->fetch) {
        const int64_t number = hard_gas_calendar_number(gas, gas->event[body].time);
        __builtin_prefetch(hard_gas_calendar_bucket(calendar, number), 1);
        if (number > calendar->present && calendar->waits < HARD_GAS_WAITING)
            return;
    }
    hard_gas_calendar_insert_waiting(gas);
}

/// On to the next bucket: what is due goes into the heap.
static inline void hard_gas_calendar_turn(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    int32_t *first = hard_gas_calendar_bucket(calendar, ++calendar->present), left = -1;
    for (int32_t next, k = *first; k >= 0; k = next) {
        struct hard_gas_entry *entry = &calendar->entry[k];
        next = entry->next;
        if (hard_gas_calendar_number(gas, entry->time) <= calendar->present) {
            entry->next = -1;
            calendar->heap = hard_gas_calendar_merge(calendar->entry, calendar->heap, k);
        } else {
            entry->next = left;
            left = k;
        }
    }
    *first = left;
}

/// Take out the first event before `time`; returns its body, −1 if there is none.
static inline int32_t hard_gas_calendar_take(struct hard_gas *gas, double time) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    const int64_t last = hard_gas_calendar_number(gas, time);
    for (;;) {
        while (calendar->heap >= 0) {
            const int32_t k = calendar->heap;
            struct hard_gas_entry *entry = &calendar->entry[k];
            const bool valid = entry->time == gas->event[entry->body].time;
            if (valid && entry->time >= time)
                return -1;
            calendar->heap = hard_gas_calendar_merge(calendar->entry, entry->next, entry->other);
            entry->next = calendar->unused;
            calendar->unused = k;
            if (valid)
                return entry->body;
        }
        if (calendar->present >= last)
            return -1;
        hard_gas_calendar_insert_waiting(gas);
        hard_gas_calendar_turn(gas);
        if (calendar->fetch)
            mf_hard_gas_fetch_ask(gas);
    }
}
