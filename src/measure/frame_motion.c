// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_motion.h"

#include "base/memory.h"

#include <math.h>

/// Parts of the box: what counts as the same place, and as near half a box.
static const double same = 0.1, near_half = 0.45;

enum status mf_frame_motion_init(struct frame_motion *motion, size_t beads) {
    enum status status = STATUS_OK;
    *motion = (struct frame_motion){.beads = beads};
    for (int d = 0; d < 3; d++) {
        NEW_ARRAY(motion->place[d], beads);
        NEW_ARRAY(motion->path[d], 3 * beads);
    }
    NEW_ARRAY(motion->state, 6 * beads);
    NEW_ARRAY(motion->boxes, 6 * beads);
done:
    if (status != STATUS_OK)
        mf_frame_motion_clear(motion);
    return status;
}

void mf_frame_motion_clear(struct frame_motion *motion) {
    for (int d = 0; d < 3; d++) {
        mf_memory_free(motion->place[d]);
        mf_memory_free(motion->path[d]);
    }
    mf_memory_free(motion->state);
    mf_memory_free(motion->boxes);
    *motion = (struct frame_motion){0};
}

/// The oldest path makes room for the present one.
static void turn(struct frame_motion *motion) {
    double *const oldest = motion->path[0];
    motion->path[0] = motion->path[1];
    motion->path[1] = motion->path[2];
    motion->path[2] = oldest;
}

/// Fractions of the box with the images.
static void find_boxes(const struct frame_motion *motion, const struct trajectory_frame *beads,
                       double *boxes) {
    double inverse[3][3];
    mf_frame_reciprocal(beads, inverse);
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++) {
            const double *const at = beads->position[k];
            boxes[(size_t)i * motion->beads + k] =
                at[0] * inverse[i][0] + at[1] * inverse[i][1] + at[2] * inverse[i][2];
        }
}

static double nearest_step(const struct frame_motion *motion, int32_t *const place[3], int i,
                           size_t k) {
    return 0x1p-32 * box_fraction_difference(place[i][k], motion->place[i][k]);
}

/// Whole boxes that the beads have gone since the frame before, in place of where they were in
/// that; false if nobody tells them.
static bool find_whole_boxes(struct frame_motion *motion, const struct trajectory_frame *beads,
                             int32_t *const place[3]) {
    double *const now = motion->boxes, *const before = now + 3 * motion->beads;
    const bool told = motion->unwrapped && beads->unwrapped;
    size_t around = 0, stayed = 0;
    for (int i = 0; told && i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++) {
            const size_t n = (size_t)i * motion->beads + k;
            const double step = nearest_step(motion, place, i, k);
            before[n] = rint(now[n] - before[n] - step);
            around += before[n] != 0;
            stayed += before[n] != 0 && fabs(step) < same;
        }
    return told && 2 * stayed <= around;
}

/// Steps to nearest images are of the wrong one if they are longer than half a box.
static void count_far(struct frame_motion *motion, int32_t *const place[3]) {
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++)
            motion->far += fabs(nearest_step(motion, place, i, k)) > near_half;
    motion->steps += 3 * motion->beads;
}

/// Go on by the fractions that the beads have moved since the frame before, which are 0 in the
/// first frame. @param[in] whole  shape [3, beads], boxes beside; NULL: none
static void go_on(struct frame_motion *motion, const struct trajectory_frame *beads,
                  int32_t *const place[3], const double *whole) {
    const size_t count = motion->beads;
    double mean[3][3];
    for (int n = 0; n < 9; n++)
        mean[n / 3][n % 3] = 0.5 * 0x1p-32 * (motion->box[n / 3][n % 3] + beads->box[n / 3][n % 3]);
    for (int d = 0; d < 3; d++) {
        const double *const before = motion->path[1] + (size_t)d * count;
        double *const now = motion->path[2] + (size_t)d * count;
        for (size_t k = 0; k < count; k++) {
            double step = 0;
            for (int i = 0; i < 3; i++)
                step += mean[i][d] * (box_fraction_difference(place[i][k], motion->place[i][k]) +
                                      (whole ? 0x1p32 * whole[(size_t)i * count + k] : 0));
            now[k] = before[k] + step;
        }
    }
}

static void remember(struct frame_motion *motion, const struct trajectory_frame *beads,
                     int32_t *const place[3]) {
    memcpy(motion->box, beads->box, sizeof motion->box);
    for (int i = 0; i < 3; i++)
        memcpy(motion->place[i], place[i], motion->beads * sizeof *place[i]);
}

static void subtract_mean(const struct frame_motion *motion, double *values) {
    double sum = 0, all = 0;
    for (size_t k = 0; k < motion->beads; k++) {
        const double mass = motion->mass ? motion->mass[k] : 1;
        sum += mass * values[k];
        all += mass;
    }
    for (size_t k = 0; k < motion->beads; k++)
        values[k] -= sum / all;
}

static void set_state(struct frame_motion *motion, const struct trajectory_frame *beads) {
    const size_t count = motion->beads;
    const double *const at = motion->path[motion->differences ? 1 : 2];
    double *const velocity = motion->state + 3 * count;
    memcpy(motion->state, at, 3 * count * sizeof *at);
    for (size_t k = 0; motion->differences && k < 3 * count; k++)
        velocity[k] = (motion->path[2][k] - motion->path[0][k]) / (2 * motion->interval);
    for (int d = 0; !motion->differences && beads->has_velocities && d < 3; d++)
        for (size_t k = 0; k < count; k++)
            velocity[(size_t)d * count + k] = beads->velocity[k][d];
    for (size_t d = 0; motion->together && d < 6; d++)
        subtract_mean(motion, motion->state + d * count);
}

const double *mf_frame_motion_add(struct frame_motion *motion, const struct trajectory_frame *beads,
                                  int32_t *const place[3]) {
    if (motion->frames == 0)
        remember(motion, beads, place);
    turn(motion);
    find_boxes(motion, beads, motion->boxes);
    double *const whole = motion->boxes + 3 * motion->beads;
    const bool told = find_whole_boxes(motion, beads, place);
    if (!told)
        count_far(motion, place);
    go_on(motion, beads, place, told ? whole : NULL);
    remember(motion, beads, place);
    memcpy(whole, motion->boxes, 3 * motion->beads * sizeof *whole);
    motion->unwrapped = beads->unwrapped;
    motion->frames++;
    if (motion->differences && motion->frames < 3)
        return NULL;
    set_state(motion, beads);
    return motion->state;
}
