// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the targets of a state ask of its samples: S* and its error in each bin.
#include "inversion/inversion_state.h"

#include "observe/finite_size.h"
#include "problem/group_kind.h"

#include <math.h>

/// S if g were 1, and S* with its error, of each pair type: in the sampled system, which may have
/// other numbers of particles than the scene.
static void set_pairs(struct inversion_state *state) {
    const struct inverse_problem *problem = state->problem;
    const struct simulation_setup *scene = &problem->scene;
    const struct rdf_bins *bins = &problem->targets.bins;
    const struct target *target = &problem->targets.target[TARGET_RDF];
    const double from = (double)mf_composition_particles(&scene->composition);
    const double to = (double)mf_composition_particles(&state->composition);
    const struct molecules *molecules = mf_molecules_find(scene->interaction, scene->interactions);
    const struct finite_size_fluid fluid = {.box = &scene->box,
                                            .composition = &scene->composition,
                                            .topology = molecules ? &molecules->topology : NULL};
    for (size_t first = 0; first < state->grid.pair_bins; first += bins->count) {
        const int pair = (int)(first / bins->count);
        const double factor = mf_finite_size_factor_of(
            bins, target->value + first, target->error + first, &fluid, pair, from, to);
        for (size_t k = 0; k < bins->count; k++) {
            const size_t bin = first + k;
            const double ideal =
                mf_rdf_ideal_pairs_of(bins, k, &state->box, &state->composition, pair);
            state->target.min[bin] = problem->core_threshold;
            state->target.ideal[bin] = state->target.unit[bin] = ideal > 0 ? ideal : 1;
            if (!mf_targets_have_pair(&problem->targets, (size_t)pair)) {
                state->target.unit[bin] = INFINITY; // what is counted says nothing
                continue;
            }
            state->target.counts[bin] = ideal * target->value[bin] * factor;
            state->target.error[bin] = ideal * target->error[bin];
        }
    }
}

/// −ln g* of a known bin.
static double potential_of_mean_force(const struct inversion_state *state, size_t a) {
    const size_t bin = state->grid.known_bin[a];
    return -log(fmax(state->target.counts[bin] / state->target.ideal[bin], state->target.min[bin]));
}

/// The error of S* that the bins of a pair type have in common: by their normalisation, which is
/// known within `factor_error`.
static void set_common_errors(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const struct targets *targets = &state->problem->targets;
    const double *factor_error = targets->target[TARGET_RDF].factor_error;
    for (size_t a = 0; factor_error && a < grid->pairs_known; a++) {
        const size_t bin = grid->known_bin[a];
        if (grid->seen[a])
            state->target.common[a] =
                state->target.counts[bin] * factor_error[bin / targets->bins.count];
    }
}

/// By how much −ln g* changes within ℓ round each bin of a pair type; at its ends by as much in
/// what there is of ℓ.
static void set_steepness(struct inversion_state *state, size_t begin, size_t end) {
    const double width = state->problem->targets.bins.width;
    const size_t half = (size_t)fmax(1, round(0.5 * mf_imc_smooth_length / width));
    for (size_t a = begin; a < end; a++) {
        const size_t low = a > begin + half ? a - half : begin;
        const size_t high = a + half < end ? a + half : end - 1;
        const double change =
            potential_of_mean_force(state, high) - potential_of_mean_force(state, low);
        if (high > low)
            state->target.steepness[a] =
                fabs(change) * mf_imc_smooth_length / ((double)(high - low) * width);
    }
}

static double peak_of(const struct bonded_grid *group) {
    double peak = 0;
    for (size_t k = 0; k < group->unknown->bins.count; k++)
        peak = fmax(peak, group->target[k]);
    return peak;
}

/// S* and its error of a group; `ideal` is S where p is its mean over the known bins.
static void set_group(struct inversion_state *state, const struct potential_group *group) {
    const struct inverse_problem *problem = state->problem;
    const struct bonded_unknown *unknown = group->own.unknown;
    const double *error =
        problem->targets.target[mf_group_kind_target(unknown->order)].error + unknown->first;
    const double mean = mf_bonded_grid_mean(&group->own), peak = peak_of(&group->own);
    const double terms =
        (double)mf_group_kind_terms(mf_inversion_topology(state), unknown,
                                    (size_t)mf_composition_particles(&state->composition));
    const double unit = unknown->bins.width * terms;
    for (size_t k = 0; k < unknown->bins.count; k++) {
        const size_t bin = group->bin + k;
        state->target.unit[bin] = unit;
        state->target.ideal[bin] = unit * mean;
        state->target.counts[bin] = unit * group->own.target[k];
        state->target.error[bin] = unit * error[k];
        state->target.min[bin] = mf_bonded_distribution_seen * peak / mean;
    }
}

/// The next section, whose bins follow those of the section before.
static struct inversion_section *add_section(struct inversion_state *state, int kind) {
    struct inversion_section *section = &state->assessment.section[state->assessment.sections];
    if (state->assessment.sections > 0) {
        const struct inversion_section *last = section - 1;
        section->bin = last->bin + last->bins;
        section->known = last->known + last->known_count;
    }
    section->kind = kind;
    state->assessment.sections++;
    return section;
}

/// The groups stand in the order of their kinds. U may bend by k_B T within a tenth of the range
/// that is known.
static void enter_group(struct inversion_state *state, size_t g) {
    static const double narrow = 0.1;
    const struct bonded_grid *own = &state->grid.group[g].own;
    const struct bonded_unknown *unknown = own->unknown;
    struct inversion_section *section = add_section(state, mf_group_kind_target(unknown->order));
    section->bins = unknown->bins.count;
    section->known_count = own->known;
    section->peak = peak_of(own);
    state->groups[g] = (struct sampler_group){unknown->order, unknown->group, unknown->bins,
                                              unknown->order == INVERSE_LOCAL_DENSITY
                                                  ? mf_group_kind_density(&state->problem->targets)
                                                  : NULL};
    state->target.shape[state->grid.pairs + g] =
        (struct imc_shape){.bend = fmax(1, narrow * (double)own->known),
                           .periodic = mf_group_kind_is_periodic(unknown->order)};
}

void mf_inversion_count_targets(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    if (grid->pairs > 0) {
        struct inversion_section *section = add_section(state, TARGET_RDF);
        section->bins = grid->pair_bins;
        section->known_count = grid->pairs_known;
        section->peak = 1;
    }
    set_pairs(state);
    set_common_errors(state);
    for (size_t block = 0, first = 0; block < grid->pairs; first += grid->known_of[block++])
        set_steepness(state, first, first + grid->known_of[block]);
    for (size_t g = 0; g < grid->groups; g++) {
        set_group(state, &grid->group[g]);
        enter_group(state, g);
    }
}
