// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_motion.h"

#include "base/memory.h"

enum status mf_frame_motion_init(struct frame_motion *motion, size_t beads) {
    enum status status = STATUS_OK;
    *motion = (struct frame_motion){.beads = beads};
    for (int d = 0; d < 3; d++) {
        NEW_ARRAY(motion->place[d], beads);
        NEW_ARRAY(motion->path[d], 3 * beads);
    }
    NEW_ARRAY(motion->state, 6 * beads);
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
    *motion = (struct frame_motion){0};
}

/// The oldest path makes room for the present one.
static void turn(struct frame_motion *motion) {
    double *const oldest = motion->path[0];
    motion->path[0] = motion->path[1];
    motion->path[1] = motion->path[2];
    motion->path[2] = oldest;
}

/// Go on by the fractions that the beads have moved since the frame before, which are 0 in the
/// first frame.
static void go_on(struct frame_motion *motion, const struct trajectory_frame *beads,
                  int32_t *const place[3]) {
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
                step += mean[i][d] * box_fraction_difference(place[i][k], motion->place[i][k]);
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
    go_on(motion, beads, place);
    remember(motion, beads, place);
    motion->frames++;
    if (motion->differences && motion->frames < 3)
        return NULL;
    set_state(motion, beads);
    return motion->state;
}
