// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/measurement.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "observe/motion.h"
#include "observe/pooled.h"
#include "observe/rdf_observable.h"

#include <math.h>
#include <string.h>

// What is measured --------------------------------------------------------------------------------

/// Steps in an interval, which defaults/fit_file has found to be whole if a target says it.
static int64_t steps_of(double interval, double time_step) {
    const int64_t steps = llround(interval / time_step);
    return steps > 0 ? steps : 1;
}

/// Intervals in the window of motion: as many of whole steps as are as long. Those of a curve,
/// which says both, are whole anyway.
static int64_t lags_of(const struct targets *targets, double time_step) {
    const double interval = time_step * (double)steps_of(targets->motion_interval, time_step);
    const int64_t lags =
        llround((double)targets->motion_lags * targets->motion_interval / interval);
    return lags > 2 ? lags : 2;
}

/// What the targets fix of the settings: bins of theirs, and times.
static void set_settings(const struct measurement_setup *setup, double time_step, size_t place,
                         void *settings) {
    const struct targets *targets = setup->targets;
    const struct observable *observable = mf_observables[place];
    if (observable == &mf_rdf_observable)
        *(struct rdf_settings *)settings = (struct rdf_settings){
            .estimator = setup->force_estimator ? RDF_FORCE_USED : RDF_FORCE_NOT_USED,
            .of_target = true,
            .target = targets->bins};
    else if (observable == &mf_etd_observable)
        *(struct etd_settings *)settings = (struct etd_settings){
            .grid = targets->etd,
            .plan = {.every = steps_of(targets->etd_interval, time_step),
                     .origin_every = steps_of(targets->etd_origins, targets->etd_interval)}};
    else if (observable == &mf_motion_observable)
        *(struct motion_plan *)settings =
            (struct motion_plan){.every = steps_of(targets->motion_interval, time_step),
                                 .lags = lags_of(targets, time_step),
                                 .origin_every = 5};
    else if (targets->settings[place])
        memcpy(settings, targets->settings[place], observable->settings_size);
}

static bool is_asked(const struct measurement_setup *setup, const struct observable *observable) {
    bool asked = setup->thermodynamics && observable == &mf_thermodynamics_observable;
    struct observable_kind found;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++)
        asked = asked || (found.observable == observable && targets_ask(setup->targets, kind));
    return asked;
}

enum status mf_measurement_list(const struct measurement_setup *setup, double time_step,
                                struct observable_use *uses) {
    for (size_t place = 0; mf_observables[place]; place++) {
        if (!is_asked(setup, mf_observables[place]))
            continue;
        *uses = (struct observable_use){.observable = mf_observables[place]};
        if (uses->observable->settings_size > 0) {
            uses->settings = mf_memory_zeroed(1, uses->observable->settings_size);
            if (uses->settings == NULL)
                return STATUS_NO_MEMORY;
            set_settings(setup, time_step, place, uses->settings);
        }
        uses++;
    }
    return STATUS_OK;
}

void mf_measurement_list_clear(struct observable_use *uses) {
    for (; uses->observable; uses++) {
        mf_observable_end(uses);
        mf_memory_free(uses->settings);
        *uses = (struct observable_use){0};
    }
}

int64_t mf_measurement_window(const struct targets *targets, double time_step,
                              enum target_kind *longest) {
    int64_t window = 0;
    *longest = TARGETS;
    if (targets_ask(targets, TARGET_ETD)) {
        window = (targets->etd.times - 1) * steps_of(targets->etd_interval, time_step);
        *longest = TARGET_ETD;
    }
    for (int kind = TARGET_VACF; kind <= TARGET_DIFFUSION; kind++) {
        const int64_t steps =
            lags_of(targets, time_step) * steps_of(targets->motion_interval, time_step);
        if (!targets_ask(targets, kind) || steps <= window)
            continue;
        window = steps;
        *longest = kind;
    }
    return window;
}

// Measuring it ------------------------------------------------------------------------------------

static enum status begin(struct measurement *measurement, const struct measurement_setup *setup) {
    const struct configuration first = mf_configuration_of(&measurement->simulation);
    TRY(mf_measurement_list(setup, first.time_step, measurement->use));
    for (struct observable_use *use = measurement->use; use->observable; use++)
        TRY(mf_observable_begin(use, &first, &setup->plan));
    return STATUS_OK;
}

enum status mf_measurement_init(struct measurement *measurement,
                                const struct inverse_problem *problem,
                                const struct measurement_setup *setup) {
    *measurement = (struct measurement){.targets = setup->targets};
    struct simulation_setup scene = problem->scene;
    struct simulation_start start = {0};
    scene.potential = setup->potential;
    scene.omega = setup->omega;
    scene.seed = setup->seed;
    scene.threads = setup->threads;
    if (setup->time_step > 0)
        scene.time_step = setup->time_step;
    for (int d = 0; setup->position && d < scene.box.dimensions; d++)
        start.position[d] = setup->position[d];
    if (setup->position)
        scene.placement.kind = PLACEMENT_FILE;
    TRY(mf_simulation_init(&measurement->simulation, &scene, setup->position ? &start : NULL));
    return begin(measurement, setup);
}

void mf_measurement_clear(struct measurement *measurement) {
    mf_simulation_clear(&measurement->simulation);
    mf_measurement_list_clear(measurement->use);
}

size_t mf_measurement_spans(struct measurement *measurement, struct memory_span *spans) {
    struct simulation *simulation = &measurement->simulation;
    if (simulation_wants_capacity(simulation) && mf_simulation_reserve(simulation) != STATUS_OK)
        return 0;
    size_t n = mf_simulation_spans(simulation, spans);
    for (const struct observable_use *use = measurement->use; use->observable; use++) {
        if (use->observable->reserve && use->observable->reserve(use->state) != STATUS_OK)
            return 0;
        n += use->observable->spans(use->state, spans + n);
    }
    return n;
}

const void *mf_measurement_state(const struct measurement *measurement,
                                 const struct observable *observable) {
    for (const struct observable_use *use = measurement->use; use->observable; use++)
        if (use->observable == observable)
            return use->state;
    return NULL;
}

// Results -----------------------------------------------------------------------------------------

enum status mf_measurement_values_init(struct observed *observed, const struct targets *targets) {
    *observed = (struct observed){0};
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!targets_ask(targets, kind))
            continue;
        TRY_ARRAY(observed->value[kind], targets->target[kind].count);
        TRY_ARRAY(observed->error[kind], targets->target[kind].count);
    }
    return STATUS_OK;
}

void mf_measurement_values_clear(struct observed *observed) {
    for (int kind = 0; kind < TARGETS; kind++) {
        mf_memory_free(observed->value[kind]);
        mf_memory_free(observed->error[kind]);
    }
    *observed = (struct observed){0};
}

size_t mf_measurement_values_spans(const struct observed *observed, const struct targets *targets,
                                   struct memory_span *spans) {
    size_t n = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        const size_t bytes = targets->target[kind].count * sizeof(double);
        if (!targets_ask(targets, kind))
            continue;
        spans[n++] = (struct memory_span){observed->value[kind], bytes};
        spans[n++] = (struct memory_span){observed->error[kind], bytes};
    }
    return n;
}

static void clear_values(struct observed *observed, const struct targets *targets) {
    for (int kind = 0; kind < TARGETS; kind++)
        for (size_t k = 0; k < targets->target[kind].count; k++)
            observed->value[kind][k] = observed->error[kind][k] = 0;
}

/// All targets of the observable number `use` of the replicas.
static enum status find_result(const struct measurement *replicas, size_t count, size_t use,
                               struct observed *observed) {
    const struct observable *observable = replicas->use[use].observable;
    struct observable_values values[TARGETS] = {0};
    struct observable_kind found;
    OWNED const void **states = NULL;
    bool asked = false;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++)
        if (found.observable == observable) {
            const struct target *target = &replicas->targets->target[kind];
            values[found.number] =
                (struct observable_values){target->count, target->x, observed->value[kind],
                                           observed->error[kind], &observed->freedom[kind]};
            observed->freedom[kind] = 0;
            asked = asked || target->count > 0;
        }
    if (!asked)
        return STATUS_OK;
    TRY_ARRAY(states, count);
    for (size_t k = 0; k < count; k++)
        states[k] = replicas[k].use[use].state;
    return mf_pooled_result(observable, states, count, values);
}

enum status mf_measurement_result(const struct measurement *replicas, size_t count,
                                  struct observed *observed) {
    clear_values(observed, replicas->targets);
    for (size_t use = 0; replicas->use[use].observable; use++)
        TRY(find_result(replicas, count, use, observed));
    return STATUS_OK;
}

void mf_measurement_mean(const struct observed *observed, size_t count,
                         const struct targets *targets, struct observed *mean) {
    for (int kind = 0; kind < TARGETS; kind++)
        for (size_t k = 0; k < targets->target[kind].count; k++) {
            struct running_mean all = {0};
            double squares = 0;
            bool known = true;
            for (size_t n = 0; n < count; n++) {
                const double value = observed[n].value[kind][k], error = observed[n].error[kind][k];
                if (!isfinite(value))
                    continue;
                mf_statistics_add(&all, value);
                squares += error * error;
                known = known && error > 0;
            }
            mean->value[kind][k] = all.count > 0 ? all.mean : NAN;
            mean->error[kind][k] =
                known ? sqrt(squares) / all.count : mf_statistics_standard_error(&all);
        }
}

void mf_measurement_distance(const struct observed *observed, const struct targets *targets,
                             struct target_distance distance[TARGETS]) {
    for (int kind = 0; kind < TARGETS; kind++)
        distance[kind] = targets_ask(targets, kind)
                             ? mf_targets_distance(&targets->target[kind], observed->value[kind],
                                                   observed->error[kind])
                             : (struct target_distance){0};
}
