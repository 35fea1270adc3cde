// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configurational temperature of the fast loop against that of the plain one.
#include "forces/configurational.h"

#include "shared/is_close.h"
#include "shared/pairs.h"
#include "shared/testing.h"

/// What the order of double-precision additions can change.
static const double rounding = 1e-11;

/// Both parts of the temperature, with forces beside the pairs if there are any.
static void compare(const struct pairs_system *system, const struct pair_law *law,
                    double *const *beside) {
    struct particles particles;
    struct neighbours neighbours;
    double fast[2], slow[2];
    pairs_make(&particles, &neighbours, system, law);
    assert_ok(mf_configurational(law->potential, &law->composition, law->temperature, &particles,
                                 &neighbours, beside, &fast[0], &fast[1]));
    assert_ok(mf_reference_configurational(law->potential, &law->composition, law->temperature,
                                           &particles, &neighbours, beside, &slow[0], &slow[1]));
    assert_true(slow[0] > 0);
    assert_close_relative(fast[0], slow[0], rounding);
    assert_close_relative(fast[1], slow[1], rounding);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

/// The soft repulsion ends smoothly; Lennard-Jones with a jump of the force. In the cluster rows
/// are longer than what is looked at together.
static void test_one_type_has_the_temperature_of_the_plain_loop(void **state) {
    static const struct pairs_system systems[] = {
        {{3, {5.1, 5.6, 6.3}}, 443, PAIRS_RANDOM, 0.05},
        {{3, {5.1, 5.6, 6.3}}, 400, PAIRS_CLUSTERED, 0.05},
        {{2, {9.2, 8.7}}, 260, PAIRS_RANDOM, 0.2},
    };
    (void)state;
    for (size_t s = 0; s < sizeof systems / sizeof *systems; s++) {
        const struct pair_law soft = pairs_law(&pairs_tables.soft, NULL);
        const struct pair_law jump = pairs_law(&pairs_tables.lennard_jones, NULL);
        compare(&systems[s], &soft, NULL);
        compare(&systems[s], &jump, NULL);
    }
}

/// Three tables of two cutoffs, and forces beside the pairs.
static void test_mixture_has_the_temperature_of_the_plain_loop(void **state) {
    static const struct pairs_system system = {{3, {5.1, 5.6, 6.3}}, 443, PAIRS_RANDOM, 0.05};
    static double x[443], y[443], z[443];
    static double *const beside[3] = {x, y, z};
    const struct table parts[] = {pairs_tables.soft, pairs_tables.lennard_jones, pairs_tables.soft};
    struct table potential;
    (void)state;
    for (size_t k = 0; k < system.count; k++) {
        x[k] = (double)k;
        y[k] = 3;
    }
    assert_ok(mf_table_stack(&potential, parts, 3));
    struct pair_law law = pairs_law(&potential, NULL);
    law.composition = (struct composition){.types = 2, .count = {120, 323}};
    compare(&system, &law, NULL);
    compare(&system, &law, beside);
    mf_table_clear(&potential);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_type_has_the_temperature_of_the_plain_loop),
        cmocka_unit_test(test_mixture_has_the_temperature_of_the_plain_loop),
    };
    return cmocka_run_group_tests(tests, pairs_begin, pairs_end);
}
