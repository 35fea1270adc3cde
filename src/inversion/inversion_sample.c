// SPDX-License-Identifier: GPL-3.0-or-later
//
// The samples of a state in an iteration: until they have settled and are exact enough.
#include "base/spent.h"
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// Samples are doubled until their noise is this share of what is off, each bin in units of its
/// error, or as small as was asked for: pairs that are rare, of which little is known, then do
/// not decide how many samples the others need.
static const double noise_share = 0.5;

/// A gradient below this many times its noise is hardly more than that: what g is still off is out
/// of reach of the coefficients.
static const double gradient_of_noise = 2;

/// Samples of an iteration double at most so often.
enum { MAX_DOUBLINGS = 9 };

/// Replicas that begin from disorder are equilibrated so many times as long.
enum { DISORDER_EQUILIBRATION = 2 };

/// Sweeps of one potential, over those of its first samples, after which it is given up if it has
/// not settled: in any case, and beside one to go back to, if all before it took no more.
enum { MAX_TIMES = 600, MIN_TIMES = 16 };

/// Independent samples after which replicas that go on with another potential have forgotten the
/// one before: its effect falls as exp(−2 t/memory), to 3e-4; and after which a twentieth of a step
/// is left, with which a fit still ends.
enum { FORGETTING = 4 };
static const double least_forgetting = 1.5;

/// The equilibration of replicas: that of the parameters, so many times, if they begin from
/// disorder or their memory is not known; less if they forget sooner, and more if they remember
/// longer.
static int64_t equilibration_of(const struct inversion_state *state, int64_t stretch,
                                bool scatter) {
    const int64_t most = state->parameters->equilibration * stretch;
    const double memory = state->work.memory;
    if (scatter)
        return most * DISORDER_EQUILIBRATION;
    return memory > 0 ? (int64_t)ceil(fmax(least_forgetting * memory,
                                           fmin((double)most, FORGETTING * memory)))
                      : most;
}

/// The sweeps and least samples of an iteration, with so many times the equilibration and the
/// least spacing.
static struct replicas_plan plan(const struct inversion *inversion,
                                 const struct inversion_state *state, int64_t stretch) {
    const struct inversion_parameters *p = &inversion->parameters;
    const bool scatter = inversion->course.progress.from_disorder;
    return (struct replicas_plan){.scatter = scatter,
                                  .equilibration = equilibration_of(state, stretch, scatter),
                                  .block_samples = (p->samples - 1) / REPLICAS_BLOCKS + 1,
                                  .every = p->every * stretch};
}

/// Noise up to this share of the error of a section does for a step. 0, so that the samples must be
/// as exact as was asked for, where there is no error left to step against: it is noise itself, or
/// out of reach of the coefficients.
static double find_share(const struct inversion_state *state,
                         const struct inversion_section *section) {
    const bool reached = state->gradient < gradient_of_noise;
    return reached || inversion_section_agrees(section) ? 0 : noise_share;
}

/// Of two errors the one that is farther from what it is to be.
static struct inverse_doubling noisier(struct inverse_doubling a, struct inverse_doubling b) {
    return b.noise * a.wanted > a.noise * b.wanted ? b : a;
}

/// The error that is farthest from what the samples are to make it: as small as was asked for, or a
/// small part of what is off.
static struct inverse_doubling find_noisiest(const struct inversion_state *state, int doublings) {
    struct inverse_doubling noisiest =
        noisier(mf_inversion_kirkwood_buff_noise(state), mf_inversion_bulk_noise(state, doublings));
    for (int k = 0; k < state->assessment.sections; k++) {
        const struct inversion_section *section = &state->assessment.section[k];
        const double noises = sqrt(section->misfit / section->own_misfit);
        const double wanted =
            fmax(section->precision, find_share(state, section) * noises * section->own_noise);
        noisiest = noisier(
            noisiest,
            (struct inverse_doubling){.noise = section->own_noise, .wanted = wanted, .unit = ""});
    }
    return noisiest;
}

/// The samples of an iteration as they are taken.
struct sampling {
    const struct inversion *inversion;
    struct inversion_state *state;
    const struct inverse_listener *listener;
    struct replicas_plan plan;
    struct inverse_progress progress;
    uint64_t sweeps;                        ///< of each replica
    uint64_t waited;                        ///< those of them that were to settle
    double spent_before;                    ///< on samples, without these [s]
    int failures;                           ///< times that something drifted
    struct target_distance before[TARGETS]; ///< of the samples before, if there were any
};

/// Whether what has not settled hardly changes a section: against what is off there, or its noise.
static bool section_hardly_drifts(const struct inversion_state *state,
                                  const struct inversion_section *section) {
    double squares = 0, seen = 0;
    for (size_t a = section->known; a < section->known + section->known_count; a++) {
        const size_t bin = state->grid.known_bin[a];
        if (state->grid.seen[a])
            squares += mf_inversion_equilibrium_shift(&state->replicas, bin) / state->variance[a];
        seen += state->grid.seen[a];
    }
    return squares < seen * fmax(1, section->misfit) * noise_share * noise_share;
}

bool mf_inversion_is_far_beyond_drift(const struct inversion_state *state) {
    bool is_off = false;
    if (state->basis.count > 0) // what is off may be out of reach of the gradient
        return false;
    for (int k = 0; k < state->assessment.sections; k++) {
        const struct inversion_section *section = &state->assessment.section[k];
        if (!section_hardly_drifts(state, section))
            return false;
        is_off = is_off || find_share(state, section) > 0;
    }
    if (!is_off)
        return false;
    return !mf_inversion_bulk_is_asked(state) ||
           mf_inversion_bulk_shift(state) < noise_share * fabs(mf_inversion_bulk_missing(state));
}

/// Whether there is a potential to go back to.
static bool has_kept(const struct inversion *inversion) {
    return isfinite(inversion->course.progress.best.distance[TARGET_RDF].rms);
}

/// Whether these may be the last samples: nothing is left to step against.
static bool may_be_last(const struct sampling *sampling) {
    const struct inversion_state *state = sampling->state;
    for (int k = 0; k < state->assessment.sections; k++)
        if (find_share(state, &state->assessment.section[k]) > 0)
            return false;
    return mf_inversion_may_end(sampling->inversion);
}

/// Whether samples must settle before a step is made of them. Where sizes of molecules alone
/// remember, while g(r), lengths and angles do not, they are no worse than their replicas' scatter
/// says, and do for a step; not for the last one.
static bool waits(const struct sampling *sampling) {
    const struct inversion_state *state = sampling->state;
    const struct inversion_unequilibrated *unequilibrated = &state->assessment.unequilibrated;
    return unequilibrated->found && !mf_inversion_is_far_beyond_drift(state) &&
           (unequilibrated->beside_sizes || may_be_last(sampling));
}

/// Whether samples that have not settled have cost too much. A step may lead to where nothing
/// settles, as into two phases: half of it is tried when to wait has cost as much as all before it,
/// so that where each potential is slow, the next one may cost twice that.
static bool has_cost_enough(const struct sampling *sampling, uint64_t first) {
    const struct inversion_state *state = sampling->state;
    const uint64_t before = state->work.sweeps / (uint64_t)state->parameters->replicas;
    const uint64_t least = MIN_TIMES * first;
    return sampling->sweeps > MAX_TIMES * first ||
           (has_kept(sampling->inversion) && !may_be_last(sampling) &&
            sampling->waited > (before > least ? before : least));
}

/// Whether samples that have not settled are given up: they have cost enough, or each more takes
/// them farther from the targets, and they could not be kept, or there is another start. Of several
/// states only all together are kept or not.
static bool is_hopeless(struct sampling *sampling) {
    const struct inversion *inversion = sampling->inversion;
    const struct targets *targets = &sampling->state->problem->targets;
    struct inversion_assessment *assessment = &sampling->state->assessment;
    const struct replicas_plan min = plan(inversion, sampling->state, 1);
    const int64_t settling = min.equilibration < sampling->state->parameters->equilibration
                                 ? min.equilibration
                                 : sampling->state->parameters->equilibration;
    const uint64_t first = replicas_plan_sweeps(&min) + (uint64_t)settling;
    const bool farther = sampling->before[TARGET_RDF].count > 0 &&
                         mf_inversion_assessment_noises(assessment, targets, assessment->distance) >
                             mf_inversion_assessment_noises(assessment, targets, sampling->before);
    const bool other = mf_inversion_start_has_other(inversion, sampling->state);
    const bool lost =
        other || (inversion->states == 1 && !mf_inversion_is_worth_keeping(inversion, assessment));
    const bool worse = sampling->state->basis.count == 0 && farther && lost;
    assessment->unequilibrated.for_long = has_cost_enough(sampling, first);
    memcpy(sampling->before, assessment->distance, sizeof sampling->before);
    return assessment->unequilibrated.for_long || worse;
}

/// Whether samples that were given up do for a step: their replicas only remember, and scatter by
/// it; none of them drifts, and halves that began apart have met. Not one time after the other.
static bool does_for_step(const struct sampling *sampling) {
    const struct inversion_unequilibrated *unequilibrated =
        &sampling->state->assessment.unequilibrated;
    return unequilibrated->for_long && !unequilibrated->drifts && !unequilibrated->apart &&
           !sampling->inversion->course.progress.gave_up;
}

/// Whether samples may be longer for A alone.
static bool may_refine(const struct sampling *sampling) {
    return sampling->sweeps < sampling->inversion->course.progress.refine_sweeps &&
           may_be_last(sampling);
}

/// Whether more samples help. Replicas that are stuck would never be distinguished from noise.
static bool needs_samples(struct sampling *sampling) {
    struct inverse_doubling *doubling = &sampling->progress.doubling;
    const int before = doubling->number;
    *doubling = find_noisiest(sampling->state, before);
    if (may_refine(sampling))
        *doubling = noisier(*doubling, mf_inversion_band_noise(sampling->state));
    doubling->number = before + 1;
    doubling->max = MAX_DOUBLINGS;
    return doubling->noise > doubling->wanted && before < MAX_DOUBLINGS;
}

/// Take samples by the plan, all of them or as many again.
static enum status take(struct sampling *sampling, bool again) {
    struct inversion_state *state = sampling->state;
    struct replicas_plan *now = &sampling->plan;
    const struct inverse_listener *listener = sampling->listener;
    const int threads = inverse_problem_threads(state->problem);
    if (again) {
        listener->report(listener->context, &sampling->progress); // it takes as long as all before
        TRY(mf_replicas_double(&state->replicas, now, threads, &sampling->progress, listener));
        sampling->sweeps += replicas_plan_sweeps(now) / 2;
    } else {
        mf_spent_lose(mf_spent().seconds[SPENT_SAMPLES] - sampling->spent_before);
        state->work.mixed = state->work.mixed && !now->scatter;
        TRY(mf_replicas_run(&state->replicas, now, threads, &sampling->progress, listener));
        sampling->sweeps += replicas_plan_sweeps(now) + (uint64_t)now->equilibration;
    }
    TRY(mf_inversion_equilibrium_check(state, &state->assessment.unequilibrated));
    mf_inversion_assess(state);
    mf_inversion_bulk_measure(state);
    mf_inversion_equilibrium_reset(state);
    return STATUS_OK;
}

/// As many sweeps again: between the samples, where they are more than are independent, else by
/// more of them.
static void lengthen(struct sampling *sampling) {
    if (sampling->state->inefficiency >= 2)
        sampling->plan.every *= 2;
    else
        sampling->plan.block_samples *= 2;
}

/// Samples that drift, or whose halves are apart, were equilibration, and are taken again; those
/// that only still remember their first configurations are too few, and doubled.
static enum status settle(struct sampling *sampling) {
    struct inversion_assessment *assessment = &sampling->state->assessment;
    struct replicas_plan *now = &sampling->plan;
    const bool early = assessment->unequilibrated.drifts || assessment->unequilibrated.apart;
    if (!early || sampling->failures++ > 0)
        assessment->stretch *= 2;
    if (!early)
        return take(sampling, true);
    now->scatter = false;
    now->equilibration = sampling->state->parameters->equilibration * assessment->stretch;
    if (sampling->failures > 1)
        lengthen(sampling);
    return take(sampling, false);
}

/// Sample until they have settled and are exact enough, or are given up.
static enum status sample_all(struct sampling *sampling) {
    struct inversion_state *state = sampling->state;
    TRY(take(sampling, false));
    sampling->progress.done = sampling->progress.total = (uint64_t)state->parameters->replicas;
    for (;;) {
        const uint64_t before = sampling->sweeps;
        if (waits(sampling) && is_hopeless(sampling))
            return STATUS_OK;
        if (waits(sampling)) {
            TRY(settle(sampling));
            sampling->waited += sampling->sweeps - before;
        } else if (needs_samples(sampling)) {
            TRY(take(sampling, true));
        } else {
            return STATUS_OK;
        }
    }
}

/// Whether another engine could not sample the potential, while there is one to go back to.
static bool is_unstable(const struct inversion *inversion, enum status status) {
    return status == STATUS_UNSTABLE && has_kept(inversion);
}

enum status mf_inversion_sample(struct inversion *inversion, struct inversion_state *state,
                                const struct inverse_listener *listener) {
    const struct inversion_progress *progress = &inversion->course.progress;
    struct inversion_unequilibrated *unequilibrated = &state->assessment.unequilibrated;
    const uint64_t replicas = (uint64_t)state->parameters->replicas;
    struct sampling sampling = {.inversion = inversion,
                                .state = state,
                                .listener = listener,
                                .spent_before = mf_spent().seconds[SPENT_SAMPLES],
                                .plan = plan(inversion, state, progress->stretch),
                                .progress = {.iteration = progress->iteration,
                                             .iterations = (uint32_t)state->parameters->iterations,
                                             .best = mf_targets_error(&inversion->problem->targets,
                                                                      progress->best.distance),
                                             .min = NAN,
                                             .mean = NAN}};
    state->assessment.stretch = progress->stretch;
    unequilibrated->for_long = false;
    state->open.independent = 0;
    TRY(mf_inversion_tabulate(state));
    state->work.evaluations += replicas;
    const enum status status = sample_all(&sampling);
    const bool unstable = is_unstable(inversion, status);
    TRY(unstable ? STATUS_OK : status);
    unequilibrated->sweeps = sampling.sweeps;
    state->work.memory = state->inefficiency * (double)sampling.plan.every;
    state->assessment.unstable = unstable;
    state->assessment.useless = unstable || (waits(&sampling) && !does_for_step(&sampling));
    state->work.sweeps += replicas * sampling.sweeps;
    return STATUS_OK;
}
