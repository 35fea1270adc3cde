// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_doubts.h"

#include "trajectory/frame.h"

#include <math.h>

/// Units are wrong more often than matter is so thin or dense; bins of 0.01 nm may
/// then be more than memory holds.
static void doubt_density(struct progress *progress, const struct trajectory_frame *frame,
                          size_t beads, const char *units) {
    static const double thinnest = 1e-3, densest = 200;
    const double(*const a)[3] = (const double(*)[3])frame->box;
    double volume = 0;
    for (int d = 0; d < 3; d++)
        volume += a[0][d] *
                  (a[1][(d + 1) % 3] * a[2][(d + 2) % 3] - a[1][(d + 2) % 3] * a[2][(d + 1) % 3]);
    const double density = (double)beads / fabs(volume);
    if (!frame->has_box || (density >= thinnest && density <= densest))
        return;
    if (units == NULL)
        mf_progress_print(progress,
                          "mesofit: warning: %s: %.3g beads in a nm^3: are places and box in "
                          "another unit?",
                          frame->file, density);
    else
        mf_progress_print(
            progress,
            "mesofit: warning: --file-units %s make %.3g beads in a nm^3: is the file "
            "in other units?",
            units, density);
}

/// A box that the atoms of the first frame do not fill, or not go into unless they were unwrapped,
/// is another's, or in another unit.
static void doubt_box(struct progress *progress, const struct trajectory_frame *frame) {
    enum { MIN_ATOMS = 50 };
    static const double widest = 1.5, narrowest = 0.5;
    struct box_vectors box;
    double spread[3], most = 0, least = INFINITY;
    if (frame->atoms < MIN_ATOMS || !frame->has_box ||
        mf_frame_box_find(&box, frame) != STATUS_OK || mf_frame_box_is_plane(&box, frame))
        return;
    mf_frame_box_spread(&box, frame, spread);
    for (int i = 0; i < 3; i++) {
        most = fmax(most, spread[i]);
        least = fmin(least, spread[i]);
    }
    if (most > widest && !frame->unwrapped)
        mf_progress_print(progress,
                          "mesofit: warning: %s: in its first frame atoms spread over %.2g boxes: "
                          "that is right of unwrapped positions; of others the box is wrong, or in "
                          "another unit, and so are g(r) and S(q)",
                          frame->file, most);
    else if (least < narrowest)
        mf_progress_print(progress,
                          "mesofit: warning: %s: in its first frame atoms fill %.2g of the box: "
                          "g(r) and S(q) are of all of it; is the box in another unit?",
                          frame->file, least);
}

void mf_measure_doubts(struct progress *progress, const struct trajectory_frame *frame,
                       size_t beads, const char *units) {
    doubt_density(progress, frame, beads, units);
    doubt_box(progress, frame);
}
