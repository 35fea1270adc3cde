// SPDX-License-Identifier: GPL-3.0-or-later
//
// From the best potential of an inversion to the next one.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// Largest change of the potential in one iteration where the target is well known [k_B T], T that
/// of the coldest state.
static const double largest_change = 1;

/// The same of a single bin where it is not [k_B T]. A bin at the edge of the core that the
/// samples have hardly seen responds to nothing: to fill it, one step lowered the potential by
/// 26,000 there.
static const double largest_unknown_change = 3;

/// Part of the last step, back, that still swings in by itself: each step halves what is left.
static const double max_left = 0.5;

static double find_lowest_temperature(const struct inversion *inversion) {
    double lowest = inversion->state->problem->scene.temperature;
    for (size_t s = 1; s < inversion->states; s++)
        lowest = fmin(lowest, inversion->state[s].problem->scene.temperature);
    return lowest;
}

/// The share of a step that is bounded as a whole.
static double find_bounded(const struct inversion *inversion, const double *step) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const bool whole = inversion->state->basis.count > 0;
    const double temperature = find_lowest_temperature(inversion);
    double largest = 0; // times what is allowed
    for (size_t a = 0; a < grid->known; a++) {
        const double size = fabs(step[grid->known_point[a]]) / temperature;
        if (grid->well_known[a])
            largest = fmax(largest, size / largest_change);
        else if (whole)
            largest = fmax(largest, size / largest_unknown_change);
    }
    return 1 / fmax(1, largest);
}

void mf_inversion_relax(struct inversion *inversion) {
    const struct potential_grid *grid = inversion_grid(inversion);
    struct inversion_course *course = &inversion->course;
    double *damping = &course->progress.damping;
    double along = 0, squares = 0, left = 0;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        const double last = course->best.step[point];
        if (!grid->well_known[a])
            continue;
        along += last * (course->phi[point] - course->best.phi[point]);
        left += last * course->step[point];
        squares += last * last;
    }
    *damping = fmin(1, 1.5 * *damping);
    if (left < -max_left * squares && !mf_inversion_is_near(inversion) &&
        course->has_other == course->progress.has_other) {
        const double unit = find_bounded(inversion, course->step) * course->progress.chosen_damping;
        const double share = along / (squares - left) / unit;
        *damping = fmin(*damping, fmax(mf_inversion_min_damping, share));
    }
}

/// @param[in] part  of the step that the fit would take
static void take_part(struct inversion *inversion, double part) {
    const struct inversion_state *first = inversion->state;
    const struct potential_grid *grid = &first->grid;
    struct inversion_course *course = &inversion->course;
    const bool whole = first->basis.count > 0;
    const double largest = largest_unknown_change * find_lowest_temperature(inversion);
    const double share =
        part * course->progress.damping * find_bounded(inversion, course->best.step);
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        double change = share * course->best.step[point];
        if (!grid->well_known[a] && !whole)
            change = fmax(-largest, fmin(largest, change));
        course->phi[point] = course->best.phi[point] + change;
    }
    mf_potential_grid_complete(grid, course->phi);
}

void mf_inversion_take_step(struct inversion *inversion) {
    take_part(inversion, inversion->course.progress.chosen_damping);
}

enum status mf_inversion_take_last_step(struct inversion *inversion) {
    const struct potential_grid *grid = inversion_grid(inversion);
    struct inversion_course *course = &inversion->course;
    const size_t bytes = grid->points * sizeof(double);
    if (mf_inversion_ends_with_mean(inversion)) {
        memcpy(course->phi, inversion->state->pool.phi, bytes);
        mf_potential_grid_complete(grid, course->phi);
    } else if (course->most_probable) {
        take_part(inversion, 1);
    } else {
        memcpy(course->phi, course->best.phi, bytes);
    }
    TRY(mf_inversion_smooth(inversion));
    memcpy(course->best.phi, course->phi, bytes);
    return STATUS_OK;
}
