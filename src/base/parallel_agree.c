// SPDX-License-Identifier: GPL-3.0-or-later
//
// Between tasks: ranks go on together, or stop together.
#include "base/letter.h"
#include "base/ranks.h"
#include "base/ranks_watch.h"

#include <stdio.h>

/// The next letter of this turn, however long that takes.
static struct letter *await(uint64_t turn, struct ranks_watch *watch, int *from) {
    struct letter *letter;
    while ((letter = mf_letter_receive(turn, from)) == NULL) {
        mf_ranks_watch_look(watch);
        mf_ranks_rest();
    }
    mf_ranks_watch_hear(watch, *from);
    return letter;
}

/// What all go on with: rank 0's failure, else that of the lowest rank.
struct verdict {
    int rank; ///< the number of ranks while nobody has failed
    enum status status;
    char message[STATUS_MESSAGE_SIZE];
};

static void weigh(struct verdict *verdict, int rank, const struct letter *letter, uint64_t digest) {
    const bool alike = letter->task == digest;
    if (rank >= verdict->rank || (letter->status == STATUS_OK && alike))
        return;
    verdict->rank = rank;
    verdict->status = letter->status == STATUS_OK ? STATUS_BAD_INPUT : letter->status;
    snprintf(verdict->message, sizeof verdict->message, "rank %d on %s: %s", rank,
             mf_ranks_host(rank),
             letter->status != STATUS_OK
                 ? (const char *)letter_bytes(letter)
                 : "it has computed other numbers than rank 0: all must have the same program, the "
                   "same input and processors of one kind");
}

/// Rank 0: wait for all.
static void judge(uint64_t turn, uint64_t digest, struct verdict *verdict) {
    struct ranks_watch watch;
    mf_ranks_watch_init(&watch);
    for (int missing = mf_ranks_count() - 1, from; missing > 0; missing--) {
        struct letter *letter = await(turn, &watch, &from);
        if (letter->turn != turn || letter->kind != LETTER_ARRIVED) {
            if (verdict->status != STATUS_OK) // and the others have gone on
                mf_ranks_stop(2, "%s", verdict->message);
            mf_letter_stop_strayed(from, letter);
        }
        mf_ranks_watch_leave(&watch, from);
        weigh(verdict, from, letter, digest);
        mf_memory_free(letter);
    }
    mf_ranks_watch_clear(&watch);
}

void mf_parallel_share(const struct memory_span *spans, size_t count) {
    for (size_t k = 0; k < count; k++)
        mf_ranks_share(spans[k].memory, spans[k].bytes);
}

enum status mf_parallel_agree(enum status status, uint64_t digest) {
    if (mf_ranks_count() == 1)
        return status;
    const uint64_t turn = mf_letter_turn();
    struct verdict verdict = {.rank = status == STATUS_OK ? mf_ranks_count() : 0, .status = status};
    if (status != STATUS_OK)
        snprintf(verdict.message, sizeof verdict.message, "%s", mf_status_message());
    const struct letter head = {
        .kind = LETTER_ARRIVED, .turn = turn, .task = digest, .status = (int32_t)status};
    if (ranks_lead()) {
        judge(turn, digest, &verdict);
    } else {
        struct letter *letter = mf_letter_of_message(&head, verdict.message);
        mf_letter_send(0, letter);
        mf_memory_free(letter);
    }
    mf_ranks_share(&verdict, sizeof verdict);
    return verdict.status == STATUS_OK ? STATUS_OK
                                       : mf_status_fail(verdict.status, "%s", verdict.message);
}
