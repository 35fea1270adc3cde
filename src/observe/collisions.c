// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the collisions of hard discs and spheres tell: pressure, rates, free path, speeds.
///
/// Between two samples t apart, of N particles with f degrees of freedom (d N, less one for each
/// axis whose momentum is kept) and k_B T = Σ m v²/f,
///   Z = p V/(N k_B T) = f/(d N) + Σ r·Δp/(d N k_B T t),
/// summed over all collisions (D. C. Rapaport, The Art of Molecular Dynamics Simulation, 2nd ed.,
/// Cambridge 2004, chapter 14), and by the walls Σ 2 m |v| V/(A t N k_B T) with the whole area A of
/// all of them. Errors are those of the means of the samples, by mf_statistics_correlated_error.
///
/// Speeds in units of sqrt(k_B T/m) are held against Maxwell's distribution. Energy and, without
/// walls, momentum never change, which would make them agree too well: both are replaced by
/// numbers that are drawn from their canonical distributions, as in observe/maxwell.h.
/// Tested: test_kinetic_gas (physics, cli).
#include "base/memory.h"
#include "base/number_text.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "dynamics/event_driven.h"
#include "io/data_table.h"
#include "observe/hard_theory.h"
#include "observe/maxwell.h"
#include "observe/measure.h"
#include "observe/sample_series.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/// Largest speed of the distribution [sqrt(k_B T/m)].
static const double speed_maximum = 5;

struct settings {
    int64_t bins;
};

#define MEMBER(name) .offset = offsetof(struct settings, name)
static const struct field fields[] = {
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 50, .minimum = 1, .maximum = 10000, .unit = "",
     .help = "bins of the speed distribution, up to five thermal speeds"},
    FIELD_END,
};

/// Numbers of a sample: sums and rates since the last.
enum quantity { FACTOR, WALL_FACTOR, RATE, SPEED, QUANTITIES };

struct collisions {
    struct settings settings;
    int64_t first, every; ///< steps
    size_t planned;       ///< samples
    bool begun;           ///< what was before the first step of sampling is known
    struct hard_gas_tally last;
    struct sample_series series; ///< of QUANTITIES
    uint64_t *speeds;
    struct maxwell maxwell;
    struct hard_theory theory;
    bool walls;
    size_t particles;
    double seconds;    ///< on events, by this process
    double collisions; ///< in them
};

/// Degrees of freedom: momentum is kept along axes without walls.
static double degrees_of_freedom(const struct hard_gas *gas) {
    double degrees = (double)gas->dimensions * gas->count;
    for (int d = 0; d < gas->dimensions; d++)
        degrees -= gas->walls >> d & 1 ? 0 : 1;
    return degrees;
}

/// Σ m v² relative to the drift, the mean velocity along axes without walls, which stays.
static double kinetic(const struct hard_gas *gas, double drift[3]) {
    double sum = 0, mass = 0, momentum[3] = {0};
    for (int k = 0; k < gas->count; k++) {
        const double m = gas->label[k].mass;
        mass += m;
        for (int d = 0; d < gas->dimensions; d++)
            momentum[d] += m * gas->body[k].velocity[d];
    }
    for (int d = 0; d < gas->dimensions; d++)
        drift[d] = gas->walls >> d & 1 ? 0 : momentum[d] / mass;
    for (int k = 0; k < gas->count; k++)
        for (int d = 0; d < gas->dimensions; d++)
            sum += gas->label[k].mass * pow(gas->body[k].velocity[d] - drift[d], 2);
    return sum;
}

/// Of the gas as it is, which is that of the scene unless a file gives the velocities.
static double temperature_of(const struct hard_gas *gas) {
    double drift[3];
    return kinetic(gas, drift) / degrees_of_freedom(gas);
}

static double mean_speed(const struct hard_gas *gas, const double drift[3]) {
    double sum = 0;
    for (int k = 0; k < gas->count; k++) {
        double square = 0;
        for (int d = 0; d < gas->dimensions; d++)
            square += pow(gas->body[k].velocity[d] - drift[d], 2);
        sum += sqrt(square);
    }
    return sum / gas->count;
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct collisions *c = state;
    const struct event_driven *engine = mf_event_driven_state(simulation);
    OWNED double *radius = NULL, *mass = NULL;
    if (engine == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "collisions: only the integrator \"event-driven\" has any");
    const struct hard_gas *gas = &engine->gas;
    c->settings = *(const struct settings *)settings;
    c->first = plan->equilibration;
    c->every = plan->every;
    c->planned = (size_t)plan->samples;
    c->series.columns = QUANTITIES;
    c->walls = gas->walls != 0;
    c->particles = (size_t)gas->count;
    TRY_ARRAY(c->speeds, (size_t)c->settings.bins + 1);
    TRY(mf_maxwell_init(&c->maxwell, c->planned));
    TRY_ARRAY(radius, c->particles);
    TRY_ARRAY(mass, c->particles);
    for (size_t k = 0; k < c->particles; k++) {
        radius[k] = gas->body[k].radius;
        mass[k] = gas->label[k].mass;
    }
    c->theory = mf_hard_theory(gas->dimensions, mf_box_volume(&simulation->setup.box),
                               temperature_of(gas), radius, mass, c->particles);
    return STATUS_OK;
}

static void clear(void *state) {
    struct collisions *c = state;
    mf_sample_series_clear(&c->series);
    mf_memory_free(c->speeds);
    mf_maxwell_clear(&c->maxwell);
    *c = (struct collisions){0};
}

static int64_t due(const void *state) {
    const struct collisions *c = state;
    if (!c->begun)
        return c->first;
    return c->series.count < c->planned ? c->first + (int64_t)(c->series.count + 1) * c->every
                                        : INT64_MAX;
}

// Sampling ----------------------------------------------------------------------------------------

/// Maxwell's distribution function of a speed in units of sqrt(k_B T/m).
static double maxwell_share(int dimensions, double u) {
    if (dimensions == 2)
        return -expm1(-0.5 * u * u);
    return erf(u * sqrt(0.5)) - sqrt(2 / pi) * u * exp(-0.5 * u * u);
}

/// A number of the chi-squared distribution from a normal one: E. B. Wilson and M. M. Hilferty,
/// Proc. Natl. Acad. Sci. 17, 684 (1931); off by less than 1e-3 of its width from 30 degrees on.
static double chi_squared(double degrees, double normal) {
    const double ninth = 2 / (9 * degrees);
    return degrees * pow(1 - ninth + normal * sqrt(ninth), 3);
}

/// Add all speeds, with energy and drift as in a canonical ensemble at the same temperature.
static void add_speeds(struct collisions *c, const struct hard_gas *gas, uint64_t seed,
                       uint64_t step) {
    double drift[3], normal[4], shift[3] = {0}, mass = 0;
    const double square = kinetic(gas, drift), degrees = degrees_of_freedom(gas);
    const double temperature = square / degrees;
    mf_rng_normal4(
        mf_rng_philox(seed, RNG_MEAN_VELOCITY, (uint32_t)step, (uint32_t)(step >> 32), 1), normal);
    const double scale = sqrt(chi_squared(degrees, normal[3]) * temperature / square);
    mf_maxwell_begin(&c->maxwell);
    for (int k = 0; k < gas->count; k++)
        mass += gas->label[k].mass;
    for (int d = 0; d < gas->dimensions; d++)
        if (!(gas->walls >> d & 1))
            shift[d] = normal[d] * sqrt(temperature / mass);
    for (int k = 0; k < gas->count; k++) {
        double own = 0;
        for (int d = 0; d < gas->dimensions; d++)
            own += pow(scale * (gas->body[k].velocity[d] - drift[d]) + shift[d], 2);
        const double u = sqrt(own * gas->label[k].mass / temperature);
        const double place = u / speed_maximum * (double)c->settings.bins;
        mf_maxwell_add(&c->maxwell, maxwell_share(gas->dimensions, u));
        c->speeds[(size_t)fmin(place, (double)c->settings.bins)]++;
    }
}

/// Momentum that walls got, over their area and the volume: p V if divided by a time.
static double wall_sum(const struct hard_gas *gas, const struct hard_gas_tally *last) {
    double momentum = 0, inverse_length = 0;
    for (int d = 0; d < gas->dimensions; d++) {
        if (!(gas->walls >> d & 1))
            continue;
        momentum += gas->now.tally.impulse[d] - last->impulse[d];
        inverse_length += 2 / gas->length[d]; // area over volume
    }
    return momentum / inverse_length; // NaN without walls
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct collisions *c = state;
    const struct event_driven *engine = mf_event_driven_state(simulation);
    const struct hard_gas *gas = &engine->gas;
    const struct hard_gas_tally *now = &gas->now.tally;
    if (c->begun) {
        double drift[3];
        const double time = (double)c->every * simulation->setup.time_step, n = gas->count;
        const double square = kinetic(gas, drift), degrees = degrees_of_freedom(gas);
        const double unit = n * square / degrees * time, dimensions = gas->dimensions;
        double here[QUANTITIES];
        here[FACTOR] =
            degrees / (dimensions * n) + (now->virial - c->last.virial) / (dimensions * unit);
        here[WALL_FACTOR] = wall_sum(gas, &c->last) / unit;
        here[RATE] = 2 * (double)(now->collisions - c->last.collisions) / (n * time);
        here[SPEED] = mean_speed(gas, drift);
        add_speeds(c, gas, simulation->setup.seed, simulation->step);
        TRY(mf_sample_series_add(&c->series, here));
    }
    c->begun = true;
    c->last = *now;
    c->seconds = engine->seconds;
    c->collisions = (double)engine->collisions;
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct collisions *c = state;
    size_t n = mf_sample_series_spans(&c->series, spans);
    spans[n++] = (struct memory_span){&c->begun, sizeof c->begun};
    spans[n++] = (struct memory_span){&c->last, sizeof c->last};
    spans[n++] =
        (struct memory_span){c->speeds, ((size_t)c->settings.bins + 1) * sizeof *c->speeds};
    return n + mf_maxwell_spans(&c->maxwell, spans + n);
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct collisions *)state)->series);
}

// Results -----------------------------------------------------------------------------------------

struct result {
    double mean, error;
};

static const double *series(const struct collisions *c, enum quantity quantity) {
    return sample_series_column(&c->series, (size_t)quantity);
}

static struct result result_of(const struct collisions *c, enum quantity quantity) {
    struct running_mean mean = {0};
    for (size_t k = 0; k < c->series.count; k++)
        mf_statistics_add(&mean, series(c, quantity)[k]);
    struct result result = {
        mean.mean, mf_statistics_correlated_error(series(c, quantity), c->series.count, 1)};
    mf_statistics_mark_unknown_errors(&result.error, 1);
    return result;
}

/// Speed over rate; the rate makes nearly all of its error.
static struct result free_path(const struct collisions *c) {
    const struct result rate = result_of(c, RATE), speed = result_of(c, SPEED);
    const double path = speed.mean / rate.mean;
    return (struct result){path, path * hypot(rate.error / rate.mean, speed.error / speed.mean)};
}

static void write_result(struct json_writer *writer, const char *name, const char *unit,
                         struct result result, double theory) {
    char key[64];
    mf_json_put_measured(writer, name, unit, result.mean, result.error);
    snprintf(key, sizeof key, "%s_theory", name);
    if (!isnan(theory))
        mf_json_write_quantity(writer, key, unit, theory);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct collisions *c = state;
    const struct maxwell_summary maxwell = mf_maxwell_result(&c->maxwell);
    (void)results;
    mf_json_write_number(writer, "packing_fraction", c->theory.eta);
    write_result(writer, "compressibility_factor", "", result_of(c, FACTOR),
                 c->theory.compressibility_factor);
    if (c->walls)
        write_result(writer, "compressibility_factor_walls", "", result_of(c, WALL_FACTOR), NAN);
    write_result(writer, "collision_rate", "1/tau", result_of(c, RATE), c->theory.collision_rate);
    write_result(writer, "mean_free_path", "lambda", free_path(c), c->theory.mean_free_path);
    mf_json_write_number(writer, "speeds_tested", maxwell.numbers);
    mf_json_write_number(writer, "speeds_independent", maxwell.independent);
    mf_json_write_number(writer, "speeds_kolmogorov_smirnov", maxwell.statistic);
    mf_json_write_number(writer, "speeds_p_value", maxwell.probability);
    mf_json_write_number(writer, "collisions", (double)c->last.collisions);
    mf_json_write_quantity(writer, "deepest_overlap", "lambda", c->last.overlap);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    (void)results;
    const struct collisions *c = state;
    const struct result factor = result_of(c, FACTOR);
    const struct result by_walls = result_of(c, WALL_FACTOR);
    char text[NUMBER_TEXT_SIZE], walls[NUMBER_TEXT_SIZE];
    mf_number_text(factor.mean, factor.error, text);
    mf_number_text(by_walls.mean, by_walls.error, walls);
    snprintf(line, size, "Z = %s by collisions, theory %.5g without walls%s%s; %.3g collisions/s",
             text, c->theory.compressibility_factor, c->walls ? "; by the walls " : "",
             c->walls ? walls : "", c->collisions / c->seconds);
}

/// collisions.tsv: a row for each sample.
static enum status write_series(const struct collisions *c,
                                const struct observable_results *results) {
    OWNED double *step = NULL, *time = NULL;
    TRY_ARRAY(step, c->series.count);
    TRY_ARRAY(time, c->series.count);
    for (size_t k = 0; k < c->series.count; k++) {
        step[k] = (double)(c->first + (int64_t)(k + 1) * c->every);
        time[k] = step[k] * results->setup->time_step;
    }
    const struct data_column columns[] = {
        {"step", step, NULL},
        {"time[tau]", time, NULL},
        {"compressibility_factor[1]", series(c, FACTOR), "%.8g"},
        {"collision_rate[1/tau]", series(c, RATE), "%.8g"},
        {"mean_speed[lambda/tau]", series(c, SPEED), "%.8g"},
        {"compressibility_factor_walls[1]", series(c, WALL_FACTOR), "%.8g"}};
    return mf_observable_table(results, "collisions.tsv", columns, c->walls ? 6 : 5,
                               c->series.count);
}

/// speeds.tsv: the middle of a bin, the density of speeds there with the error of as many counts as
/// are independent, Maxwell's mean density in the bin.
static enum status write_speeds(const struct collisions *c,
                                const struct observable_results *results) {
    const size_t bins = (size_t)c->settings.bins;
    const int dimensions = results->setup->box.dimensions;
    const double width = speed_maximum / (double)bins;
    const double all = (double)c->series.count * (double)c->particles * width;
    const struct maxwell_summary tested = mf_maxwell_result(&c->maxwell);
    const double each = sqrt(tested.numbers / tested.independent);
    OWNED double *values = NULL;
    TRY_ARRAY(values, 4 * bins);
    double *speed = values, *density = speed + bins, *error = density + bins,
           *theory = error + bins;
    for (size_t k = 0; k < bins; k++) {
        const double low = (double)k * width, count = (double)c->speeds[k];
        speed[k] = low + 0.5 * width;
        density[k] = count / all;
        error[k] = count > 0 ? each * sqrt(count) / all : NAN;
        theory[k] =
            (maxwell_share(dimensions, low + width) - maxwell_share(dimensions, low)) / width;
    }
    const struct data_column columns[] = {{"speed[sqrt(k_B.T/m)]", speed, NULL},
                                          {"density[1]", density, "%.8g"},
                                          {"density_error[1]", error, "%.3g"},
                                          {"maxwell[1]", theory, "%.8g"}};
    return mf_observable_table(results, "speeds.tsv", columns, 4, bins);
}

/// timing.tsv: of this process alone, after a restart.
static enum status write(const void *state, const struct observable_results *results) {
    const struct collisions *c = state;
    const double rate = c->seconds > 0 ? c->collisions / c->seconds : NAN;
    const struct data_column columns[] = {{"seconds[s]", &c->seconds, NULL},
                                          {"collisions", &c->collisions, NULL},
                                          {"collisions_per_second[1/s]", &rate, "%.6g"}};
    TRY(write_series(c, results));
    TRY(write_speeds(c, results));
    return mf_observable_table(results, "timing.tsv", columns, 3, 1);
}

/// Nanoseconds of a particle and sample: its speed, and where it stands in the distribution.
static const double sample_cost = 40;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings, (void)setup;
    mf_stages_add(stages, "collisions", true, sample_cost / every,
                  "pressure, rates, speeds, one step in %.0f", every);
}

static const char *const files[] = {"speeds.tsv", "collisions.tsv", "timing.tsv", NULL};

const struct observable mf_collisions = {
    .name = "collisions",
    .summary = "pressure, collision rate, mean free path and speeds of hard particles",
    .of_time = true,
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct collisions),
    .begin = begin,
    .clear = clear,
    .due = due,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "collisions",
    .files = files,
    .figure = "speeds",
};
