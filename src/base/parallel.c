// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

/// Where part `number` of `parts` begins, at a multiple of 16: parts share no cache line.
static size_t part_begin(size_t count, int number, int parts) {
    return number == parts ? count : count * (size_t)number / (size_t)parts / 16 * 16;
}

void mf_parallel_for(size_t count, int threads,
                     void (*body)(void *context, size_t begin, size_t end), void *context) {
    if (threads <= 1) {
        body(context, 0, count);
        return;
    }
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int part = 0; part < threads; part++)
        body(context, part_begin(count, part, threads), part_begin(count, part + 1, threads));
}

double mf_parallel_sum(size_t count, int threads,
                       double (*body)(const void *context, size_t begin, size_t end),
                       const void *context) {
    enum { MOST_BLOCKS = 64, SMALLEST_BLOCK = 4096 };
    const size_t wanted = (count + SMALLEST_BLOCK - 1) / SMALLEST_BLOCK;
    const int blocks = wanted < MOST_BLOCKS ? (int)wanted : MOST_BLOCKS;
    double sums[MOST_BLOCKS], total = 0;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int block = 0; block < blocks; block++)
        sums[block] =
            body(context, part_begin(count, block, blocks), part_begin(count, block + 1, blocks));
    for (int block = 0; block < blocks; block++)
        total += sums[block];
    return total;
}
