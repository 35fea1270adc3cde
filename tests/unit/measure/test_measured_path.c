// SPDX-License-Identifier: GPL-3.0-or-later
//
// Beads whose ways are known, in a box that breathes, seen with images and without.
#include "base/rng.h"
#include "measure/measured_motion.h"
#include "shared/testing.h"

#include <math.h>

enum { BEADS = 40, FRAMES = 30 };

enum images { WRAPPED, TOLD, CALLED_UNWRAPPED };

/// Boxes that a bead has gone, from 0.5 on.
struct ways {
    double boxes[FRAMES][3][BEADS];
};

/// Steps up to `most` boxes.
static void walk(struct ways *ways, double most) {
    struct rng_sequence random = mf_rng_sequence_begin(3, RNG_PLACEMENT, 0, 0);
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < BEADS; k++)
                ways->boxes[t][i][k] = t == 0
                                           ? 0.5
                                           : ways->boxes[t - 1][i][k] +
                                                 most * (2 * mf_rng_sequence_uniform(&random) - 1);
}

static double edge_of(int t) {
    return 2 + 0.1 * sin(t);
}

static void show(const struct ways *ways, int t, enum images images,
                 struct trajectory_frame *frame) {
    const double edge = edge_of(t), box[3][3] = {{edge, 0, 0}, {0, edge, 0}, {0, 0, edge}};
    assert_ok(mf_frame_reserve(frame, BEADS, false));
    mf_frame_set_box(frame, box);
    frame->unwrapped = images != WRAPPED;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < BEADS; k++) {
            const double boxes = ways->boxes[t][i][k];
            frame->position[k][i] = edge * (images == TOLD ? boxes : boxes - floor(boxes));
        }
}

/// The mean square of what the paths are off the truth, of which the squares are returned.
static double follow(double most, enum images images, struct measured_path *motion, double *truth) {
    static struct ways ways;
    struct trajectory_frame frame = {0};
    struct box_vectors box;
    int32_t place[3][BEADS], *const places[3] = {place[0], place[1], place[2]};
    double off = 0, gone[3][BEADS] = {{0}};
    walk(&ways, most);
    *truth = 0;
    assert_ok(mf_measured_path_init(motion, BEADS));
    for (int t = 0; t < FRAMES; t++) {
        show(&ways, t, images, &frame);
        assert_ok(mf_frame_box_find(&box, &frame));
        assert_ok(mf_frame_box_places(&box, &frame, places));
        const double *state = mf_measured_path_add(motion, &frame, places);
        for (int i = 0; t > 0 && i < 3; i++)
            for (int k = 0; k < BEADS; k++) {
                gone[i][k] += 0.5 * (edge_of(t) + edge_of(t - 1)) *
                              (ways.boxes[t][i][k] - ways.boxes[t - 1][i][k]);
                off = fmax(off, fabs(state[i * BEADS + k] - gone[i][k]));
                *truth += gone[i][k] * gone[i][k] / (3 * BEADS * (FRAMES - 1));
            }
    }
    mf_frame_clear(&frame);
    return off;
}

/// Steps of two boxes; without images they are lost, and it is counted that they may be.
static void test_measured_path_goes_whole_boxes_where_images_are_told(void **state) {
    (void)state;
    struct measured_path motion;
    double truth;
    assert_true(follow(2, TOLD, &motion, &truth) < 1e-7);
    assert_true(truth > 10);
    assert_int_equal(motion.far, 0);
    mf_measured_path_clear(&motion);
    assert_true(follow(2, WRAPPED, &motion, &truth) > 1);
    assert_true((double)motion.far > 0.05 * (double)motion.steps);
    mf_measured_path_clear(&motion);
}

/// Steps of a tenth of the box are the same with and without, and where a file calls unwrapped what
/// is not, so that beads seem to jump back across the box.
static void test_measured_path_does_not_believe_images_that_jump(void **state) {
    (void)state;
    for (int images = WRAPPED; images <= CALLED_UNWRAPPED; images++) {
        struct measured_path motion;
        double truth;
        assert_true(follow(0.09, (enum images)images, &motion, &truth) < 1e-7);
        assert_int_equal(motion.far, 0);
        mf_measured_path_clear(&motion);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_measured_path_goes_whole_boxes_where_images_are_told),
        cmocka_unit_test(test_measured_path_does_not_believe_images_that_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
