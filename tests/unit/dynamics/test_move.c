// SPDX-License-Identifier: GPL-3.0-or-later
//
// The vector kernels of Metropolis moves against sums over all pairs in double precision.
#include "base/simd.h"
#include "curves/formula.h"
#include "dynamics/metropolis.h"
#include "dynamics/move.h"
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <string.h>

enum { COUNT = 400, BINS = 30, MAX_PAIRS = 6 };

/// Of changes between energies of up to 10 k_B T, and in proportion beyond. Measured: 1.8e-5 of
/// Lennard-Jones, whose core is steep, 1.6e-6 of soft potentials.
static const double energy_tolerance = 3e-5;

/// Σ_j Φ of a particle at a point [k_B T_0], and its r·F.
static double energy_at(const struct metropolis *metropolis, size_t self, const double at[3],
                        double *virial) {
    const struct particles *particles = &metropolis->particles;
    double sum = 0;
    for (size_t j = 0; j < particles->count; j++) {
        double square = 0, value, slope;
        for (int d = 0; d < particles->box.dimensions; d++) {
            const double x =
                box_nearest(at[d] - particles->position[d][j], particles->box.length[d]);
            square += x * x;
        }
        if (j == self || sqrt(square) >= metropolis->law.potential->cutoff)
            continue;
        const int pair = mf_composition_pair_of_ids(&metropolis->law.composition,
                                                    particles->id[self], particles->id[j]);
        mf_table_evaluate_pair(metropolis->law.potential, pair, sqrt(square), &value, &slope, NULL);
        sum += value;
        *virial -= sqrt(square) * slope;
    }
    return sum;
}

static void check_changes(const struct metropolis *metropolis) {
    const struct particles *particles = &metropolis->particles;
    double largest = 0;
    for (size_t k = 0; k < COUNT; k++) {
        double from[3] = {0}, moved[3] = {0}, unused = 0;
        int32_t to[3] = {0};
        for (int d = 0; d < particles->box.dimensions; d++) {
            from[d] = particles->position[d][k];
            moved[d] = from[d] + metropolis->step * (d == (int)(k % 2) ? 0.9 : -0.4);
            to[d] = box_fraction(moved[d], 1 / particles->box.length[d]);
        }
        const double before = energy_at(metropolis, k, from, &unused);
        const double after = energy_at(metropolis, k, moved, &unused);
        const struct neighbours *neighbours = &metropolis->neighbours;
        const double fast = mf_move_energy_change(&metropolis->law, particles, k,
                                                  neighbours->list + neighbours->start[k],
                                                  neighbours->stop[k] - neighbours->start[k], to);
        const double scale = fmax(1, 0.1 * (fabs(before) + fabs(after)));
        largest = fmax(largest, fabs(fast - (after - before)) / scale);
    }
    print_message("%s: largest error %.1e\n", mf_simd_name(), largest);
    assert_true(largest < energy_tolerance);
}

/// Σ_j Φ of a particle where it is, as if it had the id of another one, without that one.
static double energy_as(const struct metropolis *metropolis, size_t self, size_t other,
                        uint32_t id) {
    const struct particles *particles = &metropolis->particles;
    double sum = 0;
    for (size_t j = 0; j < particles->count; j++) {
        double square = 0, value;
        for (int d = 0; d < particles->box.dimensions; d++)
            square += pow(box_nearest(particles->position[d][self] - particles->position[d][j],
                                      particles->box.length[d]),
                          2);
        if (j == self || j == other || sqrt(square) >= metropolis->law.potential->cutoff)
            continue;
        const int pair =
            mf_composition_pair_of_ids(&metropolis->law.composition, id, particles->id[j]);
        mf_table_evaluate_pair(metropolis->law.potential, pair, sqrt(square), &value, NULL, NULL);
        sum += value;
    }
    return sum;
}

/// Each with one that is far away, and with its nearest on the list, which does not count.
static void check_type_changes(const struct metropolis *metropolis) {
    const struct particles *particles = &metropolis->particles;
    const struct neighbours *neighbours = &metropolis->neighbours;
    double largest = 0;
    for (size_t k = 0; k < COUNT; k++) {
        const int32_t *list = neighbours->list + neighbours->start[k];
        const size_t count = neighbours->stop[k] - neighbours->start[k];
        for (size_t n = 0; n <= count; n++) {
            const size_t other = n < count ? (size_t)list[n] : (k + COUNT / 2) % COUNT;
            const double before = energy_as(metropolis, k, other, particles->id[k]);
            const double after = energy_as(metropolis, k, other, particles->id[other]);
            const double fast =
                mf_move_type_change(&metropolis->law, particles, k, other, list, count);
            const double scale = fmax(1, 0.1 * (fabs(before) + fabs(after)));
            largest = fmax(largest, fabs(fast - (after - before)) / scale);
            n += n < count ? 7 : 0; // some of the list
        }
    }
    print_message("%s: largest error of a type's change %.1e\n", mf_simd_name(), largest);
    assert_true(largest < energy_tolerance);
}

static void check_sums(struct metropolis *metropolis) {
    const struct composition *composition = &metropolis->law.composition;
    const struct rdf_bins bins = {0, metropolis->law.potential->cutoff / BINS, BINS};
    const size_t pairs = (size_t)mf_composition_pairs(composition);
    uint32_t counts[MAX_PAIRS * BINS + 1] = {0};
    double histogram[MAX_PAIRS * BINS] = {0}, energy = 0, virial = 0, differences = 0;
    struct pair_sums sums;
    mf_rdf_count_pairs(&bins, composition, &metropolis->particles, &metropolis->neighbours,
                       histogram);
    for (size_t k = 0; k < COUNT; k++) {
        double at[3] = {0};
        for (int d = 0; d < metropolis->particles.box.dimensions; d++)
            at[d] = metropolis->particles.position[d][k];
        energy += 0.5 * energy_at(metropolis, k, at, &virial);
    }
    assert_ok(mf_metropolis_count(
        metropolis, &(struct pair_histogram){0, bins.width, BINS, pairs, counts}, &sums));
    assert_close(sums.energy, energy, energy_tolerance * COUNT);
    assert_close(sums.virial, 0.5 * virial, 10 * energy_tolerance * COUNT);
    // The list is full, and distances at an edge are rounded to either side.
    for (size_t a = 0; a < pairs * BINS; a++)
        differences += fabs(counts[a] - 0.5 * histogram[a]);
    assert_true(differences <= 4);
}

/// Without bins for each pair type, a mixture's pairs are counted together.
static void check_counts_together(struct metropolis *metropolis) {
    const double width = metropolis->law.potential->cutoff / BINS;
    uint32_t apart[MAX_PAIRS * BINS + 1] = {0}, together[BINS + 1] = {0};
    const size_t pairs = (size_t)mf_composition_pairs(&metropolis->law.composition);
    struct pair_sums sums;
    assert_ok(mf_metropolis_count(metropolis,
                                  &(struct pair_histogram){0, width, BINS, pairs, apart}, &sums));
    assert_ok(mf_metropolis_count(metropolis, &(struct pair_histogram){0, width, BINS, 0, together},
                                  &sums));
    for (size_t k = 0; k < BINS; k++) {
        uint32_t sum = 0;
        for (size_t pair = 0; pair < pairs; pair++)
            sum += apart[pair * BINS + k];
        assert_int_equal(sum, together[k]);
    }
}

static void check_all_sets(const struct fluid *fluid) {
    static const char *const sets[] = {"portable", "avx2", "avx512"};
    const char *best = mf_simd_name();
    struct metropolis metropolis;
    assert_ok(mf_metropolis_init(&metropolis, &fluid->setup.box, &fluid->setup.composition,
                                 &fluid->potential, fluid->setup.temperature, 3));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 60));
    // A list has room for the moves of the sweep that it was looked at for, and no more.
    assert_ok(mf_metropolis_refresh(&metropolis));
    for (int s = 0; s < 3; s++) {
        if (!mf_simd_select(sets[s]))
            continue;
        check_changes(&metropolis);
        if (composition_is_mixed(&fluid->setup.composition))
            check_type_changes(&metropolis);
        check_sums(&metropolis);
        check_counts_together(&metropolis);
    }
    assert_true(mf_simd_select(best));
    mf_metropolis_clear(&metropolis);
}

static void test_move_is_right_when_cores_are_hard(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_lennard_jones(&fluid, COUNT, 0.01);
    check_all_sets(&fluid);
    fluid_clear(&fluid);
}

static void test_move_is_right_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, COUNT, 0.01);
    check_all_sets(&fluid);
    fluid_clear(&fluid);
}

/// More pairs in range than fit into a batch.
static void test_move_is_right_when_there_are_many_neighbours(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, COUNT, 0.01);
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = 2.2;
    check_all_sets(&fluid);
    fluid_clear(&fluid);
}

/// Six potentials of different cutoffs, where a bead's type follows from its id.
static void test_move_is_right_when_the_beads_are_of_three_types(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_mixture(&fluid, COUNT, 0.01);
    check_all_sets(&fluid);
    fluid_clear(&fluid);
}

static void test_move_is_right_when_a_flat_scene_has_two_types(void **state) {
    (void)state;
    struct fluid fluid;
    struct table parts[3];
    fluid_soft_discs(&fluid, COUNT, 0.01);
    for (int pair = 0; pair < 3; pair++) {
        struct formula_soft_repulsion_parameters soft = {20 + 15 * pair, 0.8 + 0.1 * pair};
        const struct curve curve = {&mf_formula_soft_repulsion, &soft};
        assert_ok(mf_table_init_potential(&parts[pair], &curve));
    }
    mf_table_clear(&fluid.potential);
    assert_ok(mf_table_stack(&fluid.potential, parts, 3));
    fluid.setup.composition = (struct composition){.types = 2, .count = {150, COUNT - 150}};
    check_all_sets(&fluid);
    // More pairs in range than fit into a batch.
    for (int d = 0; d < 2; d++)
        fluid.setup.box.length[d] = 2.2 * fluid.potential.cutoff;
    check_all_sets(&fluid);
    for (int pair = 0; pair < 3; pair++)
        mf_table_clear(&parts[pair]);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_move_is_right_when_cores_are_hard),
        cmocka_unit_test(test_move_is_right_when_the_scene_is_flat),
        cmocka_unit_test(test_move_is_right_when_there_are_many_neighbours),
        cmocka_unit_test(test_move_is_right_when_the_beads_are_of_three_types),
        cmocka_unit_test(test_move_is_right_when_a_flat_scene_has_two_types),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
