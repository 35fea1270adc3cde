// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Verlet list against all pairs.
#include "system/neighbours.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/simd.h"
#include "curves/formula.h"
#include "dynamics/simulation.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <stdlib.h>

/// Squared distance of two particles.
static double square_distance(const struct particles *particles, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                      particles->box.length[d]);
        square += dx * dx;
    }
    return square;
}

/// How often particle j stands in the list of i: shape [count, count].
static uint8_t *count_entries(const struct neighbours *neighbours) {
    const size_t count = neighbours->count;
    uint8_t *entries = mf_memory_zeroed(count * count, 1);
    assert_non_null(entries);
    for (size_t i = 0; i < count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            assert_in_range(neighbours->list[k], 0, count - 1);
            // What is left of a row of a half list holds its owner.
            if (neighbours->kind == NEIGHBOURS_HALF && neighbours->list[k] == (int32_t)i)
                continue;
            entries[i * count + (size_t)neighbours->list[k]]++;
        }
    return entries;
}

/// Nobody is their own neighbour, no entry stands twice, a half list has a pair from one side
/// only, a full list from both.
static void check_entries(const struct neighbours *neighbours, const uint8_t *entries) {
    const size_t count = neighbours->count;
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(entries[i * count + i], 0);
        for (size_t j = i + 1; j < count; j++) {
            const int forth = entries[i * count + j], back = entries[j * count + i];
            assert_true(forth <= 1 && back <= 1);
            if (neighbours->kind == NEIGHBOURS_HALF)
                assert_true(forth + back <= 1);
            else
                assert_int_equal(forth, back);
        }
    }
}

/// Every pair nearer than `cutoff` is in the list; returns the number of such pairs.
static size_t check_complete(const struct neighbours *neighbours, const uint8_t *entries,
                             const struct particles *particles, double cutoff) {
    const size_t count = particles->count;
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++)
            if (square_distance(particles, i, j) < cutoff * cutoff) {
                found++;
                if (!entries[i * count + j] && !entries[j * count + i])
                    fail_msg("a pair at distance %g (range %g) is not in the list",
                             sqrt(square_distance(particles, i, j)), neighbours->range);
            }
    return found;
}

/// A dense hot DPD fluid in which everything moves through everything.
static void check_hot_simulation(const struct box *box, int64_t count, double skin) {
    struct curve curve;
    struct table potential, omega;
    assert_ok(mf_curve_create(&curve, &mf_formula_soft_repulsion));
    assert_ok(mf_table_init_potential(&potential, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_power_omega));
    assert_ok(mf_table_init_omega(&omega, &curve));
    mf_curve_clear(&curve);
    const struct simulation_setup setup = {.box = *box,
                                           .placement = {.count = count, .jitter = 0.2},
                                           .temperature = 10,
                                           .time_step = 0.01,
                                           .skin = skin,
                                           .temperature_limit = 20,
                                           .integrator = &mf_dpd_verlet,
                                           .potential = &potential,
                                           .omega = &omega,
                                           .seed = 3};
    struct simulation simulation;
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    uint8_t *entries = count_entries(&simulation.neighbours);
    uint64_t builds = simulation.list_builds;
    for (int step = 0; step < 3000; step++) {
        assert_ok(mf_simulation_run(&simulation, 1));
        if (simulation.list_builds != builds) {
            builds = simulation.list_builds;
            mf_memory_free(entries);
            entries = count_entries(&simulation.neighbours);
            check_entries(&simulation.neighbours, entries);
        }
        assert_true(check_complete(&simulation.neighbours, entries, &simulation.particles, 1) > 0);
    }
    assert_in_range(builds, 30, 2990); // lists were built, and lists were kept
    mf_memory_free(entries);
    mf_simulation_clear(&simulation);
    mf_table_clear(&potential);
    mf_table_clear(&omega);
}

static void test_neighbours_are_complete_when_a_simulation_is_hot(void **state) {
    (void)state;
    check_hot_simulation(&(struct box){3, {4.1, 3.3, 3.9}}, 150, 0.3);
    check_hot_simulation(&(struct box){3, {2.5, 2.6, 9.3}}, 150, 0.5);
    check_hot_simulation(&(struct box){2, {7.5, 6.1, 1}}, 130, 0.3);
}

static void make_gas(struct particles *particles, const struct box *box, size_t count,
                     double speed) {
    assert_ok(mf_particles_init(particles, box, count));
    struct rng_sequence sequence = mf_rng_sequence_begin(9, RNG_PLACEMENT, 0, 0);
    for (int d = 0; d < box->dimensions; d++)
        for (size_t k = 0; k < count; k++) {
            particles->position[d][k] = box->length[d] * mf_rng_sequence_uniform(&sequence);
            particles->velocity[d][k] = speed * (mf_rng_sequence_uniform(&sequence) - 0.3);
        }
}

static void drift(struct particles *particles, double time) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->position[d][k] += time * particles->velocity[d][k];
    mf_particles_update_fractions(particles);
}

/// Free flight over many boxes, rebuilt only when stale.
static void check_drift(enum neighbours_kind kind, const struct box *box, size_t count,
                        double cutoff, double skin) {
    struct particles particles;
    struct neighbours neighbours;
    make_gas(&particles, box, count, 3);
    assert_ok(mf_neighbours_init(&neighbours, kind, box, count, cutoff, skin));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    uint8_t *entries = count_entries(&neighbours);
    int builds = 0;
    for (int step = 0; step < 2000; step++) {
        drift(&particles, 0.01);
        if (mf_neighbours_are_stale(&neighbours, &particles)) {
            assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
            mf_memory_free(entries);
            entries = count_entries(&neighbours);
            check_entries(&neighbours, entries);
            check_complete(&neighbours, entries, &particles, neighbours.range * (1 - 1e-6));
            builds++;
        }
        check_complete(&neighbours, entries, &particles, cutoff);
    }
    assert_in_range(builds, 10, 1990);
    int farthest = 0;
    for (size_t k = 0; k < count; k++)
        farthest = abs(particles.image[0][k]) > farthest ? abs(particles.image[0][k]) : farthest;
    assert_true(farthest > 3);
    mf_memory_free(entries);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

static void test_neighbours_are_complete_when_particles_drift_by_many_boxes(void **state) {
    (void)state;
    for (int kind = NEIGHBOURS_HALF; kind <= NEIGHBOURS_FULL; kind++) {
        check_drift((enum neighbours_kind)kind, &(struct box){3, {7, 6, 5}}, 160, 1.1, 0.4);
        check_drift((enum neighbours_kind)kind, &(struct box){3, {2.8, 14, 2.9}}, 120, 1.1, 0.9);
        check_drift((enum neighbours_kind)kind, &(struct box){2, {9, 5, 1}}, 100, 1.1, 0.4);
    }
}

static void test_neighbours_are_complete_when_particles_are_few(void **state) {
    (void)state;
    const struct box box = {3, {3, 3, 3}};
    for (size_t count = 2; count < 70; count++) {
        struct particles particles;
        struct neighbours neighbours;
        make_gas(&particles, &box, count, 1);
        for (int kind = NEIGHBOURS_HALF; kind <= NEIGHBOURS_FULL; kind++) {
            assert_ok(
                mf_neighbours_init(&neighbours, (enum neighbours_kind)kind, &box, count, 1.2, 0.2));
            assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
            uint8_t *entries = count_entries(&neighbours);
            check_entries(&neighbours, entries);
            check_complete(&neighbours, entries, &particles, neighbours.range * (1 - 1e-6));
            mf_memory_free(entries);
            mf_neighbours_clear(&neighbours);
        }
        mf_particles_clear(&particles);
    }
}

/// So dense that cells are narrower than the range: along no, some and all axes, and in two
/// dimensions.
static void test_neighbours_are_complete_when_there_are_several_cells_to_the_range(void **state) {
    (void)state;
    static const struct {
        struct box box;
        size_t count;
        int range_cells[3];
    } cases[] = {
        {{3, {9, 8, 10}}, 600, {1, 1, 1}},     {{3, {9, 8, 10}}, 1200, {1, 1, 4}},
        {{3, {9, 8, 10}}, 2000, {1, 2, 4}},    {{3, {9, 8, 10}}, 4000, {2, 2, 4}},
        {{3, {4.1, 8, 4.3}}, 1100, {2, 2, 4}}, {{2, {9, 13, 1}}, 800, {2, 2, 1}},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int kind = NEIGHBOURS_HALF; kind <= NEIGHBOURS_FULL; kind++) {
            struct particles particles;
            struct neighbours neighbours;
            make_gas(&particles, &cases[c].box, cases[c].count, 1);
            assert_ok(mf_neighbours_init(&neighbours, (enum neighbours_kind)kind, &cases[c].box,
                                         cases[c].count, 1.7, 0.3));
            assert_memory_equal(neighbours.range_cells, cases[c].range_cells,
                                sizeof neighbours.range_cells);
            assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
            uint8_t *entries = count_entries(&neighbours);
            check_entries(&neighbours, entries);
            check_complete(&neighbours, entries, &particles, neighbours.range * (1 - 1e-6));
            mf_memory_free(entries);
            mf_neighbours_clear(&neighbours);
            mf_particles_clear(&particles);
        }
}

/// All on one spot: a list of all pairs, but no more memory than that.
static void test_neighbours_are_complete_when_all_particles_crowd_in_one_cell(void **state) {
    (void)state;
    enum { COUNT = 700 };
    const struct box box = {3, {8, 8, 8}};
    struct particles particles;
    struct neighbours neighbours;
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &box, COUNT, 1, 0.3));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    uint8_t *entries = count_entries(&neighbours);
    check_entries(&neighbours, entries);
    assert_int_equal(check_complete(&neighbours, entries, &particles, 1), COUNT * (COUNT - 1) / 2);
    assert_true(neighbours.list_capacity < 2 * mf_neighbours_entries(&neighbours));
    mf_memory_free(entries);
    mf_neighbours_clear(&neighbours);
    mf_particles_clear(&particles);
}

/// Entries beyond the range would cost time in every step.
static void test_neighbours_list_only_pairs_in_range_when_built(void **state) {
    (void)state;
    const struct box box = {3, {8, 7, 6}};
    struct particles particles;
    struct neighbours neighbours;
    make_gas(&particles, &box, 500, 1);
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &box, 500, 1.2, 0.3));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    const double limit = neighbours.range * neighbours.range * (1 + 1e-5);
    for (size_t i = 0; i < 500; i++)
        for (size_t k = neighbours.start[i]; k < neighbours.stop[i]; k++)
            assert_true(square_distance(&particles, i, (size_t)neighbours.list[k]) < limit);
    // What fills the rows is no pair: collapsed systems are told by their pairs.
    size_t pairs = 0;
    for (size_t i = 0; i < 500; i++)
        for (size_t j = 0; j < i; j++)
            pairs += square_distance(&particles, i, j) < neighbours.range * neighbours.range;
    assert_in_range(mf_neighbours_listed(&neighbours), pairs,
                    pairs + 1); // one may be at the very range
    assert_true(mf_neighbours_entries(&neighbours) > pairs + 500);
    mf_neighbours_clear(&neighbours);
    mf_particles_clear(&particles);
}

static void
test_neighbours_are_stale_when_a_particle_moved_half_the_skin_in_small_steps(void **state) {
    (void)state;
    const struct box box = {3, {6, 6, 6}};
    struct particles particles;
    struct neighbours neighbours;
    make_gas(&particles, &box, 100, 1);
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &box, 100, 1, 0.4));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    assert_false(mf_neighbours_are_stale(&neighbours, &particles));
    for (int step = 0; step < 19; step++) {
        particles.position[2][57] += 0.01;
        assert_false(mf_neighbours_are_stale(&neighbours, &particles));
    }
    particles.position[2][57] += 0.0101;
    assert_true(mf_neighbours_are_stale(&neighbours, &particles));
    particles.position[2][57] -= 0.02;
    assert_false(mf_neighbours_are_stale(&neighbours, &particles));
    particles.position[0][3] += 6; // whole boxes count: positions since the build are unwrapped
    assert_true(mf_neighbours_are_stale(&neighbours, &particles));
    mf_neighbours_clear(&neighbours);
    mf_particles_clear(&particles);
}

/// A restart knows the positions at the last build and the order of the particles, not the list.
static void test_neighbours_rebuild_gives_the_same_list_when_restarted(void **state) {
    (void)state;
    const struct box box = {3, {6, 5, 7}};
    for (int kind = NEIGHBOURS_HALF; kind <= NEIGHBOURS_FULL; kind++) {
        struct particles particles;
        struct neighbours neighbours, restarted;
        make_gas(&particles, &box, 400, 2);
        assert_ok(mf_neighbours_init(&neighbours, (enum neighbours_kind)kind, &box, 400, 1.1, 0.5));
        assert_ok(mf_neighbours_init(&restarted, (enum neighbours_kind)kind, &box, 400, 1.1, 0.5));
        for (int step = 0; step < 300; step++) {
            drift(&particles, 0.01);
            if (mf_neighbours_are_stale(&neighbours, &particles))
                assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
        }
        assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
        for (int step = 0; step < 5; step++)
            drift(&particles, 0.01);
        double x = particles.position[0][17];
        for (int d = 0; d < 3; d++)
            memcpy(restarted.built[d], neighbours.built[d], 400 * sizeof(double));
        assert_ok(mf_neighbours_rebuild(&restarted, &particles));
        assert_identical(particles.position[0][17], x);
        assert_memory_equal(restarted.start, neighbours.start, 400 * sizeof(size_t));
        assert_memory_equal(restarted.stop, neighbours.stop, 400 * sizeof(size_t));
        assert_memory_equal(restarted.list, neighbours.list,
                            mf_neighbours_entries(&neighbours) * sizeof *neighbours.list);
        for (int d = 0; d < 3; d++)
            assert_memory_equal(restarted.built[d], neighbours.built[d], 400 * sizeof(double));
        // The fractions are those of the present positions again.
        assert_int_equal(particles.fraction[0][17], box_fraction(x, 1 / box.length[0]));
        mf_neighbours_clear(&neighbours);
        mf_neighbours_clear(&restarted);
        mf_particles_clear(&particles);
    }
}

struct seen {
    double *squares;
    size_t count, capacity;
};

static void remember(void *context, const float *squared_distances, size_t count) {
    struct seen *seen = context;
    assert_true(seen->count + count <= seen->capacity);
    for (size_t k = 0; k < count; k++)
        seen->squares[seen->count++] = squared_distances[k];
}

static int compare_doubles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void check_visit(const struct box *box, size_t count, double range) {
    struct particles particles;
    struct neighbours neighbours;
    make_gas(&particles, box, count, 1);
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, box, count, 1.4, 0.3));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    struct seen seen = {.capacity = count * count}, expected = {.capacity = count * count};
    seen.squares = mf_memory_zeroed(seen.capacity, sizeof(double));
    expected.squares = mf_memory_zeroed(expected.capacity, sizeof(double));
    assert_non_null(seen.squares);
    assert_non_null(expected.squares);
    mf_neighbours_visit_distances(&neighbours, &particles, range, remember, &seen);
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++) {
            const double square = square_distance(&particles, i, j);
            if (square < range * range)
                expected.squares[expected.count++] = square;
        }
    assert_true(expected.count > 0);
    assert_int_equal(seen.count, expected.count);
    qsort(seen.squares, seen.count, sizeof(double), compare_doubles);
    qsort(expected.squares, expected.count, sizeof(double), compare_doubles);
    for (size_t k = 0; k < seen.count; k++)
        assert_close_relative(seen.squares[k], expected.squares[k], 1e-6); // single precision
    mf_memory_free(seen.squares);
    mf_memory_free(expected.squares);
    mf_neighbours_clear(&neighbours);
    mf_particles_clear(&particles);
}

static void test_neighbours_visit_distances_finds_all_pairs_when_in_range(void **state) {
    (void)state;
    check_visit(&(struct box){3, {5.5, 6.5, 4.5}}, 600, 1.4);
    check_visit(&(struct box){3, {5.5, 6.5, 4.5}}, 600, 0.7);
    check_visit(&(struct box){3, {2.9, 2.9, 2.9}}, 300, 1.4);
    check_visit(&(struct box){2, {9.5, 6.5, 1}}, 300, 1.4);
    check_visit(&(struct box){2, {9.5, 6.5, 1}}, 300, 1.1);
}

/// One pair at a distance of cutoff, less up to 5e-12 of it, in a random direction, and no skin:
/// distances in single precision are as often beyond the cutoff as within.
static void check_very_cutoff(const struct box *box, double cutoff) {
    enum { TRIES = 500 };
    struct rng_sequence sequence = mf_rng_sequence_begin(11, RNG_PLACEMENT, 0, 0);
    struct particles particles;
    struct neighbours neighbours;
    assert_ok(mf_particles_init(&particles, box, 2));
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_FULL, box, 2, cutoff, 0));
    for (int k = 0; k < TRIES; k++) {
        double direction[3], square = 0;
        for (int d = 0; d < box->dimensions; d++) {
            direction[d] = mf_rng_sequence_uniform(&sequence) - 0.5;
            square += direction[d] * direction[d];
        }
        for (int d = 0; d < box->dimensions; d++) {
            particles.position[d][0] = box->length[d] * mf_rng_sequence_uniform(&sequence);
            particles.position[d][1] =
                particles.position[d][0] + direction[d] / sqrt(square) * cutoff * (1 - 1e-14 * k);
        }
        assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
        // Wrapping may have rounded it beyond.
        if (square_distance(&particles, 0, 1) < cutoff * cutoff)
            assert_int_equal(neighbours.stop[0] - neighbours.start[0], 1);
    }
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

static void test_neighbours_list_a_pair_when_it_is_at_the_very_cutoff(void **state) {
    (void)state;
    static const char *const instruction_sets[] = {"portable", "avx2", "avx512"};
    for (int s = 0; s < 3; s++) {
        if (!mf_simd_select(instruction_sets[s]))
            continue;
        check_very_cutoff(&(struct box){3, {4.1, 3.3, 3.9}}, 1.3);
        check_very_cutoff(&(struct box){2, {7.5, 6.1, 1}}, 1.3);
        check_very_cutoff(&(struct box){3, {1300, 2.7, 2.9}}, 1.3);
    }
}

static void test_neighbours_init_refuses_when_the_box_is_below_two_cutoffs(void **state) {
    (void)state;
    struct neighbours neighbours;
    assert_fails(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &(struct box){3, {6, 1.99, 6}},
                                    10, 1, 0.3),
                 STATUS_BAD_INPUT, "twice the cutoff");
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &(struct box){2, {6, 2.1, 1}}, 10, 1,
                                 0.3));
    assert_close(neighbours.range, 1.05, 1e-12); // the skin gives way
    assert_close(neighbours.skin, 0.05, 1e-12);
    mf_neighbours_clear(&neighbours);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_neighbours_are_complete_when_a_simulation_is_hot),
        cmocka_unit_test(test_neighbours_are_complete_when_particles_drift_by_many_boxes),
        cmocka_unit_test(test_neighbours_are_complete_when_particles_are_few),
        cmocka_unit_test(test_neighbours_are_complete_when_there_are_several_cells_to_the_range),
        cmocka_unit_test(test_neighbours_are_complete_when_all_particles_crowd_in_one_cell),
        cmocka_unit_test(test_neighbours_list_only_pairs_in_range_when_built),
        cmocka_unit_test(
            test_neighbours_are_stale_when_a_particle_moved_half_the_skin_in_small_steps),
        cmocka_unit_test(test_neighbours_rebuild_gives_the_same_list_when_restarted),
        cmocka_unit_test(test_neighbours_visit_distances_finds_all_pairs_when_in_range),
        cmocka_unit_test(test_neighbours_list_a_pair_when_it_is_at_the_very_cutoff),
        cmocka_unit_test(test_neighbours_init_refuses_when_the_box_is_below_two_cutoffs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
