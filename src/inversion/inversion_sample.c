// SPDX-License-Identifier: GPL-3.0-or-later
//
// The samples of an iteration: until they have settled and are exact enough.
#include "inversion/inversion.h"

#include <math.h>

/// Samples are doubled until their noise is this share of the error, or as small as was asked for.
static const double noise_share = 1.0 / 3;

/// A gradient below this many times its noise is hardly more than that: what g is still off is out
/// of reach of the coefficients.
static const double gradient_of_noise = 2;

/// Samples of an iteration double at most so often.
enum { MOST_DOUBLINGS = 7 };

/// Replicas that are placed anew are equilibrated so many times as long.
enum { ANEW_EQUILIBRATION = 5 };

/// Sweeps of one potential, over those of its first samples, after which it is given up if it has
/// not settled; and a start beside which there is another. Lennard-Jones at 1.5 ε condenses under
/// the hypernetted chain's start, and had taken 270 times the first samples to do so.
enum { MOST_TIMES = 200, MOST_TIMES_OF_START = 10 };

/// The sweeps and least samples of an iteration, with so many times the least equilibration and
/// spacing.
static struct replicas_plan plan(const struct inversion *inversion, int64_t stretch) {
    const struct inversion_parameters *p = &inversion->settings.common;
    const bool anew = inversion->progress.anew;
    return (struct replicas_plan){.scatter = anew,
                                  .equilibration =
                                      p->equilibration * (anew ? ANEW_EQUILIBRATION : 1) * stretch,
                                  .block_samples = (p->samples - 1) / REPLICAS_BLOCKS + 1,
                                  .every = p->every * stretch};
}

/// The error that is farthest from what the samples are to make it: as small as was asked for, or a
/// small part of what is off.
static struct inverse_doubling find_noisiest(const struct inversion *inversion) {
    // What is out of reach, or noise itself, is no error that hides the noise.
    const bool reached = inversion->progress.miss < gradient_of_noise;
    struct inverse_doubling noisiest = mf_inversion_kirkwood_buff_noise(inversion);
    for (int k = 0; k < inversion->sections; k++) {
        const struct inversion_section *section = &inversion->section[k];
        const double share = reached || inversion_section_agrees(section) ? 0 : noise_share;
        const double wanted = fmax(section->precision, share * section->rms);
        if (section->own_noise * noisiest.wanted > noisiest.noise * wanted)
            noisiest = (struct inverse_doubling){
                .noise = section->own_noise, .wanted = wanted, .unit = ""};
    }
    return noisiest;
}

/// Whether more samples help. Replicas that are stuck would never be told apart from noise.
static bool needs_samples(const struct inversion *inversion, struct inverse_doubling *doubling) {
    const int before = doubling->number;
    *doubling = find_noisiest(inversion);
    doubling->number = before + 1;
    doubling->most = MOST_DOUBLINGS;
    return doubling->noise > doubling->wanted && before < MOST_DOUBLINGS;
}

double mf_inversion_count_noises(const struct inversion *inversion,
                                 const struct target_distance distance[TARGETS]) {
    double sum = 0;
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(&inversion->problem->targets, kind) && inversion->distance[kind].noise > 0)
            sum += pow(distance[kind].rms / inversion->distance[kind].noise, 2);
    return sqrt(sum);
}

bool mf_inversion_is_near_enough(const struct inversion *inversion) {
    const struct inversion_progress *progress = &inversion->progress;
    return isinf(progress->best[TARGET_RDF].rms) ||
           mf_inversion_count_noises(inversion, inversion->distance) <=
               mf_inversion_count_noises(inversion, progress->least) + 2;
}

/// The samples of an iteration as they are taken.
struct sampling {
    struct replicas_plan plan;
    struct inverse_progress progress;
    uint64_t sweeps; ///< of each replica
    int failures;    ///< times that something drifted
    double off;      ///< how far the samples before were from their targets, in noises
};

/// Whether samples that have not settled are to be left: they have cost enough, are those of a
/// start that is left anyway, or are too far off to be kept and get farther. What tears a liquid,
/// or freezes it, takes for ever to do so.
static bool is_hopeless(struct inversion *inversion, struct sampling *sampling) {
    const struct replicas_plan least = plan(inversion, 1);
    const uint64_t first = replicas_plan_sweeps(&least) + (uint64_t)least.equilibration;
    const double off = mf_inversion_count_noises(inversion, inversion->distance);
    const bool worse = inversion->basis.count == 0 && !mf_inversion_is_near_enough(inversion) &&
                       off > sampling->off;
    mf_inversion_pressure_measure(inversion);
    const bool poor = mf_inversion_start_is_poor(inversion, true);
    const uint64_t most =
        first * (mf_inversion_start_has_other(inversion) ? MOST_TIMES_OF_START : MOST_TIMES);
    inversion->progress.unsettled.for_long = sampling->sweeps > most;
    sampling->off = off;
    return inversion->progress.unsettled.for_long || worse || poor;
}

/// Take samples by the plan, all of them or as many again.
static enum status take(struct inversion *inversion, struct sampling *sampling, bool again,
                        const struct inverse_listener *listener) {
    struct replicas_plan *now = &sampling->plan;
    const int threads = inversion->problem->threads;
    if (again) {
        listener->tell(listener->context, &sampling->progress); // it takes as long as all before
        TRY(mf_replicas_double(&inversion->replicas, now, threads, &sampling->progress, listener));
        sampling->sweeps += replicas_plan_sweeps(now) / 2;
    } else {
        TRY(mf_replicas_run(&inversion->replicas, now, threads, &sampling->progress, listener));
        sampling->sweeps += replicas_plan_sweeps(now) + (uint64_t)now->equilibration;
    }
    mf_inversion_assess(inversion);
    return mf_inversion_settled_judge(inversion, &inversion->progress.unsettled);
}

/// What drifts was equilibration; what only remembers its begin is too short.
static enum status settle(struct inversion *inversion, struct sampling *sampling,
                          const struct inverse_listener *listener) {
    struct replicas_plan *now = &sampling->plan;
    const bool drifts = inversion->progress.unsettled.drifts;
    if (!drifts || sampling->failures++ > 0)
        inversion->stretch *= 2;
    if (!drifts)
        return take(inversion, sampling, true, listener);
    now->scatter = false;
    now->equilibration = inversion->settings.common.equilibration * inversion->stretch;
    if (sampling->failures > 1)
        now->every *= 2;
    return take(inversion, sampling, false, listener);
}

enum status mf_inversion_sample(struct inversion *inversion,
                                const struct inverse_listener *listener) {
    struct inversion_progress *state = &inversion->progress;
    struct inversion_unsettled *unsettled = &state->unsettled;
    const uint64_t replicas = (uint64_t)inversion->settings.common.replicas;
    struct sampling sampling = {
        .plan = plan(inversion, state->stretch),
        .off = INFINITY,
        .progress = {.iteration = state->iteration,
                     .iterations = (uint32_t)inversion->settings.common.iterations,
                     .best = mf_targets_error(&inversion->problem->targets, state->best),
                     .least = NAN,
                     .mean = NAN}};
    inversion->stretch = state->stretch;
    TRY(mf_inversion_tabulate(inversion));
    state->evaluations += replicas;
    TRY(take(inversion, &sampling, false, listener));
    sampling.progress.done = sampling.progress.total = replicas;
    for (;;) {
        if (unsettled->found && is_hopeless(inversion, &sampling))
            break;
        if (unsettled->found)
            TRY(settle(inversion, &sampling, listener));
        else if (needs_samples(inversion, &sampling.progress.doubling))
            TRY(take(inversion, &sampling, true, listener));
        else
            break;
    }
    unsettled->sweeps = sampling.sweeps;
    inversion->unsettled = unsettled->found;
    state->sweeps += replicas * sampling.sweeps;
    return STATUS_OK;
}
