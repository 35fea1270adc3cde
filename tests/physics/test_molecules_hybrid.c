// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hybrid Monte Carlo of molecules samples the canonical ensemble exactly, with inner steps for
// their bonds and any time step: without pair potentials p(r) ~ r^2 exp(-U/T) and p(theta) ~
// sin(theta) exp(-U/T). And the multiple time steps themselves are reversible.
#include "base/memory.h"
#include "base/statistics.h"
#include "curves/formula.h"
#include "dynamics/dpd_verlet.h"
#include "dynamics/hybrid.h"
#include "dynamics/respa.h"
#include "observe/bonded_distribution.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { CHAINS = 60, BEADS = 3 };

static const double temperature = 1.4;
static const int type[BEADS] = {0};
static const struct molecules_number spring[] = {{"k", 300}, {"length", 0.7}, {NULL, 0}};
static const struct molecules_number bend[] = {{"k", 30}, {"angle", 120}, {NULL, 0}};
static const struct box box = {.dimensions = 3, .length = {5, 5, 5}};

static struct composition make_chains(struct molecules *molecules) {
    *molecules = (struct molecules){0};
    const struct composition composition =
        molecules_topology(&molecules->topology, molecules_chain(CHAINS, type, BEADS, 1, 2),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    return composition;
}

static void make_table(struct table *table, double a) {
    struct formula_soft_repulsion_parameters soft = {a, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &soft};
    assert_ok(mf_table_init_potential(table, &curve));
}

/// Part of the weight that is below a median-like place, by Simpson's rule.
static double moment(int order, int power) {
    enum { HALVES = 4000 };
    const double low = order == BONDED_BOND ? 0.3 : 0, high = order == BONDED_BOND ? 1.1 : M_PI;
    double sum = 0, norm = 0;
    for (int k = 0; k <= 2 * HALVES; k++) {
        const double q = low + (high - low) * k / (2 * HALVES);
        const double factor = k == 0 || k == 2 * HALVES ? 1 : k % 2 ? 4 : 2;
        const double away = order == BONDED_BOND ? q - 0.7 : q - 120 * BONDED_RADIANS;
        const double energy = (order == BONDED_BOND ? 300 : 30) * away * away / 2;
        const double weight =
            factor * exp(-energy / temperature) * (order == BONDED_BOND ? q * q : sin(q));
        sum += weight * pow(away, power);
        norm += weight;
    }
    return sum / norm;
}

/// Means of powers of r − 0.7 and θ − 120° over blocks; the time step is far too long for molecular
/// dynamics, so that hundreds of trajectories are refused.
static void test_hybrid_samples_bonds_and_angles_exactly(void **state) {
    enum { BLOCKS = 40, SAMPLES = 50, ORDERS = 2, POWERS = 2, BINS = 4000 };
    (void)state;
    struct molecules molecules;
    struct hybrid hybrid;
    struct table table;
    struct running_mean mean[ORDERS][POWERS] = {{{0}}};
    double *counts = mf_memory_zeroed(BINS, sizeof *counts);
    const struct pair_histogram none = {0};
    const struct composition composition = make_chains(&molecules);
    make_table(&table, 0); // pairs that do nothing
    assert_ok(mf_hybrid_init(&hybrid, &box, &composition, &table, &molecules, NULL, &none,
                             temperature, 5, NULL));
    assert_ok(mf_hybrid_scatter(&hybrid));
    assert_ok(mf_hybrid_equilibrate(&hybrid, 400));
    hybrid.simulation.setup.time_step *= 1.6;
    for (int block = 0; block < BLOCKS; block++) {
        double sum[ORDERS][POWERS] = {{0}}, all[ORDERS] = {0};
        for (int sample = 0; sample < SAMPLES; sample++) {
            assert_ok(mf_hybrid_run(&hybrid, 4));
            for (int order = 0; order < ORDERS; order++) {
                const struct bonded_bins bins = {0, (order == BONDED_BOND ? 1.2 : 180.0) / BINS,
                                                 BINS};
                memset(counts, 0, BINS * sizeof *counts);
                mf_bonded_distribution_count(&molecules, order, 0, &bins,
                                             &hybrid.simulation.particles, counts);
                for (size_t k = 0; k < BINS; k++) {
                    const double q = bonded_bins_centre(&bins, k);
                    const double away = order == BONDED_BOND ? q - 0.7 : (q - 120) * BONDED_RADIANS;
                    all[order] += counts[k];
                    for (int power = 0; power < POWERS; power++)
                        sum[order][power] += counts[k] * pow(away, power + 1);
                }
            }
        }
        for (int order = 0; order < ORDERS; order++) {
            assert_close(all[order], (2 - order) * CHAINS * SAMPLES, 0.5);
            for (int power = 0; power < POWERS; power++)
                mf_statistics_add(&mean[order][power], sum[order][power] / all[order]);
        }
    }
    assert_true(hybrid.taken < hybrid.tried);
    for (int order = 0; order < ORDERS; order++)
        for (int power = 0; power < POWERS; power++) {
            const struct running_mean *found = &mean[order][power];
            // Four means; a false alarm in 4,000 with 4.2 standard errors of 40 blocks.
            assert_close(found->mean, moment(order, power + 1),
                         4.2 * mf_statistics_standard_error(found));
        }
    mf_memory_free(counts);
    mf_hybrid_clear(&hybrid);
    mf_molecules_clear(&molecules);
    mf_table_clear(&table);
}

/// Steps forth, all velocities turned, as many steps: the way back. In double precision, where
/// roundings are small enough to be told from it.
static void go_there_and_back(const struct integrator *integrator, const void *parameters,
                              bool densities) {
    enum { STEPS = 30 };
    struct molecules molecules;
    struct many_body crowd;
    struct simulation simulation;
    struct table table;
    double *start = mf_memory_zeroed(3 * CHAINS * BEADS, sizeof *start), farthest = 0;
    const struct composition composition = make_chains(&molecules);
    make_table(&table, 25);
    many_bodies_crowd(&crowd, 0.5, 1.2, 0.5, 2, &composition);
    struct simulation_setup setup = {.box = box,
                                     .placement = {.kind = PLACEMENT_LATTICE},
                                     .temperature = 1,
                                     .time_step = 0.03,
                                     .temperature_limit = 100,
                                     .integrator = integrator,
                                     .integrator_parameters = parameters,
                                     .potential = &table,
                                     .precision = PAIR_DOUBLE,
                                     .seed = 3,
                                     .threads = 1};
    molecules_enter(&setup, &molecules, &composition);
    if (densities)
        setup.interaction[setup.interactions++] =
            (struct interaction_choice){&mf_many_body, &crowd};
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    struct particles *particles = &simulation.particles;
    const size_t count = particles->count;
    for (size_t k = 0; k < count; k++)
        for (size_t d = 0; d < 3; d++)
            start[3 * particles->id[k] + d] = particles->position[d][k];
    for (int way = 0; way < 2; way++) {
        assert_ok(mf_simulation_run(&simulation, STEPS));
        for (size_t d = 0; d < 3; d++)
            for (size_t k = 0; k < count; k++) {
                const double moved = particles->position[d][k] - start[3 * particles->id[k] + d];
                farthest = fmax(farthest, fabs(box_nearest(moved, box.length[d])));
                particles->velocity[d][k] = -particles->velocity[d][k];
            }
        if (way == 0)
            assert_true(farthest > 0.3);
        farthest = 0;
    }
    for (size_t k = 0; k < count; k++)
        for (size_t d = 0; d < 3; d++)
            assert_close(box_nearest(particles->position[d][k] - start[3 * particles->id[k] + d],
                                     box.length[d]),
                         0, 1e-6);
    mf_memory_free(start);
    mf_simulation_clear(&simulation);
    mf_molecules_clear(&molecules);
    mf_many_body_clear(&crowd);
    mf_table_clear(&table);
}

static void test_respa_goes_back_the_way_it_came(void **state) {
    (void)state;
    static const struct integrator *const integrators[] = {&mf_velocity_verlet, &mf_dpd_verlet,
                                                           &mf_aboba};
    for (int64_t inner = 1; inner <= 6; inner += 5)
        for (size_t n = 0; n < 3; n++) {
            const struct respa_parameters steps = {inner};
            const struct dpd_verlet_parameters half = {0.5, inner};
            const void *parameters =
                integrators[n] == &mf_dpd_verlet ? (const void *)&half : (const void *)&steps;
            for (int densities = 0; densities < 2; densities++)
                go_there_and_back(integrators[n], parameters, densities);
        }
}

/// Energy a bead of dynamics without friction, every 0.2 τ from the first 40 τ on: by how much it
/// grows in a time, and how it scatters about that line. Its growth is a walk of chance, which does
/// not follow the time step: of four seeds it made 0.0001 to 0.0002 of scatters of 0.0002 to
/// 0.0003.
static void follow_energy(double time_step, double *scatter, double *drift) {
    enum { SAMPLES = 300 };
    struct molecules molecules;
    struct simulation simulation;
    struct table table;
    struct running_mean energy = {0};
    double slope = 0, squares = 0;
    const struct composition composition = make_chains(&molecules);
    const struct respa_parameters inner = {4};
    make_table(&table, 25);
    struct simulation_setup setup = {.box = {3, {3.9, 3.9, 3.9}}, // density 3
                                     .placement = {.kind = PLACEMENT_LATTICE},
                                     .temperature = 1,
                                     .time_step = time_step,
                                     .temperature_limit = 100,
                                     .integrator = &mf_velocity_verlet,
                                     .integrator_parameters = &inner,
                                     .potential = &table,
                                     .precision = PAIR_DOUBLE,
                                     .seed = 3,
                                     .threads = 1};
    molecules_enter(&setup, &molecules, &composition);
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    const uint64_t every = (uint64_t)llround(0.2 / time_step);
    assert_ok(mf_simulation_run(&simulation, 200 * every));
    for (int n = 0; n < SAMPLES; n++) {
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, every));
        const double each =
            (simulation.sums.energy + mf_particles_kinetic_energy(&simulation.particles)) /
            (CHAINS * BEADS);
        const double time = 0.2 * (n - 0.5 * (SAMPLES - 1));
        mf_statistics_add(&energy, each);
        slope += time * each;
        squares += time * time;
    }
    *drift = slope / squares;
    *scatter = sqrt((energy.squares - *drift * slope) / (SAMPLES - 2));
    print_message("time step %g: energy %.6f, scatter %.2g, drift %.2g a bead and time\n",
                  time_step, energy.mean, *scatter, *drift);
    mf_simulation_clear(&simulation);
    mf_molecules_clear(&molecules);
    mf_table_clear(&table);
}

/// Multiple time steps keep the energy with an error of Δt², in a melt of pairs, bonds and angles:
/// at half the time step it scatters a quarter as much. In 60 τ it drifts by less than 0.0012 k_B T
/// a bead.
static void test_respa_keeps_the_energy_with_an_error_of_second_order(void **state) {
    (void)state;
    double scatter[2], drift;
    for (int n = 0; n < 2; n++) {
        follow_energy(n == 0 ? 0.01 : 0.005, &scatter[n], &drift);
        assert_close(drift, 0, 2e-5);
    }
    assert_close(scatter[0] / scatter[1], 4, 1.2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hybrid_samples_bonds_and_angles_exactly),
        cmocka_unit_test(test_respa_keeps_the_energy_with_an_error_of_second_order),
        cmocka_unit_test(test_respa_goes_back_the_way_it_came),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
