// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "observe/etd.h"

#include <math.h>

/// Pairs of one bin: begun, and escaped by some time.
struct tally {
    double begun, escaped;
};

static double survived(struct tally tally) {
    return 1 - tally.escaped / tally.begun;
}

/// Standard error of what has survived of n independent pairs; if all or none have, the end of
/// Wilson's interval of one standard deviation, where n p² = p (1 − p).
static double find_error_of_pairs(struct tally sum) {
    if (sum.escaped == 0 || sum.escaped == sum.begun)
        return 1 / (sum.begun + 1);
    return sqrt(survived(sum) * (1 - survived(sum)) / sum.begun);
}

/// Spread of a jackknife that is but rounding.
static const double no_spread = 1e-12;

/// Standard error of what has survived of the sum of `count` blocks.
static double find_error(const struct tally *blocks, size_t count, struct tally sum) {
    double filled = 0, changes = 0, squares = 0;
    for (size_t b = 0; b < count; b++) {
        if (blocks[b].begun == 0 || blocks[b].begun == sum.begun)
            continue;
        const struct tally without = {sum.begun - blocks[b].begun, sum.escaped - blocks[b].escaped};
        const double change = survived(without) - survived(sum);
        filled++;
        changes += change;
        squares += change * change;
    }
    if (filled < 3)
        return find_error_of_pairs(sum);
    const double error =
        sqrt(fmax(0, squares - changes * changes / filled) * (filled - 1) / filled);
    return error > no_spread ? error : find_error_of_pairs(sum);
}

/// Go on to the next time: the pairs of a bin that are begun at time 0 or escape at a later one.
static struct tally advance(const struct etd *const *replicas, size_t count, size_t time,
                            size_t bin, struct tally *blocks) {
    struct tally sum = {0, 0};
    size_t b = 0;
    for (size_t r = 0; r < count; r++)
        for (size_t block = 0; block < replicas[r]->blocks; block++, b++) {
            const size_t cell = time * (size_t)replicas[r]->grid.bins + bin;
            const double here = (double)replicas[r]->counts[block * etd_cells(replicas[r]) + cell];
            if (time == 0)
                blocks[b] = (struct tally){here, 0};
            else
                blocks[b].escaped += here;
            sum.begun += blocks[b].begun;
            sum.escaped += blocks[b].escaped;
        }
    return sum;
}

enum status mf_etd_result(const struct etd *const *replicas, size_t count, double *survival,
                          double *error, uint64_t *pairs) {
    const size_t times = (size_t)replicas[0]->grid.times, bins = (size_t)replicas[0]->grid.bins;
    size_t block_count = 0;
    OWNED struct tally *blocks = NULL;
    for (size_t r = 0; r < count; r++)
        block_count += replicas[r]->blocks;
    TRY_ARRAY(blocks, block_count);
    for (size_t bin = 0; bin < bins; bin++)
        for (size_t time = 0; time < times; time++) {
            const struct tally sum = advance(replicas, count, time, bin, blocks);
            const bool known = sum.begun > 0;
            survival[time * bins + bin] = known ? survived(sum) : NAN;
            if (error)
                error[time * bins + bin] = !known      ? NAN
                                           : time == 0 ? 0 // E(0) is 1 by definition
                                                       : find_error(blocks, block_count, sum);
            if (pairs)
                pairs[bin] = (uint64_t)sum.begun;
        }
    return STATUS_OK;
}
