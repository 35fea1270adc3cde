// SPDX-License-Identifier: GPL-3.0-or-later
//
// Waves in boxes of any shape, against sums over pairs and what periodic systems have in common.
#include "base/rng.h"
#include "trajectory/frame.h"
#include "observe/measure.h"
#include "observe/structure_factor.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { BEADS = 30 };

/// Of places in units of 2⁻³² of a box, times the beads.
static const double rounding = 1e-6;

struct scene {
    struct trajectory_frame frame;
    struct box_vectors box;
    int32_t *place[3];
    struct structure_factor_state state;
};

static void scene_init(struct scene *scene, const double box[3][3], uint64_t seed) {
    struct rng_sequence random = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    *scene = (struct scene){.frame = {.file = "film"}};
    assert_ok(mf_frame_reserve(&scene->frame, BEADS, false));
    mf_frame_set_box(&scene->frame, box);
    for (int k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++)
            scene->frame.position[k][d] = 9 * mf_rng_sequence_uniform(&random) - 3;
    assert_ok(mf_frame_box_find(&scene->box, &scene->frame));
    for (int i = 0; i < 3; i++)
        scene->place[i] = calloc(BEADS, sizeof *scene->place[i]);
    assert_ok(mf_frame_box_places(&scene->box, &scene->frame, scene->place));
}

static void scene_clear(struct scene *scene) {
    mf_frame_clear(&scene->frame);
    mf_structure_factor.clear(&scene->state);
    for (int i = 0; i < 3; i++)
        free(scene->place[i]);
}

/// S of the beads, summed over the waves of each bin, and how many these are.
static const double *find(struct scene *scene, double q_maximum, int64_t bins, int64_t max) {
    const struct structure_factor_settings settings = {q_maximum, bins, max};
    const struct composition composition = mf_composition_of_one(BEADS);
    const struct measure_plan plan = {.every = 1};
    const struct configuration frame = {.dimensions = 3,
                                        .threads = 1,
                                        .count = BEADS,
                                        .box = scene->box,
                                        .composition = &composition,
                                        .fraction = scene->place};
    assert_ok(mf_structure_factor.begin(&scene->state, &settings, &frame, &plan));
    assert_ok(mf_structure_factor.sample(&scene->state, &frame));
    return scene->state.factor.sums;
}

/// (1/N) Σ_ij cos q·(r_i − r_j).
static double sum_over_pairs(const struct scene *scene, const double q[3]) {
    double sum = 0;
    for (int i = 0; i < BEADS; i++)
        for (int j = 0; j < BEADS; j++) {
            double angle = 0;
            for (int d = 0; d < 3; d++)
                angle += q[d] * (scene->frame.position[i][d] - scene->frame.position[j][d]);
            sum += cos(angle);
        }
    return sum / BEADS;
}

/// Waves with q·v = 2π n for the box's vectors v = (3, 0, 0), (1, 2.8, 0), (−1, 1.4, 2.5), solved
/// by hand: one after the other, all of ±q.
static void test_density_waves_are_sums_over_pairs_when_a_box_is_tilted(void **state) {
    (void)state;
    enum { BINS = 300, MAX = 6 };
    static const double tilted[3][3] = {{3, 0, 0}, {1, 2.8, 0}, {-1, 1.4, 2.5}};
    const double q_maximum = 6, turn = 2 * acos(-1);
    double sum[BINS] = {0}, members[BINS] = {0};
    struct scene scene;
    scene_init(&scene, tilted, 3);
    const double *const numbers = find(&scene, q_maximum, BINS, 0);
    for (int a = -MAX; a <= MAX; a++)
        for (int b = -MAX; b <= MAX; b++)
            for (int c = -MAX; c <= MAX; c++) {
                const double x = turn * a / 3, y = (turn * b - x) / 2.8,
                             z = (turn * c + x - 1.4 * y) / 2.5;
                const double size = sqrt(x * x + y * y + z * z);
                if (size > q_maximum || size == 0)
                    continue;
                const size_t bin = (size_t)fmin(size / q_maximum * BINS, BINS - 1);
                sum[bin] += 0.5 * sum_over_pairs(&scene, (const double[]){x, y, z});
                members[bin] += 0.5;
            }
    double all = 0;
    for (size_t bin = 0; bin < BINS; bin++) {
        assert_close(numbers[2 * BINS + bin], members[bin], 0);
        assert_close(numbers[bin], sum[bin], rounding * (1 + members[bin]));
        all += members[bin];
    }
    assert_true(all > 30);
    scene_clear(&scene);
}

/// One lattice has many cells: a, b + 2a, c − b has the same waves, and the same S.
static void test_density_waves_are_the_same_when_another_cell_tells_the_lattice(void **state) {
    (void)state;
    enum { BINS = 90 };
    static const double cube[3][3] = {{3, 0, 0}, {0, 3.3, 0}, {0, 0, 2.7}},
                        slanted[3][3] = {{3, 0, 0}, {6, 3.3, 0}, {0, -3.3, 2.7}};
    struct scene one, other;
    scene_init(&one, cube, 5);
    scene_init(&other, slanted, 5);
    const double *const first = find(&one, 9, BINS, 0), *const second = find(&other, 9, BINS, 0);
    for (size_t k = 0; k < 3 * BINS; k++)
        assert_close(first[k], second[k], 1e-4);
    scene_clear(&one);
    scene_clear(&other);
}

/// A bin keeps all of few waves, and just as many as wanted of more; their S are of the whole bin.
static void test_density_waves_are_evenly_fewer_when_a_bin_has_many(void **state) {
    (void)state;
    enum { BINS = 20, MAX = 7 };
    static const double cube[3][3] = {{3, 0, 0}, {0, 3.3, 0}, {0, 0, 2.7}};
    struct scene one, other;
    double min = 1e9, max = 0;
    scene_init(&one, cube, 5);
    scene_init(&other, cube, 5);
    const double *const all = find(&one, 12, BINS, 0), *const some = find(&other, 12, BINS, MAX);
    for (size_t k = 0; k < BINS; k++)
        assert_close(some[2 * BINS + k], fmin(all[2 * BINS + k], MAX), 0);
    // Of the last bin, from one end of the list to the other.
    for (size_t k = 0; k < other.state.waves.vectors; k++)
        if (other.state.waves.wave[k].bin == BINS - 1) {
            min = fmin(min, other.state.waves.wave[k].n[2]);
            max = fmax(max, other.state.waves.wave[k].n[2]);
        }
    assert_true(min <= 1 && max >= 4);
    scene_clear(&one);
    scene_clear(&other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_density_waves_are_sums_over_pairs_when_a_box_is_tilted),
        cmocka_unit_test(test_density_waves_are_the_same_when_another_cell_tells_the_lattice),
        cmocka_unit_test(test_density_waves_are_evenly_fewer_when_a_bin_has_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
