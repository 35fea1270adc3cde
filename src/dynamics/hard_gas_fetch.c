// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_gas_fetch.h"

#include "dynamics/hard_gas_calendar.h"

/// Buckets ahead of the present one, of which the first entry is asked for, the second, the third,
/// and all bodies.
enum { FIRST = 36, SECOND = 30, THIRD = 24, BODIES = 16 };

/// Bodies after which the next stage of one follows.
enum { STAGE = 7 };

/// Lines that are begun with together, about half of what an event needs, in two dimensions and in
/// three.
enum { AT_ONCE_PLANE = 12, AT_ONCE_SPACE = 20 };

enum status mf_hard_gas_fetch_init(struct hard_gas *gas) {
    TRY_ARRAY(gas->calendar.fetch, 1);
    gas->calendar.fetch->at_once = gas->dimensions == 2 ? AT_ONCE_PLANE : AT_ONCE_SPACE;
    return STATUS_OK;
}

static inline void ask(struct hard_gas_fetch *fetch, const void *line) {
    fetch->line[fetch->asked++ % HARD_GAS_LINES] = line;
}

// Cells -------------------------------------------------------------------------------------------

/// Where a body will look, but what is beyond the border of the box: around itself, or beyond the
/// border of its cell.
static inline struct hard_gas_block find_block(const struct hard_gas *gas, int32_t body,
                                               bool crosses) {
    const struct hard_gas_event *event = &gas->event[body];
    struct hard_gas_block block;
    for (int d = 0; d < 3; d++) {
        block.low[d] = event->cell[d] - 1;
        block.high[d] = event->cell[d] + 1;
    }
    if (crosses) {
        const int d = event->axis;
        block.low[d] = block.high[d] = event->cell[d] + (gas->body[body].velocity[d] > 0 ? 2 : -2);
    }
    for (int d = 0; d < 3; d++) {
        block.low[d] = block.low[d] < 0 ? 0 : block.low[d];
        block.high[d] = block.high[d] < gas->cells[d] ? block.high[d] : gas->cells[d] - 1;
    }
    return block;
}

static inline bool holds(const struct hard_gas_block *block, int x, int y, int z) {
    return (x >= block->low[0]) & (x <= block->high[0]) & (y >= block->low[1]) &
           (y <= block->high[1]) & (z >= block->low[2]) & (z <= block->high[2]);
}

static inline const int32_t *first_of(const struct hard_gas *gas, int x, int y, int z) {
    return &gas->first[((size_t)x * (size_t)gas->cells[1] + (size_t)y) * (size_t)gas->cells[2] +
                       (size_t)z];
}

/// The cells of a row, along the last axis, follow each other in memory.
static inline void ask_cells(struct hard_gas *gas, const struct hard_gas_block *block) {
    const bool plane = gas->dimensions == 2;
    for (int x = block->low[0]; x <= block->high[0]; x++)
        for (int y = block->low[1]; y <= (plane ? block->low[1] : block->high[1]); y++)
            ask(gas->calendar.fetch, first_of(gas, x, y, block->low[2]));
}

static inline void ask_body(struct hard_gas *gas, int32_t body) {
    ask(gas->calendar.fetch, &gas->body[body]);
    ask(gas->calendar.fetch, &gas->link[body]);
}

/// The first one of each cell of a block, but of those that another block has.
static inline void ask_first(struct hard_gas *gas, struct hard_gas_coming *coming,
                             const struct hard_gas_block *block, const struct hard_gas_block *but) {
    for (int x = block->low[0]; x <= block->high[0]; x++)
        for (int y = block->low[1]; y <= block->high[1]; y++)
            for (int z = block->low[2]; z <= block->high[2]; z++) {
                const int32_t k = *first_of(gas, x, y, z);
                if (k < 0 || (but && holds(but, x, y, z)))
                    continue;
                coming->first[coming->found++] = k;
                ask_body(gas, k);
            }
}

// Stages ------------------------------------------------------------------------------------------

static inline void begin(struct hard_gas *gas, const struct hard_gas_entry *entry) {
    struct hard_gas_fetch *fetch = gas->calendar.fetch;
    struct hard_gas_coming *coming = &fetch->coming[fetch->bodies++ % HARD_GAS_COMING];
    coming->time = entry->time;
    coming->body = entry->body;
    ask(fetch, &gas->event[entry->body]);
}

static inline void ask_bodies(struct hard_gas *gas, struct hard_gas_coming *coming) {
    const struct hard_gas_event *event = &gas->event[coming->body];
    if (event->time != coming->time) {
        coming->body = -1;
        return;
    }
    coming->partner = event->time < event->border ? event->partner : -1;
    ask_body(gas, coming->body);
    if (coming->partner < 0)
        return;
    ask(gas->calendar.fetch, &gas->label[coming->body]);
    ask(gas->calendar.fetch, &gas->label[coming->partner]);
    ask(gas->calendar.fetch, &gas->event[coming->partner]);
    ask_body(gas, coming->partner);
}

static inline void ask_blocks(struct hard_gas *gas, struct hard_gas_coming *coming) {
    coming->own = find_block(gas, coming->body, coming->partner < 0);
    ask_cells(gas, &coming->own);
    if (coming->partner < 0) {
        const uint16_t *cell = gas->event[coming->body].cell;
        ask(gas->calendar.fetch, first_of(gas, cell[0], cell[1], cell[2]));
        return;
    }
    coming->others = find_block(gas, coming->partner, false);
    ask_cells(gas, &coming->others);
}

static inline void ask_neighbours(struct hard_gas *gas, struct hard_gas_coming *coming) {
    coming->found = 0;
    ask_first(gas, coming, &coming->own, NULL);
    if (coming->partner >= 0)
        ask_first(gas, coming, &coming->others, &coming->own);
}

/// The second ones of the cells.
static inline void ask_second(struct hard_gas *gas, const struct hard_gas_coming *coming) {
    for (int n = 0; n < coming->found; n++) {
        const int32_t k = gas->link[coming->first[n]].next;
        if (k >= 0)
            ask_body(gas, k);
    }
}

/// NULL: there is none in this stage.
static inline struct hard_gas_coming *find_coming(const struct hard_gas *gas, uint32_t stage) {
    struct hard_gas_fetch *fetch = gas->calendar.fetch;
    if (fetch->bodies <= stage * STAGE)
        return NULL;
    struct hard_gas_coming *coming =
        &fetch->coming[(fetch->bodies - 1 - stage * STAGE) % HARD_GAS_COMING];
    return coming->body >= 0 ? coming : NULL;
}

static inline void go_on(struct hard_gas *gas) {
    struct hard_gas_coming *coming = find_coming(gas, 1);
    if (coming)
        ask_bodies(gas, coming);
    if ((coming = find_coming(gas, 2)))
        ask_blocks(gas, coming);
    if ((coming = find_coming(gas, 3)))
        ask_neighbours(gas, coming);
    if ((coming = find_coming(gas, 4)))
        ask_second(gas, coming);
}

/// Ask for the entry number `place` of a bucket so many ahead; those before it are there.
static inline void ask_entry(struct hard_gas *gas, int buckets, int place) {
    const struct hard_gas_calendar *calendar = &gas->calendar;
    int32_t k = *hard_gas_calendar_bucket(calendar, calendar->present + buckets);
    for (; place > 0 && k >= 0; place--)
        k = calendar->entry[k].next;
    if (k >= 0)
        ask(calendar->fetch, &calendar->entry[k]);
}

void mf_hard_gas_fetch_ask(struct hard_gas *gas) {
    const struct hard_gas_calendar *calendar = &gas->calendar;
    ask_entry(gas, FIRST, 0);
    ask_entry(gas, SECOND, 1);
    ask_entry(gas, THIRD, 2);
    for (int32_t k = *hard_gas_calendar_bucket(calendar, calendar->present + BODIES); k >= 0;
         k = calendar->entry[k].next) {
        begin(gas, &calendar->entry[k]);
        go_on(gas);
    }
    hard_gas_fetch_some(calendar->fetch);
}
