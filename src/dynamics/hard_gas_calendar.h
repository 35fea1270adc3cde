// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The calendar of events: a bucket for each short time, the buckets of a year used again and
/// again.
///
///   R. Brown, Commun. ACM 31, 1220 (1988); for hard spheres G. Paul, J. Comput. Phys. 221, 615
///   (2007).
/// Every body has one event, which stands in one bucket: a list of one or two. To put one in, to
/// take one out and to find the first take the same time for any number of bodies. Paul sorts the
/// events of the present bucket in a tree; lists so short need none.
#pragma once

#include "dynamics/hard_gas.h"

/// Number of the bucket of a time, counted from the epoch's begin through all years.
static inline int64_t hard_gas_calendar_number(const struct hard_gas *gas, double time) {
    const double number = time * gas->now.bucket_density;
    return (int64_t)(number < 0x1p62 ? number : 0x1p62); // never: INFINITY
}

static inline int32_t *hard_gas_calendar_bucket(const struct hard_gas *gas, double time) {
    return &gas->bucket[hard_gas_calendar_number(gas, time) & (gas->buckets - 1)];
}

static inline void hard_gas_calendar_put(struct hard_gas *gas, int32_t body) {
    struct hard_gas_event *event = &gas->event[body];
    int32_t *first = hard_gas_calendar_bucket(gas, event->time);
    event->previous = -1;
    event->next = *first;
    if (*first >= 0)
        gas->event[*first].previous = body;
    *first = body;
}

static inline void hard_gas_calendar_take(struct hard_gas *gas, int32_t body) {
    const struct hard_gas_event *event = &gas->event[body];
    if (event->next >= 0)
        gas->event[event->next].previous = event->previous;
    if (event->previous >= 0)
        gas->event[event->previous].next = event->next;
    else
        *hard_gas_calendar_bucket(gas, event->time) = event->next;
}

/// The body with the first event before `time`, of two at once that with the smaller number, or −1.
static inline int32_t hard_gas_calendar_first(struct hard_gas *gas, double time) {
    const int64_t last = hard_gas_calendar_number(gas, time);
    for (;; gas->now.bucket++) {
        double earliest = time;
        int32_t body = -1;
        for (int32_t k = gas->bucket[gas->now.bucket & (gas->buckets - 1)]; k >= 0;
             k = gas->event[k].next) {
            const double own = gas->event[k].time;
            if ((own < earliest || (own == earliest && k < body)) &&
                hard_gas_calendar_number(gas, own) <= gas->now.bucket) {
                earliest = own;
                body = k;
            }
        }
        if (body >= 0 || gas->now.bucket >= last)
            return body;
    }
}
