// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/uneven.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "shared/testing.h"

static const struct box box = {3, {24, 8, 8}};

/// A place for a bead.
typedef void uneven_place(struct rng_sequence *random, double x[3]);

static double between(struct rng_sequence *random, double low, double high) {
    return low + (high - low) * mf_rng_sequence_uniform(random);
}

static void place_anywhere(struct rng_sequence *random, double x[3]) {
    for (int d = 0; d < 3; d++)
        x[d] = between(random, 0, box.length[d]);
}

/// Near `centre`, up to `radius` away along each axis.
static void place_near(struct rng_sequence *random, const double centre[3], const double radius[3],
                       double x[3]) {
    for (int d = 0; d < 3; d++)
        x[d] = between(random, centre[d] - radius[d], centre[d] + radius[d]);
}

/// A share of the beads near a place that is as random as the share.
static void place_dense(struct particles *particles, struct rng_sequence *random,
                        const double wide[3]) {
    const double share = between(random, 0.02, 0.32), radius = between(random, 0.5, 1.4);
    const double size[3] = {radius * wide[0], radius * wide[1], radius * wide[2]};
    double centre[3], x[3];
    place_anywhere(random, centre);
    for (size_t k = 0; k < particles->count; k++) {
        if (mf_rng_sequence_uniform(random) < share)
            place_near(random, centre, size, x);
        else
            place_anywhere(random, x);
        for (int d = 0; d < 3; d++)
            particles->position[d][k] = x[d];
    }
}

static void place_clusters(struct particles *particles, struct rng_sequence *random) {
    const double size[3] = {0.6, 0.6, 0.6};
    double centre[3] = {0}, x[3];
    for (size_t k = 0; k < particles->count; k++) {
        if (k % 64 == 0)
            place_anywhere(random, centre);
        place_near(random, centre, size, x);
        for (int d = 0; d < 3; d++)
            particles->position[d][k] = x[d];
    }
}

/// Beads in the first plane of cells, ever fewer along it: the last of the part are lonely. Some
/// are in the last half.
static void place_first(struct particles *particles, struct rng_sequence *random) {
    for (size_t k = 0; k < particles->count; k++) {
        const bool is_far = k % 8 == 0;
        particles->position[0][k] = is_far ? between(random, 12, 24) : between(random, 0, 0.9);
        particles->position[1][k] = box.length[1] * pow(mf_rng_sequence_uniform(random), 6);
        particles->position[2][k] = between(random, 0, box.length[2]);
    }
}

static void place(struct particles *particles, enum uneven_kind kind, uint32_t number) {
    struct rng_sequence random = mf_rng_sequence_begin(77, RNG_PLACEMENT, (uint32_t)kind, number);
    switch (kind) {
    case UNEVEN_DROPLET:
        place_dense(particles, &random, (const double[3]){1, 1, 1});
        break;
    case UNEVEN_FILM:
        place_dense(particles, &random, (const double[3]){1, 8, 8});
        break;
    case UNEVEN_CLUSTERS:
        place_clusters(particles, &random);
        break;
    case UNEVEN_EMPTY:
        place_first(particles, &random);
        break;
    default:
        for (int k = 0; k < 2; k++)
            for (int d = 0; d < 3; d++)
                particles->position[d][k] = between(&random, 3, 3.5);
    }
}

void uneven_init(struct uneven *uneven, enum uneven_kind kind, uint32_t number) {
    struct formula_soft_repulsion_parameters parameters = {25, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    const size_t some = kind == UNEVEN_EMPTY ? 600 : 2000;
    const size_t count = kind == UNEVEN_TWO ? 2 : some + 31 * (number % 64);
    assert_ok(mf_table_init_potential(&uneven->potential, &curve));
    assert_ok(mf_particles_init(&uneven->particles, &box, count));
    uneven->particles.threads = 1;
    place(&uneven->particles, kind, number);
    assert_ok(mf_neighbours_init(&uneven->neighbours, NEIGHBOURS_HALF, &box, count, 1, 0.3));
    assert_ok(mf_neighbours_sort_and_build(&uneven->neighbours, &uneven->particles));
}

void uneven_clear(struct uneven *uneven) {
    mf_table_clear(&uneven->potential);
    mf_particles_clear(&uneven->particles);
    mf_neighbours_clear(&uneven->neighbours);
}

void uneven_narrow(struct uneven *uneven, int room) {
    struct neighbours *neighbours = &uneven->neighbours;
    double needed = 0;
    for (int p = 0; p < neighbours->parts; p++) {
        const struct neighbours_part *part = &neighbours->part[p];
        const double places = (double)(part->end - part->begin) + 16 * (room - 16);
        if (part->last > part->first)
            needed = fmax(needed, places / (double)(part->last - part->first));
    }
    neighbours->entries_each = needed;
}

static void check_owners(const struct neighbours *neighbours, int threads) {
    for (size_t k = 0; k < neighbours->count; k++)
        for (size_t row = neighbours->start[k] / NEIGHBOURS_ROW;
             row < neighbours->stop[k] / NEIGHBOURS_ROW; row++)
            if (neighbours->owner[row] != (int32_t)k)
                fail_msg("row %zu of particle %zu belongs to %d after a build with %d threads", row,
                         k, neighbours->owner[row], threads);
}

/// Forces from a list that so many threads have built.
static double *find_forces(struct uneven *uneven, int threads) {
    struct particles *particles = &uneven->particles;
    const struct pair_law law = {.potential = &uneven->potential, .temperature = 1};
    const size_t count = particles->count;
    double *forces = mf_memory_zeroed(3 * count, sizeof *forces);
    assert_non_null(forces);
    particles->threads = threads;
    assert_ok(mf_neighbours_sort_and_build(&uneven->neighbours, particles));
    check_owners(&uneven->neighbours, threads);
    mf_pair_forces(&law, particles, &uneven->neighbours, 0, PAIR_FORCES, NULL);
    for (int d = 0; d < 3; d++)
        memcpy(forces + (size_t)d * count, particles->force[d], count * sizeof *forces);
    particles->threads = 1;
    return forces;
}

void uneven_check_threads(struct uneven *uneven, int threads) {
    double *shared = find_forces(uneven, threads), *alone = find_forces(uneven, 1);
    assert_memory_equal(shared, alone, 3 * uneven->particles.count * sizeof *alone);
    mf_memory_free(shared);
    mf_memory_free(alone);
}

int uneven_check_ends(struct uneven *uneven) {
    enum { UNTOUCHED = -77 };
    struct neighbours *neighbours = &uneven->neighbours;
    const double narrow = neighbours->entries_each;
    const size_t capacity = neighbours->list_capacity;
    int seen = 0;
    for (size_t row = 0; row < capacity / NEIGHBOURS_ROW; row++)
        neighbours->owner[row] = UNTOUCHED;
    assert_ok(mf_neighbours_sort_and_build(neighbours, &uneven->particles));
    // A first trial with other ends has left its rows, or the list is a new one.
    if (neighbours->entries_each > narrow || neighbours->list_capacity > capacity)
        return 0;
    for (int p = 1; p + 1 < neighbours->parts; p++) {
        const struct neighbours_part *empty = &neighbours->part[p];
        if (empty->last > empty->first || empty[-1].last == empty[-1].first)
            continue;
        seen++;
        // The first row of the empty part is its own end.
        const size_t first = empty->begin / NEIGHBOURS_ROW + 1;
        for (size_t row = first; row < empty[1].begin / NEIGHBOURS_ROW; row++)
            if (neighbours->owner[row] != UNTOUCHED)
                fail_msg("part %d writes into row %zu of the next, with room for %zu places", p - 1,
                         row - first + 1, empty->begin - empty[-1].end);
    }
    return seen;
}
