// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/spent.h"

static struct spent seen;

struct spent mf_spent(void) {
    struct spent spent;
    for (int kind = 0; kind < SPENT_KINDS; kind++) {
#pragma omp atomic read
        spent.seconds[kind] = seen.seconds[kind];
    }
    return spent;
}

struct spent mf_spent_less(struct spent spent, struct spent less) {
    for (int kind = 0; kind < SPENT_KINDS; kind++)
        spent.seconds[kind] -= less.seconds[kind];
    return spent;
}

void mf_spent_add(enum spent_on kind, double seconds) {
#pragma omp atomic
    seen.seconds[kind] += seconds;
}

void mf_spent_lose(double seconds) {
    mf_spent_add(SPENT_SAMPLES, -seconds);
    mf_spent_add(SPENT_LOST, seconds);
}
