// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/shear_viscosity.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "dynamics/respa.h"
#include "forces/many_body.h"
#include "forces/shear_wave.h"
#include "forces/transfer.h"
#include "io/data_table.h"
#include "observe/finite_size.h"
#include "observe/green_kubo.h"
#include "observe/measure.h"
#include "observe/pooled.h"

#include <math.h>

enum { MAX_BLOCKS = 4096, SYMMETRIC = 5, UNSYMMETRIC = 6 };

static const char unit[] = "k_B T_0 tau/lambda^3";

struct settings {
    int64_t every, lags;
};

struct viscosity {
    struct settings settings;
    struct simulation_setup setup;
    int64_t begin;  ///< step after which the first interval begins
    size_t planned; ///< samples
    double density; ///< of mass [μ/λ³]
    double count;   ///< of particles
    bool driven;
    double acceleration, wave_number;
    size_t samples;
    double heat; ///< Σ of the kinetic temperature [k_B T_0]
    struct transfer transfer;
    struct green_kubo green_kubo;
    size_t each;                 ///< samples in a block of what follows
    double velocity[MAX_BLOCKS]; ///< Σ over its samples of V
};

static const struct field fields[] = {
    {"every", FIELD_INTEGER, offsetof(struct settings, every), .initial = 5, .minimum = 1,
     .maximum = 1e9, .unit = "steps", .help = "averaging interval of the momentum transfer"},
    {"lags", FIELD_INTEGER, offsetof(struct settings, lags), .initial = 200, .minimum = 8,
     .maximum = 1e5, .unit = "samples", .help = "longest window of the Green-Kubo integral"},
    FIELD_END,
};

// Sampling ----------------------------------------------------------------------------------------

static bool conserves_momentum(const struct interaction *kind) {
    return kind == &mf_shear_wave || kind == &mf_molecules || kind == &mf_many_body;
}

static enum status check(const struct simulation *simulation, bool driven) {
    const struct simulation_setup *setup = &simulation->setup;
    const char *name = setup->integrator->name;
    if (setup->box.dimensions != 3)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "shear_viscosity: in two dimensions it grows with the box, and has no "
            "value");
    for (int k = 0; k < setup->interactions; k++)
        if (!conserves_momentum(setup->interaction[k].kind))
            return mf_status_fail(STATUS_BAD_INPUT, "shear_viscosity: \"interactions\" other than "
                                                    "\"shear-wave\" do not conserve momentum");
    if (driven && (setup->integrator->solvent_particles || !simulation_has_velocities(setup) ||
                   !simulation_holds_temperature(setup)))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "shear_viscosity: a wave heats the fluid, and \"%s\" has no friction "
                              "between pairs here that would cool it",
                              name);
    if (!driven && (!setup->integrator->records_momentum_transfer || mf_respa_acts(setup)))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "shear_viscosity: \"%s\"%s does not give the momentum that pairs "
                              "exchange; \"aboba\" and \"velocity-verlet\" do without "
                              "\"inner_steps\", and \"shear-wave\" needs no stress",
                              name, mf_respa_acts(setup) ? " with \"inner_steps\"" : "");
    return STATUS_OK;
}

static double mass_of(const struct particles *particles) {
    const double *mass = particles_masses(particles);
    double sum = 0;
    for (size_t k = 0; k < particles->count; k++)
        sum += mass ? mass[k] : 1;
    return sum;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct viscosity *v = state;
    const struct simulation_setup *setup = &simulation->setup;
    const struct shear_wave_parameters *wave =
        mf_shear_wave_find(setup->interaction, setup->interactions);
    TRY(check(simulation, wave != NULL));
    *v = (struct viscosity){.settings = *(const struct settings *)settings,
                            .setup = *setup,
                            .begin = plan->equilibration,
                            .density = mass_of(&simulation->particles) / mf_box_volume(&setup->box),
                            .count = (double)simulation->particles.count,
                            .driven = wave != NULL,
                            .acceleration = wave ? wave->acceleration : 0,
                            .wave_number = shear_wave_number(&setup->box)};
    v->planned = (size_t)(plan->samples * plan->every / v->settings.every);
    v->each = (v->planned + MAX_BLOCKS - 1) / MAX_BLOCKS;
    if (v->planned < 2)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "shear_viscosity.every: the measurement has no two intervals of %lld "
                              "steps",
                              (long long)v->settings.every);
    if (v->driven)
        return STATUS_OK;
    const enum status status =
        mf_green_kubo_init(&v->green_kubo, (size_t)v->settings.lags,
                           setup->memory.transverse ? UNSYMMETRIC : SYMMETRIC, v->planned);
    return status == STATUS_OK ? status : mf_status_prefix(status, "shear_viscosity");
}

static void clear(void *state) {
    struct viscosity *v = state;
    mf_green_kubo_clear(&v->green_kubo);
}

static struct transfer *transfer(void *state) {
    struct viscosity *v = state;
    return v->driven ? NULL : &v->transfer;
}

static int64_t due(const void *state) {
    const struct viscosity *v = state;
    return v->samples < v->planned ? v->begin + (int64_t)(v->samples + 1) * v->settings.every
                                   : INT64_MAX;
}

/// Hand over what has been exchanged since the last sample.
static void sample_transfer(struct viscosity *v) {
    const double(*g)[3] = (const double(*)[3])v->transfer.sum;
    const double symmetric[SYMMETRIC] = {0.5 * (g[0][1] + g[1][0]), 0.5 * (g[0][2] + g[2][0]),
                                         0.5 * (g[1][2] + g[2][1]), 0.5 * (g[0][0] - g[1][1]),
                                         (2 * g[2][2] - g[0][0] - g[1][1]) / sqrt(12)};
    const double all[UNSYMMETRIC] = {g[0][1], g[1][0], g[0][2], g[2][0], g[1][2], g[2][1]};
    mf_green_kubo_add(&v->green_kubo, v->setup.memory.transverse ? all : symmetric);
    memset(v->transfer.sum, 0, sizeof v->transfer.sum);
}

static void sample_wave(struct viscosity *v, const struct particles *particles) {
    double sum = 0;
    for (size_t k = 0; k < particles->count; k++)
        sum += particles->velocity[0][k] * cos(v->wave_number * particles->position[2][k]);
    v->velocity[v->samples / v->each] += 2 * sum / v->count;
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct viscosity *v = state;
    v->heat += mf_particles_temperature(&simulation->particles);
    if (v->driven)
        sample_wave(v, &simulation->particles);
    else
        sample_transfer(v);
    v->samples++;
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct viscosity *v = state;
    spans[0] = (struct memory_span){&v->samples, sizeof v->samples};
    spans[1] = (struct memory_span){&v->heat, sizeof v->heat};
    spans[2] = (struct memory_span){v->velocity, sizeof v->velocity};
    spans[3] = (struct memory_span){v->transfer.sum, sizeof v->transfer.sum};
    return 4 + (v->driven ? 0 : mf_green_kubo_spans(&v->green_kubo, spans + 4));
}

// Results -----------------------------------------------------------------------------------------

/// 1/(V k_B T Δ). T is the one that is held, or the mean kinetic one.
static double scale_of(const struct viscosity *v) {
    const double temperature = simulation_holds_temperature(&v->setup)
                                   ? v->setup.temperature
                                   : v->heat / (double)v->samples;
    return 1 / (mf_box_volume(&v->setup.box) * temperature * (double)v->settings.every *
                v->setup.time_step);
}

static struct shear_viscosity_summary result_at_rest(const struct viscosity *v) {
    const struct green_kubo_summary found = mf_green_kubo_result(&v->green_kubo, NULL);
    const double scale = scale_of(v);
    return (struct shear_viscosity_summary){
        .value = scale * found.value,
        .error = scale * found.error,
        .blocks = found.blocks,
        .density = v->density,
        .window = (double)found.window * (double)v->settings.every * v->setup.time_step,
        .reached = found.reached};
}

static struct shear_viscosity_summary result_of_wave(const struct viscosity *v) {
    double values[MAX_BLOCKS];
    struct running_mean mean = {0};
    const size_t blocks = v->samples / v->each;
    for (size_t b = 0; b < blocks; b++) {
        values[b] = v->velocity[b] / (double)v->each;
        mf_statistics_add(&mean, values[b]);
    }
    const double k = v->wave_number, error = mf_statistics_correlated_error(values, blocks, 1);
    const double value = v->density * v->acceleration / (k * k * mean.mean);
    const double mass = v->density * mf_box_volume(&v->setup.box) / v->count;
    // Of m v²/2 the flow has m V²/4, as much as 3/2 k_B T of T = m V²/6.
    return (struct shear_viscosity_summary){.value = value,
                                            .error = fabs(value * error / mean.mean),
                                            .driven = true,
                                            .blocks = (double)blocks,
                                            .density = v->density,
                                            .wave_number = k,
                                            .velocity = mean.mean,
                                            .velocity_error = error,
                                            .temperature = v->heat / (double)v->samples -
                                                           mass * mean.mean * mean.mean / 6,
                                            .settling = v->density / (fabs(value) * k * k)};
}

struct shear_viscosity_summary mf_shear_viscosity_result(const void *state) {
    const struct viscosity *v = state;
    return v->driven ? result_of_wave(v) : result_at_rest(v);
}

bool mf_shear_viscosity_correct(const struct observable_results *results, double *diffusion,
                                double *error) {
    const struct observable_use *use = results->use;
    const struct box *box = &results->setup->box;
    while (use && use->observable && use->observable != &mf_shear_viscosity)
        use++;
    if (use == NULL || use->observable == NULL || mf_box_shortest(box) < mf_box_longest(box))
        return false;
    const struct shear_viscosity_summary s = mf_shear_viscosity_result(use->state);
    if (s.driven) // the flow carries particles along
        return false;
    const double lacking = mf_finite_size_diffusion(results->setup->temperature, s.value, s.density,
                                                    *diffusion, mf_box_longest(box));
    *error = hypot(*error, lacking * s.error / (s.value + s.density * *diffusion));
    *diffusion += lacking;
    return true;
}

static enum status assess_wave(const struct viscosity *v, const struct shear_viscosity_summary *s) {
    static const double hot = 0.02, fast = 0.5, settled = 3;
    const double wanted = v->setup.temperature;
    const double rest = (double)v->begin * v->setup.time_step;
    if (!(s->error < 0.2 * fabs(s->value)))
        return mf_status_fail(STATUS_UNCONVERGED,
                              "the viscosity is %.2g" STATUS_VISCOSITY
                              " with an error of %.2g" STATUS_VISCOSITY ": the wave is lost in its "
                              "noise; raise \"shear-wave.acceleration\" or \"samples\"",
                              s->value, s->error);
    if (s->temperature > (1 + hot) * wanted || fabs(s->velocity) > fast * sqrt(wanted))
        return mf_status_fail(
            STATUS_UNCONVERGED,
            "the wave is too strong, with a temperature of %.3g" STATUS_TEMPERATURE
            ", not %.3g" STATUS_TEMPERATURE ", and a "
            "flow of %.2g" STATUS_SPEED "; lower \"shear-wave.acceleration\"",
            s->temperature, wanted, fabs(s->velocity));
    return rest >= settled * s->settling
               ? STATUS_OK
               : mf_status_fail(STATUS_UNCONVERGED,
                                "the flow relaxes within %.3g" STATUS_TIME
                                ", and the measurement began after "
                                "%.3g" STATUS_TIME "; make \"equilibration\" three times as long",
                                s->settling, rest);
}

/// Whether the integral has come to rest, or the flow is a weak one that has settled.
static enum status assess(const void *state, const struct simulation_setup *setup) {
    const struct viscosity *v = state;
    const struct shear_viscosity_summary s = mf_shear_viscosity_result(v);
    (void)setup;
    if (v->driven)
        return assess_wave(v, &s);
    if (s.reached)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_UNCONVERGED,
        "the Green-Kubo integral of the viscosity has not converged within %.3g" STATUS_TIME "; "
        "raise \"shear_viscosity.lags\"",
        s.window);
}

// Output ------------------------------------------------------------------------------------------

/// shear_viscosity.tsv: the integral by the length of its window, and the autocorrelation of the
/// stress over intervals times V/(k_B T), whose integral it is.
static enum status write(const void *state, const struct observable_results *results) {
    const struct viscosity *v = state;
    const size_t rows = (size_t)v->settings.lags + 1;
    const double interval = (double)v->settings.every * v->setup.time_step;
    OWNED double *values = NULL;
    if (v->driven)
        return STATUS_OK;
    TRY_ARRAY(values, 6 * rows);
    double *time = values, *integral = time + rows, *error = integral + rows, *lag = error + rows,
           *correlation = lag + rows, *correlation_error = correlation + rows;
    mf_green_kubo_result(&v->green_kubo, &(struct green_kubo_curves){integral, error, correlation,
                                                                     correlation_error});
    for (size_t k = 0; k < rows; k++) {
        time[k] = ((double)k + 0.5) * interval;
        lag[k] = (double)k * interval;
        integral[k] *= scale_of(v);
        error[k] *= scale_of(v);
        correlation[k] *= scale_of(v) / interval;
        correlation_error[k] *= scale_of(v) / interval;
    }
    mf_statistics_mark_unknown_errors(error, rows);
    mf_statistics_mark_unknown_errors(correlation_error, rows);
    const struct data_column columns[] = {
        {"time[tau]", time, NULL},
        {"shear_viscosity[k_B.T_0.tau/lambda^3]", integral, "%.8g"},
        {"shear_viscosity_error[k_B.T_0.tau/lambda^3]", error, "%.3g"},
        {"lag[tau]", lag, NULL},
        {"stress_correlation[k_B.T_0/lambda^3]", correlation, "%.8g"},
        {"stress_correlation_error[k_B.T_0/lambda^3]", correlation_error, "%.3g"}};
    return mf_observable_table(results, "shear_viscosity.tsv", columns, 6, rows);
}

/// mPa s of one k_B T_0 τ/λ³.
static double millipascal_seconds(const struct units *units) {
    static const double of_bar_ps = 1e-4;
    return mf_units_pressure_bar(units) * mf_units_time_ps(units) * of_bar_ps;
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct viscosity *v = state;
    struct shear_viscosity_summary s = mf_shear_viscosity_result(v);
    mf_json_begin(writer, "shear_viscosity");
    if (mf_units_convert_message(results->units, assess(v, results->setup)) != STATUS_OK)
        mf_json_write_text(writer, "warning", mf_status_message());
    mf_statistics_mark_unknown_errors(&s.error, 1);
    mf_json_write_text(writer, "by", s.driven ? "shear-wave" : "green-kubo");
    mf_json_write_quantity(writer, "value", unit, s.value);
    mf_json_write_quantity(writer, "error", unit, s.error);
    if (mf_units_known(results->units)) {
        mf_json_write_number(writer, "value_mPa_s", s.value * millipascal_seconds(results->units));
        mf_json_write_number(writer, "error_mPa_s", s.error * millipascal_seconds(results->units));
    }
    if (s.driven) {
        mf_json_write_quantity(writer, "wave_number", "1/lambda", s.wave_number);
        mf_json_put_measured(writer, "velocity", "lambda/tau", s.velocity, s.velocity_error);
        mf_json_write_quantity(writer, "temperature", "T_0", s.temperature);
        mf_json_write_quantity(writer, "settling_time", "tau", s.settling);
    } else {
        mf_json_write_quantity(writer, "window", "tau", s.window);
    }
    mf_json_end(writer);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct shear_viscosity_summary s = mf_shear_viscosity_result(state);
    const struct units *units = results->units;
    const bool known = mf_units_known(units);
    const double factor = known ? millipascal_seconds(units) : 1;
    const double time = mf_units_factor(units, "tau");
    char text[NUMBER_TEXT_SIZE], name[UNITS_NAME_SIZE];
    mf_number_text(factor * s.value, factor * s.error, text);
    if (s.driven)
        snprintf(line, size, "shear viscosity %s%s by a flow of %.3g%s", text,
                 known ? " mPa s" : "", mf_units_factor(units, "lambda/tau") * s.velocity,
                 mf_units_suffix(units, "lambda/tau", name));
    else
        snprintf(line, size, "shear viscosity %s%s by Green and Kubo, window %.3g%s", text,
                 known ? " mPa s" : "", time * s.window, mf_units_suffix(units, "tau", name));
}

/// Nanoseconds of a particle and step: of what particles carry; of a pair, of its force and of its
/// friction; of a sample of a wave.
static const double carry_cost = 3, force_cost = 0.5, friction_cost = 9, wave_cost = 12;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const struct settings *own = settings;
    const bool has_friction = setup->omega || pair_memory_acts(&setup->memory);
    const double pairs = mf_stages_pairs_within(setup, mf_simulation_range(setup));
    (void)every;
    if (mf_shear_wave_find(setup->interaction, setup->interactions))
        mf_stages_add(stages, "viscosity", true, wave_cost / (double)own->every,
                      "the flow of the wave, one step in %lld", (long long)own->every);
    else
        mf_stages_add(stages, "viscosity", true,
                      carry_cost + (has_friction ? friction_cost : force_cost) * pairs,
                      "the momentum that pairs exchange, every step");
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct shear_viscosity_summary found = mf_shear_viscosity_result(state);
    mf_pooled_set(values, &found.value, &found.error);
    *blocks = found.blocks;
    return STATUS_OK;
}

static const struct observable_target targets[] = {{.name = "shear_viscosity",
                                                    .summary = "shear viscosity of the fluid",
                                                    .form = OBSERVABLE_NUMBER,
                                                    .unit = unit,
                                                    .has_settings = true},
                                                   {.name = NULL}};
static const char *const files[] = {"shear_viscosity.tsv", NULL};

const struct observable mf_shear_viscosity = {
    .name = "shear_viscosity",
    .summary = "shear viscosity by Green and Kubo, or from the flow that \"shear-wave\" drives",
    .of_time = true,
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct viscosity),
    .begin = begin,
    .clear = clear,
    .transfer = transfer,
    .due = due,
    .sample = sample,
    .spans = spans,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = "viscosity",
    .files = files,
    .figure = OBSERVABLE_FIGURE_OF_CURVE,
    .targets = targets,
    .result = result,
};
