// SPDX-License-Identifier: GPL-3.0-or-later
//
// The same of a simulation's particles. Tested: test_weighted_density (unit, cli).
#include "base/memory.h"
#include "observe/density_list.h"
#include "observe/measure.h"

#include <math.h>

struct state {
    struct weighted_density density;
    struct density_list list;
};

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    const struct weighted_density_settings *const wish = settings;
    const struct box *const box = &simulation->setup.box;
    const size_t count = simulation->particles.count;
    TRY(mf_weighted_density_init(&s->density, wish, box, count, (size_t)plan->samples));
    return mf_density_list_init(&s->list, wish, box, count);
}

static void clear(void *state) {
    struct state *s = state;
    mf_weighted_density_clear(&s->density);
    mf_density_list_clear(&s->list);
    *s = (struct state){0};
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    TRY(mf_density_list_find(&s->list, &simulation->particles));
    return mf_weighted_density_add(&s->density, s->list.values, simulation->particles.count);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct weighted_density *const d = &((struct state *)state)->density;
    size_t n = mf_sample_series_spans(&d->series, spans);
    n += mf_sample_blocks_spans(&d->blocks, spans + n);
    spans[n] =
        (struct memory_span){d->sums, d->blocks.count * (size_t)d->settings.bins * sizeof *d->sums};
    return n + 1;
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->density.series);
}

static enum status write(const void *state, const struct observable_results *results) {
    return mf_weighted_density_write(&((const struct state *)state)->density, results);
}

static void write_summary(const void *state, const struct observable_results *results,
                          struct json_writer *writer) {
    (void)results;
    mf_weighted_density_write_summary(&((const struct state *)state)->density, writer);
}

static void print(const void *state, const struct observable_results *results, char *line,
                  size_t size) {
    const struct weighted_density_summary s =
        mf_weighted_density_result(&((const struct state *)state)->density);
    char mean[UNITS_MEASURED_SIZE], variance[UNITS_MEASURED_SIZE];
    snprintf(line, size, "weighted density of a particle %s, variance %s",
             mf_units_measured(results->units, "1", s.mean, s.mean_error, mean),
             mf_units_measured(results->units, "1", s.variance, s.variance_error, variance));
}

static enum status assess(const void *state, const struct simulation_setup *setup) {
    static const double allowed = 1e-3;
    const struct weighted_density *const d = &((const struct state *)state)->density;
    const double beyond = mf_weighted_density_result(d).beyond;
    (void)setup;
    if (!(beyond > allowed))
        return STATUS_OK;
    return mf_status_fail(STATUS_UNCONVERGED,
                          "the weighted densities of a part %.2g of the particles are above the "
                          "table's largest, %.4g: give a larger weighted_density.maximum",
                          beyond, d->settings.maximum);
}

/// Nanoseconds of a particle, for a list of its own, and of a pair.
static const double particle_cost = 100, pair_cost = 4;

static void explain(const void *settings, const struct simulation_setup *setup, double every,
                    struct stages *stages) {
    const double cutoff = ((const struct weighted_density_settings *)settings)->cutoff;
    const double pairs = mf_stages_pairs_within(setup, cutoff);
    mf_stages_add(stages, "weighted density", true, (particle_cost + pair_cost * pairs) / every,
                  "a list of its own, one step in %.0f", every);
}

static enum status result(const void *state, const struct observable_values *values,
                          double *blocks) {
    const struct weighted_density *const d = &((const struct state *)state)->density;
    for (size_t n = 0; n < values->count; n++)
        values->value[n] = mf_weighted_density_at(d, values->x[n], &values->error[n]);
    *blocks = (double)mf_sample_blocks_whole(&d->blocks);
    return STATUS_OK;
}

#define MEMBER(name) .offset = offsetof(struct weighted_density_settings, name)
const struct field mf_weighted_density_fields[] = {
    {"inner_cutoff", FIELD_NUMBER, MEMBER(inner_cutoff), .initial = 0, .minimum = 0,
     .maximum = DBL_MAX, .unit = "lambda", .help = "r_0: the weight is 1 below it"},
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .required = true, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "r_c: the weight is 0 beyond it"},
    {"bins", FIELD_INTEGER, MEMBER(bins), .initial = 200, .minimum = 1, .maximum = 100000,
     .unit = "", .help = "number of bins from 0"},
    {"maximum", FIELD_NUMBER, MEMBER(maximum), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "", .help = "end of the bins; 0: four times mean and deviation of an ideal gas"},
    FIELD_END,
};
static const char *const files[] = {"weighted_density.tsv", NULL};

static const struct observable_target targets[] = {
    {.name = "weighted_density",
     .summary = "p of the density around each particle",
     .form = OBSERVABLE_CURVE,
     .argument = "rho[1]",
     .unit = "1",
     .has_settings = true},
    {.name = NULL}};

const struct observable mf_weighted_density = {
    .name = "weighted_density",
    .summary = "distribution of the density around each particle, neighbours by weight",
    .fields = mf_weighted_density_fields,
    .settings_size = sizeof(struct weighted_density_settings),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .write_summary = write_summary,
    .print = print,
    .assess = assess,
    .explain = explain,
    .stage = "weighted density",
    .files = files,
    .figure = OBSERVABLE_FIGURE_OF_CURVE,
    .targets = targets,
    .result = result,
};

int mf_weighted_density_kind(void) {
    int kind = 0;
    while (mf_observable_kind(kind).observable != &mf_weighted_density)
        kind++;
    return kind;
}

enum status mf_weighted_density_independence(const void *const *states, size_t replicas,
                                             size_t first, size_t count,
                                             struct statistics_independence *found) {
    const struct state *const *all = (const struct state *const *)states;
    OWNED double *series = NULL;
    size_t blocks = SIZE_MAX;
    for (size_t k = 0; k < replicas; k++) {
        const size_t whole = mf_sample_blocks_whole(&all[k]->density.blocks);
        blocks = whole < blocks ? whole : blocks;
    }
    TRY_ARRAY(series, count * replicas * blocks + 1);
    for (size_t k = 0; k < count; k++)
        for (size_t n = 0; n < replicas * blocks; n++) {
            const struct weighted_density *const d = &all[n / blocks]->density;
            series[k * replicas * blocks + n] =
                d->sums[n % blocks * (size_t)d->settings.bins + first + k] /
                d->blocks.samples[n % blocks];
        }
    return mf_statistics_independence(series, blocks, replicas, count, found);
}
