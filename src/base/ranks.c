// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/ranks.h"

#include "base/memory.h"

#include <limits.h>
#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { HOST_SIZE = MPI_MAX_PROCESSOR_NAME, LINE_SIZE = 9000, MOST_ARRIVALS = 64 };

static struct {
    int count, number;
    bool begun;
    char (*host)[HOST_SIZE]; ///< shape [count]
    void (*warn)(const char *line);
    /// Letters of which not all has come, in their order.
    struct arrival {
        MPI_Request request;
        uint64_t *letter;
        size_t words;
        int from;
    } arrival[MOST_ARRIVALS];
    size_t arrivals;
} job = {.count = 1};

static enum status learn_hosts(void) {
    char own[HOST_SIZE] = "";
    int length;
    job.host = mf_memory_zeroed((size_t)job.count, HOST_SIZE);
    if (job.host == NULL)
        return STATUS_NO_MEMORY;
    MPI_Get_processor_name(own, &length);
    MPI_Allgather(own, HOST_SIZE, MPI_CHAR, job.host, HOST_SIZE, MPI_CHAR, MPI_COMM_WORLD);
    return STATUS_OK;
}

enum status mf_ranks_begin(void (*warn)(const char *line)) {
    int provided;
    // Errors of MPI end the job by its own handler: a rank that is lost cannot be gone on without.
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
        return mf_status_fail(STATUS_IO, "MPI cannot begin");
    job.begun = true;
    job.warn = warn;
    MPI_Comm_size(MPI_COMM_WORLD, &job.count);
    MPI_Comm_rank(MPI_COMM_WORLD, &job.number);
    if (job.count > 1 && provided < MPI_THREAD_SERIALIZED)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "this MPI does not let threads take turns (MPI_THREAD_SERIALIZED)");
    return learn_hosts();
}

/// Wait for what all ranks do together, without keeping a processor busy as MPI_Wait does.
static void finish(MPI_Request *request) {
    enum { SHORT = 20 };
    int arrived = 0;
    for (int turn = 0; !arrived; turn++) {
        MPI_Test(request, &arrived, MPI_STATUS_IGNORE);
        if (!arrived && turn < SHORT)
            sched_yield();
        else if (!arrived)
            mf_ranks_rest();
    }
}

void mf_ranks_end(void) {
    if (!job.begun)
        return;
    MPI_Request all;
    MPI_Ibarrier(MPI_COMM_WORLD, &all); // as MPI_Finalize waits, but resting
    finish(&all);
    MPI_Finalize();
    mf_memory_free(job.host);
    job.begun = false;
}

int mf_ranks_count(void) {
    return job.count;
}

int mf_ranks_number(void) {
    return job.number;
}

const char *mf_ranks_host(int rank) {
    return job.host[rank];
}

void mf_ranks_send(int to, const uint64_t *letter, size_t words) {
    if (words > INT_MAX)
        mf_ranks_stop(3, "a task has more to tell than MPI can send: %zu bytes", 8 * words);
    MPI_Send(letter, (int)words, MPI_UINT64_T, to, 0, MPI_COMM_WORLD);
}

/// Begin to receive a letter if one is on its way.
static void begin_arrival(void) {
    struct arrival *arrival = &job.arrival[job.arrivals];
    MPI_Message message;
    MPI_Status about;
    int is_there, count;
    MPI_Improbe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &is_there, &message, &about);
    if (!is_there)
        return;
    MPI_Get_count(&about, MPI_UINT64_T, &count);
    arrival->from = about.MPI_SOURCE;
    arrival->words = (size_t)count;
    arrival->letter = mf_memory_uncleared((size_t)count, sizeof *arrival->letter);
    if (arrival->letter == NULL)
        mf_ranks_stop(3, "%s", mf_status_message());
    MPI_Imrecv(arrival->letter, count, MPI_UINT64_T, &message, &arrival->request);
    job.arrivals++;
}

uint64_t *mf_ranks_receive(int *from, size_t *words) {
    // A large letter whose sender hangs in the middle of it must not keep others waiting.
    if (job.arrivals < MOST_ARRIVALS)
        begin_arrival();
    for (size_t k = 0; k < job.arrivals; k++) {
        const struct arrival arrival = job.arrival[k];
        int is_whole;
        MPI_Test(&job.arrival[k].request, &is_whole, MPI_STATUS_IGNORE);
        if (!is_whole)
            continue;
        job.arrivals--;
        memmove(job.arrival + k, job.arrival + k + 1, (job.arrivals - k) * sizeof *job.arrival);
        *from = arrival.from;
        *words = arrival.words;
        return arrival.letter;
    }
    return NULL;
}

void mf_ranks_share(void *memory, size_t bytes) {
    enum { PIECE = 1 << 30 };
    if (job.count == 1)
        return;
    for (size_t done = 0; done < bytes; done += PIECE) {
        const size_t left = bytes - done;
        MPI_Request all;
        MPI_Ibcast((char *)memory + done, (int)(left < PIECE ? left : PIECE), MPI_BYTE, 0,
                   MPI_COMM_WORLD, &all);
        finish(&all);
    }
}

void mf_ranks_rest(void) {
    nanosleep(&(struct timespec){.tv_nsec = 300000}, NULL);
}

static void tell(const char *format, va_list arguments) {
    char line[LINE_SIZE];
    vsnprintf(line, sizeof line, format, arguments);
    if (job.warn)
        job.warn(line);
}

void mf_ranks_warn(const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(format, arguments);
    va_end(arguments);
}

void mf_ranks_stop(int exit_code, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    tell(format, arguments);
    va_end(arguments);
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    exit(exit_code);
}
