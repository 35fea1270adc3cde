// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether a fit has come to its end.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// The way that is left of the ramp, and of the pressure, in their errors, at which both have
/// settled.
static const double settled_way = 0.5;

/// Iterations since the fit came near its targets that must meet them where C is that of few
/// samples, so that a step goes a part of its way.
enum { LEAST_MET_WITH_GROUPS = 3 };

/// Iterations near the target whose mean is worth more than the last: of fewer the first ones lie
/// on the side that the fit came from. As many samples, less what rounding may take.
static const double enough_near = 2.99;

bool mf_inversion_ends_with_mean(const struct inversion *inversion) {
    const struct inversion_state *first = inversion->state;
    const struct potential_grid *grid = &first->grid;
    const double samples = first->pool.samples;
    double mean = 0, now = 0;
    if (samples <= 0 || samples < enough_near * first->replicas.counts.count ||
        !((const struct inversion_rule *)inversion->method->own)->forgets ||
        targets_ask(&inversion->problem->targets, TARGET_PRESSURE))
        return false;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        const double excess = first->replicas.counts.mean[bin] - first->target.counts[bin];
        mean += pow(first->pool.excess[a], 2) / first->variance[a];
        now += pow(excess, 2) / first->variance[a];
    }
    return mean < now;
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
    for (int k = 0; k < state->verdict.sections; k++)
        if (!mean_meets_section(state, &state->verdict.section[k]))
            return false;
    return true;
}

/// Whether a kind of targets is that of sections.
static bool has_sections(const struct inversion_verdict *verdict, int kind) {
    bool has = false;
    for (int k = 0; k < verdict->sections; k++)
        has = has || verdict->section[k].kind == kind;
    return has;
}

/// Whether the present potential meets all targets as far as their noise lets see: each section by
/// its χ², and the numbers beside them.
static bool present_meets(const struct inversion *inversion) {
    const struct inversion_verdict *verdict = &inversion->verdict;
    if (!inversion_section_agrees(mf_inversion_verdict_worst(verdict)))
        return false;
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(&inversion->problem->targets, kind) && !has_sections(verdict, kind) &&
            verdict->distance[kind].rms > mf_inverse_noise_margin * verdict->distance[kind].noise)
            return false;
    return true;
}

/// Whether the present potential meets the targets, or the mean that the fit would end with, which
/// has less noise and follows a slow fit at a distance; of few coefficients, whether no change of
/// these makes it better.
static bool meets_targets(const struct inversion *inversion) {
    const struct inversion_basis *basis = &inversion->state->basis;
    if (basis->count > 0)
        return basis->miss <= mf_inverse_noise_margin;
    return present_meets(inversion) ||
           (mf_inversion_ends_with_mean(inversion) && mean_meets(inversion->state));
}

/// Whether a method that takes the most probable step must go all of the way that g hardly sees.
static bool must_settle(const struct inversion *inversion) {
    return inversion->course.most_probable && inversion_grid(inversion)->pairs > 0 &&
           !targets_ask(&inversion->problem->targets, TARGET_PRESSURE);
}

/// Whether the sum of the last `count` ways of a number is a part of so many errors.
static bool cancels(double sum, uint32_t count, const struct inversion_band_way *last) {
    return fabs(sum) <= count * settled_way * last->open;
}

/// Whether the ways of the last iterations near the targets, `least` of them or more, cancel but
/// for a part of their errors: each one has the noise of its samples, and what goes on goes on in
/// one direction. Each state has a pressure of its own, and so a sum.
static bool has_settled(const struct inversion *inversion, uint32_t least) {
    const struct inversion_band_ways *last = &inversion->course.band.ways;
    const struct inversion_ways *ways = &inversion->course.progress.ways;
    double ramp = 0, pressure[INVERSE_MOST_STATES] = {0};
    for (uint32_t k = 1; k <= ways->near && k <= INVERSION_MOST_WAYS; k++) {
        const uint32_t place = (ways->near - k) % INVERSION_MOST_WAYS;
        ramp += ways->ramp[place];
        bool settled = k >= least && cancels(ramp, k, &last->ramp);
        for (size_t s = 0; s < inversion->states; s++) {
            pressure[s] += ways->pressure[place][s];
            settled = settled && cancels(pressure[s], k, &last->pressure[s]);
        }
        if (settled)
            return true;
    }
    return false;
}

static void note_ways(const struct inversion *inversion, struct inversion_ways *ways) {
    const struct inversion_band_ways *last = &inversion->course.band.ways;
    const uint32_t place = ways->near % INVERSION_MOST_WAYS;
    ways->ramp[place] = last->ramp.way;
    for (size_t s = 0; s < inversion->states; s++)
        ways->pressure[place][s] = last->pressure[s].way;
    ways->near++;
}

bool mf_inversion_has_converged(struct inversion *inversion, bool kept) {
    struct inversion_ways *ways = &inversion->course.progress.ways;
    if (!kept) // it goes back to the one before
        return false;
    const bool meets = inversion->course.progress.best.precise && meets_targets(inversion);
    if (!meets && !mf_inversion_is_near(inversion))
        ways->near = ways->met = 0;
    else
        note_ways(inversion, ways);
    if (!meets)
        return false;
    ways->met++;
    const struct potential_grid *grid = inversion_grid(inversion);
    const uint32_t least = grid->groups > 0 ? LEAST_MET_WITH_GROUPS : 1;
    if (ways->met == 1 && grid->points > 0)
        memcpy(inversion->course.met_phi, inversion->course.phi, grid->points * sizeof(double));
    if (!must_settle(inversion) || (ways->met >= least && has_settled(inversion, least)))
        return true;
    inversion->course.walked = grid->groups > 0 && ways->met >= INVERSION_MOST_WAYS;
    return inversion->course.walked;
}
