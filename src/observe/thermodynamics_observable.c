// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/statistics.h"
#include "forces/interaction.h"
#include "io/data_table.h"
#include "observe/equilibration.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/thermodynamics.h"

#include <math.h>
#include <string.h>

// Thermodynamics capacity -------------------------------------------------------------------------

enum { MIN_SAMPLES = 5, MAX_BLOCKS = 4096 };

/// The energy of sample k whose fluctuations tell [k_B T_0 a particle].
static double energy_of(const struct thermodynamics *t, const struct simulation_setup *setup,
                        size_t k) {
    const double total = mf_thermodynamics_series(t, THERMODYNAMICS_TOTAL_ENERGY)[k];
    const double potential = mf_thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY)[k];
    if (!simulation_has_velocities(setup))
        return potential;
    return simulation_holds_temperature(setup) ? total : total - potential;
}

/// Variance of that energy with its error: that of the mean of the squares.
static struct thermodynamics_capacity variance_of(const struct thermodynamics *t,
                                                  const struct simulation_setup *setup) {
    const size_t count = t->series.count, each = (count + MAX_BLOCKS - 1) / MAX_BLOCKS;
    struct running_mean mean = {0}, square = {0};
    double squares[MAX_BLOCKS] = {0};
    for (size_t k = 0; k < count; k++)
        mf_statistics_add(&mean, energy_of(t, setup, k));
    for (size_t k = 0; k < count; k++) {
        const double s = pow(energy_of(t, setup, k) - mean.mean, 2);
        mf_statistics_add(&square, s);
        squares[k / each] += s / (double)each;
    }
    return (struct thermodynamics_capacity){
        square.mean * (double)count / (double)(count - 1),
        mf_statistics_correlated_error(squares, count / each, 1)};
}

struct thermodynamics_capacity
mf_thermodynamics_heat_capacity(const struct thermodynamics *thermodynamics,
                                const struct simulation_setup *setup) {
    const double particles = (double)setup->placement.count, d = setup->box.dimensions;
    struct thermodynamics_capacity none = {NAN, NAN};
    if (thermodynamics->series.count < MIN_SAMPLES || !mf_simulation_is_thermal(setup) ||
        setup->integrator->events || setup->integrator->solvent_particles)
        return none;
    const struct thermodynamics_capacity variance = variance_of(thermodynamics, setup);
    if (simulation_holds_temperature(setup)) {
        const double factor = particles / pow(setup->temperature, 2);
        const double kinetic = simulation_has_velocities(setup) ? 0 : d / 2;
        return (struct thermodynamics_capacity){kinetic + factor * variance.value,
                                                factor * variance.error};
    }
    const struct thermodynamics_summary s = mf_thermodynamics_result(thermodynamics, 1);
    const double factor = 2 * particles / (d * pow(s.temperature, 2));
    const double left = 1 - factor * variance.value; // d/2 of the capacity
    return left > 0 ? (struct thermodynamics_capacity){d / 2 / left, d / 2 / (left * left) *
                                                                         factor * variance.error}
                    : none;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    (void)settings, (void)simulation, (void)plan;
    mf_thermodynamics_init(state);
    return STATUS_OK;
}

static void clear(void *state) {
    mf_thermodynamics_clear(state);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    return mf_thermodynamics_sample(state, simulation);
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_sample_series_spans(&((struct thermodynamics *)state)->series, spans);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct thermodynamics *)state)->series);
}

/// thermodynamics.tsv: a row for each sample.
static enum status write(const void *state, const struct observable_results *results) {
    const struct thermodynamics *t = state;
    OWNED double *step = NULL, *time = NULL, *configurational = NULL;
    const struct simulation_setup *setup = results->setup;
    const bool sweeps = setup->integrator->samples; // in the place of times
    const double time_step = sweeps ? 1 : setup->time_step;
    char path[OUTPUT_PATH_SIZE];
    TRY_ARRAY(step, t->series.count);
    TRY_ARRAY(time, t->series.count);
    TRY_ARRAY(configurational, t->series.count);
    for (size_t k = 0; k < t->series.count; k++) {
        step[k] = (double)(results->plan->equilibration + (int64_t)(k + 1) * results->plan->every);
        time[k] = step[k] * time_step;
        configurational[k] = mf_thermodynamics_series(t, THERMODYNAMICS_FORCE_SQUARES)[k] /
                             mf_thermodynamics_series(t, THERMODYNAMICS_LAPLACIAN)[k];
    }
    // bar is a force on an area.
    const bool in_space = setup->box.dimensions == 3;
    enum { STEP, TIME, TEMPERATURE, ENERGY, PRESSURE, CONFIGURATIONAL, TOTAL, COLUMNS };
    const struct data_column columns[COLUMNS] = {
        [STEP] = {"step", step, NULL},
        [TIME] = {sweeps ? "sweeps[1]" : "time[tau]", time, NULL},
        [TEMPERATURE] = {"temperature[T_0]",
                         mf_thermodynamics_series(t, THERMODYNAMICS_TEMPERATURE), "%.8g"},
        [ENERGY] = {"potential_energy[k_B.T_0]",
                    mf_thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY), "%.12g"},
        [PRESSURE] = {"pressure[k_B.T_0/lambda^d]",
                      mf_thermodynamics_series(t, THERMODYNAMICS_PRESSURE), "%.8g"},
        [CONFIGURATIONAL] = {"temperature_configurational[T_0]", configurational, "%.8g"},
        [TOTAL] = {"total_energy[k_B.T_0]",
                   mf_thermodynamics_series(t, THERMODYNAMICS_TOTAL_ENERGY), "%.12g"}};
    const size_t reduced = simulation_has_velocities(setup) ? COLUMNS : TOTAL;
    const char *const beside[COLUMNS] = {
        [TIME] = sweeps ? NULL : "%.10g", [ENERGY] = "%.8g", [PRESSURE] = in_space ? "%.8g" : NULL};
    mf_observable_file(results, "thermodynamics.tsv", path);
    return mf_data_table_write_beside(path, results->units, NULL, columns, beside, reduced,
                                      t->series.count);
}

/// Half as much again, or half of it, is not the temperature of the scene: nothing of the
/// simulation is right. What is nearer is a warning.
static bool is_another(const struct thermodynamics_summary *s,
                       const struct simulation_setup *setup) {
    static const double factor = 1.5;
    const double found =
        simulation_has_velocities(setup) ? s->temperature : s->temperature_configurational;
    return found > factor * setup->temperature || found < setup->temperature / factor;
}

/// A temperature that changes all along has an error that covers any other.
static enum status assess_change(const struct thermodynamics *t,
                                 const struct thermodynamics_summary *s,
                                 const struct simulation_setup *setup) {
    if (!simulation_has_velocities(setup) || !simulation_holds_temperature(setup) ||
        !mf_simulation_is_thermal(setup) || !is_another(s, setup) ||
        t->series.count < EQUILIBRATION_MIN_SAMPLES ||
        mf_equilibration_check("temperature", "T_0",
                               mf_thermodynamics_series(t, THERMODYNAMICS_TEMPERATURE),
                               t->series.count) == STATUS_OK)
        return STATUS_OK;
    return mf_status_fail(STATUS_UNSTABLE,
                          "the temperature is %.3g" STATUS_TEMPERATURE
                          ", not %.3g" STATUS_TEMPERATURE ", and still changes: equilibrate for "
                          "longer, or with more friction",
                          s->temperature, setup->temperature);
}

/// A uniform force lets the energy of all that it carries along fall for ever.
static bool energy_falls(const struct simulation_setup *setup) {
    bool falls = false;
    for (int k = 0; k < setup->interactions; k++)
        falls = falls || setup->interaction[k].kind == &mf_uniform_force;
    return falls;
}

/// Temperatures first: a step that is too long tells more than the drift that it makes.
static enum status assess(const void *state, const struct simulation_setup *setup) {
    const struct thermodynamics *t = state;
    const struct thermodynamics_summary s = mf_thermodynamics_result(t, 1);
    const enum status status = mf_thermodynamics_assess(&s, setup);
    if (status == STATUS_UNSTABLE && !is_another(&s, setup))
        return mf_status_fail(STATUS_UNCONVERGED, "%s", mf_status_marked());
    TRY(status);
    if (mf_thermodynamics_assess_unheld(&s, setup) != STATUS_OK)
        return mf_status_fail(STATUS_UNCONVERGED, "%s", mf_status_marked());
    TRY(assess_change(t, &s, setup));
    if (!energy_falls(setup))
        TRY(mf_equilibration_check("potential energy", "k_B T_0",
                                   mf_thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY),
                                   t->series.count));
    TRY(mf_equilibration_check("pressure", "k_B T_0/lambda^d",
                               mf_thermodynamics_series(t, THERMODYNAMICS_PRESSURE),
                               t->series.count));
    return mf_thermodynamics_assess_step(&s, setup) == STATUS_OK
               ? STATUS_OK
               : mf_status_fail(STATUS_UNCONVERGED, "%s", mf_status_marked());
}

/// Means with errors, and the object "physical" when the units are known.
static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct thermodynamics_summary s = mf_thermodynamics_result(state, 1);
    const double known = s.blocks > 1 ? 1 : NAN; // one sample tells no error
    if (mf_units_convert_message(results->units, assess(state, results->setup)) != STATUS_OK)
        mf_json_write_text(writer, "warning", mf_status_message());
    mf_json_put_measured(writer, "temperature", "T_0", s.temperature, known * s.temperature_error);
    if (isfinite(s.temperature_configurational))
        mf_json_put_measured(writer, "temperature_configurational", "T_0",
                             s.temperature_configurational,
                             known * s.temperature_configurational_error);
    mf_json_put_measured(writer, "potential_energy", "k_B T_0", s.potential_energy,
                         known * s.potential_energy_error);
    mf_json_put_measured(writer, "pressure", "k_B T_0/lambda^d", s.pressure,
                         known * s.pressure_error);
    const struct thermodynamics_capacity capacity =
        mf_thermodynamics_heat_capacity(state, results->setup);
    if (isfinite(capacity.value))
        mf_json_put_measured(writer, "heat_capacity", "1", capacity.value, known * capacity.error);
    if (!simulation_holds_temperature(results->setup) &&
        !results->setup->integrator->solvent_particles)
        mf_json_write_number(writer, "energy_drift", mf_thermodynamics_energy_drift(state));
    mf_units_write_results(results->units, writer, s.potential_energy, s.pressure);
}

/// What everybody looks at first: T, U and p of those that there are.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct thermodynamics_summary s = mf_thermodynamics_result(state, 1);
    const double known = s.blocks > 1 ? 1 : NAN;
    const struct {
        const char *name, *unit;
        double value, error;
    } numbers[] = {
        {"T = ", "T_0", s.temperature, s.temperature_error},
        {"T from forces = ", "T_0", s.temperature_configurational,
         s.temperature_configurational_error},
        {"U of a bead = ", "k_B T_0", s.potential_energy, s.potential_energy_error},
        {"pressure ", "k_B T_0/lambda^d", s.pressure, s.pressure_error},
    };
    line[0] = '\0';
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        char text[UNITS_MEASURED_SIZE];
        const size_t length = strlen(line);
        if (!isfinite(numbers[k].value))
            continue;
        mf_units_measured(results->units, numbers[k].unit, numbers[k].value,
                          known * numbers[k].error, text);
        snprintf(line + length, size - length, "%s%s%s", length > 0 ? ", " : "", numbers[k].name,
                 text);
    }
}

/// Nanoseconds of a pair and sample: of the sums, and of the configurational temperature.
static const double sum_cost = 0.2, curvature_cost = 8;

static const char sums_stage[] = "energy, virial, temperature";

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings;
    const double pairs = mf_stages_pairs_within(setup, mf_stages_cutoff(setup));
    mf_stages_add(stages, sums_stage, true, (sum_cost * pairs + 2) / every, "one step in %.0f",
                  every);
    mf_stages_add(stages, "configurational temperature", true, curvature_cost * pairs / every,
                  "one step in %.0f, in double precision", every);
}

static enum status result_of_all(const void *const *states, size_t count,
                                 const struct observable_values *values) {
    for (size_t k = 0; k < count; k++) {
        const struct thermodynamics_summary s = mf_thermodynamics_result(states[k], 1);
        mf_pooled_add(&values[0], &s.pressure, &s.pressure_error, count);
        mf_pooled_add(&values[1], &s.density, &s.density_error, count);
    }
    return STATUS_OK;
}

static const struct observable_target targets[] = {
    {.name = "pressure", .summary = "P", .form = OBSERVABLE_NUMBER, .unit = "k_B T_0/lambda^d"},
    {.name = "density",
     .summary = "beads by volume, of another engine",
     .form = OBSERVABLE_NUMBER,
     .unit = "1/lambda^d"},
    {.name = NULL}};

static const char *const files[] = {"thermodynamics.tsv", NULL};

const struct observable mf_thermodynamics_observable = {
    .name = "thermodynamics",
    .summary = "temperatures, energy, pressure",
    .always = true,
    .state_size = sizeof(struct thermodynamics),
    .begin = begin,
    .clear = clear,
    .sums = true,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = sums_stage,
    .files = files,
    .figure = "simulation",
    .targets = targets,
    .result_of_all = result_of_all,
};
