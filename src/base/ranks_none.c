// SPDX-License-Identifier: GPL-3.0-or-later
//
// In place of ranks.c where the program is built without MPI.
#include "base/ranks.h"

#include <stdlib.h>

/// What Open MPI and the others (MPICH, Intel, Slurm's pmi2) tell the processes that they start.
static const char *const sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}, *const numbers[] = {
                                                                             "OMPI_COMM_WORLD_RANK",
                                                                             "PMI_RANK"};

/// Its number in the job that it was started in by mistake: one of those is to say so.
static int number;

enum status mf_ranks_begin(void (*warn)(const char *line)) {
    (void)warn;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        const char *size = getenv(sizes[k]);
        const char *rank = getenv(numbers[k]);
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

const char *mf_ranks_host(int rank) {
    (void)rank;
    return "";
}

void mf_ranks_send(int to, const uint64_t *letter, size_t words) {
    (void)to, (void)letter, (void)words;
}

uint64_t *mf_ranks_receive(int *from, size_t *words) {
    (void)from, (void)words;
    return NULL;
}

void mf_ranks_share(void *memory, size_t bytes) {
    (void)memory, (void)bytes;
}

void mf_ranks_rest(void) {
}

void mf_ranks_warn(const char *format, ...) {
    (void)format;
}

void mf_ranks_stop(int exit_code, const char *format, ...) {
    (void)format;
    exit(exit_code);
}
