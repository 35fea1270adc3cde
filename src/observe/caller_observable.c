// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/caller_observable.h"

#include "base/statistics.h"
#include "observe/sample_series.h"

#include <ctype.h>
#include <fnmatch.h>
#include <math.h>
#include <string.h>

enum { FIRST_ROOM = 16, NAME_MAX_LENGTH = 60 };

struct state {
    struct caller_observable own;
    const struct units *units;
    int dimensions;
    bool has_velocities;
    size_t count;             ///< particles
    double *position;         ///< shape [count, dimensions]
    double *velocity;         ///< the same
    int32_t *type;            ///< shape [count]
    size_t room;              ///< of `values`
    double *values;           ///< of one sample
    size_t width;             ///< values of a sample; 0: not known yet
    struct sample_series all; ///< those of all samples, one behind the other
};

// Names -------------------------------------------------------------------------------------------

static enum status check_name(const char *name) {
    size_t length = 0;
    while (name && length <= NAME_MAX_LENGTH &&
           (isalnum((unsigned char)name[length]) || (length > 0 && strchr("_-", name[length]))) &&
           name[length])
        length++;
    return name && length > 0 && length <= NAME_MAX_LENGTH && name[length] == '\0'
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT,
                                "observable \"%.80s\": expected a name of letters, digits, \"_\" "
                                "and \"-\", at most %d of them",
                                name ? name : "", NAME_MAX_LENGTH);
}

/// A table of the program's own would be replaced.
static enum status check_table(const char *name) {
    char file[NAME_MAX_LENGTH + 8];
    snprintf(file, sizeof file, "%s.tsv", name);
    for (size_t k = 0; mf_observables[k]; k++)
        for (const char *const *own = mf_observables[k]->files; own && *own; own++)
            if (fnmatch(*own, file, 0) == 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "observable \"%s\": \"%s\" has a table of this name; choose "
                                      "another one",
                                      name, mf_observables[k]->name);
    return STATUS_OK;
}

enum status mf_caller_observables_check(const struct caller_observables *observables) {
    for (size_t k = 0; k < observables->count; k++) {
        const char *name = observables->item[k].name;
        TRY(check_name(name));
        TRY(check_table(name));
        for (size_t j = 0; j < k; j++)
            if (strcmp(observables->item[j].name, name) == 0)
                return mf_status_fail(STATUS_BAD_INPUT, "observable \"%s\": the name comes twice",
                                      name);
    }
    return STATUS_OK;
}

// Samples -----------------------------------------------------------------------------------------

static enum status begin(void *state, const void *settings,
                         const struct configuration *configuration,
                         const struct measure_plan *plan) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    (void)plan;
    *s = (struct state){.own = *(const struct caller_observable *)settings,
                        .dimensions = simulation->particles.box.dimensions,
                        .has_velocities = simulation_has_velocities(&simulation->setup),
                        .count = simulation->particles.count,
                        .room = FIRST_ROOM,
                        .all.columns = 1};
    const size_t numbers = s->count * (size_t)s->dimensions;
    TRY_ARRAY(s->position, numbers);
    TRY_ARRAY(s->velocity, numbers);
    TRY_ARRAY(s->type, s->count);
    TRY_ARRAY(s->values, s->room);
    for (size_t id = 0; id < s->count; id++)
        s->type[id] = mf_composition_type(&simulation->setup.composition, (uint32_t)id);
    return STATUS_OK;
}

static void clear(void *state) {
    struct state *s = state;
    mf_memory_free(s->position);
    mf_memory_free(s->velocity);
    mf_memory_free(s->type);
    mf_memory_free(s->values);
    mf_sample_series_clear(&s->all);
    *s = (struct state){0};
}

static void open_folder(void *state, const struct observable_results *results) {
    ((struct state *)state)->units = results->units;
}

/// A coordinate in [0, length), also where length - x is less than what rounding leaves of it.
static double fold(double x, double length) {
    const double folded = x - length * floor(x / length);
    return folded < length ? folded : 0;
}

static void copy_particles(struct state *s, const struct particles *particles, double edge[3]) {
    const double length = mf_units_factor(s->units, "lambda");
    const double speed = mf_units_factor(s->units, "lambda/tau");
    const size_t dimensions = (size_t)s->dimensions;
    for (size_t d = 0; d < dimensions; d++) {
        const double box = particles->box.length[d];
        edge[d] = box * length;
        for (size_t k = 0; k < s->count; k++) {
            const size_t at = particles->id[k] * dimensions + d;
            s->position[at] = fold(particles->position[d][k], box) * length;
            s->velocity[at] = particles->velocity[d][k] * speed;
        }
    }
}

/// What a function answers; more than there is room for, and it is asked once more.
static enum status ask(struct state *s, const struct caller_sample *sample, ptrdiff_t *answer) {
    *answer = s->own.function(s->own.context, sample, s->room, s->values);
    if (*answer < 0 || (size_t)*answer <= s->room)
        return STATUS_OK;
    mf_memory_free(s->values);
    s->values = NULL;
    s->room = (size_t)*answer;
    TRY_ARRAY(s->values, s->room);
    *answer = s->own.function(s->own.context, sample, s->room, s->values);
    return STATUS_OK;
}

static enum status check_answer(struct state *s, ptrdiff_t answer, uint64_t step) {
    const unsigned long long now = step;
    if (answer < 0)
        return mf_status_fail(STATUS_BAD_INPUT, "observable \"%s\" failed at step %llu",
                              s->own.name, now);
    if (answer == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "observable \"%s\" has no value at step %llu",
                              s->own.name, now);
    if (s->width == 0)
        s->width = (size_t)answer;
    return (size_t)answer == s->width
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT,
                                "observable \"%s\" has %td values at step %llu, and had %zu before",
                                s->own.name, answer, now, s->width);
}

static enum status sample(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct state *s = state;
    double edge[3];
    ptrdiff_t answer;
    copy_particles(s, &simulation->particles, edge);
    const struct caller_sample now = {.count = s->count,
                                      .dimensions = s->dimensions,
                                      .position = s->position,
                                      .velocity = s->has_velocities ? s->velocity : NULL,
                                      .type = s->type,
                                      .edge = edge};
    TRY(ask(s, &now, &answer));
    TRY(check_answer(s, answer, simulation->step));
    for (size_t k = 0; k < s->width; k++)
        TRY(mf_sample_series_add(&s->all, &s->values[k]));
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t n = mf_sample_series_spans(&s->all, spans);
    spans[n] = (struct memory_span){&s->width, sizeof s->width};
    return n + 1;
}

static enum status reserve(void *state) {
    return mf_sample_series_reserve(&((struct state *)state)->all);
}

// Results -----------------------------------------------------------------------------------------

/// NAME.tsv: the mean of each value over the samples, and its error. What is not finite is not
/// known, and neither is a mean of it.
static enum status write(const void *state, const struct observable_results *results) {
    const struct state *s = state;
    const size_t samples = s->width > 0 ? s->all.count / s->width : 0;
    OWNED double *numbers = NULL, *series = NULL;
    char file[NAME_MAX_LENGTH + 8];
    TRY_ARRAY(numbers, 3 * s->width + 1);
    TRY_ARRAY(series, samples + 1);
    double *index = numbers, *value = index + s->width, *error = value + s->width;
    for (size_t k = 0; k < s->width; k++) {
        double sum = 0;
        for (size_t n = 0; n < samples; n++)
            sum += series[n] = sample_series_column(&s->all, 0)[n * s->width + k];
        index[k] = (double)k;
        value[k] = isfinite(sum) ? sum / (double)samples : NAN;
        error[k] = isfinite(sum) ? mf_statistics_correlated_error(series, samples, 1) : NAN;
    }
    mf_statistics_mark_unknown_errors(error, s->width);
    snprintf(file, sizeof file, "%s.tsv", s->own.name);
    const struct data_column columns[] = {
        {"index[1]", index, "%.0f"}, {"value", value, "%.15g"}, {"error", error, "%.6g"}};
    return mf_observable_table(results, file, columns, 3, s->width);
}

const struct observable mf_caller_observable = {
    .name = "caller",
    .summary = "a function of who calls the library",
    .settings_size = sizeof(struct caller_observable),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .open = open_folder,
    .sample = sample,
    .spans = spans,
    .reserve = reserve,
    .write = write,
    .stage = "observables of the caller",
};
