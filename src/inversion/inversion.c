// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "base/clock.h"
#include "base/spent.h"

#include <math.h>
#include <string.h>

bool mf_inversion_is_near(const struct inversion *inversion) {
    const struct inversion_state *first = inversion->state;
    return first->basis.count > 0
               ? mf_inversion_state_is_near(first)
               : mf_inversion_assessment_is_near(&inversion->assessment, first->pool.samples > 0);
}

// Samples -----------------------------------------------------------------------------------------

/// Progress of one state, reported as a part of that of all.
struct sharing {
    const struct inversion *inversion;
    size_t state;
    const struct inverse_listener *listener;
};

static void report_of_state(void *context, const struct inverse_progress *own) {
    const struct sharing *sharing = context;
    struct inverse_progress all = *own;
    all.done += sharing->state * own->total;
    all.total *= sharing->inversion->states;
    sharing->listener->report(sharing->listener->context, &all);
}

enum status mf_inversion_observe(struct inversion *inversion,
                                 const struct inverse_listener *listener) {
    for (size_t s = 0; s < inversion->states; s++) {
        struct inversion_state *state = &inversion->state[s];
        struct sharing sharing = {inversion, s, listener};
        TRY(mf_inversion_sample(inversion, state,
                                &(struct inverse_listener){report_of_state, &sharing}));
        if (state->assessment.unstable)
            continue;
        TRY(mf_inversion_bulk_check(state));
        TRY(mf_inversion_response_assess(state));
        if (state->assessment.unequilibrated.found)
            state->pool.samples = 0;
        else
            mf_inversion_pool(state, inversion->course.progress.on_its_way);
    }
    mf_inversion_states_assess(inversion->state, inversion->states, &inversion->assessment);
    return STATUS_OK;
}

// Reports ----------------------------------------------------------------------------------------

/// The curves of groups follow those of pairs, of which there may be none.
static void show_groups(const struct inversion *inversion, struct inverse_step *step) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const struct inversion_course *course = &inversion->course;
    if (grid->pairs == 0)
        step->curve[UNKNOWN_POTENTIAL] = NULL;
    if (grid->groups == 0)
        return;
    step->curve[UNKNOWN_BONDED] = course->best.phi + grid->pair_points;
    step->curve_error[UNKNOWN_BONDED] = course->band.error + grid->pair_points;
    step->curve_flat[UNKNOWN_BONDED] = course->band.flat + INVERSE_FLAT * grid->pair_points;
}

/// What the iteration has cost, and the columns of the first state.
static void describe_samples(const struct inversion *inversion, const double *own,
                             struct inverse_step *step) {
    const struct inversion_state *first = inversion->state;
    const struct inversion_assessment *assessment = &inversion->assessment;
    const double particles = (double)mf_composition_particles(&first->composition);
    const struct replicas_mean energy =
        mf_replicas_mean(&first->replicas, SAMPLER_ENERGY, first->inefficiency);
    const bool told = mf_inversion_bulk_knows_pressure(first);
    const double columns[INVERSION_SHARED_COLUMNS] = {inversion->course.progress.damping *
                                                          inversion->course.progress.chosen_damping,
                                                      assessment->own_noise,
                                                      assessment->disagreement,
                                                      assessment->distance[TARGET_RDF].rms,
                                                      told ? first->bulk.pressure : NAN,
                                                      told ? first->bulk.pressure_error : NAN,
                                                      mf_replicas_acceptance(&first->replicas),
                                                      energy.mean / particles,
                                                      energy.error / particles,
                                                      first->inefficiency};
    memcpy(step->extra, columns, sizeof columns);
    memcpy(step->extra + INVERSION_SHARED_COLUMNS, own, INVERSION_OWN_COLUMNS * sizeof *own);
    for (size_t s = 0; s < inversion->states; s++) {
        step->evaluations += inversion->state[s].work.evaluations;
        step->engine_steps += inversion->state[s].work.sweeps;
    }
}

static void describe(const struct inversion *inversion, const double *own, bool kept,
                     bool converged, struct inverse_step *step) {
    const struct inversion_course *course = &inversion->course;
    const struct inversion_progress *progress = &course->progress;
    const struct targets *targets = &inversion->problem->targets;
    const bool stuck = progress->damping < mf_inversion_min_damping;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .error = mf_targets_error(targets, progress->best.distance),
        .noise = mf_targets_noise(targets, progress->best.distance),
        .variance = mf_targets_variance(targets, progress->best.distance),
        .curve = {course->best.phi},
        .curve_error = {course->band.error},
        .curve_flat = {course->band.flat},
        .without_ramp = course->band.without_ramp,
        .ramp = course->band.ramp,
        .start = mf_inversion_start_taken(inversion, kept),
        .response = {inversion->state->response.covariance, inversion->state->target.ideal},
        .converged = converged,
        .finished = converged || stuck || progress->lost ||
                    progress->iteration + 1 >= inversion->parameters.iterations,
    };
    memcpy(step->noise_of_state, progress->best.noise, sizeof step->noise_of_state);
    for (size_t s = 0; s < inversion->states; s++)
        mf_inversion_equilibrium_slowest(&inversion->state[s], &step->slowest);
    show_groups(inversion, step);
    describe_samples(inversion, own, step);
    if (step->finished && !converged)
        mf_inversion_reason_write(inversion, step->reason);
}

// An iteration ------------------------------------------------------------------------------------

/// Keep the potential or go back, and step on.
static enum status advance(struct inversion *inversion, struct inverse_step *step, bool *kept) {
    struct inversion_course *course = &inversion->course;
    const struct inversion_state *first = inversion->state;
    const struct inversion_rule *rule = inversion->method->own;
    double own[INVERSION_OWN_COLUMNS] = {0};
    bool converged;
    course->has_other = course->most_probable = false;
    TRY(rule->update(inversion, own));
    mf_inversion_history_add(&inversion->history, first->replicas.counts.mean, first->target.counts,
                             first->target.unit);
    TRY(mf_inversion_course_accept(inversion, kept));
    converged = mf_inversion_has_converged(inversion, *kept);
    if (converged)
        TRY(mf_inversion_take_last_step(inversion));
    describe(inversion, own, *kept, converged, step);
    if (!step->finished)
        TRY(mf_inversion_course_go_on(inversion, *kept));
    course->progress.iteration++;
    return STATUS_OK;
}

/// Processor time of all that was simulated.
static double simulated(const struct spent *spent) {
    return spent->seconds[SPENT_EQUILIBRATION] + spent->seconds[SPENT_SAMPLES] +
           spent->seconds[SPENT_LOST];
}

/// All but the simulations was algebra. Samples of a potential that is not kept do not count.
static void account(double begun, const struct spent *before, bool kept) {
    const struct spent now = mf_spent();
    mf_spent_add(SPENT_ALGEBRA,
                 clock_process_seconds() - begun - (simulated(&now) - simulated(before)));
    if (!kept)
        mf_spent_lose(now.seconds[SPENT_SAMPLES] - before->seconds[SPENT_SAMPLES]);
}

enum status mf_inversion_iterate(void *memory, struct inverse_step *step,
                                 const struct inverse_listener *listener) {
    struct inversion *inversion = memory;
    const double begun = clock_process_seconds();
    const struct spent before = mf_spent();
    bool kept;
    if (inversion->course.progress.iteration == 0)
        TRY(mf_inversion_start_of_molecules(inversion, listener));
    TRY(mf_inversion_observe(inversion, listener));
    TRY(mf_inversion_equations_fill(&inversion->equations,
                                    mf_inversion_band_birge(&inversion->assessment)));
    TRY(advance(inversion, step, &kept));
    if (inversion->states > 1)
        mf_inversion_states_end(inversion, step);
    account(begun, &before, kept);
    return STATUS_OK;
}
