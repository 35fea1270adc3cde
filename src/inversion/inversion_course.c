// SPDX-License-Identifier: GPL-3.0-or-later
//
// What of the potentials of an inversion is kept, and where it goes on from there.
#include "inversion/inversion.h"
#include "inversion/inversion_states.h"

#include <math.h>
#include <string.h>

const double mf_inversion_min_damping = 1.0 / 64;

enum status mf_inversion_course_init(struct inversion_course *course, size_t known, size_t points,
                                     size_t bins) {
    enum status status = STATUS_OK;
    NEW_ARRAY(course->phi, points);
    NEW_ARRAY(course->step, points);
    NEW_ARRAY(course->other_step, points);
    NEW_ARRAY(course->reference, points);
    NEW_ARRAY(course->best.phi, points);
    NEW_ARRAY(course->best.step, points);
    NEW_ARRAY(course->best.other_step, points);
    NEW_ARRAY(course->best.counts, bins);
    CHECK(mf_inversion_band_init(&course->band, known, points));
    course->progress = (struct inversion_progress){.from_disorder = true,
                                                   .stretch = 1,
                                                   .damping = 1,
                                                   .chosen_damping = 1,
                                                   .best.distance[TARGET_RDF].rms = INFINITY,
                                                   .min_decrement = INFINITY};
done:
    return status;
}

void mf_inversion_course_clear(struct inversion_course *course) {
    double *arrays[] = {course->phi,         course->step,      course->other_step,
                        course->best.phi,    course->best.step, course->best.other_step,
                        course->best.counts, course->reference};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
    mf_inversion_band_clear(&course->band);
}

size_t mf_inversion_course_spans(struct inversion_course *course, size_t points, size_t bins,
                                 struct memory_span *span) {
    double *curves[] = {course->phi, course->best.phi, course->best.step, course->best.other_step,
                        course->reference};
    size_t n = 0;
    span[n++] = (struct memory_span){&course->progress, sizeof course->progress};
    for (size_t k = 0; k < sizeof curves / sizeof *curves; k++)
        span[n++] = (struct memory_span){curves[k], points * sizeof(double)};
    span[n++] = (struct memory_span){course->best.counts, bins * sizeof(double)};
    return n + mf_inversion_band_spans(&course->band, points, span + n);
}

static void keep_counts(struct inversion *inversion) {
    double *best = inversion->course.best.counts;
    for (size_t s = 0; s < inversion->states; best += inversion->state[s++].bins)
        memcpy(best, inversion->state[s].replicas.counts.mean,
               inversion->state[s].bins * sizeof *best);
}

/// Keep the present potential as the best, with the steps that lead on from it.
static enum status keep(struct inversion *inversion) {
    struct inversion_course *course = &inversion->course;
    const struct inversion_state *first = inversion->state;
    const struct inversion_assessment *assessment = &inversion->assessment;
    struct inversion_best_samples *best = &course->progress.best;
    const size_t bytes = first->grid.points * sizeof(double);
    memcpy(course->best.phi, course->phi, bytes);
    memcpy(course->best.step, course->step, bytes);
    memcpy(course->best.other_step, course->other_step, bytes);
    keep_counts(inversion);
    course->progress.has_other = course->has_other;
    memcpy(best->distance, assessment->distance, sizeof best->distance);
    best->own_noise = assessment->own_noise;
    for (size_t s = 0; s < inversion->states; s++)
        best->noise[s] = mf_targets_noise(&inversion->state[s].problem->targets,
                                          inversion->state[s].assessment.distance);
    best->precise = mf_inversion_assessment_is_precise(assessment);
    best->worst = *mf_inversion_assessment_worst(assessment);
    mf_inversion_find_factor(first, &best->factor);
    return mf_inversion_band_find(inversion);
}

/// Which part of the way from the best to the present samples is nearest to the targets of all
/// states, each bin in its noise, if S changes evenly along it.
static double find_nearest_part(const struct inversion *inversion) {
    const double *best = inversion->course.best.counts;
    double along = 0, squares = 0;
    for (size_t s = 0; s < inversion->states; best += inversion->state[s++].bins) {
        const struct inversion_state *state = &inversion->state[s];
        for (size_t a = 0; a < state->grid.known; a++) {
            const size_t bin = state->grid.known_bin[a];
            const double change = state->replicas.counts.mean[bin] - best[bin];
            if (!state->grid.seen[a])
                continue;
            along += change * (state->target.counts[bin] - best[bin]) / state->variance[a];
            squares += change * change / state->variance[a];
        }
    }
    return squares > 0 ? along / squares : 0;
}

/// Go back to the best, for its other step if it has one, or for a part of its step: that of which
/// the samples tell, half at most and an eighth at least.
static void go_back(struct inversion *inversion) {
    struct inversion_course *course = &inversion->course;
    if (!course->progress.has_other) {
        course->progress.damping *= inversion->assessment.unstable
                                        ? 0.5
                                        : fmin(0.5, fmax(0.125, find_nearest_part(inversion)));
        return;
    }
    memcpy(course->best.step, course->best.other_step,
           inversion_grid(inversion)->points * sizeof(double));
    course->progress.newton_failed_error = course->progress.best.distance[TARGET_RDF].rms;
    course->progress.has_other = false;
    course->progress.damping = 1;
}

/// S_rel is convex: its Newton steps promise less and less, unless one was too long.
static bool keeps_by_gradient(struct inversion *inversion) {
    const struct inversion_basis *basis = &inversion->state->basis;
    double *min = &inversion->course.progress.min_decrement;
    const bool kept = basis->decrement <= 2 * *min + 8 * basis->chance;
    *min = fmin(*min, basis->decrement);
    return kept;
}

bool mf_inversion_is_worth_keeping(const struct inversion *inversion,
                                   const struct inversion_assessment *assessment) {
    const struct inversion_progress *progress = &inversion->course.progress;
    const struct targets *targets = &inversion->problem->targets;
    return isinf(progress->best.distance[TARGET_RDF].rms) ||
           mf_inversion_assessment_noises(assessment, targets, assessment->distance) <=
               mf_inversion_assessment_noises(assessment, targets, progress->min) + 2;
}

/// Whether the present potential is so near to the best one that its samples tell what those of the
/// best should have been, and did not: a small part of a step changes S by more than twice that
/// part of what was off, and their noise. What is slow had not settled there.
static bool belies_best(const struct inversion *inversion) {
    static const double small = 0.125, times = 2;
    const double *best = inversion->course.best.counts;
    const double damping = inversion->course.progress.damping;
    double changed = 0, off = 0, noise = 0;
    if (!(damping <= small) || inversion->course.progress.has_other)
        return false;
    for (size_t s = 0; s < inversion->states; best += inversion->state[s++].bins) {
        const struct inversion_state *state = &inversion->state[s];
        for (size_t a = 0; a < state->grid.known; a++) {
            const size_t bin = state->grid.known_bin[a];
            if (!state->grid.seen[a])
                continue;
            changed += pow(state->replicas.counts.mean[bin] - best[bin], 2) / state->variance[a];
            off += pow(state->target.counts[bin] - best[bin], 2) / state->variance[a];
            noise += 2; // that of both samples at most
        }
    }
    return changed > times * times * (damping * damping * off + noise);
}

bool mf_inversion_keeps(struct inversion *inversion) {
    struct inversion_progress *progress = &inversion->course.progress;
    const struct inversion_assessment *assessment = &inversion->assessment;
    const struct targets *targets = &inversion->problem->targets;
    if (inversion->state->basis.count > 0)
        return keeps_by_gradient(inversion);
    const bool kept = mf_inversion_is_worth_keeping(inversion, assessment);
    const bool belied = !kept && belies_best(inversion);
    if (belied)
        progress->damping = 1;
    if (belied || isinf(progress->best.distance[TARGET_RDF].rms) ||
        mf_inversion_assessment_noises(assessment, targets, assessment->distance) <
            mf_inversion_assessment_noises(assessment, targets, progress->min))
        memcpy(progress->min, assessment->distance, sizeof progress->min);
    return kept || belied;
}

/// Keep the other start if it is nearer; else go on from the first.
static enum status accept_trial(struct inversion *inversion, bool *kept) {
    struct inversion_progress *progress = &inversion->course.progress;
    const struct inversion_assessment *assessment = &inversion->assessment;
    const struct targets *targets = &inversion->problem->targets;
    const bool first = isinf(progress->best.distance[TARGET_RDF].rms);
    *kept = !assessment->useless &&
            (first || mf_inversion_assessment_noises(assessment, targets, assessment->distance) <
                          mf_inversion_assessment_noises(assessment, targets, progress->min));
    progress->trial = false;
    progress->from_disorder = !*kept;
    progress->gave_up = assessment->unequilibrated.found && assessment->unequilibrated.for_long;
    progress->lost = first && !*kept;
    progress->from_forces = progress->from_forces && !*kept;
    if (!*kept)
        return first ? keep(inversion) : STATUS_OK; // to have something to show
    progress->first_error = progress->second_error = progress->newton_failed_error =
        assessment->distance[TARGET_RDF].rms;
    memcpy(progress->min, assessment->distance, sizeof progress->min);
    return keep(inversion);
}

/// Whether the second start, as sampled now, is much farther from the targets than the first was,
/// which was left as its samples had not settled, or as the first step from it was too long.
static bool is_farther_than_first(const struct inversion *inversion) {
    static const double times = 4;
    const double first = inversion->course.progress.first_start;
    return first > 0 && mf_targets_error(&inversion->problem->targets,
                                         inversion->assessment.distance) > times * first;
}

enum status mf_inversion_course_accept(struct inversion *inversion, bool *kept) {
    struct inversion_progress *progress = &inversion->course.progress;
    const struct inversion_assessment *assessment = &inversion->assessment;
    const bool start = isinf(progress->best.distance[TARGET_RDF].rms);
    if (progress->trial)
        return accept_trial(inversion, kept);
    const double error = assessment->distance[TARGET_RDF].rms;
    *kept = !assessment->useless && mf_inversion_keeps(inversion);
    progress->from_disorder = !*kept;
    progress->gave_up = assessment->unequilibrated.found && assessment->unequilibrated.for_long;
    progress->lost = start && !*kept && !mf_inversion_start_has_trial(inversion, false) &&
                     !mf_inversion_start_is_poor(inversion, false) &&
                     !is_farther_than_first(inversion);
    if (start && !*kept)
        return keep(inversion); // to have something to show
    if (start)
        progress->first_error = progress->second_error = progress->newton_failed_error = error;
    else if (progress->second_error == progress->first_error)
        progress->second_error = error;
    if (!*kept) {
        go_back(inversion);
        return STATUS_OK;
    }
    if (!start)
        mf_inversion_relax(inversion);
    progress->stretch = assessment->stretch > 1 ? assessment->stretch / 2 : 1;
    return keep(inversion);
}

/// From another start.
static enum status begin_again(struct inversion *inversion,
                               enum status (*start)(struct inversion_state *, double *)) {
    struct inversion_progress *progress = &inversion->course.progress;
    const size_t widest = mf_inversion_states_widest(inversion->state, inversion->states);
    progress->best.distance[TARGET_RDF].rms = progress->min_decrement = INFINITY;
    progress->damping = 1;
    progress->from_disorder = progress->second_start = true;
    progress->drifts = (struct inversion_drifts){0};
    return start(&inversion->state[widest], inversion->course.phi);
}

enum status mf_inversion_course_go_on(struct inversion *inversion, bool kept) {
    struct inversion_progress *progress = &inversion->course.progress;
    if (mf_inversion_start_has_trial(inversion, kept)) {
        if (!kept)
            progress->best.distance[TARGET_RDF].rms = progress->min_decrement = INFINITY;
        mf_inversion_start_try(inversion);
        return STATUS_OK;
    }
    const bool farther = is_farther_than_first(inversion);
    progress->first_start = 0;
    if (farther)
        return begin_again(inversion, mf_inversion_start);
    if (!mf_inversion_start_is_poor(inversion, kept)) {
        mf_inversion_take_step(inversion);
        return STATUS_OK;
    }
    progress->first_start = mf_targets_error(&inversion->problem->targets, progress->best.distance);
    return begin_again(inversion, mf_inversion_start_again);
}
