// SPDX-License-Identifier: GPL-3.0-or-later
//
// Without a potential every configuration is equally likely: g = 1, in any number of dimensions, by
// Monte Carlo and by dynamics, with friction and without.
#include "dynamics/metropolis.h"
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/hotelling.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <stdio.h>

enum { PARTICLES = 120, BINS = 10, SAMPLES = 40 };

static uint64_t replicas_count(void) {
    return length_is_long() ? 40 : 20;
}

/// Probability of such a deviation from 1 by chance. The replicas are independent, so that the rate
/// is exact whatever the correlations of bins and samples. Sixteen comparisons at most: with a new
/// seed the file would fail once in 60 times.
static const double false_alarm_rate = 0.001;

/// Bins up to half the box: the whole range that the nearest image allows.
static const struct rdf_bins bins = {0, 0.25, BINS};

static void assert_unity(const struct comoments *g, const char *what) {
    double ones[BINS];
    for (int k = 0; k < BINS; k++)
        ones[k] = 1;
    const double p = hotelling_one_sample(g, ones);
    print_message("%s: g(1.1) = %.4f(%.4f), p = %.3f\n", what, g->mean[4],
                  sqrt(mf_comoments_covariance(g, 4, 4) / (g->count - 1)), p);
    assert_true(p > false_alarm_rate);
}

/// g of one replica of dynamics. The list is short: the RDF makes its own.
static void sample_dynamics(const struct simulation_setup *setup, uint64_t every, double *g) {
    struct simulation simulation;
    struct rdf rdf;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_rdf_init(&rdf, &bins, &setup->box, PARTICLES, setup->omega ? 1 : 0, SAMPLES));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_simulation_run(&simulation, every));
        assert_ok(mf_rdf_sample(&rdf, &simulation.particles, &simulation.neighbours));
    }
    assert_ok(mf_rdf_result(&rdf, 1, g, NULL));
    mf_rdf_clear(&rdf);
    mf_simulation_clear(&simulation);
}

static void assert_dynamics_gives_unity(struct fluid *fluid, uint64_t every, uint64_t seed,
                                        const char *what) {
    struct comoments replicas;
    assert_ok(mf_comoments_init(&replicas, BINS));
    for (uint64_t k = 0; k < replicas_count(); k++) {
        double g[BINS];
        fluid->setup.seed = seed + k;
        sample_dynamics(&fluid->setup, every, g);
        mf_comoments_add(&replicas, g);
    }
    assert_unity(&replicas, what);
    mf_comoments_clear(&replicas);
    fluid_clear(fluid);
}

static void test_ideal_gas_has_no_structure_when_particles_fly_freely(void **state) {
    (void)state;
    static const char *const what[] = {"flight in 2D", "flight in 3D"};
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct fluid fluid;
        fluid_ideal_gas(&fluid, dimensions, PARTICLES, 0.05);
        fluid.setup.omega = NULL;
        fluid.setup.integrator = &mf_velocity_verlet;
        assert_dynamics_gives_unity(&fluid, 20, 100, what[dimensions - 2]);
    }
}

static void test_ideal_gas_has_no_structure_when_there_are_friction_and_noise(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int v = 0; v < variant_count; v++)
        for (int dimensions = 2; dimensions <= 3; dimensions++) {
            struct fluid fluid;
            char what[80];
            // DPD velocity Verlet gives even the ideal gas some structure, which falls with Δt (G.
            // Besold et al., Phys. Rev. E 62, R7611 (2000)). Measured in 2D at density 10, g at
            // 0.25 to 0.5: 0.960 at Δt = 0.04, 0.993 at 0.01, 0.998(2) at 0.0025.
            fluid_ideal_gas(&fluid, dimensions, PARTICLES, 0.001);
            fluid.setup.precision = (int)variants[v].precision;
            variants_select(&variants[v]);
            snprintf(what, sizeof what, "friction and noise in %dD, %s", dimensions,
                     variants[v].name);
            assert_dynamics_gives_unity(&fluid, 50, 100 + 1000 * (uint64_t)v, what);
        }
    variants_select(&variants[0]);
}

/// g of one Markov chain with a potential that is 0 everywhere, from a lattice.
static void sample_monte_carlo(const struct box *box, const struct table *nothing, uint64_t seed,
                               double *g) {
    struct metropolis metropolis;
    struct rdf rdf;
    assert_ok(mf_metropolis_init(&metropolis, box,
                                 &(struct composition){.types = 1, .count = {PARTICLES}}, nothing,
                                 1, seed));
    // Steps up to 0.07 to 0.09: what is left of the lattice's order is far below the noise.
    assert_ok(mf_metropolis_equilibrate(&metropolis, 1000));
    assert_ok(mf_rdf_init(&rdf, &bins, box, PARTICLES, 0, SAMPLES));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_metropolis_run(&metropolis, 20));
        assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
    }
    assert_int_equal(metropolis.accepted, metropolis.tried);
    assert_ok(mf_rdf_result(&rdf, 1, g, NULL));
    mf_rdf_clear(&rdf);
    mf_metropolis_clear(&metropolis);
}

static void test_ideal_gas_has_no_structure_when_sampled_by_metropolis(void **state) {
    (void)state;
    static const char *const what[] = {"Metropolis in 2D", "Metropolis in 3D"};
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct fluid fluid;
        struct table nothing;
        struct comoments replicas;
        fluid_ideal_gas(&fluid, dimensions, PARTICLES, 0.01);
        fluid_no_potential(&nothing);
        assert_ok(mf_comoments_init(&replicas, BINS));
        for (uint64_t k = 0; k < replicas_count(); k++) {
            double g[BINS];
            sample_monte_carlo(&fluid.setup.box, &nothing, 200 + k, g);
            mf_comoments_add(&replicas, g);
        }
        assert_unity(&replicas, what[dimensions - 2]);
        mf_comoments_clear(&replicas);
        mf_table_clear(&nothing);
        fluid_clear(&fluid);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ideal_gas_has_no_structure_when_particles_fly_freely),
        cmocka_unit_test(test_ideal_gas_has_no_structure_when_there_are_friction_and_noise),
        cmocka_unit_test(test_ideal_gas_has_no_structure_when_sampled_by_metropolis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
