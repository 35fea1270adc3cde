// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/molecule_moves.h"

#include "base/memory.h"
#include "dynamics/metropolis.h"
#include "forces/bonded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What moves need to know of a kind of molecules: found once --------------------------------------

static bool are_bonded(const struct topology_bonds *bonds, int a, int b) {
    for (int n = bonds->start[a]; n < bonds->start[a + 1]; n++)
        if (bonds->to[n] == b)
            return true;
    return false;
}

/// Whether all beads that are next to each other in a term are bonded.
static bool terms_follow_bonds(const struct topology_kind *kind,
                               const struct topology_bonds *bonds) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++)
            for (int k = 0; k + 1 < mf_bonded_kinds[order]->beads; k++)
                if (!are_bonded(bonds, kind->term[order][n].bead[k],
                                kind->term[order][n].bead[k + 1]))
                    return false;
    return true;
}

// Arms --------------------------------------------------------------------------------------------

/// On the way through the beads; all of shape [beads].
struct path {
    int *place; ///< in `walk`, −1 before it is reached
    int *next;  ///< its next bond
    int *low;   ///< the first place that a bond leads to from it or from what follows it
};

static void enter(struct molecule_plan *plan, const struct topology_bonds *bonds, struct path *path,
                  int bead, int parent, int *reached) {
    path->next[bead] = bonds->start[bead];
    path->place[bead] = path->low[bead] = *reached;
    plan->parent[bead] = parent;
    plan->walk[(*reached)++] = bead;
}

/// A bond from a bead's parent that no way goes around is in no ring (R. E. Tarjan, Inf. Process.
/// Lett. 2, 160 (1974)): what follows the bead and what does not are two arms.
static void leave(struct molecule_plan *plan, struct path *path, int bead, int reached) {
    const int parent = plan->parent[bead], begin = path->place[bead];
    if (parent < 0)
        return;
    if (path->low[bead] < path->low[parent])
        path->low[parent] = path->low[bead];
    if (path->low[bead] < begin)
        return;
    const bool outside = 2 * (reached - begin) > plan->beads;
    plan->arm[plan->arms++] = (struct molecule_arm){.pivot = outside ? bead : parent,
                                                    .first = outside ? parent : bead,
                                                    .begin = begin,
                                                    .end = reached,
                                                    .outside = outside};
}

/// Depth first from one bead to all that bonds lead to.
static void walk_from(struct molecule_plan *plan, const struct topology_bonds *bonds,
                      struct path *path, int root, int *reached) {
    int bead = root;
    enter(plan, bonds, path, root, -1, reached);
    while (bead >= 0) {
        if (path->next[bead] == bonds->start[bead + 1]) {
            leave(plan, path, bead, *reached);
            bead = plan->parent[bead];
            continue;
        }
        const int to = bonds->to[path->next[bead]++];
        if (path->place[to] < 0) {
            enter(plan, bonds, path, to, bead, reached);
            bead = to;
        } else if (to != plan->parent[bead] && path->place[to] < path->low[bead]) {
            path->low[bead] = path->place[to];
        }
    }
}

static enum status find_arms(struct molecule_plan *plan, const struct topology_kind *kind) {
    enum status status = STATUS_OK;
    struct topology_bonds bonds = {0};
    struct path path = {0};
    int reached = 0;
    NEW_ARRAY(plan->walk, kind->beads);
    NEW_ARRAY(plan->parent, kind->beads);
    NEW_ARRAY(plan->arm, kind->beads);
    NEW_ARRAY(path.place, kind->beads);
    NEW_ARRAY(path.next, kind->beads);
    NEW_ARRAY(path.low, kind->beads);
    CHECK(mf_topology_bonds(kind, &bonds));
    memset(path.place, 0xff, (size_t)kind->beads * sizeof *path.place);
    walk_from(plan, &bonds, &path, 0, &reached);
    plan->joined = reached == kind->beads;
    for (int bead = 0; bead < kind->beads; bead++)
        if (path.place[bead] < 0)
            walk_from(plan, &bonds, &path, bead, &reached);
    if (!plan->joined || !terms_follow_bonds(kind, &bonds))
        plan->arms = 0;
done:
    mf_memory_free(bonds.start);
    mf_memory_free(bonds.to);
    mf_memory_free(path.place);
    mf_memory_free(path.next);
    mf_memory_free(path.low);
    return status;
}

// Terms -------------------------------------------------------------------------------------------

/// A term of a bead, to be sorted by bead and law.
struct entry {
    int bead, order, group, term;
};

static int compare_entries(const void *a, const void *b) {
    const int *x = a, *y = b; // four numbers each, in the order in which they count
    for (size_t k = 0; k < sizeof(struct entry) / sizeof(int); k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static size_t list_entries(const struct topology_kind *kind, struct entry *entry) {
    size_t count = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++)
            for (int k = 0; k < mf_bonded_kinds[order]->beads; k++, count++)
                if (entry)
                    entry[count] = (struct entry){kind->term[order][n].bead[k], order,
                                                  kind->term[order][n].group, n};
    return count;
}

static enum status find_runs(struct molecule_plan *plan, const struct topology_kind *kind) {
    OWNED struct entry *entry = NULL;
    const size_t entries = list_entries(kind, NULL);
    size_t used = 0;
    int runs = 0;
    TRY_ARRAY(entry, entries);
    TRY_ARRAY(plan->run_start, kind->beads + 1);
    TRY_ARRAY(plan->run, entries);
    TRY_ARRAY(plan->term_bead, BONDED_MAX_TERM_BEADS * entries);
    list_entries(kind, entry);
    qsort(entry, entries, sizeof *entry, compare_entries);
    for (size_t e = 0; e < entries; e++) {
        const struct entry *here = &entry[e], *last = e > 0 ? here - 1 : NULL;
        if (last == NULL || last->bead != here->bead || last->order != here->order ||
            last->group != here->group)
            plan->run[runs++] = (struct molecule_run){here->order, here->group, 0, used};
        plan->run[runs - 1].count++;
        plan->run_start[here->bead + 1] = runs;
        for (int k = 0; k < mf_bonded_kinds[here->order]->beads; k++)
            plan->term_bead[used++] = kind->term[here->order][here->term].bead[k];
    }
    for (int bead = 0; bead < kind->beads; bead++)
        if (plan->run_start[bead + 1] < plan->run_start[bead])
            plan->run_start[bead + 1] = plan->run_start[bead]; // without terms
    return STATUS_OK;
}

enum status mf_molecule_plan_init(struct molecule_plan *plan, const struct topology_kind *kind) {
    *plan = (struct molecule_plan){.beads = kind->beads};
    const int64_t others = (int64_t)kind->beads * (kind->beads - 1);
    plan->excluded = kind->near_start[kind->beads] == others;
    TRY(find_arms(plan, kind));
    return find_runs(plan, kind);
}

void mf_molecule_plan_clear(struct molecule_plan *plan) {
    mf_memory_free(plan->walk);
    mf_memory_free(plan->parent);
    mf_memory_free(plan->arm);
    mf_memory_free(plan->run_start);
    mf_memory_free(plan->run);
    mf_memory_free(plan->term_bead);
    *plan = (struct molecule_plan){0};
}

// Moves -------------------------------------------------------------------------------------------

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
