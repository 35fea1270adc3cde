// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a state is made of: its system, its memory.
#include "inversion/inversion_state.h"
#include "dynamics/metropolis.h"
#include "inversion/inversion_low_rank.h"
#include "problem/group_kind.h"
#include "system/scaled_system.h"

#include <math.h>

/// By which the share of a type or of a kind of molecules may change with the number of particles:
/// rare ones are rounded, and keep two.
static const double max_distortion = 0.2;

static const struct topology *topology_of(const struct simulation_setup *scene) {
    const struct molecules *molecules = mf_molecules_find(scene->interaction, scene->interactions);
    return molecules ? &molecules->topology : NULL;
}

const struct topology *mf_inversion_topology(const struct inversion_state *state) {
    return state->topology.kinds > 0 ? &state->topology : topology_of(&state->problem->scene);
}

static enum status check_shares(const struct composition *composition,
                                const struct topology *topology, int64_t wanted,
                                const struct scaled_system *system) {
    if (!mf_scaled_system_is_alike(composition, topology))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "method.particles: g(r) counts pairs within molecules, which in a mixture go by the "
            "numbers of the scene: leave it out, or \"exclude\" these pairs");
    if (system->distortion <= max_distortion)
        return STATUS_OK;
    const int64_t next = mf_scaled_system_min(composition, topology, wanted, max_distortion);
    if (next < wanted)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.particles: %lld change the share of a type or of a kind of "
                              "molecules, as some are few: leave it out",
                              (long long)wanted);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "method.particles: %lld change the share of %s by %.0f %%; %lld are the next that keep all "
        "shares",
        (long long)wanted, topology ? "a type or of a kind of molecules" : "a type",
        100 * system->distortion, (long long)next);
}

/// The smallest number to ask for that makes so many beads and keeps shares, no more than the scene
/// has: molecules are whole, and may be rounded down.
static int64_t find_least(const struct simulation_setup *scene, const struct topology *topology,
                          double beads) {
    const int64_t all = mf_composition_particles(&scene->composition);
    int64_t particles = (int64_t)ceil(beads);
    for (; particles < all; particles++) {
        const struct scaled_system system =
            mf_scaled_system(&scene->composition, topology, particles);
        if ((double)mf_composition_particles(&system.composition) >= beads &&
            system.distortion <= max_distortion)
            break;
    }
    return particles;
}

/// What an edge must hold, and in words why.
struct inversion_edge {
    double least;
    const char *holds;
};

/// Of each pair one image is in range: of g(r), and of what is known. Single beads are sampled by
/// Monte Carlo, whose list has a skin besides.
static struct inversion_edge find_edge_of_pairs(const struct inverse_problem *problem) {
    const double range =
        problem->unknown[UNKNOWN_POTENTIAL].wanted ? mf_rdf_bins_range(&problem->targets.bins) : 0;
    double known = 0;
    for (int pair = 0; pair < mf_composition_pairs(&problem->scene.composition); pair++) {
        const struct curve *const curve = inverse_law_curve(&problem->known, pair);
        known = fmax(known, curve ? mf_curve_cutoff(curve) : 0);
    }
    const double reach = fmax(known, range);
    if (topology_of(&problem->scene))
        return (struct inversion_edge){2 * reach, known > range ? "twice the cutoff of \"known\""
                                                                : "twice the range of g(r)"};
    return (struct inversion_edge){metropolis_shortest_box(reach),
                                   known > range ? "2.1 times the cutoff of \"known\""
                                                 : "2.1 times the range of g(r)"};
}

/// By its target, or by its law if it has none [λ].
static double find_bond_length(const struct inverse_problem *problem,
                               const struct molecules *molecules, int g) {
    for (size_t k = 0; k < problem->bonded; k++) {
        const struct bonded_unknown *const unknown = &problem->group[k];
        const double *const p = problem->targets.target[mf_group_kind_target(BONDED_BOND)].value;
        if (unknown->order == BONDED_BOND && unknown->group == g)
            return mf_bonded_distribution_moments(&unknown->bins, p + unknown->first).mean;
    }
    return mf_bonded_reach(&molecules->group[BONDED_BOND][g].curve, problem->scene.temperature);
}

/// A molecule that is stretched out, and what acts on it from beyond its ends.
static struct inversion_edge find_edge_of_molecules(const struct inverse_problem *problem,
                                                    double pairs) {
    const struct simulation_setup *const scene = &problem->scene;
    const struct molecules *const molecules =
        mf_molecules_find(scene->interaction, scene->interactions);
    double bond = 0, bonds = 0;
    for (int g = 0; molecules && g < molecules->groups[BONDED_BOND]; g++)
        bond = fmax(bond, find_bond_length(problem, molecules, g));
    for (int k = 0; molecules && k < molecules->topology.kinds; k++)
        bonds = fmax(bonds, molecules->topology.kind[k].beads - 1);
    return (struct inversion_edge){bonds * bond + 0.5 * pairs,
                                   "what keeps a molecule apart from its own image"};
}

/// What an edge may be shorter by than what it holds.
static const double rounding = 1e-9;

static enum status check_edge(const struct simulation_setup *scene, const struct box *box,
                              int64_t wanted, const struct inversion_edge *edge) {
    const double found = mf_box_shortest(box);
    const double share = pow(edge->least / mf_box_shortest(&scene->box), scene->box.dimensions);
    const double beads = share * (double)mf_composition_particles(&scene->composition);
    if (found >= edge->least * (1 - rounding))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "method.particles: %lld make a box whose shortest edge, %g" STATUS_LENGTH
                          ", is below %s, %g" STATUS_LENGTH "; %lld are the least",
                          (long long)wanted, found, edge->holds, edge->least,
                          (long long)find_least(scene, topology_of(scene), beads * (1 - rounding)));
}

/// Molecules that may meet their own images in the scene do so no more often in what is sampled.
static enum status check_edges(const struct inverse_problem *problem, const struct box *box,
                               int64_t wanted) {
    const struct inversion_edge pairs = find_edge_of_pairs(problem);
    const double of_scene = mf_box_shortest(&problem->scene.box);
    struct inversion_edge whole = find_edge_of_molecules(problem, pairs.least);
    if (whole.least > of_scene)
        whole = (struct inversion_edge){
            of_scene, "that of the scene, in which a molecule may already meet its own image"};
    return check_edge(&problem->scene, box, wanted, whole.least > pairs.least ? &whole : &pairs);
}

/// So many particles at the densities of the scene, and their box.
static enum status find_size(const struct inverse_problem *problem, int64_t wanted,
                             struct scaled_system *system, struct box *box) {
    const struct simulation_setup *scene = &problem->scene;
    const struct topology *topology = topology_of(scene);
    *system = mf_scaled_system(&scene->composition, topology, wanted);
    *box = mf_box_scaled(&scene->box, (double)mf_composition_particles(&system->composition) /
                                          (double)mf_composition_particles(&scene->composition));
    TRY(check_shares(&scene->composition, topology, wanted, system));
    return check_edges(problem, box, wanted);
}

/// Whether that is another number than the scene has.
static bool is_other_size(const struct inverse_problem *problem, int64_t wanted) {
    return problem->engine == NULL && wanted > 0 &&
           wanted != mf_composition_particles(&problem->scene.composition);
}

enum status mf_inversion_check_size(const struct inverse_problem *problem, int64_t wanted) {
    struct scaled_system system;
    struct box box;
    return is_other_size(problem, wanted) ? find_size(problem, wanted, &system, &box) : STATUS_OK;
}

static enum status choose_size(struct inversion_state *state) {
    const struct simulation_setup *scene = &state->problem->scene;
    const struct topology *topology = topology_of(scene);
    struct scaled_system system;
    state->composition = scene->composition;
    state->box = scene->box;
    if (!is_other_size(state->problem, state->parameters->particles))
        return STATUS_OK;
    TRY(find_size(state->problem, state->parameters->particles, &system, &state->box));
    state->composition = system.composition;
    return topology ? mf_scaled_system_topology(&system, topology, &state->topology) : STATUS_OK;
}

/// Local densities act by their forces alone.
static enum status refuse_moves(const struct inversion_state *state) {
    const struct simulation_setup *scene = &state->problem->scene;
    if (state->parameters->sampler != SAMPLER_MONTE_CARLO ||
        mf_many_body_find(scene->interaction, scene->interactions) == NULL)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "method.sampler: \"monte-carlo\" moves beads by energies of pairs, and "
                          "does not sample \"many_body\"; \"dynamics\" and \"auto\" do, exactly");
}

/// No potential of pairs empties a shell in the midst of a liquid: an empty bin beyond one that is
/// well known is a fault of the target, and what would be made of it a barrier without an end.
static enum status refuse_holes(const struct inversion_state *state) {
    static const double well = 0.1;
    const struct inverse_problem *problem = state->problem;
    const struct potential_grid *grid = &state->grid;
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t bin = grid->known_bin[n], next = grid->known_bin[n] + 1;
        const double *g = problem->targets.target[TARGET_RDF].value;
        if (next % grid->bins == 0 || !(g[bin] > well) || g[next] > problem->core_threshold)
            continue;
        const double r = mf_rdf_bins_centre(&problem->targets.bins, next % grid->bins);
        char kind[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&problem->scene.composition, (int)(bin / grid->bins), kind);
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s%sthe target is empty at r = %g" STATUS_LENGTH
            ", where the bin before it has g = %.3g: no pair "
            "potential gives such a gap; correct the target there, or end it before by \"cutoff\"",
            kind, kind[0] ? ": " : "", r, problem->targets.target[TARGET_RDF].value[bin]);
    }
    return STATUS_OK;
}

static enum status allocate(struct inversion_state *state) {
    enum status status = STATUS_OK;
    const size_t bins = state->bins, known = state->grid.known;
    struct inversion_target *target = &state->target;
    NEW_ARRAY(target->ideal, bins);
    NEW_ARRAY(target->unit, bins);
    NEW_ARRAY(target->counts, bins);
    NEW_ARRAY(target->error, bins);
    NEW_ARRAY(target->min, bins);
    NEW_ARRAY(target->common, known);
    NEW_ARRAY(target->steepness, known);
    NEW_ARRAY(target->shape, state->grid.blocks);
    NEW_ARRAY(state->groups, state->grid.groups);
    NEW_ARRAY(state->excess, known);
    NEW_ARRAY(state->variance, known);
    NEW_ARRAY(state->bin_inefficiency, known);
    NEW_ARRAY(state->memory, state->grid.blocks);
    NEW_ARRAY(state->pool.excess, known);
    NEW_ARRAY(state->pool.variance, known);
    NEW_ARRAY(state->pool.phi, state->grid.points);
    NEW_ARRAY(state->bulk.slope, known);
    NEW_ARRAY(state->open.weight, known);
    NEW_ARRAY(state->inside.g, state->grid.pairs * state->grid.bins);
    CHECK(mf_inversion_response_init(state));
    CHECK(mf_inversion_kirkwood_buff_init(state));
done:
    return status;
}

enum status mf_inversion_state_init(struct inversion_state *state,
                                    const struct inverse_problem *problem,
                                    const struct inversion_parameters *parameters,
                                    const struct inversion_basis_size *coefficients) {
    state->problem = problem;
    state->parameters = parameters;
    state->gradient = INFINITY;
    TRY(choose_size(state));
    TRY(refuse_moves(state));
    TRY(mf_potential_grid_init(&state->grid, problem));
    state->bins = state->grid.all_bins;
    TRY(refuse_holes(state));
    TRY(allocate(state));
    mf_inversion_count_targets(state);
    if (state->grid.pairs == 0 && mf_inversion_bulk_is_asked(state))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "target.%s: no pair potential is fitted that could meet it; "
                              "with \"fitted\": \"no\" it is only compared",
                              mf_targets_name((int)mf_inversion_bulk_kind(state)));
    if (coefficients)
        return mf_inversion_basis_init(&state->basis, &state->grid, coefficients);
    return state->grid.pairs > 1 || mf_potential_grid_has_terms(&state->grid)
               ? mf_inversion_low_rank_init(state)
               : STATUS_OK;
}

static void clear_interaction(struct inversion_state *state) {
    mf_table_clear(&state->interaction.table);
    mf_potential_grid_molecules_clear(&state->grid, &state->interaction.molecules);
    mf_potential_grid_many_body_clear(&state->grid, &state->interaction.many_body);
}

enum status mf_inversion_tabulate(struct inversion_state *state) {
    const struct simulation_setup *scene = &state->problem->scene;
    const struct potential_grid *grid = &state->grid;
    const struct molecules *molecules = mf_molecules_find(scene->interaction, scene->interactions);
    const struct many_body *many_body = mf_many_body_find(scene->interaction, scene->interactions);
    const double *energy = state->phi + grid->pair_points; // of the groups
    clear_interaction(state);
    if (grid->pairs > 0)
        TRY(mf_potential_grid_table(grid, state->phi, &state->interaction.table));
    if (molecules)
        TRY(mf_potential_grid_molecules(grid, energy, molecules, &state->interaction.molecules));
    if (state->topology.kinds > 0)
        state->interaction.molecules.topology = state->topology;
    if (many_body) {
        TRY(mf_potential_grid_many_body(grid, energy, many_body, &state->interaction.many_body));
        state->interaction.many_body.composition = state->composition;
    }
    return STATUS_OK;
}

enum status mf_inversion_state_make_samplers(struct inversion_state *state) {
    const struct inverse_problem *problem = state->problem;
    const struct inversion_parameters *p = state->parameters;
    const struct simulation_setup *scene = &problem->scene;
    const struct rdf_bins *bins = &problem->targets.bins;
    const bool joined = mf_molecules_find(scene->interaction, scene->interactions) != NULL;
    const bool pairs = state->grid.pairs > 0;
    const bool crowds = mf_many_body_find(scene->interaction, scene->interactions) != NULL;
    TRY(mf_inversion_tabulate(state));
    // What one cannot sample none can: molecules take long to be placed.
    return mf_replicas_init(
        &state->replicas, problem->trial ? 1 : (size_t)p->replicas, (enum sampler_kind)p->sampler,
        &(struct sampler_system){.cancel = scene->cancel,
                                 .box = &state->box,
                                 .composition = &state->composition,
                                 .potential = pairs ? &state->interaction.table : scene->potential,
                                 .temperature = scene->temperature,
                                 .low = bins->low,
                                 .width = bins->width,
                                 .bins = pairs ? bins->count : 0,
                                 .molecules = joined ? &state->interaction.molecules : NULL,
                                 .many_body = crowds ? &state->interaction.many_body : NULL,
                                 .group = state->groups,
                                 .groups = state->grid.groups,
                                 .integrals = state->kirkwood_buff.pairs,
                                 .q_maximum = state->kirkwood_buff.q_maximum,
                                 .engine = problem->engine,
                                 .seed = problem->seed});
}

void mf_inversion_state_clear(struct inversion_state *state) {
    mf_replicas_clear(&state->replicas);
    clear_interaction(state);
    mf_potential_grid_clear(&state->grid);
    mf_topology_clear(&state->topology);
    mf_inversion_basis_clear(&state->basis);
    mf_inversion_basis_clear(&state->low_rank);
    mf_inversion_kirkwood_buff_clear(&state->kirkwood_buff);
    mf_inversion_response_clear(&state->response);
    mf_memory_free(state->memory);
    mf_memory_free(state->target.shape);
    mf_memory_free(state->groups);
    double *arrays[] = {state->target.ideal, state->target.unit,   state->target.counts,
                        state->target.error, state->target.min,    state->target.common,
                        state->excess,       state->variance,      state->bin_inefficiency,
                        state->pool.excess,  state->pool.variance, state->pool.phi,
                        state->bulk.slope,   state->inside.g,      state->target.steepness,
                        state->open.weight,  state->indirect};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
}

size_t mf_inversion_state_spans(struct inversion_state *state, struct memory_span *span) {
    const size_t known = state->grid.known, bytes = known * sizeof(double);
    struct inversion_pool *pool = &state->pool;
    struct inversion_response *response = &state->response;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->work, sizeof state->work};
    span[n++] = (struct memory_span){state->memory, state->grid.blocks * sizeof *state->memory};
    span[n++] = (struct memory_span){&state->gradient, sizeof state->gradient};
    span[n++] = (struct memory_span){&pool->samples, sizeof pool->samples};
    span[n++] = (struct memory_span){pool->excess, bytes};
    span[n++] = (struct memory_span){pool->variance, bytes};
    span[n++] = (struct memory_span){pool->phi, state->grid.points * sizeof(double)};
    span[n++] = (struct memory_span){state->open.weight, bytes};
    span[n++] = (struct memory_span){&state->open.rest, sizeof state->open.rest};
    span[n++] = (struct memory_span){&response->independent, sizeof response->independent};
    span[n++] = (struct memory_span){response->mean, bytes};
    span[n++] = (struct memory_span){response->phi, bytes};
    span[n++] = (struct memory_span){&response->functions, sizeof response->functions};
    span[n++] = (struct memory_span){response->sampled, known * bytes};
    if (response->of_density)
        span[n++] = (struct memory_span){response->of_density, bytes};
    span[n++] = (struct memory_span){&state->inside.min, sizeof state->inside.min};
    span[n++] = (struct memory_span){state->inside.g,
                                     state->grid.pairs * state->grid.bins * sizeof(double)};
    if (state->kirkwood_buff.pairs > 0)
        span[n++] =
            (struct memory_span){state->kirkwood_buff.slope, state->kirkwood_buff.pairs * bytes};
    return n + mf_replicas_spans(&state->replicas, span + n);
}
