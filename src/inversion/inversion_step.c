// SPDX-License-Identifier: GPL-3.0-or-later
//
// From the best potential of an inversion to the next one.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// Largest change of the potential in one iteration where the target is well known [k_B T_0].
static const double largest_change = 1;

/// The same of a single bin where it is not [k_B T_0]. A bin at the edge of the core that the
/// samples have hardly seen responds to nothing: to fill it, one step lowered the potential by
/// 26,000 there.
static const double largest_unknown_change = 3;

/// Part of the last step, back, that still swings in by itself: each step halves what is left.
static const double most_left = 0.5;

void mf_inversion_relax(struct inversion *inversion) {
    const struct potential_grid *grid = &inversion->grid;
    double *damping = &inversion->progress.damping;
    double way = 0, squares = 0, left = 0;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        const double last = inversion->best_step[point];
        if (!grid->well_known[a])
            continue;
        way += last * (inversion->phi[point] - inversion->best[point]);
        left += last * inversion->step[point];
        squares += last * last;
    }
    *damping = fmin(1, 1.5 * *damping);
    if (left < -most_left * squares && !mf_inversion_is_near(inversion) &&
        inversion->has_other == inversion->progress.best_other)
        *damping = fmin(*damping, way / (squares - left));
}

void mf_inversion_take_step(struct inversion *inversion) {
    const struct potential_grid *grid = &inversion->grid;
    const bool whole = inversion->basis.count > 0;
    double largest = 0;
    for (size_t a = 0; a < grid->known; a++) {
        const double size = fabs(inversion->best_step[grid->known_point[a]]);
        if (grid->well_known[a] || whole)
            largest =
                fmax(largest,
                     grid->well_known[a] ? size : size * largest_change / largest_unknown_change);
    }
    const double share = fmin(inversion->progress.damping, largest_change / fmax(largest, 1e-300));
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        double change = share * inversion->best_step[point];
        if (!grid->well_known[a] && !whole)
            change = fmax(-largest_unknown_change, fmin(largest_unknown_change, change));
        inversion->phi[point] = inversion->best[point] + change;
    }
    mf_potential_grid_complete(grid, inversion->phi);
}

enum status mf_inversion_take_last_step(struct inversion *inversion) {
    const size_t bytes = inversion->grid.points * sizeof(double);
    if (mf_inversion_ends_with_mean(inversion)) {
        memcpy(inversion->phi, inversion->pooled_phi, bytes);
        mf_potential_grid_complete(&inversion->grid, inversion->phi);
    } else if (inversion->settling) {
        mf_inversion_take_step(inversion);
    } else {
        memcpy(inversion->phi, inversion->best, bytes);
    }
    TRY(mf_inversion_smooth(inversion));
    memcpy(inversion->best, inversion->phi, bytes);
    return STATUS_OK;
}
