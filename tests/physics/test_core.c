// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where the target is 0 the potential is continued inwards by a guess, the stiffness of the core
// (mf_core_fill). It must not decide anything: whatever the guess, the potential that an inversion
// finds gives the same g(r), within the noise of the fits.
#include "curves/formula.h"
#include "dynamics/metropolis.h"
#include "shared/fluids.h"
#include "shared/inversions.h"
#include "shared/testing.h"

enum { PARTICLES = 250, BINS = 36, BLOCKS = 24, SAMPLES = 120 };

static const struct rdf_bins bins = {0, 0.05, BINS};
static const struct composition composition = {.types = 1, .count = {PARTICLES}};

/// Two guesses [k_B T_0/λ²]; the curvature of this potential there is some 3000.
static const double soft = 300, hard = 15000;

/// Statistical error of g that the fits ask for.
static const double precision = 0.002;

/// g, as the means of blocks.
static void sample_g(const struct table *potential, const struct fluid *fluid, uint64_t seed,
                     struct comoments *blocks) {
    struct metropolis metropolis;
    assert_ok(mf_metropolis_init(&metropolis, &fluid->setup.box, &composition, potential,
                                 fluid->setup.temperature, seed));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 600));
    assert_ok(mf_comoments_init(blocks, BINS));
    for (int block = 0; block < BLOCKS; block++) {
        struct rdf rdf;
        double mean[BINS];
        assert_ok(mf_rdf_init(&rdf, &bins, &fluid->setup.box, PARTICLES, 0, SAMPLES));
        assert_ok(mf_metropolis_run(&metropolis, 60));
        for (int sample = 0; sample < SAMPLES; sample++) {
            assert_ok(mf_metropolis_run(&metropolis, 8));
            assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
        }
        assert_ok(mf_rdf_result(&rdf, 1, mean, NULL));
        mf_comoments_add(blocks, mean);
        mf_rdf_clear(&rdf);
    }
    mf_metropolis_clear(&metropolis);
}

/// Find the potential of the target by inverse Monte Carlo; returns the noise of the fit.
static double invert(const struct inverse_problem *problem, double *phi) {
    struct inverse_step step;
    inversions_run(&mf_imc, problem, precision, phi, &step);
    assert_true(step.converged);
    return step.noise;
}

/// rms over all bins of the difference of g of two potentials, and its standard error by sampling.
static double compare(const struct fluid *fluid, const struct potential_grid *grid,
                      const double *const phi[2], double *error) {
    struct comoments blocks[2];
    double square = 0, variance = 0;
    for (int k = 0; k < 2; k++) {
        struct table table;
        assert_ok(mf_potential_grid_table(grid, phi[k], &table));
        sample_g(&table, fluid, 11 + (uint64_t)k, &blocks[k]);
        mf_table_clear(&table);
    }
    for (size_t k = 0; k < BINS; k++) {
        square += pow(blocks[1].mean[k] - blocks[0].mean[k], 2) / BINS;
        for (int n = 0; n < 2; n++)
            variance += mf_comoments_covariance(&blocks[n], k, k) / (BLOCKS - 1) / BINS;
    }
    print_message("g in the first known bin, at r = %.3f: %.4f and %.4f\n",
                  mf_rdf_bins_centre(&bins, grid->core[0]), blocks[0].mean[grid->core[0]],
                  blocks[1].mean[grid->core[0]]);
    for (int k = 0; k < 2; k++)
        mf_comoments_clear(&blocks[k]);
    *error = sqrt(variance);
    return sqrt(square);
}

static void test_core_model_does_not_matter_when_the_potential_is_fitted(void **state) {
    (void)state;
    struct fluid fluid;
    struct comoments target;
    struct potential_grid grid;
    double error[BINS], with_soft[BINS + 1], with_hard[BINS + 1], error_of_rms;
    const struct formula_lennard_jones_parameters parameters = {1, 1, 1.8};
    const struct curve curve = {&mf_formula_lennard_jones, (void *)&parameters};
    fluid_lennard_jones(&fluid, PARTICLES, 0.01);
    mf_table_clear(&fluid.potential);
    assert_ok(mf_table_init_potential(&fluid.potential, &curve));
    fluid.setup.temperature = 1.5;
    sample_g(&fluid.potential, &fluid, 10, &target);
    for (size_t k = 0; k < BINS; k++)
        error[k] = sqrt(mf_comoments_covariance(&target, k, k) / (BLOCKS - 1));
    struct inverse_problem problem = {
        .targets = {.bins = bins, .target[TARGET_RDF] = {BINS, target.mean, error, 0}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = soft,
        .seed = 5,
        .threads = 2};
    const double noise_soft = invert(&problem, with_soft);
    problem.core_stiffness = hard;
    const double noise_hard = invert(&problem, with_hard);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    const double *const phi[] = {with_soft, with_hard};
    const double rms = compare(&fluid, &grid, phi, &error_of_rms);
    const double noise =
        sqrt(noise_soft * noise_soft + noise_hard * noise_hard + error_of_rms * error_of_rms);
    print_message("rms of the difference %.4f, noise %.4f\n", rms, noise);
    assert_true(rms < mf_inverse_noise_margin * noise);
    mf_potential_grid_clear(&grid);
    mf_comoments_clear(&target);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_core_model_does_not_matter_when_the_potential_is_fitted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
