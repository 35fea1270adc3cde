// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_gas_calendar.h"

/// Buckets and entries a body, at least. With fewer entries, which void ones fill up, the calendar
/// must be filled again more often.
enum { BUCKETS_A_BODY = 2, ENTRIES_A_BODY = 3 };

/// Bodies beyond which memory is not in the caches of a core: fetching costs a fifth before, and
/// gains as much after.
enum { FETCHED_FROM = 30000 };

enum status mf_hard_gas_calendar_init(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    const int64_t count = gas->count;
    for (calendar->buckets = 1; calendar->buckets < BUCKETS_A_BODY * count;)
        calendar->buckets *= 2;
    calendar->entries = (int32_t)(ENTRIES_A_BODY * count + 8);
    calendar->fetches = count >= FETCHED_FROM;
    TRY_ARRAY(calendar->first, (size_t)calendar->buckets);
    TRY_ARRAY(calendar->entry, (size_t)calendar->entries);
    return STATUS_OK;
}

void mf_hard_gas_calendar_clear(struct hard_gas_calendar *calendar) {
    mf_memory_free(calendar->first);
    mf_memory_free(calendar->entry);
    *calendar = (struct hard_gas_calendar){0};
}

void mf_hard_gas_calendar_fill(struct hard_gas *gas) {
    struct hard_gas_calendar *calendar = &gas->calendar;
    memset(calendar->first, 0xff, (size_t)calendar->buckets * sizeof *calendar->first);
    for (int32_t k = 0; k < calendar->entries; k++)
        calendar->entry[k].next = k + 1 < calendar->entries ? k + 1 : -1;
    calendar->unused = 0;
    calendar->heap = -1;
    calendar->present = hard_gas_calendar_number(gas, gas->now.time);
    for (int32_t k = 0; k < gas->count; k++)
        hard_gas_calendar_insert_entry(gas, k);
    gas->calendar_events = gas->now.events;
}

/// The body of the first entry of a bucket that is so many ahead, or −1.
static inline int32_t find_ahead(const struct hard_gas_calendar *calendar, int buckets) {
    const int32_t k = *hard_gas_calendar_bucket(calendar, calendar->present + buckets);
    return k >= 0 ? calendar->entry[k].body : -1;
}

/// Cells of a body and those one before and one after it along the first two axes; of three
/// dimensions, the last axis follows in memory.
static inline int find_rows(const struct hard_gas *gas, int32_t body, size_t rows[9]) {
    const uint16_t *cell = gas->event[body].cell;
    int count = 0;
    for (int x = cell[0] - 1; x <= cell[0] + 1; x++)
        for (int y = cell[1] - 1; y <= cell[1] + 1; y++)
            if (x >= 0 && x < gas->cells[0] && y >= 0 && y < gas->cells[1])
                rows[count++] =
                    ((size_t)x * (size_t)gas->cells[1] + (size_t)y) * (size_t)gas->cells[2] +
                    cell[2];
    return count;
}

void mf_hard_gas_calendar_fetch(const struct hard_gas *gas) {
    enum { ENTRY = 40, EVENT = 30, CELLS = 20, BODIES = 10 };
    const struct hard_gas_calendar *calendar = &gas->calendar;
    const int32_t entry = *hard_gas_calendar_bucket(calendar, calendar->present + ENTRY);
    const int32_t far = find_ahead(calendar, EVENT), middle = find_ahead(calendar, CELLS);
    const int32_t near = find_ahead(calendar, BODIES);
    size_t rows[9];
    if (entry >= 0)
        __builtin_prefetch(&calendar->entry[entry]);
    if (far >= 0) {
        __builtin_prefetch(&gas->event[far]);
        __builtin_prefetch(&gas->body[far]);
    }
    if (middle >= 0) {
        const int32_t partner = gas->event[middle].partner;
        if (partner >= 0) {
            __builtin_prefetch(&gas->event[partner]);
            __builtin_prefetch(&gas->body[partner]);
        }
        for (int n = find_rows(gas, middle, rows) - 1; n >= 0; n--)
            __builtin_prefetch(&gas->first[rows[n]]);
    }
    if (near >= 0)
        for (int n = find_rows(gas, near, rows) - 1; n >= 0; n--) {
            const int32_t k = gas->first[rows[n]];
            if (k >= 0) {
                __builtin_prefetch(&gas->body[k]);
                __builtin_prefetch(&gas->link[k]);
            }
        }
}
