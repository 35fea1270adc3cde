// SPDX-License-Identifier: GPL-3.0-or-later
//
// An inversion ends at one potential, wherever it begins: beads of Weeks, Chandler and Andersen (J.
// Chem. Phys. 54, 5237, 1971) from the hypernetted chain, and from beads so soft that they overlap,
// which lack the bend of the core that few pairs reach.
#include "curves/formula.h"
#include "dynamics/metropolis.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/inversions.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { PARTICLES = 700, BINS = 80 };

static const struct rdf_bins bins = {0, 0.02, BINS};
static const double density = 0.8;

static void make_fluid(struct fluid *fluid) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    ((struct formula_lennard_jones_parameters *)curve.parameters)->cutoff = pow(2, 1.0 / 6);
    fluid_lennard_jones(fluid, PARTICLES, 0.004);
    mf_table_clear(&fluid->potential);
    assert_ok(mf_table_init_potential(&fluid->potential, &curve));
    fluid->setup.box = mf_box_cube(PARTICLES / density);
    fluid->setup.temperature = 1;
    mf_curve_clear(&curve);
}

static void measure(const struct fluid *fluid, double *g, double *error) {
    enum { SAMPLES = 4000 };
    const struct simulation_setup *setup = &fluid->setup;
    struct metropolis metropolis;
    struct rdf rdf;
    assert_ok(mf_metropolis_init(&metropolis, &setup->box, &setup->composition, setup->potential,
                                 setup->temperature, 77));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 500));
    assert_ok(mf_rdf_init_mixture(&rdf, &bins, &setup->box, &setup->composition, 0, SAMPLES));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_metropolis_run(&metropolis, 2));
        assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
    }
    assert_ok(mf_rdf_result(&rdf, 1, g, error));
    mf_rdf_clear(&rdf);
    mf_metropolis_clear(&metropolis);
}

static struct inverse_problem problem_of(const struct fluid *fluid, double *g, double *error,
                                         const struct curve *start) {
    struct inverse_problem problem = {
        .targets = {.bins = bins,
                    .target[TARGET_RDF] = {.count = BINS,
                                           .value = g,
                                           .error = error,
                                           .errors_of = TARGET_ERRORS_OF_SAMPLES}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true, .start = {start}},
        .scene = fluid->setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    problem.scene.potential = NULL;
    return problem;
}

/// −k_B T ln g, made smooth, stays within the errors of each bin: a repulsion is not bent where few
/// pairs are.
static void assert_start_follows_core(const struct fluid *fluid, double *g, double *error) {
    const struct inverse_problem problem = problem_of(fluid, g, error, NULL);
    struct inversion *inversion = calloc(1, sizeof *inversion);
    struct inversion_parameters settings;
    assert_non_null(inversion);
    mf_fields_set_defaults(mf_inversion_fields, &settings);
    settings.start = INVERSION_FROM_MEAN_FORCE;
    assert_ok(mf_inversion_create(inversion, &mf_imc, &problem, &settings));
    const struct potential_grid *grid = &inversion->state->grid;
    for (size_t a = 0; a < 6; a++) {
        const size_t bin = grid->known_bin[a];
        const double off = inversion->course.phi[grid->known_point[a]] + log(g[bin]);
        print_message("r = %.2f: off by %.3f, error %.3f\n", mf_rdf_bins_centre(&bins, bin), off,
                      error[bin] / g[bin]);
        assert_true(fabs(off) < 2.5 * error[bin] / g[bin]);
    }
    mf_inversion_destroy(inversion);
    free(inversion);
}

/// Invert; returns the first known bin.
static size_t invert(const struct fluid *fluid, double *g, double *target_error,
                     const struct curve *start, double *phi, double *error) {
    struct inverse_step step;
    struct inverse_problem problem = problem_of(fluid, g, target_error, start);
    size_t first = 0;
    inversions_run(&mf_imc, &problem, 0.004, phi, error, &step);
    assert_true(step.converged);
    while (!(error[first] > 0))
        first++;
    return first;
}

static void test_inversion_ends_at_one_potential_wherever_it_begins(void **state) {
    double g[BINS], target_error[BINS], phi[2][BINS + 1], error[2][BINS + 1], squares = 0;
    struct curve soft;
    struct fluid fluid;
    (void)state;
    assert_ok(mf_curve_create(&soft, &mf_formula_soft_repulsion));
    *(struct formula_soft_repulsion_parameters *)soft.parameters =
        (struct formula_soft_repulsion_parameters){.a = 100, .cutoff = 1};
    make_fluid(&fluid);
    measure(&fluid, g, target_error);
    assert_start_follows_core(&fluid, g, target_error);
    const size_t first = invert(&fluid, g, target_error, NULL, phi[0], error[0]);
    assert_true(invert(&fluid, g, target_error, &soft, phi[1], error[1]) == first);
    for (size_t k = first; k < BINS; k++) {
        const double off = (phi[1][k] - phi[0][k]) / hypot(error[0][k], error[1][k]);
        if (k < first + 4)
            print_message("r = %.2f: %.2f and %.2f, %.1f of their errors apart\n",
                          mf_rdf_bins_centre(&bins, k), phi[0][k], phi[1][k], off);
        assert_true(fabs(off) < 3);
        squares += off * off / (double)(BINS - first);
    }
    print_message("rms %.2f\n", sqrt(squares));
    assert_true(sqrt(squares) < 1.3);
    mf_curve_clear(&soft);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_ends_at_one_potential_wherever_it_begins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
