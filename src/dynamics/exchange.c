// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/exchange.h"

#include "base/rng.h"

/// r² of two particles, from the fractions that the kernels read.
static double square_distance(const struct particles *particles, size_t k, size_t l) {
    static const double unit = 1.0 / 4294967296.0; // 2⁻³² of the box
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double x =
            unit * particles->box.length[d] *
            box_fraction_difference(particles->fraction[d][k], particles->fraction[d][l]);
        square += x * x;
    }
    return square;
}

/// Change of Φ if particle k were of type `to`; `other` changes at the same time, and what the two
/// have with each other does not.
static double find_change(const struct metropolis *metropolis, size_t k, size_t other, int to) {
    const struct particles *particles = &metropolis->particles;
    const struct neighbours *neighbours = &metropolis->neighbours;
    const struct composition *composition = &metropolis->law.composition;
    const struct table *potential = metropolis->law.potential;
    const int from = mf_composition_type(composition, particles->id[k]);
    const double cutoff2 = potential->cutoff * potential->cutoff;
    double change = 0;
    for (size_t n = neighbours->start[k]; n < neighbours->stop[k]; n++) {
        const size_t l = (size_t)neighbours->list[n];
        const double square = square_distance(particles, k, l);
        if (l == other || square >= cutoff2)
            continue;
        const int type = mf_composition_type(composition, particles->id[l]);
        double before, after;
        mf_table_evaluate_pair(potential, mf_composition_pair(composition, from, type),
                               sqrt(square), &before, NULL, NULL);
        mf_table_evaluate_pair(potential, mf_composition_pair(composition, to, type), sqrt(square),
                               &after, NULL, NULL);
        change += after - before;
    }
    return change;
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
    const double change =
        find_change(metropolis, k, l, type[1]) + find_change(metropolis, l, k, type[0]);
    // Written so that a NaN is refused.
    if (mf_rng_uniform(random.word[3], 0) < exp(-change / metropolis->law.temperature))
        exchange(&metropolis->particles, place, id);
}

void mf_exchange_pass(struct metropolis *metropolis, uint32_t *place) {
    if (metropolis->law.potential == NULL)
        return;
    for (uint32_t n = 0; n < metropolis->exchanges; n++)
        try_exchange(metropolis, n, place);
}
