// SPDX-License-Identifier: GPL-3.0-or-later
//
// The step of several states far from the targets of groups.
#include "inversion/inversion.h"
#include "inversion/inversion_low_rank.h"

#include <math.h>

/// What the states say.
struct state_steps {
    struct inversion_state *state;
    size_t states;
    double *weight; ///< of each bin, shape [states, known]
    double *step;   ///< shape [states, points]
};

/// 1/(k_B T σ_a/S_a)², the weight of what a state says of a bin.
static double weigh(const struct inversion_state *state, size_t a) {
    const size_t bin = state->grid.known_bin[a];
    const double min = state->target.min[bin] * state->target.ideal[bin];
    const double counts =
        fmax(min, fmax(state->replicas.counts.mean[bin], state->target.counts[bin]));
    const double temperature = state->problem->scene.temperature;
    return state->grid.seen[a] ? counts * counts / (temperature * temperature * state->variance[a])
                               : 0;
}

/// The weight of what all states together say of how they differ: 0 where one has not seen the bin.
static double weigh_difference(const struct state_steps *state_steps, size_t a) {
    double sum = 0;
    for (size_t s = 0; s < state_steps->states; s++)
        sum += 1 / state_steps->weight[s * state_steps->state->grid.known + a];
    return 1 / sum;
}

/// Take the mean over the bins first … end − 1 of a group off the states' steps.
static void align_group(const struct state_steps *state_steps, size_t first, size_t end) {
    const struct potential_grid *grid = &state_steps->state->grid;
    for (size_t s = 0; s < state_steps->states; s++) {
        double *step = state_steps->step + s * grid->points;
        double sum = 0, all = 0;
        for (size_t a = first; a < end; a++) {
            const double weight = weigh_difference(state_steps, a);
            sum += weight * step[grid->known_point[a]];
            all += weight;
        }
        for (size_t a = first; a < end && all > 0; a++)
            step[grid->known_point[a]] -= sum / all;
    }
}

static void align_groups(const struct state_steps *state_steps) {
    const struct potential_grid *grid = &state_steps->state->grid;
    size_t first = grid->pairs_known;
    for (size_t g = 0; g < grid->groups; g++) {
        align_group(state_steps, first, first + grid->group[g].own.known);
        first += grid->group[g].own.known;
    }
}

/// What no state has seen is left as it is.
static void take_mean(const struct state_steps *state_steps, double *step) {
    const struct potential_grid *grid = &state_steps->state->grid;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        double sum = 0, all = 0;
        for (size_t s = 0; s < state_steps->states; s++) {
            sum += state_steps->weight[s * grid->known + a] *
                   state_steps->step[s * grid->points + point];
            all += state_steps->weight[s * grid->known + a];
        }
        step[point] = all > 0 ? sum / all : 0;
    }
}

/// The ramp that brings all pressures nearest to what is asked for, by their noise.
static void add_ramp(const struct state_steps *state_steps, double *step) {
    const struct potential_grid *grid = &state_steps->state->grid;
    double product = 0, squares = 0;
    if (!mf_inversion_bulk_is_asked(state_steps->state) || grid->pairs == 0)
        return;
    for (size_t s = 0; s < state_steps->states; s++) {
        const struct inversion_state *state = &state_steps->state[s];
        const double weight =
            pow(state->assessment.distance[mf_inversion_bulk_kind(state)].noise, -2);
        const double slope = mf_inversion_bulk_ramp_slope(state);
        double missing = mf_inversion_bulk_missing(state);
        for (size_t b = 0; b < grid->known; b++)
            missing -= state->bulk.slope[b] * step[grid->known_point[b]];
        product += weight * slope * missing;
        squares += weight * slope * slope;
    }
    for (size_t a = 0; a < grid->known && squares > 0; a++)
        step[grid->known_point[a]] +=
            product / squares * mf_potential_grid_ramp(grid, grid->known_point[a]);
}

enum status mf_inversion_states_low_rank_step(struct inversion_state *state, size_t states,
                                              double *step) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known, points = state->grid.points;
    struct state_steps state_steps = {state, states, NULL, NULL};
    NEW_ARRAY(state_steps.weight, states * known);
    NEW_ARRAY(state_steps.step, states * points);
    for (size_t s = 0; s < states; s++) {
        CHECK(mf_inversion_low_rank_step(&state[s], state_steps.step + s * points));
        for (size_t a = 0; a < known; a++)
            state_steps.weight[s * known + a] = weigh(&state[s], a);
    }
    align_groups(&state_steps);
    take_mean(&state_steps, step);
    add_ramp(&state_steps, step);
done:
    mf_memory_free(state_steps.weight);
    mf_memory_free(state_steps.step);
    return status;
}
