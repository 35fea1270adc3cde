// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/evaluate.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>

/// A liquid has about the pairs in range of a uniform one; a drop has many times as many.
static const double collapse_factor = 2;

static bool has_collapsed(const struct simulation *simulation) {
    const struct neighbours *neighbours = &simulation->neighbours;
    const double count = (double)simulation->particles.count;
    const double uniform = 0.5 * count * particles_density(&simulation->particles) *
                           box_shell_volume(&simulation->particles.box, 0, neighbours->range);
    return (double)neighbours_listed(neighbours) > collapse_factor * uniform;
}

static enum status equilibrate(struct simulation *simulation, const struct measure_plan *plan,
                               double tolerance) {
    double temperature;
    TRY(measure_equilibrate(simulation, plan, &temperature, NULL));
    const double wanted = simulation->setup.temperature;
    if (!(fabs(temperature / wanted - 1) <= tolerance))
        return status_fail(STATUS_UNSTABLE, "the temperature is %.3g after equilibration, not %.3g",
                           temperature, wanted);
    if (has_collapsed(simulation))
        return status_fail(STATUS_UNSTABLE, "the particles have collapsed into a drop");
    return STATUS_OK;
}

/// rms over bins of the statistical errors of target and measurement.
static double expected_noise(const double *error, const double *target_error, size_t bins) {
    double sum = 0;
    for (size_t k = 0; k < bins; k++)
        sum += error[k] * error[k] + target_error[k] * target_error[k];
    return sqrt(sum / (double)bins);
}

static enum status score(const struct inverse_problem *problem, const struct rdf *rdf,
                         const struct rdf_force *rdf_force, struct evaluate_result *result) {
    enum status status = STATUS_OK;
    const size_t bins = problem->bins.count;
    double *g = NULL, *error = NULL;
    NEW_ARRAY(g, bins);
    NEW_ARRAY(error, bins);
    if (rdf_force)
        CHECK(rdf_force_result(rdf_force, 1, RDF_FORCE_COUNTED, g, error));
    else
        rdf_result(rdf, 1, g, error);
    result->error = rdf_rmse(g, problem->target, bins);
    result->noise = expected_noise(error, problem->target_error, bins);
done:
    memory_free(g);
    memory_free(error);
    return status;
}

enum status evaluate_potential(const struct inverse_problem *problem, const struct table *potential,
                               const struct evaluate_parameters *parameters, uint64_t seed,
                               struct evaluate_result *result) {
    enum status status = STATUS_OK;
    const struct measure_plan *plan = &parameters->plan;
    struct simulation simulation = {0};
    struct rdf rdf = {0};
    struct rdf_force rdf_force = {0};
    struct simulation_setup setup = problem->scene;
    setup.potential = potential;
    setup.seed = seed;
    *result = (struct evaluate_result){0};
    const bool uses_force =
        parameters->estimator == RDF_FORCE_USED && rdf_force_applies(potential, setup.temperature);
    const struct measure_targets targets = {.rdf = uses_force ? NULL : &rdf,
                                            .rdf_force = uses_force ? &rdf_force : NULL};
    const size_t count = (size_t)setup.placement.count, samples = (size_t)plan->samples;
    if (uses_force)
        CHECK(rdf_force_init(&rdf_force, &problem->bins, &setup.box, count, potential,
                             setup.temperature, potential->cutoff, samples));
    else
        CHECK(rdf_init(&rdf, &problem->bins, &setup.box, count, potential->cutoff, samples));
    CHECK(simulation_init(&simulation, &setup, NULL));
    CHECK(equilibrate(&simulation, plan, parameters->temperature_tolerance));
    CHECK(measure_sample(&simulation, plan, targets, NULL));
    CHECK(score(problem, targets.rdf, targets.rdf_force, result));
done:
    result->engine_steps = simulation.step;
    simulation_clear(&simulation);
    rdf_clear(&rdf);
    rdf_force_clear(&rdf_force);
    return status;
}

#define MEMBER(name) .offset = offsetof(struct evaluate_verification_parameters, name)
const struct field evaluate_verification_fields[] = {
    {"replicas", FIELD_INTEGER, MEMBER(replicas), .initial = 4, .minimum = 1, .maximum = 1024,
     .unit = "", .help = "independent simulations"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau",
     .help =
         "of the verification, which should be finer than a fit's: a fit makes up for the error "
         "of its own; 0: that of the scene"},
    {"equilibration", FIELD_INTEGER, MEMBER(plan.equilibration), .initial = 1000, .minimum = 0,
     .maximum = 1e12, .unit = "steps", .help = "before the first sample"},
    {"samples", FIELD_INTEGER, MEMBER(plan.samples), .initial = 50, .minimum = 1, .maximum = 1e8,
     .unit = "", .help = "of each replica"},
    {"every", FIELD_INTEGER, MEMBER(plan.every), .initial = 25, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "between samples"},
    FIELD_END,
};

/// One replica of the verification.
struct replica {
    struct simulation simulation;
    struct rdf rdf;
    struct thermodynamics thermodynamics;
};

static enum status run_replica(const struct inverse_problem *problem, const struct table *potential,
                               const struct evaluate_verification_parameters *parameters,
                               uint32_t number, struct replica *replica) {
    const struct measure_plan *plan = &parameters->plan;
    struct simulation_setup setup = problem->scene;
    double temperature;
    setup.potential = potential;
    if (parameters->time_step > 0)
        setup.time_step = parameters->time_step;
    setup.seed = rng_child_seed(problem->seed, RNG_VERIFICATION, number, 0);
    TRY(rdf_init(&replica->rdf, &problem->bins, &setup.box, (size_t)setup.placement.count,
                 potential->cutoff, (size_t)plan->samples));
    TRY(thermodynamics_init(&replica->thermodynamics, (size_t)plan->samples));
    TRY(simulation_init(&replica->simulation, &setup, NULL));
    TRY(measure_equilibrate(&replica->simulation, plan, &temperature, NULL));
    return measure_sample(
        &replica->simulation, plan,
        (struct measure_targets){.rdf = &replica->rdf, .thermodynamics = &replica->thermodynamics},
        NULL);
}

/// Results of all replicas together, in their order.
static enum status summarise(const struct inverse_problem *problem, const struct rdf *rdf,
                             const struct thermodynamics *thermodynamics, size_t count,
                             struct evaluate_verification *verification) {
    enum status status = STATUS_OK;
    verification->bins = problem->bins.count;
    NEW_ARRAY(verification->g, verification->bins);
    NEW_ARRAY(verification->g_error, verification->bins);
    rdf_result(rdf, count, verification->g, verification->g_error);
    CHECK(
        rdf_distance(rdf, count, problem->target, &verification->rmse, &verification->rmse_error));
    verification->noise =
        expected_noise(verification->g_error, problem->target_error, verification->bins);
    verification->thermodynamics = thermodynamics_result(thermodynamics, count);
done:
    return status;
}

enum status evaluate_verify(const struct inverse_problem *problem, const struct table *potential,
                            const struct evaluate_verification_parameters *parameters,
                            const struct inverse_listener *listener,
                            struct evaluate_verification *verification) {
    enum status status = STATUS_OK;
    const size_t count = (size_t)parameters->replicas;
    struct replica *replicas = NULL;
    struct rdf *rdf = NULL;
    struct thermodynamics *thermodynamics = NULL;
    uint64_t done = 0;
    char reason[512] = "";
    *verification = (struct evaluate_verification){0};
    NEW_ARRAY(replicas, count);
    NEW_ARRAY(rdf, count);
    NEW_ARRAY(thermodynamics, count);
#pragma omp parallel for schedule(dynamic) num_threads(problem->threads)
    for (size_t k = 0; k < count; k++) {
        const enum status here =
            run_replica(problem, potential, parameters, (uint32_t)k, &replicas[k]);
#pragma omp critical
        {
            if (here != STATUS_OK) {
                status = here;
                snprintf(reason, sizeof reason, "%s", status_message());
            }
            done++;
            const struct inverse_progress progress = {
                .done = done, .total = count, .best = NAN, .mean = NAN};
            listener->tell(listener->context, &progress);
        }
    }
    if (status != STATUS_OK) {
        status_fail(status, "%s", reason);
        goto done;
    }
    for (size_t k = 0; k < count; k++) {
        rdf[k] = replicas[k].rdf;
        thermodynamics[k] = replicas[k].thermodynamics;
        verification->engine_steps += replicas[k].simulation.step;
    }
    CHECK(summarise(problem, rdf, thermodynamics, count, verification));
done:
    for (size_t k = 0; replicas && k < count; k++) {
        simulation_clear(&replicas[k].simulation);
        rdf_clear(&replicas[k].rdf);
        thermodynamics_clear(&replicas[k].thermodynamics);
    }
    memory_free(replicas);
    memory_free(rdf);
    memory_free(thermodynamics);
    return status;
}

void evaluate_verification_clear(struct evaluate_verification *verification) {
    memory_free(verification->g);
    memory_free(verification->g_error);
    *verification = (struct evaluate_verification){0};
}
