// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/crew.h"

#include <stdlib.h>

void mf_crew_init(struct crew *crew, int most) {
    *crew = (struct crew){.most = most, .now = most, .better = most, .next_rest = CREW_FIRST_REST};
}

static int compare_ticks(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/// The median: a turn in which lists were built, or that another process cut short, does not count.
static uint64_t usual_ticks(uint64_t *tried) {
    qsort(tried, CREW_TRIED_TURNS, sizeof *tried, compare_ticks);
    return tried[CREW_TRIED_TURNS / 2];
}

static void end_trial(struct crew *crew) {
    const int better = usual_ticks(crew->tried[0]) <= usual_ticks(crew->tried[1]) ? crew->most : 1;
    if (better != crew->better)
        crew->next_rest = CREW_FIRST_REST;
    crew->rest = crew->next_rest;
    if (2 * crew->next_rest <= CREW_LONGEST_REST)
        crew->next_rest *= 2;
    crew->better = crew->now = better;
    crew->turn = 0;
}

static void begin_trial(struct crew *crew) {
    crew->rest = 0;
    crew->now = crew->most;
    crew->turn = 0;
}

void mf_crew_end_turn(struct crew *crew, uint64_t ticks) {
    if (crew->most <= 1)
        return;
    const int turn = crew->turn++;
    if (crew->rest > 0) {
        if (crew->turn >= crew->rest)
            begin_trial(crew);
        return;
    }
    crew->tried[turn >= CREW_TRIED_TURNS][turn % CREW_TRIED_TURNS] = ticks;
    crew->now = crew->turn < CREW_TRIED_TURNS ? crew->most : 1;
    if (crew->turn == 2 * CREW_TRIED_TURNS)
        end_trial(crew);
}
