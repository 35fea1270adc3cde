// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/box.h"

double mf_box_volume(const struct box *box) {
    double volume = 1;
    for (int d = 0; d < box->dimensions; d++)
        volume *= box->length[d];
    return volume;
}

double mf_box_shortest(const struct box *box) {
    double shortest = box->length[0];
    for (int d = 1; d < box->dimensions; d++)
        shortest = fmin(shortest, box->length[d]);
    return shortest;
}

double mf_box_longest(const struct box *box) {
    double longest = box->length[0];
    for (int d = 1; d < box->dimensions; d++)
        longest = fmax(longest, box->length[d]);
    return longest;
}

struct box mf_box_scaled(const struct box *box, double volume_share) {
    struct box scaled = *box;
    for (int d = 0; d < box->dimensions; d++)
        scaled.length[d] *= pow(volume_share, 1.0 / box->dimensions);
    return scaled;
}

double mf_box_shell_volume(const struct box *box, double low, double high) {
    if (box->dimensions == 2)
        return M_PI * (high - low) * (high + low);
    return 4 * M_PI / 3 * (high - low) * (high * high + high * low + low * low);
}

struct box mf_box_cube(double volume) {
    const double edge = cbrt(volume);
    return (struct box){3, {edge, edge, edge}};
}
