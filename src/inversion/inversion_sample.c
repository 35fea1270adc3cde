// SPDX-License-Identifier: GPL-3.0-or-later
//
// The samples of an iteration: until they have settled and are exact enough.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

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
/// not settled.
enum { MOST_TIMES = 200 };

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

/// What of a section is off is known well enough for a step if this part of it is uncertain.
/// What is out of reach, or noise itself, is no error that hides the noise.
static double find_share(const struct inversion *inversion,
                         const struct inversion_section *section) {
    const bool reached = inversion->progress.miss < gradient_of_noise;
    return reached || inversion_section_agrees(section) ? 0 : noise_share;
}

/// The error that is farthest from what the samples are to make it: as small as was asked for, or a
/// small part of what is off.
static struct inverse_doubling find_noisiest(const struct inversion *inversion) {
    struct inverse_doubling noisiest = mf_inversion_kirkwood_buff_noise(inversion);
    for (int k = 0; k < inversion->sections; k++) {
        const struct inversion_section *section = &inversion->section[k];
        const double wanted =
            fmax(section->precision, find_share(inversion, section) * section->rms);
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
    uint64_t sweeps;                        ///< of each replica
    int failures;                           ///< times that something drifted
    struct target_distance before[TARGETS]; ///< of the samples before, if there were any
};

/// Whether the section is so far from its targets that what has not settled hardly changes the way
/// to them.
static bool tells_way(const struct inversion *inversion, const struct inversion_section *section) {
    double squares = 0;
    for (size_t a = section->known; a < section->known + section->known_count; a++) {
        const size_t bin = inversion->grid.known_bin[a];
        squares += mf_inversion_settled_shift(&inversion->replicas, bin) /
                   (inversion->unit[bin] * inversion->unit[bin]);
    }
    return sqrt(fmax(squares, 0) / (double)section->bins) <
           section->peak * section->rms * find_share(inversion, section);
}

bool mf_inversion_tells_way(const struct inversion *inversion) {
    const struct targets *targets = &inversion->problem->targets;
    if (inversion->basis.count > 0) // what is off may be out of reach of the gradient
        return false;
    for (int k = 0; k < inversion->sections; k++)
        if (!tells_way(inversion, &inversion->section[k]))
            return false;
    return !targets_ask(targets, TARGET_PRESSURE) ||
           mf_inversion_pressure_shift(inversion) <
               noise_share *
                   fabs(inversion->pressure.value - *targets->target[TARGET_PRESSURE].value);
}

/// Whether samples that have not settled are to be left: they have cost enough, are those of a
/// start that is left anyway, or get farther from the targets though they are too far off to be
/// kept, or those of a start beside which there is another.
static bool is_hopeless(struct inversion *inversion, struct sampling *sampling) {
    const struct replicas_plan least = plan(inversion, 1);
    const uint64_t first = replicas_plan_sweeps(&least) + (uint64_t)least.equilibration;
    const bool farther = sampling->before[TARGET_RDF].count > 0 &&
                         mf_inversion_count_noises(inversion, inversion->distance) >
                             mf_inversion_count_noises(inversion, sampling->before);
    const bool worse =
        inversion->basis.count == 0 && farther &&
        (mf_inversion_start_has_other(inversion) || !mf_inversion_is_near_enough(inversion));
    const bool poor = mf_inversion_start_is_poor(inversion, true);
    inversion->progress.unsettled.for_long = sampling->sweeps > MOST_TIMES * first;
    memcpy(sampling->before, inversion->distance, sizeof sampling->before);
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
    mf_inversion_pressure_measure(inversion);
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
        .progress = {.iteration = state->iteration,
                     .iterations = (uint32_t)inversion->settings.common.iterations,
                     .best = mf_targets_error(&inversion->problem->targets, state->best),
                     .least = NAN,
                     .mean = NAN}};
    inversion->stretch = state->stretch;
    unsettled->for_long = false;
    TRY(mf_inversion_tabulate(inversion));
    state->evaluations += replicas;
    TRY(take(inversion, &sampling, false, listener));
    sampling.progress.done = sampling.progress.total = replicas;
    for (;;) {
        const bool waits = unsettled->found && !mf_inversion_tells_way(inversion);
        if (waits && is_hopeless(inversion, &sampling))
            break;
        if (waits)
            TRY(settle(inversion, &sampling, listener));
        else if (needs_samples(inversion, &sampling.progress.doubling))
            TRY(take(inversion, &sampling, true, listener));
        else
            break;
    }
    unsettled->sweeps = sampling.sweeps;
    inversion->unsettled = unsettled->found;
    inversion->useless = unsettled->found && !mf_inversion_tells_way(inversion);
    state->sweeps += replicas * sampling.sweeps;
    return STATUS_OK;
}
