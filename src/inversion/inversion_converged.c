// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether a fit has come to its end.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// The way that is left of the ramp, and of the pressure, in their errors, at which both have
/// settled.
static const double settled_drift = 0.5;

/// A drift in the direction of the one before is that of a way if it is this part of the error.
static const double least_drift = 0.1;

/// Iterations since the fit came near its targets that must meet them where C is that of few
/// samples, so that a step goes a part of its way.
enum { MIN_MET_WITH_GROUPS = 3 };

/// Iterations near the target whose mean is worth more than the last: of fewer the first ones lie
/// on the side that the fit came from. As many samples, less what rounding may take.
static const double enough_near = 2.99;

bool mf_inversion_ends_with_mean(const struct inversion *inversion) {
    const struct inversion_state *first = inversion->state;
    const struct potential_grid *grid = &first->grid;
    const double samples = first->pool.samples;
    double mean = 0, now = 0;
    if (samples <= 0 || samples < enough_near * first->replicas.counts.count ||
        !((const struct inversion_rule *)inversion->method->own)->memoryless ||
        mf_inversion_bulk_is_asked(first))
        return false;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        const double excess = first->replicas.counts.mean[bin] - first->target.counts[bin];
        mean += pow(first->pool.excess[a], 2) / first->variance[a];
        now += pow(excess, 2) / first->variance[a];
    }
    return mean < now;
}

/// Bins of a stretch of a curve; those beside it share half of them.
enum { STRETCH = 6 };

/// Σ x²/σ² of a stretch, and what noise alone exceeds, also that of the samples that the potential
/// follows, with such a chance over all of them.
struct misfit {
    double sum, most;
};

static struct misfit find_misfit(const struct inversion_state *state, const double *excess,
                                 double factor, double chance,
                                 const struct inversion_section *stretch) {
    const struct potential_grid *grid = &state->grid;
    double sum = 0, seen = 0, followed = 0;
    for (size_t a = stretch->known; a < stretch->known + stretch->known_count; a++) {
        const double wanted = state->target.counts[grid->known_bin[a]];
        if (!grid->seen[a])
            continue;
        seen++;
        sum += pow(excess[a] - factor * wanted, 2) / state->variance[a];
        followed += 1 - mf_inversion_target_variance(state, a) / state->variance[a];
    }
    return seen == 0 ? (struct misfit){0, 1}
                     : (struct misfit){sum, (seen + followed) *
                                                mf_inversion_probable(state, stretch, chance)};
}

/// Keep the stretch of a state that is off by most, if one is by more than those before.
static void find_farthest(const struct inversion_state *state, const double *excess, size_t number,
                          struct misfit *worst, struct inversion_stretch *farthest) {
    const struct potential_grid *grid = &state->grid;
    const double chance = mf_inversion_chance * STRETCH / (2.0 * (double)grid->pairs_known);
    for (size_t pair = 0, first = 0; pair < grid->pairs; first += grid->known_of[pair++]) {
        const size_t last = first + grid->known_of[pair];
        const double factor = mf_inversion_factor_of(state, pair).missing;
        for (size_t a = first; a < last; a += STRETCH / 2) {
            struct inversion_section stretch = state->assessment.section[0];
            stretch.known = a;
            stretch.known_count = last - a < STRETCH ? last - a : STRETCH;
            const struct misfit own = find_misfit(state, excess, factor, chance, &stretch);
            if (own.sum <= own.most || own.sum * worst->most <= worst->sum * own.most)
                continue;
            *worst = own;
            *farthest =
                (struct inversion_stretch){number, pair, grid->r[grid->known_point[a]],
                                           grid->r[grid->known_point[a + stretch.known_count - 1]]};
        }
    }
}

bool mf_inversion_find_stretch(const struct inversion *inversion,
                               struct inversion_stretch *farthest) {
    const bool mean = mf_inversion_ends_with_mean(inversion);
    struct misfit worst = {0, 1};
    for (size_t s = 0; s < inversion->states; s++) {
        const struct inversion_state *state = &inversion->state[s];
        find_farthest(state, mean ? state->pool.excess : state->excess, s, &worst, farthest);
    }
    return worst.sum > 0;
}

/// Whether that mean meets the targets of a section.
static bool mean_meets_section(const struct inversion_state *state,
                               const struct inversion_section *section) {
    const size_t end = section->known + section->known_count;
    double bins = 0;
    for (size_t a = section->known; a < end; a++)
        bins += state->grid.seen[a];
    return mf_inversion_chi_squared(state, state->pool.excess, section->known, end) <=
           section->probable * bins;
}

/// Whether that mean meets the targets of all sections.
static bool mean_meets(const struct inversion_state *state) {
    for (int k = 0; k < state->assessment.sections; k++)
        if (!mean_meets_section(state, &state->assessment.section[k]))
            return false;
    return true;
}

/// Whether a kind of targets is that of sections.
static bool has_sections(const struct inversion_assessment *assessment, int kind) {
    bool has = false;
    for (int k = 0; k < assessment->sections; k++)
        has = has || assessment->section[k].kind == kind;
    return has;
}

/// Whether the present potential meets all targets as far as their noise lets see: each section by
/// its χ², and the numbers beside them.
static bool present_meets(const struct inversion *inversion) {
    const struct inversion_assessment *assessment = &inversion->assessment;
    if (!inversion_section_agrees(mf_inversion_assessment_worst(assessment)))
        return false;
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(&inversion->problem->targets, kind) && !has_sections(assessment, kind) &&
            assessment->distance[kind].rms >
                mf_inverse_noise_margin * assessment->distance[kind].noise)
            return false;
    return true;
}

/// Whether the present potential meets the targets, or the mean that the fit would end with, which
/// has less noise and follows a slow fit at a distance; of few coefficients, whether no change of
/// these makes it better.
static bool meets_targets(const struct inversion *inversion) {
    const struct inversion_basis *basis = &inversion->state->basis;
    struct inversion_stretch off;
    if (basis->count > 0)
        return basis->miss <= mf_inverse_noise_margin;
    return (present_meets(inversion) ||
            (mf_inversion_ends_with_mean(inversion) && mean_meets(inversion->state))) &&
           !mf_inversion_find_stretch(inversion, &off);
}

/// Whether a method that takes the most probable step must go all of the way that g hardly sees.
static bool must_settle(const struct inversion *inversion) {
    return inversion->course.most_probable && inversion_grid(inversion)->pairs > 0 &&
           !mf_inversion_bulk_is_asked(inversion->state);
}

/// Whether the sum of the last `count` drifts of a number is a part of so many errors.
static bool cancels(double sum, uint32_t count, const struct inversion_band_drift *last) {
    return fabs(sum) <= count * settled_drift * last->open;
}

uint32_t mf_inversion_least_met(const struct inversion *inversion) {
    return inversion_grid(inversion)->groups > 0 ? MIN_MET_WITH_GROUPS : 1;
}

bool mf_inversion_may_end(const struct inversion *inversion) {
    return ((const struct inversion_rule *)inversion->method->own)->memoryless ||
           inversion_grid(inversion)->pairs == 0 || inversion->state->basis.count > 0 ||
           mf_inversion_bulk_is_asked(inversion->state) ||
           inversion->course.progress.drifts.met + 1 >= mf_inversion_least_met(inversion);
}

/// Whether the drifts of the last iterations near the targets, `min` of them or more, cancel but
/// for a part of their errors: each one has the noise of its samples, and what goes on goes on in
/// one direction. Each state has a pressure of its own, and so a sum.
static bool has_settled(const struct inversion *inversion, uint32_t min) {
    const struct inversion_band_drifts *last = &inversion->course.band.drifts;
    const struct inversion_drifts *drifts = &inversion->course.progress.drifts;
    double ramp = 0, bulk[INVERSE_MAX_STATES] = {0};
    for (uint32_t k = 1; k <= drifts->near && k <= INVERSION_MAX_DRIFTS; k++) {
        const uint32_t place = (drifts->near - k) % INVERSION_MAX_DRIFTS;
        ramp += drifts->ramp[place];
        bool settled = k >= min && cancels(ramp, k, &last->ramp);
        for (size_t s = 0; s < inversion->states; s++) {
            bulk[s] += drifts->bulk[place][s];
            settled = settled && cancels(bulk[s], k, &last->bulk[s]);
        }
        if (settled)
            return true;
    }
    return false;
}

/// Whether two drifts keep one direction, as a way does, and of noise every second pair.
static bool keeps_direction(double last, double before, double open) {
    return last * before > 0 && fabs(last) > least_drift * open;
}

/// Whether the last two drifts near the targets keep one direction.
static bool is_on_its_way(const struct inversion *inversion) {
    const struct inversion_band_drifts *last = &inversion->course.band.drifts;
    const struct inversion_drifts *drifts = &inversion->course.progress.drifts;
    if (drifts->near < 2 || !must_settle(inversion))
        return false;
    const uint32_t now = (drifts->near - 1) % INVERSION_MAX_DRIFTS,
                   before = (drifts->near - 2) % INVERSION_MAX_DRIFTS;
    bool keeps = keeps_direction(drifts->ramp[now], drifts->ramp[before], last->ramp.open);
    for (size_t s = 0; s < inversion->states; s++)
        keeps = keeps ||
                keeps_direction(drifts->bulk[now][s], drifts->bulk[before][s], last->bulk[s].open);
    return keeps;
}

static void record_drifts(const struct inversion *inversion, struct inversion_drifts *drifts) {
    const struct inversion_band_drifts *last = &inversion->course.band.drifts;
    const uint32_t place = drifts->near % INVERSION_MAX_DRIFTS;
    drifts->ramp[place] = last->ramp.drift;
    for (size_t s = 0; s < inversion->states; s++)
        drifts->bulk[place][s] = last->bulk[s].drift;
    drifts->near++;
}

/// Whether the samples leave A, and the pressure, no less known than all else does, or are longer
/// for that already; else the next ones are, if there are any.
static bool is_known(struct inversion *inversion) {
    struct inversion_progress *progress = &inversion->course.progress;
    const struct inversion_state *first = inversion->state;
    const bool last = progress->iteration + 1 >= inversion->parameters.iterations;
    const bool known = progress->refine_sweeps > 0 || last || !mf_inversion_band_is_noisy(first);
    if (!known)
        progress->refine_sweeps = first->work.sweeps / first->replicas.count;
    return known;
}

bool mf_inversion_has_converged(struct inversion *inversion, bool kept) {
    struct inversion_progress *const progress = &inversion->course.progress;
    struct inversion_drifts *drifts = &progress->drifts;
    progress->on_its_way = false;
    if (!kept) // it goes back to the one before
        return false;
    const bool meets = progress->best.precise && meets_targets(inversion);
    const bool unsettled = inversion->assessment.unequilibrated.found;
    if (unsettled && !meets)
        return false;
    if (!meets && !mf_inversion_is_near(inversion))
        drifts->near = drifts->met = 0;
    else
        record_drifts(inversion, drifts);
    progress->on_its_way = is_on_its_way(inversion);
    if (!meets)
        return false;
    drifts->met++;
    const uint32_t min = mf_inversion_least_met(inversion);
    const bool settled = drifts->met >= min && has_settled(inversion, min);
    return !unsettled &&
           (!must_settle(inversion) || (settled && !progress->on_its_way && is_known(inversion)));
}
