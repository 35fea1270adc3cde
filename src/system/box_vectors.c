// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/box_vectors.h"

struct box_vectors mf_box_vectors_of(const struct box *box) {
    struct box_vectors vectors = {.volume = mf_box_volume(box)};
    for (int d = 0; d < 3; d++) {
        vectors.edge[d][d] = vectors.height[d] = box->length[d];
        vectors.inverse[d][d] = d < box->dimensions ? 1 / box->length[d] : 0;
    }
    return vectors;
}

double mf_box_vectors_min_height(const struct box_vectors *vectors) {
    const double *const height = vectors->height;
    return fmin(height[0], fmin(height[1], height[2]));
}
