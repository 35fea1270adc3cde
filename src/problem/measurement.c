// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/measurement.h"

#include "base/memory.h"

#include <math.h>

bool mf_measurement_moves(const struct targets *targets) {
    return targets_ask(targets, TARGET_VACF) || targets_ask(targets, TARGET_MSD) ||
           targets_ask(targets, TARGET_DIFFUSION);
}

/// Steps in an interval, which input/fit_file has found to be whole if a target says it.
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

void mf_measurement_plans(const struct targets *targets, double time_step, struct etd_plan *etd,
                          struct motion_plan *motion) {
    *etd = (struct etd_plan){.every = steps_of(targets->etd_interval, time_step)};
    if (targets_ask(targets, TARGET_ETD))
        etd->origin_every = steps_of(targets->etd_origins, targets->etd_interval);
    *motion = (struct motion_plan){.every = steps_of(targets->motion_interval, time_step),
                                   .lags = lags_of(targets, time_step),
                                   .origin_every = 5,
                                   .fit_from = 0.5};
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

static enum status begin_rdf(struct measurement *measurement, const struct simulation_setup *scene,
                             const struct measurement_setup *setup) {
    const struct targets *targets = measurement->targets;
    const size_t count = (size_t)scene->placement.count, samples = (size_t)setup->plan.samples;
    const double cutoff = scene->potential ? scene->potential->cutoff : 0;
    if (!targets_ask(targets, TARGET_RDF))
        return STATUS_OK;
    if (setup->force_estimator && scene->potential && scene->interactions == 0 &&
        !composition_is_mixed(&scene->composition) &&
        mf_rdf_force_applies(scene->potential, scene->temperature)) {
        measurement->observables.rdf_force = &measurement->rdf_force;
        return mf_rdf_force_init(&measurement->rdf_force, &targets->bins, &scene->box, count,
                                 scene->potential, scene->temperature, cutoff, samples);
    }
    measurement->observables.rdf = &measurement->rdf;
    return mf_rdf_init_mixture(&measurement->rdf, &targets->bins, &scene->box, &scene->composition,
                               cutoff, samples);
}

static enum status begin_dynamics(struct measurement *measurement,
                                  const struct measurement_setup *setup) {
    const struct targets *targets = measurement->targets;
    const struct simulation *simulation = &measurement->simulation;
    const double time_step = simulation->setup.time_step;
    const int64_t begin = setup->plan.equilibration;
    const int64_t steps = setup->plan.samples * setup->plan.every;
    struct etd_plan etd;
    struct motion_plan motion;
    mf_measurement_plans(targets, time_step, &etd, &motion);
    if (targets_ask(targets, TARGET_ETD)) {
        TRY(mf_etd_init(&measurement->etd, &targets->etd, &etd, simulation, begin, steps));
        measurement->observables.etd = &measurement->etd;
    }
    if (mf_measurement_moves(targets)) {
        TRY(mf_motion_init(&measurement->motion, &motion, simulation, begin, steps));
        measurement->observables.motion = &measurement->motion;
    }
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
    TRY(begin_rdf(measurement, &scene, setup));
    if (setup->thermodynamics || targets_ask(setup->targets, TARGET_PRESSURE)) {
        TRY(mf_thermodynamics_init(&measurement->thermodynamics, (size_t)setup->plan.samples));
        measurement->observables.thermodynamics = &measurement->thermodynamics;
    }
    TRY(mf_simulation_init(&measurement->simulation, &scene, setup->position ? &start : NULL));
    return begin_dynamics(measurement, setup);
}

void mf_measurement_clear(struct measurement *measurement) {
    mf_simulation_clear(&measurement->simulation);
    mf_rdf_clear(&measurement->rdf);
    mf_rdf_force_clear(&measurement->rdf_force);
    mf_etd_clear(&measurement->etd);
    mf_motion_clear(&measurement->motion);
    mf_thermodynamics_clear(&measurement->thermodynamics);
}

enum status mf_measurement_values_init(struct observed *observed, const struct targets *targets) {
    enum status status = STATUS_OK;
    *observed = (struct observed){0};
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!targets_ask(targets, kind))
            continue;
        NEW_ARRAY(observed->value[kind], targets->target[kind].count);
        NEW_ARRAY(observed->error[kind], targets->target[kind].count);
    }
done:
    return status;
}

void mf_measurement_values_clear(struct observed *observed) {
    for (int kind = 0; kind < TARGETS; kind++) {
        mf_memory_free(observed->value[kind]);
        mf_memory_free(observed->error[kind]);
    }
    *observed = (struct observed){0};
}

static enum status result_rdf(const struct measurement *replicas, size_t count,
                              struct observed *observed) {
    enum status status = STATUS_OK;
    struct rdf *rdf = NULL;
    struct rdf_force *force = NULL;
    NEW_ARRAY(rdf, count);
    NEW_ARRAY(force, count);
    for (size_t k = 0; k < count; k++) {
        rdf[k] = replicas[k].rdf;
        force[k] = replicas[k].rdf_force;
    }
    if (replicas->observables.rdf_force)
        CHECK(mf_rdf_force_result(force, count, RDF_FORCE_COUNTED, observed->value[TARGET_RDF],
                                  observed->error[TARGET_RDF]));
    else
        CHECK(mf_rdf_result(rdf, count, observed->value[TARGET_RDF], observed->error[TARGET_RDF]));
done:
    mf_memory_free(rdf);
    mf_memory_free(force);
    return status;
}

static enum status result_etd(const struct measurement *replicas, size_t count,
                              struct observed *observed) {
    enum status status = STATUS_OK;
    const struct etd **etd = NULL;
    NEW_ARRAY(etd, count);
    for (size_t k = 0; k < count; k++)
        etd[k] = &replicas[k].etd;
    CHECK(
        mf_etd_result(etd, count, observed->value[TARGET_ETD], observed->error[TARGET_ETD], NULL));
    // At time 0 all are there: no measurement.
    for (size_t k = 0; k < (size_t)replicas->targets->etd.bins; k++)
        observed->value[TARGET_ETD][k] = NAN;
done:
    mf_memory_free(etd);
    return status;
}

/// Add a replica's values to the means over `count` of them, and its errors squared.
static void add_mean(struct observed *observed, enum target_kind kind, size_t values,
                     const double *value, const double *error, double count) {
    if (observed->value[kind] == NULL)
        return;
    for (size_t k = 0; k < values; k++) {
        observed->value[kind][k] += value[k] / count;
        observed->error[kind][k] = hypot(observed->error[kind][k], error[k] / count);
    }
}

static void clear_values(struct observed *observed, const struct targets *targets) {
    for (int kind = 0; kind < TARGETS; kind++)
        for (size_t k = 0; k < targets->target[kind].count; k++)
            observed->value[kind][k] = observed->error[kind][k] = 0;
}

/// A replica's results of one kind of target, and how many blocks of time its errors rest on.
struct replica_curve {
    const double *value, *error;
    double blocks;
};

/// Make the errors inside the replicas, squared and added up by add_mean, the standard errors of
/// the mean over `count` of them: the variance by blocks of time, of which each replica has B, with
/// count (B − 1) degrees of freedom, and that by the scatter of the replicas, with count − 1,
/// count as much as they know. A replica of one window alone has B = 1, and no error of its own.
static void join_scatter(struct observed *observed, enum target_kind kind, size_t values,
                         const struct replica_curve *replicas, size_t count) {
    if (observed->value[kind] == NULL || count < 2)
        return;
    const double inside = (double)count * fmax(0, replicas->blocks - 1),
                 between = (double)count - 1;
    for (size_t k = 0; k < values; k++) {
        double *error = &observed->error[kind][k], squares = 0;
        for (size_t n = 0; n < count; n++)
            squares += pow(replicas[n].value[k] - observed->value[kind][k], 2);
        const double scatter = squares / ((double)count * between);
        *error = sqrt((inside * *error * *error + between * scatter) / (inside + between));
    }
}

/// Mean and errors of one kind of target over the replicas.
static void combine(struct observed *observed, enum target_kind kind, size_t values,
                    const struct replica_curve *replicas, size_t count) {
    for (size_t k = 0; k < count; k++)
        add_mean(observed, kind, values, replicas[k].value, replicas[k].error, (double)count);
    join_scatter(observed, kind, values, replicas, count);
}

static enum status result_motion(const struct measurement *replicas, size_t count,
                                 struct observed *observed) {
    enum status status = STATUS_OK;
    const size_t values = (size_t)replicas->motion.plan.lags + 1;
    double *memory = NULL;
    struct motion_summary *summary = NULL;
    struct replica_curve *vacf = NULL, *msd = NULL, *diffusion = NULL;
    NEW_ARRAY(memory, 4 * values * count);
    NEW_ARRAY(summary, count);
    NEW_ARRAY(vacf, count);
    NEW_ARRAY(msd, count);
    NEW_ARRAY(diffusion, count);
    for (size_t k = 0; k < count; k++) {
        double *own = memory + 4 * values * k;
        const struct motion_curves curves = {own, own + values, own + 2 * values, own + 3 * values};
        summary[k] = mf_motion_result(&replicas[k].motion, &curves);
        const double blocks = summary[k].blocks;
        vacf[k] = (struct replica_curve){curves.vacf, curves.vacf_error, blocks};
        msd[k] = (struct replica_curve){curves.msd, curves.msd_error, blocks};
        diffusion[k] = (struct replica_curve){&summary[k].msd, &summary[k].msd_error, blocks};
    }
    combine(observed, TARGET_VACF, values, vacf, count);
    combine(observed, TARGET_MSD, values, msd, count);
    combine(observed, TARGET_DIFFUSION, 1, diffusion, count);
done:
    mf_memory_free(summary);
    mf_memory_free(vacf);
    mf_memory_free(msd);
    mf_memory_free(diffusion);
    mf_memory_free(memory);
    return status;
}

enum status mf_measurement_result(const struct measurement *replicas, size_t count,
                                  struct observed *observed) {
    const struct targets *targets = replicas->targets;
    clear_values(observed, targets);
    if (targets_ask(targets, TARGET_RDF))
        TRY(result_rdf(replicas, count, observed));
    if (targets_ask(targets, TARGET_ETD))
        TRY(result_etd(replicas, count, observed));
    if (mf_measurement_moves(targets))
        TRY(result_motion(replicas, count, observed));
    for (size_t k = 0; k < count && targets_ask(targets, TARGET_PRESSURE); k++) {
        const struct thermodynamics_summary t =
            mf_thermodynamics_result(&replicas[k].thermodynamics, 1);
        add_mean(observed, TARGET_PRESSURE, 1, &t.pressure, &t.pressure_error, (double)count);
    }
    return STATUS_OK;
}

void mf_measurement_distance(const struct observed *observed, const struct targets *targets,
                             struct target_distance distance[TARGETS]) {
    for (int kind = 0; kind < TARGETS; kind++)
        distance[kind] = targets_ask(targets, kind)
                             ? mf_targets_distance(&targets->target[kind], observed->value[kind],
                                                   observed->error[kind])
                             : (struct target_distance){0};
}
