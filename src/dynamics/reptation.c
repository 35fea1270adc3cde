// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reptation.h"

#include "base/memory.h"
#include "base/rng.h"
#include "dynamics/metropolis.h"
#include "forces/bonded.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Accepted moves for each place drawn, below which a kind does not reptate.
static const double least_accepted = 0.01;

// Which kinds -------------------------------------------------------------------------------------

/// The group of all terms of an order, which are of beads that follow each other from the first to
/// the last; −1: there are none; −2: they are not so.
static int find_group(const struct topology_kind *kind, int order) {
    const struct topology_term *term = kind->term[order];
    if (kind->terms[order] == 0)
        return -1;
    if (kind->terms[order] != kind->beads - 1 - order)
        return -2;
    for (int n = 0; n < kind->terms[order]; n++) {
        const int step = term[n].bead[1] - term[n].bead[0];
        for (int k = 0; k + 1 < topology_beads(order); k++)
            if (abs(step) != 1 || term[n].bead[k + 1] - term[n].bead[k] != step)
                return -2;
        if (term[n].group != term[0].group)
            return -2;
    }
    return term[0].group;
}

static bool can_reptate(const struct topology_kind *kind, int dimensions,
                        int group[TOPOLOGY_ORDERS]) {
    bool can = kind->beads >= REPTATION_LEAST_BEADS && dimensions == 3;
    for (int order = 0; order < TOPOLOGY_ORDERS; order++) {
        group[order] = find_group(kind, order);
        can &= group[order] >= (order == TOPOLOGY_BOND ? 0 : -1);
    }
    for (int bead = 1; bead < kind->beads; bead++)
        can &= kind->type[bead] == kind->type[0];
    return can;
}

bool mf_reptation_is_possible(const struct topology_kind *kind, int dimensions) {
    int group[TOPOLOGY_ORDERS];
    return can_reptate(kind, dimensions, group);
}

enum status mf_reptation_init(struct reptation *reptation, const struct topology *topology,
                              int dimensions) {
    enum status status = STATUS_OK;
    int most = 1;
    *reptation = (struct reptation){0};
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        reptation->kind[k].choice = -1;
        reptation->can[k] = can_reptate(kind, dimensions, reptation->group[k]);
        reptation->chains |= reptation->can[k];
        most = kind->beads > most ? kind->beads : most;
    }
    NEW_ARRAY(reptation->bead, most);
    CHECK(mf_reptation_grid_init(&reptation->grid, topology->particles));
done:
    if (status != STATUS_OK)
        mf_reptation_clear(reptation);
    return status;
}

void mf_reptation_clear(struct reptation *reptation) {
    mf_reptation_grid_clear(&reptation->grid);
    mf_memory_free(reptation->bead);
    *reptation = (struct reptation){0};
}

// What is drawn -----------------------------------------------------------------------------------

/// One chain and what its kind has in common.
struct snake {
    struct metropolis *metropolis;
    struct reptation *reptation;
    const struct bonded_curve *curve[TOPOLOGY_ORDERS]; ///< NULL: without such terms
    struct reptation_draw length, cosine;              ///< of the bond, and of the angle
    int beads, exclude, places;
    int first; ///< bead n is reptation->bead[(first + n) % beads]
    struct rng_sequence random;
};

/// The beads next to where one is put, from the end inwards.
struct snake_end {
    int32_t bead[TOPOLOGY_MOST_BEADS - 1];
};

/// p(r) ~ r² exp(−U/k_B T), where U has the pair of both beads, too, if it is not excluded.
static void prepare_length(struct snake *snake, int type) {
    const struct pair_law *law = &snake->metropolis->law;
    const double half = mf_box_shortest(&snake->metropolis->particles.box) / 2;
    const double longest =
        fmin(half, mf_bonded_reach(snake->curve[TOPOLOGY_BOND], 20 * law->temperature));
    const double least = mf_bonded_rest(snake->curve[TOPOLOGY_BOND]);
    double weight[REPTATION_BINS], at_rest;
    mf_bonded_value(snake->curve[TOPOLOGY_BOND], least, &at_rest, NULL);
    for (int bin = 0; bin < REPTATION_BINS; bin++) {
        const double r = longest * (bin + 0.5) / REPTATION_BINS;
        double energy, pair = 0;
        mf_bonded_value(snake->curve[TOPOLOGY_BOND], r, &energy, NULL);
        if (law->potential && snake->exclude == 0)
            mf_table_evaluate_pair(law->potential,
                                   mf_composition_pair(&law->composition, type, type), r, &pair,
                                   NULL, NULL);
        weight[bin] = r * r * exp(-(energy - at_rest + pair) / law->temperature);
    }
    mf_reptation_draw_init(&snake->length, 0, longest, weight);
}

/// p(cos θ) ~ exp(−U/k_B T).
static void prepare_cosine(struct snake *snake) {
    const struct bonded_curve *curve = snake->curve[TOPOLOGY_ANGLE];
    double weight[REPTATION_BINS], at_rest = 0, energy = 0;
    if (curve)
        mf_bonded_value(curve, mf_bonded_rest(curve), &at_rest, NULL);
    for (int bin = 0; bin < REPTATION_BINS; bin++) {
        if (curve)
            mf_bonded_value(curve, acos(2 * (bin + 0.5) / REPTATION_BINS - 1), &energy, NULL);
        weight[bin] = exp(-(energy - at_rest) / snake->metropolis->law.temperature);
    }
    mf_reptation_draw_init(&snake->cosine, -1, 1, weight);
}

static void prepare(struct snake *snake, const struct molecules *molecules, int k) {
    const struct topology_kind *kind = &molecules->topology.kind[k];
    snake->beads = kind->beads;
    snake->exclude = kind->exclude;
    snake->places = reptation_places(snake->reptation->kind[k].choice);
    for (int order = 0; order < TOPOLOGY_ORDERS; order++) {
        const int group = snake->reptation->group[k][order];
        snake->curve[order] = group >= 0 ? &molecules->group[order][group].curve : NULL;
    }
    prepare_length(snake, kind->type[0]);
    prepare_cosine(snake);
}

// Places and weights ------------------------------------------------------------------------------

static double uniform(struct snake *snake) {
    return mf_rng_sequence_uniform(&snake->random);
}

static void put(const struct snake *snake, int32_t k, const double where[3]) {
    const struct particles *particles = &snake->metropolis->particles;
    for (int d = 0; d < 3; d++) {
        particles->position[d][k] = where[d];
        particles->fraction[d][k] = particles->kernel_place[k].fraction[d] =
            box_fraction(where[d], 1 / particles->box.length[d]);
    }
}

static void normalise(double a[3]) {
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int d = 0; d < 3; d++)
        a[d] /= length;
}

static void cross(const double a[3], const double b[3], double product[3]) {
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        product[d] = a[e] * b[f] - a[f] * b[e];
    }
}

/// A place next to an end: a bond of a random length, at a random angle with the last one, turned
/// about it by any angle.
static void draw_place(struct snake *snake, const struct snake_end *end, double where[3]) {
    const struct particles *particles = &snake->metropolis->particles;
    const double length = mf_reptation_draw_number(&snake->length, uniform(snake));
    const double cosine = mf_reptation_draw_number(&snake->cosine, uniform(snake));
    const double sine = sqrt(fmax(0, 1 - cosine * cosine)), phi = 2 * M_PI * uniform(snake);
    double last[3], side[3], normal[3], axis[3] = {0};
    for (int d = 0; d < 3; d++)
        last[d] =
            box_nearest(particles->position[d][end->bead[0]] - particles->position[d][end->bead[1]],
                        particles->box.length[d]);
    normalise(last);
    axis[fabs(last[0]) < 0.6 ? 0 : 1] = 1; // whatever is not along it
    cross(last, axis, side);
    normalise(side);
    cross(last, side, normal);
    for (int d = 0; d < 3; d++)
        where[d] = particles->position[d][end->bead[0]] +
                   length * (sine * (cos(phi) * side[d] + sin(phi) * normal[d]) - cosine * last[d]);
}

/// exp(−U/k_B T)/q of a bead where it is, next to an end. Not finite where no bead is put.
static double weigh(const struct snake *snake, int32_t k, const struct snake_end *end) {
    const struct metropolis *metropolis = snake->metropolis;
    const struct particles *particles = &metropolis->particles;
    const int32_t place[TOPOLOGY_MOST_BEADS] = {k, end->bead[0], end->bead[1], end->bead[2]};
    double q[TOPOLOGY_ORDERS], sum = 0;
    for (int order = 0; order < TOPOLOGY_ORDERS; order++) {
        double energy = 0;
        if (order < TOPOLOGY_DIHEDRAL || snake->curve[order])
            mf_bonded_measure(order, 1, place, particles, &q[order]);
        if (snake->curve[order])
            mf_bonded_value(snake->curve[order], q[order], &energy, NULL);
        sum += energy;
    }
    if (q[TOPOLOGY_BOND] >= mf_bonded_longest(snake->curve[TOPOLOGY_BOND]))
        return 0;
    if (metropolis->law.potential)
        sum += mf_reptation_grid_energy(&snake->reptation->grid, &metropolis->law, particles, k,
                                        end->bead, snake->exclude);
    return exp(-sum / metropolis->law.temperature) * q[TOPOLOGY_BOND] * q[TOPOLOGY_BOND] /
           (mf_reptation_draw_density(&snake->length, q[TOPOLOGY_BOND]) *
            mf_reptation_draw_density(&snake->cosine, cos(q[TOPOLOGY_ANGLE])));
}

/// Σ w of some places next to an end, where a bead is put in turn; one of them is chosen by w.
static double draw_places(struct snake *snake, int32_t k, const struct snake_end *end, int places,
                          double chosen[3]) {
    double sum = 0;
    for (int n = 0; n < places; n++) {
        double where[3];
        draw_place(snake, end, where);
        put(snake, k, where);
        const double weight = weigh(snake, k, end);
        sum += weight;
        if (uniform(snake) * sum < weight)
            memcpy(chosen, where, sizeof where);
    }
    return sum;
}

// Moves -------------------------------------------------------------------------------------------

/// Number of the particle that is bead n of the chain.
static int32_t bead_at(const struct snake *snake, int n) {
    return snake->reptation->bead[(snake->first + n) % snake->beads];
}

static struct snake_end end_at(const struct snake *snake, int n, int step) {
    return (struct snake_end){
        {bead_at(snake, n), bead_at(snake, n + step), bead_at(snake, n + 2 * step)}};
}

/// Take a bead off one end and put it before the other. Whether it stays there.
static bool creep(struct snake *snake) {
    const struct particles *particles = &snake->metropolis->particles;
    struct reptation_grid *grid = &snake->reptation->grid;
    const int last = snake->beads - 1;
    const bool forward = uniform(snake) < 0.5;
    const int32_t k = bead_at(snake, forward ? 0 : last);
    const struct snake_end ahead = forward ? end_at(snake, last, -1) : end_at(snake, 0, 1);
    const struct snake_end behind = forward ? end_at(snake, 1, 1) : end_at(snake, last - 1, -1);
    double here[3], there[3], unused[3];
    for (int d = 0; d < 3; d++)
        here[d] = particles->position[d][k];
    mf_reptation_grid_remove(grid, particles, k);
    const double before =
        weigh(snake, k, &behind) + draw_places(snake, k, &behind, snake->places - 1, unused);
    const double after = draw_places(snake, k, &ahead, snake->places, there);
    // Written so that a NaN is refused, and so is what could never have been drawn.
    const bool accepted = uniform(snake) * before < after && isfinite(after);
    put(snake, k, accepted ? there : here);
    mf_reptation_grid_insert(grid, particles, k);
    if (!accepted)
        return false;
    for (int d = 0; d < 3; d++) // its new place stands beside that of the bead ahead
        particles->image[d][k] = particles->image[d][ahead.bead[0]];
    snake->first = (snake->first + (forward ? 1 : last)) % snake->beads;
    return true;
}

/// Chains that have just crept often creep back. With beads that have moved in between, and a pass
/// that costs as much as the rest of a sweep, R_e forgets itself soonest, if not by much: of 50
/// beads in a soft melt, k = 1, in 4.7, 4.4 and 5.8 s with 50, 12 and 4 tries a sweep, good to some
/// 20 %.
static int tries_of(int beads, int places) {
    return beads > 4 * places ? beads / (4 * places) : 1;
}

/// Try molecule number m of its kind, and name its beads anew.
static void creep_along(struct snake *snake, const struct topology_kind *kind, uint32_t m,
                        struct reptation_tally *tally) {
    const struct particles *particles = &snake->metropolis->particles;
    const int tries = tries_of(snake->beads, snake->places);
    snake->first = 0;
    for (int n = 0; n < snake->beads; n++)
        snake->reptation->bead[n] = (int32_t)particles->place[topology_id(kind, m, n)];
    for (int n = 0; n < tries; n++)
        tally->accepted += creep(snake);
    tally->tried += (uint64_t)tries;
    for (int n = 0; n < snake->beads; n++)
        particles->id[bead_at(snake, n)] = topology_id(kind, m, n);
}

bool mf_reptation_is_on(const struct reptation *reptation) {
    for (int k = 0; k < TOPOLOGY_MOST_KINDS; k++)
        if (reptation->can[k] && reptation->kind[k].choice >= 0)
            return true;
    return false;
}

/// Try the chains of one kind.
static void creep_kind(struct snake *snake, const struct molecules *molecules, int k) {
    enum { COUNTER = 16 }; // of random numbers; other moves of molecules have smaller ones
    const struct metropolis *metropolis = snake->metropolis;
    const struct topology *topology = &molecules->topology;
    struct reptation_kind *kind = &snake->reptation->kind[k];
    prepare(snake, molecules, k);
    for (size_t n = 0; n < metropolis->particles.count; n++) {
        const uint32_t id = metropolis->order[n], molecule = topology->molecule[id];
        if (metropolis->molecules.bead_of[id] != 0 ||
            mf_molecule_moves_kind(topology, molecule) != k)
            continue;
        snake->random =
            mf_rng_sequence_begin(metropolis->seed, RNG_METROPOLIS, metropolis->sweep, molecule);
        snake->random.c = COUNTER;
        creep_along(snake, &topology->kind[k], molecule - (uint32_t)topology->kind[k].first,
                    &kind->tally[kind->choice]);
    }
}

enum status mf_reptation_pass(struct metropolis *metropolis) {
    const struct molecules *molecules = metropolis->molecules.molecules;
    const struct table *potential = metropolis->law.potential;
    struct reptation *reptation = &metropolis->reptation;
    struct snake snake = {.metropolis = metropolis, .reptation = reptation};
    mf_reptation_grid_fill(&reptation->grid, &metropolis->particles,
                           potential ? potential->cutoff : 0);
    for (int k = 0; k < molecules->topology.kinds; k++)
        if (reptation->can[k] && reptation->kind[k].choice >= 0)
            creep_kind(&snake, molecules, k);
    return mf_metropolis_refresh(metropolis);
}

// How often ---------------------------------------------------------------------------------------

void mf_reptation_forget(struct reptation *reptation) {
    for (int k = 0; k < TOPOLOGY_MOST_KINDS; k++)
        memset(reptation->kind[k].tally, 0, sizeof reptation->kind[k].tally);
}

void mf_reptation_tune(struct reptation *reptation, uint32_t sweep) {
    for (int k = 0; k < TOPOLOGY_MOST_KINDS; k++)
        if (reptation->can[k])
            reptation->kind[k].choice = (int)(sweep % REPTATION_CHOICES);
}

void mf_reptation_choose(struct reptation *reptation) {
    for (int k = 0; k < TOPOLOGY_MOST_KINDS; k++) {
        double best = least_accepted;
        reptation->kind[k].choice = -1;
        for (int choice = 0; choice < REPTATION_CHOICES; choice++) {
            const struct reptation_tally *tally = &reptation->kind[k].tally[choice];
            const double accepted =
                (double)tally->accepted / ((double)tally->tried * reptation_places(choice));
            if (accepted > best) { // a NaN is not
                best = accepted;
                reptation->kind[k].choice = choice;
            }
        }
    }
    mf_reptation_forget(reptation);
}
