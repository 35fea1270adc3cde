// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo, Boltzmann and hypernetted-chain inversion find a known potential from its
// own g(r), but for the direction that g(r) hardly sees: the ramp A (1 − r/r_c).
#include "curves/formula.h"
#include "dynamics/metropolis.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/inversions.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"

enum { PARTICLES = 200, MAX_BINS = 40 };

/// Below this g the pairs are too few to tell the potential.
static const double well_known = 0.1;

/// The start, −ln g, is off by this much at least without the ramp, so that there is something to
/// do. Measured: 0.31 (soft) and 0.75 (core and well).
static const double min_start_error = 0.2;

/// rms over the well-known bins without the ramp [k_B T]. Measured with six seeds of target and
/// inversion each: 0.018 to 0.029 (soft) and 0.009 to 0.045 (core and well). Since samples stop at
/// the precision asked for, one seed: 0.023 to 0.032 and 0.071. With targets of 1500 samples and
/// honest errors core and well came out at 0.019 to 0.095 (seeds 1 to 5), at the bound; with 6000
/// samples and a precision of 0.002, seeds 1 to 6: 0.008 to 0.047.
static const double potential_tolerance = 0.08;

/// The ramp itself [k_B T], which a target with errors of 0.004 leaves open: −0.8 to 0.02 (soft,
/// from −5.3 at the start) and −1.9 to 0.3 in the same runs.
static const double ramp_tolerance = 4;

/// With the pressure as a target the ramp is left what its error of 0.05 allows, with ∂P/∂A of 4.6:
/// 0.02 from imc and hnc, and a few times as much where a fit stops within 1.7 times the noise.
/// Measured: −0.01 (imc), 0.09 (ibi), 0.00 (hnc).
static const double ramp_tolerance_with_pressure = 0.2;

struct target_measured {
    double g[MAX_BINS], error[MAX_BINS], pressure;
};

/// g and the pressure of `potential` with standard errors, by Monte Carlo of the size that the
/// inversion uses.
static void measure_target(const struct fluid *fluid, const struct rdf_bins *bins,
                           struct target_measured *target) {
    enum { SAMPLES = 6000 };
    const struct box *box = &fluid->setup.box;
    const size_t particles = mf_composition_particles(&fluid->setup.composition);
    uint32_t counts[2];
    const struct pair_histogram pairs = {.width = 1, .bins = 1, .counts = counts};
    struct pair_sums sums;
    double virial = 0;
    struct metropolis metropolis;
    struct rdf rdf;
    assert_ok(mf_metropolis_init(&metropolis, box, &fluid->setup.composition, &fluid->potential,
                                 fluid->setup.temperature, 77));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 500));
    assert_ok(mf_rdf_init(&rdf, bins, box, particles, 0, SAMPLES));
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_ok(mf_metropolis_run(&metropolis, 4));
        assert_ok(mf_rdf_sample(&rdf, &metropolis.particles, &metropolis.neighbours));
        assert_ok(mf_metropolis_count(&metropolis, &pairs, &sums));
        virial += sums.virial / SAMPLES;
    }
    double volume = 1;
    for (int d = 0; d < box->dimensions; d++)
        volume *= box->length[d];
    target->pressure =
        ((double)particles * fluid->setup.temperature + virial / box->dimensions) / volume;
    assert_ok(mf_rdf_result(&rdf, 1, target->g, target->error));
    mf_rdf_clear(&rdf);
    mf_metropolis_clear(&metropolis);
}

/// Best A of Φ − truth = A (1 − r/r_c) over the well-known bins, and the rms of what it leaves.
static void compare_with_truth(const struct inverse_problem *problem, const double *phi,
                               double *ramp, double *rms) {
    double above = 0, below = 0, sum = 0, count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < problem->targets.bins.count; k++) {
            if (problem->targets.target[TARGET_RDF].value[k] < well_known)
                continue;
            const double r = mf_rdf_bins_centre(&problem->targets.bins, k);
            const double shape = 1 - r / mf_rdf_bins_range(&problem->targets.bins);
            double truth;
            mf_table_evaluate(problem->scene.potential, r, &truth, NULL, NULL);
            if (pass == 0) {
                above += shape * (phi[k] - truth);
                below += shape * shape;
            } else {
                const double left = phi[k] - truth - *ramp * shape;
                sum += left * left;
                count += 1;
            }
        }
        *ramp = above / below;
    }
    *rms = sqrt(sum / count);
}

static void assert_truth_is_found(const struct inverse_method *method, const struct fluid *fluid,
                                  const struct rdf_bins *bins, const struct target_measured *target,
                                  bool with_pressure, double precision) {
    static const double pressure_error = 0.05;
    double start[MAX_BINS], phi[MAX_BINS + 1], ramp, rms;
    struct inverse_step step;
    const struct inverse_problem problem = {
        .targets = {.bins = *bins,
                    .target[TARGET_RDF] = {.count = bins->count,
                                           .value = target->g,
                                           .error = target->error},
                    .target[TARGET_PRESSURE] = {.count = with_pressure,
                                                .value = &target->pressure,
                                                .error = &pressure_error}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = fluid->setup,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    for (size_t k = 0; k < bins->count; k++)
        start[k] = -fluid->setup.temperature * log(fmax(target->g[k], 1e-3));
    compare_with_truth(&problem, start, &ramp, &rms);
    print_message("-ln g: rms without the ramp %.3f, ramp %.3f\n", rms, ramp);
    assert_true(rms > min_start_error);
    inversions_run(method, &problem, precision, phi, NULL, &step);
    compare_with_truth(&problem, phi, &ramp, &rms);
    print_message("found: rms without the ramp %.4f, ramp %.3f(%.3f), dP/dA %.2f\n", rms, ramp,
                  step.ramp.error, step.ramp.bulk);
    assert_true(step.converged);
    assert_true(rms < potential_tolerance);
    assert_true(fabs(ramp) < (with_pressure ? ramp_tolerance_with_pressure : ramp_tolerance));
    // The band is that of the data; ibi and hnc stop as soon as the error of g is in its noise,
    // here with a ramp of five standard errors.
    if (method == &mf_imc)
        assert_true(fabs(ramp) < 4 * step.ramp.error);
}

/// Where g reaches far beyond the potential, it agrees before its ramp has settled. Until 0.2.0 imc
/// ended there with pressures that were too low by 3.4 to 6.5 of their errors.
static void test_imc_and_auto_have_the_pressure_when_g_reaches_far(void **state) {
    (void)state;
    const struct rdf_bins bins = {0, 0.05, 40};
    double phi[MAX_BINS + 1];
    struct fluid fluid;
    struct target_measured target;
    struct inverse_step step;
    fluid_groot_warren(&fluid, 300, 0.01);
    measure_target(&fluid, &bins, &target);
    struct inverse_problem problem = {.targets = {.bins = bins,
                                                  .target[TARGET_RDF] = {.count = bins.count,
                                                                         .value = target.g,
                                                                         .error = target.error}},
                                      .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
                                      .scene = fluid.setup,
                                      .core_threshold = 1e-3,
                                      .core_stiffness = 2000,
                                      .threads = 2};
    for (int run = 0; run < (length_is_long() ? 4 : 1); run++) {
        problem.seed = 5 + run / 2;
        inversions_run(run % 2 ? &mf_automatic : &mf_imc, &problem, 0.003, phi, NULL, &step);
        const double found = step.extra[4], open = step.ramp.bulk_open;
        print_message("pressure %.2f(%.2f), truth %.2f\n", found, open, target.pressure);
        assert_true(step.converged);
        assert_true(fabs(found - target.pressure) < 2.5 * open);
    }
    fluid_clear(&fluid);
}

static void check_soft(const struct inverse_method *method, bool with_pressure) {
    static const struct rdf_bins bins = {0, 0.05, 20};
    static struct target_measured target; // the same for all methods
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    if (!(target.pressure > 0))
        measure_target(&fluid, &bins, &target);
    assert_truth_is_found(method, &fluid, &bins, &target, with_pressure, 0.004);
    fluid_clear(&fluid);
}

static void test_imc_finds_the_truth_when_the_potential_is_soft(void **state) {
    (void)state;
    check_soft(&mf_imc, false);
}

static void test_ibi_finds_the_truth_when_the_potential_is_soft(void **state) {
    (void)state;
    check_soft(&mf_ibi, false);
}

static void test_hnc_finds_the_truth_when_the_potential_is_soft(void **state) {
    (void)state;
    check_soft(&mf_hnc, false);
}

static void test_auto_finds_the_truth_when_the_potential_is_soft(void **state) {
    (void)state;
    check_soft(&mf_automatic, false);
}

static void test_imc_finds_the_ramp_too_when_the_pressure_is_known(void **state) {
    (void)state;
    check_soft(&mf_imc, true);
}

static void test_ibi_finds_the_ramp_too_when_the_pressure_is_known(void **state) {
    (void)state;
    check_soft(&mf_ibi, true);
}

static void test_hnc_finds_the_ramp_too_when_the_pressure_is_known(void **state) {
    (void)state;
    check_soft(&mf_hnc, true);
}

static void test_auto_finds_the_ramp_too_in_two_dimensions(void **state) {
    (void)state;
    static const struct rdf_bins bins = {0, 0.05, 20};
    struct fluid fluid;
    struct target_measured target;
    fluid_soft_discs(&fluid, PARTICLES, 0.01);
    measure_target(&fluid, &bins, &target);
    assert_truth_is_found(&mf_automatic, &fluid, &bins, &target, true, 0.004);
    fluid_clear(&fluid);
}

static void test_imc_finds_the_truth_when_it_has_a_core_and_a_well(void **state) {
    (void)state;
    static const struct rdf_bins bins = {0, 0.06, 30};
    struct fluid fluid;
    struct target_measured target;
    struct formula_lennard_jones_parameters parameters = {1, 1, 1.8};
    const struct curve curve = {&mf_formula_lennard_jones, &parameters};
    fluid_lennard_jones(&fluid, PARTICLES, 0.01);
    // A short cutoff makes it quick; hot, so that the chains mix soon.
    mf_table_clear(&fluid.potential);
    assert_ok(mf_table_init_potential(&fluid.potential, &curve));
    fluid.setup.temperature = 1.5;
    measure_target(&fluid, &bins, &target);
    assert_truth_is_found(&mf_imc, &fluid, &bins, &target, false, 0.002);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        LENGTH_ONLY_LONG(cmocka_unit_test(test_ibi_finds_the_truth_when_the_potential_is_soft)),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_hnc_finds_the_truth_when_the_potential_is_soft)),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_imc_finds_the_truth_when_the_potential_is_soft)),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_auto_finds_the_truth_when_the_potential_is_soft)),
        cmocka_unit_test(test_imc_finds_the_ramp_too_when_the_pressure_is_known),
        cmocka_unit_test(test_ibi_finds_the_ramp_too_when_the_pressure_is_known),
        cmocka_unit_test(test_hnc_finds_the_ramp_too_when_the_pressure_is_known),
        cmocka_unit_test(test_auto_finds_the_ramp_too_in_two_dimensions),
        cmocka_unit_test(test_imc_and_auto_have_the_pressure_when_g_reaches_far),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_imc_finds_the_truth_when_it_has_a_core_and_a_well)),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
