// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bonds, angles and dihedrals: energies against a slow sum over terms with other formulas, forces
// against the slopes of energies, the virial against the volume, and the same bits for any number
// of threads and through a restart.
#include "forces/molecules.h"

#include "base/memory.h"
#include "dynamics/dpd_verlet.h"
#include "dynamics/respa.h"
#include "dynamics/simulation.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

// 45 are no multiple of the lanes (forces/bonded.h).
enum { CHAINS = 45, BEADS = 6, LONGEST = 150 };
static const int type[LONGEST] = {0, 1, 1, 0, 1, 0};
static const struct molecules_number spring[] = {{"k", 80}, {"length", 0.6}, {NULL, 0}};
static const struct molecules_number bend[] = {{"k", 40}, {"angle", 100}, {NULL, 0}};
static const struct molecules_number stiff[] = {{"k", 60}, {"angle", 120}, {NULL, 0}};
static const struct molecules_number weak[] = {{"k", 4}, {NULL, 0}};
static const struct molecules_number twist[] = {
    {"k", 3}, {"multiplicity", 3}, {"phase", 40}, {NULL, 0}};
static const struct molecules_number butane[] = {
    {"c0", 1}, {"c1", 2}, {"c2", -1}, {"c3", 0.5}, {NULL, 0}};

/// The second kind of bond has nothing to keep its beads apart, and what it sets free may tear one
/// after a hundred steps: simulations here are shorter, or without pairs.
///
/// Chains of two types with two groups of each order, of which every other term is of the second,
/// and single beads, in the fluid of Groot and Warren with a mixture's tables of one.
struct polymers {
    struct fluid fluid;
    struct molecules molecules;
};

static struct topology_kind make_chains(int64_t count, int beads, int exclude) {
    struct topology_kind chain = molecules_chain(count, type, beads, BONDED_DIHEDRAL, exclude);
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int n = 0; n < chain.terms[order]; n++)
            chain.term[order][n].group = n % 2;
    return chain;
}

/// Of one kind or two, which are then owned.
static void make_kinds(struct polymers *polymers, struct topology_kind first,
                       struct topology_kind second) {
    polymers->molecules = (struct molecules){0};
    const struct composition composition = molecules_topology(&polymers->molecules.topology, first,
                                                              second, 2, (const int64_t[]){30, 20});
    molecules_add_group(&polymers->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(&polymers->molecules, BONDED_BOND, &mf_bond_fene, weak);
    molecules_add_group(&polymers->molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    molecules_add_group(&polymers->molecules, BONDED_ANGLE, &mf_angle_cosine_squared, stiff);
    molecules_add_group(&polymers->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    molecules_add_group(&polymers->molecules, BONDED_DIHEDRAL, &mf_dihedral_ryckaert_bellemans,
                        butane);
    fluid_groot_warren(&polymers->fluid, mf_composition_particles(&composition), 0.005);
    molecules_enter(&polymers->fluid.setup, &polymers->molecules, &composition);
    polymers->fluid.setup.precision = PAIR_DOUBLE;
}

static void make(struct polymers *polymers, int exclude) {
    make_kinds(polymers, make_chains(CHAINS, BEADS, exclude), (struct topology_kind){0});
}

static void clear(struct polymers *polymers) {
    mf_molecules_clear(&polymers->molecules);
    fluid_clear(&polymers->fluid);
}

// The slow sum ------------------------------------------------------------------------------------

static void from_to(const struct simulation *simulation, uint32_t a, uint32_t b, double r[3]) {
    const struct particles *particles = &simulation->particles;
    size_t i = 0, j = 0;
    while (particles->id[i] != a)
        i++;
    while (particles->id[j] != b)
        j++;
    for (int d = 0; d < 3; d++)
        r[d] = box_nearest(particles->position[d][j] - particles->position[d][i],
                           particles->box.length[d]);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3]) {
    for (int d = 0; d < 3; d++)
        c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/// q of a term from textbook formulas: arc cosines, and the sign of a dihedral from a triple
/// product.
static double slow_q(const struct simulation *simulation, int order, const uint32_t *id) {
    double u[3], v[3], w[3], a[3], b[3];
    from_to(simulation, id[0], id[1], u);
    if (order == BONDED_BOND)
        return sqrt(dot(u, u));
    from_to(simulation, id[1], id[2], v);
    if (order == BONDED_ANGLE)
        return acos(-dot(u, v) / sqrt(dot(u, u) * dot(v, v)));
    from_to(simulation, id[2], id[3], w);
    cross(u, v, a);
    cross(v, w, b);
    const double phi = acos(dot(a, b) / sqrt(dot(a, a) * dot(b, b)));
    return dot(u, b) > 0 ? phi : -phi; // clockwise, seen along the middle bond
}

static double slow_energy_of(const struct simulation *simulation, const struct molecules *molecules,
                             const struct topology_kind *kind) {
    double sum = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int64_t m = 0; m < kind->count; m++)
            for (int n = 0; n < kind->terms[order]; n++) {
                const struct topology_term *term = &kind->term[order][n];
                uint32_t id[BONDED_MAX_TERM_BEADS];
                double energy;
                for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
                    id[k] = topology_id(kind, m, term->bead[k]);
                mf_bonded_value(&molecules->group[order][term->group].curve,
                                slow_q(simulation, order, id), &energy, NULL);
                sum += energy;
            }
    return sum;
}

static double slow_energy(const struct simulation *simulation, const struct molecules *molecules) {
    double sum = 0;
    for (int k = 0; k < molecules->topology.kinds; k++)
        sum += slow_energy_of(simulation, molecules, &molecules->topology.kind[k]);
    return sum;
}

static void test_energy_is_that_of_a_slow_sum_over_terms(void **state) {
    (void)state;
    struct polymers polymers;
    struct simulation simulation;
    make(&polymers, 0);
    polymers.fluid.setup.potential = NULL;
    polymers.fluid.setup.omega = NULL;
    polymers.fluid.setup.integrator = &mf_velocity_verlet;
    assert_ok(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL));
    for (int n = 0; n < 3; n++) {
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, 30));
        const double slow = slow_energy(&simulation, &polymers.molecules);
        assert_true(slow > 100);
        assert_close_relative(simulation.sums.energy, slow, 1e-10);
    }
    mf_simulation_clear(&simulation);
    clear(&polymers);
}

// Slopes ------------------------------------------------------------------------------------------

static double energy_of(struct simulation *simulation) {
    assert_ok(mf_simulation_compute_potential(simulation));
    return simulation->sums.energy;
}

/// Of one in `each` particles.
static void assert_forces_are_slopes(struct simulation *simulation, size_t each) {
    static const double h = 1e-5;
    for (int d = 0; d < 3; d++) {
        double sum = 0;
        for (size_t k = 0; k < simulation->particles.count; k += each) {
            double *x = &simulation->particles.position[d][k];
            const double here = *x;
            *x = here + h;
            const double above = energy_of(simulation);
            *x = here - h;
            const double below = energy_of(simulation);
            *x = here;
            energy_of(simulation);
            const double force = simulation->particles.force[d][k];
            assert_close(force, (below - above) / (2 * h), 2e-5 * (10 + fabs(force)));
        }
        for (size_t k = 0; k < simulation->particles.count; k++)
            sum += simulation->particles.force[d][k];
        assert_close(sum, 0, 1e-9); // momentum
    }
}

static void test_forces_are_minus_the_slopes_of_the_energy(void **state) {
    (void)state;
    struct polymers polymers;
    struct simulation simulation;
    make(&polymers, 2);
    assert_ok(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 60));
    assert_forces_are_slopes(&simulation, 7);
    mf_simulation_clear(&simulation);
    clear(&polymers);
}

/// Molecules of more beads than are worked on together, and fewer of them than there are lanes.
static void test_long_and_few_molecules_have_energies_and_forces_like_others(void **state) {
    (void)state;
    static const int count[][2] = {{5, 1}, {9, 3}, {4, 2}};
    for (size_t n = 0; n < sizeof count / sizeof *count; n++) {
        struct polymers polymers;
        struct simulation simulation;
        make_kinds(&polymers, make_chains(count[n][0], LONGEST, 0),
                   make_chains(count[n][1], LONGEST - 20, 0));
        polymers.fluid.setup.potential = NULL;
        polymers.fluid.setup.omega = NULL;
        polymers.fluid.setup.integrator = &mf_velocity_verlet;
        assert_ok(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL));
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, 30));
        assert_close_relative(simulation.sums.energy, slow_energy(&simulation, &polymers.molecules),
                              1e-10);
        assert_forces_are_slopes(&simulation, 3);
        mf_simulation_clear(&simulation);
        clear(&polymers);
    }
}

/// dU/d ln L = −Σ r·F, and all of it from the bonds and the pairs: the slope of the whole energy.
static void test_virial_is_the_slope_of_the_energy_with_the_volume(void **state) {
    (void)state;
    static const double h = 1e-5;
    struct polymers polymers;
    struct simulation simulation;
    make(&polymers, 1);
    assert_ok(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 60));
    energy_of(&simulation);
    const double virial = simulation.sums.virial;
    double energy[2];
    for (int n = 0; n < 2; n++) {
        const double scale = n == 0 ? 1 - h : (1 + h) / (1 - h);
        for (int d = 0; d < 3; d++) {
            simulation.particles.box.length[d] *= scale;
            for (size_t k = 0; k < simulation.particles.count; k++)
                simulation.particles.position[d][k] *= scale;
        }
        mf_particles_update_fractions(&simulation.particles);
        energy[n] = energy_of(&simulation);
    }
    assert_true(fabs(virial) > 10);
    assert_close_relative(virial, -(energy[1] - energy[0]) / (2 * h), 1e-4);
    mf_simulation_clear(&simulation);
    clear(&polymers);
}

// One molecule ------------------------------------------------------------------------------------

/// A chain of four with one term of each order, somewhere across the boundary of the box.
static void make_one(struct polymers *polymers, struct simulation *simulation,
                     const double (*place)[3]) {
    static const int types[4] = {0};
    double position[3][4];
    polymers->molecules = (struct molecules){0};
    const struct composition composition = molecules_topology(
        &polymers->molecules.topology, molecules_chain(1, types, 4, BONDED_DIHEDRAL, 3),
        (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&polymers->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(&polymers->molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    molecules_add_group(&polymers->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_ideal_gas(&polymers->fluid, 3, 4, 0.005);
    polymers->fluid.setup.omega = NULL;
    polymers->fluid.setup.integrator = &mf_velocity_verlet;
    molecules_enter(&polymers->fluid.setup, &polymers->molecules, &composition);
    polymers->fluid.setup.placement.kind = PLACEMENT_FILE;
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < 4; k++)
            position[d][k] = 4.8 + place[k][d];
    const struct simulation_start start = {.position = {position[0], position[1], position[2]}};
    assert_ok(mf_simulation_init(simulation, &polymers->fluid.setup, &start));
}

/// Straight and folded angles, three and four beads in a line, two beads on one spot.
static void test_forces_are_finite_where_geometry_has_no_direction(void **state) {
    (void)state;
    static const double places[][4][3] = {
        {{0, 0, 0}, {0.6, 0, 0}, {1.2, 0, 0}, {1.8, 0, 0}},
        {{0, 0, 0}, {0.6, 0, 0}, {0, 0, 0}, {0.6, 0, 0}},
        {{0, 0, 0}, {0.6, 0, 0}, {1.2, 0, 0}, {1.2, 0.6, 0}},
        {{0, 0, 0}, {0, 0, 0}, {0.6, 0, 0}, {0.6, 0.5, 0}},
        {{0, 0, 0}, {0.6, 0, 0}, {1.2, 1e-12, 0}, {1.8, 0, 0}},
        {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}, {1.0, 1.1, 1.2}},
    };
    for (size_t n = 0; n < sizeof places / sizeof *places; n++) {
        struct polymers polymers;
        struct simulation simulation;
        make_one(&polymers, &simulation, places[n]);
        assert_true(mf_particles_largest_force(&simulation.particles) < 1e3);
        assert_true(isfinite(energy_of(&simulation)));
        mf_simulation_clear(&simulation);
        clear(&polymers);
    }
}

/// G_ab is −dU/dγ of a molecule of which coordinate b grows by γ times coordinate a.
static void test_transfer_is_the_slope_of_the_energy_with_shear(void **state) {
    (void)state;
    static const double h = 1e-5;
    static const double place[4][3] = {
        {0, 0, 0}, {0.5, 0.2, 0.1}, {0.7, 0.8, -0.2}, {0.1, 0.9, 0.4}};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double energy[2], sheared[4][3];
            struct polymers polymers;
            struct simulation simulation;
            struct transfer transfer = {0};
            for (int n = 0; n < 2; n++) {
                memcpy(sheared, place, sizeof place);
                for (int k = 0; k < 4; k++)
                    sheared[k][b] += (n == 0 ? -h : h) * place[k][a];
                make_one(&polymers, &simulation, (const double(*)[3])sheared);
                energy[n] = energy_of(&simulation);
                mf_simulation_clear(&simulation);
                clear(&polymers);
            }
            make_one(&polymers, &simulation, place);
            simulation.transfer = &transfer;
            assert_ok(mf_simulation_compute_forces(&simulation, 0));
            assert_close(transfer.sum[a][b] / simulation.setup.time_step,
                         -(energy[1] - energy[0]) / (2 * h), 1e-4);
            mf_simulation_clear(&simulation);
            clear(&polymers);
        }
}

// Bits --------------------------------------------------------------------------------------------

static void check_bits(const struct integrator *integrator, const void *parameters) {
    struct polymers polymers;
    struct simulation one, three;
    make(&polymers, 1);
    polymers.fluid.setup.precision = PAIR_MIXED;
    polymers.fluid.setup.integrator = integrator;
    polymers.fluid.setup.integrator_parameters = parameters;
    if (!integrator->dissipative)
        polymers.fluid.setup.omega = NULL;
    assert_ok(mf_simulation_init(&one, &polymers.fluid.setup, NULL));
    polymers.fluid.setup.threads = 3;
    assert_ok(mf_simulation_init(&three, &polymers.fluid.setup, NULL));
    one.wants = three.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&one, 80));
    assert_ok(mf_simulation_run(&three, 35));
    restart_simulation(&three);
    three.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&three, 45));
    assert_true(one.list_builds > 5);
    restart_assert_same(&one, &three);
    assert_memory_equal(&one.sums, &three.sums, sizeof one.sums);
    mf_simulation_clear(&one);
    mf_simulation_clear(&three);
    clear(&polymers);
}

static void test_threads_and_restarts_leave_the_bits_as_they_are(void **state) {
    (void)state;
    static const struct respa_parameters inner = {3};
    static const struct dpd_verlet_parameters plain = {0.5, 1}, split = {0.5, 3};
    check_bits(&mf_dpd_verlet, &plain);
    check_bits(&mf_dpd_verlet, &split);
    check_bits(&mf_aboba, &inner);
    check_bits(&mf_velocity_verlet, &inner);
}

// What cannot be ----------------------------------------------------------------------------------

static void test_a_fene_bond_that_is_too_long_is_unstable(void **state) {
    (void)state;
    struct polymers polymers;
    struct simulation simulation;
    make(&polymers, 0);
    assert_ok(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL));
    const struct topology_kind *kind = &polymers.molecules.topology.kind[0];
    const struct particles *particles = &simulation.particles;
    for (int d = 0; d < 3; d++) // the second bond
        particles->position[d][particles->place[topology_id(kind, 7, 1)]] =
            particles->position[d][particles->place[topology_id(kind, 7, 2)]] + (d == 0 ? 1.7 : 0);
    assert_int_equal(mf_simulation_run(&simulation, 1), STATUS_UNSTABLE);
    assert_non_null(strstr(mf_status_message(), "unstable at step 1: a bond \"fene\" is"));
    assert_non_null(strstr(mf_status_message(), "breaks at 1.5;"));
    mf_simulation_clear(&simulation);
    clear(&polymers);
}

static void test_bonds_of_half_the_box_are_refused(void **state) {
    (void)state;
    struct polymers polymers;
    struct simulation simulation;
    make(&polymers, 0);
    for (int d = 0; d < 3; d++)
        polymers.fluid.setup.box.length[d] = 3;
    assert_int_equal(mf_simulation_init(&simulation, &polymers.fluid.setup, NULL),
                     STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "bonds.fene: a bond of 1.5 is not shorter than half "
                                             "of the box, whose shortest edge is 3");
    clear(&polymers);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy_is_that_of_a_slow_sum_over_terms),
        cmocka_unit_test(test_forces_are_minus_the_slopes_of_the_energy),
        cmocka_unit_test(test_long_and_few_molecules_have_energies_and_forces_like_others),
        cmocka_unit_test(test_virial_is_the_slope_of_the_energy_with_the_volume),
        cmocka_unit_test(test_forces_are_finite_where_geometry_has_no_direction),
        cmocka_unit_test(test_transfer_is_the_slope_of_the_energy_with_shear),
        cmocka_unit_test(test_threads_and_restarts_leave_the_bits_as_they_are),
        cmocka_unit_test(test_a_fene_bond_that_is_too_long_is_unstable),
        cmocka_unit_test(test_bonds_of_half_the_box_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
