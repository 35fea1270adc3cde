// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/kirkwood_buff.h"
#include "observe/motion.h"
#include "observe/stationary.h"
#include "problem/sampling_engine.h"
#include "problem/group_kind.h"
#include "problem/verify_agreement.h"

#include <math.h>

static const char *const by[] = {"auto", "mesofit", "engine", NULL};
static const char *const no_or_yes[] = {"no", "yes", NULL};

#define MEMBER(name) .offset = offsetof(struct verify_parameters, name)
const struct field mf_verify_fields[] = {
    {"by", FIELD_CHOICE, MEMBER(by), .choices = by, .initial = VERIFY_BY_AUTO, .unit = "",
     .help = "who simulates; auto: a command or \"input\", else mesofit"},
    {"replicas", FIELD_INTEGER, MEMBER(replicas), .initial = 4, .minimum = 1, .maximum = 1024,
     .unit = "", .help = "independent simulations"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau", .help = "time step; 0: the scene's"},
    {"shorten_time_step", FIELD_CHOICE, MEMBER(shorten), .choices = no_or_yes, .initial = 0,
     .unit = "",
     .help = "halve the time step until both temperatures agree within 1 %; "
             "default yes if the file has none"},
    {"equilibration", FIELD_INTEGER, MEMBER(plan.equilibration), .initial = 1000, .minimum = 0,
     .maximum = 1e12, .unit = "steps", .help = "interval before the first sample"},
    {"samples", FIELD_INTEGER, MEMBER(plan.samples), .initial = 50, .minimum = 1, .maximum = 1e8,
     .unit = "", .help = "samples of each replica"},
    {"end_early", FIELD_CHOICE, MEMBER(end_early), .choices = no_or_yes, .initial = 0, .unit = "",
     .help = "end when differences from targets are known within a tenth, T within 0.3 %; default "
             "yes where samples are chosen"},
    {"every", FIELD_INTEGER, MEMBER(plan.every), .initial = 25, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "interval between samples"},
    FIELD_END,
};

/// A verification that may end early looks after these parts of its samples.
enum { LOOKS = 5 };
static const int look_at[LOOKS] = {2, 3, 4, 6, 8};

/// Replicas at work.
struct work {
    const struct inverse_problem *problem;
    const struct table *potential, *omega;
    struct verify_parameters parameters;
    uint32_t attempt;           ///< with another time step, or again as the first had not settled
    bool last;                  ///< no shorter step will be tried
    struct measure_plan so_far; ///< up to the next look
    bool goes_on;               ///< there was a look before
    double
        *begin; ///< where they begin, shape [replicas, dimensions, particles]; NULL: as the scene
    const struct inverse_listener *listener;
    struct measurement *replicas;
    struct engine_replay *replay; ///< shape [replicas]; NULL: we simulate
    struct inverse_progress progress;
    uint64_t taken; ///< samples of each replica since the last look
};

/// With the frames of another engine in the place of time steps.
static enum status replay_replica(const struct work *work, size_t number,
                                  const struct measurement_setup *setup) {
    struct inverse_problem problem = *work->problem;
    struct engine_piece *piece = &work->replay[number].piece;
    const struct sampling_engine *engine = problem.engine;
    piece->seed = setup->seed;
    piece->potential = work->potential;
    piece->molecules = mf_molecules_find(problem.scene.interaction, problem.scene.interactions);
    problem.scene.integrator = &mf_sampling_engine_replay;
    problem.scene.integrator_parameters = &work->replay[number];
    if (engine->announce)
        TRY(engine->announce(engine->context, piece));
    return mf_measurement_init(&work->replicas[number], &problem, setup);
}

/// What the engine is asked for: as many time steps as we would take, and of the measurement a
/// frame a step.
static enum status ask_engine(struct work *work) {
    struct verify_parameters *parameters = &work->parameters;
    struct measure_plan *plan = &parameters->plan;
    const struct inverse_problem *problem = work->problem;
    const int64_t steps = problem->engine->steps;
    TRY_ARRAY(work->replay, (size_t)parameters->replicas);
    for (int64_t k = 0; k < parameters->replicas; k++)
        work->replay[k] = (struct engine_replay){
            .engine = problem->engine,
            .piece = {.replica = (size_t)k,
                      .fresh = true,
                      .temperature = problem->scene.temperature,
                      .lead = (uint64_t)((plan->equilibration + steps - 1) / steps),
                      .frames = (uint64_t)plan->samples,
                      .every = (uint64_t)((plan->every + steps - 1) / steps)}};
    *plan = (struct measure_plan){.samples = plan->samples, .every = 1};
    parameters->end_early = 0;
    return STATUS_OK;
}

static enum status begin_replica(void *context, size_t number, void *result) {
    const struct work *work = context;
    const struct verify_parameters *parameters = &work->parameters;
    const size_t particles = (size_t)work->problem->scene.placement.count;
    const size_t dimensions = (size_t)work->problem->scene.box.dimensions;
    const double *position[3] = {NULL};
    (void)result;
    for (size_t d = 0; work->begin && d < dimensions; d++)
        position[d] = work->begin + (number * dimensions + d) * particles;
    const struct measurement_setup setup = {
        .targets = &work->problem->compared,
        .potential = work->potential,
        .omega = work->omega,
        .position = work->begin ? position : NULL,
        .time_step = parameters->time_step,
        .plan = parameters->plan,
        .thermodynamics = true,
        .threads = 1,
        .seed = mf_rng_child_seed(work->problem->seed, RNG_VERIFICATION, (uint32_t)number,
                                  work->attempt)};
    return work->replay ? replay_replica(work, number, &setup)
                        : mf_measurement_init(&work->replicas[number], work->problem, &setup);
}

/// A simulation that is far too hot is not sampled if a shorter step is to follow: by a tenth and
/// more than the chance of one configuration's temperature.
static enum status check_heat(const struct simulation *simulation, double temperature) {
    static const double hot = 0.1, deviations = 4;
    const struct simulation_setup *setup = &simulation->setup;
    const double degrees = (double)setup->box.dimensions * (double)simulation->particles.count;
    const double wanted = setup->temperature;
    if (!simulation_has_velocities(setup) || !simulation_holds_temperature(setup) ||
        !(temperature > (1 + hot + deviations * sqrt(2 / degrees)) * wanted))
        return STATUS_OK;
    return mf_status_fail(STATUS_UNSTABLE,
                          "the temperature is %.3g" STATUS_TEMPERATURE
                          " after equilibration, not %.3g" STATUS_TEMPERATURE,
                          temperature, wanted);
}

/// From the beginning, or from the last look on, where another rank may have brought it.
static enum status run_replica(void *context, size_t number, void *result) {
    const struct work *work = context;
    struct measurement *replica = &work->replicas[number];
    double temperature;
    (void)result;
    if (work->goes_on) {
        TRY(mf_simulation_restore(&replica->simulation));
    } else {
        TRY(mf_measure_equilibrate(&replica->simulation, &work->so_far, &temperature, NULL));
        if (!work->last)
            TRY(check_heat(&replica->simulation, temperature));
    }
    return mf_measure_sample(&replica->simulation, &work->so_far, replica->use, NULL);
}

static void report_one(void *context, size_t number, const void *result) {
    struct work *work = context;
    (void)number, (void)result;
    work->progress.done += work->taken;
    work->listener->report(work->listener->context, &work->progress);
}

static size_t list_measured(void *context, size_t number, struct memory_span *spans) {
    return mf_measurement_spans(&((const struct work *)context)->replicas[number], spans);
}

static enum status run_until_look(struct work *work) {
    return mf_parallel_try(
        &(struct parallel_tasks){.count = (size_t)work->parameters.replicas,
                                 .threads = inverse_problem_threads(work->problem),
                                 .run = run_replica,
                                 .take = report_one,
                                 .context = work,
                                 .spans = list_measured});
}

/// Samples of each replica at a look; 0 if they are too few for one: of some targets a single
/// window of time has no error.
static int64_t samples_at(const struct work *work, int look) {
    enum { MIN_SAMPLES = 2 * STATIONARY_PARTS, MIN_WINDOWS = 4 };
    const struct measure_plan *plan = &work->parameters.plan;
    enum target_kind longest;
    const int64_t window = mf_measurement_window(
        &work->problem->compared, work->replicas->simulation.setup.time_step, &longest);
    const int64_t samples = plan->samples * look_at[look] / look_at[LOOKS - 1];
    const bool enough = samples >= MIN_SAMPLES && samples * plan->every >= MIN_WINDOWS * window;
    return look == LOOKS - 1 || enough ? samples : 0;
}

/// All replicas in parallel, until they have all samples or know enough. Every rank begins them
/// all, to have room for what others find.
static enum status run_replicas(struct work *work) {
    const size_t count = (size_t)work->parameters.replicas;
    struct measure_plan *so_far = &work->so_far;
    struct inverse_progress *progress = &work->progress;
    int64_t before = 0;
    bool known = false;
    // With another step there are as many more.
    *progress = (struct inverse_progress){.done = progress->done,
                                          .total = progress->done +
                                                   count * (uint64_t)work->parameters.plan.samples,
                                          .best = NAN,
                                          .min = NAN,
                                          .mean = NAN};
    TRY(mf_parallel_try(&(struct parallel_tasks){
        .count = count, .threads = work->problem->threads, .run = begin_replica, .context = work}));
    work->goes_on = false;
    *so_far = work->parameters.plan;
    for (int look = work->parameters.end_early ? 0 : LOOKS - 1; look < LOOKS && !known; look++) {
        so_far->samples = samples_at(work, look);
        if (so_far->samples == 0)
            continue;
        work->taken = (uint64_t)(so_far->samples - before);
        TRY(run_until_look(work));
        if (look < LOOKS - 1)
            TRY(mf_verify_knows(work->replicas, count, &known));
        before = so_far->samples;
        work->goes_on = true;
    }
    progress->total = progress->done;
    work->listener->report(work->listener->context, progress);
    return STATUS_OK;
}

/// Whether the temperature that another engine has told is that of the scene.
static void doubt_engine(const struct simulation_setup *setup, struct verification *verification) {
    static const double allowed = 0.025, errors = 3;
    const struct thermodynamics_summary *found = &verification->thermodynamics;
    const double off = found->temperature / setup->temperature - 1;
    if (fabs(off) > allowed + errors * found->temperature_error / setup->temperature)
        snprintf(verification->warning, sizeof verification->warning,
                 "the engine's samples are %.2g %% too %s: its time step is too long for this "
                 "potential, or its thermostat does not hold",
                 100 * fabs(off), off > 0 ? "hot" : "cold");
}

/// Results of all replicas together, in their order.
static enum status summarise(struct measurement *replicas, size_t count,
                             struct verification *verification) {
    const struct targets *targets = replicas->targets;
    OWNED struct thermodynamics *thermodynamics = NULL;
    TRY_ARRAY(thermodynamics, count);
    for (size_t k = 0; k < count; k++)
        thermodynamics[k] = *(const struct thermodynamics *)mf_measurement_state(
            &replicas[k], &mf_thermodynamics_observable);
    verification->thermodynamics = mf_thermodynamics_result(thermodynamics, count);
    verification->shift = mf_thermodynamics_shift(
        thermodynamics, count, &verification->thermodynamics, &replicas->simulation.setup);
    if (replicas->simulation.setup.integrator->tell)
        doubt_engine(&replicas->simulation.setup, verification);
    else if (mf_thermodynamics_assess_fit(&verification->thermodynamics,
                                          &replicas->simulation.setup) != STATUS_OK)
        snprintf(verification->warning, sizeof verification->warning, "%s", mf_status_marked());
    const struct simulation_setup *setup = &replicas->simulation.setup;
    if (!verification->warning[0] && mf_pair_memory_is_coarse(&setup->memory, setup->time_step))
        snprintf(verification->warning, sizeof verification->warning,
                 "the time step is too long for the memory that was found: with a shorter one it "
                 "is another friction");
    const void *moved = mf_measurement_state(replicas, &mf_motion_observable);
    if (moved) {
        const struct motion_summary motion = mf_motion_result(moved, NULL);
        verification->diffusion_begin = motion.fit_begin;
        verification->diffusion_end = motion.fit_end;
    }
    TRY(mf_verify_distances(replicas, count, &verification->observed, verification->distance,
                            verification->distance_error));
    for (int kind = 0; kind < TARGETS; kind++)
        mf_statistics_mark_unknown_errors(verification->observed.error[kind],
                                          targets->target[kind].count);
    return STATUS_OK;
}

/// The state of a simulation, from which another can go on.
static enum status keep_configuration(const struct particles *particles,
                                      struct verification *verification) {
    const size_t count = particles->count;
    verification->particles = count;
    TRY_ARRAY(verification->configuration, 6 * count);
    for (size_t k = 0; k < count; k++)
        for (size_t d = 0; d < (size_t)particles->box.dimensions; d++) {
            verification->configuration[d * count + particles->id[k]] = particles->position[d][k];
            verification->configuration[(3 + d) * count + particles->id[k]] =
                particles->velocity[d][k];
        }
    return STATUS_OK;
}

static void clear_replicas(struct measurement *replicas, size_t count) {
    for (size_t k = 0; replicas && k < count; k++) {
        mf_measurement_clear(&replicas[k]);
        replicas[k] = (struct measurement){0};
    }
}

/// Let those that come next begin where these have ended.
static enum status go_on(struct work *work) {
    enum status status = STATUS_OK;
    const size_t replicas = (size_t)work->parameters.replicas;
    const size_t particles = work->replicas->simulation.particles.count;
    const size_t dimensions = (size_t)work->problem->scene.box.dimensions;
    if (work->begin == NULL)
        NEW_ARRAY(work->begin, replicas * dimensions * particles);
    for (size_t r = 0; r < replicas; r++) {
        const struct particles *ended = &work->replicas[r].simulation.particles;
        for (size_t d = 0; d < dimensions; d++)
            for (size_t k = 0; k < particles; k++)
                work->begin[(r * dimensions + d) * particles + ended->id[k]] =
                    ended->position[d][k];
    }
    work->attempt += VERIFY_STEP_HALVINGS + 1; // other seeds than those of other time steps
done:
    clear_replicas(work->replicas, replicas);
    return status;
}

/// Run them until they have settled, or twice again: what has not is equilibration, and goes on.
static enum status run_until_settled(struct work *work, struct verification *verification) {
    enum { MAX_ATTEMPTS = 3 };
    const size_t count = (size_t)work->parameters.replicas;
    for (int attempt = 1;; attempt++) {
        TRY(run_replicas(work));
        TRY(mf_verify_equilibrium(work->replicas, count, verification->unequilibrated));
        for (size_t k = 0; k < count; k++)
            verification->engine_steps += work->replicas[k].simulation.step;
        if (verification->unequilibrated[0] == '\0' || attempt == MAX_ATTEMPTS || work->replay)
            return STATUS_OK;
        work->parameters.plan.every *= 2;
        TRY(go_on(work));
    }
}

/// With one time step.
/// @param[out] off  how far the temperatures are
static enum status verify_once(struct work *work, struct verification *verification,
                               struct thermodynamics_off *off) {
    enum status status = STATUS_OK;
    const size_t count = (size_t)work->parameters.replicas;
    struct measurement *replicas = NULL;
    *verification = (struct verification){0};
    *off = (struct thermodynamics_off){.known = false};
    verification->by_engine = work->problem->engine != NULL;
    NEW_ARRAY(replicas, count);
    work->replicas = replicas;
    if (work->problem->engine)
        CHECK(ask_engine(work));
    CHECK(run_until_settled(work, verification));
    CHECK(summarise(replicas, count, verification));
    if (!verification->by_engine) // whose time step is not ours
        *off = mf_thermodynamics_off(&verification->thermodynamics, &replicas->simulation.setup);
    CHECK(mf_verify_sections_find(work->problem, replicas, count, &verification->observed,
                                  &verification->sections));
    CHECK(keep_configuration(&replicas->simulation.particles, verification));
done:
    clear_replicas(replicas, count);
    mf_memory_free(replicas);
    mf_memory_free(work->begin);
    mf_memory_free(work->replay);
    work->begin = NULL;
    work->replay = NULL;
    return status;
}

/// As long a time in shorter steps.
static void shorten(const struct verify_parameters *of, const struct verify_step *step,
                    struct verify_parameters *parameters) {
    *parameters = *of;
    parameters->time_step = step->used;
    parameters->plan.equilibration <<= step->halvings;
    parameters->plan.every <<= step->halvings;
}

enum status mf_verify(const struct inverse_problem *problem, const struct table *potential,
                      const struct table *omega, const struct verify_parameters *parameters,
                      const struct inverse_listener *listener, struct verification *verification) {
    const double first =
        parameters->time_step > 0 ? parameters->time_step : problem->scene.time_step;
    struct verify_step step = mf_verify_step_begin(
        problem, potential, first, parameters->shorten == 1 && problem->engine == NULL);
    struct work work = {
        .problem = problem, .potential = potential, .omega = omega, .listener = listener};
    *verification = (struct verification){0};
    for (bool again = true; again;) {
        struct thermodynamics_off off;
        mf_verify_clear(verification);
        shorten(parameters, &step, &work.parameters);
        work.attempt = (uint32_t)step.halvings;
        work.last = !step.shortens || step.halvings == VERIFY_STEP_HALVINGS;
        const enum status status = verify_once(&work, verification, &off);
        if (status != STATUS_OK && status != STATUS_UNSTABLE)
            return status;
        again = mf_verify_step_again(&step, &off, status == STATUS_UNSTABLE);
        verification->step = step;
        if (!again)
            return status;
    }
    return STATUS_OK;
}

void mf_verify_clear(struct verification *verification) {
    mf_measurement_values_clear(&verification->observed);
    mf_memory_free(verification->configuration);
    *verification = (struct verification){0};
}
