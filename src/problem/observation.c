// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/observation.h"

#include "base/memory.h"

#include <math.h>

bool mf_observation_moves(const struct goals *goals) {
    return goals_ask(goals, GOAL_VACF) || goals_ask(goals, GOAL_MSD) ||
           goals_ask(goals, GOAL_DIFFUSION);
}

/// Steps in an interval, which input/fit_file has found to be whole if a target says it.
static int64_t steps_of(double interval, double time_step) {
    const int64_t steps = llround(interval / time_step);
    return steps > 0 ? steps : 1;
}

/// Intervals in the window of motion: as many of whole steps as are as long. Those of a curve,
/// which says both, are whole anyway.
static int64_t lags_of(const struct goals *goals, double time_step) {
    const double interval = time_step * (double)steps_of(goals->motion_interval, time_step);
    const int64_t lags = llround((double)goals->motion_lags * goals->motion_interval / interval);
    return lags > 2 ? lags : 2;
}

void mf_observation_plans(const struct goals *goals, double time_step, struct etd_plan *etd,
                          struct motion_plan *motion) {
    *etd = (struct etd_plan){.every = steps_of(goals->etd_interval, time_step)};
    if (goals_ask(goals, GOAL_ETD))
        etd->origin_every = steps_of(goals->etd_origins, goals->etd_interval);
    *motion = (struct motion_plan){.every = steps_of(goals->motion_interval, time_step),
                                   .lags = lags_of(goals, time_step),
                                   .origin_every = 5,
                                   .fit_from = 0.5};
}

int64_t mf_observation_window(const struct goals *goals, double time_step,
                              enum goal_kind *longest) {
    int64_t window = 0;
    *longest = GOALS;
    if (goals_ask(goals, GOAL_ETD)) {
        window = (goals->etd.times - 1) * steps_of(goals->etd_interval, time_step);
        *longest = GOAL_ETD;
    }
    for (int kind = GOAL_VACF; kind <= GOAL_DIFFUSION; kind++) {
        const int64_t steps =
            lags_of(goals, time_step) * steps_of(goals->motion_interval, time_step);
        if (!goals_ask(goals, kind) || steps <= window)
            continue;
        window = steps;
        *longest = kind;
    }
    return window;
}

static enum status begin_rdf(struct observation *observation, const struct simulation_setup *scene,
                             const struct observation_setup *setup) {
    const struct goals *goals = observation->goals;
    const size_t count = (size_t)scene->placement.count, samples = (size_t)setup->plan.samples;
    const double cutoff = scene->potential ? scene->potential->cutoff : 0;
    if (!goals_ask(goals, GOAL_RDF))
        return STATUS_OK;
    if (setup->force_estimator && scene->potential && !composition_is_mixed(&scene->composition) &&
        mf_rdf_force_applies(scene->potential, scene->temperature)) {
        observation->targets.rdf_force = &observation->rdf_force;
        return mf_rdf_force_init(&observation->rdf_force, &goals->bins, &scene->box, count,
                                 scene->potential, scene->temperature, cutoff, samples);
    }
    observation->targets.rdf = &observation->rdf;
    return mf_rdf_init_mixture(&observation->rdf, &goals->bins, &scene->box, &scene->composition,
                               cutoff, samples);
}

static enum status begin_dynamics(struct observation *observation,
                                  const struct observation_setup *setup) {
    const struct goals *goals = observation->goals;
    const struct simulation *simulation = &observation->simulation;
    const double time_step = simulation->setup.time_step;
    const int64_t begin = setup->plan.equilibration;
    const int64_t steps = setup->plan.samples * setup->plan.every;
    struct etd_plan etd;
    struct motion_plan motion;
    mf_observation_plans(goals, time_step, &etd, &motion);
    if (goals_ask(goals, GOAL_ETD)) {
        TRY(mf_etd_init(&observation->etd, &goals->etd, &etd, simulation, begin, steps));
        observation->targets.etd = &observation->etd;
    }
    if (mf_observation_moves(goals)) {
        TRY(mf_motion_init(&observation->motion, &motion, simulation, begin, steps));
        observation->targets.motion = &observation->motion;
    }
    return STATUS_OK;
}

enum status mf_observation_init(struct observation *observation,
                                const struct inverse_problem *problem,
                                const struct observation_setup *setup) {
    *observation = (struct observation){.goals = setup->goals};
    struct simulation_setup scene = problem->scene;
    struct simulation_start start = {0};
    scene.potential = setup->potential;
    scene.weight = setup->weight;
    scene.seed = setup->seed;
    scene.threads = setup->threads;
    if (setup->time_step > 0)
        scene.time_step = setup->time_step;
    for (int d = 0; setup->position && d < scene.box.dimensions; d++)
        start.position[d] = setup->position[d];
    if (setup->position)
        scene.placement.kind = PLACEMENT_FILE;
    TRY(begin_rdf(observation, &scene, setup));
    if (setup->thermodynamics || goals_ask(setup->goals, GOAL_PRESSURE)) {
        TRY(mf_thermodynamics_init(&observation->thermodynamics, (size_t)setup->plan.samples));
        observation->targets.thermodynamics = &observation->thermodynamics;
    }
    TRY(mf_simulation_init(&observation->simulation, &scene, setup->position ? &start : NULL));
    return begin_dynamics(observation, setup);
}

void mf_observation_clear(struct observation *observation) {
    mf_simulation_clear(&observation->simulation);
    mf_rdf_clear(&observation->rdf);
    mf_rdf_force_clear(&observation->rdf_force);
    mf_etd_clear(&observation->etd);
    mf_motion_clear(&observation->motion);
    mf_thermodynamics_clear(&observation->thermodynamics);
}

enum status mf_observation_values_init(struct observed *observed, const struct goals *goals) {
    enum status status = STATUS_OK;
    *observed = (struct observed){0};
    for (int kind = 0; kind < GOALS; kind++) {
        if (!goals_ask(goals, kind))
            continue;
        NEW_ARRAY(observed->value[kind], goals->goal[kind].count);
        NEW_ARRAY(observed->error[kind], goals->goal[kind].count);
    }
done:
    return status;
}

void mf_observation_values_clear(struct observed *observed) {
    for (int kind = 0; kind < GOALS; kind++) {
        mf_memory_free(observed->value[kind]);
        mf_memory_free(observed->error[kind]);
    }
    *observed = (struct observed){0};
}

static enum status result_rdf(const struct observation *replicas, size_t count,
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
    if (replicas->targets.rdf_force)
        CHECK(mf_rdf_force_result(force, count, RDF_FORCE_COUNTED, observed->value[GOAL_RDF],
                                  observed->error[GOAL_RDF]));
    else
        CHECK(mf_rdf_result(rdf, count, observed->value[GOAL_RDF], observed->error[GOAL_RDF]));
done:
    mf_memory_free(rdf);
    mf_memory_free(force);
    return status;
}

static enum status result_etd(const struct observation *replicas, size_t count,
                              struct observed *observed) {
    enum status status = STATUS_OK;
    const struct etd **etd = NULL;
    NEW_ARRAY(etd, count);
    for (size_t k = 0; k < count; k++)
        etd[k] = &replicas[k].etd;
    CHECK(mf_etd_result(etd, count, observed->value[GOAL_ETD], observed->error[GOAL_ETD], NULL));
    // At time 0 all are there: no measurement.
    for (size_t k = 0; k < (size_t)replicas->goals->etd.bins; k++)
        observed->value[GOAL_ETD][k] = NAN;
done:
    mf_memory_free(etd);
    return status;
}

/// Add a replica's values to the means over `count` of them, and its errors squared.
static void add_mean(struct observed *observed, enum goal_kind kind, size_t values,
                     const double *value, const double *error, double count) {
    if (observed->value[kind] == NULL)
        return;
    for (size_t k = 0; k < values; k++) {
        observed->value[kind][k] += value[k] / count;
        observed->error[kind][k] = hypot(observed->error[kind][k], error[k] / count);
    }
}

static void clear_values(struct observed *observed, const struct goals *goals) {
    for (int kind = 0; kind < GOALS; kind++)
        for (size_t k = 0; k < goals->goal[kind].count; k++)
            observed->value[kind][k] = observed->error[kind][k] = 0;
}

/// A replica's results of one kind of goal, and how many blocks of time its errors rest on.
struct replica_curve {
    const double *value, *error;
    double blocks;
};

/// Make the errors inside the replicas, squared and added up by add_mean, the standard errors of
/// the mean over `count` of them: the variance by blocks of time, of which each replica has B, with
/// count (B − 1) degrees of freedom, and that by the scatter of the replicas, with count − 1,
/// count as much as they know. A replica of one window alone has B = 1, and no error of its own.
static void join_scatter(struct observed *observed, enum goal_kind kind, size_t values,
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

/// Mean and errors of one kind of goal over the replicas.
static void combine(struct observed *observed, enum goal_kind kind, size_t values,
                    const struct replica_curve *replicas, size_t count) {
    for (size_t k = 0; k < count; k++)
        add_mean(observed, kind, values, replicas[k].value, replicas[k].error, (double)count);
    join_scatter(observed, kind, values, replicas, count);
}

static enum status result_motion(const struct observation *replicas, size_t count,
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
    combine(observed, GOAL_VACF, values, vacf, count);
    combine(observed, GOAL_MSD, values, msd, count);
    combine(observed, GOAL_DIFFUSION, 1, diffusion, count);
done:
    mf_memory_free(summary);
    mf_memory_free(vacf);
    mf_memory_free(msd);
    mf_memory_free(diffusion);
    mf_memory_free(memory);
    return status;
}

enum status mf_observation_result(const struct observation *replicas, size_t count,
                                  struct observed *observed) {
    const struct goals *goals = replicas->goals;
    clear_values(observed, goals);
    if (goals_ask(goals, GOAL_RDF))
        TRY(result_rdf(replicas, count, observed));
    if (goals_ask(goals, GOAL_ETD))
        TRY(result_etd(replicas, count, observed));
    if (mf_observation_moves(goals))
        TRY(result_motion(replicas, count, observed));
    for (size_t k = 0; k < count && goals_ask(goals, GOAL_PRESSURE); k++) {
        const struct thermodynamics_summary t =
            mf_thermodynamics_result(&replicas[k].thermodynamics, 1);
        add_mean(observed, GOAL_PRESSURE, 1, &t.pressure, &t.pressure_error, (double)count);
    }
    return STATUS_OK;
}

void mf_observation_distance(const struct observed *observed, const struct goals *goals,
                             struct goal_distance distance[GOALS]) {
    for (int kind = 0; kind < GOALS; kind++)
        distance[kind] = goals_ask(goals, kind)
                             ? mf_goals_distance(&goals->goal[kind], observed->value[kind],
                                                 observed->error[kind])
                             : (struct goal_distance){0};
}
