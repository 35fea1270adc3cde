// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/evaluate.h"

#include "base/clock.h"
#include "base/rng.h"
#include "base/spent.h"
#include "observe/equilibration.h"
#include "observe/observable.h"
#include "observe/rdf_force.h"
#include "observe/thermodynamics.h"

#include <math.h>

/// A liquid has about the pairs in range of a uniform one; a drop has many times as many.
static const double collapse_factor = 2;

/// Errors by which a temperature after equilibration may be off besides the tolerance.
static const double deviations = 4;

/// Parts of the samples after each of which a simulation may be stopped, and samples and windows of
/// the longest target that it must have by then, so that their errors mean something: one window of
/// a VACF has none.
enum { PARTS = 16, MIN_SAMPLES = 4, MIN_WINDOWS = 4 };

static bool has_collapsed(const struct simulation *simulation) {
    const struct neighbours *neighbours = &simulation->neighbours;
    const double count = (double)simulation->particles.count;
    const double uniform = 0.5 * count * mf_particles_density(&simulation->particles) *
                           mf_box_shell_volume(&simulation->particles.box, 0, neighbours->range);
    return (double)mf_neighbours_listed(neighbours) > collapse_factor * uniform;
}

static enum status equilibrate(struct simulation *simulation, const struct measure_plan *plan,
                               double tolerance, struct evaluate_result *result) {
    struct measure_temperature found;
    TRY(mf_measure_settle(simulation, plan, &found, NULL));
    const double wanted = simulation->setup.temperature;
    if (!mf_simulation_is_thermal(&simulation->setup))
        return STATUS_OK;
    result->temperature = found.mean / wanted;
    // What is not known is not held against it.
    result->failure = EVALUATE_TEMPERATURE;
    if (fabs(found.mean / wanted - 1) > tolerance + deviations * found.error / wanted)
        return mf_status_fail(STATUS_UNSTABLE,
                              "the temperature is %.3g" STATUS_TEMPERATURE
                              " after equilibration, not %.3g" STATUS_TEMPERATURE,
                              found.mean, wanted);
    // Only what is uniform by itself must stay so.
    result->failure = EVALUATE_COLLAPSED;
    if (simulation->setup.interactions == 0 && has_collapsed(simulation))
        return mf_status_fail(STATUS_UNSTABLE, "the particles have collapsed into a drop");
    return STATUS_OK;
}

static enum status score(const struct measurement *measurement, struct observed *observed,
                         struct evaluate_result *result) {
    const struct targets *targets = measurement->targets;
    TRY(mf_measurement_result(measurement, 1, observed));
    mf_measurement_distance(observed, targets, result->distance);
    result->error = mf_targets_error(targets, result->distance);
    result->noise = mf_targets_noise(targets, result->distance);
    result->variance = mf_targets_variance(targets, result->distance);
    return STATUS_OK;
}

/// Whether a running result says enough: that the candidate cannot win (racing: O. Maron and A. W.
/// Moore, Artif. Intell. Rev. 11, 193 (1997)), or its error as well as is wanted.
static bool is_decided(const struct evaluate_result *result, double discard_above,
                       const struct evaluate_parameters *parameters) {
    const double chance = sqrt(result->variance);
    if (!isfinite(result->error) || !(result->noise > 0))
        return false;
    return (parameters->racing > 0 &&
            result->error - parameters->racing * chance > discard_above) ||
           chance < parameters->precision * result->error;
}

/// Take the samples part by part, until they are all there or say enough.
static enum status sample(struct measurement *measurement, double discard_above,
                          const struct evaluate_parameters *parameters, struct observed *observed,
                          struct evaluate_result *result) {
    const struct measure_plan *plan = &parameters->plan;
    enum target_kind longest;
    const int64_t min_steps =
        MIN_WINDOWS * mf_measurement_window(measurement->targets,
                                            measurement->simulation.setup.time_step, &longest);
    const bool may_stop = parameters->racing > 0 || parameters->precision > 0;
    for (int part = may_stop ? 1 : PARTS; part < PARTS; part++) {
        struct measure_plan so_far = *plan;
        so_far.samples = plan->samples * part / PARTS;
        if (so_far.samples < MIN_SAMPLES || so_far.samples * plan->every < min_steps)
            continue;
        TRY(mf_measure_sample(&measurement->simulation, &so_far, measurement->use, NULL));
        TRY(score(measurement, observed, result));
        result->stopped = is_decided(result, discard_above, parameters);
        if (result->stopped)
            return STATUS_OK;
    }
    TRY(mf_measure_sample(&measurement->simulation, plan, measurement->use, NULL));
    return score(measurement, observed, result);
}

/// Positions by particle number, wrapped into the box.
static void copy_positions(const struct particles *particles, double *const *position) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d];
        for (size_t k = 0; k < particles->count; k++) {
            const double x = particles->position[d][k];
            const double wrapped = x - length * floor(x / length);
            position[d][particles->id[k]] = wrapped < length ? wrapped : 0;
        }
    }
}

/// Add the processor time of this thread since then; returns its present one.
static double account(enum spent_on kind, double begun) {
    const double now = clock_thread_seconds();
    mf_spent_add(kind, now - begun);
    return now;
}

enum status mf_evaluate(const struct inverse_problem *problem,
                        const struct evaluate_candidate *candidate,
                        const struct evaluate_parameters *parameters, double *features,
                        struct observed *observed, double *const *position,
                        struct evaluate_result *result) {
    enum status status = STATUS_OK;
    struct measurement measurement = {0};
    struct observed own = {0};
    struct measure_plan plan = parameters->plan;
    double begun;
    *result = (struct evaluate_result){0};
    const struct measurement_setup setup = {.targets = &problem->targets,
                                            .potential = candidate->potential,
                                            .omega = candidate->omega,
                                            .position = candidate->position,
                                            .plan = plan,
                                            .force_estimator =
                                                parameters->estimator == RDF_FORCE_USED,
                                            .threads = candidate->threads,
                                            .seed = candidate->seed};
    if (observed == NULL) {
        CHECK(mf_measurement_values_init(&own, &problem->targets));
        observed = &own;
    }
    CHECK(mf_measurement_init(&measurement, problem, &setup));
    begun = clock_thread_seconds();
    status = equilibrate(&measurement.simulation, &plan, parameters->temperature_tolerance, result);
    begun = account(SPENT_EQUILIBRATION, begun);
    CHECK(status);
    result->failure = EVALUATE_BLEW_UP;
    status = sample(&measurement, candidate->discard_above, parameters, observed, result);
    account(status == STATUS_OK ? SPENT_SAMPLES : SPENT_LOST, begun);
    CHECK(status);
    result->failure = EVALUATE_UNMEASURED;
    if (features)
        mf_targets_take_features(&problem->targets, observed->value, features, NULL);
    if (position)
        copy_positions(&measurement.simulation.particles, position);
done:
    result->engine_steps = measurement.simulation.step;
    mf_measurement_clear(&measurement);
    mf_measurement_values_clear(&own);
    return status;
}

// One configuration for all candidates ------------------------------------------------------------

/// Samples of a window, equilibrations of a candidate in the first one, and windows, of which each
/// is twice as long as the last, and the first of all is the lattice's.
enum { SETTLE_SAMPLES = 64, SETTLE_EQUILIBRATIONS = EVALUATE_SETTLE / 3, SETTLE_WINDOWS = 6 };

/// Whether energy or temperature go on changing.
static bool still_drifts(const struct measurement *measurement) {
    static const enum thermodynamics_quantity looked_at[] = {THERMODYNAMICS_POTENTIAL_ENERGY,
                                                             THERMODYNAMICS_TEMPERATURE};
    const struct thermodynamics *found =
        mf_measurement_state(measurement, &mf_thermodynamics_observable);
    bool drifts = false;
    for (int k = 0; k < 2; k++) {
        const struct equilibration_drift drift =
            mf_equilibration_drift(mf_thermodynamics_series(found, looked_at[k]), SETTLE_SAMPLES);
        drifts = drifts || equilibration_drifts(&drift, 2);
    }
    return drifts;
}

/// A window with new velocities, so that what the positions gave them is gone.
static enum status run_window(const struct inverse_problem *problem,
                              const struct measurement_setup *setup, double *const *position,
                              bool *drifts, uint64_t *steps) {
    enum status status = STATUS_OK;
    struct measurement measurement = {0};
    CHECK(mf_measurement_init(&measurement, problem, setup));
    CHECK(mf_measure_sample(&measurement.simulation, &setup->plan, measurement.use, NULL));
    if (measurement.simulation.setup.interactions == 0 && has_collapsed(&measurement.simulation))
        CHECK(mf_status_fail(STATUS_UNSTABLE, "the particles have collapsed into a drop"));
    *drifts = still_drifts(&measurement);
    copy_positions(&measurement.simulation.particles, position);
done:
    *steps += measurement.simulation.step;
    mf_measurement_clear(&measurement);
    return status;
}

enum status mf_evaluate_settle(const struct inverse_problem *problem,
                               const struct evaluate_candidate *candidate, int64_t equilibration,
                               double *const *position, uint64_t *steps) {
    const double begun = clock_thread_seconds();
    struct targets none = problem->targets;
    int64_t every = (SETTLE_EQUILIBRATIONS * equilibration + SETTLE_SAMPLES - 1) / SETTLE_SAMPLES;
    bool drifts = true;
    for (int kind = 0; kind < TARGETS; kind++)
        none.target[kind].count = 0;
    for (int window = 0; (drifts || window < 2) && window < SETTLE_WINDOWS; window++, every *= 2) {
        const struct measurement_setup setup = {
            .targets = &none,
            .potential = candidate->potential,
            .omega = candidate->omega,
            .position = window > 0 ? (const double *const *)position : candidate->position,
            .plan = {.samples = SETTLE_SAMPLES, .every = every},
            .thermodynamics = true,
            .threads = candidate->threads,
            .seed = mf_rng_child_seed(candidate->seed, RNG_EVALUATION, (uint32_t)window, 0)};
        TRY(run_window(problem, &setup, position, &drifts, steps));
    }
    account(SPENT_EQUILIBRATION, begun);
    return STATUS_OK;
}
