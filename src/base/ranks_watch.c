// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/ranks_watch.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/ranks.h"

void mf_ranks_watch_init(struct ranks_watch *watch) {
    const size_t count = (size_t)mf_ranks_count();
    *watch = (struct ranks_watch){.one = mf_memory_zeroed(count, sizeof *watch->one),
                                  .said = clock_seconds(),
                                  .looked = clock_seconds()};
    if (watch->one == NULL)
        mf_ranks_stop(3, "%s", mf_status_message());
    for (size_t k = 0; k < count; k++)
        watch->one[k].heard = watch->said;
}

void mf_ranks_watch_clear(struct ranks_watch *watch) {
    mf_memory_free(watch->one);
}

void mf_ranks_watch_hear(struct ranks_watch *watch, int rank) {
    struct ranks_watch_one *one = &watch->one[rank];
    if (one->named)
        mf_ranks_warn("rank %d on %s is back", rank, mf_ranks_host(rank));
    *one = (struct ranks_watch_one){.heard = clock_seconds()};
}

void mf_ranks_watch_leave(struct ranks_watch *watch, int rank) {
    watch->one[rank].left = true;
}

bool mf_ranks_watch_is_due(struct ranks_watch *watch) {
    const double now = clock_seconds();
    const bool due = now - watch->said > RANKS_WATCH_WORD;
    if (due)
        watch->said = now;
    return due;
}

void mf_ranks_watch_look(struct ranks_watch *watch) {
    const double now = clock_seconds();
    const int own = mf_ranks_number(), count = mf_ranks_count();
    // Who was away itself has heard nobody.
    const bool away = now - watch->looked > RANKS_WATCH_WORD;
    watch->looked = now;
    for (int rank = 0; away && rank < count; rank++)
        watch->one[rank].heard = now;
    for (int rank = own == 0; own <= 1 && rank < (own == 0 ? count : 1); rank++) {
        struct ranks_watch_one *one = &watch->one[rank];
        if (one->named || one->left || now - one->heard < RANKS_WATCH_PATIENCE)
            continue;
        one->named = true;
        mf_ranks_warn("rank %d on %s has not been heard of for %d s: it hangs, or its computer or "
                      "network does",
                      rank, mf_ranks_host(rank), RANKS_WATCH_PATIENCE);
    }
}
