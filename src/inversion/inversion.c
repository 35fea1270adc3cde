// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"
#include "inversion/inversion_coarse.h"

#include <math.h>
#include <string.h>

const double mf_inversion_least_damping = 1.0 / 64;

/// C of the present samples, and near the target of all since it was reached. The noise of C leads
/// from every direction into those that g sees best, so that little seen ones seem better known
/// than they are and each step goes a part of their way: a third for soft beads with 1400 samples
/// and as many again behind the target, where the pressure was still off by three of its errors
/// when g had agreed.
static void assess_covariance(struct inversion *inversion) {
    const struct potential_grid *grid = &inversion->grid;
    const struct comoments *counts = &inversion->replicas.counts;
    const bool near = mf_inversion_is_near(inversion);
    const double before = near ? inversion->progress.responses : 0;
    const double share = counts->count / (before + counts->count);
    inversion->behind = before + counts->count;
    for (size_t a = 0; a < grid->known; a++)
        for (size_t b = 0; b < grid->known; b++) {
            double *c = &inversion->covariance[a * grid->known + b];
            const double now =
                mf_comoments_covariance(counts, grid->known_bin[a], grid->known_bin[b]);
            *c = (1 - share) * *c + share * now;
        }
    mf_inversion_response_find(inversion);
    mf_inversion_kirkwood_buff_respond(inversion, share);
    inversion->progress.responses = near ? inversion->behind : 0;
}

struct imc_system mf_inversion_system(const struct inversion *inversion) {
    if (inversion->joint)
        return inversion->joint->system;
    return (struct imc_system){.size = inversion->grid.known,
                               .block = inversion->grid.known_of,
                               .blocks = inversion->grid.blocks,
                               .shape = inversion->shape,
                               .covariance = mf_inversion_response_values(inversion),
                               .excess = inversion->excess,
                               .variance = inversion->variance,
                               .common = inversion->common,
                               .temperature = inversion->problem->scene.temperature,
                               .spacing = inversion->problem->targets.bins.width};
}

/// What the samples say besides g: how far the pressure is from what is asked for, and how all
/// respond to the potential.
static enum status assess_response(struct inversion *inversion) {
    const struct targets *targets = &inversion->problem->targets;
    mf_inversion_pressure_measure(inversion);
    if (targets_ask(targets, TARGET_PRESSURE))
        inversion->distance[TARGET_PRESSURE] =
            mf_targets_distance(&targets->target[TARGET_PRESSURE], &inversion->pressure.value,
                                &inversion->pressure.error);
    assess_covariance(inversion);
    return mf_inversion_pressure_slopes(inversion);
}

static bool goes_by_gradient(const struct inversion *inversion) {
    return inversion->basis.count > 0;
}

/// Whether the samples are as exact as was asked for.
static bool is_precise(const struct inversion *inversion) {
    for (int k = 0; k < inversion->sections; k++)
        if (inversion->section[k].own_noise > inversion->section[k].precision)
            return false;
    return true;
}

/// Keep the present potential as the best, with the steps that lead on from it.
static enum status keep(struct inversion *inversion) {
    struct inversion_progress *progress = &inversion->progress;
    const size_t bytes = inversion->grid.points * sizeof(double);
    memcpy(inversion->best, inversion->phi, bytes);
    memcpy(inversion->best_step, inversion->step, bytes);
    memcpy(inversion->best_other, inversion->other_step, bytes);
    progress->best_other = inversion->has_other;
    memcpy(inversion->best_counts, inversion->replicas.counts.mean,
           inversion->bins * sizeof(double));
    memcpy(progress->best, inversion->distance, sizeof progress->best);
    progress->best_own_noise = inversion->own_noise;
    progress->best_precise = is_precise(inversion);
    progress->best_worst = *mf_inversion_worst(inversion);
    mf_inversion_find_factor(inversion, &progress->best_factor);
    return mf_inversion_band_find(inversion);
}

/// Go back to the best, for its other step if it has one, or for half of its step.
static void go_back(struct inversion *inversion) {
    struct inversion_progress *progress = &inversion->progress;
    const size_t bytes = inversion->grid.points * sizeof(double);
    if (!progress->best_other) {
        progress->damping *= 0.5;
        return;
    }
    memcpy(inversion->best_step, inversion->best_other, bytes);
    progress->best_other = false;
    progress->damping = 1;
}

/// S_rel is convex: its Newton steps promise less and less, unless one was too long.
static bool keeps_by_gradient(struct inversion *inversion) {
    const struct inversion_basis *basis = &inversion->basis;
    double *least = &inversion->progress.least_decrement;
    const bool kept = basis->decrement <= 2 * *least + 8 * basis->chance;
    *least = fmin(*least, basis->decrement);
    return kept;
}

bool mf_inversion_keeps(struct inversion *inversion) {
    struct inversion_progress *progress = &inversion->progress;
    if (goes_by_gradient(inversion))
        return keeps_by_gradient(inversion);
    const bool kept = mf_inversion_is_near_enough(inversion);
    if (isinf(progress->best[TARGET_RDF].rms) ||
        mf_inversion_count_noises(inversion, inversion->distance) <
            mf_inversion_count_noises(inversion, progress->least))
        memcpy(progress->least, inversion->distance, sizeof progress->least);
    return kept;
}

/// Keep the present potential, or go back if it is worse than the nearest by more than chance.
/// Replicas that a worse potential may have frozen or torn apart are not gone on with.
static enum status judge(struct inversion *inversion, bool *kept) {
    struct inversion_progress *progress = &inversion->progress;
    const double error = inversion->distance[TARGET_RDF].rms;
    const bool start = isinf(progress->best[TARGET_RDF].rms);
    *kept = !inversion->useless && mf_inversion_keeps(inversion);
    progress->anew = !*kept;
    progress->lost = start && !*kept && !mf_inversion_start_is_poor(inversion, false);
    if (start && !*kept)
        return keep(inversion); // to have something to show
    if (start)
        progress->first_error = progress->second_error = error;
    else if (progress->second_error == progress->first_error)
        progress->second_error = error;
    if (!*kept) {
        go_back(inversion);
        return STATUS_OK;
    }
    if (!start)
        mf_inversion_relax(inversion);
    progress->stretch = inversion->stretch > 1 ? inversion->stretch / 2 : 1;
    return keep(inversion);
}

/// The next potential to be sampled: the other start, or a step from the best.
static enum status go_on(struct inversion *inversion, bool kept) {
    struct inversion_progress *progress = &inversion->progress;
    if (!mf_inversion_start_is_poor(inversion, kept)) {
        mf_inversion_take_step(inversion);
        return STATUS_OK;
    }
    progress->best[TARGET_RDF].rms = progress->least_decrement = INFINITY;
    progress->damping = 1;
    progress->anew = true;
    progress->again = true;
    return mf_inversion_start_again(inversion);
}

/// The curves of groups stand behind those of pairs, of which there may be none.
static void show_groups(const struct inversion *inversion, struct inverse_step *step) {
    const struct potential_grid *grid = &inversion->grid;
    if (grid->pairs == 0)
        step->curve[UNKNOWN_POTENTIAL] = NULL;
    if (grid->groups == 0)
        return;
    step->curve[UNKNOWN_BONDED] = inversion->best + grid->pair_points;
    step->curve_error[UNKNOWN_BONDED] = inversion->band.error + grid->pair_points;
    step->curve_flat[UNKNOWN_BONDED] = inversion->band.flat + INVERSE_FLAT * grid->pair_points;
}

static void describe(const struct inversion *inversion, const double *own, bool converged,
                     struct inverse_step *step) {
    const struct inversion_progress *progress = &inversion->progress;
    const struct inversion_parameters *p = &inversion->settings.common;
    const bool stuck = progress->damping < mf_inversion_least_damping;
    const double particles = (double)mf_composition_particles(&inversion->composition);
    const struct replicas_mean energy =
        mf_replicas_mean(&inversion->replicas, SAMPLER_ENERGY, inversion->inefficiency);
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = progress->evaluations,
        .engine_steps = progress->sweeps,
        .error = mf_targets_error(&inversion->problem->targets, progress->best),
        .noise = mf_targets_noise(&inversion->problem->targets, progress->best),
        .variance = mf_targets_variance(&inversion->problem->targets, progress->best),
        .extra = {progress->damping, inversion->own_noise, inversion->disagreement,
                  inversion->distance[TARGET_RDF].rms, inversion->pressure.value,
                  inversion->pressure.error, mf_replicas_acceptance(&inversion->replicas),
                  energy.mean / particles, energy.error / particles},
        .curve = {inversion->best},
        .curve_error = {inversion->band.error},
        .curve_flat = {inversion->band.flat},
        .without_ramp = inversion->band.without_ramp,
        .ramp = inversion->band.ramp,
        .response = {inversion->covariance, inversion->ideal},
        .converged = converged,
        .finished =
            converged || stuck || progress->lost || progress->iteration + 1 >= p->iterations,
    };
    show_groups(inversion, step);
    memcpy(step->extra + INVERSION_SHARED_COLUMNS, own, INVERSION_OWN_COLUMNS * sizeof *own);
    if (step->finished && !converged)
        mf_inversion_reason_tell(inversion, step->reason);
}

enum status mf_inversion_observe(struct inversion *inversion,
                                 const struct inverse_listener *listener) {
    inversion->joint = NULL;
    TRY(mf_inversion_sample(inversion, listener));
    TRY(assess_response(inversion));
    if (inversion->unsettled)
        inversion->progress.responses = inversion->progress.pool = 0;
    else
        mf_inversion_pool(inversion);
    return STATUS_OK;
}

/// Integrals are met by rows beside those of g(r), as several states are.
static enum status join_integrals(struct inversion *inversion) {
    if (inversion->kirkwood_buff.pairs == 0 || inversion->joint)
        return STATUS_OK;
    TRY(mf_inversion_rows_reduce(&inversion->rows, inversion, 1, false));
    if (inversion->doubt)
        TRY(mf_inversion_rows_reduce(&inversion->doubted, inversion, 1, true));
    inversion->together = (struct inversion_joint){.state = inversion,
                                                   .states = 1,
                                                   .system = inversion->rows.system,
                                                   .doubted = inversion->doubted.system};
    inversion->joint = &inversion->together;
    return STATUS_OK;
}

enum status mf_inversion_advance(struct inversion *inversion, struct inverse_step *step) {
    struct inversion_progress *progress = &inversion->progress;
    double own[INVERSION_OWN_COLUMNS] = {0};
    bool kept, converged;
    const struct inversion_rule *rule = inversion->method->own;
    inversion->has_other = inversion->settling = false;
    TRY(join_integrals(inversion));
    TRY(rule->update(inversion, own));
    mf_inversion_trail_add(&inversion->trail, inversion->replicas.counts.mean,
                           inversion->target_counts);
    TRY(judge(inversion, &kept));
    converged = mf_inversion_has_converged(inversion, kept && !inversion->unsettled);
    if (converged)
        TRY(mf_inversion_take_last_step(inversion));
    describe(inversion, own, converged, step);
    if (!step->finished)
        TRY(go_on(inversion, kept));
    progress->iteration++;
    return STATUS_OK;
}

enum status mf_inversion_iterate(void *memory, struct inverse_step *step,
                                 const struct inverse_listener *listener) {
    TRY(mf_inversion_observe(memory, listener));
    return mf_inversion_advance(memory, step);
}
