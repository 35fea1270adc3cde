// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_blocks.h"

#include "base/statistics.h"

#include <math.h>
#include <string.h>

/// So many tell a standard error to about 16 %.
enum { BLOCKS = 20 };

enum status mf_sample_blocks_init(struct sample_blocks *blocks, size_t planned, size_t row) {
    *blocks = (struct sample_blocks){.planned = planned, .each = planned == 0, .row = row};
    blocks->count = planned == 0 ? 2 * BLOCKS : planned < BLOCKS ? planned : BLOCKS;
    TRY_ARRAY(blocks->samples, blocks->count);
    TRY_ARRAY(blocks->sums, blocks->count * row);
    return STATUS_OK;
}

void mf_sample_blocks_clear(struct sample_blocks *blocks) {
    mf_memory_free(blocks->samples);
    mf_memory_free(blocks->sums);
    *blocks = (struct sample_blocks){0};
}

void mf_sample_blocks_join(double *sums, size_t count, size_t row) {
    const size_t half = count / 2;
    for (size_t b = 0; b < half; b++)
        for (size_t k = 0; k < row; k++)
            sums[b * row + k] = sums[2 * b * row + k] + sums[(2 * b + 1) * row + k];
    memset(sums + half * row, 0, half * row * sizeof *sums);
}

/// The block of the next sample.
static size_t find_block(struct sample_blocks *blocks) {
    if (blocks->each == 0) {
        const size_t block = blocks->taken * blocks->count / blocks->planned;
        return block < blocks->count ? block : blocks->count - 1;
    }
    if (blocks->taken == blocks->count * blocks->each) {
        mf_sample_blocks_join(blocks->sums, blocks->count, blocks->row);
        mf_sample_blocks_join(blocks->samples, blocks->count, 1);
        blocks->each *= 2;
    }
    return blocks->taken / blocks->each;
}

double *mf_sample_blocks_next(struct sample_blocks *blocks) {
    const size_t block = find_block(blocks);
    blocks->samples[block] += 1;
    blocks->taken++;
    return blocks->sums + block * blocks->row;
}

size_t mf_sample_blocks_whole(const struct sample_blocks *blocks) {
    const double min = blocks->each > 0 ? (double)blocks->each : 1;
    size_t whole = 0;
    while (whole < blocks->count && blocks->samples[whole] >= min)
        whole++;
    return whole;
}

double mf_sample_blocks_mean(const struct sample_blocks *blocks, size_t k, double divisor,
                             double *error) {
    const size_t whole = mf_sample_blocks_whole(blocks);
    double means[2 * BLOCKS] = {0}, sum = 0, samples = 0;
    for (size_t b = 0; b < whole; b++) {
        const double own = blocks->sums[b * blocks->row + k] / divisor;
        means[b] = own / blocks->samples[b];
        sum += own;
        samples += blocks->samples[b];
    }
    *error = mf_statistics_correlated_error(means, whole, 1);
    return samples > 0 ? sum / samples : NAN;
}

bool mf_sample_blocks_are_independent(const struct sample_blocks *blocks, size_t first,
                                      size_t count, const double *mean, const double *error) {
    static const double enough = 100, independent = 1.5;
    double sum = 0, seen = 0;
    for (size_t k = 0; k < count; k++) {
        double counts = 0;
        for (size_t b = 0; b < blocks->count; b++)
            counts += blocks->sums[b * blocks->row + first + k];
        if (!(counts >= enough) || !(error[k] > 0) || !isfinite(error[k]))
            continue;
        sum += counts * pow(error[k] / mean[k], 2);
        seen += 1;
    }
    return seen > 0 && sum / seen < independent;
}

size_t mf_sample_blocks_spans(struct sample_blocks *blocks, struct memory_span *spans) {
    const size_t numbers = blocks->count * blocks->row;
    spans[0] = (struct memory_span){&blocks->taken, sizeof blocks->taken};
    spans[1] = (struct memory_span){blocks->samples, blocks->count * sizeof *blocks->samples};
    spans[2] = (struct memory_span){blocks->sums, numbers * sizeof *blocks->sums};
    return 3;
}
