// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_state.h"
#include "problem/group_kind.h"

#include <math.h>

/// d V of the Monte Carlo system.
static double virial_unit(const struct inversion_state *state) {
    double volume = state->box.dimensions;
    for (int d = 0; d < state->box.dimensions; d++)
        volume *= state->box.length[d];
    return volume;
}

/// By which part of itself S is to change, rms over the bins.
static double find_change(const struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    double squares = 0;
    for (size_t a = 0; a < grid->known; a++)
        squares += pow(state->excess[a] / state->target.ideal[grid->known_bin[a]], 2);
    return sqrt(squares / (double)grid->known);
}

enum target_kind mf_inversion_bulk_kind(const struct inversion_state *state) {
    return inverse_problem_bulk(state->problem);
}

static const struct target *target_of(const struct inversion_state *state) {
    return &state->problem->targets.target[mf_inversion_bulk_kind(state)];
}

bool mf_inversion_bulk_is_asked(const struct inversion_state *state) {
    return target_of(state)->count > 0;
}

double mf_inversion_bulk_missing(const struct inversion_state *state) {
    return *target_of(state)->value - state->bulk.value;
}

/// Density where V is that of the scene [1/λ^d].
static double density_unit(const struct inversion_state *state) {
    return (double)mf_composition_particles(&state->composition) / mf_box_volume(&state->box);
}

static void measure_pressure(struct inversion_state *state) {
    const struct replicas_mean virial =
        mf_replicas_mean(&state->replicas, SAMPLER_VIRIAL, state->inefficiency);
    const double unit = virial_unit(state);
    const double ideal =
        (double)mf_composition_particles(&state->composition) * state->problem->scene.temperature;
    state->bulk.pressure = (state->box.dimensions * ideal + virial.mean) / unit;
    state->bulk.pressure_error = virial.error / unit;
}

bool mf_inversion_bulk_knows_pressure(const struct inversion_state *state) {
    const struct replicas_mean virial =
        mf_replicas_mean(&state->replicas, SAMPLER_VIRIAL, state->inefficiency);
    return !state->problem->knows_elsewhere || virial.mean != 0 || virial.error > 0;
}

enum status mf_inversion_bulk_check(const struct inversion_state *state) {
    static const double rounding = 1e-9;
    if (mf_inversion_bulk_kind(state) != TARGET_DENSITY ||
        state->bulk.error > rounding * state->bulk.value)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "target.density: the frames of the engine all have one volume: it must hold "
        "the pressure, as LAMMPS by \"fix npt\", or leave out \"density\"");
}

void mf_inversion_bulk_measure(struct inversion_state *state) {
    struct inversion_bulk *bulk = &state->bulk;
    measure_pressure(state);
    bulk->value = bulk->pressure;
    bulk->error = bulk->pressure_error;
    if (mf_inversion_bulk_kind(state) == TARGET_DENSITY) {
        const struct replicas_mean density =
            mf_replicas_mean(&state->replicas, SAMPLER_DENSITY, state->inefficiency);
        bulk->value = density_unit(state) * density.mean;
        bulk->error = density_unit(state) * density.error;
    }
    if (!mf_inversion_bulk_is_asked(state))
        return;
    struct target_distance *distance = &state->assessment.distance[mf_inversion_bulk_kind(state)];
    *distance = mf_targets_distance(target_of(state), &bulk->value, &bulk->error);
    state->assessment.bulk_reach = hypot(distance->noise, 2 * find_change(state) * distance->rms);
}

struct inverse_doubling mf_inversion_bulk_noise(const struct inversion_state *state,
                                                int doublings) {
    static const double noise_share = 0.5;
    enum { MOST = 4 };
    if (!mf_inversion_bulk_is_asked(state) || !mf_inversion_state_is_near(state) ||
        doublings >= MOST)
        return (struct inverse_doubling){.wanted = 1, .unit = ""};
    return (struct inverse_doubling){
        .noise = state->bulk.error,
        .wanted =
            fmax(*target_of(state)->error, noise_share * fabs(mf_inversion_bulk_missing(state))),
        .unit = mf_observable_kind(mf_inversion_bulk_kind(state)).target->unit};
}

double mf_inversion_bulk_shift(const struct inversion_state *state) {
    const bool density = mf_inversion_bulk_kind(state) == TARGET_DENSITY;
    const double square = mf_inversion_equilibrium_shift(
        &state->replicas, state->bins + (density ? SAMPLER_DENSITY : SAMPLER_VIRIAL));
    return sqrt(fmax(square, 0)) * (density ? density_unit(state) : 1 / virial_unit(state));
}

/// Σ_a S_a ∂(−r_a U'(r_a))/∂U_b of bond lengths, U' being a central difference: what the value of
/// a bin does to the virial of the bins beside it.
static double bond_virial(const struct inversion_state *state, const struct bonded_bins *bins,
                          size_t bin, size_t k) {
    const double *counts = state->replicas.counts.mean;
    const double below = k > 0 ? counts[bin - 1] * bonded_bins_centre(bins, k - 1) : 0;
    const double above =
        k + 1 < bins->count ? counts[bin + 1] * bonded_bins_centre(bins, k + 1) : 0;
    return (above - below) / (2 * bins->width);
}

/// The same of f of local densities, Σ_a T_a ∂(−f'(ρ_a))/∂f_b with the stresses T of the bins.
/// @param[in] stress  shape [bins->count]
static double density_virial(const double *stress, const struct bonded_bins *bins, size_t k) {
    const double below = k > 0 ? stress[k - 1] : 0;
    const double above = k + 1 < bins->count ? stress[k + 1] : 0;
    return (above - below) / (2 * bins->width);
}

/// What the value of a bin of a group does to the virial, beside what it does to S.
static double group_virial(const struct inversion_state *state, size_t b) {
    const struct potential_grid *grid = &state->grid;
    const size_t point = grid->known_point[b], bin = grid->known_bin[b];
    const double *stress =
        state->replicas.counts.mean + state->bins + SAMPLER_SUMS + state->kirkwood_buff.pairs;
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *group = &grid->group[g];
        const struct bonded_unknown *unknown = group->own.unknown;
        const bool here = point >= group->point && point < group->point + group->own.points;
        if (here && unknown->order == INVERSE_LOCAL_DENSITY)
            return density_virial(stress, &unknown->bins, bin - group->bin);
        if (here && mf_group_kind_is_length(unknown->order))
            return bond_virial(state, &unknown->bins, bin, bin - group->bin);
        if (unknown->order == INVERSE_LOCAL_DENSITY)
            stress += unknown->bins.count;
    }
    return 0;
}

static enum status find_pressure_slopes(struct inversion_state *state) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &state->grid;
    const struct comoments *counts = &state->replicas.counts;
    double *virial = NULL;
    NEW_ARRAY(virial, grid->pair_bins * grid->known);
    CHECK(mf_potential_grid_virials(grid, &state->problem->targets.bins, state->box.dimensions,
                                    state->phi, virial));
    for (size_t b = 0; b < grid->known; b++) {
        double slope =
            -mf_comoments_covariance(counts, state->bins + SAMPLER_VIRIAL, grid->known_bin[b]) /
            state->problem->scene.temperature;
        slope += group_virial(state, b);
        for (size_t a = 0; a < grid->pair_bins; a++)
            slope += counts->mean[a] * virial[a * grid->known + b];
        state->bulk.slope[b] = slope / virial_unit(state);
    }
done:
    mf_memory_free(virial);
    return status;
}

/// In units of 1/V of the scene the pairs of a bin are S = G w, with G as they are counted and w
/// that of the sample (inversion/sampler.h): cov(w, S) = ⟨w⟩ cov(w, G) + ⟨G⟩ var w.
static void find_density_slopes(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const struct comoments *counts = &state->replicas.counts;
    const size_t w = state->bins + SAMPLER_DENSITY;
    const double variance = mf_comoments_covariance(counts, w, w);
    for (size_t b = 0; b < grid->known; b++) {
        const size_t bin = grid->known_bin[b];
        const double covariance = mf_comoments_covariance(counts, w, bin);
        const double with_pairs = b < grid->pairs_known
                                      ? counts->mean[w] * covariance + counts->mean[bin] * variance
                                      : covariance;
        state->bulk.slope[b] =
            -density_unit(state) * with_pairs / state->problem->scene.temperature;
    }
}

enum status mf_inversion_bulk_slopes(struct inversion_state *state) {
    if (mf_inversion_bulk_kind(state) == TARGET_PRESSURE)
        return find_pressure_slopes(state);
    find_density_slopes(state);
    return STATUS_OK;
}

double mf_inversion_bulk_ramp_slope(const struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    double slope = 0;
    for (size_t b = 0; b < grid->known; b++)
        slope += state->bulk.slope[b] * mf_potential_grid_ramp(grid, grid->known_point[b]);
    return slope;
}

void mf_inversion_bulk_add_ramp(const struct inversion_state *state, double *step) {
    const struct potential_grid *grid = &state->grid;
    if (!mf_inversion_bulk_is_asked(state) || grid->pairs == 0)
        return;
    double missing = mf_inversion_bulk_missing(state);
    for (size_t b = 0; b < grid->known; b++)
        missing -= state->bulk.slope[b] * step[grid->known_point[b]];
    const double amplitude = missing / mf_inversion_bulk_ramp_slope(state);
    for (size_t n = 0; n < grid->known; n++)
        step[grid->known_point[n]] +=
            amplitude * mf_potential_grid_ramp(grid, grid->known_point[n]);
}
