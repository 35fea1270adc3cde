// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pressure along each axis and across, in time:
///
///   P_ab = ρ k_B T δ_ab + (1/V) Σ_pairs r_a F_b,
///
/// the stress with the other sign, of all potentials (M. P. Allen and D. J. Tildesley, Computer
/// Simulation of Liquids, 2nd ed. (2017), eq. 2.61 to 2.64). What velocities carry is that of the
/// temperature, as in the pressure of thermodynamics, which is the mean of the diagonal; what
/// friction, noise and propulsion add is not in it. Tested: cli/test_pressure_tensor.
#include "base/memory.h"
#include "dynamics/simulation_look.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_series.h"

#include <stdio.h>

/// Of space first xx, yy, zz, xy, xz, yz; of the plane those that it has.
enum { COMPONENTS = 6, TIME = COMPONENTS, COLUMNS };

static const struct component {
    const char *name;
    int a, b;
} components[COMPONENTS] = {{"xx", 0, 0}, {"yy", 1, 1}, {"zz", 2, 2},
                            {"xy", 0, 1}, {"xz", 0, 2}, {"yz", 1, 2}};

struct state {
    int dimensions;
    double clock;                ///< a step, or a sweep [τ or 1]
    struct sample_series series; ///< of COLUMNS
};

static bool has(const struct state *s, int component) {
    return components[component].b < s->dimensions;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    const struct integrator *integrator = simulation->setup.integrator;
    double virial[3][3];
    (void)settings, (void)plan;
    if (integrator->events || integrator->solvent_particles)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "pressure_tensor: %s of \"%s\" is not that of potentials; leave it out",
            integrator->events ? "the pressure" : "the stress of the solvent", integrator->name);
    *(struct state *)state =
        (struct state){.dimensions = simulation->setup.box.dimensions,
                       .clock = configuration->sweeps ? 1 : configuration->time_step,
                       .series.columns = COLUMNS};
    const enum status status = mf_simulation_look_virial(simulation, virial);
    return status == STATUS_OK ? status : mf_status_prefix(status, "pressure_tensor");
}

static void clear(void *state) {
    mf_sample_series_clear(&((struct state *)state)->series);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const double volume = mf_box_volume(&simulation->particles.box);
    double virial[3][3], trace = 0, here[COLUMNS] = {0};
    TRY(mf_simulation_look_virial(simulation, virial));
    for (int d = 0; d < s->dimensions; d++)
        trace += virial[d][d];
    const double mean = mf_simulation_pressure(simulation) - trace / s->dimensions / volume;
    for (int k = 0; k < COMPONENTS; k++) {
        const int a = components[k].a, b = components[k].b;
        here[k] = (a == b ? mean : 0) + 0.5 * (virial[a][b] + virial[b][a]) / volume;
    }
    here[TIME] = (double)simulation->step * s->clock;
    return mf_sample_series_add(&s->series, here);
}

static size_t spans(void *state, struct memory_span *spans) {
    return mf_sample_series_spans(&((struct state *)state)->series, spans);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->series);
}

// Results -----------------------------------------------------------------------------------------

enum { HEAD_SIZE = 32 };

/// pressure_tensor.tsv: a row for each sample.
static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    char head[COMPONENTS][HEAD_SIZE];
    struct data_column columns[COLUMNS];
    size_t n = 0;
    const bool sweeps = results->setup->integrator->samples;
    columns[n++] = (struct data_column){sweeps ? "sweeps[1]" : "time[tau]",
                                        sample_series_column(&s->series, TIME), NULL};
    for (int k = 0; k < COMPONENTS; k++) {
        if (!has(s, k))
            continue;
        snprintf(head[k], HEAD_SIZE, "%s[k_B.T_0/lambda^d]", components[k].name);
        columns[n++] =
            (struct data_column){head[k], sample_series_column(&s->series, (size_t)k), "%.8g"};
    }
    return mf_observable_table(results, "pressure_tensor.tsv", columns, n, s->series.count);
}

static double mean_of(const struct state *s, int component, double *error) {
    const double mean = mf_sample_series_mean(&s->series, (size_t)component, error);
    if (s->series.count < 2)
        *error = NAN;
    return mean;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    (void)results;
    mf_json_begin(writer, "pressure_tensor");
    for (int k = 0; k < COMPONENTS; k++) {
        double error;
        if (!has(s, k))
            continue;
        const double mean = mean_of(s, k, &error);
        mf_json_put_measured(writer, components[k].name, "k_B T_0/lambda^d", mean, error);
    }
    mf_json_end(writer);
}

/// The diagonal.
static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    size_t length = (size_t)snprintf(line, size, "pressure along");
    for (int d = 0; d < s->dimensions && length < size; d++) {
        char text[UNITS_MEASURED_SIZE];
        double error;
        const double mean = mean_of(s, d, &error);
        mf_units_measured(results->units, "k_B T_0/lambda^d", mean, error, text);
        length += (size_t)snprintf(line + length, size - length, "%s %c %s", d > 0 ? "," : "",
                                   "xyz"[d], text);
    }
}

/// Nanoseconds of a particle: a list is built, and forces are found, of the potentials alone.
static const double look_cost = 200;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const double pairs = mf_stages_pairs_within(setup, mf_stages_cutoff(setup));
    (void)settings;
    mf_stages_add(stages, "pressure along each axis", true,
                  (look_cost + mf_stages_cost.build * pairs) / every, "one step in %.0f", every);
}

static const struct field fields[] = {FIELD_END};
static const char *const files[] = {"pressure_tensor.tsv", NULL};

const struct observable mf_pressure_tensor = {
    .name = "pressure_tensor",
    .summary = "pressure along each axis and across, in time",
    .fields = fields,
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sums = true,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "pressure along each axis",
    .files = files,
    .figure = "pressure_tensor",
};
