// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_features.h"

#include "base/memory.h"
#include "observe/sample_blocks.h"
#include <math.h>
#include <string.h>

/// Ranges are joined until they have so many pairs a frame, whose number is then nearly normal; the
/// farthest that have fewer are left.
static const double enough = 25;

/// The volume, and all ranges of all pair types.
static size_t features_of(const struct frame_pairs_plan *plan) {
    const size_t kinds = plan->within ? 2 : 1;
    return 1 + kinds * FEATURE_RANGES * (size_t)mf_composition_pairs(&plan->composition);
}

void mf_frame_features_clear(struct frame_features *features) {
    mf_memory_free(features->block);
    *features = (struct frame_features){0};
}

static size_t range_of(const struct frame_pairs_plan *plan, size_t bin) {
    return bin * FEATURE_RANGES / plan->bins;
}

enum status mf_frame_features_add(struct frame_features *features,
                                  const struct frame_pairs_plan *plan,
                                  const struct frame_pairs *pairs, double volume) {
    const size_t types = (size_t)mf_composition_pairs(&plan->composition);
    if (features->block == NULL) {
        features->features = features_of(plan);
        features->each = 1;
        TRY_ARRAY(features->block, FEATURE_BLOCKS * features->features);
    }
    if (features->frames == FEATURE_BLOCKS * features->each) {
        mf_sample_blocks_join(features->block, FEATURE_BLOCKS, features->features);
        features->each *= 2;
    }
    double *const block = features->block + features->frames / features->each * features->features;
    block[0] += volume;
    for (size_t pair = 0; pair < types; pair++)
        for (size_t bin = 0; bin < plan->bins; bin++) {
            const size_t from = pair * (plan->bins + 1) + bin;
            const size_t to = 1 + pair * FEATURE_RANGES + range_of(plan, bin);
            const double apart = (double)pairs->counts[from];
            block[to] += apart;
            if (plan->within)
                block[to + types * FEATURE_RANGES] += (double)pairs->within[from] - apart;
        }
    features->frames++;
    return STATUS_OK;
}

/// One series after the other.
struct look {
    const struct frame_features *features;
    size_t blocks;  ///< that are complete
    size_t from;    ///< block from which on drift is looked for
    bool drift;     ///< instead of a beginning
    size_t count;   ///< series so far
    double *series; ///< shape [blocks]: pairs of a frame
    struct frame_features_slowest slowest;
};

/// Add a feature to the present series.
static void add(struct look *look, size_t feature) {
    const struct frame_features *const all = look->features;
    for (size_t b = 0; b < look->blocks; b++)
        look->series[b] += all->block[b * all->features + feature] / (double)all->each;
}

static void begin(struct look *look) {
    memset(look->series, 0, look->blocks * sizeof *look->series);
}

/// Mean of the present series over its second half.
static double later_mean(const struct look *look) {
    const size_t half = look->blocks / 2;
    double sum = 0;
    for (size_t b = half; b < look->blocks; b++)
        sum += look->series[b];
    return sum / (double)(look->blocks - half);
}

/// Keep what settles later than all before, or drifts more.
static void keep(struct look *look, struct frame_features_slowest now) {
    const struct frame_features_slowest *const slowest = &look->slowest;
    if (look->drift ? now.drift.evidence > slowest->drift.evidence : now.frames > slowest->frames)
        look->slowest = now;
}

/// Look at the present series, which is of what `now` says.
static void judge(struct look *look, struct frame_features_slowest now) {
    if (look->drift)
        now.drift = mf_equilibration_drift(look->series + look->from, look->blocks - look->from);
    else
        now.frames = look->features->each * mf_equilibration_length(look->series, look->blocks);
    look->count++;
    keep(look, now);
}

/// Ranges that are empty in the second half; returns how many.
static size_t assess_core(struct look *look, size_t first, struct frame_features_slowest now) {
    const size_t each = look->features->each;
    size_t empty = 0;
    begin(look);
    while (empty < FEATURE_RANGES) {
        add(look, first + empty);
        if (later_mean(look) > 0)
            break;
        empty++;
    }
    begin(look);
    for (size_t range = 0; range < empty; range++)
        add(look, first + range);
    for (size_t b = 0; b < look->blocks; b++)
        look->series[b] *= (double)each;
    now.frames = each * mf_equilibration_length_of_events(look->series, look->blocks);
    now.to = now.from + (double)empty * now.to;
    if (!look->drift)
        keep(look, now);
    return empty;
}

/// The ranges of one pair type. @param[in] now  what it is, with `to` the width of a range
static void assess_pair(struct look *look, size_t first, struct frame_features_slowest now) {
    const double width = now.to;
    size_t from = assess_core(look, first, now);
    begin(look);
    for (size_t range = from; range < FEATURE_RANGES; range++) {
        add(look, first + range);
        if (later_mean(look) < enough)
            continue;
        now.from = (double)from * width;
        now.to = (double)(range + 1) * width;
        judge(look, now);
        from = range + 1;
        begin(look);
    }
}

static void assess_volume(struct look *look) {
    begin(look);
    add(look, 0);
    judge(look, (struct frame_features_slowest){.volume = true});
}

/// Look at all series.
static enum status assess_all(struct look *look, const struct frame_pairs_plan *plan) {
    const struct frame_features *const features = look->features;
    OWNED double *series = NULL;
    if (features->block == NULL)
        return STATUS_OK;
    look->blocks = features->frames / features->each;
    look->from = look->from < look->blocks ? look->from : look->blocks;
    TRY_ARRAY(series, look->blocks);
    look->series = series;
    assess_volume(look);
    const size_t types = (size_t)mf_composition_pairs(&plan->composition);
    const size_t count = (features->features - 1) / FEATURE_RANGES;
    for (size_t k = 0; k < count; k++)
        assess_pair(look, 1 + k * FEATURE_RANGES,
                    (struct frame_features_slowest){.pair = (int)(k % types),
                                                    .within = k >= types,
                                                    .to = plan->range / FEATURE_RANGES});
    return STATUS_OK;
}

enum status mf_frame_features_assess(const struct frame_features *features,
                                     const struct frame_pairs_plan *plan,
                                     struct frame_features_slowest *slowest) {
    struct look look = {.features = features};
    TRY(assess_all(&look, plan));
    *slowest = look.slowest;
    return STATUS_OK;
}

enum status mf_frame_features_drift(const struct frame_features *features,
                                    const struct frame_pairs_plan *plan, size_t begin,
                                    struct frame_features_slowest *slowest) {
    struct look look = {.features = features, .drift = true};
    look.from = features->each > 0 ? (begin + features->each - 1) / features->each : 0;
    TRY(assess_all(&look, plan));
    *slowest = look.slowest;
    slowest->drifts = equilibration_drifts(&slowest->drift, look.count);
    return STATUS_OK;
}
