// SPDX-License-Identifier: GPL-3.0-or-later
//
// A stream among ranks: rank 0 knows how many threads of each rank are idle, and sends each a task
// of its own; a letter with a result says that the thread is idle again. Each time that the stream
// is open is a turn (base/letter.h). Large letters may be overtaken, so that both sides count what
// the other says that it has sent before they leave a turn.
#include "base/parallel_stream_state.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/ranks.h"

#include <string.h>

/// Nobody writes letters of the next turn before rank 0 has had all of this one.
static void part(uint64_t turn) {
    mf_ranks_share(&turn, sizeof turn);
}

/// Bytes of a task, behind which the result stands in a letter.
static size_t task_room(const struct parallel_stream_tasks *tasks) {
    return (tasks->task_size + sizeof(uint64_t) - 1) / sizeof(uint64_t) * sizeof(uint64_t);
}

static void check_bytes(const struct letter *letter, size_t bytes) {
    if (letter->bytes != bytes)
        mf_ranks_stop(2,
                      "ranks do not run the same program on the same input: a letter has %llu "
                      "bytes in place of %zu",
                      (unsigned long long)letter->bytes, bytes);
}

// Rank 0 ------------------------------------------------------------------------------------------

enum status mf_parallel_stream_others_begin(struct parallel_stream *stream) {
    enum status status = STATUS_OK;
    NEW_ARRAY(stream->others, 1);
    NEW_ARRAY(stream->others->given, (size_t)mf_ranks_count());
    NEW_ARRAY(stream->others->idle, (size_t)mf_ranks_count());
done:
    return status;
}

void mf_parallel_stream_others_end(struct stream_others *others) {
    if (others == NULL)
        return;
    for (struct stream_mail *mail = others->first, *next; mail; mail = next) {
        next = mail->next;
        mf_memory_free(mail->letter);
        mf_memory_free(mail);
    }
    mf_memory_free(others->taken);
    mf_memory_free(others->given);
    mf_memory_free(others->idle);
    mf_memory_free(others);
}

/// The rank that has most idle threads; 0: none has.
static int find_idle(const struct stream_others *others) {
    int most = 0;
    for (int rank = 1; rank < mf_ranks_count(); rank++)
        if (others->idle[rank] > others->idle[most])
            most = rank;
    return most;
}

bool mf_parallel_stream_others_have_idle(const struct stream_others *others) {
    return find_idle(others) > 0;
}

void mf_parallel_stream_others_give(struct parallel_stream *stream, const void *task) {
    struct stream_others *others = stream->others;
    const int rank = find_idle(others);
    struct letter *letter = mf_letter_new(&(struct letter){
        .kind = LETTER_TASK, .turn = others->turn, .bytes = stream->tasks.task_size});
    memcpy(letter_bytes(letter), task, stream->tasks.task_size);
    mf_letter_send(rank, letter);
    mf_memory_free(letter);
    others->idle[rank]--;
    others->given[rank]++;
    others->open++;
}

/// Keep a letter until its result is taken.
static void keep(struct stream_others *others, struct letter *letter) {
    struct stream_mail *mail = mf_letter_or_stop(mf_memory_zeroed(1, sizeof *mail));
    mail->letter = letter;
    if (others->first)
        others->last->next = mail;
    else
        others->first = mail;
    others->last = mail;
}

bool mf_parallel_stream_others_take(struct parallel_stream *stream,
                                    struct stream_outcome *outcome) {
    struct stream_others *others = stream->others;
    struct stream_mail *mail = others->first;
    if (mail == NULL)
        return false;
    others->first = mail->next;
    others->open--;
    mf_memory_free(others->taken);
    const struct letter *letter = others->taken = mail->letter;
    mf_memory_free(mail);
    const char *bytes = letter_bytes(letter);
    *outcome = (struct stream_outcome){.task = bytes,
                                       .result = bytes + task_room(&stream->tasks),
                                       .seconds = letter->seconds,
                                       .status = letter->status,
                                       .message = bytes};
    return true;
}

static void hear_result(struct parallel_stream *stream, int from, struct letter *letter) {
    struct stream_others *others = stream->others;
    if (letter->status == STATUS_OK)
        check_bytes(letter, task_room(&stream->tasks) + stream->tasks.result_size);
    others->heard++;
    others->idle[from]++;
    keep(others, letter);
}

/// Answer a letter, or keep it.
static void serve(struct parallel_stream *stream, int from, struct letter *letter) {
    struct stream_others *others = stream->others;
    mf_ranks_watch_hear(&others->watch, from);
    switch (letter->turn == others->turn ? (enum letter_kind)letter->kind : LETTER_ARRIVED) {
    case LETTER_RESULT:
        hear_result(stream, from, letter);
        return;
    case LETTER_ASK:
        others->present++;
        others->idle[from] = letter->task;
        break;
    case LETTER_ALIVE:
        mf_letter_send(from, &(struct letter){.kind = LETTER_ALIVE, .turn = others->turn});
        break;
    case LETTER_WISH: // who has left hears of it in the next turn
        if (!others->closing)
            mf_letter_stop_all(others->turn, (int)letter->task);
        break;
    case LETTER_READY:
        others->ready++;
        mf_ranks_watch_leave(&others->watch, from);
        others->told += letter->task;
        break;
    default:
        mf_letter_stop_strayed(from, letter);
    }
    mf_memory_free(letter);
}

void mf_parallel_stream_others_listen(struct parallel_stream *stream) {
    struct stream_others *others = stream->others;
    struct letter *letter;
    int from;
    while ((letter = mf_letter_receive(others->turn, &from)))
        serve(stream, from, letter);
    if (mf_interrupt_signal() != 0 && !others->closing)
        mf_letter_stop_all(others->turn, mf_interrupt_signal());
    mf_ranks_watch_look(&others->watch);
}

void mf_parallel_stream_open(struct parallel_stream *stream) {
    struct stream_others *others = stream->others;
    if (others == NULL)
        return;
    others->turn = mf_letter_turn();
    others->closing = false;
    others->present = others->ready = 0;
    others->told = others->heard = 0;
    mf_ranks_watch_init(&others->watch);
    for (int rank = 1; rank < mf_ranks_count(); rank++)
        others->given[rank] = 0;
    while (mf_parallel_stream_others_listen(stream), others->present < mf_ranks_count() - 1)
        mf_ranks_pause(&stream->pause, true);
}

void mf_parallel_stream_close(struct parallel_stream *stream) {
    struct stream_others *others = stream->others;
    if (others == NULL)
        return;
    others->closing = true;
    for (int rank = 1; rank < mf_ranks_count(); rank++)
        mf_letter_send(rank, &(struct letter){.kind = LETTER_OVER,
                                              .turn = others->turn,
                                              .task = others->given[rank]});
    while (mf_parallel_stream_others_listen(stream),
           others->ready < mf_ranks_count() - 1 || others->heard < others->told)
        mf_ranks_pause(&stream->pause, true);
    for (int rank = 1; rank < mf_ranks_count(); rank++)
        others->idle[rank] = 0;
    mf_ranks_watch_clear(&others->watch);
    part(others->turn);
}

// Another rank ------------------------------------------------------------------------------------

struct follower {
    struct parallel_stream *stream;
    uint64_t turn;
    struct ranks_watch watch;
    uint64_t received, told; ///< tasks and results of this turn
    uint64_t given;          ///< tasks of this turn, once it is over
    bool over, wished;
};

static void hear(struct follower *follower, const struct letter *letter) {
    mf_ranks_watch_hear(&follower->watch, 0);
    if (letter->kind == LETTER_TASK) {
        check_bytes(letter, follower->stream->tasks.task_size);
        mf_parallel_stream_give_own(follower->stream, letter_bytes(letter));
        follower->received++;
    } else if (letter->kind == LETTER_STOP) {
        mf_interrupt_agree((int)letter->task);
    } else if (letter->kind == LETTER_OVER) {
        follower->over = true;
        follower->given = letter->task;
    }
}

static struct letter *letter_of(const struct follower *follower,
                                const struct stream_outcome *outcome) {
    const struct parallel_stream_tasks *tasks = &follower->stream->tasks;
    struct letter head = {.kind = LETTER_RESULT,
                          .turn = follower->turn,
                          .bytes = task_room(tasks) + tasks->result_size,
                          .seconds = outcome->seconds,
                          .status = (int32_t)outcome->status};
    if (outcome->status != STATUS_OK)
        return mf_letter_of_message(&head, outcome->message);
    struct letter *letter = mf_letter_new(&head);
    char *to = letter_bytes(letter);
    memcpy(to, outcome->task, tasks->task_size);
    memcpy(to + task_room(tasks), outcome->result, tasks->result_size);
    return letter;
}

/// Tell rank 0 what a thread has done. @return whether there was anything
static bool tell_result(struct follower *follower) {
    struct stream_outcome outcome;
    if (!mf_parallel_stream_take_own(follower->stream, &outcome))
        return false;
    struct letter *letter = letter_of(follower, &outcome);
    mf_letter_send(0, letter);
    mf_memory_free(letter);
    mf_ranks_pause_note(outcome.seconds);
    follower->told++;
    return true;
}

/// @return whether there was anything to tell or to hear
static bool talk(struct follower *follower) {
    int from;
    const bool told = !follower->over && tell_result(follower);
    struct letter *letter = mf_letter_receive(follower->turn, &from);
    if (letter)
        hear(follower, letter);
    mf_letter_tell_standing(follower->turn, &follower->watch, &follower->wished);
    mf_ranks_watch_look(&follower->watch);
    mf_memory_free(letter);
    return told || letter != NULL;
}

void mf_parallel_stream_follow(struct parallel_stream *stream) {
    struct follower follower = {.stream = stream, .turn = mf_letter_turn()};
    mf_ranks_watch_init(&follower.watch);
    mf_letter_send(0, &(struct letter){.kind = LETTER_ASK,
                                       .turn = follower.turn,
                                       .task = mf_parallel_stream_count_idle(stream)});
    while (!follower.over || follower.received < follower.given)
        if (!talk(&follower))
            mf_ranks_pause(&stream->pause, mf_parallel_stream_count_idle(stream) > 0);
    mf_letter_send(
        0, &(struct letter){.kind = LETTER_READY, .turn = follower.turn, .task = follower.told});
    mf_ranks_watch_clear(&follower.watch);
    part(follower.turn);
}
