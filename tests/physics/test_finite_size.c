// SPDX-License-Identifier: GPL-3.0-or-later
//
// g(r) of few particles taken to many: isotopes, whose partial g(r) are all that of the whole, and
// gases that do not see each other.
#include "base/statistics.h"
#include "observe/finite_size.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/watched.h"
#include "shared/testing.h"

#include <math.h>

enum { FEW = 100, MANY = 800, BINS = 32, PAIRS = 3, RUNS = 4 };

static const struct rdf_bins bins = {0, 0.05, BINS};

/// Mean of g over the volume within 1.6, over runs of other seeds: one number a pair type. The
/// last bins are those that a closed system shifts; the sum of all shifts as they do.
struct means {
    double value[PAIRS], error[PAIRS];
};

/// 30 A to 70 B.
static struct composition shares(int64_t particles) {
    return (struct composition){.types = 2, .count = {particles * 3 / 10, particles * 7 / 10}};
}

static void sample(struct fluid *fluid, int64_t samples, struct rdf *rdf) {
    static struct simulation simulation;
    const struct measure_plan plan = {.equilibration = 1000, .samples = samples, .every = 10};
    double temperature;
    assert_ok(mf_simulation_init(&simulation, &fluid->setup, NULL));
    assert_ok(mf_rdf_init_mixture(rdf, &bins, &fluid->setup.box, &fluid->setup.composition, 1,
                                  (size_t)samples));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(&simulation, &plan, (struct watched){.rdf = rdf}, NULL));
    mf_simulation_clear(&simulation);
}

/// The mean of one pair type, taken to MANY.
static double convert(const struct rdf *rdf, const double *g, const double *error, int pair) {
    const struct composition *composition = &rdf->composition;
    double sum = 0, volume = 0;
    for (size_t k = 0; k < BINS; k++) {
        const double shell = mf_box_shell_volume(&rdf->box, mf_rdf_bins_edge(&bins, k),
                                                 mf_rdf_bins_edge(&bins, k + 1));
        sum += shell * g[k];
        volume += shell;
    }
    const struct finite_size_fluid fluid = {.box = &rdf->box, .composition = composition};
    return sum / volume *
           mf_finite_size_factor_of(&bins, g, error, &fluid, pair,
                                    (double)mf_composition_particles(composition), MANY);
}

static struct means measure(int64_t particles, const struct table *potential, int64_t samples) {
    struct running_mean sum[PAIRS] = {{0}};
    struct means means;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        struct fluid fluid;
        struct rdf rdf;
        double g[PAIRS * BINS], error[PAIRS * BINS];
        fluid_groot_warren(&fluid, particles, 0.02);
        fluid.setup.composition = shares(particles);
        fluid.setup.potential = potential;
        fluid.setup.seed = seed;
        sample(&fluid, samples, &rdf);
        assert_ok(mf_rdf_result(&rdf, 1, g, error));
        for (int pair = 0; pair < PAIRS; pair++)
            mf_statistics_add(&sum[pair],
                              convert(&rdf, g + pair * BINS, error + pair * BINS, pair));
        mf_rdf_clear(&rdf);
        fluid_clear(&fluid);
    }
    for (int pair = 0; pair < PAIRS; pair++) {
        means.value[pair] = sum[pair].mean;
        means.error[pair] = mf_statistics_standard_error(&sum[pair]);
    }
    return means;
}

/// Agreement within five errors, of four runs each (Student's t: one false alarm in 500
/// comparisons, of which there are 6, with fixed seeds), and within what s may be off by, 0.15 of
/// its 1/FEW: oscillations cut off at 1.6 leave that much, and terms in dg/dρ.
static void compare(const struct table *potential, const char *name) {
    const int64_t part = length_is_long() ? 1 : 3;
    const struct means few = measure(FEW, potential, 8000 / part),
                       many = measure(MANY, potential, 800 / part);
    for (int pair = 0; pair < PAIRS; pair++) {
        print_message("%s, pairs %d: from %d %.4f(%.4f), of %d %.4f(%.4f)\n", name, pair, FEW,
                      few.value[pair], few.error[pair], MANY, many.value[pair], many.error[pair]);
        assert_close(few.value[pair], many.value[pair],
                     5 * hypot(few.error[pair], many.error[pair]) + 0.15 / FEW);
    }
}

static void test_finite_size_of_isotopes_is_that_of_the_whole(void **state) {
    (void)state;
    struct fluid fluid;
    struct table parts[PAIRS], potential;
    fluid_groot_warren(&fluid, FEW, 0.02);
    for (int pair = 0; pair < PAIRS; pair++)
        parts[pair] = fluid.potential;
    assert_ok(mf_table_stack(&potential, parts, PAIRS));
    compare(&potential, "isotopes");
    mf_table_clear(&potential);
    fluid_clear(&fluid);
}

/// A-A and B-B as if alone, at densities 0.9 and 2.1, A-B ideal.
static void test_finite_size_of_gases_that_do_not_see_each_other(void **state) {
    (void)state;
    struct fluid fluid;
    struct table parts[PAIRS], potential;
    fluid_groot_warren(&fluid, FEW, 0.02);
    parts[0] = parts[2] = fluid.potential;
    fluid_no_potential(&parts[1]);
    assert_ok(mf_table_stack(&potential, parts, PAIRS));
    compare(&potential, "gases");
    mf_table_clear(&parts[1]);
    mf_table_clear(&potential);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finite_size_of_isotopes_is_that_of_the_whole),
        cmocka_unit_test(test_finite_size_of_gases_that_do_not_see_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
