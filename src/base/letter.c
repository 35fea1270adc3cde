// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/letter.h"

#include "base/ranks.h"

#include <string.h>

_Static_assert(sizeof(struct letter) % sizeof(uint64_t) == 0, "a head of whole words");

uint64_t mf_letter_turn(void) {
    static uint64_t turns;
    return ++turns;
}

void *mf_letter_or_stop(void *memory) {
    if (memory == NULL)
        mf_ranks_stop(3, "%s", mf_status_message());
    return memory;
}

static size_t words_of(const struct letter *letter) {
    return letter_room(letter) / sizeof(uint64_t);
}

struct letter *mf_letter_new(const struct letter *head) {
    struct letter *letter = mf_letter_or_stop(mf_memory_zeroed(words_of(head), sizeof(uint64_t)));
    *letter = *head;
    return letter;
}

struct letter *mf_letter_of_message(const struct letter *head, const char *message) {
    struct letter with = *head;
    with.bytes = strlen(message) + 1;
    struct letter *letter = mf_letter_new(&with);
    memcpy(letter_bytes(letter), message, with.bytes);
    return letter;
}

struct letter mf_letter_sized(const struct letter *head, const struct parallel_tasks *tasks) {
    struct memory_span span[PARALLEL_MOST_SPANS];
    const size_t spans = tasks->spans(tasks->context, head->task, span);
    struct letter with = *head;
    with.bytes = tasks->result_size;
    for (size_t k = 0; k < spans; k++)
        with.bytes += sizeof(uint64_t) + span[k].bytes;
    return with;
}

void mf_letter_write(struct letter *letter, const struct parallel_tasks *tasks,
                     const void *result) {
    struct memory_span span[PARALLEL_MOST_SPANS];
    const size_t spans = tasks->spans(tasks->context, letter->task, span);
    char *to = letter_bytes(letter);
    if (tasks->result_size > 0)
        memcpy(to, result, tasks->result_size);
    to += tasks->result_size;
    for (size_t k = 0; k < spans; k++) {
        const uint64_t bytes = span[k].bytes;
        memcpy(to, &bytes, sizeof bytes);
        if (bytes > 0)
            memcpy(to + sizeof bytes, span[k].memory, bytes);
        to += sizeof bytes + bytes;
    }
}

struct letter *mf_letter_of_task(const struct letter *head, const struct parallel_tasks *tasks,
                                 const void *result) {
    const struct letter with = mf_letter_sized(head, tasks);
    struct letter *letter = mf_letter_new(&with);
    mf_letter_write(letter, tasks, result);
    return letter;
}

void mf_letter_send(int to, const struct letter *letter) {
    mf_ranks_send(to, (const uint64_t *)letter, words_of(letter));
}

struct letter *mf_letter_receive(uint64_t turn, int *from) {
    size_t words;
    struct letter *letter;
    while ((letter = (struct letter *)mf_ranks_receive(from, &words)) && letter->turn < turn)
        mf_memory_free(letter);
    return letter;
}

/// Lengths may follow from the spans before, so that they are listed anew for each.
static bool unpack_span(const struct parallel_tasks *tasks, uint64_t task, size_t number,
                        const char **from, size_t *left) {
    struct memory_span span[PARALLEL_MOST_SPANS];
    uint64_t bytes;
    if (*left < sizeof bytes)
        return false;
    memcpy(&bytes, *from, sizeof bytes);
    if (number >= tasks->spans(tasks->context, task, span) || span[number].bytes != bytes ||
        *left - sizeof bytes < bytes)
        return false;
    if (bytes > 0)
        memcpy(span[number].memory, *from + sizeof bytes, bytes);
    *from += sizeof bytes + bytes;
    *left -= sizeof bytes + bytes;
    return true;
}

bool mf_letter_read(const struct letter *letter, const struct parallel_tasks *tasks,
                    const void **result) {
    const char *from = letter_bytes(letter);
    size_t left = letter->bytes;
    bool fits = left >= tasks->result_size;
    from += tasks->result_size;
    left -= fits ? tasks->result_size : left;
    for (size_t number = 0; fits && left > 0; number++)
        fits = unpack_span(tasks, letter->task, number, &from, &left);
    *result = tasks->result_size > 0 ? letter_bytes(letter) : NULL;
    return fits;
}

const void *mf_letter_unpack(const struct letter *letter, const struct parallel_tasks *tasks) {
    const void *result;
    if (!mf_letter_read(letter, tasks, &result))
        mf_ranks_stop(2,
                      "ranks do not run the same program on the same input: task %llu left "
                      "something else",
                      (unsigned long long)letter->task);
    return result;
}

void mf_letter_stop_strayed(int from, const struct letter *letter) {
    const bool failed = letter->kind == LETTER_ARRIVED && letter->status != STATUS_OK;
    mf_ranks_stop(2, "rank %d on %s %s", from, mf_ranks_host(from),
                  failed ? (const char *)letter_bytes(letter)
                         : "does not do the same as rank 0: its program or its input is another");
}
