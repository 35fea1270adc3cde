// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/metropolis.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/rng.h"
#include "dynamics/hybrid.h"
#include "dynamics/move.h"
#include "system/placement.h"

#include <string.h>

// Exchanges of beads of different types -----------------------------------------------------------
//
// Two beads, of two types that are drawn, each of these with the same probability, change places.
// In a dense liquid a bead needs hundreds of sweeps to go as far as its neighbours are, and the
// concentrations change by beads that go through the box; beads of about the same size take each
// other's place in one move. D. Gazzillo and G. Pastore, Chem. Phys. Lett. 159, 388 (1989).

/// Beads for each exchange that a sweep tries, and where they are hardly accepted. An exchange
/// costs as much as 1.6 moves. One in 4 beads instead of in 50 makes concentrations forget in a
/// half to a third of the time, with acceptances of 15, 13, 1.3 and 0.08 % (lab/samplers.md).
enum { BEADS_BY_EXCHANGE = 4, BEADS_BY_USELESS_EXCHANGE = 50 };

/// Sweeps in which a bead of the rarest type is to change places once, else beads go faster by
/// themselves.
static const double longest_wait = 1000;

static int64_t rarest(const struct composition *composition) {
    int64_t least = INT64_MAX;
    for (int type = 0; type < composition->types; type++)
        if (composition->count[type] > 0 && composition->count[type] < least)
            least = composition->count[type];
    return least;
}

static uint32_t one_in(const struct metropolis *metropolis, int beads) {
    return 1 + (uint32_t)metropolis->particles.count / (uint32_t)beads;
}

void mf_metropolis_exchange(struct metropolis *metropolis) {
    if (composition_is_mixed(&metropolis->law.composition))
        metropolis->exchanges = one_in(metropolis, BEADS_BY_EXCHANGE);
    metropolis->exchanges_accepted = metropolis->exchanges_tried = 0;
}

/// After an equilibration that has tried many. One more that was accepted is the benefit of the
/// doubt.
static void tune_exchanges(struct metropolis *metropolis) {
    const double accepted = (double)metropolis->exchanges_accepted + 1;
    const double in_a_sweep =
        accepted / (double)metropolis->exchanges_tried * metropolis->exchanges;
    if (in_a_sweep * longest_wait < (double)rarest(&metropolis->law.composition))
        metropolis->exchanges = one_in(metropolis, BEADS_BY_USELESS_EXCHANGE);
}

/// Change of Φ if particle k were of the type of another one; what the two have with each other
/// stays as it is when they change places.
static double change_of_type(const struct metropolis *metropolis, size_t k, size_t other) {
    const struct neighbours *neighbours = &metropolis->neighbours;
    return mf_move_type_change(&metropolis->law, &metropolis->particles, k, other,
                               neighbours->list + neighbours->start[k],
                               neighbours->stop[k] - neighbours->start[k]);
}

/// Two different types, each pair of them as likely.
static void draw_types(const struct composition *composition, double share, int type[2]) {
    const int pairs = composition->types * (composition->types - 1) / 2;
    int left = (int)(share * pairs);
    type[0] = 0;
    while (left >= composition->types - 1 - type[0])
        left -= composition->types - 1 - type[0]++;
    type[1] = type[0] + 1 + left;
}

/// A bead of a type: ids of a type follow each other.
static uint32_t draw_bead(const struct composition *composition, int type, double share) {
    int64_t first = 0;
    for (int t = 0; t < type; t++)
        first += composition->count[t];
    return (uint32_t)(first + (int64_t)(share * (double)composition->count[type]));
}

static void exchange(struct particles *particles, uint32_t *place, const uint32_t id[2]) {
    const uint32_t at[2] = {place[id[0]], place[id[1]]};
    for (int n = 0; n < 2; n++) {
        particles->id[at[n]] = particles->kernel_place[at[n]].id = id[1 - n];
        place[id[1 - n]] = at[n];
    }
}

static void try_exchange(struct metropolis *metropolis, uint32_t number, uint32_t *place) {
    const struct composition *composition = &metropolis->law.composition;
    const struct rng_block random =
        mf_rng_philox(metropolis->seed, RNG_EXCHANGE, metropolis->sweep, number, 0);
    int type[2];
    draw_types(composition, mf_rng_uniform(random.word[0], 0), type);
    if (composition->count[type[0]] == 0 || composition->count[type[1]] == 0)
        return;
    const uint32_t id[2] = {draw_bead(composition, type[0], mf_rng_uniform(random.word[1], 0)),
                            draw_bead(composition, type[1], mf_rng_uniform(random.word[2], 0))};
    const size_t k = place[id[0]], l = place[id[1]];
    const double change = change_of_type(metropolis, k, l) + change_of_type(metropolis, l, k);
    metropolis->exchanges_tried++;
    // Written so that a NaN is refused.
    if (!(mf_rng_uniform(random.word[3], 0) < exp(-change / metropolis->law.temperature)))
        return;
    metropolis->exchanges_accepted++;
    exchange(&metropolis->particles, place, id);
}

/// The exchanges of a sweep, after its moves of beads, whose list of neighbours is used.
static void exchange_beads(struct metropolis *metropolis, uint32_t *place) {
    if (metropolis->law.potential == NULL)
        return;
    for (uint32_t n = 0; n < metropolis->exchanges; n++)
        try_exchange(metropolis, n, place);
}

// Moves -------------------------------------------------------------------------------------------

/// Skin of the list in mean distances of the particles. It bounds the moves, and a wide one costs
/// only distances (move_loop.h). 729 particles take, with 0.6, 0.72, 0.9 and 1.1, 703, 684, 655 and
/// 676 ns a move of SPC water, and with 0.72, 0.9 and 1.1, 351, 351 and 372 ns of a Lennard-Jones
/// liquid (best of six, busy machine). A Groot-Warren fluid, whose moves are as long as the list
/// allows, takes for g to a given error 1.7 times as long with 0.36 as with 0.72, and 1.2 times
/// with 0.5 and with 1.
static const double skin_distances = 0.8;

double mf_metropolis_skin(const struct box *box, double count) {
    return skin_distances * pow(mf_box_volume(box) / count, 1.0 / box->dimensions);
}

/// Room for the particles, and a list that is not built yet.
static enum status prepare(struct metropolis *metropolis, const struct box *box, size_t count,
                           const struct pair_law *law) {
    static const double rounding = 1e-9;
    enum status status = STATUS_OK;
    const double cutoff = law->potential ? law->potential->cutoff : 0;
    *metropolis = (struct metropolis){.law = {.potential = law->potential,
                                              .composition = law->composition,
                                              .temperature = law->temperature},
                                      .step = 0.1,
                                      .seed = law->seed};
    CHECK(mf_particles_init(&metropolis->particles, box, count));
    NEW_ARRAY(metropolis->order, count);
    CHECK(mf_neighbours_init(&metropolis->neighbours, NEIGHBOURS_FULL, box, count, cutoff,
                             mf_metropolis_skin(box, (double)count)));
    if (mf_box_shortest(box) < metropolis_shortest_box(cutoff) * (1 - rounding)) {
        status = mf_status_fail(
            STATUS_BAD_INPUT,
            "the box is too small for Monte Carlo: its shortest edge %g" STATUS_LENGTH " must be "
            "at least 2.1 times the cutoff %g" STATUS_LENGTH,
            mf_box_shortest(box), cutoff);
        goto done;
    }
    metropolis->step = fmin(metropolis->step, metropolis_longest_step(metropolis));
done:
    return status;
}

/// From now on sweeps move the particles in the present order of the arrays.
static void keep_order(struct metropolis *metropolis) {
    const struct particles *particles = &metropolis->particles;
    memcpy(metropolis->order, particles->id, particles->count * sizeof *metropolis->order);
}

enum status mf_metropolis_init(struct metropolis *metropolis, const struct box *box,
                               const struct composition *composition, const struct table *potential,
                               double temperature, uint64_t seed) {
    enum status status = STATUS_OK;
    CHECK(prepare(metropolis, box, (size_t)mf_composition_particles(composition),
                  &(struct pair_law){.potential = potential,
                                     .composition = *composition,
                                     .temperature = temperature,
                                     .seed = seed}));
    mf_placement_lattice(&metropolis->particles, 0.05, seed);
    if (composition_is_mixed(composition))
        mf_placement_mix(&metropolis->particles, seed);
    CHECK(mf_metropolis_refresh(metropolis));
    keep_order(metropolis);
done:
    if (status != STATUS_OK)
        mf_metropolis_clear(metropolis);
    return status;
}

/// Let the particles be where others are.
static enum status take_places(struct metropolis *metropolis, const struct particles *from) {
    struct particles *particles = &metropolis->particles;
    for (int d = 0; d < particles->box.dimensions; d++) {
        memcpy(particles->position[d], from->position[d], from->count * sizeof(double));
        memcpy(particles->image[d], from->image[d], from->count * sizeof *from->image[d]);
    }
    memcpy(particles->id, from->id, from->count * sizeof *from->id);
    return mf_metropolis_refresh(metropolis);
}

static enum status join(struct metropolis *metropolis, const struct molecules *molecules) {
    TRY(mf_particles_join(&metropolis->particles, &molecules->topology));
    return mf_molecule_moves_init(&metropolis->molecules, molecules, &metropolis->particles);
}

enum status mf_metropolis_init_at(struct metropolis *metropolis, const struct particles *particles,
                                  const struct pair_law *law, const struct molecules *molecules) {
    enum status status = STATUS_OK;
    CHECK(prepare(metropolis, &particles->box, particles->count, law));
    if (molecules)
        CHECK(join(metropolis, molecules));
    CHECK(take_places(metropolis, particles));
    keep_order(metropolis);
done:
    if (status != STATUS_OK)
        mf_metropolis_clear(metropolis);
    return status;
}

void mf_metropolis_clear(struct metropolis *metropolis) {
    mf_particles_clear(&metropolis->particles);
    mf_neighbours_clear(&metropolis->neighbours);
    mf_memory_free(metropolis->order);
    mf_molecule_moves_clear(&metropolis->molecules);
    *metropolis = (struct metropolis){0};
}

enum status mf_metropolis_refresh(struct metropolis *metropolis) {
    return mf_neighbours_sort_and_build(&metropolis->neighbours, &metropolis->particles);
}

/// Where hybrid Monte Carlo begins: placed along their bonds, and parted.
static enum status place_molecules(struct metropolis *metropolis) {
    const struct pair_law *law = &metropolis->law;
    struct hybrid hybrid;
    TRY(mf_hybrid_init(&hybrid, &metropolis->particles.box, &law->composition, law->potential,
                       metropolis->molecules.molecules, NULL, &(struct pair_histogram){0},
                       law->temperature, metropolis->seed, &metropolis->bias));
    const enum status status = take_places(metropolis, &hybrid.simulation.particles);
    mf_hybrid_clear(&hybrid);
    return status;
}

enum status mf_metropolis_join(struct metropolis *metropolis, const struct molecules *molecules) {
    if (molecules == NULL)
        return STATUS_OK;
    TRY(join(metropolis, molecules));
    TRY(place_molecules(metropolis));
    keep_order(metropolis);
    return STATUS_OK;
}

enum status mf_metropolis_scatter(struct metropolis *metropolis) {
    if (metropolis->molecules.molecules)
        return place_molecules(metropolis);
    TRY(mf_placement_disordered(&metropolis->particles, metropolis->seed));
    mf_placement_tilt(&metropolis->particles, metropolis->bias.tilt, metropolis->seed);
    return mf_metropolis_refresh(metropolis);
}

/// Where each id stands: in spare words, which are other ones after a refresh.
static uint32_t *places(const struct metropolis *metropolis) {
    return metropolis->particles.spare_words;
}

static void list_places(const struct metropolis *metropolis) {
    const struct particles *particles = &metropolis->particles;
    for (size_t k = 0; k < particles->count; k++)
        places(metropolis)[particles->id[k]] = (uint32_t)k;
}

/// A move of a particle that is tried.
struct trial {
    size_t k;
    double moved[3];
    int32_t to[3]; ///< the same as fractions of the box
};

static void propose(const struct metropolis *metropolis, const struct rng_block *random, size_t k,
                    struct trial *trial) {
    const struct particles *particles = &metropolis->particles;
    const struct box *box = &particles->box;
    trial->k = k;
    for (int d = 0; d < box->dimensions; d++) {
        trial->moved[d] = particles->position[d][k] +
                          metropolis->step * (2 * mf_rng_uniform(random->word[d], 0) - 1);
        trial->to[d] = box_fraction(trial->moved[d], 1 / box->length[d]);
    }
}

/// Whether the list knows the neighbours where the particle is to go: it and all others are within
/// half the skin of where they were when it was built.
static bool is_listed(const struct metropolis *metropolis, const struct trial *trial) {
    const struct neighbours *neighbours = &metropolis->neighbours;
    const double reach = metropolis_reach(metropolis);
    double square = 0;
    for (int d = 0; d < metropolis->particles.box.dimensions; d++)
        square += pow(trial->moved[d] - neighbours->built[d][trial->k], 2);
    return square < reach * reach;
}

static double find_change(struct metropolis *metropolis, const struct trial *trial) {
    const struct neighbours *neighbours = &metropolis->neighbours;
    struct particles *particles = &metropolis->particles;
    const size_t k = trial->k;
    double change = 0;
    if (metropolis->law.potential)
        change = mf_move_energy_change(&metropolis->law, particles, k,
                                       neighbours->list + neighbours->start[k],
                                       neighbours->stop[k] - neighbours->start[k], trial->to);
    if (metropolis->molecules.molecules)
        change += mf_molecule_moves_bead_change(&metropolis->molecules, particles, k, trial->moved);
    return change;
}

/// Try to move a particle once. One that would leave the list has it built again where all are now.
static enum status try_move(struct metropolis *metropolis, uint32_t id) {
    struct particles *particles = &metropolis->particles;
    const struct rng_block random =
        mf_rng_philox(metropolis->seed, RNG_METROPOLIS, metropolis->sweep, id, 0);
    struct trial trial = {0};
    propose(metropolis, &random, places(metropolis)[id], &trial);
    if (!is_listed(metropolis, &trial)) {
        TRY(mf_metropolis_refresh(metropolis));
        list_places(metropolis);
        propose(metropolis, &random, places(metropolis)[id], &trial);
    }
    const double change = find_change(metropolis, &trial);
    metropolis->tried++;
    // Written so that a NaN is refused.
    if (!(mf_rng_uniform(random.word[3], 0) < exp(-change / metropolis->law.temperature)))
        return STATUS_OK;
    metropolis->accepted++;
    for (int d = 0; d < particles->box.dimensions; d++) {
        particles->position[d][trial.k] = trial.moved[d];
        particles->fraction[d][trial.k] = particles->kernel_place[trial.k].fraction[d] =
            trial.to[d];
    }
    return STATUS_OK;
}

/// In an order that stays the same. Each move leaves the canonical distribution as it is, and so do
/// moves in any order that does not follow the places, whenever the list is built. In that of the
/// arrays, which are sorted by place, it would not: which kernel acts depends on the state, and
/// what is sorted so before each sweep (three particles on a ring of six sites, all 216 states) has
/// an energy 0.4 % too high and single states off by 16 % of the largest probability.
enum status mf_metropolis_move_beads(struct metropolis *metropolis) {
    list_places(metropolis);
    for (size_t k = 0; k < metropolis->particles.count; k++)
        TRY(try_move(metropolis, metropolis->order[k]));
    exchange_beads(metropolis, places(metropolis));
    return STATUS_OK;
}

/// The kind of moves of molecules that ends a sweep.
static enum molecule_move next_move(const struct metropolis *metropolis) {
    return (enum molecule_move)(metropolis->sweep % MOLECULE_MOVES);
}

static enum status sweep(struct metropolis *metropolis) {
    if (mf_interrupt_wanted(metropolis->cancel))
        return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
    TRY(mf_metropolis_move_beads(metropolis));
    if (metropolis->molecules.molecules)
        TRY(mf_molecule_moves_pass(metropolis, next_move(metropolis)));
    metropolis->sweep++;
    return STATUS_OK;
}

enum status mf_metropolis_run(struct metropolis *metropolis, uint32_t sweeps) {
    for (uint32_t s = 0; s < sweeps; s++)
        TRY(sweep(metropolis));
    return STATUS_OK;
}

static void reset_counts(struct metropolis *metropolis) {
    metropolis->accepted = metropolis->tried = 0;
    for (int move = 0; move < MOLECULE_MOVES; move++)
        metropolis->molecules.tally[move].accepted = metropolis->molecules.tally[move].tried = 0;
}

enum status mf_metropolis_tune(struct metropolis *metropolis) {
    const enum molecule_move move = next_move(metropolis);
    reset_counts(metropolis);
    TRY(sweep(metropolis));
    const double accepted = (double)metropolis->accepted / (double)metropolis->tried;
    metropolis->step =
        fmin(metropolis->step * metropolis_tuning(accepted), metropolis_longest_step(metropolis));
    if (metropolis->molecules.molecules)
        mf_molecule_moves_tune(metropolis, move);
    reset_counts(metropolis);
    return STATUS_OK;
}

enum status mf_metropolis_equilibrate(struct metropolis *metropolis, uint32_t sweeps) {
    keep_order(metropolis);
    reset_counts(metropolis);
    if (metropolis->exchanges > 0)
        mf_metropolis_exchange(metropolis);
    for (uint32_t s = 0; s < sweeps; s++)
        TRY(mf_metropolis_tune(metropolis));
    if (metropolis->exchanges_tried > 0)
        tune_exchanges(metropolis);
    return STATUS_OK;
}

enum status mf_metropolis_count(struct metropolis *metropolis,
                                const struct pair_histogram *histogram, struct pair_sums *sums) {
    struct pair_law law = metropolis->law;
    law.histogram = histogram;
    *sums = (struct pair_sums){0};
    if (law.potential)
        mf_move_count_pairs(&law, &metropolis->particles, &metropolis->neighbours, sums);
    return metropolis->molecules.molecules ? mf_molecule_moves_add_sums(metropolis, sums)
                                           : STATUS_OK;
}

void mf_metropolis_tally(const struct metropolis *metropolis, uint64_t *accepted, uint64_t *tried) {
    *accepted = metropolis->accepted;
    *tried = metropolis->tried;
    for (int move = 0; move < MOLECULE_MOVES; move++) {
        *accepted += metropolis->molecules.tally[move].accepted;
        *tried += metropolis->molecules.tally[move].tried;
    }
}
