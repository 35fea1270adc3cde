// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/molecule_moves.h"

#include "base/memory.h"
#include "base/rng.h"
#include "dynamics/metropolis.h"
#include "dynamics/move.h"

#include <math.h>

// Proposals ---------------------------------------------------------------------------------------

/// One molecule, and how it is to move.
struct trial {
    struct metropolis *metropolis;
    struct molecule_moves *moves;
    const struct molecule_plan *plan;
    enum molecule_move move;
    int kind;
    uint32_t m;                     ///< of its kind
    const struct molecule_arm *arm; ///< that turns, or NULL: all of it moves
    int beads;                      ///< that move: moves->moved
    double limit;                   ///< how far a bead may go [λ]
    struct rng_block random;
};

/// Where the beads are, from one to the next.
static void gather(const struct trial *trial) {
    const struct molecule_moves *moves = trial->moves;
    const struct particles *particles = &trial->metropolis->particles;
    const struct topology_kind *kind = &moves->molecules->topology.kind[trial->kind];
    for (int n = 0; n < trial->plan->beads; n++) {
        const int bead = trial->plan->walk[n], parent = trial->plan->parent[bead];
        const size_t k = particles->place[topology_id(kind, trial->m, bead)];
        moves->place[bead] = (int32_t)k;
        for (int d = 0; d < 3; d++) {
            const double x = particles->position[d][k];
            const double last = parent >= 0 ? moves->position[parent][d] : x;
            moves->position[bead][d] = last + box_nearest(x - last, particles->box.length[d]);
        }
    }
}

static void choose_beads(struct trial *trial) {
    const struct molecule_plan *plan = trial->plan;
    const struct molecule_moves *moves = trial->moves;
    const struct particles *particles = &trial->metropolis->particles;
    trial->beads = trial->arm ? molecule_arm_beads(plan, trial->arm) : plan->beads;
    for (int n = 0; n < trial->beads; n++) {
        const int bead = trial->arm ? molecule_arm_bead(plan, trial->arm, n) : plan->walk[n];
        moves->moved[n] = moves->place[bead];
        for (int d = 0; d < 3; d++) {
            moves->from[n][d] = particles->position[d][moves->place[bead]];
            moves->to[n][d] = moves->from[n][d];
        }
    }
}

static void propose_translation(const struct trial *trial) {
    const double step = trial->moves->tally[trial->move].step;
    for (int d = 0; d < trial->metropolis->particles.box.dimensions; d++)
        for (int n = 0; n < trial->beads; n++)
            trial->moves->to[n][d] += step * (2 * mf_rng_uniform(trial->random.word[d], 0) - 1);
}

/// Where it turns about: the bead before the arm, or the mean of all.
static void find_centre(const struct trial *trial, double centre[3]) {
    const struct molecule_moves *moves = trial->moves;
    const int beads = trial->plan->beads;
    for (int d = 0; d < 3; d++) {
        centre[d] = trial->arm ? moves->position[trial->arm->pivot][d] : 0;
        for (int bead = 0; bead < beads && !trial->arm; bead++)
            centre[d] += moves->position[bead][d] / beads;
    }
}

/// An axis that is uniform on the sphere; in two dimensions it leaves the plane.
static void find_axis(const struct trial *trial, double axis[3]) {
    const bool flat = trial->metropolis->particles.box.dimensions == 2;
    const double z = flat ? 1 : 2 * mf_rng_uniform(trial->random.word[0], 0) - 1;
    const double phi = 2 * M_PI * mf_rng_uniform(trial->random.word[1], 0);
    axis[0] = sqrt(1 - z * z) * cos(phi);
    axis[1] = sqrt(1 - z * z) * sin(phi);
    axis[2] = z;
}

/// False if a bead is too far from the centre (file comment of molecule_moves.h).
static bool propose_turn(const struct trial *trial) {
    const struct molecule_moves *moves = trial->moves;
    const double farthest = 0.25 * mf_box_shortest(&trial->metropolis->particles.box);
    const double angle =
        moves->tally[trial->move].step * (2 * mf_rng_uniform(trial->random.word[2], 0) - 1);
    const double sine = sin(angle), versine = 1 - cos(angle);
    double centre[3], axis[3];
    find_centre(trial, centre);
    find_axis(trial, axis);
    for (int n = 0; n < trial->beads; n++) {
        const int bead =
            trial->arm ? molecule_arm_bead(trial->plan, trial->arm, n) : trial->plan->walk[n];
        double r[3], along = 0, square = 0;
        for (int d = 0; d < 3; d++) {
            r[d] = moves->position[bead][d] - centre[d];
            along += r[d] * axis[d];
            square += r[d] * r[d];
        }
        if (!(square < farthest * farthest))
            return false;
        for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            moves->to[n][d] +=
                sine * (axis[e] * r[f] - axis[f] * r[e]) + versine * (along * axis[d] - r[d]);
        }
    }
    return true;
}

/// Whether no bead goes farther than the limit.
static bool is_short(const struct trial *trial) {
    const struct molecule_moves *moves = trial->moves;
    for (int n = 0; n < trial->beads; n++) {
        double square = 0;
        for (int d = 0; d < 3; d++)
            square += pow(moves->to[n][d] - moves->from[n][d], 2);
        if (!(square <= trial->limit * trial->limit))
            return false;
    }
    return true;
}

/// Whether the list knows the neighbours where the beads are to go.
static bool is_listed(const struct trial *trial) {
    const struct molecule_moves *moves = trial->moves;
    const struct neighbours *neighbours = &trial->metropolis->neighbours;
    for (int n = 0; n < trial->beads; n++) {
        double square = 0;
        for (int d = 0; d < trial->metropolis->particles.box.dimensions; d++)
            square += pow(moves->to[n][d] - neighbours->built[d][moves->moved[n]], 2);
        if (!(square < 0.25 * neighbours->skin * neighbours->skin))
            return false;
    }
    return true;
}

// Energies ----------------------------------------------------------------------------------------

/// The neighbours of particle k that do not move with it.
static enum status find_others(struct trial *trial, size_t k, const int32_t **list, size_t *count) {
    struct molecule_moves *moves = trial->moves;
    const struct neighbours *neighbours = &trial->metropolis->neighbours;
    *count = neighbours->stop[k] - neighbours->start[k];
    *list = neighbours->list + neighbours->start[k];
    if (trial->plan->excluded)
        return STATUS_OK;
    if (*count > moves->list_capacity) {
        mf_memory_free(moves->list);
        moves->list_capacity = 0;
        TRY_ARRAY(moves->list, 2 * *count);
        moves->list_capacity = 2 * *count;
    }
    size_t others = 0;
    for (size_t n = 0; n < *count; n++) {
        moves->list[others] = (*list)[n];
        others += !moves->together[(*list)[n]];
    }
    *list = moves->list;
    *count = others;
    return STATUS_OK;
}

/// Of the pairs with what does not move.
static enum status find_pair_change(struct trial *trial, double *change) {
    const struct molecule_moves *moves = trial->moves;
    const struct metropolis *metropolis = trial->metropolis;
    const struct particles *particles = &metropolis->particles;
    enum status status = STATUS_OK;
    for (int n = 0; n < trial->beads; n++)
        moves->together[moves->moved[n]] = true;
    for (int n = 0; n < trial->beads && status == STATUS_OK; n++) {
        const size_t k = (size_t)moves->moved[n];
        const int32_t *list;
        size_t count;
        int32_t to[3] = {0};
        for (int d = 0; d < particles->box.dimensions; d++)
            to[d] = box_fraction(moves->to[n][d], 1 / particles->box.length[d]);
        status = find_others(trial, k, &list, &count);
        if (status == STATUS_OK)
            *change += mf_move_energy_change(&metropolis->law, particles, k, list, count, to);
    }
    for (int n = 0; n < trial->beads; n++)
        moves->together[moves->moved[n]] = false;
    return status;
}

static void write_beads(const struct trial *trial, double (*where)[3]) {
    const struct particles *particles = &trial->metropolis->particles;
    for (int n = 0; n < trial->beads; n++)
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->position[d][trial->moves->moved[n]] = where[n][d];
}

/// Of the terms across the bond that an arm turns about: all of them have its first bead, whose
/// other terms stay what they are.
static double find_term_change(const struct trial *trial) {
    const struct particles *particles = &trial->metropolis->particles;
    if (!trial->arm)
        return 0;
    const double before = mf_molecule_moves_bead_energy(trial->moves, trial->kind, trial->m,
                                                        trial->arm->first, particles);
    write_beads(trial, trial->moves->to);
    const double after = mf_molecule_moves_bead_energy(trial->moves, trial->kind, trial->m,
                                                       trial->arm->first, particles);
    write_beads(trial, trial->moves->from);
    return after - before;
}

static void accept(const struct trial *trial) {
    const struct molecule_moves *moves = trial->moves;
    const struct particles *particles = &trial->metropolis->particles;
    write_beads(trial, trial->moves->to);
    for (int n = 0; n < trial->beads; n++) {
        const size_t k = (size_t)moves->moved[n];
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->fraction[d][k] = particles->kernel_place[k].fraction[d] =
                box_fraction(particles->position[d][k], 1 / particles->box.length[d]);
    }
}

// Moves -------------------------------------------------------------------------------------------

/// Whether there is such a move of a kind of molecules.
static bool can_move(const struct molecule_plan *plan, enum molecule_move move) {
    if (plan->beads < 2)
        return false;
    return move == MOLECULE_TRANSLATE || (move == MOLECULE_ROTATE ? plan->joined : plan->arms > 0);
}

/// False if what turns is too large to do so.
static bool propose(struct trial *trial) {
    gather(trial);
    choose_beads(trial);
    if (trial->move != MOLECULE_TRANSLATE)
        return propose_turn(trial);
    propose_translation(trial);
    return true;
}

static enum status try_molecule(struct trial *trial, uint32_t molecule) {
    struct metropolis *metropolis = trial->metropolis;
    struct molecule_tally *tally = &trial->moves->tally[trial->move];
    enum { CHOICE = 1 + MOLECULE_MOVES }; // counters of random numbers; single beads have 0
    const uint32_t counter = 1 + (uint32_t)trial->move;
    double change = 0;
    trial->random =
        mf_rng_philox(metropolis->seed, RNG_METROPOLIS, metropolis->sweep, molecule, counter);
    if (trial->move == MOLECULE_PIVOT) {
        const struct rng_block choice =
            mf_rng_philox(metropolis->seed, RNG_METROPOLIS, metropolis->sweep, molecule, CHOICE);
        trial->arm =
            &trial->plan->arm[(uint64_t)choice.word[0] * (uint64_t)trial->plan->arms >> 32];
    }
    if (!propose(trial))
        return STATUS_OK;
    tally->tried++;
    if (!is_short(trial))
        return STATUS_OK;
    if (!is_listed(trial)) {
        TRY(mf_metropolis_refresh(metropolis));
        propose(trial); // from other places of the arrays
    }
    change += find_term_change(trial);
    if (metropolis->law.potential)
        TRY(find_pair_change(trial, &change));
    // Written so that a NaN is refused.
    if (!(mf_rng_uniform(trial->random.word[3], 0) < exp(-change / metropolis->law.temperature)))
        return STATUS_OK;
    tally->accepted++;
    accept(trial);
    return STATUS_OK;
}

enum status mf_molecule_moves_pass(struct metropolis *metropolis, enum molecule_move move) {
    struct molecule_moves *moves = &metropolis->molecules;
    const struct topology *topology = &moves->molecules->topology;
    for (size_t n = 0; n < metropolis->particles.count; n++) {
        const uint32_t id = metropolis->order[n], molecule = topology->molecule[id];
        if (moves->bead_of[id] != 0)
            continue;
        const int kind = mf_molecule_moves_kind(topology, molecule);
        struct trial trial = {.metropolis = metropolis,
                              .moves = moves,
                              .plan = &moves->plan[kind],
                              .move = move,
                              .kind = kind,
                              .m = molecule - (uint32_t)topology->kind[kind].first,
                              .limit = metropolis_reach(metropolis)};
        if (can_move(trial.plan, move))
            TRY(try_molecule(&trial, molecule));
    }
    return STATUS_OK;
}
