// SPDX-License-Identifier: GPL-3.0-or-later
//
// Metropolis Monte Carlo and thermostatted dynamics sample the same distribution by different code:
// the same g(r) and the same mean energy, within their errors.
#include "base/statistics.h"
#include "curves/sampled.h"
#include "dynamics/hybrid.h"
#include "dynamics/metropolis.h"
#include "observe/rdf.h"
#include "forces/configurational.h"
#include "shared/all_pairs.h"
#include "shared/fluids.h"
#include "shared/hotelling.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"

enum { BLOCKS = 20, BINS = 8 };

/// Probability of a difference like this by chance. Six comparisons are made here: with a new seed
/// the file would fail once in 170 times.
static const double false_alarm_rate = 0.001;

/// How a scene is sampled, so that blocks are independent: a gap of a few correlation times, then
/// the configurations of a block.
struct schedule {
    uint64_t equilibration, gap, every; ///< steps, or sweeps
    bool is_long;                       ///< also in the short form of the tests
};

/// Of a block.
static int samples_of_block(const struct schedule *schedule) {
    return schedule->is_long || length_is_long() ? 40 : 20;
}

/// Means of the blocks.
struct measurement {
    struct comoments energy; ///< size 1: of a particle
    struct comoments g;      ///< size BINS
};

static void measurement_init(struct measurement *measurement) {
    assert_ok(mf_comoments_init(&measurement->energy, 1));
    assert_ok(mf_comoments_init(&measurement->g, BINS));
}

static void measurement_clear(struct measurement *measurement) {
    mf_comoments_clear(&measurement->energy);
    mf_comoments_clear(&measurement->g);
}

/// End a block: `energy` [total, summed over samples] and the RDF that saw its samples.
static void add_block(struct measurement *measurement, const struct schedule *schedule,
                      double energy, const struct rdf *rdf) {
    double g[BINS];
    assert_ok(mf_rdf_result(rdf, 1, g, NULL));
    mf_comoments_add(&measurement->g, g);
    energy /= samples_of_block(schedule) * (double)rdf->particle_count;
    mf_comoments_add(&measurement->energy, &energy);
}

static void measure_dynamics(const struct simulation_setup *setup, const struct rdf_bins *bins,
                             const struct schedule *schedule, struct measurement *measurement) {
    struct simulation simulation;
    measurement_init(measurement);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&simulation, schedule->equilibration));
    for (int block = 0; block < BLOCKS; block++) {
        struct rdf rdf;
        double energy = 0;
        assert_ok(mf_rdf_init(&rdf, bins, &setup->box, (size_t)setup->placement.count,
                              setup->potential->cutoff, (size_t)samples_of_block(schedule)));
        assert_ok(mf_simulation_run(&simulation, schedule->gap));
        for (int sample = 0; sample < samples_of_block(schedule); sample++) {
            assert_ok(mf_simulation_run(&simulation, schedule->every));
            assert_ok(mf_rdf_sample(&rdf, &simulation.particles, &simulation.neighbours));
            energy += simulation.sums.energy;
        }
        add_block(measurement, schedule, energy, &rdf);
        mf_rdf_clear(&rdf);
    }
    mf_simulation_clear(&simulation);
}

static void measure_monte_carlo(const struct simulation_setup *setup, const struct rdf_bins *bins,
                                const struct schedule *schedule, struct measurement *measurement) {
    const struct pair_law law = {.potential = setup->potential};
    const size_t count = (size_t)setup->placement.count;
    struct metropolis metropolis;
    double slope;
    mf_table_evaluate(setup->potential, setup->potential->cutoff * (1 - 1e-9), NULL, &slope, NULL);
    const double edge = setup->potential->cutoff * fabs(slope);
    measurement_init(measurement);
    assert_ok(mf_metropolis_init(&metropolis, &setup->box,
                                 &(struct composition){.types = 1, .count = {(int64_t)count}},
                                 setup->potential, setup->temperature, setup->seed));
    assert_ok(mf_metropolis_equilibrate(&metropolis, (uint32_t)schedule->equilibration));
    for (int block = 0; block < BLOCKS; block++) {
        struct rdf rdf;
        double energy = 0;
        // The list of the sampler is a full one: the RDF has to make its own.
        assert_ok(
            mf_rdf_init(&rdf, bins, &setup->box, count, 0, (size_t)samples_of_block(schedule)));
        assert_ok(mf_metropolis_run(&metropolis, (uint32_t)schedule->gap));
        for (int sample = 0; sample < samples_of_block(schedule); sample++) {
            struct pair_sums sums, fast;
            assert_ok(mf_metropolis_run(&metropolis, (uint32_t)schedule->every));
            assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
            all_pairs_forces(&law, &metropolis.particles, 0, &sums);
            energy += sums.energy;
            // Distances are rounded to single precision before the table is read, so that a pair
            // may be on the other side of the cutoff, where the force ends abruptly.
            uint32_t counts[2] = {0};
            assert_ok(mf_metropolis_count(&metropolis, &(struct pair_histogram){0, 1, 1, 0, counts},
                                          &fast));
            assert_close(fast.virial, sums.virial, 1e-4 * (double)count + edge);
        }
        add_block(measurement, schedule, energy, &rdf);
        mf_rdf_clear(&rdf);
    }
    mf_metropolis_clear(&metropolis);
}

static void measure_hybrid(const struct simulation_setup *setup, const struct rdf_bins *bins,
                           const struct schedule *schedule, struct measurement *measurement) {
    const struct pair_histogram pairs = {bins->low, bins->width, bins->count, 0, NULL};
    const size_t count = (size_t)setup->placement.count;
    struct hybrid hybrid;
    measurement_init(measurement);
    assert_ok(mf_hybrid_init(
        &hybrid, &setup->box, &(struct composition){.types = 1, .count = {(int64_t)count}},
        setup->potential, NULL, NULL, &pairs, setup->temperature, setup->seed, NULL));
    assert_ok(mf_hybrid_equilibrate(&hybrid, schedule->equilibration));
    hybrid.simulation.setup.time_step *= 1.8;
    for (int block = 0; block < BLOCKS; block++) {
        struct rdf rdf;
        double energy = 0;
        assert_ok(
            mf_rdf_init(&rdf, bins, &setup->box, count, 0, (size_t)samples_of_block(schedule)));
        assert_ok(mf_hybrid_run(&hybrid, schedule->gap));
        for (int sample = 0; sample < samples_of_block(schedule); sample++) {
            assert_ok(mf_hybrid_run(&hybrid, schedule->every));
            assert_ok(
                mf_rdf_sample(&rdf, &hybrid.simulation.particles, &hybrid.simulation.neighbours));
            energy += hybrid.sums.energy;
        }
        add_block(measurement, schedule, energy, &rdf);
        mf_rdf_clear(&rdf);
    }
    mf_hybrid_clear(&hybrid);
}

static double standard_error(const struct comoments *moments, size_t k) {
    return sqrt(mf_comoments_covariance(moments, k, k) / (moments->count - 1));
}

static void assert_equal_within_errors(const struct measurement *dynamics,
                                       const struct measurement *monte_carlo) {
    const double p_energy = hotelling_two_samples(&dynamics->energy, &monte_carlo->energy);
    const double p_g = hotelling_two_samples(&dynamics->g, &monte_carlo->g);
    print_message("U/N: %.4f(%.4f), Monte Carlo %.4f(%.4f), p = %.3f\n", dynamics->energy.mean[0],
                  standard_error(&dynamics->energy, 0), monte_carlo->energy.mean[0],
                  standard_error(&monte_carlo->energy, 0), p_energy);
    print_message("g: p = %.3f\n", p_g);
    assert_true(p_energy > false_alarm_rate);
    assert_true(p_g > false_alarm_rate);
}

static void compare(const struct fluid *fluid, const struct rdf_bins *bins,
                    const struct schedule *dynamics, const struct schedule *monte_carlo) {
    struct measurement first, second;
    measure_dynamics(&fluid->setup, bins, dynamics, &first);
    measure_monte_carlo(&fluid->setup, bins, monte_carlo, &second);
    assert_equal_within_errors(&first, &second);
    measurement_clear(&first);
    measurement_clear(&second);
}

// The time steps below are so small that their error in the configurational temperature, of second
// order, is below the statistical errors: 0.001 for the soft fluids (a quarter of 0.0036, that at
// Δt = 0.01) and about as much for Lennard-Jones.

/// Hybrid Monte Carlo has steps 1.8 times as long as tuned, so that many trajectories go on or
/// back: if all were taken, U/N was off by eight of its errors (with steps of half that length, or
/// half of the samples, this can go unnoticed). Longer ones use all their chances, which takes time
/// alone.
static void
test_metropolis_agrees_with_dynamics_and_hybrid_when_the_liquid_is_lennard_jones(void **state) {
    (void)state;
    struct fluid fluid;
    struct measurement dynamics, moves, trajectories;
    const struct rdf_bins bins = {0.85, 0.2, BINS};
    fluid_lennard_jones(&fluid, 500, 0.003);
    measure_dynamics(&fluid.setup, &bins, &(struct schedule){2000, 200, 15, false}, &dynamics);
    measure_monte_carlo(&fluid.setup, &bins, &(struct schedule){1000, 200, 15, true}, &moves);
    measure_hybrid(&fluid.setup, &bins, &(struct schedule){1000, 100, 8, true}, &trajectories);
    assert_equal_within_errors(&dynamics, &moves);
    assert_equal_within_errors(&trajectories, &moves);
    measurement_clear(&dynamics);
    measurement_clear(&moves);
    measurement_clear(&trajectories);
    fluid_clear(&fluid);
}

static void test_metropolis_agrees_with_dynamics_when_the_fluid_is_soft(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 648, 0.005);
    compare(&fluid, &(struct rdf_bins){0.2, 0.1, BINS}, &(struct schedule){1000, 100, 10, false},
            &(struct schedule){500, 50, 5, false});
    fluid_clear(&fluid);
}

static void test_metropolis_agrees_with_dynamics_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, 400, 0.005);
    // Beyond the cutoff of 1.
    compare(&fluid, &(struct rdf_bins){0.1, 0.25, BINS}, &(struct schedule){1000, 100, 10, false},
            &(struct schedule){500, 50, 5, false});
    fluid_clear(&fluid);
}

/// Particles on top of each other with a huge repulsion: what is unstable is not taken.
static void test_hybrid_survives_when_the_potential_is_wild(void **state) {
    (void)state;
    struct fluid fluid;
    struct hybrid hybrid;
    const struct pair_histogram pairs = {0, 0.1, BINS, 0, NULL};
    fluid_groot_warren(&fluid, 300, 0.01);
    assert_ok(mf_hybrid_init(&hybrid, &fluid.setup.box,
                             &(struct composition){.types = 1, .count = {300}}, &fluid.potential,
                             NULL, NULL, &pairs, 1, 3, NULL));
    assert_ok(mf_hybrid_equilibrate(&hybrid, 100));
    for (int k = 0; k <= TABLE_INTERVALS; k++)
        for (int n = 0; n < 4; n++)
            fluid.potential.single[k][n] *= 1e7F;
    assert_ok(mf_hybrid_refresh(&hybrid));
    const double before = hybrid.sums.energy;
    assert_ok(mf_hybrid_run(&hybrid, 20));
    assert_close(hybrid.sums.energy, before, 1e-6 * before); // all of them went back
    assert_ok(mf_hybrid_equilibrate(&hybrid, 2000));
    assert_true(hybrid.sums.energy < 0.9 * before); // steps became short enough
    mf_hybrid_clear(&hybrid);
    fluid_clear(&fluid);
}

/// True if particle j is on the list of particle i.
static bool is_listed(const struct neighbours *neighbours, size_t i, size_t j) {
    for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++)
        if ((size_t)neighbours->list[k] == j)
            return true;
    return false;
}

/// Pairs within the cutoff that the list does not hold.
static size_t count_missing(const struct metropolis *metropolis) {
    const struct particles *particles = &metropolis->particles;
    const double cutoff = metropolis->law.potential->cutoff;
    size_t missing = 0;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < particles->count; j++) {
            double square = 0;
            for (int d = 0; d < particles->box.dimensions; d++) {
                const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                              particles->box.length[d]);
                square += dx * dx;
            }
            missing +=
                i != j && square < cutoff * cutoff && !is_listed(&metropolis->neighbours, i, j);
        }
    return missing;
}

static void test_metropolis_list_is_complete_when_the_step_is_the_first_or_tuned(void **state) {
    (void)state;
    struct fluid fluid;
    struct metropolis metropolis;
    fluid_groot_warren(&fluid, 300, 0.01);
    assert_ok(mf_metropolis_init(&metropolis, &fluid.setup.box,
                                 &(struct composition){.types = 1, .count = {300}},
                                 &fluid.potential, 1, 3));
    for (int sweep = 0; sweep < 30; sweep++) {
        assert_ok(mf_metropolis_run(&metropolis, 1));
        assert_int_equal(count_missing(&metropolis), 0);
    }
    assert_ok(mf_metropolis_equilibrate(&metropolis, 200));
    for (int sweep = 0; sweep < 30; sweep++) {
        assert_ok(mf_metropolis_run(&metropolis, 1));
        assert_int_equal(count_missing(&metropolis), 0);
    }
    mf_metropolis_clear(&metropolis);
    fluid_clear(&fluid);
}

/// Φ = 2 (1 − r), whose force of 2 ends abruptly at the cutoff.
static void make_linear(struct table *table) {
    const double r[] = {0, 0.25, 0.5, 0.75, 1}, phi[] = {2, 1.5, 1, 0.5, 0};
    struct curve curve;
    assert_ok(mf_sampled_create(&curve, r, phi, 5));
    assert_ok(mf_table_init_potential(table, &curve));
    mf_curve_clear(&curve);
}

static void add_configurational(const struct metropolis *metropolis, double *squares,
                                double *laplacian) {
    struct particles copy;
    struct neighbours half;
    double here[2];
    const size_t count = metropolis->particles.count;
    assert_ok(mf_particles_init(&copy, &metropolis->particles.box, count));
    for (int d = 0; d < 3; d++)
        memcpy(copy.position[d], metropolis->particles.position[d], count * sizeof(double));
    assert_ok(mf_neighbours_init(&half, NEIGHBOURS_HALF, &copy.box, count,
                                 metropolis->law.potential->cutoff, 0));
    assert_ok(mf_neighbours_sort_and_build(&half, &copy));
    const struct composition alike = {0};
    assert_ok(mf_configurational(metropolis->law.potential, &alike, metropolis->law.temperature,
                                 &copy, &half, NULL, NULL, &here[0], &here[1]));
    *squares += here[0];
    *laplacian += here[1];
    mf_neighbours_clear(&half);
    mf_particles_clear(&copy);
}

/// ⟨Σ|F|²⟩ = k_B T ⟨Σ∇²U⟩ within four standard errors of the blocks: one false alarm in 1,700.
/// Without what the jump of the slope adds, the right side is negative.
static void test_configurational_temperature_sees_a_force_that_ends_abruptly(void **state) {
    (void)state;
    enum { PARTICLES = 1000, CONFIGURATIONS = 25 };
    const struct box box = {3, {7, 7, 7}};
    struct table linear;
    struct metropolis metropolis;
    struct running_mean difference = {0}, squares = {0};
    make_linear(&linear);
    assert_ok(mf_metropolis_init(
        &metropolis, &box, &(struct composition){.types = 1, .count = {PARTICLES}}, &linear, 1, 3));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 200));
    for (int block = 0; block < BLOCKS; block++) {
        double sum[2] = {0};
        for (int n = 0; n < CONFIGURATIONS; n++) {
            assert_ok(mf_metropolis_run(&metropolis, 10));
            add_configurational(&metropolis, &sum[0], &sum[1]);
        }
        mf_statistics_add(&squares, sum[0]);
        mf_statistics_add(&difference, sum[0] - sum[1]);
    }
    const double error = mf_statistics_standard_error(&difference);
    print_message("1 - 1/T configurational: %.4f(%.4f)\n", difference.mean / squares.mean,
                  error / squares.mean);
    assert_close(difference.mean, 0, 4 * error);
    assert_true(error < 0.05 * squares.mean);
    mf_metropolis_clear(&metropolis);
    mf_table_clear(&linear);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            test_metropolis_agrees_with_dynamics_and_hybrid_when_the_liquid_is_lennard_jones),
        cmocka_unit_test(test_metropolis_agrees_with_dynamics_when_the_fluid_is_soft),
        cmocka_unit_test(test_metropolis_agrees_with_dynamics_when_the_scene_is_flat),
        cmocka_unit_test(test_hybrid_survives_when_the_potential_is_wild),
        cmocka_unit_test(test_metropolis_list_is_complete_when_the_step_is_the_first_or_tuned),
        cmocka_unit_test(test_configurational_temperature_sees_a_force_that_ends_abruptly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
