// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reported standard errors are honest: of many independent simulations of a small fluid, about
// 95 % find the truth within two of their own errors. The truth is the mean of all of them, whose
// error is a fourteenth of one's.
#include "base/statistics.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
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
    const struct motion_plan plan = {.every = 2, .lags = 25, .origin_every = 5, .fit_from = 0.5};
    struct simulation simulation;
    struct motion motion;
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(simulation_init(&simulation, setup, NULL));
    assert_ok(motion_init(&motion, &plan, &simulation, when.equilibration, 1200));
    assert_ok(thermodynamics_init(&thermodynamics, 300));
    assert_ok(measure_equilibrate(&simulation, &when, &temperature, NULL));
    const struct measure_targets targets = {.thermodynamics = &thermodynamics, .motion = &motion};
    assert_ok(measure_sample(&simulation, &when, targets, NULL));
    const struct thermodynamics_summary t = thermodynamics_result(&thermodynamics, 1);
    const struct motion_summary m = motion_result(&motion, NULL);
    *measured =
        (struct measured){{t.temperature, t.potential_energy, t.pressure, m.msd, m.green_kubo},
                          {t.temperature_error, t.potential_energy_error, t.pressure_error,
                           m.msd_error, m.green_kubo_error}};
    thermodynamics_clear(&thermodynamics);
    motion_clear(&motion);
    simulation_clear(&simulation);
}

static void assert_covered(const struct measured measured[SEEDS], int kind) {
    struct running_mean values = {0}, squares = {0};
    double covered = 0;
    for (int k = 0; k < SEEDS; k++) {
        statistics_add(&values, measured[k].value[kind]);
        statistics_add(&squares, measured[k].error[kind] * measured[k].error[kind]);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_cover_the_truth_of_a_fluid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
