// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_coarse.h"
#include "inversion/joint.h"

#include <math.h>
#include <string.h>

/// 1/(k_B T σ_a/S_a)², the weight of what a state says of a bin.
static double weigh(const struct inversion *state, size_t a) {
    const size_t bin = state->grid.known_bin[a];
    const double least = state->least[bin] * state->ideal[bin];
    const double counts =
        fmax(least, fmax(state->replicas.counts.mean[bin], state->target_counts[bin]));
    const double temperature = state->problem->scene.temperature;
    return state->grid.seen[a] ? counts * counts / (temperature * temperature * state->variance[a])
                               : 0;
}

/// The weight of what all states together say of how they differ: 0 where one has not seen the bin.
static double weigh_together(const struct joint *joint, const double *weight, size_t a) {
    const size_t known = joint_leader(joint)->grid.known;
    double sum = 0;
    for (size_t s = 0; s < joint->states; s++)
        sum += 1 / weight[s * known + a];
    return 1 / sum;
}

/// Take the mean over the bins first … end − 1 of a group off the states' steps.
static void align_group(const struct joint *joint, const double *weight, size_t first, size_t end) {
    for (size_t s = 0; s < joint->states; s++) {
        const struct inversion *state = &joint->state[s];
        const size_t *point = state->grid.known_point;
        double sum = 0, all = 0;
        for (size_t a = first; a < end; a++) {
            const double together = weigh_together(joint, weight, a);
            sum += together * state->step[point[a]];
            all += together;
        }
        for (size_t a = first; a < end && all > 0; a++)
            state->step[point[a]] -= sum / all;
    }
}

static void align_groups(const struct joint *joint, const double *weight) {
    const struct potential_grid *grid = &joint_leader(joint)->grid;
    size_t first = grid->pairs_known;
    for (size_t g = 0; g < grid->groups; g++) {
        align_group(joint, weight, first, first + grid->group[g].own.known);
        first += grid->group[g].own.known;
    }
}

/// What no state has seen is left as it is.
static void take_mean(const struct joint *joint, const double *weight, double *step) {
    const struct potential_grid *grid = &joint_leader(joint)->grid;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        double sum = 0, all = 0;
        for (size_t s = 0; s < joint->states; s++) {
            sum += weight[s * grid->known + a] * joint->state[s].step[point];
            all += weight[s * grid->known + a];
        }
        step[point] = all > 0 ? sum / all : 0;
    }
}

/// The ramp that brings all pressures nearest to what is asked for, by their noise.
static void add_ramp(const struct joint *joint, double *step) {
    const struct inversion *leader = joint_leader(joint);
    const struct potential_grid *grid = &leader->grid;
    double product = 0, squares = 0;
    if (!targets_ask(&leader->problem->targets, TARGET_PRESSURE) || grid->pairs == 0)
        return;
    for (size_t s = 0; s < joint->states; s++) {
        const struct inversion *state = &joint->state[s];
        const double weight = pow(state->distance[TARGET_PRESSURE].noise, -2);
        const double slope = mf_inversion_pressure_ramp_slope(state);
        double missing =
            *state->problem->targets.target[TARGET_PRESSURE].value - state->pressure.value;
        for (size_t b = 0; b < grid->known; b++)
            missing -= state->pressure.slope[b] * step[grid->known_point[b]];
        product += weight * slope * missing;
        squares += weight * slope * slope;
    }
    for (size_t a = 0; a < grid->known && squares > 0; a++)
        step[grid->known_point[a]] +=
            product / squares * mf_potential_grid_ramp(grid, grid->known_point[a]);
}

enum status mf_joint_coarse_step(const struct joint *joint, double *step) {
    enum status status = STATUS_OK;
    const size_t known = joint_leader(joint)->grid.known;
    double *weight = NULL;
    NEW_ARRAY(weight, joint->states * known);
    for (size_t s = 0; s < joint->states; s++) {
        struct inversion *state = &joint->state[s];
        CHECK(mf_inversion_coarse_step(state, state->step));
        for (size_t a = 0; a < known; a++)
            weight[s * known + a] = weigh(state, a);
    }
    align_groups(joint, weight);
    take_mean(joint, weight, step);
    add_ramp(joint, step);
done:
    mf_memory_free(weight);
    return status;
}
