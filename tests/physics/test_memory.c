// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction that remembers leaves the equilibrium alone: temperatures, velocities, hidden variables
// and g(r) of the standard fluid, also where it is ten times as strong.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/remembering.h"
#include "shared/testing.h"
#include "shared/watched.h"

#include <math.h>
#include <stdlib.h>

enum { ALL = REMEMBERING_SLOW | REMEMBERING_RATTLE | REMEMBERING_ACROSS };

/// Standard errors by which a temperature may be off, beside the error of the time step: one false
/// alarm in 15,000, with fixed seeds.
static const double deviations = 4, step_error = 0.003;

/// As in test_groot_warren, for a shorter run.
static const double rdf_tolerance = 0.015;

static struct thermodynamics_summary simulate(const struct simulation_setup *setup,
                                              struct simulation *simulation, struct rdf *rdf) {
    const struct measure_plan plan = {.equilibration = 3000, .samples = 400, .every = 20};
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(mf_simulation_init(simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(
        simulation, &plan, (struct watched){.rdf = rdf, .thermodynamics = &thermodynamics}, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    print_message("temperature %.4f(%.4f), configurational %.4f(%.4f), U/N %.4f(%.4f)\n",
                  s.temperature, s.temperature_error, s.temperature_configurational,
                  s.temperature_configurational_error, s.potential_energy,
                  s.potential_energy_error);
    mf_thermodynamics_clear(&thermodynamics);
    return s;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Kolmogorov and Smirnov's test of a standard normal law with a false alarm in 10,000: D sqrt(n)
/// above 2.22.
static void assert_normal(double *value, size_t count) {
    double distance = 0;
    qsort(value, count, sizeof *value, compare);
    for (size_t k = 0; k < count; k++) {
        const double below = 0.5 * erfc(-value[k] * M_SQRT1_2);
        distance = fmax(distance, fabs(below - ((double)k + 0.5) / (double)count));
    }
    print_message("%zu values, D sqrt(n) = %.2f\n", count, distance * sqrt((double)count));
    assert_true(distance * sqrt((double)count) < 2.22);
}

/// Hidden variables of one configuration: those of different pairs are independent.
static void assert_variables_normal(const struct pair_memory *memory) {
    double *values = calloc(memory->pairs.count, sizeof *values);
    assert_non_null(values);
    for (int k = 0; k < memory->variables; k++) {
        size_t count = 0;
        for (size_t n = 0; n < memory->pairs.count; n++)
            if (!isnan(memory->pairs.value[0][n]))
                values[count++] = memory->pairs.value[k][n];
        assert_true(count > 1000);
        assert_normal(values, count);
    }
    free(values);
}

static void assert_velocities_normal(const struct particles *particles) {
    double *values = calloc(particles->count, sizeof *values);
    assert_non_null(values);
    for (int d = 0; d < 3; d++) {
        memcpy(values, particles->velocity[d], particles->count * sizeof *values);
        assert_normal(values, particles->count);
    }
    free(values);
}

/// The published g(r) at 0.005, 0.015, … in bins of 0.05.
static void assert_published(const struct rdf *rdf) {
    struct data_table table;
    double g[40], error[40], largest = 0;
    assert_ok(mf_rdf_result(rdf, 1, g, error));
    assert_ok(mf_data_table_read(&table, "tests/reference_data/groot_warren_rdf.txt", 2));
    for (size_t k = 4; k < rdf->bins.count; k++) {
        double sum = 0, weight = 0;
        for (size_t row = 0; row < table.rows; row++) {
            const double r = table.values[row * table.columns];
            if (r > mf_rdf_bins_edge(&rdf->bins, k) && r < mf_rdf_bins_edge(&rdf->bins, k + 1)) {
                sum += r * r * table.values[row * table.columns + 1];
                weight += r * r;
            }
        }
        assert_true(weight > 0);
        largest = fmax(largest, fabs(g[k] - sum / weight));
    }
    print_message("g(r) off by %.4f at most\n", largest);
    assert_true(largest < rdf_tolerance);
    mf_data_table_clear(&table);
}

static void check(double strength, double time_step) {
    struct remembering r;
    struct simulation simulation;
    struct rdf rdf;
    remembering_make(&r, 1500, time_step, ALL);
    for (int k = 0; k < 2 * TABLE_INTERVALS; k++) {
        r.slow.coefficient[k] *= strength;
        r.rattle.coefficient[k] *= strength;
        r.across.coefficient[k] *= strength;
    }
    const struct simulation_setup *setup = &r.fluid.setup;
    const struct rdf_bins bins = {.width = 0.05, .count = 40};
    assert_ok(mf_rdf_init(&rdf, &bins, &setup->box, 1500, 1, 400));
    const struct thermodynamics_summary s = simulate(setup, &simulation, &rdf);
    assert_close(s.temperature, 1, step_error + deviations * s.temperature_error);
    assert_close(s.temperature_configurational, 1,
                 step_error + deviations * s.temperature_configurational_error);
    assert_published(&rdf);
    assert_variables_normal(&simulation.memory);
    assert_velocities_normal(&simulation.particles);
    mf_rdf_clear(&rdf);
    mf_simulation_clear(&simulation);
    remembering_clear(&r);
}

static void test_memory_leaves_the_standard_fluid_alone(void **state) {
    (void)state;
    check(1, 0.02);
}

/// Kernels and friction ten times as strong: ω by sqrt(10).
static void test_a_strong_memory_does_too(void **state) {
    (void)state;
    check(sqrt(10), 0.02);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        LENGTH_ONLY_LONG(cmocka_unit_test(test_memory_leaves_the_standard_fluid_alone)),
        cmocka_unit_test(test_a_strong_memory_does_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
