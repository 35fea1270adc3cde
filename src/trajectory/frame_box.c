// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/frame_box.h"

#include "base/statistics.h"
#include "base/visible.h"

#include <math.h>

static double product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Cholesky's factor of the products of the box's vectors.
static void find_edges(const double vector[3][3], double edge[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double rest = product(vector[i], vector[j]);
            for (int k = 0; k < j && j <= i; k++)
                rest -= edge[i][k] * edge[j][k];
            edge[i][j] = j > i ? 0 : j == i ? sqrt(fmax(0, rest)) : rest / edge[j][j];
        }
}

enum status mf_frame_box_find(struct box_vectors *box, const struct trajectory_frame *frame) {
    *box = (struct box_vectors){.volume = 1};
    if (!frame->has_box)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu has no box: g(r) needs the volume and its images; "
                              "give it by --box; with --molecules bonds and angles are measured "
                              "without",
                              frame->file, frame->number);
    for (int i = 0; i < 3; i++)
        if (!frame->periodic[i])
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: frame %zu is not periodic along vector %c of its box: give a "
                "box that is, by --box",
                frame->file, frame->number, 'a' + i);
    find_edges(frame->box, box->edge);
    mf_frame_reciprocal(frame, box->inverse);
    for (int i = 0; i < 3; i++) {
        box->height[i] = 1 / sqrt(product(box->inverse[i], box->inverse[i]));
        box->volume *= box->edge[i][i];
    }
    return STATUS_OK;
}

enum status mf_frame_box_check_range(const struct box_vectors *box,
                                     const struct trajectory_frame *frame, double range,
                                     const char *what) {
    const double half = 0.5 * mf_box_vectors_min_height(box);
    if (range <= half)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: frame %zu: %s, %g nm, is beyond half the shortest height of the "
                          "box, %.6g nm: pairs would be seen in the wrong image",
                          frame->file, frame->number, what, range, half);
}

/// Boxes beyond which a fraction is none (box_fraction): no digit of the place in a box is left.
static const double max_boxes = 0x1p19;

enum status mf_frame_box_places(const struct box_vectors *box, const struct trajectory_frame *frame,
                                int32_t *const place[3]) {
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < frame->atoms; k++) {
            const double boxes = product(frame->position[k], box->inverse[i]);
            if (!(fabs(boxes) < max_boxes))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: frame %zu: bead %zu is %.3g boxes away, so that its "
                                      "place in a box is lost",
                                      frame->file, frame->number, k + 1, mf_visible_number(boxes));
            place[i][k] = box_fraction(boxes, 1);
        }
    return STATUS_OK;
}

void mf_frame_box_spread(const struct box_vectors *box, const struct trajectory_frame *frame,
                         double spread[3]) {
    for (int i = 0; i < 3; i++) {
        struct running_mean boxes = {0};
        for (size_t k = 0; k < frame->atoms; k++)
            mf_statistics_add(&boxes, product(frame->position[k], box->inverse[i]));
        spread[i] = mf_statistics_standard_error(&boxes) * sqrt(12 * (double)frame->atoms);
    }
}
