// SPDX-License-Identifier: GPL-3.0-or-later
//
// Energies of local densities: the vector kernels beside two loops over all pairs, these beside
// differences of the energy and of the volume, and beside the force that many-body dissipative
// particle dynamics is about.
#include "dynamics/simulation_look.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/restart.h"
#include "shared/slow_forces.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <math.h>

enum { BEADS = 300 };

/// What the slow twin finds, without the pairs.
struct found {
    double force[3][BEADS];
    struct pair_sums sums;
};

static void find(const struct many_body *law, const struct particles *particles,
                 struct found *found) {
    *found = (struct found){0};
    assert_true(particles->count <= BEADS);
    assert_ok(slow_forces_many_body(law, particles,
                                    (double *[]){found->force[0], found->force[1], found->force[2]},
                                    &found->sums));
}

static void begin(struct simulation *simulation, struct many_bodies *many) {
    many->fluid.setup.placement.kind = PLACEMENT_RANDOM;
    many->fluid.setup.placement.separation = 0;
    many->fluid.setup.temperature_limit = 1e9;
    many->fluid.setup.skin = 0.1;
    assert_ok(mf_simulation_init(simulation, &many->fluid.setup, NULL));
}

static bool is_any(const struct interaction *kind) {
    (void)kind;
    return true;
}

/// All forces of a pass, and those of the pairs alone taken from them.
static void check_kernels(struct many_bodies *many, double tolerance) {
    static struct found found;
    struct simulation simulation;
    many->fluid.setup.potential = NULL;
    many->fluid.setup.omega = NULL;
    begin(&simulation, many);
    const struct particles *particles = &simulation.particles;
    find(&many->law, particles, &found);
    assert_ok(mf_simulation_compute_potential(&simulation));
    double largest = 0;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            largest = fmax(largest, fabs(found.force[d][k]));
    assert_true(largest > 1);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            assert_close(particles->force[d][k], found.force[d][k], tolerance * largest);
    // Sums of numbers of either sign, about 1 and the largest force.
    assert_close(simulation.sums.energy, found.sums.energy,
                 tolerance * (BEADS + fabs(found.sums.energy)));
    assert_close(simulation.sums.virial, found.sums.virial,
                 tolerance * (BEADS * largest + fabs(found.sums.virial)));
    // The same beside others, as integrators with inner steps ask for it.
    double *beside[3] = {NULL};
    for (int d = 0; d < 3; d++) {
        beside[d] = mf_memory_zeroed(BEADS, sizeof(double));
        assert_non_null(beside[d]);
    }
    assert_ok(mf_simulation_interaction_forces(&simulation, is_any, beside));
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            assert_close(beside[d][k], particles->force[d][k], 1e-12 * largest);
    for (int d = 0; d < 3; d++)
        mf_memory_free(beside[d]);
    mf_simulation_clear(&simulation);
}

static void make(struct many_bodies *many, bool mixed, int dimensions, int beads) {
    if (mixed)
        many_bodies_mixture(many, dimensions, beads);
    else
        many_bodies_dpd(many, dimensions, beads);
}

static void test_kernels_find_what_two_loops_find(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int count = variants_find(variants);
    for (int v = 0; v < count; v++)
        for (int dimensions = 2; dimensions <= 3; dimensions++)
            for (int mixed = 0; mixed < 2; mixed++) {
                struct many_bodies many;
                make(&many, mixed, dimensions, BEADS);
                variants_select(&variants[v]);
                many.fluid.setup.precision = (int)variants[v].precision;
                check_kernels(&many, variants[v].precision == PAIR_DOUBLE ? 1e-12 : 4e-6);
                many_bodies_clear(&many);
            }
    variants_select(&variants[0]);
}

/// −dU/dx by the five-point rule, of every seventh bead; the virial is −d V dU/dV.
static void check_differences(struct many_bodies *many) {
    static const double step = 1e-4;
    static struct found found, moved;
    struct simulation simulation;
    begin(&simulation, many);
    struct particles *particles = &simulation.particles;
    const int dimensions = particles->box.dimensions;
    find(&many->law, particles, &found);
    for (size_t k = 0; k < particles->count; k += 7)
        for (int d = 0; d < dimensions; d++) {
            static const double factor[] = {1, -8, 8, -1}, at[] = {-2, -1, 1, 2};
            const double here = particles->position[d][k];
            double slope = 0;
            for (int n = 0; n < 4; n++) {
                particles->position[d][k] = here + at[n] * step;
                find(&many->law, particles, &moved);
                slope += factor[n] * moved.sums.energy / (12 * step);
            }
            particles->position[d][k] = here;
            assert_close(found.force[d][k], -slope, 2e-6 * (1 + fabs(slope)));
        }
    const struct box box = particles->box;
    double energy[2];
    for (int side = 0; side < 2; side++) {
        const double scale = 1 + (side ? step : -step);
        for (int d = 0; d < dimensions; d++) {
            particles->box.length[d] = scale * box.length[d];
            for (size_t k = 0; k < particles->count; k++)
                particles->position[d][k] *= scale;
        }
        find(&many->law, particles, &moved);
        energy[side] = moved.sums.energy;
        for (int d = 0; d < dimensions; d++)
            for (size_t k = 0; k < particles->count; k++)
                particles->position[d][k] /= scale;
    }
    assert_close_relative(found.sums.virial, -(energy[1] - energy[0]) / (2 * step), 1e-5);
    mf_simulation_clear(&simulation);
}

static void test_forces_and_virial_are_derivatives_of_the_energy(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int mixed = 0; mixed < 2; mixed++) {
            struct many_bodies many;
            make(&many, mixed, dimensions, 80);
            check_differences(&many);
            many_bodies_clear(&many);
        }
}

/// Three beads on a line: B (ρ_i + ρ_j)(1 − r/r_d) of each pair, with Warren's ρ.
static void test_many_body_dpd_has_warrens_force(void **state) {
    (void)state;
    static const double x[3] = {1, 1.3, 1.9}, r_d = 0.75, b = 25;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const double norm =
            dimensions == 3 ? 15 / (2 * M_PI * pow(r_d, 3)) : 6 / (M_PI * r_d * r_d);
        double density[3] = {0}, expected[3] = {0};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                density[i] += i == j ? 0 : norm * pow(fmax(0, 1 - fabs(x[i] - x[j]) / r_d), 2);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                if (i != j)
                    expected[i] += b * (density[i] + density[j]) *
                                   fmax(0, 1 - fabs(x[i] - x[j]) / r_d) * (x[i] > x[j] ? 1 : -1);
        struct many_bodies many;
        struct simulation simulation;
        many_bodies_dpd(&many, dimensions, 3);
        double y[3] = {1, 1, 1}, z[3] = {1, 1, 1}, positions[3] = {x[0], x[1], x[2]};
        for (int d = 0; d < dimensions; d++)
            many.fluid.setup.box.length[d] = 4;
        many.fluid.setup.potential = NULL;
        many.fluid.setup.placement.kind = PLACEMENT_FILE;
        many.fluid.setup.precision = PAIR_DOUBLE;
        assert_ok(mf_simulation_init(&simulation, &many.fluid.setup,
                                     &(struct simulation_start){.position = {positions, y, z}}));
        assert_ok(mf_simulation_compute_potential(&simulation));
        for (size_t k = 0; k < 3; k++)
            assert_close(simulation.particles.force[0][k], expected[simulation.particles.id[k]],
                         1e-6);
        mf_simulation_clear(&simulation);
        many_bodies_clear(&many);
    }
}

static void sum_forces(const struct particles *particles, double sum[3]) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        sum[d] = 0;
        for (size_t k = 0; k < particles->count; k++)
            sum[d] += particles->force[d][k];
    }
}

static void test_momentum_is_conserved_to_rounding(void **state) {
    (void)state;
    struct many_bodies many;
    struct simulation simulation;
    many_bodies_mixture(&many, 3, 3000);
    assert_ok(mf_simulation_init(&simulation, &many.fluid.setup, NULL));
    double sum[3];
    sum_forces(&simulation.particles, sum);
    for (int d = 0; d < 3; d++)
        assert_close(sum[d], 0, 1e-9);
    mf_simulation_clear(&simulation);
    many_bodies_clear(&many);
}

static void test_same_bits_for_any_threads_and_when_restarted(void **state) {
    (void)state;
    for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++)
        for (int mixed = 0; mixed < 2; mixed++) {
            struct many_bodies many;
            struct simulation alone, shared;
            make(&many, mixed, 3, 2000);
            many.fluid.setup.precision = precision;
            many.fluid.setup.skin = 0.15;
            many.fluid.setup.temperature_limit = 100;
            assert_ok(mf_simulation_init(&alone, &many.fluid.setup, NULL));
            many.fluid.setup.threads = 3;
            assert_ok(mf_simulation_init(&shared, &many.fluid.setup, NULL));
            assert_true(alone.neighbours.parts >= 4);
            assert_ok(mf_simulation_run(&alone, 24));
            assert_true(alone.list_builds > 1);
            assert_ok(mf_simulation_run(&shared, 10));
            restart_simulation(&shared);
            assert_ok(mf_simulation_run(&shared, 14));
            alone.wants = shared.wants = PAIR_FORCES_AND_SUMS;
            assert_ok(mf_simulation_run(&alone, 1));
            assert_ok(mf_simulation_run(&shared, 1));
            restart_assert_same(&alone, &shared);
            assert_identical(alone.sums.energy, shared.sums.energy);
            assert_identical(alone.sums.virial, shared.sums.virial);
            mf_simulation_clear(&alone);
            mf_simulation_clear(&shared);
            many_bodies_clear(&many);
        }
}

/// The stress of each pair: its trace is the virial.
static void test_the_stress_has_the_virial_for_its_trace(void **state) {
    (void)state;
    static struct transfer transfer;
    struct many_bodies many;
    struct simulation simulation;
    many_bodies_mixture(&many, 3, 1500);
    many.fluid.setup.omega = NULL;
    many.fluid.setup.integrator = &mf_velocity_verlet;
    assert_ok(mf_simulation_init(&simulation, &many.fluid.setup, NULL));
    transfer = (struct transfer){0};
    simulation.transfer = &transfer;
    simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_compute_forces(&simulation, 0));
    const double trace = transfer.sum[0][0] + transfer.sum[1][1] + transfer.sum[2][2];
    assert_close_relative(trace / many.fluid.setup.time_step, simulation.sums.virial, 1e-6);
    assert_close_relative(transfer.sum[0][1], transfer.sum[1][0], 1e-9);
    mf_simulation_clear(&simulation);
    many_bodies_clear(&many);
}

/// The formula of A among B ends at 3, and the other terms have no table.
static void test_densities_beyond_a_table_are_told(void **state) {
    (void)state;
    struct many_bodies many;
    struct simulation simulation;
    double extreme[2];
    many_bodies_mixture(&many, 3, 1000);
    assert_ok(mf_simulation_init(&simulation, &many.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 2));
    const void *own = NULL;
    for (int k = 0; k < simulation.interactions; k++)
        if (simulation.interaction[k].choice.kind == &mf_many_body)
            own = simulation.interaction[k].state;
    assert_non_null(own);
    assert_false(mf_many_body_was_beyond(&many.law, own, 1, extreme));
    assert_true(mf_many_body_was_beyond(&many.law, own, 0, extreme));
    assert_true(extreme[0] >= 0 && extreme[0] < 1 && extreme[1] > 3);
    double largest = 0;
    for (size_t k = 0; k < simulation.particles.count; k++)
        if (mf_composition_type(&many.law.composition, simulation.particles.id[k]) == 0)
            largest = fmax(largest, mf_many_body_density(own, 0)[k]);
    assert_true(largest > 1 && largest <= extreme[1]);
    mf_simulation_clear(&simulation);
    many_bodies_clear(&many);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kernels_find_what_two_loops_find),
        cmocka_unit_test(test_forces_and_virial_are_derivatives_of_the_energy),
        cmocka_unit_test(test_many_body_dpd_has_warrens_force),
        cmocka_unit_test(test_momentum_is_conserved_to_rounding),
        cmocka_unit_test(test_same_bits_for_any_threads_and_when_restarted),
        cmocka_unit_test(test_the_stress_has_the_virial_for_its_trace),
        cmocka_unit_test(test_densities_beyond_a_table_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
