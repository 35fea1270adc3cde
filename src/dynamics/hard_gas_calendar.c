// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_gas_calendar.h"

/// Buckets and entries a body, at least. With fewer entries, which void ones fill up, the calendar
/// must be filled again more often.
enum { BUCKETS_A_BODY = 2, ENTRIES_A_BODY = 3 };

/// Bodies beyond which memory is not in the caches of a core, and fetching ahead gains more than it
/// costs.
enum { FETCHED_FROM = 30000 };

enum status mf_hard_gas_calendar_init(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    const int64_t count = gas->count;
    for (calendar->buckets = 1; calendar->buckets < BUCKETS_A_BODY * count;)
        calendar->buckets *= 2;
    calendar->entries = (int32_t)(ENTRIES_A_BODY * count + 8);
    TRY_SCATTERED(calendar->first, (size_t)calendar->buckets);
    TRY_SCATTERED(calendar->entry, (size_t)calendar->entries);
    if (count >= FETCHED_FROM)
        TRY(mf_hard_gas_fetch_init(gas));
    return STATUS_OK;
}

void mf_hard_gas_calendar_clear(struct hard_gas_calendar *calendar) {
    mf_memory_free(calendar->first);
    mf_memory_free(calendar->entry);
    mf_memory_free(calendar->fetch);
    *calendar = (struct hard_gas_calendar){0};
}

void mf_hard_gas_calendar_fill(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    memset(calendar->first, 0xff, (size_t)calendar->buckets * sizeof *calendar->first);
    for (int32_t k = 0; k < calendar->entries; k++)
        calendar->entry[k].next = k + 1 < calendar->entries ? k + 1 : -1;
    calendar->unused = 0;
    calendar->heap = -1;
    calendar->waits = 0;
    calendar->present = hard_gas_calendar_number(gas, gas->now.time);
    for (int32_t k = 0; k < gas->count; k++)
        hard_gas_calendar_insert_entry(gas, k);
    gas->calendar_events = gas->now.events;
}
