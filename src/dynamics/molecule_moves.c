// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/molecule_moves.h"

#include "base/memory.h"
#include "dynamics/metropolis.h"
#include "forces/bonded.h"

#include <math.h>
#include <string.h>

const char *const mf_molecule_move_names[MOLECULE_MOVES] = {"translate", "rotate", "pivot"};

/// Before they are tuned: in λ, and in rad.
static const double first_step[MOLECULE_MOVES] = {0.05, 0.2, 0.2};

enum status mf_molecule_moves_init(struct molecule_moves *moves, const struct molecules *molecules,
                                   const struct particles *particles) {
    enum status status = STATUS_OK;
    const struct topology *topology = &molecules->topology;
    int max = 1;
    *moves = (struct molecule_moves){.molecules = molecules};
    for (int move = 0; move < MOLECULE_MOVES; move++)
        moves->tally[move].step = first_step[move];
    NEW_ARRAY(moves->bead_of, topology->particles);
    memset(moves->bead_of, 0xff, topology->particles * sizeof *moves->bead_of);
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        CHECK(mf_molecule_plan_init(&moves->plan[k], kind));
        max = kind->beads > max ? kind->beads : max;
        for (int64_t m = 0; m < kind->count; m++)
            for (int bead = 0; bead < kind->beads; bead++)
                moves->bead_of[topology_id(kind, m, bead)] = bead;
    }
    NEW_ARRAY(moves->place, max);
    NEW_ARRAY(moves->position, max);
    NEW_ARRAY(moves->moved, max);
    NEW_ARRAY(moves->from, max);
    NEW_ARRAY(moves->to, max);
    NEW_ARRAY(moves->together, topology->particles);
    CHECK((moves->forces = mf_memory_zeroed(1, mf_molecules.state_size)) ? STATUS_OK
                                                                         : STATUS_NO_MEMORY);
    CHECK(mf_molecules.begin(molecules, moves->forces, particles));
done:
    if (status != STATUS_OK)
        mf_molecule_moves_clear(moves);
    return status;
}

void mf_molecule_moves_clear(struct molecule_moves *moves) {
    if (moves->forces)
        mf_molecules.clear(moves->forces);
    for (int k = 0; k < TOPOLOGY_MAX_KINDS; k++)
        mf_molecule_plan_clear(&moves->plan[k]);
    mf_memory_free(moves->forces);
    mf_memory_free(moves->bead_of);
    mf_memory_free(moves->place);
    mf_memory_free(moves->position);
    mf_memory_free(moves->moved);
    mf_memory_free(moves->from);
    mf_memory_free(moves->to);
    mf_memory_free(moves->together);
    mf_memory_free(moves->list);
    *moves = (struct molecule_moves){0};
}

// Terms -------------------------------------------------------------------------------------------

int mf_molecule_moves_kind(const struct topology *topology, uint32_t molecule) {
    int k = 0;
    while (k + 1 < topology->kinds && molecule >= topology->kind[k + 1].first)
        k++;
    return k;
}

/// U of some terms of one law at the present positions.
static double run_energy(const struct molecule_moves *moves, int k, uint32_t m,
                         const struct molecule_run *run, const struct particles *particles) {
    enum { SOME = 16 };
    const struct topology_kind *kind = &moves->molecules->topology.kind[k];
    const struct bonded_curve *curve = &moves->molecules->group[run->order][run->group].curve;
    const double longest = mf_bonded_longest(curve);
    const int beads = mf_bonded_kinds[run->order]->beads;
    const int *bead = moves->plan[k].term_bead + run->first;
    double sum = 0;
    for (int done = 0; done < run->count; done += SOME) {
        const int some = run->count - done < SOME ? run->count - done : SOME;
        int32_t place[SOME * BONDED_MAX_TERM_BEADS];
        double q[SOME], energy[SOME], slope[SOME];
        for (int n = 0; n < some * beads; n++)
            place[n] = (int32_t)particles->place[topology_id(kind, m, *bead++)];
        mf_bonded_measure(run->order, (size_t)some, place, particles, q);
        curve->law->evaluate(curve->parameters, (size_t)some, q, energy, slope);
        for (int n = 0; n < some; n++)
            sum += q[n] >= longest ? INFINITY : energy[n];
    }
    return sum;
}

double mf_molecule_moves_bead_energy(const struct molecule_moves *moves, int k, uint32_t m,
                                     int bead, const struct particles *particles) {
    const struct molecule_plan *plan = &moves->plan[k];
    double sum = 0;
    for (int run = plan->run_start[bead]; run < plan->run_start[bead + 1]; run++)
        sum += run_energy(moves, k, m, &plan->run[run], particles);
    return sum;
}

double mf_molecule_moves_bead_change(const struct molecule_moves *moves,
                                     struct particles *particles, size_t k, const double to[3]) {
    const struct topology *topology = &moves->molecules->topology;
    const uint32_t id = particles->id[k], molecule = topology->molecule[id];
    const int bead = moves->bead_of[id], dimensions = particles->box.dimensions;
    double from[3];
    if (bead < 0)
        return 0;
    const int kind = mf_molecule_moves_kind(topology, molecule);
    const uint32_t m = molecule - (uint32_t)topology->kind[kind].first;
    const double before = mf_molecule_moves_bead_energy(moves, kind, m, bead, particles);
    for (int d = 0; d < dimensions; d++) {
        from[d] = particles->position[d][k];
        particles->position[d][k] = to[d];
    }
    const double after = mf_molecule_moves_bead_energy(moves, kind, m, bead, particles);
    for (int d = 0; d < dimensions; d++)
        particles->position[d][k] = from[d];
    return after - before;
}

// Sums and steps --------------------------------------------------------------------------------

void mf_molecule_moves_tune(struct metropolis *metropolis, enum molecule_move move) {
    struct molecule_tally *tally = &metropolis->molecules.tally[move];
    const double longest = move == MOLECULE_TRANSLATE ? metropolis_longest_step(metropolis) : M_PI;
    if (tally->tried > 0)
        tally->step = fmin(longest, tally->step * metropolis_tuning((double)tally->accepted /
                                                                    (double)tally->tried));
}

enum status mf_molecule_moves_add_sums(struct metropolis *metropolis, struct pair_sums *sums) {
    struct particles *particles = &metropolis->particles;
    for (int d = 0; d < particles->box.dimensions; d++)
        memset(particles->force[d], 0, particles->count * sizeof *particles->force[d]);
    return mf_molecules.add(metropolis->molecules.molecules, metropolis->molecules.forces,
                            &(struct interaction_pass){.law = &metropolis->law,
                                                       .particles = particles,
                                                       .neighbours = &metropolis->neighbours,
                                                       .conservative = true,
                                                       .wants = PAIR_FORCES_AND_SUMS,
                                                       .sums = sums});
}
