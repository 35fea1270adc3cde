// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rank 0 hands out and collects; see base/letter.h for what is said.
#include "base/parallel_ranks.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/letter.h"
#include "base/parallel_times.h"
#include "base/ranks.h"
#include "base/ranks_pause.h"
#include "base/ranks_watch.h"

#include <pthread.h>
#include <string.h>

/// Tasks that are being done. What threads share is behind the lock.
struct round {
    const struct parallel_tasks *tasks;
    uint64_t turn;
    struct ranks_watch watch;
    pthread_mutex_t lock;
    pthread_cond_t changed; ///< a task has come, or has been finished
    struct ranks_pause pause;
    // of rank 0
    size_t next, open;               ///< task to be handed out; tasks that are being done
    struct parallel_failure failure; ///< of all ranks
    struct letter **left;            ///< shape [tasks]: what each has left; NULL: nothing
    bool over;                       ///< all is done
    int ready;                       ///< ranks that wait for what was found
    // of another rank, in the order of time
    size_t waiting, asked;  ///< threads without a task; tasks asked for
    size_t received, begun; ///< numbers of tasks that have come, and that threads took
    uint64_t *task;         ///< shape [received]
    size_t finished, sent;  ///< numbers of those that are done, and that were told of
    struct letter **told;   ///< shape [finished]
    bool none_left;
};

// Rank 0 ------------------------------------------------------------------------------------------

/// The next task, or LETTER_NO_TASK. Tasks go in their order: all below one that failed have begun.
static uint64_t hand_out(struct round *round) {
    uint64_t task = LETTER_NO_TASK;
    pthread_mutex_lock(&round->lock);
    if (round->next < round->tasks->count &&
        parallel_failure_allows(&round->failure, round->next)) {
        task = round->next++;
        round->open++;
    }
    pthread_mutex_unlock(&round->lock);
    return task;
}

/// A task has succeeded, here or elsewhere, or has failed: then the letter has its message.
static void collect(struct round *round, struct letter *letter, const void *result) {
    pthread_mutex_lock(&round->lock);
    mf_parallel_times_add(round->tasks->count, letter->seconds);
    mf_ranks_pause_note(letter->seconds);
    if (letter->status == STATUS_OK) {
        if (round->tasks->take)
            round->tasks->take(round->tasks->context, letter->task, result);
        round->left[letter->task] = letter;
    } else {
        parallel_failure_note(&round->failure, letter->status, letter->task, letter_bytes(letter));
        mf_memory_free(letter);
    }
    round->open--;
    pthread_cond_signal(&round->changed);
    pthread_mutex_unlock(&round->lock);
}

static void tell_all(const struct letter *letter) {
    for (int rank = 1; rank < mf_ranks_count(); rank++)
        mf_letter_send(rank, letter);
}

static void stop_all(const struct round *round, int signal_number) {
    if (mf_interrupt_requested())
        return;
    mf_interrupt_agree(signal_number);
    tell_all(&(struct letter){
        .kind = LETTER_STOP, .turn = round->turn, .task = (uint64_t)signal_number});
}

static bool is_over(struct round *round) {
    pthread_mutex_lock(&round->lock);
    const bool over = round->over;
    pthread_mutex_unlock(&round->lock);
    return over;
}

/// Answer a letter, or keep it.
static void serve(struct round *round, int from, struct letter *letter) {
    struct letter answer = {.turn = round->turn};
    mf_ranks_watch_hear(&round->watch, from);
    switch (letter->turn == round->turn ? (enum letter_kind)letter->kind : LETTER_ARRIVED) {
    case LETTER_RESULT:
        collect(round, letter,
                letter->status == STATUS_OK ? mf_letter_unpack(letter, round->tasks) : NULL);
        return;
    case LETTER_ASK:
        answer.kind = LETTER_TASK;
        answer.task = hand_out(round);
        mf_letter_send(from, &answer);
        break;
    case LETTER_ALIVE:
        answer.kind = LETTER_ALIVE;
        mf_letter_send(from, &answer);
        break;
    case LETTER_WISH: // who has gone on hears of it in the next round
        if (!is_over(round))
            stop_all(round, (int)letter->task);
        break;
    case LETTER_READY:
        round->ready++;
        mf_ranks_watch_leave(&round->watch, from);
        break;
    default:
        mf_letter_stop_strayed(from, letter);
    }
    mf_memory_free(letter);
}

static void listen_once(struct round *round) {
    int from;
    struct letter *letter = mf_letter_receive(round->turn, &from);
    if (letter)
        serve(round, from, letter);
    else
        mf_ranks_pause(&round->pause, is_over(round));
    mf_ranks_watch_look(&round->watch);
}

static void *lead(void *memory) {
    struct round *round = memory;
    while (!is_over(round)) {
        listen_once(round);
        if (mf_interrupt_signal() != 0)
            stop_all(round, mf_interrupt_signal());
    }
    tell_all(&(struct letter){.kind = LETTER_OVER, .turn = round->turn});
    // What all do together cannot tell who is missing.
    while (round->ready < mf_ranks_count() - 1)
        listen_once(round);
    return NULL;
}

/// Wait for tasks that others still do.
static void wait_for_all(struct round *round) {
    pthread_mutex_lock(&round->lock);
    while (round->open > 0)
        pthread_cond_wait(&round->changed, &round->lock);
    round->over = true;
    mf_ranks_pause_end(&round->pause);
    pthread_mutex_unlock(&round->lock);
}

// Another rank ------------------------------------------------------------------------------------

/// Wait for a task.
static uint64_t ask(struct round *round) {
    uint64_t task = LETTER_NO_TASK;
    pthread_mutex_lock(&round->lock);
    round->waiting++;
    mf_ranks_pause_end(&round->pause);
    while (round->begun == round->received && !round->none_left)
        pthread_cond_wait(&round->changed, &round->lock);
    round->waiting--;
    if (round->begun < round->received)
        task = round->task[round->begun++];
    pthread_mutex_unlock(&round->lock);
    return task;
}

static void deliver(struct round *round, struct letter *letter) {
    pthread_mutex_lock(&round->lock);
    round->told[round->finished++] = letter;
    mf_ranks_pause_note(letter->seconds);
    mf_ranks_pause_end(&round->pause);
    pthread_mutex_unlock(&round->lock);
}

static void hear(struct round *round, const struct letter *letter) {
    mf_ranks_watch_hear(&round->watch, 0);
    pthread_mutex_lock(&round->lock);
    if (letter->kind == LETTER_TASK)
        round->asked--;
    if (letter->kind == LETTER_TASK && letter->task != LETTER_NO_TASK)
        round->task[round->received++] = letter->task;
    else if (letter->kind == LETTER_TASK)
        round->none_left = true;
    else if (letter->kind == LETTER_STOP)
        mf_interrupt_agree((int)letter->task);
    else if (letter->kind == LETTER_OVER)
        round->over = round->none_left = true;
    pthread_cond_broadcast(&round->changed);
    pthread_mutex_unlock(&round->lock);
}

/// The next letter to rank 0, a result before a question; NULL if there is none. To be freed.
static struct letter *next_letter(struct round *round) {
    struct letter *letter = NULL;
    pthread_mutex_lock(&round->lock);
    const size_t coming = round->received - round->begun + round->asked;
    if (round->sent < round->finished) {
        letter = round->told[round->sent++];
    } else if (round->waiting > coming && !round->none_left) {
        letter = mf_letter_new(&(struct letter){.kind = LETTER_ASK, .turn = round->turn});
        round->asked++;
    }
    pthread_mutex_unlock(&round->lock);
    return letter;
}

/// Tell rank 0 what there is to tell. @return whether there was anything
static bool tell_leader(struct round *round, bool *wished) {
    struct letter *letter = next_letter(round);
    if (letter)
        mf_letter_send(0, letter);
    mf_memory_free(letter);
    if (mf_interrupt_signal() != 0 && !*wished)
        mf_letter_send(0, &(struct letter){.kind = LETTER_WISH,
                                           .turn = round->turn,
                                           .task = (uint64_t)mf_interrupt_signal()});
    *wished = mf_interrupt_signal() != 0;
    if (mf_ranks_watch_is_due(&round->watch))
        mf_letter_send(0, &(struct letter){.kind = LETTER_ALIVE, .turn = round->turn});
    return letter != NULL;
}

static void *follow(void *memory) {
    struct round *round = memory;
    bool wished = false;
    while (!round->over) {
        int from;
        const bool told = tell_leader(round, &wished);
        struct letter *letter = mf_letter_receive(round->turn, &from);
        if (letter)
            hear(round, letter);
        else if (!told)
            mf_ranks_pause(&round->pause, round->asked > 0);
        mf_memory_free(letter);
        mf_ranks_watch_look(&round->watch);
    }
    mf_letter_send(0, &(struct letter){.kind = LETTER_READY, .turn = round->turn});
    return NULL;
}

// All ranks ---------------------------------------------------------------------------------------

static void do_task(struct round *round, uint64_t task) {
    const struct parallel_tasks *tasks = round->tasks;
    struct letter head = {.kind = LETTER_RESULT, .turn = round->turn, .task = task};
    void *result =
        tasks->result_size > 0 ? mf_letter_or_stop(mf_memory_zeroed(1, tasks->result_size)) : NULL;
    const double begin = clock_thread_seconds();
    head.status = tasks->run(tasks->context, task, result);
    head.seconds = clock_thread_seconds() - begin;
    struct letter *letter = head.status == STATUS_OK
                                ? mf_letter_of_task(&head, tasks, result)
                                : mf_letter_of_message(&head, mf_status_message());
    mf_memory_free(result);
    if (ranks_lead())
        collect(round, letter, tasks->result_size > 0 ? letter_bytes(letter) : NULL);
    else
        deliver(round, letter);
}

static void work(struct round *round) {
    uint64_t task;
    while ((task = ranks_lead() ? hand_out(round) : ask(round)) != LETTER_NO_TASK)
        do_task(round, task);
}

/// Do tasks with all threads until none is left on any rank, while one more thread talks.
static void work_together(struct round *round) {
    const size_t count = round->tasks->count;
    pthread_t talker;
    if (pthread_create(&talker, NULL, ranks_lead() ? lead : follow, round) != 0)
        mf_ranks_stop(3, "a thread that talks to other ranks cannot begin");
        // One task has the threads for itself.
#pragma omp parallel num_threads(round->tasks->threads) if (round->tasks->threads > 1 && count > 1)
    work(round);
    if (ranks_lead())
        wait_for_all(round);
    pthread_join(talker, NULL);
}

/// Bytes of a piece that a letter of so many bytes takes, with its head.
static size_t room(uint64_t bytes) {
    return (bytes + sizeof(uint64_t) - 1) / sizeof(uint64_t) * sizeof(uint64_t);
}

static void take_over(const struct round *round, const struct letter *letter) {
    const struct parallel_tasks *tasks = round->tasks;
    const void *result = mf_letter_unpack(letter, tasks);
    if (tasks->take)
        tasks->take(tasks->context, letter->task, result);
}

/// Letters first … end − 1, one behind the other, from rank 0 to all.
static void share_piece(const struct round *round, const uint64_t *bytes, size_t first, size_t end,
                        size_t total) {
    char *piece = mf_letter_or_stop(mf_memory_zeroed(total, 1)), *at = piece;
    for (size_t k = first; k < end; at += room(bytes[k++]))
        if (ranks_lead() && bytes[k] > 0)
            memcpy(at, round->left[k], bytes[k]);
    mf_ranks_share(piece, total);
    at = piece;
    for (size_t k = first; k < end; at += room(bytes[k++]))
        if (!ranks_lead() && bytes[k] > 0)
            take_over(round, (const struct letter *)at);
    mf_memory_free(piece);
}

/// What tasks have left, from rank 0 to all, many in a piece.
static void share_letters(const struct round *round) {
    enum { PIECE = 1 << 25 };
    const size_t count = round->tasks->count;
    uint64_t *bytes = mf_letter_or_stop(mf_memory_zeroed(count, sizeof *bytes));
    for (size_t k = 0; ranks_lead() && k < count; k++)
        bytes[k] = round->left[k] ? sizeof(struct letter) + round->left[k]->bytes : 0;
    mf_ranks_share(bytes, count * sizeof *bytes);
    for (size_t first = 0, end = 0; first < count; first = end) {
        size_t total = 0;
        while (end < count && total < PIECE)
            total += room(bytes[end++]);
        share_piece(round, bytes, first, end, total);
    }
    mf_memory_free(bytes);
}

static void round_init(struct round *round, const struct parallel_tasks *tasks) {
    *round = (struct round){.tasks = tasks, .turn = mf_letter_turn(), .failure.task = tasks->count};
    mf_ranks_watch_init(&round->watch);
    pthread_mutex_init(&round->lock, NULL);
    pthread_cond_init(&round->changed, NULL);
    mf_ranks_pause_init(&round->pause, &round->lock);
    round->left = mf_letter_or_stop(mf_memory_zeroed(tasks->count, sizeof *round->left));
    round->told = mf_letter_or_stop(mf_memory_zeroed(tasks->count, sizeof *round->told));
    round->task = mf_letter_or_stop(mf_memory_zeroed(tasks->count, sizeof *round->task));
}

static void round_clear(struct round *round) {
    for (size_t k = 0; k < round->tasks->count; k++)
        mf_memory_free(round->left[k]);
    mf_memory_free(round->left);
    mf_memory_free(round->told);
    mf_memory_free(round->task);
    pthread_mutex_destroy(&round->lock);
    pthread_cond_destroy(&round->changed);
    mf_ranks_pause_clear(&round->pause);
    mf_ranks_watch_clear(&round->watch);
}

enum status mf_parallel_try_together(const struct parallel_tasks *tasks) {
    struct round round;
    round_init(&round, tasks);
    work_together(&round);
    mf_ranks_share(&round.failure, sizeof round.failure);
    share_letters(&round);
    const enum status status = parallel_failure_status(&round.failure);
    round_clear(&round);
    return status;
}
