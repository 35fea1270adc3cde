// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/ranks.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/task_log.h"

#include <limits.h>
#include <math.h>
#include <mpi.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { HOST_SIZE = MPI_MAX_PROCESSOR_NAME };
enum tag { TAG_REPORT, TAG_RESULT, TAG_TASK };

static struct {
    int count, number;
    bool begun;
    char (*host)[HOST_SIZE]; ///< shape [count]
    uint64_t calls;          ///< of mf_ranks_check and mf_ranks_try: the same on all ranks
} job = {.count = 1};

enum status mf_ranks_begin(void) {
    char own[HOST_SIZE] = "";
    int provided, length;
    // Errors of MPI end the job by its own handler: a rank that is lost cannot be gone on without.
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_MULTIPLE, &provided) != MPI_SUCCESS)
        return mf_status_fail(STATUS_IO, "MPI cannot begin");
    job.begun = true;
    MPI_Comm_size(MPI_COMM_WORLD, &job.count);
    MPI_Comm_rank(MPI_COMM_WORLD, &job.number);
    if (job.count > 1 && provided < MPI_THREAD_MULTIPLE)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "this MPI lets no threads call it (MPI_THREAD_MULTIPLE)");
    job.host = mf_memory_zeroed((size_t)job.count, HOST_SIZE);
    if (job.host == NULL)
        return STATUS_NO_MEMORY;
    MPI_Get_processor_name(own, &length);
    MPI_Allgather(own, HOST_SIZE, MPI_CHAR, job.host, HOST_SIZE, MPI_CHAR, MPI_COMM_WORLD);
    if (job.count > 1)
        mf_interrupt_defer();
    return STATUS_OK;
}

int mf_ranks_count(void) {
    return job.count;
}

int mf_ranks_number(void) {
    return job.number;
}

/// End all ranks, with the message of this failure.
static _Noreturn void stop(enum status status) {
    const int exit_code = status == STATUS_NO_MEMORY ? 3 : 2;
    fprintf(stderr, "mesofit: %s\n", mf_status_message());
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    exit(exit_code);
}

static _Noreturn void stop_diverged(void) {
    stop(mf_status_fail(STATUS_BAD_INPUT, "ranks do not run the same program on the same input"));
}

/// New memory; without it the others would wait for this rank.
static void *or_stop(void *memory) {
    if (memory == NULL)
        stop(STATUS_NO_MEMORY);
    return memory;
}

// Waiting -----------------------------------------------------------------------------------------

/// How long to rest between two looks for messages [s]: MPI itself would turn in circles and take a
/// processor from the tasks. A look costs 2e-5 s of it. While tasks are done here, looks become
/// rare as long as nothing comes, and a task of 100 ms that asks for the next waits some ms.
static const double SHORTEST = 3e-4, LONGEST = 5e-3, GROWTH = 1.1;

/// Returns how long that took [s], but for a time in which the whole job was suspended.
static double rest(double seconds) {
    static const double SUSPENDED = 1;
    const double begin = clock_seconds();
    nanosleep(&(struct timespec){.tv_nsec = (long)(1e9 * seconds)}, NULL);
    return fmin(clock_seconds() - begin, SUSPENDED);
}

static void finish(int count, MPI_Request *request) {
    for (int done = 0; MPI_Testall(count, request, &done, MPI_STATUSES_IGNORE), !done;)
        rest(SHORTEST);
}

static void broadcast(void *memory, size_t bytes) {
    enum { PIECE = 1 << 30 };
    MPI_Request request;
    for (size_t done = 0; done < bytes; done += PIECE) {
        const size_t left = bytes - done;
        MPI_Ibcast((char *)memory + done, (int)(left < PIECE ? left : PIECE), MPI_BYTE, 0,
                   MPI_COMM_WORLD, &request);
        finish(1, &request);
    }
}

void mf_ranks_broadcast(const struct memory_span *spans, size_t count) {
    for (size_t k = 0; job.count > 1 && k < count; k++)
        broadcast(spans[k].memory, spans[k].bytes);
}

void mf_ranks_end(void) {
    MPI_Request request;
    if (!job.begun)
        return;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    finish(1, &request);
    MPI_Finalize();
    mf_memory_free(job.host);
    job.begun = false;
}

// Tasks of a call ---------------------------------------------------------------------------------

static const uint64_t NO_TASK = UINT64_MAX;

/// What the threads of a rank share. On rank 0 the call and `next` are behind the lock.
struct round {
    struct parallel_call *call;
    atomic_bool working; ///< threads of this rank do tasks, or ask for one
    double pause;        ///< of the thread that talks to other ranks [s]
    pthread_mutex_t lock;
    size_t next; ///< task to be handed out
};

/// A task has ended here, or on another rank, which has changed its own context alone.
static void collect(struct parallel_call *call, const struct task_record *record, bool is_here) {
    const struct parallel_tasks *tasks = call->tasks;
    const void *result = tasks->result_size > 0 ? task_record_bytes(record) : NULL;
    parallel_call_end_task(call, record->task, (enum status)record->status,
                           task_record_bytes(record), record->seconds);
    if (record->status != STATUS_OK)
        return;
    if (!is_here && !mf_task_record_restore(record, tasks, &result))
        stop_diverged();
    if (mf_task_log_add(call->log, record) != STATUS_OK)
        stop(STATUS_NO_MEMORY);
    if (tasks->take)
        tasks->take(tasks->context, record->task, result);
}

/// Rank 0 gives a thread the next task. They go in their order: all below one that failed have
/// begun.
static uint64_t next_task(struct round *round, const struct task_record *finished, bool is_here) {
    const size_t count = round->call->tasks->count;
    pthread_mutex_lock(&round->lock);
    if (finished)
        collect(round->call, finished, is_here);
    while (round->next < count && !parallel_call_wants(round->call, round->next))
        round->next++;
    const uint64_t task = round->next < count ? round->next++ : NO_TASK;
    pthread_mutex_unlock(&round->lock);
    return task;
}

/// Rank 0 answers a thread of another rank, if one asks.
static bool serve(struct round *round) {
    int is_there, words;
    MPI_Message message;
    MPI_Status about;
    MPI_Improbe(MPI_ANY_SOURCE, TAG_RESULT, MPI_COMM_WORLD, &is_there, &message, &about);
    if (!is_there)
        return false;
    MPI_Get_count(&about, MPI_UINT64_T, &words);
    struct task_record *record = or_stop(mf_memory_uncleared((size_t)words, sizeof(uint64_t)));
    MPI_Mrecv(record, words, MPI_UINT64_T, &message, MPI_STATUS_IGNORE);
    const uint64_t task = next_task(round, words > 0 ? record : NULL, false);
    MPI_Send(&task, 1, MPI_UINT64_T, about.MPI_SOURCE, TAG_TASK, MPI_COMM_WORLD);
    mf_memory_free(record);
    return true;
}

/// Another rank asks for it. Whichever of its threads gets an answer does that task.
static uint64_t ask_for_task(const struct task_record *finished) {
    const size_t words = finished ? task_record_size(finished) / sizeof(uint64_t) : 0;
    uint64_t task;
    MPI_Request request[2];
    if (words > INT_MAX)
        stop(mf_status_fail(STATUS_BAD_INPUT, "a task has left more than MPI can send: %zu bytes",
                            words * sizeof(uint64_t)));
    MPI_Irecv(&task, 1, MPI_UINT64_T, 0, TAG_TASK, MPI_COMM_WORLD, &request[0]);
    MPI_Isend(finished, (int)words, MPI_UINT64_T, 0, TAG_RESULT, MPI_COMM_WORLD, &request[1]);
    finish(2, request);
    return task;
}

static struct task_record *do_task(const struct parallel_call *call, uint64_t task) {
    const struct parallel_tasks *tasks = call->tasks;
    struct task_record head = {.call = call->number, .task = task};
    void *result = or_stop(mf_memory_zeroed(1, tasks->result_size));
    const double begin = clock_thread_seconds();
    head.status = parallel_call_run(call, task, tasks->result_size > 0 ? result : NULL);
    head.seconds = clock_thread_seconds() - begin;
    struct task_record *record = or_stop(mf_task_record_create(&head, tasks, result));
    mf_memory_free(result);
    return record;
}

static void work(struct round *round) {
    struct task_record *finished = NULL;
    uint64_t task;
    while ((task = job.number == 0 ? next_task(round, finished, true) : ask_for_task(finished)) !=
           NO_TASK) {
        mf_memory_free(finished);
        finished = do_task(round->call, task);
    }
    mf_memory_free(finished);
}

// What all ranks report ---------------------------------------------------------------------------

/// Where in the program a rank is and how it is; then what all go on with.
struct report {
    uint64_t call;   ///< of mf_ranks_check or mf_ranks_try, by number
    uint64_t digest; ///< of what must be the same on all ranks
    int32_t is_check, status;
    int32_t signal;  ///< that has asked to stop
    int32_t working; ///< on tasks
    char message[STATUS_MESSAGE_SIZE];
};

static const size_t REPORT_HEAD = offsetof(struct report, message);

/// Serve another rank or rest; returns how long [s].
static double look(struct round *round) {
    if (round && job.number == 0 && serve(round)) {
        round->pause = SHORTEST;
        return 0;
    }
    if (round == NULL || !round->working)
        return rest(SHORTEST);
    round->pause = fmin(GROWTH * round->pause, LONGEST);
    return rest(round->pause);
}

/// Who has not reported for long hangs, or its computer or network does. It may come back.
static void name_missing(MPI_Request *request, int patience) {
    for (int rank = 1, is_there; rank < job.count; rank++) {
        MPI_Request_get_status(request[rank], &is_there, MPI_STATUS_IGNORE);
        if (!is_there)
            fprintf(stderr,
                    "mesofit: warning: rank %d on %s has not been heard of for %d s: it hangs, or "
                    "its computer or network does\n",
                    rank, job.host[rank], patience);
    }
}

/// Rank 0's report becomes that of all.
static void merge(struct report *all, int rank, const struct report *other) {
    static const char diverged[] = "it has computed other numbers than rank 0: all must have the "
                                   "same program, the same input and processors of one kind";
    const bool is_alike = other->digest == all->digest;
    const bool is_same_call = other->call == all->call && other->is_check == all->is_check;
    if (all->status == STATUS_OK && (other->status != STATUS_OK || !is_alike || !is_same_call)) {
        all->status = other->status != STATUS_OK ? other->status : STATUS_BAD_INPUT;
        mf_status_fail((enum status)all->status, "rank %d on %s: %s", rank, job.host[rank],
                       other->status != STATUS_OK ? other->message : diverged);
        memcpy(all->message, mf_status_marked(), sizeof all->message);
    }
    if (!is_same_call || (!is_alike && !all->is_check))
        stop(mf_status_fail((enum status)all->status, "%s", all->message));
    all->signal = all->signal ? all->signal : other->signal;
    all->working = all->working || other->working;
}

/// Rank 0 receives all reports, and serves threads of other ranks meanwhile.
static void gather(struct report *all, struct round *round) {
    enum { PATIENCE = 60 };
    const size_t count = (size_t)job.count;
    struct report *report = or_stop(mf_memory_uncleared(count, sizeof *report));
    MPI_Request *request = or_stop(mf_memory_uncleared(count, sizeof(MPI_Request)));
    double waited = 0;
    request[0] = MPI_REQUEST_NULL;
    for (int rank = 1; rank < job.count; rank++)
        MPI_Irecv(&report[rank], sizeof *report, MPI_BYTE, rank, TAG_REPORT, MPI_COMM_WORLD,
                  &request[rank]);
    for (int done = 0; MPI_Testall(job.count, request, &done, MPI_STATUSES_IGNORE), !done;) {
        waited += look(round);
        if (waited > PATIENCE) {
            name_missing(request, PATIENCE);
            waited = -INFINITY;
        }
    }
    all->working = round && round->working;
    for (int rank = 1; rank < job.count; rank++)
        merge(all, rank, &report[rank]);
    mf_memory_free(report);
    mf_memory_free(request);
}

/// All ranks report, and have the same report then.
static void meet(struct report *all, struct round *round) {
    if (job.number == 0)
        gather(all, round);
    else
        MPI_Send(all, (int)(REPORT_HEAD + strlen(all->message) + 1), MPI_BYTE, 0, TAG_REPORT,
                 MPI_COMM_WORLD);
    broadcast(all, REPORT_HEAD);
    if (all->status != STATUS_OK)
        broadcast(all->message, sizeof all->message);
}

enum status mf_ranks_check(enum status status, uint64_t digest) {
    struct report all = {
        .call = ++job.calls, .digest = digest, .is_check = true, .status = (int32_t)status};
    if (job.count == 1)
        return status;
    if (status != STATUS_OK)
        memcpy(all.message, mf_status_marked(), sizeof all.message);
    meet(&all, NULL);
    return all.status == STATUS_OK ? STATUS_OK
                                   : mf_status_fail((enum status)all.status, "%s", all.message);
}

// A round of tasks --------------------------------------------------------------------------------

/// A thread of its own talks to other ranks, so that rank 0 serves them while all its other threads
/// work, and a signal that one rank receives stops all, until no rank has a task.
static void *exchange_reports(void *memory) {
    static const double BETWEEN_REPORTS = 0.05;
    struct round *round = memory;
    struct report all = {.working = true};
    while (all.working) {
        for (double waited = 0; round->working && waited < BETWEEN_REPORTS;)
            waited += look(round);
        all = (struct report){.call = job.calls,
                              .digest = round->call->tasks->count,
                              .signal = mf_interrupt_signal(),
                              .working = round->working};
        meet(&all, round);
        mf_interrupt_stop_by(all.signal);
    }
    return NULL;
}

/// What rank 0 has collected goes to the others, which have seen their own tasks alone.
static void share(struct parallel_call *call) {
    struct task_log *log = call->log;
    broadcast(&call->status, sizeof call->status);
    if (call->status != STATUS_OK)
        broadcast(call->message, sizeof call->message);
    broadcast(&log->size, sizeof log->size);
    if (mf_task_log_reserve(log) != STATUS_OK)
        stop(STATUS_NO_MEMORY);
    broadcast(log->records + call->begin, log->size - call->begin);
    if (job.number != 0 && !mf_task_log_replay(call))
        stop_diverged();
    if (log->size > TASK_LOG_MAX)
        log->size = call->begin;
}

void mf_ranks_try(struct parallel_call *call) {
    const struct parallel_tasks *tasks = call->tasks;
    static struct task_log own; // where none is in use
    struct round round = {.call = call, .working = true, .pause = SHORTEST};
    pthread_t reporter;
    if (call->log == NULL)
        call->log = &own;
    job.calls++;
    pthread_mutex_init(&round.lock, NULL);
    if (pthread_create(&reporter, NULL, exchange_reports, &round) != 0)
        stop(mf_status_fail(STATUS_NO_MEMORY, "a thread that talks to other ranks cannot begin"));
        // One task has the threads for itself.
#pragma omp parallel num_threads(tasks->threads) if (tasks->threads > 1 && call->left > 1)
    work(&round);
    round.working = false;
    pthread_join(reporter, NULL);
    pthread_mutex_destroy(&round.lock);
    share(call);
    mf_task_log_clear(&own);
}
