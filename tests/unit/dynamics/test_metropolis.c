// SPDX-License-Identifier: GPL-3.0-or-later
//
// Metropolis sweeps: the order of the moves is none of the places' business, or else they would not
// keep the canonical distribution. What they sample is tested in physics/test_monte_carlo.
#include "dynamics/metropolis.h"

#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/testing.h"

enum { PARTICLES = 400, SWEEPS = 200 };

/// Positions by id after sweeps that begin with a new list each, or with one when it is due.
static void find_positions(bool sorted_often, double position[PARTICLES][3]) {
    struct formula_soft_repulsion_parameters parameters = {25, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    const struct box box = {3, {5, 5.1, 5.2}};
    const struct composition composition = mf_composition_of_one(PARTICLES);
    struct metropolis metropolis;
    struct table potential;
    assert_ok(mf_table_init_potential(&potential, &curve));
    assert_ok(mf_metropolis_init(&metropolis, &box, &composition, &potential, 1, 9));
    metropolis.step = 0.04; // so small that the list holds for several sweeps
    for (int n = 0; n < SWEEPS; n++) {
        if (sorted_often)
            assert_ok(mf_metropolis_refresh(&metropolis));
        assert_ok(mf_metropolis_run(&metropolis, 1));
    }
    const struct particles *particles = &metropolis.particles;
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < PARTICLES; k++)
            position[particles->id[k]][d] =
                particles->position[d][k] + particles->image[d][k] * box.length[d];
    mf_metropolis_clear(&metropolis);
    mf_table_clear(&potential);
}

/// A sum of energies in another order may decide one move in a million otherwise.
static void test_sweeps_are_the_same_when_particles_are_sorted_often(void **state) {
    (void)state;
    static double often[PARTICLES][3], seldom[PARTICLES][3];
    find_positions(true, often);
    find_positions(false, seldom);
    for (int k = 0; k < PARTICLES; k++)
        for (int d = 0; d < 3; d++)
            assert_close(often[k][d], seldom[k][d], 1e-12);
}

/// Its owner clears it all the same.
static void test_metropolis_is_empty_when_the_box_is_too_small(void **state) {
    (void)state;
    struct formula_soft_repulsion_parameters parameters = {25, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    const struct box box = {3, {2.05, 3, 3}};
    const struct composition composition = mf_composition_of_one(30);
    struct metropolis metropolis;
    struct table potential;
    assert_ok(mf_table_init_potential(&potential, &curve));
    assert_fails(mf_metropolis_init(&metropolis, &box, &composition, &potential, 1, 9),
                 STATUS_BAD_INPUT, "too small for Monte Carlo");
    assert_null(metropolis.order);
    mf_metropolis_clear(&metropolis);
    mf_table_clear(&potential);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sweeps_are_the_same_when_particles_are_sorted_often),
        cmocka_unit_test(test_metropolis_is_empty_when_the_box_is_too_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
