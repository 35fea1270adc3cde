// SPDX-License-Identifier: GPL-3.0-or-later
//
// The standard fluid of dissipative particle dynamics against published and independent values;
// tests/reference_data/README.md says where they come from.
#include "curves/formula.h"
#include "dynamics/dpd_verlet.h"
#include "io/data_table.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/watched.h"
#include "shared/testing.h"
#include "shared/variants.h"

enum { PARTICLES = 3000 };

/// Standard errors by which a measured mean may differ from a reference: one false alarm in 370
/// comparisons, and there are 6 of them with fixed seeds, and 2 for each other variant.
static const double deviations = 3;

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
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    const struct watched observables = {.rdf = rdf, .thermodynamics = &thermodynamics};
    assert_ok(watched_sample(&simulation, &plan, observables, NULL));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    print_message("%s, time step %g: kinetic %.4f(%.4f), configurational %.4f(%.4f), U/N "
                  "%.4f(%.4f), pressure %.4f(%.4f)\n",
                  setup->integrator->name, setup->time_step, s.temperature, s.temperature_error,
                  s.temperature_configurational, s.temperature_configurational_error,
                  s.potential_energy, s.potential_energy_error, s.pressure, s.pressure_error);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
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
    assert_ok(mf_data_table_read(&table, "tests/reference_data/groot_warren_rdf.txt", 2));
    const size_t each = table.rows / rdf->bins.count;
    assert_int_equal(table.rows % rdf->bins.count, 0);
    for (size_t k = 0; k < rdf->bins.count; k++) {
        double sum = 0, volume = 0;
        for (size_t row = each * k; row < each * (k + 1); row++) {
            const double r = table.values[row * table.columns];
            const double shell = mf_box_shell_volume(&rdf->box, r - 0.005, r + 0.005);
            sum += shell * table.values[row * table.columns + 1];
            volume += shell;
        }
        g[k] = sum / volume;
    }
    mf_data_table_clear(&table);
}

static void test_standard_fluid_has_the_published_state_when_the_time_step_is_small(void **state) {
    (void)state;
    enum { BINS = 40, SAMPLES = 300 };
    struct fluid fluid;
    struct rdf rdf;
    double g[BINS], error[BINS], reference[BINS], largest = 0, largest_error = 0;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    // Beyond the cutoff, so that the RDF makes its own list.
    assert_ok(mf_rdf_init(&rdf, &(struct rdf_bins){0, 0.05, BINS}, &fluid.setup.box, PARTICLES, 1,
                          SAMPLES));
    const struct thermodynamics_summary s = simulate(&fluid.setup, 500, SAMPLES, &rdf);
    assert_close(s.potential_energy, 4.545, energy_tolerance);
    assert_close(s.pressure, 23.65, pressure_tolerance);
    // Kinetic: LAMMPS at this time step. Configurational: a quarter of the excess at twice it.
    assert_temperatures(&s, 1.0039, 1.0036);
    read_reference(&rdf, reference);
    assert_ok(mf_rdf_result(&rdf, 1, g, error));
    for (int k = 0; k < BINS; k++) {
        assert_close(g[k], reference[k], rdf_tolerance);
        largest = fmax(largest, fabs(g[k] - reference[k]));
        largest_error = fmax(largest_error, error[k]);
    }
    print_message("g(r): largest difference %.4f, largest error %.4f\n", largest, largest_error);
    mf_rdf_clear(&rdf);
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
    fluid.setup.integrator_parameters = &(struct dpd_verlet_parameters){.lambda = 0.65};
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
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int v = 1; v < variant_count; v++) {
        struct fluid fluid;
        fluid_groot_warren(&fluid, PARTICLES, 0.04);
        fluid.setup.precision = (int)variants[v].precision;
        fluid.setup.seed = 10 + (uint64_t)v;
        variants_select(&variants[v]);
        print_message("%s: ", variants[v].name);
        const struct thermodynamics_summary s =
            simulate(&fluid.setup, 150, length_is_long() ? 150 : 50, NULL);
        assert_temperatures(&s, 1.0281, 1.0551);
        assert_close(s.potential_energy, 4.5758, energy_tolerance);
        assert_close(s.pressure, 23.649, pressure_tolerance);
        fluid_clear(&fluid);
    }
    variants_select(&variants[0]);
}

/// Published excess of the temperatures [%], to the digits given: kinetic at the end of the step.
struct heating {
    const struct integrator *integrator;
    double lambda, time_step;
    double kinetic, configurational;
    double kinetic_digit, configurational_digit; ///< half the last digit
};

static const struct heating heatings[] = {
    {&mf_dpd_verlet, 0.5, 0.02, 1.0, 1.4, 0.05, 0.05},
    {&mf_dpd_verlet, 0.65, 0.02, 0.2, 0.8, 0.05, 0.05},
    {&mf_shardlow, 0, 0.02, 0, 1.2, 0.05, 0.05},
    {&mf_aboba, 0, 0.02, 0.7, -0.05, 0.05, 0.005},
    {&mf_dpd_verlet, 0.5, 0.04, 2.8, 5.5, 0.05, 0.05},
    {&mf_dpd_verlet, 0.65, 0.04, 0.2, 3.4, 0.05, 0.05},
    {&mf_shardlow, 0, 0.04, 0.8, 4.9, 0.05, 0.05},
    {&mf_aboba, 0, 0.04, 2.4, -0.9, 0.05, 0.05},
    {&mf_dpd_verlet, 0.5, 0.06, 6.1, 14, 0.05, 0.5},
    {&mf_dpd_verlet, 0.65, 0.06, 0.9, 9.1, 0.05, 0.05},
    {&mf_shardlow, 0, 0.06, 2.3, 12, 0.05, 0.5},
    {&mf_aboba, 0, 0.06, 6.3, -1.5, 0.05, 0.05},
    {&mf_dpd_verlet, 0.5, 0.08, 13, 32, 0.5, 0.5},
    {&mf_dpd_verlet, 0.65, 0.08, 4.6, 22, 0.05, 0.5},
    {&mf_shardlow, 0, 0.08, 5.2, 25, 0.05, 0.5},
    {&mf_aboba, 0, 0.08, 13, -2.5, 0.5, 0.05},
};

/// Of the published excess: 0.1 %.
static const double heating_error = 0.001;

/// Mean kinetic temperature at the ends of steps, beside what is measured of them.
struct ends {
    double sum;
    size_t count;
};

static void add_end(void *context, const struct simulation *simulation, uint64_t done,
                    uint64_t total) {
    (void)done, (void)total;
    struct ends *ends = context;
    ends->sum += mf_particles_temperature(&simulation->particles);
    ends->count++;
}

/// The statistical error of the temperature at the end of a step is that in the middle.
static void check_heating(const struct heating *heating) {
    const struct measure_plan plan = {
        .equilibration = 500, .samples = length_is_long() ? 1000 : 150, .every = 10};
    struct fluid fluid;
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    struct ends ends = {0};
    double temperature;
    fluid_groot_warren(&fluid, PARTICLES, heating->time_step);
    fluid.setup.integrator = heating->integrator;
    const struct dpd_verlet_parameters prediction = {.lambda = heating->lambda};
    if (heating->integrator == &mf_dpd_verlet)
        fluid.setup.integrator_parameters = &prediction;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    const struct watched observables = {.thermodynamics = &thermodynamics};
    const struct measure_listener listener = {.report = add_end, .context = &ends};
    assert_ok(watched_sample(&simulation, &plan, observables, &listener));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    const double kinetic = ends.sum / (double)ends.count;
    print_message("%s, lambda %g, time step %g: kinetic %.4f(%.4f), configurational %.4f(%.4f)\n",
                  heating->integrator->name, heating->lambda, heating->time_step, kinetic,
                  s.temperature_error, s.temperature_configurational,
                  s.temperature_configurational_error);
    const double wide = heating->integrator == &mf_aboba && heating->time_step == 0.08 ? 3 : 2;
    assert_close(kinetic, 1 + heating->kinetic / 100,
                 heating->kinetic_digit / 100 + 2 * hypot(s.temperature_error, heating_error));
    assert_close(s.temperature_configurational, 1 + heating->configurational / 100,
                 heating->configurational_digit / 100 +
                     wide * hypot(s.temperature_configurational_error, heating_error));
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// 32 comparisons within two combined errors besides half the last published digit. About half of
/// the allowance is for the published numbers' own error, which is the same with any seed of ours.
/// One comparison is allowed three: in runs of 17,000 to 25,000 steps ABOBA had a configurational
/// temperature off by −0.64(6), −1.44(5) and −2.21(4) % at 0.04, 0.06 and 0.08, the last 2.2
/// combined errors beyond the digits of −2.5. Implicit friction, −2.16(8), and 100 particles,
/// −2.25(8), do not explain it; of 32 one or two stray beyond two by chance.
/// In short each integrator at 0.06 alone, with errors of 0.2 %, where it heats by 1 to 14 %.
static void test_standard_fluid_heats_as_published_when_the_integrator_changes(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof heatings / sizeof *heatings; k++)
        if (length_is_long() || heatings[k].time_step == 0.06)
            check_heating(&heatings[k]);
}

/// Published pressures at Δt = 0.02, some of them twice.
struct published_pressure {
    double density, a, temperature;
    double pressure[2], error; ///< 0: published once
};

/// Of 100 particles, with errors.
static const struct published_pressure pressures[] = {
    {3, 25, 1, {23.637, 23.635}, 0.002},
    {4, 18.75, 1, {32.622, 32.628}, 0.003},
    {2, 37.5, 1, {14.320}, 0.002},
    {5, 15, 1, {41.539}, 0.004},
};

/// Published without errors, and without the number of particles. With a in proportion to the
/// temperature, pressures are, too: by the first above these should be 11.8185, 35.4555 and 47.274.
/// They are lower by 2 to 4e-4 of themselves; so is 47.2501(34) of 64 particles than 47.2694(26) of
/// 100, and 47.2402(27) with dpd-verlet at twice the time step. Half of that stands for an error.
static const struct published_pressure hot_pressures[] = {
    {3, 12.5, 0.5, {11.814}, 2e-4 * 11.814},
    {3, 37.5, 1.5, {35.449}, 2e-4 * 35.449},
    {3, 50, 2, {47.257}, 2e-4 * 47.257},
};

static struct thermodynamics_summary measure_pressure(const struct published_pressure *published) {
    struct formula_soft_repulsion_parameters parameters = {published->a, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    struct table potential;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.02);
    assert_ok(mf_table_init_potential(&potential, &curve));
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = cbrt(100 / published->density);
    fluid.setup.potential = &potential;
    fluid.setup.temperature = published->temperature;
    fluid.setup.integrator = &mf_aboba;
    print_message("density %g, a %g, temperature %g: ", published->density, published->a,
                  published->temperature);
    const int64_t samples = length_is_long() ? 16000 : 3000;
    const struct thermodynamics_summary s = simulate(&fluid.setup, 500, samples, NULL);
    mf_table_clear(&potential);
    fluid_clear(&fluid);
    return s;
}

/// Within three combined errors: one false alarm in 60 sets of seeds, and these are fixed.
static void assert_published(const struct thermodynamics_summary *s,
                             const struct published_pressure *published) {
    for (int k = 0; k < 2; k++)
        if (published->pressure[k] > 0)
            assert_close(s->pressure, published->pressure[k],
                         3 * hypot(s->pressure_error, published->error));
}

static void test_pressure_is_the_published_one_when_the_density_changes(void **state) {
    (void)state;
    for (size_t k = 0; k < sizeof pressures / sizeof *pressures; k++) {
        const struct thermodynamics_summary s = measure_pressure(&pressures[k]);
        assert_published(&s, &pressures[k]);
    }
}

static void test_pressure_is_in_proportion_to_the_temperature_as_published(void **state) {
    (void)state;
    const struct published_pressure *one = &pressures[0];
    for (size_t k = 0; k < sizeof hot_pressures / sizeof *hot_pressures; k++) {
        const double temperature = hot_pressures[k].temperature;
        const struct thermodynamics_summary s = measure_pressure(&hot_pressures[k]);
        assert_published(&s, &hot_pressures[k]);
        assert_close(s.pressure / temperature, one->pressure[0],
                     3 * hypot(s.pressure_error / temperature, one->error));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_standard_fluid_has_the_published_state_when_the_time_step_is_small),
        cmocka_unit_test(test_standard_fluid_heats_as_known_when_the_time_step_is_large),
        cmocka_unit_test(test_standard_fluid_heats_as_known_when_the_variant_changes),
        cmocka_unit_test(test_standard_fluid_heats_as_published_when_the_integrator_changes),
        cmocka_unit_test(test_pressure_is_the_published_one_when_the_density_changes),
        cmocka_unit_test(test_pressure_is_in_proportion_to_the_temperature_as_published),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
