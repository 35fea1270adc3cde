// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hybrid.h"

#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/testing.h"

enum { PAIRS = 3, COUNT = 200 };

static const struct box box = {.dimensions = 3, .length = {4, 4, 4}};
static const struct pair_histogram bins = {.width = 0.1, .bins = 10};

static void make_table(struct table *table, double a) {
    struct formula_soft_repulsion_parameters soft = {a, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &soft};
    assert_ok(mf_table_init_potential(table, &curve));
}

/// The time step that a fluid begins with.
static double first_step(const struct composition *composition, const struct table *table) {
    struct hybrid hybrid;
    assert_ok(mf_hybrid_init(&hybrid, &box, composition, table, NULL, NULL, &bins, 1, 3, NULL));
    const double step = hybrid.simulation.setup.time_step;
    mf_hybrid_clear(&hybrid);
    return step;
}

/// It follows the fastest pairs, whatever their pair type is.
static void test_hybrid_begins_with_the_step_of_the_stiffest_pairs(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(COUNT);
    const struct composition two = {.types = 2, .count = {COUNT / 2, COUNT / 2}};
    struct table soft, stiff;
    make_table(&soft, 60);
    make_table(&stiff, 2000);
    const double slow = first_step(&one, &soft), fast = first_step(&one, &stiff);
    assert_true(fast < 0.5 * slow);
    for (int place = 0; place < PAIRS; place++) {
        struct table part[PAIRS] = {soft, soft, soft}, all;
        part[place] = stiff;
        assert_ok(mf_table_stack(&all, part, PAIRS));
        assert_identical(first_step(&two, &all), fast);
        mf_table_clear(&all);
    }
    mf_table_clear(&soft);
    mf_table_clear(&stiff);
}

/// Without pairs it is a share of the weight's range, over which the forces change.
static void test_hybrid_of_local_densities_alone_has_a_step(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(COUNT);
    struct many_body law;
    struct hybrid hybrid;
    many_bodies_crowd(&law, 0.5, 1.2, 1, 2, &one);
    assert_ok(mf_hybrid_init(&hybrid, &box, &one, NULL, NULL, &law, &(struct pair_histogram){0}, 1,
                             3, NULL));
    assert_true(hybrid.simulation.setup.time_step > 0.01 && hybrid.longest < 0.12);
    mf_hybrid_clear(&hybrid);
    mf_many_body_clear(&law);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hybrid_begins_with_the_step_of_the_stiffest_pairs),
        cmocka_unit_test(test_hybrid_of_local_densities_alone_has_a_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
