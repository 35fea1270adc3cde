// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reported standard errors are honest: of many independent simulations of a small fluid, about
// 95 % find the truth within two of their own errors. The truth is the mean of all of them, whose
// error is a fourteenth of one's.
#include "base/statistics.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/watched.h"
#include "shared/testing.h"

#include <math.h>

enum { SEEDS = 200, TEMPERATURE = 0, ENERGY, PRESSURE, DIFFUSION_MSD, DIFFUSION_GREEN_KUBO, KINDS };

static const char *const names[KINDS] = {"temperature", "energy", "pressure", "D of the MSD",
                                         "D of Green and Kubo"};

/// Of 200 seeds the share has a standard error of 0.015; four of these. Each of five numbers would
/// stray by chance with one set of seeds in 10^4.
static const double share_band = 0.06;

struct measured {
    double value[KINDS], error[KINDS];
};

static void measure(const struct simulation_setup *setup, struct measured *measured) {
    // 48 τ of a fluid whose velocities remember 0.3 τ: samples at 0.16 τ are correlated, and 24
    // windows overlap.
    const struct measure_plan when = {.equilibration = 150, .samples = 300, .every = 4};
    const struct motion_plan plan = {.every = 2, .lags = 25, .origin_every = 5};
    struct simulation simulation;
    struct motion motion;
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_motion_init(&motion, &plan, &simulation, when.equilibration, 1200));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &when, &temperature, NULL));
    const struct watched observables = {.thermodynamics = &thermodynamics, .motion = &motion};
    assert_ok(watched_sample(&simulation, &when, observables, NULL));
    const struct thermodynamics_summary t = mf_thermodynamics_result(&thermodynamics, 1);
    const struct motion_summary m = mf_motion_result(&motion, NULL);
    *measured =
        (struct measured){{t.temperature, t.potential_energy, t.pressure, m.msd, m.green_kubo},
                          {t.temperature_error, t.potential_energy_error, t.pressure_error,
                           m.msd_error, m.green_kubo_error}};
    mf_thermodynamics_clear(&thermodynamics);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
}

static void assert_covered(const struct measured measured[SEEDS], int kind) {
    struct running_mean values = {0}, squares = {0};
    double covered = 0;
    for (int k = 0; k < SEEDS; k++) {
        mf_statistics_add(&values, measured[k].value[kind]);
        mf_statistics_add(&squares, measured[k].error[kind] * measured[k].error[kind]);
    }
    for (int k = 0; k < SEEDS; k++)
        covered += fabs(measured[k].value[kind] - values.mean) < 2 * measured[k].error[kind];
    const double scatter = sqrt(values.squares / (SEEDS - 1));
    print_message("%s: %.4f; scatter of a run %.4f, its error %.4f; within two errors %.1f %%\n",
                  names[kind], values.mean, scatter, sqrt(squares.mean), 100 * covered / SEEDS);
    assert_close(covered / SEEDS, 0.95, share_band);
}

static void test_errors_cover_the_truth_of_a_fluid(void **state) {
    (void)state;
    static struct measured measured[SEEDS];
    struct fluid fluid;
    fluid_groot_warren(&fluid, 81, 0.04);
    for (int k = 0; k < SEEDS; k++) {
        fluid.setup.seed = 1000 + (uint64_t)k;
        measure(&fluid.setup, &measured[k]);
    }
    for (int kind = 0; kind < KINDS; kind++)
        assert_covered(measured, kind);
    fluid_clear(&fluid);
}

/// The mean over bins of ratios from 60 runs is known to some 3 %; series of some 20 correlations
/// tell too little of their errors, up to 7 % (statistics.h).
static const double close_band = 0.15;

/// Samples so close that even the means of 20 blocks, of 0.5 τ each, are correlated: a liquid near
/// its triple point. With the errors of independent blocks the scatter is 1.26 of them.
static void test_errors_of_close_samples_are_the_scatter_of_g(void **state) {
    (void)state;
    enum { BINS = 30, RUNS = 60, SAMPLES = 500, PARTICLES = 125 };
    const struct rdf_bins bins = {1, 0.05, BINS};
    const struct measure_plan when = {.equilibration = 1000, .samples = SAMPLES, .every = 5};
    struct running_mean g[BINS] = {{0}}, squares[BINS] = {{0}};
    struct fluid fluid;
    double temperature, ratio = 0;
    fluid_lennard_jones(&fluid, PARTICLES, 0.004);
    for (int k = 0; k < RUNS; k++) {
        struct simulation simulation;
        struct rdf rdf;
        double value[BINS], error[BINS];
        fluid.setup.seed = 3000 + (uint64_t)k;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_rdf_init(&rdf, &bins, &fluid.setup.box, PARTICLES, 2.5, SAMPLES));
        assert_ok(mf_measure_equilibrate(&simulation, &when, &temperature, NULL));
        assert_ok(watched_sample(&simulation, &when, (struct watched){.rdf = &rdf}, NULL));
        assert_ok(mf_rdf_result(&rdf, 1, value, error));
        for (int n = 0; n < BINS; n++) {
            mf_statistics_add(&g[n], value[n]);
            mf_statistics_add(&squares[n], error[n] * error[n]);
        }
        mf_rdf_clear(&rdf);
        mf_simulation_clear(&simulation);
    }
    for (int n = 0; n < BINS; n++)
        ratio += sqrt(g[n].squares / (RUNS - 1) / squares[n].mean) / BINS;
    print_message("scatter of g over its error, mean over bins: %.3f\n", ratio);
    assert_close(ratio, 1, close_band);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_cover_the_truth_of_a_fluid),
        cmocka_unit_test(test_errors_of_close_samples_are_the_scatter_of_g),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
