// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/flow_profile.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "dynamics/solvent.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/pooled.h"

#include <math.h>

enum { MAX_BLOCKS = 32 };

struct settings {
    int64_t bins;
};

/// What is known of one bin.
struct bin {
    double count, momentum; ///< Σ 1, Σ v_x
};

struct profile {
    struct simulation_setup setup; ///< with the parameters of the solvent
    struct collision_dynamics_parameters parameters;
    size_t bins, blocks, each;
    double height, interval; ///< interval of time between samples
    uint64_t samples;
    struct bin *sums; ///< shape [blocks, bins]
    double energy[MAX_BLOCKS], degrees[MAX_BLOCKS];
    double *now; ///< shape [bins, 4]: Σ 1, Σ v of a sample
    /// Across the flow, where a wave does not carry them: places of the beads when the block began,
    /// shape [axes, beads] by id, and the mean square of their ways over a block, along an axis.
    size_t beads;
    double bead_mass; ///< of all; NaN if they differ
    double *before, square[MAX_BLOCKS];
};

static const struct field fields[] = {
    {"bins", FIELD_INTEGER, offsetof(struct settings, bins), .initial = 0, .minimum = 0,
     .maximum = 1e5, .unit = "", .help = "bins along y; 0: one a cell"},
    FIELD_END,
};

static double mass_of(const struct particles *beads) {
    const double *mass = particles_masses(beads);
    for (size_t k = 1; mass && k < beads->count; k++)
        if (mass[k] != mass[0])
            return NAN;
    return mass && beads->count > 0 ? mass[0] : 1;
}

/// Whether nothing carries the beads along the axes across the flow, on which their D is measured.
static bool beads_diffuse_alone(const struct collision_dynamics_parameters *parameters) {
    bool alone = parameters->walls == COLLISION_NO_WALLS;
    for (int d = 1; d < 3; d++)
        alone = alone && parameters->acceleration[d] == 0 && parameters->drift[d] == 0;
    return alone;
}

/// The highest velocity of the flow that s and the viscosity make; 0 if its shape is not known.
static double peak_shape(const struct profile *p) {
    if (p->parameters.obstacle_radius > 0)
        return 0;
    const double k = 2 * M_PI / p->height;
    return p->parameters.walls == COLLISION_PLATES
               ? fabs(p->parameters.acceleration[0]) * p->height * p->height / 8
               : fabs(p->parameters.wave_acceleration) / (k * k);
}

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    enum { MIN_BINS = 3 }; // two of a parabola are as fast
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    struct profile *p = state;
    if (solvent == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "flow_profile: %s has no solvent; use \"collision-dynamics\"",
                              simulation->setup.integrator->name);
    const struct settings *given = settings;
    p->setup = simulation->setup;
    p->parameters = solvent->parameters;
    p->setup.integrator_parameters = &p->parameters;
    p->height = solvent->box.length[1];
    p->bins = given->bins > 0 ? (size_t)given->bins : (size_t)rint(p->height / p->parameters.cell);
    if (peak_shape(p) > 0 && p->bins < MIN_BINS)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "flow_profile.bins: %zu along y are too few for a viscosity; expected at least %d",
            p->bins, MIN_BINS);
    p->interval = (double)plan->every * simulation->setup.time_step;
    p->each = ((size_t)plan->samples + MAX_BLOCKS - 1) / MAX_BLOCKS;
    p->blocks = (size_t)plan->samples / p->each;
    TRY_ARRAY(p->sums, p->blocks * p->bins);
    TRY_ARRAY(p->now, 4 * p->bins);
    p->beads = beads_diffuse_alone(&p->parameters) ? simulation->particles.count : 0;
    p->bead_mass = mass_of(&simulation->particles);
    TRY_ARRAY(p->before, 2 * p->beads);
    return STATUS_OK;
}

static void clear(void *state) {
    struct profile *p = state;
    mf_memory_free(p->sums);
    mf_memory_free(p->now);
    mf_memory_free(p->before);
    *p = (struct profile){0};
}

/// The ways of the beads along y and z since their block began, at its last sample.
static void follow_beads(struct profile *p, const struct particles *beads, size_t block) {
    const bool begins = (p->samples - 1) % p->each == 0, ends = p->samples % p->each == 0;
    const int axes = beads->box.dimensions - 1;
    double sum = 0;
    for (int d = 1; d <= axes && (begins || ends); d++)
        for (size_t k = 0; k < p->beads; k++) {
            const double x = beads->position[d][k] + beads->image[d][k] * beads->box.length[d];
            double *before = &p->before[(size_t)(d - 1) * p->beads + beads->id[k]];
            if (begins)
                *before = x;
            sum += (x - *before) * (x - *before);
        }
    if (ends && p->beads > 0)
        p->square[block] = sum / (axes * (double)p->beads);
}

/// Energy relative to the mean velocity of the particles' own bin: flow is no heat.
static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct profile *p = state;
    const struct solvent *solvent = mf_collision_dynamics_solvent(simulation);
    const double scale = (double)p->bins / p->height;
    const int dimensions = solvent->box.dimensions;
    const size_t block = p->samples++ / p->each;
    double squares = 0;
    if (block >= p->blocks)
        return STATUS_OK;
    follow_beads(p, &simulation->particles, block);
    memset(p->now, 0, 4 * p->bins * sizeof *p->now);
    for (size_t k = 0; k < solvent->count; k++) {
        const double place = solvent->position[1][k] * scale;
        const size_t bin = place < (double)p->bins ? (size_t)fmax(0, place) : p->bins - 1;
        double *now = p->now + 4 * bin;
        now[0] += 1;
        for (int d = 0; d < dimensions; d++) {
            const double v = solvent->velocity[d][k];
            now[1 + d] += v;
            squares += v * v;
        }
    }
    for (size_t bin = 0; bin < p->bins; bin++) {
        const double *now = p->now + 4 * bin;
        if (!(now[0] > 0))
            continue;
        p->sums[block * p->bins + bin].count += now[0];
        p->sums[block * p->bins + bin].momentum += now[1];
        p->degrees[block] += dimensions * (now[0] - 1);
        for (int d = 0; d < dimensions; d++)
            squares -= now[1 + d] * now[1 + d] / now[0];
    }
    p->energy[block] += p->parameters.mass * squares;
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct profile *p = state;
    spans[0] = (struct memory_span){&p->samples, sizeof p->samples};
    spans[1] = (struct memory_span){p->sums, p->blocks * p->bins * sizeof *p->sums};
    spans[2] = (struct memory_span){p->energy, sizeof p->energy};
    spans[3] = (struct memory_span){p->degrees, sizeof p->degrees};
    spans[4] = (struct memory_span){p->square, sizeof p->square};
    spans[5] = (struct memory_span){p->before, 2 * p->beads * sizeof *p->before};
    return 6;
}

// Results -----------------------------------------------------------------------------------------

static size_t complete_blocks(const struct profile *p) {
    const size_t blocks = p->samples / p->each;
    return blocks < p->blocks ? blocks : p->blocks;
}

/// s(y), averaged over a bin; 0 everywhere if nothing drives the flow.
static double shape(const struct profile *p, size_t bin) {
    const double width = p->height / (double)p->bins, y = width * ((double)bin + 0.5);
    const double k = 2 * M_PI / p->height, half = 0.5 * k * width;
    if (p->parameters.walls == COLLISION_PLATES)
        return 0.5 * p->parameters.acceleration[0] * (y * (p->height - y) - width * width / 12);
    return p->parameters.wave_acceleration / (k * k) * sin(k * y) * sin(half) / half;
}

/// v = A + B s, with the blocks from `first` to before `last`, but for `without`.
struct line {
    double base, slope;
};

static struct line fit(const struct profile *p, size_t first, size_t last) {
    double n = 0, s = 0, ss = 0, v = 0, vs = 0;
    for (size_t bin = 0; bin < p->bins; bin++) {
        struct bin sum = {0};
        const double x = shape(p, bin);
        for (size_t block = first; block < last; block++) {
            sum.count += p->sums[block * p->bins + bin].count;
            sum.momentum += p->sums[block * p->bins + bin].momentum;
        }
        n += sum.count;
        s += sum.count * x;
        ss += sum.count * x * x;
        v += sum.momentum;
        vs += sum.momentum * x;
    }
    const double slope = (n * vs - s * v) / (n * ss - s * s);
    return (struct line){(v - slope * s) / n, slope};
}

/// Of all blocks together, with errors from those of single ones: that of ν is by 1/ν, which is
/// linear in the velocities.
struct flow_profile_summary mf_flow_profile_result(const void *state) {
    const struct profile *p = state;
    const size_t blocks = complete_blocks(p);
    const double window = 2 * p->interval * (double)(p->each - 1);
    const struct line all = fit(p, 0, blocks);
    const double peak = peak_shape(p);
    double slopes[MAX_BLOCKS], bases[MAX_BLOCKS], temperatures[MAX_BLOCKS];
    double energy = 0, degrees = 0, squares = 0;
    for (size_t block = 0; block < blocks; block++) {
        const struct line one = fit(p, block, block + 1);
        slopes[block] = one.slope;
        bases[block] = one.base;
        temperatures[block] = p->energy[block] / p->degrees[block];
        energy += p->energy[block];
        degrees += p->degrees[block];
        squares += p->square[block];
    }
    const double diffusion = squares / ((double)blocks * window);
    const double diffusion_error = mf_statistics_correlated_error(p->square, blocks, 1) / window;
    const double schmidt = 1 / (all.slope * diffusion);
    const double error = mf_statistics_correlated_error(slopes, blocks, 1);
    const double base_error = mf_statistics_correlated_error(bases, blocks, 1);
    const double top = copysign(peak, p->parameters.acceleration[0]) * all.slope; // of the velocity
    return (struct flow_profile_summary){
        .viscosity = peak > 0 ? 1 / all.slope : NAN,
        .viscosity_error = error / (all.slope * all.slope),
        .diffusion = p->beads > 0 ? diffusion : NAN,
        .diffusion_error = diffusion_error,
        .schmidt = p->beads > 0 ? schmidt : NAN,
        .schmidt_error = schmidt * hypot(error / all.slope, diffusion_error / diffusion),
        .slip = all.base / top,
        .slip_error = base_error / fabs(top),
        .temperature = energy / degrees,
        .temperature_error = mf_statistics_correlated_error(temperatures, blocks, 1)};
}

static bool is_driven(const struct profile *p) {
    return peak_shape(p) > 0;
}

/// flow_profile.tsv: y, v_x with its error, the fitted curve, and how many particles there were.
static enum status write(const void *state, const struct observable_results *results) {
    const struct profile *p = state;
    const size_t blocks = complete_blocks(p);
    const struct line line = fit(p, 0, blocks);
    OWNED double *values = NULL;
    TRY_ARRAY(values, 5 * p->bins);
    double *y = values, *v = y + p->bins, *error = v + p->bins, *fitted = error + p->bins,
           *count = fitted + p->bins;
    for (size_t bin = 0; bin < p->bins; bin++) {
        double means[MAX_BLOCKS], momentum = 0;
        for (size_t block = 0; block < blocks; block++) {
            const struct bin *sum = &p->sums[block * p->bins + bin];
            means[block] = sum->momentum / sum->count;
            momentum += sum->momentum;
            count[bin] += sum->count;
        }
        y[bin] = p->height * ((double)bin + 0.5) / (double)p->bins;
        v[bin] = momentum / count[bin];
        error[bin] = mf_statistics_correlated_error(means, blocks, 1);
        fitted[bin] = is_driven(p) ? line.base + line.slope * shape(p, bin) : NAN;
        count[bin] /= (double)(blocks * p->each);
    }
    mf_statistics_mark_unknown_errors(error, p->bins);
    const struct data_column columns[] = {{"y[lambda]", y, NULL},
                                          {"v_x[lambda/tau]", v, "%.8g"},
                                          {"v_x_error[lambda/tau]", error, "%.3g"},
                                          {"fit[lambda/tau]", fitted, "%.8g"},
                                          {"particles[1]", count, "%.6g"}};
    return mf_observable_table(results, "flow_profile.tsv", columns, 5, p->bins);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct profile *p = state;
    struct flow_profile_summary found = mf_flow_profile_result(p);
    (void)results;
    if (is_driven(p)) {
        mf_statistics_mark_unknown_errors(&found.viscosity_error, 1);
        mf_json_put_measured(writer, "viscosity", "lambda^2/tau", found.viscosity,
                             found.viscosity_error);
        if (p->parameters.grid_shift)
            mf_json_write_quantity(writer, "viscosity_theory", "lambda^2/tau",
                                   mf_collision_dynamics_viscosity(&p->setup));
    }
    if (is_driven(p) && p->parameters.walls == COLLISION_PLATES) {
        mf_statistics_mark_unknown_errors(&found.slip_error, 1);
        mf_json_put_measured(writer, "slip", "1", found.slip, found.slip_error);
    }
    if (isfinite(found.diffusion)) {
        mf_json_put_measured(writer, "bead_diffusion", "lambda^2/tau", found.diffusion,
                             found.diffusion_error);
        if (p->setup.potential == NULL && p->setup.interactions == 0)
            mf_json_write_quantity(writer, "bead_diffusion_theory", "lambda^2/tau",
                                   mf_collision_dynamics_diffusion(&p->setup, p->bead_mass));
    }
    if (is_driven(p) && isfinite(found.schmidt)) {
        mf_json_put_measured(writer, "schmidt_number", "1", found.schmidt, found.schmidt_error);
    }
    mf_statistics_mark_unknown_errors(&found.temperature_error, 1);
    mf_json_put_measured(writer, "solvent_temperature", "T_0", found.temperature,
                         found.temperature_error);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct profile *p = state;
    const struct flow_profile_summary found = mf_flow_profile_result(p);
    const struct units *units = results->units;
    const double factor = mf_units_factor(units, "lambda^2/tau");
    const double temperature = found.temperature * mf_units_factor(units, "T_0");
    char viscosity[NUMBER_TEXT_SIZE], unit[UNITS_NAME_SIZE], kelvin[UNITS_NAME_SIZE];
    mf_number_text(factor * found.viscosity, factor * found.viscosity_error, viscosity);
    mf_units_suffix(units, "T_0", kelvin);
    if (is_driven(p))
        snprintf(line, size, "viscosity %s%s, by theory %.4g; temperature of the solvent %.4f%s",
                 viscosity, mf_units_suffix(units, "lambda^2/tau", unit),
                 factor * mf_collision_dynamics_viscosity(&p->setup), temperature, kelvin);
    else
        snprintf(line, size,
                 "temperature of the solvent %.4f%s; a viscosity needs plates and an acceleration "
                 "along x, or a wave, and no obstacle",
                 temperature, kelvin);
}

/// A flow that still grows, or hardly differs from the noise, gives any viscosity.
static enum status assess(const void *state, const struct simulation_setup *setup) {
    static const double max = 0.2;
    const struct flow_profile_summary found = mf_flow_profile_result(state);
    (void)setup;
    if (!is_driven(state) || fabs(found.viscosity_error) <= max * fabs(found.viscosity))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_UNCONVERGED,
        "the viscosity is %.2g with an error of %.2g: the flow is not stationary, or hidden by "
        "noise; take a longer \"equilibration\" or more \"samples\"",
        found.viscosity, found.viscosity_error);
}

/// Nanoseconds of a solvent particle and sample.
static const double sample_cost = 4;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    (void)settings;
    mf_stages_add(stages, "flow profile", true,
                  sample_cost * simulation_moved(setup) / fmax(1, (double)setup->placement.count) /
                      every,
                  "one step in %.0f", every);
}

static enum status result_of_all(const void *const *states, size_t count,
                                 const struct observable_values *values) {
    for (size_t k = 0; k < count; k++) {
        const struct flow_profile_summary found = mf_flow_profile_result(states[k]);
        mf_pooled_add(&values[0], &found.viscosity, &found.viscosity_error, count);
        mf_pooled_add(&values[1], &found.schmidt, &found.schmidt_error, count);
    }
    return STATUS_OK;
}

static const struct observable_target targets[] = {
    {.name = "viscosity",
     .summary = "kinematic viscosity of a solvent that is driven",
     .form = OBSERVABLE_NUMBER},
    {.name = "schmidt_number",
     .summary = "viscosity over diffusion coefficient of the beads in a wave",
     .form = OBSERVABLE_NUMBER},
    {.name = NULL}};
static const char *const files[] = {"flow_profile.tsv", NULL};

const struct observable mf_flow_profile = {
    .name = "flow_profile",
    .summary = "velocity and viscosity of the solvent between plates or in a wave",
    .of_time = true,
    .of_solvent = true,
    .fields = fields,
    .settings_size = sizeof(struct settings),
    .state_size = sizeof(struct profile),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = "flow profile",
    .files = files,
    .figure = "flow_profile",
    .targets = targets,
    .result_of_all = result_of_all,
};
