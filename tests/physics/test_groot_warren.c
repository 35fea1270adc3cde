// SPDX-License-Identifier: GPL-3.0-or-later
//
// The standard fluid of dissipative particle dynamics against published and independent values;
// tests/reference_data/README.md says where they come from.
#include "io/data_table.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/variants.h"

enum { PARTICLES = 3000 };

/// Standard errors by which a measured mean may differ from a reference: one false alarm in 15,000
/// comparisons, and there are 6 of them with fixed seeds, and 4 for each other variant.
static const double deviations = 4;

/// Standard error of the references' temperatures.
static const double temperature_error = 0.0007;

/// Our U/N and pressure at Δt = 0.01 against the values for Δt → 0. The systematic difference is
/// 0.002 in U/N (a quarter of that at 0.02) and nothing in the pressure; the statistical errors are
/// 0.0017 and 0.003, of the variants 0.002 and 0.006: no false alarms to speak of.
static const double energy_tolerance = 0.01, pressure_tolerance = 0.05;

/// In bins of 0.05 the statistical error of g is largest at 0.05 to 0.1, where it is 0.002, and
/// elsewhere below 0.001: five errors, no false alarms to speak of.
static const double rdf_tolerance = 0.01;

/// Run the fluid: `steps` of equilibration, then `samples` every 10 steps.
static struct thermodynamics_summary simulate(const struct simulation_setup *setup, int64_t steps,
                                              int64_t samples, struct rdf *rdf) {
    const struct measure_plan plan = {.equilibration = steps, .samples = samples, .every = 10};
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    double temperature;
    assert_ok(simulation_init(&simulation, setup, NULL));
    assert_ok(thermodynamics_init(&thermodynamics, (size_t)samples));
    assert_ok(measure_equilibrate(&simulation, &plan, &temperature, NULL));
    const struct measure_targets targets = {.rdf = rdf, .thermodynamics = &thermodynamics};
    assert_ok(measure_sample(&simulation, &plan, targets, NULL));
    const struct thermodynamics_summary s = thermodynamics_result(&thermodynamics, 1);
    print_message("time step %g, lambda %g: kinetic %.4f(%.4f), configurational %.4f(%.4f), U/N "
                  "%.4f(%.4f), pressure %.4f(%.4f)\n",
                  setup->time_step, setup->integrator_parameters.lambda, s.temperature,
                  s.temperature_error, s.temperature_configurational,
                  s.temperature_configurational_error, s.potential_energy, s.potential_energy_error,
                  s.pressure, s.pressure_error);
    thermodynamics_clear(&thermodynamics);
    simulation_clear(&simulation);
    return s;
}

static double allowed(double error) {
    return deviations * sqrt(error * error + temperature_error * temperature_error);
}

static void assert_temperatures(const struct thermodynamics_summary *s, double kinetic,
                                double configurational) {
    assert_close(s->temperature, kinetic, allowed(s->temperature_error));
    assert_close(s->temperature_configurational, configurational,
                 allowed(s->temperature_configurational_error));
}

/// The reference g in the wider bins of `rdf`, each of which holds whole bins of the table.
static void read_reference(const struct rdf *rdf, double *g) {
    struct data_table table;
    assert_ok(data_table_read(&table, "tests/reference_data/groot_warren_rdf.txt", 2));
    const size_t each = table.rows / rdf->bins.count;
    assert_int_equal(table.rows % rdf->bins.count, 0);
    for (size_t k = 0; k < rdf->bins.count; k++) {
        double sum = 0, volume = 0;
        for (size_t row = each * k; row < each * (k + 1); row++) {
            const double r = table.values[row * table.columns];
            const double shell = box_shell_volume(&rdf->box, r - 0.005, r + 0.005);
            sum += shell * table.values[row * table.columns + 1];
            volume += shell;
        }
        g[k] = sum / volume;
    }
    data_table_clear(&table);
}

static void test_standard_fluid_has_the_published_state_when_the_time_step_is_small(void **state) {
    (void)state;
    enum { BINS = 40, SAMPLES = 300 };
    struct fluid fluid;
    struct rdf rdf;
    double g[BINS], error[BINS], reference[BINS], largest = 0, largest_error = 0;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    // Beyond the cutoff, so that the RDF makes its own list.
    assert_ok(
        rdf_init(&rdf, &(struct rdf_bins){0, 0.05, BINS}, &fluid.setup.box, PARTICLES, 1, SAMPLES));
    const struct thermodynamics_summary s = simulate(&fluid.setup, 500, SAMPLES, &rdf);
    assert_close(s.potential_energy, 4.545, energy_tolerance);
    assert_close(s.pressure, 23.65, pressure_tolerance);
    // Kinetic: LAMMPS at this time step. Configurational: a quarter of the excess at twice it.
    assert_temperatures(&s, 1.0039, 1.0036);
    read_reference(&rdf, reference);
    rdf_result(&rdf, 1, g, error);
    for (int k = 0; k < BINS; k++) {
        assert_close(g[k], reference[k], rdf_tolerance);
        largest = fmax(largest, fabs(g[k] - reference[k]));
        largest_error = fmax(largest_error, error[k]);
    }
    print_message("g(r): largest difference %.4f, largest error %.4f\n", largest, largest_error);
    rdf_clear(&rdf);
    fluid_clear(&fluid);
}

static void test_standard_fluid_heats_as_known_when_the_time_step_is_large(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.04);
    const struct thermodynamics_summary half = simulate(&fluid.setup, 150, 300, NULL);
    assert_temperatures(&half, 1.0281, 1.0551);
    assert_close(half.potential_energy, 4.5758, energy_tolerance);
    assert_close(half.pressure, 23.649, pressure_tolerance);
    fluid.setup.integrator_parameters.lambda = 0.65;
    const struct thermodynamics_summary more = simulate(&fluid.setup, 150, 300, NULL);
    assert_temperatures(&more, 1.0023, 1.0338);
    assert_close(more.potential_energy, 4.5633, energy_tolerance);
    assert_close(more.pressure, 23.6475, pressure_tolerance);
    fluid_clear(&fluid);
}

/// Shorter than the test of the first variant above, with errors that are larger accordingly; with
/// another seed, so that it is more than the same run again.
static void test_standard_fluid_heats_as_known_when_the_variant_changes(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MOST];
    const int variant_count = variants_find(variants);
    for (int v = 1; v < variant_count; v++) {
        struct fluid fluid;
        fluid_groot_warren(&fluid, PARTICLES, 0.04);
        fluid.setup.precision = (int)variants[v].precision;
        fluid.setup.seed = 10 + (uint64_t)v;
        variants_select(&variants[v]);
        print_message("%s: ", variants[v].name);
        const struct thermodynamics_summary s = simulate(&fluid.setup, 150, 150, NULL);
        assert_temperatures(&s, 1.0281, 1.0551);
        assert_close(s.potential_energy, 4.5758, energy_tolerance);
        assert_close(s.pressure, 23.649, pressure_tolerance);
        fluid_clear(&fluid);
    }
    variants_select(&variants[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_standard_fluid_has_the_published_state_when_the_time_step_is_small),
        cmocka_unit_test(test_standard_fluid_heats_as_known_when_the_time_step_is_large),
        cmocka_unit_test(test_standard_fluid_heats_as_known_when_the_variant_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
