// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/weighted_density.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "observe/measure.h"

#include <math.h>
#include <string.h>

enum { MEAN, SQUARE, BEYOND, SERIES };

/// ∫ w^power dV, by the rule of the middle.
static double integrate(const struct weighted_density_settings *settings, const struct box *box,
                        int power) {
    enum { STEPS = 1000 };
    const double width = settings->cutoff / STEPS;
    double sum = 0;
    for (int k = 0; k < STEPS; k++) {
        const double r = width * (k + 0.5);
        sum += pow(weighted_density_weight(settings, r * r), power) *
               mf_box_shell_volume(box, width * k, width * (k + 1));
    }
    return sum;
}

enum status mf_weighted_density_init(struct weighted_density *density,
                                     const struct weighted_density_settings *settings,
                                     const struct box *box, size_t count, size_t planned) {
    static const double room = 4;
    const double number = (double)count / mf_box_volume(box);
    *density = (struct weighted_density){.settings = *settings, .series.columns = SERIES};
    if (!(settings->inner_cutoff < settings->cutoff))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "weighted_density.inner_cutoff: %g" STATUS_LENGTH
                              " is not below the cutoff %g" STATUS_LENGTH,
                              settings->inner_cutoff, settings->cutoff);
    if (settings->maximum == 0)
        density->settings.maximum = room * (number * integrate(settings, box, 1) +
                                            sqrt(number * integrate(settings, box, 2)));
    return mf_sample_blocks_init(&density->blocks, planned, (size_t)settings->bins);
}

void mf_weighted_density_clear(struct weighted_density *density) {
    mf_sample_series_clear(&density->series);
    mf_sample_blocks_clear(&density->blocks);
    *density = (struct weighted_density){0};
}

enum status mf_weighted_density_add(struct weighted_density *density, const double *values,
                                    size_t count) {
    const size_t bins = (size_t)density->settings.bins;
    const double per_density = (double)bins / density->settings.maximum, one = 1 / (double)count;
    double numbers[SERIES] = {0};
    double *const sums = mf_sample_blocks_next(&density->blocks);
    for (size_t k = 0; k < count; k++) {
        const double place = values[k] * per_density;
        numbers[MEAN] += one * values[k];
        numbers[SQUARE] += one * values[k] * values[k];
        if (place < (double)bins)
            sums[(size_t)place] += one;
        else
            numbers[BEYOND] += one;
    }
    return mf_sample_series_add(&density->series, numbers);
}

/// ⟨ρ²⟩ − ⟨ρ⟩²; to first order its error is that of the mean of ρ² − 2⟨ρ⟩ρ.
static double find_variance(const struct weighted_density *density, double mean, double *error) {
    const size_t count = density->series.count;
    const double *const means = sample_series_column(&density->series, MEAN);
    const double *const squares = sample_series_column(&density->series, SQUARE);
    struct sample_series linear = {.columns = 1};
    double ignored;
    *error = NAN;
    for (size_t k = 0; k < count; k++) {
        const double number = squares[k] - 2 * mean * means[k];
        if (mf_sample_series_add(&linear, &number) != STATUS_OK)
            break;
    }
    if (linear.count == count && count > 0)
        (void)mf_sample_series_mean(&linear, 0, error);
    mf_sample_series_clear(&linear);
    return mf_sample_series_mean(&density->series, SQUARE, &ignored) - mean * mean;
}

struct weighted_density_summary mf_weighted_density_result(const struct weighted_density *density) {
    struct weighted_density_summary s;
    double ignored;
    s.mean = mf_sample_series_mean(&density->series, MEAN, &s.mean_error);
    s.variance = find_variance(density, s.mean, &s.variance_error);
    s.beyond = mf_sample_series_mean(&density->series, BEYOND, &ignored);
    if (density->series.count < 2)
        s.mean_error = s.variance_error = NAN;
    return s;
}

/// p in a bin, the mean over the whole blocks, and its error.
static double find_bin(const struct weighted_density *density, size_t bin, double *error) {
    const double width = density->settings.maximum / (double)density->settings.bins;
    return mf_sample_blocks_mean(&density->blocks, bin, width, error);
}

double mf_weighted_density_at(const struct weighted_density *density, double value, double *error) {
    static const double rounding = 1e-6;
    const double bins = (double)density->settings.bins;
    const double place = value / density->settings.maximum * bins - 0.5;
    double errors[2];
    *error = NAN;
    if (!(place >= -0.5 && place <= bins - 0.5 + rounding))
        return NAN;
    const double low = fmin(fmax(floor(place), 0), bins - 1), high = fmin(low + 1, bins - 1);
    const double part = fmin(fmax(place - low, 0), 1);
    const double below = find_bin(density, (size_t)low, &errors[0]);
    const double above = find_bin(density, (size_t)high, &errors[1]);
    *error = hypot((1 - part) * errors[0], part * errors[1]);
    return (1 - part) * below + part * above;
}

enum status mf_weighted_density_write(const struct weighted_density *density,
                                      const struct observable_results *results) {
    const size_t bins = (size_t)density->settings.bins;
    OWNED double *values = NULL;
    TRY_ARRAY(values, 3 * bins);
    double *const place = values, *const share = place + bins, *const error = share + bins;
    for (size_t k = 0; k < bins; k++) {
        place[k] = density->settings.maximum * ((double)k + 0.5) / (double)bins;
        share[k] = find_bin(density, k, &error[k]);
    }
    mf_statistics_mark_unknown_errors(error, bins);
    const struct data_column columns[] = {
        {"rho[1]", place, "%.6g"}, {"p[1]", share, "%.6g"}, {"error[1]", error, "%.3g"}};
    return mf_observable_table(results, "weighted_density.tsv", columns, 3, bins);
}

void mf_weighted_density_write_summary(const struct weighted_density *density,
                                       struct json_writer *writer) {
    const struct weighted_density_summary s = mf_weighted_density_result(density);
    mf_json_put_measured(writer, "weighted_density", "1", s.mean, s.mean_error);
    mf_json_put_measured(writer, "weighted_density_variance", "1", s.variance, s.variance_error);
    if (s.beyond > 0)
        mf_json_write_number(writer, "weighted_density_beyond", s.beyond);
}

//
// The same of a simulation's particles. Tested: test_weighted_density (unit, cli).

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
    return mf_weighted_density_list_init(&s->list, wish, box, count);
}

static void clear(void *state) {
    struct state *s = state;
    mf_weighted_density_clear(&s->density);
    mf_weighted_density_list_clear(&s->list);
    *s = (struct state){0};
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    TRY(mf_weighted_density_list_find(&s->list, &simulation->particles));
    return mf_weighted_density_add(&s->density, s->list.values, simulation->particles.count);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct weighted_density *const d = &((struct state *)state)->density;
    const size_t n = mf_sample_series_spans(&d->series, spans);
    return n + mf_sample_blocks_spans(&d->blocks, spans + n);
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
     .unit = "", .help = "bins from 0"},
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
                d->blocks.sums[n % blocks * d->blocks.row + first + k] /
                d->blocks.samples[n % blocks];
        }
    return mf_statistics_independence(series, blocks, replicas, count, found);
}

enum status mf_weighted_density_list_init(struct density_list *list,
                                          const struct weighted_density_settings *settings,
                                          const struct box *box, size_t count) {
    *list = (struct density_list){.settings = *settings};
    TRY(mf_particles_init(&list->particles, box, count));
    const enum status status =
        mf_neighbours_init(&list->neighbours, NEIGHBOURS_HALF, box, count, settings->cutoff, 0);
    TRY(status == STATUS_BAD_INPUT ? mf_status_prefix(status, "weighted_density.cutoff") : status);
    TRY_ARRAY(list->values, count);
    TRY_ARRAY(list->stresses, count);
    return STATUS_OK;
}

void mf_weighted_density_list_clear(struct density_list *list) {
    mf_particles_clear(&list->particles);
    mf_neighbours_clear(&list->neighbours);
    mf_memory_free(list->values);
    mf_memory_free(list->stresses);
    *list = (struct density_list){0};
}

static void add_pairs(void *context, const struct neighbours_batch *batch) {
    struct density_list *list = context;
    for (size_t k = 0; k < batch->count; k++) {
        const double squared = (double)batch->squared[k];
        const double weight = weighted_density_weight(&list->settings, squared);
        const double stress = weighted_density_stress(&list->settings, squared);
        list->values[batch->id_i[k]] += weight;
        list->values[batch->id_j[k]] += weight;
        list->stresses[batch->id_i[k]] += stress;
        list->stresses[batch->id_j[k]] += stress;
    }
}

enum status mf_weighted_density_list_find(struct density_list *list, const struct particles *from) {
    const size_t count = from->count;
    for (int d = 0; d < from->box.dimensions; d++)
        memcpy(list->particles.position[d], from->position[d], count * sizeof *from->position[d]);
    memcpy(list->particles.id, from->id, count * sizeof *from->id);
    TRY(mf_particles_join(&list->particles, from->topology));
    TRY(mf_neighbours_sort_and_build(&list->neighbours, &list->particles));
    memset(list->values, 0, count * sizeof *list->values);
    memset(list->stresses, 0, count * sizeof *list->stresses);
    mf_neighbours_visit_pairs(&list->neighbours, &list->particles, list->settings.cutoff, add_pairs,
                              list);
    return STATUS_OK;
}
