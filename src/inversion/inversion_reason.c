// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "inversion/inversions.h"
#include "observe/kirkwood_buff.h"

#include <math.h>
#include <stdio.h>

/// The kind of a bonded distribution that is off, or −1.
static int find_missed(const struct inversion *inversion) {
    const struct inversion_section *worst = &inversion->course.progress.best.worst;
    return worst->kind == TARGET_RDF || inversion_section_agrees(worst) ? -1 : worst->kind;
}

/// Why no samples could be used.
static void report_unsettled(const struct inversion_unequilibrated *unequilibrated,
                             char reason[INVERSE_REASON_SIZE]) {
    char what[INVERSE_REASON_SIZE / 2];
    mf_stationary_describe(unequilibrated->quantity, &unequilibrated->is, what, sizeof what);
    snprintf(reason, INVERSE_REASON_SIZE,
             "the samples are not in equilibrium after %llu sweeps of each replica: %.100s. It "
             "may need a longer \"equilibration\", or freeze, cavitate or condense; long "
             "molecules may equilibrate faster with the \"sampler\" \"monte-carlo\"",
             (unsigned long long)unequilibrated->sweeps, what);
}

/// Of a fit of bonded distributions alone, which has no g(r).
static void report_groups(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    snprintf(reason, INVERSE_REASON_SIZE,
             "the distributions agree within a statistical error of %.2g of their peaks, but "
             "\"precision\" is %.2g: more \"samples\" or \"iterations\" are needed",
             inversion->course.progress.best.own_noise, inversion->parameters.precision);
}

/// " of A-W for r from 0.27 to 0.32 nm".
enum { STRETCH_SIZE = 160 };
static void describe_stretch(const struct inversion *inversion,
                             const struct inversion_stretch *stretch, char text[STRETCH_SIZE]) {
    const struct inverse_problem *problem = inversion->state[stretch->state].problem;
    const struct composition *composition = &problem->scene.composition;
    char pair[COMPOSITION_PAIR_NAME_SIZE] = "";
    if (composition_is_mixed(composition))
        mf_composition_pair_name(composition, (int)stretch->pair, pair);
    snprintf(text, STRETCH_SIZE,
             "%s%.30s for r from %.3g" STATUS_LENGTH " to %.3g" STATUS_LENGTH "%s%.30s",
             pair[0] ? " of " : "", pair, stretch->first, stretch->last,
             inversion->states > 1 ? " in the state " : "",
             inversion->states > 1 ? problem->name : "");
}

static void report_stretch(const struct inversion *inversion,
                           const struct inversion_stretch *stretch,
                           char reason[INVERSE_REASON_SIZE]) {
    char place[STRETCH_SIZE];
    describe_stretch(inversion, stretch, place);
    snprintf(reason, INVERSE_REASON_SIZE,
             "g(r) agrees as a whole, but not%s: try more \"iterations\" or \"samples\", and see "
             "whether the errors of the target are right there",
             place);
}

/// Of a fit that meets its targets as exactly as was asked for: what it hardly determines must
/// settle, too.
static void report_way(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    const struct inversion_progress *p = &inversion->course.progress;
    const struct inversion_unequilibrated *unequilibrated = &inversion->assessment.unequilibrated;
    const struct inversion_band_drift *ramp = &inversion->course.band.drifts.ramp;
    const struct inversion_band_drift farthest = mf_inversion_band_farthest(inversion);
    const enum target_kind kind = mf_inversion_bulk_kind(inversion->state);
    const char *name = mf_targets_name((int)kind), *unit = mf_observable_kind(kind).target->unit;
    const uint32_t least = mf_inversion_least_met(inversion);
    char what[INVERSE_REASON_SIZE / 2];
    if (p->from_disorder) {
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the targets were met, but the last step led away from them and was taken back, "
                 "so that nothing shows yet that the potential has settled: more \"iterations\" "
                 "are needed");
    } else if (unequilibrated->found) {
        mf_stationary_describe(unequilibrated->quantity, &unequilibrated->is, what, sizeof what);
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the targets are met, but the last samples have not settled: %.100s: more "
                 "\"iterations\" or a longer \"equilibration\" are needed",
                 what);
    } else if (p->drifts.met > 0 && p->drifts.met < least) {
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the targets are met in %u of the last iterations, and %u must meet them, as each "
                 "step goes but a part of its way: more \"iterations\" are needed",
                 (unsigned)p->drifts.met, (unsigned)least);
    } else
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g(r) agrees, but what it hardly determines has not converged: a ramp "
                 "A (1 - r/cutoff) of the potential still drifts by %.2g" STATUS_ENERGY
                 " (error %.2g" STATUS_ENERGY "), and "
                 "the %s by %.2g" STATUS_UNIT " (error %.2g" STATUS_UNIT
                 ")%s; give \"%s\" as a second target, or more "
                 "\"iterations\"",
                 ramp->drift, ramp->open, name, farthest.drift, unit, farthest.open, unit,
                 p->on_its_way ? ", in one direction for two iterations" : "", name);
}

/// Why a fit whose g(r) agrees has not converged.
static void report_what_is_missing(const struct inversion *inversion,
                                   char reason[INVERSE_REASON_SIZE]) {
    const struct inversion_progress *p = &inversion->course.progress;
    const struct inversion_parameters *settings = &inversion->parameters;
    const enum target_kind kind = mf_inversion_bulk_kind(inversion->state);
    const struct target_distance *bulk = &p->best.distance[kind];
    const char *name = mf_targets_name((int)kind), *unit = mf_observable_kind(kind).target->unit;
    const struct target_distance *integrals = &p->best.distance[mf_kirkwood_buff_kind()];
    const int missed = find_missed(inversion);
    struct inversion_stretch off;
    if (missed >= 0)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the error of %s is %.2g, its statistical error %.2g, and chi^2 per bin is %.2g "
                 "(at most %.2g by noise): try more \"iterations\" or \"samples\"",
                 mf_targets_name(missed), p->best.distance[missed].rms,
                 p->best.distance[missed].noise, p->best.worst.misfit, p->best.worst.probable);
    else if (mf_inversion_bulk_is_asked(inversion->state) &&
             bulk->rms > mf_inverse_noise_margin * bulk->noise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g(r) agrees, but the %s is off by %.3g" STATUS_UNIT
                 " (statistical error %.2g" STATUS_UNIT ")",
                 name, bulk->rms, unit, bulk->noise, unit);
    else if (integrals->rms > mf_inverse_noise_margin * integrals->noise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g(r) agrees, but an integral of target.kirkwood_buff is off by %.3g" STATUS_VOLUME
                 " (statistical "
                 "error %.2g" STATUS_VOLUME
                 "): try more \"iterations\" or \"samples\", or a longer cutoff of the "
                 "potential",
                 integrals->rms, integrals->noise);
    else if (inversion_grid(inversion)->groups > 0 && inversion_grid(inversion)->pairs == 0)
        report_groups(inversion, reason);
    else if (mf_inversion_find_stretch(inversion, &off))
        report_stretch(inversion, &off, reason);
    else if (isnan(inversion->course.band.drifts.ramp.drift))
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "g(r) agrees within %.2g, but its covariance matrix is singular, so that the errors of "
            "the potential are not known: more \"samples\" are needed",
            p->best.own_noise);
    else if (p->best.precise)
        report_way(inversion, reason);
    else
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g(r) agrees within a statistical error of %.2g, but \"precision\" is %.2g: more "
                 "\"samples\" or \"iterations\" are needed",
                 p->best.own_noise, settings->precision);
}

/// The same for potentials made of coefficients, which cannot meet g(r) exactly.
static void report_gradient(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    if (!(inversion->state->gradient <= mf_inverse_noise_margin))
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the gradient of the relative entropy is %.2g times its noise: try "
                 "more \"iterations\" or \"samples\", or fewer \"coefficients\"",
                 inversion->state->gradient);
    else
        report_what_is_missing(inversion, reason);
}

static double square_of(const struct inversion_history *history, uint64_t iteration) {
    const double *excess = history->excess + iteration * history->bins;
    double sum = 0;
    for (size_t bin = 0; bin < history->bins; bin++)
        sum += excess[bin] * excess[bin];
    return sum;
}

/// Whether the second half of the iterations has hardly reduced the excess.
static bool has_stopped(const struct inversion_history *history) {
    static const double much = 0.5;
    return history->iterations < 2 || square_of(history, history->iterations - 1) >
                                          much * square_of(history, (history->iterations - 1) / 2);
}

/// Of a g(r) that is off, where it is by most, if the last samples are those of the best potential.
static void report_misfit(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    const struct inversion_progress *p = &inversion->course.progress;
    const struct target_distance *rdf = &p->best.distance[TARGET_RDF];
    struct inversion_stretch off;
    char place[STRETCH_SIZE] = "";
    const bool known = !p->from_disorder && mf_inversion_find_stretch(inversion, &off);
    if (known)
        describe_stretch(inversion, &off, place);
    snprintf(reason, INVERSE_REASON_SIZE,
             "after %lld iterations the error of g(r) is %.2g (%.2g at first), its statistical "
             "error %.2g, and chi^2 per bin is %.2g (at most %.2g by noise)%s%s%s",
             (long long)inversion->parameters.iterations, rdf->rms, p->first_error, rdf->noise,
             p->best.worst.misfit, p->best.worst.probable, known ? ", most" : "", place,
             inversion->history.iterations > 3 && has_stopped(&inversion->history)
                 ? "; it no longer falls: are density, temperature and types those of the target?"
                 : ": try more \"iterations\"");
}

/// Write the first reason that applies.
void mf_inversion_reason_write(const struct inversion *inversion,
                               char reason[INVERSE_REASON_SIZE]) {
    const struct inversion_progress *p = &inversion->course.progress;
    const struct inversion_unequilibrated *unequilibrated = &inversion->assessment.unequilibrated;
    if (unequilibrated->found && unequilibrated->for_long) {
        report_unsettled(unequilibrated, reason);
        return;
    }
    if (inversion->state->basis.count > 0) {
        report_gradient(inversion, reason);
        return;
    }
    const struct target_distance *rdf = &p->best.distance[TARGET_RDF];
    const bool stuck = p->damping < mf_inversion_min_damping;
    const struct inversion_section *worst = &p->best.worst;
    const bool agrees = worst->kind != TARGET_RDF || inversion_section_agrees(worst);
    static const double max = 3; // prior standard deviations of the factor
    const double improved = rdf->rms / p->first_error;
    const bool explains = worst->rms < mf_inverse_noise_margin * worst->noise;
    if (!agrees && explains && has_stopped(&inversion->history) &&
        fabs(p->best.factor.missing) > max * p->best.factor.prior)
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "g(r) of the target is too %s at all distances by %.2g %%, which no short-ranged "
            "potential gives; the uncertainty by its \"particles\" or \"normalisation\" is "
            "%.2g %%: check these, its density and its cutoff, or give \"pressure\" as a second "
            "target",
            p->best.factor.missing > 0 ? "small" : "large", 100 * fabs(p->best.factor.missing),
            100 * p->best.factor.prior);
    else if (improved > 0.9 && p->second_error > p->first_error + 2 * rdf->noise && !agrees)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the error of g(r) rose from %.2g to %.2g with the first step, and no shorter one "
                 "helped: the start is outside the basin of convergence of \"%s\"; try %sanother "
                 "start, and see what is said of the target first",
                 p->first_error, p->second_error, inversion->method->name,
                 inversion->method == &mf_automatic ? "" : "the method \"auto\" or ");
    else if (agrees)
        report_what_is_missing(inversion, reason);
    else if (stuck)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the step was reduced to 1/%.0f without progress: the error of g(r) is %.2g, its "
                 "statistical error %.2g%s",
                 1 / p->damping, rdf->rms, rdf->noise,
                 composition_is_mixed(&inversion->problem->scene.composition)
                     ? "; with so many pair types try targets with a shorter \"cutoff\""
                     : "");
    else
        report_misfit(inversion, reason);
}
