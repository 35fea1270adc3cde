// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_intramolecular.h"

#include <math.h>
#include <string.h>

/// Least eigenvalue of Ω at which g of the types are independent enough. Measured: 0.59 of rings
/// and 0.75 of chains of six, 0.69 of chains in a solvent, the starts of which are within 0.3 k_B T
/// of the truth but in the core; 0 of hexane in three beads, where −k_B T ln g was nearer.
static const double independent = 0.3;

/// g as a whole is known within this, as counts of N or N − 1 particles make a per mille. Measured:
/// of ten liquids the start is as near to the law with this as with 0, farther with ten times it.
static const double level = 1e-3;

/// Part of the pairs that may be nearer than the first bin, as where a file leaves out the rows of
/// the core: without bonds Ω is another molecule's.
static const double max_nearer = 0.01;

/// Configurations of free molecules of each replica, and trajectories between them.
enum { ROUNDS = 10, EVERY = 40 };

static bool has_molecules(const struct inversion_state *state) {
    const struct simulation_setup *scene = &state->problem->scene;
    return mf_molecules_find(scene->interaction, scene->interactions) != NULL;
}

/// The equation of Ornstein and Zernike needs g of all pairs that there are.
static bool knows_all_pairs(const struct inversion_state *state) {
    bool all = true;
    for (size_t pair = 0; pair < state->grid.pairs; pair++)
        all = all && (state->grid.known_of[pair] > 0 ||
                      !mf_composition_has_pairs(&state->composition, (int)pair));
    return all;
}

bool mf_inversion_knows_intramolecular(const struct inversion_state *state) {
    return state->box.dimensions == 3 && knows_all_pairs(state) &&
           (!has_molecules(state) || state->inside.min > independent);
}

struct hnc_liquid mf_inversion_liquid(const struct inversion_state *state) {
    return (struct hnc_liquid){&state->problem->targets.bins, &state->box, &state->composition,
                               state->inside.min > 0 ? state->inside.g : NULL, level};
}

/// Sample once more, and count; of what is nearer than the first bin add the number.
static enum status sample(struct inversion_state *state, const struct inverse_listener *listener,
                          double *counts, double *nearer) {
    const struct replicas_plan plan = {.equilibration = EVERY, .block_samples = 1, .every = 1};
    const struct inverse_progress progress = {.iterations =
                                                  (uint32_t)state->parameters->iterations};
    struct replicas *replicas = &state->replicas;
    TRY(mf_replicas_run(replicas, &plan, state->problem->threads, &progress, listener));
    state->work.sweeps += (replicas_plan_sweeps(&plan) + EVERY) * replicas->count;
    for (size_t k = 0; k < replicas->count; k++) {
        struct sampler *sampler = &replicas->member[k].sampler;
        TRY(mf_sampler_begin(sampler)); // another rank may have sampled
        *nearer += mf_sampler_count_excluded(sampler, &state->composition, counts);
    }
    return STATUS_OK;
}

/// Pairs of beads of two types that there are, over all, a bead with itself among them.
static double find_existing(const struct composition *composition, int pair) {
    int type[2];
    mf_composition_pair_types(composition, pair, type);
    return type[0] == type[1] ? 1 - 1 / (double)composition->count[type[0]] : 1;
}

/// Counts of so many rounds over those of an ideal gas, and what they tell of Ω.
static enum status assess(struct inversion_state *state, const double *counts, int rounds,
                          double *min) {
    const struct hnc_liquid liquid = {&state->problem->targets.bins, &state->box,
                                      &state->composition, state->inside.g, 0};
    for (size_t n = 0; n < state->grid.pair_bins; n++)
        state->inside.g[n] = find_existing(&state->composition, (int)(n / state->grid.bins)) *
                             counts[n] /
                             (rounds * (double)state->replicas.count * state->target.ideal[n]);
    return mf_hnc_closure_min_intramolecular(&liquid, min);
}

enum status mf_inversion_intramolecular_find(struct inversion_state *state, double *phi,
                                             const struct inverse_listener *listener) {
    enum status status = STATUS_OK;
    struct potential_grid *grid = &state->grid;
    const struct inverse_law beside = grid->beside;
    double *counts = NULL, nearer = 0, pairs = 0, min = INFINITY;
    if (!has_molecules(state) || grid->pairs == 0 || state->box.dimensions != 3)
        return STATUS_OK;
    NEW_ARRAY(counts, grid->pair_bins);
    memset(phi, 0, grid->pair_points * sizeof *phi);
    grid->beside = (struct inverse_law){0}; // pairs of free molecules do not act at all
    CHECK(mf_inversion_tabulate(state));
    // What is of no use is seen at once.
    for (int round = 1; round <= ROUNDS && min > independent; round++) {
        CHECK(sample(state, listener, counts, &nearer));
        CHECK(assess(state, counts, round, &min));
    }
    for (size_t n = 0; n < grid->pair_bins; n++)
        pairs += counts[n];
    if (nearer <= max_nearer * (nearer + pairs))
        state->inside.min = min;
done:
    grid->beside = beside;
    mf_memory_free(counts);
    return status;
}
