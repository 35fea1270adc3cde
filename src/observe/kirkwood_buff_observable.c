// SPDX-License-Identifier: GPL-3.0-or-later
//
// Means of G of each pair of components over blocks of samples. Errors see the correlation of the
// blocks: long waves decay slowly, with the collective diffusion D/S(q) times q². Tested:
// test_kirkwood_buff_waves.
#include "observe/kirkwood_buff_observable.h"

#include "base/number_text.h"
#include "base/statistics.h"
#include "forces/molecules.h"
#include "observe/kirkwood_buff_waves.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "observe/sample_blocks.h"

#include <math.h>

static const char unit[] = "lambda^d";

const struct field mf_kirkwood_buff_observable_fields[] = {
    {"q_maximum", FIELD_NUMBER, .offset = offsetof(struct kirkwood_buff_settings, q_maximum),
     .initial = 0, .minimum = 0, .maximum = DBL_MAX, .unit = "1/lambda",
     .help = "largest wave number of the extrapolation to q = 0; 0: a fifth of 2 pi density^(1/d), "
             "less for large molecules"},
    FIELD_END,
};

struct state {
    struct kirkwood_buff_waves waves;
    struct sample_blocks blocks;
    size_t pairs;
    double density;
    double *integral; ///< of one sample, shape [pairs] [λ^d]
    double *sums;     ///< shape [blocks, pairs]
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    enum status status = STATUS_OK;
    struct state *s = state;
    const struct simulation_setup *setup = &simulation->setup;
    const size_t count = simulation->particles.count;
    const struct molecules *molecules = configuration->molecules;
    status = mf_kirkwood_buff_waves_init(
        &s->waves, &setup->box, &setup->composition, count, molecules ? &molecules->topology : NULL,
        ((const struct kirkwood_buff_settings *)settings)->q_maximum);
    CHECK(status == STATUS_BAD_INPUT ? mf_status_prefix(status, "kirkwood_buff") : status);
    const struct composition *components = mf_kirkwood_buff_waves_components(&s->waves);
    s->pairs = (size_t)mf_composition_pairs(components);
    s->density = (double)mf_composition_particles(components) / mf_box_volume(&setup->box);
    CHECK(mf_sample_blocks_init(&s->blocks, (size_t)plan->samples));
    NEW_ARRAY(s->integral, s->pairs);
    NEW_ARRAY(s->sums, s->blocks.count * s->pairs);
done:
    return status;
}

static void clear(void *state) {
    struct state *s = state;
    mf_kirkwood_buff_waves_clear(&s->waves);
    mf_sample_blocks_clear(&s->blocks);
    mf_memory_free(s->integral);
    mf_memory_free(s->sums);
    *s = (struct state){0};
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    if (mf_sample_blocks_are_full(&s->blocks)) {
        mf_sample_blocks_join(&s->blocks, s->sums, s->pairs);
        mf_sample_blocks_double(&s->blocks);
    }
    const size_t block = mf_sample_blocks_take(&s->blocks);
    mf_kirkwood_buff_waves_take(&s->waves, &simulation->particles, simulation->setup.threads,
                                s->integral);
    for (size_t pair = 0; pair < s->pairs; pair++)
        s->sums[block * s->pairs + pair] += s->integral[pair];
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    spans[0] = (struct memory_span){s->sums, s->blocks.count * s->pairs * sizeof *s->sums};
    return 1 + mf_sample_blocks_spans(&s->blocks, spans + 1);
}

/// G of a pair type and its error; NaN before the first block is whole.
static void find(const struct state *s, size_t pair, double *value, double *error) {
    enum { MAX_BLOCKS = 64 };
    const size_t whole = mf_sample_blocks_whole(&s->blocks);
    double means[MAX_BLOCKS], sum = 0, samples = 0;
    for (size_t block = 0; block < whole; block++) {
        const double own = s->sums[block * s->pairs + pair];
        means[block] = own / s->blocks.samples[block];
        sum += own;
        samples += s->blocks.samples[block];
    }
    *value = samples > 0 ? sum / samples : NAN;
    *error = mf_statistics_correlated_error(means, whole, 1);
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct state *s = state;
    for (size_t pair = 0; pair < s->pairs && values->count > 0; pair++)
        find(s, pair, &values->value[pair], &values->error[pair]);
    *blocks = (double)mf_sample_blocks_whole(&s->blocks);
    return STATUS_OK;
}

/// A number that is known.
static void write_known(struct json_writer *writer, const char *what, const char *error,
                        const char *pair, double value) {
    char key[COMPOSITION_PAIR_NAME_SIZE + 40];
    snprintf(key, sizeof key, "%s%s%s%s", what, error, pair[0] ? "_" : "", pair);
    if (isfinite(value))
        mf_json_write_quantity(writer, key, unit, value);
}

void mf_kirkwood_buff_write(struct json_writer *writer, const char *what,
                            const struct composition *components, size_t pair, double value,
                            double error) {
    char name[COMPOSITION_PAIR_NAME_SIZE];
    mf_composition_pair_name(components, (int)pair, name);
    write_known(writer, what, "", name, value);
    write_known(writer, what, "_error", name, error > 0 ? error : NAN);
}

/// κ_T = (1 + ρG)/(ρ k_B T) where the temperature is held.
static void write_isothermal(const struct state *s, const struct observable_results *results,
                             double integral, double error, struct json_writer *writer) {
    const double unit_of = 1 / (s->density * results->setup->temperature);
    const double value = (1 + s->density * integral) * unit_of;
    const double value_error = s->density * error * unit_of;
    if (!mf_simulation_is_thermal(results->setup) || !simulation_holds_temperature(results->setup))
        return;
    if (!mf_units_are_physical(results->units))
        mf_json_put_measured(writer, "isothermal_compressibility", "lambda^d/(k_B T_0)", value,
                             value_error);
    if (mf_units_known(results->units) && results->setup->box.dimensions == 3) {
        const double bar = mf_units_pressure_bar(results->units);
        mf_json_put_measured(writer, "isothermal_compressibility_per_bar", "1", value / bar,
                             value_error / bar);
    }
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    const struct state *s = state;
    double value, error;
    for (size_t pair = 0; pair < s->pairs; pair++) {
        find(s, pair, &value, &error);
        mf_kirkwood_buff_write(writer, "kirkwood_buff",
                               mf_kirkwood_buff_waves_components(&s->waves), pair, value, error);
    }
    if (s->pairs == 1) {
        mf_json_put_measured(writer, "compressibility", "1", 1 + s->density * value,
                             s->density * error);
        write_isothermal(s, results, value, error, writer);
    }
    mf_json_write_quantity(writer, "kirkwood_buff_q_maximum", "1/lambda", s->waves.q_maximum);
    mf_json_write_number(writer, "kirkwood_buff_waves", (double)s->waves.waves.vectors);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct state *s = state;
    int length = snprintf(line, size, "Kirkwood-Buff integral%s", s->pairs > 1 ? "s" : "");
    for (size_t pair = 0; pair < s->pairs && length < (int)size; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE], text[UNITS_MEASURED_SIZE];
        double value, error;
        find(s, pair, &value, &error);
        mf_composition_pair_name(mf_kirkwood_buff_waves_components(&s->waves), (int)pair, name);
        length += snprintf(line + length, size - (size_t)length, "%s %s%s%s", pair ? "," : "", name,
                           name[0] ? " " : "",
                           mf_units_measured(results->units, unit, value, error, text));
    }
}

/// Nanoseconds of a site and wave vector.
static const double wave_cost = 1.1;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const double wish = ((const struct kirkwood_buff_settings *)settings)->q_maximum;
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const struct topology *topology = molecules ? &molecules->topology : NULL;
    const size_t beads = (size_t)setup->placement.count;
    struct composition components;
    if (mf_components_find(&components, &setup->composition, beads, topology) != STATUS_OK)
        return; // which the scene's beginning tells
    const size_t sites = (size_t)mf_composition_particles(&components);
    const double waves = mf_kirkwood_buff_waves_expected(
        &setup->box, mf_kirkwood_buff_waves_maximum(&setup->box, sites, beads, topology, wish));
    mf_stages_add(stages, "Kirkwood-Buff integrals", true,
                  wave_cost * waves * (double)sites / ((double)beads * every),
                  "about %.0f wave vectors, one step in %.0f", waves, every);
}

static const struct observable_target targets[] = {
    {.name = "kirkwood_buff",
     .summary = "Kirkwood-Buff integrals of pairs of components",
     .form = OBSERVABLE_OWN_FORM,
     .unit = unit,
     .has_settings = true},
    {.name = NULL}};

const struct observable mf_kirkwood_buff_observable = {
    .name = "kirkwood_buff",
    .summary = "Kirkwood-Buff integrals from S(q) at small q",
    .fields = mf_kirkwood_buff_observable_fields,
    .settings_size = sizeof(struct kirkwood_buff_settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .write_summary = write_summary,
    .print = print,
    .explain = explain,
    .stage = "Kirkwood-Buff integrals",
    .targets = targets,
    .result = result,
};

int mf_kirkwood_buff_kind(void) {
    int kind = 0;
    while (mf_observable_kind(kind).observable != &mf_kirkwood_buff_observable)
        kind++;
    return kind;
}
