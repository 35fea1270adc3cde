// SPDX-License-Identifier: GPL-3.0-or-later
//
// What was counted block by block, and how the bins are correlated by it.
#include "base/memory.h"
#include "observe/bonded_state.h"

size_t mf_bonded_series_blocks(const struct bonded_state *const *states, size_t count) {
    size_t min = SIZE_MAX;
    for (size_t k = 0; k < count; k++) {
        const size_t blocks = mf_sample_blocks_whole(&states[k]->blocks);
        min = blocks < min ? blocks : min;
    }
    return min;
}

void mf_bonded_series_find(const struct bonded_state *const *states, size_t count, int group,
                           size_t blocks, double *series) {
    const struct bonded_state *s = states[0];
    const double terms = (double)mf_bonded_distribution_terms(s->molecules, s->order, group);
    const size_t all = s->first[s->molecules->groups[s->order]], bins = s->bins[group].count;
    for (size_t bin = 0; bin < bins; bin++)
        for (size_t n = 0; n < count * blocks; n++) {
            const struct bonded_state *of = states[n / blocks];
            const size_t block = n % blocks;
            series[bin * count * blocks + n] =
                of->counts[block * all + s->first[group] + bin] /
                (of->blocks.samples[block] * terms * s->bins[group].width);
        }
}

enum status mf_bonded_distribution_independence(const void *const *states, size_t count, int group,
                                                size_t first, size_t bins,
                                                struct statistics_independence *found) {
    const struct bonded_state *const *all = (const struct bonded_state *const *)states;
    const size_t blocks = mf_bonded_series_blocks(all, count), values = count * blocks;
    OWNED double *series = NULL;
    TRY_ARRAY(series, all[0]->bins[group].count * values + 1);
    mf_bonded_series_find(all, count, group, blocks, series);
    return mf_statistics_independence(series + first * values, blocks, count, bins, found);
}
