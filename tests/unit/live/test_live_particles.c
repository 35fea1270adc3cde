// SPDX-License-Identifier: GPL-3.0-or-later
//
// Energies of single particles against what the pair kernels sum, and where they can be told by
// hand.
#include "live/live_particles.h"

#include "base/memory.h"
#include "shared/is_close.h"
#include "shared/pairs.h"
#include "shared/testing.h"

/// Half of them belongs to either particle of a pair: their sum is the energy of the kernels.
static void test_energies_sum_to_what_the_kernels_sum(void **state) {
    static const struct pairs_system systems[] = {
        {{3, {5.1, 4.6, 6.3}}, 443, PAIRS_RANDOM, 0.25},
        {{3, {5.1, 4.6, 6.3}}, 120, PAIRS_CLUSTERED, 0.3},
        {{2, {9.2, 8.7}}, 260, PAIRS_RANDOM, 0.2},
    };
    (void)state;
    struct pair_law law = pairs_law(&pairs_tables.soft, NULL);
    law.precision = PAIR_DOUBLE;
    for (size_t s = 0; s < sizeof systems / sizeof *systems; s++) {
        struct particles particles;
        struct neighbours neighbours;
        struct pair_sums sums;
        float *energy = mf_memory_zeroed(systems[s].count, sizeof *energy);
        double sum = 0;
        assert_non_null(energy);
        pairs_make(&particles, &neighbours, &systems[s], &law);
        mf_pair_forces(&law, &particles, &neighbours, 0, PAIR_FORCES_AND_SUMS, &sums);
        mf_live_particles_energies(law.potential, &law.composition, &particles, &neighbours,
                                   energy);
        for (size_t k = 0; k < particles.count; k++)
            sum += (double)energy[k];
        assert_true(sums.energy > 100);
        assert_close_relative(sum, sums.energy, 1e-5);
        mf_memory_free(energy);
        mf_particles_clear(&particles);
        mf_neighbours_clear(&neighbours);
    }
}

/// Three particles on a line, the first two across the box's face: 0.4 apart, and 0.7 to the third.
/// The soft repulsion is ½ a (1 − r)².
static void test_energy_is_that_of_the_particle_with_this_id(void **state) {
    static const double x[] = {4.9, 0.3, 1.0};
    const struct pairs_system system = {{3, {5, 5, 5}}, 3, PAIRS_RANDOM, 0.3};
    const struct pair_law law = pairs_law(&pairs_tables.soft, NULL);
    struct particles particles;
    struct neighbours neighbours;
    float energy[3];
    double first, second;
    (void)state;
    pairs_make(&particles, &neighbours, &system, &law);
    for (size_t k = 0; k < 3; k++) {
        particles.position[0][k] = x[particles.id[k]];
        particles.position[1][k] = particles.position[2][k] = 2;
    }
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    mf_live_particles_energies(law.potential, &law.composition, &particles, &neighbours, energy);
    mf_table_evaluate(law.potential, 0.4, &first, NULL, NULL);
    mf_table_evaluate(law.potential, 0.7, &second, NULL, NULL);
    assert_close_relative(energy[0], 0.5 * first, 1e-6);
    assert_close_relative(energy[1], 0.5 * (first + second), 1e-6);
    assert_close_relative(energy[2], 0.5 * second, 1e-6);
    assert_close_relative(first / second, 4, 1e-3); // (0.6/0.3)²
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energies_sum_to_what_the_kernels_sum),
        cmocka_unit_test(test_energy_is_that_of_the_particle_with_this_id),
    };
    return cmocka_run_group_tests(tests, pairs_begin, pairs_end);
}
