// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/molecules_growth.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/bonded_batch.h"

#include <math.h>
#include <string.h>

enum { PLACES = 4000, TRIALS = 32, BEFORE = 3 };

/// Beyond this many k_B T a bond is not drawn.
static const double highest = 40;

/// How q is distributed.
struct growth_draw {
    double low, width;             ///< of a place, in the curve's unit
    double cumulative[PLACES + 1]; ///< from 0 to 1
};

/// How a bead is joined to those before it.
struct growth_joint {
    int bead, before[BEFORE]; ///< bonded one to the next; −1 where there is none
    const struct growth_draw *draw[BONDED_KINDS]; ///< of them; NULL: free
    int first, terms;                             ///< that choose
    int pair[BEFORE];                             ///< pair type with each that repels it, or −1
    int home, left;                               ///< a ring's bead that is `left` bonds away; or 0
};

struct growth_term {
    int order;
    const struct topology_term *term;
};

// Distributions -----------------------------------------------------------------------------------

/// The longest bond that is drawn; one that no energy holds, as of a table that ends level, is
/// twice as long as at rest at most.
static double longest_of(const struct bonded_curve *curve, double temperature) {
    const double rest = mf_bonded_rest(curve);
    const double reach = mf_bonded_reach(curve, highest * temperature);
    double min, energy;
    mf_bonded_value(curve, rest, &min, NULL);
    mf_bonded_value(curve, reach, &energy, NULL);
    const bool held = energy > min + highest * temperature || reach >= mf_bonded_longest(curve);
    return held ? reach : 2 * rest;
}

/// exp(−U/k_B T) times the Jacobian. @param[in] pair  whose Φ acts along the bond, too, or −1
static void fill_draw(struct growth_draw *draw, const struct growth *growth, int order, int group,
                      int pair) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const struct bonded_curve *curve = &growth->molecules->group[order][group].curve;
    const double temperature = fmax(growth->law->temperature, 1e-3);
    const double high = kind->is_length ? longest_of(curve, temperature) : kind->high;
    double *weight = draw->cumulative + 1, min = INFINITY;
    draw->low = kind->is_length ? 0 : kind->low;
    draw->width = (high - draw->low) / PLACES;
    for (int n = 0; n < PLACES; n++) {
        const double q = kind->scale * (draw->low + (n + 0.5) * draw->width);
        double pairs = 0;
        mf_bonded_value(curve, q, &weight[n], NULL);
        if (pair >= 0)
            mf_table_evaluate_pair(growth->law->potential, pair, q, &pairs, NULL, NULL);
        weight[n] += pairs;
        min = fmin(min, weight[n]);
    }
    for (int n = 0; n < PLACES; n++)
        weight[n] =
            draw->cumulative[n] +
            exp((min - weight[n]) / temperature) *
                kind->jacobian(growth->dimensions, draw->low + n * draw->width, draw->width);
    for (int n = 0; n < PLACES; n++)
        weight[n] /= weight[PLACES - 1];
    draw->low *= kind->scale;
    draw->width *= kind->scale;
}

static enum status give_draw(struct growth *growth, struct growth_joint *joint, int order,
                             const struct topology_term *term, int pair) {
    struct growth_draw **draw = &growth->draw[order][term->group][1 + pair];
    if (*draw == NULL) {
        TRY_ARRAY(*draw, 1);
        fill_draw(*draw, growth, order, term->group, pair);
    }
    joint->draw[order] = *draw;
    return STATUS_OK;
}

/// From a uniform number.
static double find_place(const struct growth_draw *draw, double uniform) {
    int below = 0, above = PLACES;
    while (above - below > 1) {
        const int middle = (below + above) / 2;
        *(draw->cumulative[middle] <= uniform ? &below : &above) = middle;
    }
    const double from = draw->cumulative[below], to = draw->cumulative[above];
    return draw->low + draw->width * (below + (to > from ? (uniform - from) / (to - from) : 0.5));
}

// The order of growth -----------------------------------------------------------------------------

/// What is found of a kind while its growth is planned.
struct plan {
    struct growth *growth;
    int *order, *parent, *rank; ///< shape [beads]; rank by bead
};

/// The bead of a term that is placed last.
static int last_of(const struct plan *plan, int order, const struct topology_term *term) {
    int last = term->bead[0];
    for (int k = 1; k < mf_bonded_kinds[order]->beads; k++)
        last = plan->rank[term->bead[k]] > plan->rank[last] ? term->bead[k] : last;
    return last;
}

/// Whether a term goes from the bead of a joint along those before it, as far as they are known;
/// those that are not yet it gives.
static bool leads(const struct growth_joint *joint, int order, const struct topology_term *term,
                  int before[BEFORE]) {
    const int beads = mf_bonded_kinds[order]->beads;
    const bool back = term->bead[0] != joint->bead;
    for (int k = 0; k < beads; k++) {
        const int bead = term->bead[back ? beads - 1 - k : k];
        const int known = k == 0 ? joint->bead : joint->before[k - 1];
        if (known >= 0 && bead != known)
            return false;
        if (k > 0)
            before[k - 1] = bead;
    }
    return true;
}

/// Take a term of an order that goes along those before the bead off those that it completes, the
/// first of them, or NULL.
static const struct topology_term *take_term(struct growth *growth, struct growth_joint *joint,
                                             int order) {
    struct growth_term *own = growth->term + joint->first;
    for (int n = 0; n < joint->terms; n++) {
        const struct topology_term *term = own[n].term;
        int before[BEFORE];
        memcpy(before, joint->before, sizeof before);
        if (own[n].order != order || !leads(joint, order, term, before))
            continue;
        memcpy(joint->before, before, sizeof before);
        memmove(own + n, own + n + 1, (size_t)(--joint->terms - n) * sizeof *own);
        return term;
    }
    return NULL;
}

/// Type of the pair, if its potential acts, or −1.
static int pair_of(const struct growth *growth, int a, int b) {
    const struct topology_kind *kind = growth->kind;
    if (growth->law->potential == NULL || b < 0)
        return -1;
    for (int n = kind->near_start[a]; n < kind->near_start[a + 1]; n++)
        if (kind->near[n] == b)
            return -1;
    const int pair = mf_composition_pair(&growth->law->composition, kind->type[a], kind->type[b]);
    return pair < growth->law->potential->curves ? pair : 0;
}

/// The terms that the bead of each joint completes, one joint after the other.
static void list_terms(const struct plan *plan) {
    const struct topology_kind *kind = plan->growth->kind;
    struct growth_joint *joint = plan->growth->joint;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++)
            joint[plan->rank[last_of(plan, order, &kind->term[order][n])]].first++; // their number
    for (int n = 0, first = 0, own; n < kind->beads; n++, first += own) {
        own = joint[n].first;
        joint[n].first = first;
    }
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < kind->terms[order]; n++) {
            const struct topology_term *term = &kind->term[order][n];
            struct growth_joint *last = &joint[plan->rank[last_of(plan, order, term)]];
            plan->growth->term[last->first + last->terms++] = (struct growth_term){order, term};
        }
}

/// A bond that closes a ring draws all beads on the way back from its last one to its first.
static void lead_home(const struct plan *plan, const struct topology_term *bond, int bead) {
    const int home = bond->bead[bond->bead[0] == bead];
    int left = 2;
    for (int at = plan->parent[bead]; at >= 0 && at != home && plan->rank[at] > plan->rank[home];
         at = plan->parent[at], left++) {
        struct growth_joint *joint = &plan->growth->joint[plan->rank[at]];
        if (joint->left == 0 || joint->left > left)
            joint->home = home, joint->left = left;
    }
}

static enum status plan_joint(const struct plan *plan, int n) {
    struct growth *growth = plan->growth;
    struct growth_joint *joint = &growth->joint[n];
    const struct topology_term *drawn[BONDED_KINDS] = {NULL};
    const int parent = plan->parent[plan->order[n]];
    joint->bead = plan->order[n];
    joint->before[0] = parent;
    joint->before[1] = joint->before[2] = -1;
    for (int order = 0; order < BONDED_KINDS && parent >= 0; order++)
        drawn[order] = take_term(growth, joint, order);
    for (int k = 1; k < BEFORE; k++)
        if (joint->before[k] < 0 && joint->before[k - 1] >= 0)
            joint->before[k] = plan->parent[joint->before[k - 1]];
    if (joint->before[2] == parent) // the one before it is another of its branches
        joint->before[2] = -1;
    for (int k = 0; k < BEFORE; k++)
        joint->pair[k] = pair_of(growth, joint->bead, joint->before[k]);
    for (int order = 0; order < BONDED_KINDS; order++)
        if (drawn[order])
            TRY(give_draw(growth, joint, order, drawn[order],
                          order == BONDED_BOND ? joint->pair[0] : -1));
    joint->pair[0] = -1; // it is in the draw
    return STATUS_OK;
}

enum status mf_molecules_growth_init(struct growth *growth, const struct molecules *molecules,
                                     const struct topology_kind *kind, const struct pair_law *law,
                                     int dimensions) {
    OWNED int *order = NULL, *parent = NULL, *rank = NULL;
    int all = 0;
    *growth = (struct growth){molecules, law, dimensions, .kind = kind};
    for (int o = 0; o < BONDED_KINDS; o++)
        all += kind->terms[o];
    TRY_ARRAY(growth->joint, kind->beads);
    TRY_ARRAY(growth->term, all);
    TRY_ARRAY(order, kind->beads);
    TRY_ARRAY(parent, kind->beads);
    TRY_ARRAY(rank, kind->beads);
    mf_topology_walk(kind, order, parent);
    for (int n = 0; n < kind->beads; n++)
        rank[order[n]] = n;
    const struct plan plan = {growth, order, parent, rank};
    list_terms(&plan);
    for (int n = 0; n < kind->beads; n++)
        TRY(plan_joint(&plan, n));
    for (int n = 0; n < kind->beads; n++)
        for (int k = 0; k < growth->joint[n].terms; k++) {
            const struct growth_term *term = &growth->term[growth->joint[n].first + k];
            if (term->order == BONDED_BOND)
                lead_home(&plan, term->term, growth->joint[n].bead);
        }
    return STATUS_OK;
}

void mf_molecules_growth_clear(struct growth *growth) {
    mf_memory_free(growth->joint);
    mf_memory_free(growth->term);
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < MOLECULES_MAX_GROUPS; g++)
            for (int pair = 0; pair <= TABLE_MAX_CURVES; pair++)
                mf_memory_free(growth->draw[order][g][pair]);
    *growth = (struct growth){0};
}

// Growth ------------------------------------------------------------------------------------------

/// Bring a vector to length 1; returns what it was.
static double normalise(double vector[3]) {
    const double length = sqrt(bonded_dot(vector, vector));
    for (int d = 0; d < 3 && length > 0; d++)
        vector[d] /= length;
    return length;
}

/// A random direction, uniform on the sphere or the circle.
static void draw_direction(struct rng_sequence *sequence, int dimensions, double direction[3]) {
    const double turn = 2 * M_PI * mf_rng_sequence_uniform(sequence);
    const double up = dimensions == 3 ? 2 * mf_rng_sequence_uniform(sequence) - 1 : 0;
    const double flat = sqrt(1 - up * up);
    direction[0] = flat * cos(turn);
    direction[1] = flat * sin(turn);
    direction[2] = up;
}

/// The frame at the bead that is bonded to: `back` to the one before it, and across to the third,
/// or anywhere.
static bool find_frame(const struct growth_joint *joint, const double (*place)[3], int dimensions,
                       struct rng_sequence *sequence, double back[3], double across[3]) {
    const int *before = joint->before;
    if (before[1] < 0)
        return false;
    if (before[2] < 0 || joint->draw[BONDED_DIHEDRAL] == NULL)
        draw_direction(sequence, dimensions, across);
    for (int d = 0; d < 3; d++) {
        back[d] = place[before[1]][d] - place[before[0]][d];
        if (before[2] >= 0 && joint->draw[BONDED_DIHEDRAL])
            across[d] = place[before[2]][d] - place[before[1]][d];
    }
    if (!(normalise(back) > 0))
        return false;
    const double along = bonded_dot(across, back);
    for (int d = 0; d < 3; d++)
        across[d] -= along * back[d];
    return normalise(across) > BONDED_NO_DIRECTION;
}

/// A place of the bead, drawn.
static void draw_place(const struct growth_joint *joint, const double (*place)[3], int dimensions,
                       struct rng_sequence *sequence, double here[3]) {
    double back[3], across[3], side[3], direction[3];
    const bool framed = find_frame(joint, place, dimensions, sequence, back, across);
    const double length = joint->draw[BONDED_BOND] ? find_place(joint->draw[BONDED_BOND],
                                                                mf_rng_sequence_uniform(sequence))
                                                   : 0;
    draw_direction(sequence, dimensions, direction);
    if (framed && (joint->draw[BONDED_ANGLE] || joint->draw[BONDED_DIHEDRAL])) {
        const double one = mf_rng_sequence_uniform(sequence);
        const double angle = joint->draw[BONDED_ANGLE] ? find_place(joint->draw[BONDED_ANGLE], one)
                                                       : acos(1 - 2 * one);
        const double turn =
            joint->draw[BONDED_DIHEDRAL]
                ? find_place(joint->draw[BONDED_DIHEDRAL], mf_rng_sequence_uniform(sequence))
                : 0;
        bonded_cross(across, back, side);
        for (int d = 0; d < 3; d++)
            direction[d] =
                cos(angle) * back[d] + sin(angle) * (cos(turn) * across[d] + sin(turn) * side[d]);
    }
    for (int d = 0; d < 3; d++)
        here[d] = place[joint->before[0]][d] + length * direction[d];
}

/// Places of a bead that one is chosen of.
struct trials {
    int count;
    double place[TRIALS][3], energy[TRIALS]; ///< over k_B T
    struct bonded_batch batch;
};

/// Add U of a term that the bead completes.
static void add_term(const struct growth *growth, const struct growth_term *term, int bead,
                     const double (*place)[3], struct trials *trials) {
    const struct bonded_kind *kind = mf_bonded_kinds[term->order];
    const struct bonded_curve *curve =
        &growth->molecules->group[term->order][term->term->group].curve;
    double energy[BONDED_BATCH];
    trials->batch.count = trials->count;
    for (int k = 0; k < kind->arms; k++) {
        const int from = term->term->bead[kind->arm[k].from],
                  to = term->term->bead[kind->arm[k].to];
        for (int n = 0; n < trials->count; n++)
            for (int d = 0; d < 3; d++)
                trials->batch.arm[k][d][n] = (from == bead ? trials->place[n] : place[from])[d] -
                                             (to == bead ? trials->place[n] : place[to])[d];
    }
    kind->measure(&trials->batch);
    curve->law->evaluate(curve->parameters, (size_t)trials->count, trials->batch.q, energy,
                         trials->batch.slope);
    for (int n = 0; n < trials->count; n++)
        trials->energy[n] += energy[n] / fmax(growth->law->temperature, 1e-3);
}

static double square_between(const double a[3], const double b[3]) {
    const double apart[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return bonded_dot(apart, apart);
}

/// What weighs on a trial beside the terms: pairs, the way home, and the stretch.
static double weigh(const struct growth *growth, const struct growth_joint *joint,
                    const double (*place)[3], const double here[3]) {
    const double *parent = place[joint->before[0]], *first = place[growth->joint[0].bead];
    const double step = square_between(here, parent), way = square_between(parent, first);
    double energy = 0, value;
    for (int k = 0; k < BEFORE; k++)
        if (joint->pair[k] >= 0) {
            mf_table_evaluate_pair(growth->law->potential, joint->pair[k],
                                   sqrt(square_between(here, place[joint->before[k]])), &value,
                                   NULL, NULL);
            energy += value / fmax(growth->law->temperature, 1e-3);
        }
    if (joint->left > 0)
        energy += 0.5 * growth->dimensions * square_between(here, place[joint->home]) /
                  (joint->left * fmax(step, 1e-30));
    for (int d = 0; d < 3 && way > 0 && step > 0; d++)
        energy -=
            growth->stretch * (here[d] - parent[d]) * (parent[d] - first[d]) / sqrt(way * step);
    return energy;
}

/// One of them, by exp(−energy).
static int choose(const struct trials *trials, double uniform) {
    double min = INFINITY, sum = 0;
    int chosen = 0;
    for (int n = 0; n < trials->count; n++)
        min = fmin(min, trials->energy[n]);
    for (int n = 0; n < trials->count; n++)
        sum += exp(min - trials->energy[n]);
    for (uniform *= sum; chosen + 1 < trials->count; chosen++)
        if ((uniform -= exp(min - trials->energy[chosen])) < 0)
            break;
    return chosen;
}

static bool is_free(const struct growth *growth, const struct growth_joint *joint) {
    bool free = joint->terms == 0 && joint->left == 0 && growth->stretch == 0;
    for (int k = 0; k < BEFORE; k++)
        free = free && joint->pair[k] < 0;
    return free;
}

static void grow_bead(const struct growth *growth, const struct growth_joint *joint,
                      struct rng_sequence *sequence, double (*place)[3]) {
    struct trials trials = {.count = is_free(growth, joint) ? 1 : TRIALS};
    const double(*placed)[3] = (const double(*)[3])place;
    if (joint->before[0] < 0) {
        memset(place[joint->bead], 0, sizeof place[joint->bead]);
        return;
    }
    for (int n = 0; n < trials.count; n++)
        draw_place(joint, placed, growth->dimensions, sequence, trials.place[n]);
    if (trials.count > 1) {
        for (int n = 0; n < trials.count; n++)
            trials.energy[n] = weigh(growth, joint, placed, trials.place[n]);
        for (int k = 0; k < joint->terms; k++)
            add_term(growth, &growth->term[joint->first + k], joint->bead, placed, &trials);
    }
    const int chosen = trials.count > 1 ? choose(&trials, mf_rng_sequence_uniform(sequence)) : 0;
    memcpy(place[joint->bead], trials.place[chosen], sizeof trials.place[chosen]);
}

void mf_molecules_growth_draw(const struct growth *growth, uint64_t seed, uint32_t molecule,
                              double (*place)[3]) {
    for (int n = 0; n < growth->kind->beads; n++) {
        struct rng_sequence sequence =
            mf_rng_sequence_begin(seed, RNG_MIXING, molecule + 1, (uint32_t)n);
        grow_bead(growth, &growth->joint[n], &sequence, place);
    }
}
