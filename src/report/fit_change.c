// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_change.h"

#include <math.h>

/// Whether the target has enough pairs at a point to tell of the curve there.
static bool is_determined(const struct unknowns *unknowns, enum unknown_kind kind, size_t point) {
    const struct potential_grid *grid = &unknowns->potential;
    const size_t among = kind == UNKNOWN_BONDED ? grid->pair_points + point : point;
    if (unknown_is_omega(kind))
        return mf_unknowns_fits(unknowns, kind, point);
    for (size_t n = 0; n < grid->known; n++)
        if (grid->known_point[n] == among)
            return grid->well_known[n];
    return false;
}

static void find_lower(double value, double r, double *lowest, double *at) {
    if (value >= *lowest)
        return;
    *lowest = value;
    *at = r;
}

struct fit_change mf_fit_change_find(const struct unknowns *unknowns, enum unknown_kind kind,
                                     size_t curve, const double *first, const double *last) {
    struct fit_change change = {.well = INFINITY, .first_well = INFINITY};
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *r = mf_unknowns_r(unknowns, kind);
    double squares = 0, count = 0;
    for (size_t k = part.first; k < part.first + part.points; k++) {
        if (!is_determined(unknowns, kind, k))
            continue;
        squares += (last[k] - first[k]) * (last[k] - first[k]);
        count += 1;
        find_lower(last[k], r[k], &change.well, &change.well_at);
        find_lower(first[k], r[k], &change.first_well, &change.first_well_at);
    }
    change.rms = sqrt(squares / count);
    return change;
}
