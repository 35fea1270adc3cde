// SPDX-License-Identifier: GPL-3.0-or-later
//
// Terms of different molecules share no bead. So molecules are shared out among blocks, as many for
// any number of threads, and each block adds its terms to the forces in an order that is the same
// for each bead. After every sort the molecules are put into the order of their first beads, and
// terms name places instead of ids: what is near in space is near in memory.
// Tested: test_molecules, physics/test_molecules.
#include "forces/molecules.h"

#include "base/parallel.h"
#include "forces/bonded.h"

#include <math.h>

enum { MOST_BLOCKS = 64, FEWEST_IN_BLOCK = 8 };
static const uint32_t not_first = UINT32_MAX;

struct state {
    const struct molecules *molecules;
    uint64_t orders;    ///< of the particles, to which the places belong
    uint32_t *first_of; ///< shape [particles], by id: the molecule whose first bead that is
    uint32_t *sequence; ///< shape [molecules]: in the order of the places of their first beads
    int blocks;
    size_t most_beads; ///< of a molecule
    uint32_t *whole;   ///< shape [blocks, most_beads]: places of the beads of one molecule
    /// Terms of each group in a molecule of each kind.
    size_t terms[TOPOLOGY_MOST_KINDS][TOPOLOGY_ORDERS][MOLECULES_MOST_GROUPS];
    int32_t *place[TOPOLOGY_ORDERS]; ///< shape [terms, beads], of one group after the other
    /// Where terms of a group and block begin; they end where the next block's begin.
    size_t start[TOPOLOGY_ORDERS][MOLECULES_MOST_GROUPS][MOST_BLOCKS + 1];
};

// Laws --------------------------------------------------------------------------------------------

void mf_molecules_clear(struct molecules *molecules) {
    mf_topology_clear(&molecules->topology);
    for (int order = 0; order < TOPOLOGY_ORDERS; order++)
        for (int g = 0; g < molecules->groups[order]; g++)
            mf_bonded_clear(&molecules->group[order][g].curve);
    *molecules = (struct molecules){0};
}

const struct molecules *mf_molecules_find(const struct interaction_choice *interactions,
                                          int count) {
    for (int k = 0; k < count; k++)
        if (interactions[k].kind == &mf_molecules)
            return interactions[k].parameters;
    return NULL;
}

// Begin -------------------------------------------------------------------------------------------

enum status mf_molecules_check(const struct molecules *molecules, const struct box *box) {
    for (int g = 0; g < molecules->groups[TOPOLOGY_BOND]; g++) {
        const struct molecules_group *group = &molecules->group[TOPOLOGY_BOND][g];
        const double longest = mf_bonded_longest(&group->curve);
        const double length = isfinite(longest) ? longest : mf_bonded_rest(&group->curve);
        if (!(length < 0.5 * mf_box_shortest(box)))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "bonds.%s: a bond of %g is not shorter than half of the box, "
                                  "whose shortest edge is %g",
                                  group->name, length, mf_box_shortest(box));
    }
    if (box->dimensions == 2 && molecules->groups[TOPOLOGY_DIHEDRAL] > 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dihedrals: in two dimensions there are none, as nothing leaves the "
                              "plane");
    return STATUS_OK;
}

static int kind_of(const struct topology *topology, uint32_t molecule) {
    int k = 0;
    while (k + 1 < topology->kinds && molecule >= topology->kind[k + 1].first)
        k++;
    return k;
}

static size_t all_terms(const struct topology *topology, int order) {
    size_t terms = 0;
    for (int k = 0; k < topology->kinds; k++)
        terms += (size_t)topology->kind[k].terms[order] * (size_t)topology->kind[k].count;
    return terms;
}

static void count_terms(struct state *state, const struct topology *topology) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        if ((size_t)kind->beads > state->most_beads)
            state->most_beads = (size_t)kind->beads;
        for (int order = 0; order < TOPOLOGY_ORDERS; order++)
            for (int t = 0; t < kind->terms[order]; t++)
                state->terms[k][order][kind->term[order][t].group]++;
    }
}

static enum status begin(const void *parameters, void *own, const struct particles *particles) {
    enum status status = STATUS_OK;
    struct state *state = own;
    const struct molecules *molecules = parameters;
    const struct topology *topology = &molecules->topology;
    TRY(mf_molecules_check(molecules, &particles->box));
    state->molecules = molecules;
    state->orders = particles->orders - 1; // not this one: places are not known
    const int64_t blocks = topology->molecules / FEWEST_IN_BLOCK;
    state->blocks = blocks < 1 ? 1 : blocks < MOST_BLOCKS ? (int)blocks : MOST_BLOCKS;
    count_terms(state, topology);
    NEW_ARRAY(state->whole, (size_t)state->blocks * state->most_beads);
    NEW_ARRAY(state->first_of, topology->particles);
    NEW_ARRAY(state->sequence, topology->molecules);
    for (int order = 0; order < TOPOLOGY_ORDERS; order++)
        NEW_ARRAY(state->place[order], all_terms(topology, order) * (size_t)topology_beads(order));
    for (size_t id = 0; id < topology->particles; id++)
        state->first_of[id] = not_first;
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            state->first_of[topology_id(&topology->kind[k], m, 0)] =
                (uint32_t)(topology->kind[k].first + m);
done:
    return status;
}

static void clear(void *own) {
    struct state *state = own;
    mf_memory_free(state->first_of);
    mf_memory_free(state->sequence);
    mf_memory_free(state->whole);
    for (int order = 0; order < TOPOLOGY_ORDERS; order++)
        mf_memory_free(state->place[order]);
}

// Places ------------------------------------------------------------------------------------------

static size_t first_in_block(const struct state *state, int block) {
    return (size_t)state->molecules->topology.molecules * (size_t)block / (size_t)state->blocks;
}

/// How many terms of each group a block has, at the place behind its own.
static void count_block(struct state *state, int block) {
    const struct molecules *molecules = state->molecules;
    for (size_t n = first_in_block(state, block); n < first_in_block(state, block + 1); n++) {
        const int k = kind_of(&molecules->topology, state->sequence[n]);
        for (int order = 0; order < TOPOLOGY_ORDERS; order++)
            for (int g = 0; g < molecules->groups[order]; g++)
                state->start[order][g][block + 1] += state->terms[k][order][g];
    }
}

/// From counts to where terms begin: groups stand one after the other, in each of them blocks.
static void add_counts(struct state *state) {
    for (int order = 0; order < TOPOLOGY_ORDERS; order++) {
        size_t next = 0;
        for (int g = 0; g < state->molecules->groups[order]; g++) {
            size_t *start = state->start[order][g];
            start[0] = next;
            for (int block = 0; block < state->blocks; block++)
                start[block + 1] += start[block];
            next = start[state->blocks];
        }
    }
}

static void find_sequence(struct state *state, const struct particles *particles) {
    uint32_t *next = state->sequence;
    for (size_t k = 0; k < particles->count; k++) {
        const uint32_t molecule = state->first_of[particles->id[k]];
        if (molecule != not_first)
            *next++ = molecule;
    }
}

struct sweep {
    struct state *state;
    const struct interaction_pass *pass;
    struct bonded_sums sums[MOST_BLOCKS];
};

/// Write down the places of a molecule's terms, each group's from `next` on.
static void place_molecule(const struct state *state, const struct topology_kind *kind,
                           const uint32_t *whole,
                           size_t next[TOPOLOGY_ORDERS][MOLECULES_MOST_GROUPS]) {
    for (int order = 0; order < TOPOLOGY_ORDERS; order++) {
        const int beads = topology_beads(order);
        for (int t = 0; t < kind->terms[order]; t++) {
            const struct topology_term *term = &kind->term[order][t];
            int32_t *to = state->place[order] + next[order][term->group]++ * (size_t)beads;
            for (int k = 0; k < beads; k++)
                to[k] = (int32_t)whole[term->bead[k]];
        }
    }
}

static void place_blocks(void *context, size_t begin_block, size_t end_block) {
    const struct sweep *sweep = context;
    const struct state *state = sweep->state;
    const struct topology *topology = &state->molecules->topology;
    const uint32_t *place = sweep->pass->particles->place;
    for (int block = (int)begin_block; block < (int)end_block; block++) {
        uint32_t *whole = state->whole + (size_t)block * state->most_beads;
        size_t next[TOPOLOGY_ORDERS][MOLECULES_MOST_GROUPS];
        for (int order = 0; order < TOPOLOGY_ORDERS; order++)
            for (int g = 0; g < state->molecules->groups[order]; g++)
                next[order][g] = state->start[order][g][block];
        for (size_t n = first_in_block(state, block); n < first_in_block(state, block + 1); n++) {
            const struct topology_kind *kind =
                &topology->kind[kind_of(topology, state->sequence[n])];
            for (int bead = 0; bead < kind->beads; bead++)
                whole[bead] = place[topology_id(kind, state->sequence[n] - kind->first, bead)];
            place_molecule(state, kind, whole, next);
        }
    }
}

/// Follow the particles into a new order.
static void follow(struct sweep *sweep) {
    struct state *state = sweep->state;
    const struct particles *particles = sweep->pass->particles;
    if (state->orders == particles->orders)
        return;
    find_sequence(state, particles);
    memset(state->start, 0, sizeof state->start);
    for (int block = 0; block < state->blocks; block++)
        count_block(state, block);
    add_counts(state);
    mf_parallel_for((size_t)state->blocks, particles->threads, place_blocks, sweep);
    state->orders = particles->orders;
}

// Forces ------------------------------------------------------------------------------------------

static void add_terms(const struct bonded_terms *terms, int order, struct particles *particles,
                      struct bonded_sums *sums) {
    switch (order) {
    case TOPOLOGY_BOND:
        mf_bonded_add_bonds(terms, particles, sums);
        break;
    case TOPOLOGY_ANGLE:
        mf_bonded_add_angles(terms, particles, sums);
        break;
    default:
        mf_bonded_add_dihedrals(terms, particles, sums);
    }
}

static void add_group(struct sweep *sweep, int order, int g, int block) {
    const struct state *state = sweep->state;
    const size_t end = state->start[order][g][block + 1];
    for (size_t at = state->start[order][g][block]; at < end; at += BONDED_BATCH) {
        const struct bonded_terms terms = {
            .curve = &state->molecules->group[order][g].curve,
            .group = g,
            .count = end - at < BONDED_BATCH ? end - at : BONDED_BATCH,
            .place = state->place[order] + at * (size_t)topology_beads(order),
            .transfer = sweep->pass->law->transfer != NULL,
        };
        add_terms(&terms, order, sweep->pass->particles, &sweep->sums[block]);
    }
}

static void add_blocks(void *context, size_t begin_block, size_t end_block) {
    struct sweep *sweep = context;
    for (size_t block = begin_block; block < end_block; block++)
        for (int order = 0; order < TOPOLOGY_ORDERS; order++)
            for (int g = 0; g < sweep->state->molecules->groups[order]; g++)
                add_group(sweep, order, g, (int)block);
}

/// Add the sums of all blocks, in their order.
static void collect(const struct sweep *sweep) {
    const struct interaction_pass *pass = sweep->pass;
    for (int block = 0; block < sweep->state->blocks; block++) {
        const struct bonded_sums *sums = &sweep->sums[block];
        if (pass->wants == PAIR_FORCES_AND_SUMS) {
            pass->sums->energy += sums->energy;
            pass->sums->virial += sums->virial;
        }
        for (int a = 0; a < 3 && pass->law->transfer; a++)
            for (int b = 0; b < 3; b++)
                pass->law->transfer->part[0][a][b] += sums->transfer[a][b];
    }
}

/// Before the first step molecules are parted, and bonds may be too long for a while.
static enum status check_torn(const struct sweep *sweep) {
    const struct state *state = sweep->state;
    for (int block = 0; block < state->blocks && sweep->pass->step > 0; block++) {
        const struct bonded_sums *sums = &sweep->sums[block];
        const struct molecules_group *group = &state->molecules->group[TOPOLOGY_BOND][sums->torn];
        if (sums->longest > 0)
            return mf_status_fail(STATUS_UNSTABLE,
                                  "unstable at step %llu: a bond \"%s\" is %.4g long, and tears at "
                                  "%.4g; lower \"time_step\", or begin with shorter bonds",
                                  (unsigned long long)sweep->pass->step, group->name, sums->longest,
                                  mf_bonded_longest(&group->curve));
    }
    return STATUS_OK;
}

static enum status add(const void *parameters, void *own, const struct interaction_pass *pass) {
    struct sweep sweep = {.state = own, .pass = pass};
    (void)parameters;
    follow(&sweep);
    mf_parallel_for((size_t)sweep.state->blocks, pass->particles->threads, add_blocks, &sweep);
    collect(&sweep);
    return check_torn(&sweep);
}

const struct interaction mf_molecules = {
    .name = "molecules",
    .summary = "bonds, angles and dihedrals",
    .state_size = sizeof(struct state),
    .cost = 6,
    .begin = begin,
    .clear = clear,
    .add = add,
};
