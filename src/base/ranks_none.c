// SPDX-License-Identifier: GPL-3.0-or-later
//
// In place of ranks.c where the program is built without MPI.
#include "base/ranks.h"

#include <stdlib.h>

/// Its number in a job that it was started in by mistake: one process of it is to say so.
static int number;

enum status mf_ranks_begin(void) {
    // Open MPI and the others (MPICH, Intel, Slurm's pmi2) tell the processes that they start.
    static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};
    static const char *const ranks[] = {"OMPI_COMM_WORLD_RANK", "PMI_RANK"};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const char *size = getenv(sizes[k]), *rank = getenv(ranks[k]);
        number = rank ? atoi(rank) : 0;
        if (size && atoi(size) > 1)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "this is one of %d processes of a job, but the program was built "
                                  "without MPI: build it with make MPI=1",
                                  atoi(size));
    }
    return STATUS_OK;
}

void mf_ranks_end(void) {
}

int mf_ranks_count(void) {
    return 1;
}

int mf_ranks_number(void) {
    return number;
}

enum status mf_ranks_check(enum status status, uint64_t digest) {
    (void)digest;
    return status;
}

void mf_ranks_broadcast(const struct memory_span *spans, size_t count) {
    (void)spans, (void)count;
}

void mf_ranks_try(struct parallel_call *call) {
    (void)call;
}
