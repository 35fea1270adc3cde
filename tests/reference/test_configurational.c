// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configurational temperature of the fast loop against that of the plain one, and Laplacians of
// what acts beside the pairs against differences of its forces.
#include "forces/configurational.h"

#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/molecules.h"
#include "shared/pairs.h"
#include "shared/slow_forces.h"
#include "shared/testing.h"

#include <math.h>

/// What the order of double-precision additions can change.
static const double rounding = 1e-11;

/// Both parts of the temperature, with forces beside the pairs if there are any.
static void compare(const struct pairs_system *system, const struct pair_law *law,
                    double *const *beside, double *const *others) {
    struct particles particles;
    struct neighbours neighbours;
    double fast[2], slow[2];
    pairs_make(&particles, &neighbours, system, law);
    assert_ok(mf_configurational(law->potential, &law->composition, law->temperature, &particles,
                                 &neighbours, beside, others, &fast[0], &fast[1]));
    assert_ok(slow_forces_configurational(law->potential, &law->composition, law->temperature,
                                          &particles, &neighbours, beside, others, &slow[0],
                                          &slow[1]));
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
        compare(&systems[s], &soft, NULL, NULL);
        compare(&systems[s], &jump, NULL, NULL);
    }
}

/// Three tables of two cutoffs, and forces beside the pairs.
static void test_mixture_has_the_temperature_of_the_plain_loop(void **state) {
    static const struct pairs_system system = {{3, {5.1, 5.6, 6.3}}, 443, PAIRS_RANDOM, 0.05};
    static double x[443], y[443], z[443];
    static double *const beside[3] = {x, y, z}, *const others[3] = {z, x, y};
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
    compare(&system, &law, NULL, NULL);
    compare(&system, &law, beside, others);
    mf_table_clear(&potential);
}

static bool is_any(const struct interaction *kind) {
    (void)kind;
    return true;
}

/// −Σ ∂F/∂x by central differences of all forces beside the pairs, one coordinate after the other.
static double divergence(struct simulation *simulation) {
    static const double h = 1e-5;
    struct particles *particles = &simulation->particles;
    double *force[3] = {NULL}, sum = 0;
    for (int d = 0; d < 3; d++)
        force[d] = mf_memory_zeroed(particles->count, sizeof *force[d]);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const double here = particles->position[d][k];
            for (int side = -1; side <= 1; side += 2) {
                particles->position[d][k] = here + side * h;
                assert_ok(mf_simulation_compute_potential(simulation));
                for (int e = 0; e < 3; e++)
                    memset(force[e], 0, particles->count * sizeof *force[e]);
                assert_ok(mf_simulation_interaction_forces(simulation, is_any, force));
                sum -= side * force[d][k] / (2 * h);
            }
            particles->position[d][k] = here;
        }
    assert_ok(mf_simulation_compute_potential(simulation));
    for (int d = 0; d < 3; d++)
        mf_memory_free(force[d]);
    return sum;
}

static void compare_laplacian(struct simulation *simulation, double tolerance) {
    const double expected = divergence(simulation);
    double found = 0;
    assert_ok(mf_simulation_interaction_laplacian(simulation, &found));
    print_message("%g, by differences %g\n", found, expected);
    assert_true(fabs(expected) > 10);
    assert_close_relative(found, expected, tolerance);
}

/// Terms of all kinds: sets of types, a flat middle, formulas and polynomials, in two dimensions
/// and in three.
static void test_laplacian_of_local_densities_is_the_divergence_of_their_forces(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int kind = 0; kind < 2; kind++) {
            struct many_bodies many;
            struct simulation simulation;
            if (kind == 0)
                many_bodies_mixture(&many, dimensions, 90);
            else
                many_bodies_dpd(&many, dimensions, 90);
            many.fluid.setup.precision = PAIR_DOUBLE;
            many.fluid.setup.placement.jitter = 0.5;
            assert_ok(mf_simulation_init(&simulation, &many.fluid.setup, NULL));
            compare_laplacian(&simulation, 1e-3);
            mf_simulation_clear(&simulation);
            many_bodies_clear(&many);
        }
}

/// Chains with bonds, angles and dihedrals, in a trap.
static void test_laplacian_of_molecules_is_the_divergence_of_their_forces(void **state) {
    (void)state;
    enum { CHAINS = 11, BEADS = 6 };
    static const int type[BEADS] = {0};
    static const struct { double stiffness[3], centre[3]; } trap = {{3, 2, 1}, {2, 2, 2}};
    static const struct molecules_number spring[] = {{"k", 60}, {"length", 0.7}, {NULL, 0}};
    static const struct molecules_number bend[] = {{"k", 12}, {"angle", 110}, {NULL, 0}};
    static const struct molecules_number twist[] = {
        {"k", 4}, {"multiplicity", 3}, {"phase", 20}, {NULL, 0}};
    struct fluid fluid;
    struct molecules molecules = {0};
    struct simulation simulation;
    const struct composition composition = molecules_topology(
        &molecules.topology, molecules_chain(CHAINS, type, BEADS, BONDED_DIHEDRAL, 0),
        (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(&molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    molecules_add_group(&molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_groot_warren(&fluid, CHAINS * BEADS, 0.01);
    molecules_enter(&fluid.setup, &molecules, &composition);
    fluid.setup.interaction[fluid.setup.interactions++] =
        (struct interaction_choice){&mf_harmonic_trap, &trap};
    fluid.setup.precision = PAIR_DOUBLE;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 200));
    compare_laplacian(&simulation, 1e-5);
    mf_simulation_clear(&simulation);
    mf_molecules_clear(&molecules);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_type_has_the_temperature_of_the_plain_loop),
        cmocka_unit_test(test_mixture_has_the_temperature_of_the_plain_loop),
        cmocka_unit_test(test_laplacian_of_local_densities_is_the_divergence_of_their_forces),
        cmocka_unit_test(test_laplacian_of_molecules_is_the_divergence_of_their_forces),
    };
    return cmocka_run_group_tests(tests, pairs_begin, pairs_end);
}
