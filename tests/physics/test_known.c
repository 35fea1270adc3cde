// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inversions beside a part of the potential that is known find the rest, within its band: the
// attraction of Lennard-Jones beside the repulsion of Weeks, Chandler and Andersen (J. Chem. Phys.
// 54, 5237, 1971), nothing beside all of it, and the repulsion of a mixture of screened charges.
// The pressure, a target too, is of both parts.
#include "curves/expression_law.h"
#include "curves/formula.h"
#include "curves/sum.h"
#include "dynamics/metropolis.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/inversions.h"
#include "shared/testing.h"

#include <math.h>

enum { MAX_PAIRS = 3, MAX_BINS = 50 };

/// Largest rms of (Φ − truth)/error. Errors of neighbouring bins go together: it scatters about 1.
static const double largest = 1.3;

/// A fluid whose potential is a sum, and what Monte Carlo of the size of an inversion's measures.
struct twin {
    struct fluid fluid;
    struct rdf_bins bins;
    int pairs;
    struct curve known[MAX_PAIRS], rest[MAX_PAIRS]; ///< rest without a family: nothing is left
    double g[MAX_PAIRS * MAX_BINS], error[MAX_PAIRS * MAX_BINS], pressure;
};

static struct curve lennard_jones(double cutoff) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    ((struct formula_lennard_jones_parameters *)curve.parameters)->cutoff = cutoff;
    return curve;
}

static struct curve expression(const char *formula, double inner, double cutoff) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_expression_potential));
    struct expression_parameters *parameters = curve.parameters;
    snprintf(parameters->formula, sizeof parameters->formula, "%s", formula);
    parameters->inner_cutoff = inner;
    parameters->cutoff = cutoff;
    assert_ok(mf_curve_check(&curve));
    return curve;
}

/// The fluid of the curves, at this density and temperature.
static void make_fluid(struct twin *twin, int64_t count, double density, double temperature) {
    struct simulation_setup *setup = &twin->fluid.setup;
    struct table part[MAX_PAIRS];
    for (int pair = 0; pair < twin->pairs; pair++)
        assert_ok(twin->rest[pair].family
                      ? mf_sum_tabulate(&part[pair], &twin->known[pair], &twin->rest[pair])
                      : mf_table_init_potential(&part[pair], &twin->known[pair]));
    fluid_lennard_jones(&twin->fluid, count, 0.004);
    mf_table_clear(&twin->fluid.potential);
    assert_ok(mf_table_stack(&twin->fluid.potential, part, twin->pairs));
    for (int pair = 0; pair < twin->pairs; pair++)
        mf_table_clear(&part[pair]);
    setup->box = mf_box_cube((double)count / density);
    setup->temperature = temperature;
    if (twin->pairs > 1)
        setup->composition =
            (struct composition){.types = 2, .count = {count / 2, count / 2}, .name = {"A", "B"}};
}

static void measure(struct twin *twin) {
    enum { SAMPLES = 4000 };
    const struct simulation_setup *setup = &twin->fluid.setup;
    const double particles = (double)mf_composition_particles(&setup->composition);
    uint32_t counts[2 * MAX_PAIRS];
    const struct pair_histogram histogram = {
        .width = 1, .bins = 1, .pairs = (size_t)twin->pairs, .counts = counts};
    struct pair_sums sums;
    struct metropolis metropolis;
    struct rdf rdf;
    double virial = 0;
    assert_ok(mf_metropolis_init(&metropolis, &setup->box, &setup->composition, setup->potential,
                                 setup->temperature, 77));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 1000));
    assert_ok(mf_rdf_init_mixture(&rdf, &twin->bins, &setup->box, &setup->composition, 0, SAMPLES));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_metropolis_run(&metropolis, 5));
        assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
        assert_ok(mf_metropolis_count(&metropolis, &histogram, &sums));
        virial += sums.virial / SAMPLES;
    }
    twin->pressure = (particles * setup->temperature + virial / 3) / mf_box_volume(&setup->box);
    assert_ok(mf_rdf_result(&rdf, 1, twin->g, twin->error));
    mf_rdf_clear(&rdf);
    mf_metropolis_clear(&metropolis);
}

/// rms of (Φ − truth)/error over the points of a pair type that have an error.
static double deviation(const struct twin *twin, int pair, const double *phi, const double *error) {
    const size_t points = twin->bins.count + 1, first = (size_t)pair * points;
    double squares = 0, count = 0;
    for (size_t k = 0; k + 1 < points; k++) {
        const double r = mf_rdf_bins_centre(&twin->bins, k);
        const double truth = twin->rest[pair].family ? mf_sum_shifted(&twin->rest[pair], r) : 0;
        if (!(error[first + k] > 0))
            continue;
        squares += pow((phi[first + k] - truth) / error[first + k], 2);
        count++;
    }
    assert_true(count > 10);
    return sqrt(squares / count);
}

static void assert_rest_is_found(struct twin *twin) {
    static const double pressure_error = 0.03;
    double phi[MAX_PAIRS * (MAX_BINS + 1)], error[MAX_PAIRS * (MAX_BINS + 1)];
    struct inverse_step step;
    measure(twin);
    struct inverse_problem problem = {
        .targets = {.bins = twin->bins,
                    .target[TARGET_RDF] = {.count = (size_t)twin->pairs * twin->bins.count,
                                           .value = twin->g,
                                           .error = twin->error},
                    .target[TARGET_PRESSURE] = {.count = 1,
                                                .value = &twin->pressure,
                                                .error = &pressure_error}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .known = {twin->pairs, twin->known},
        .scene = twin->fluid.setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    problem.scene.potential = NULL;
    inversions_run(&mf_imc, &problem, 0.004, phi, error, &step);
    assert_true(step.converged);
    for (int pair = 0; pair < twin->pairs; pair++) {
        const double z = deviation(twin, pair, phi, error);
        print_message("pair type %d: (phi - truth)/error %.2f rms\n", pair, z);
        assert_true(z < largest);
    }
}

static void clear(struct twin *twin) {
    fluid_clear(&twin->fluid);
    for (int pair = 0; pair < twin->pairs; pair++) {
        mf_curve_clear(&twin->known[pair]);
        mf_curve_clear(&twin->rest[pair]);
    }
}

static void test_attraction_is_found_beside_the_repulsion(void **state) {
    (void)state;
    struct twin twin = {.bins = {0, 0.05, 50}, .pairs = 1};
    twin.known[0] = lennard_jones(pow(2, 1.0 / 6));
    twin.rest[0] = expression("4*(1/max(r,1.122462048)^12 - 1/max(r,1.122462048)^6)", 0, 2.5);
    make_fluid(&twin, 300, 0.7, 1.2);
    assert_rest_is_found(&twin);
    clear(&twin);
}

static void test_nothing_is_found_beside_the_whole(void **state) {
    (void)state;
    struct twin twin = {.bins = {0, 0.05, 50}, .pairs = 1};
    twin.known[0] = lennard_jones(2.5);
    make_fluid(&twin, 300, 0.7, 1.2);
    assert_rest_is_found(&twin);
    clear(&twin);
}

/// The charges reach farther than the target.
static void test_repulsion_is_found_beside_screened_charges(void **state) {
    (void)state;
    struct twin twin = {.bins = {0, 0.05, 40}, .pairs = 3};
    for (int pair = 0; pair < 3; pair++) {
        twin.known[pair] = expression(pair == 1 ? "-4*exp(-r/0.8)/r" : "4*exp(-r/0.8)/r", 0.5, 3);
        twin.rest[pair] = lennard_jones(pow(2, 1.0 / 6));
    }
    make_fluid(&twin, 300, 0.4, 1);
    assert_rest_is_found(&twin);
    clear(&twin);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_attraction_is_found_beside_the_repulsion),
        cmocka_unit_test(test_nothing_is_found_beside_the_whole),
        cmocka_unit_test(test_repulsion_is_found_beside_screened_charges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
