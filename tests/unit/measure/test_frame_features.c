// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of pairs that a test makes up, so that the beginning is known.
#include "base/rng.h"
#include "measure/frame_features.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 64, EARLY = 20 };

static const double range = 1.6;

/// Counts of a frame: Poisson-like about 100 a bin from bin 10 on, as of a core of 0.25.
static void make_counts(uint64_t *counts, uint32_t frame, uint32_t seed) {
    for (uint32_t bin = 0; bin < BINS; bin++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(seed, RNG_INITIAL, frame, bin, 0), normal);
        counts[bin] = bin < 10 ? 0 : (uint64_t)fmax(0, rint(100 + 10 * normal[0]));
    }
}

/// @param[in] spoil  changes the counts of the first `spoiled` frames
/// @param[out] drift  of the frames after the beginning
static struct frame_features_slowest find(uint32_t frames, uint32_t seed,
                                          void (*spoil)(uint64_t *counts, uint32_t frame),
                                          uint32_t spoiled, double first_volume,
                                          struct frame_features_slowest *drift) {
    const struct frame_pairs_plan plan = {
        .range = range, .bins = BINS, .composition = mf_composition_of_one(100)};
    struct frame_pairs pairs = {.counts = calloc(BINS + 1, sizeof *pairs.counts)};
    struct frame_features features = {0};
    struct frame_features_slowest slowest;
    for (uint32_t t = 0; t < frames; t++) {
        double normal[4];
        make_counts(pairs.counts, t, seed);
        if (spoil && t < spoiled)
            spoil(pairs.counts, t);
        mf_rng_normal4(mf_rng_philox(seed, RNG_PLACEMENT, t, 0, 0), normal);
        assert_ok(mf_frame_features_add(&features, &plan, &pairs,
                                        (t < EARLY ? first_volume : 27) + 0.1 * normal[0]));
    }
    assert_ok(mf_frame_features_assess(&features, &plan, &slowest));
    assert_ok(mf_frame_features_drift(&features, &plan, slowest.frames, drift));
    mf_frame_features_clear(&features);
    free(pairs.counts);
    return slowest;
}

/// What is over after a beginning does not drift any more.
static struct frame_features_slowest assess(uint32_t frames, uint32_t seed,
                                            void (*spoil)(uint64_t *counts, uint32_t frame),
                                            double first_volume) {
    struct frame_features_slowest drift;
    const struct frame_features_slowest slowest =
        find(frames, seed, spoil, EARLY, first_volume, &drift);
    assert_false(drift.drifts);
    return slowest;
}

/// Thirty series of a few hundred numbers each.
static void test_frame_features_of_equilibrium_leave_nothing_out(void **state) {
    (void)state;
    for (uint32_t seed = 1; seed <= 30; seed++)
        assert_int_equal(assess(50 + 20 * seed, seed, NULL, 27).frames, 0);
}

/// A peak at 0.8 to 0.9 that is not there yet.
static void flatten(uint64_t *counts, uint32_t frame) {
    (void)frame;
    for (int bin = 32; bin < 36; bin++)
        counts[bin] /= 2;
}

static void test_frame_features_name_the_range_that_changes(void **state) {
    (void)state;
    const struct frame_features_slowest slowest = assess(300, 4, flatten, 27);
    assert_in_range(slowest.frames, EARLY - 4, EARLY + 10);
    assert_false(slowest.volume);
    assert_true(slowest.from > 0.7 && slowest.to < 1);
}

static void overlap(uint64_t *counts, uint32_t frame) {
    if (frame < 12)
        counts[1] = 4;
}

/// Overlaps are too few to change a number of pairs, but no later frame has one.
static void test_frame_features_see_overlaps(void **state) {
    (void)state;
    const struct frame_features_slowest slowest = assess(300, 5, overlap, 27);
    assert_int_equal(slowest.frames, 12);
    assert_true(slowest.from == 0 && slowest.to < 0.3);
}

static void test_frame_features_see_the_volume(void **state) {
    (void)state;
    const struct frame_features_slowest slowest = assess(200, 6, NULL, 30);
    assert_true(slowest.volume);
    assert_in_range(slowest.frames, EARLY - 4, EARLY + 10);
}

/// Blocks of eight frames: what is left out is as long.
static void test_frame_features_join_the_frames_of_long_trajectories(void **state) {
    (void)state;
    const struct frame_features_slowest slowest = assess(5 * FEATURE_BLOCKS, 7, flatten, 27);
    assert_in_range(slowest.frames, EARLY - 4, EARLY + 16);
    assert_int_equal(slowest.frames % 8, 0);
}

/// A peak at 0.8 to 0.9 that goes on rising.
static void rise(uint64_t *counts, uint32_t frame) {
    for (int bin = 32; bin < 36; bin++)
        counts[bin] += frame / 10;
}

/// Frame by frame, and of joined frames.
static void test_frame_features_name_the_range_that_drifts_to_the_end(void **state) {
    (void)state;
    for (uint32_t frames = 300; frames <= 1500; frames += 1200) {
        struct frame_features_slowest drift;
        assert_int_equal(find(frames, 8, rise, frames, 27, &drift).frames, 0);
        assert_true(drift.drifts && drift.drift.before < drift.drift.after);
        assert_false(drift.volume);
        assert_true(drift.from > 0.7 && drift.to < 1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frame_features_of_equilibrium_leave_nothing_out),
        cmocka_unit_test(test_frame_features_name_the_range_that_changes),
        cmocka_unit_test(test_frame_features_see_overlaps),
        cmocka_unit_test(test_frame_features_see_the_volume),
        cmocka_unit_test(test_frame_features_join_the_frames_of_long_trajectories),
        cmocka_unit_test(test_frame_features_name_the_range_that_drifts_to_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
