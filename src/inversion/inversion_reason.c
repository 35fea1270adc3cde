// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "observe/kirkwood_buff_observable.h"

#include <math.h>
#include <stdio.h>

/// The kind of a distribution of groups that is off, or −1.
static int find_missed(const struct inversion *inversion) {
    const struct inversion_section *worst = &inversion->course.progress.best.worst;
    return worst->kind == TARGET_RDF || inversion_section_agrees(worst) ? -1 : worst->kind;
}

/// Why no samples could be made use of.
static void report_unsettled(const struct inversion_unequilibrated *unequilibrated,
                             char reason[INVERSE_REASON_SIZE]) {
    char what[INVERSE_REASON_SIZE / 2];
    mf_stationary_describe(unequilibrated->quantity, &unequilibrated->is, what, sizeof what);
    snprintf(reason, INVERSE_REASON_SIZE,
             "the samples are not in equilibrium after %llu sweeps of each replica: %.100s. The "
             "liquid freezes, tears or condenses, or needs a longer \"equilibration\"; long "
             "molecules may settle sooner with the \"sampler\" \"monte-carlo\"",
             (unsigned long long)unequilibrated->sweeps, what);
}

/// Groups alone have no ramp and no g.
static void report_groups(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    snprintf(reason, INVERSE_REASON_SIZE,
             "the distributions agree within a statistical error of %.2g of their peaks, but "
             "\"precision\" asks for %.2g: more \"samples\" or \"iterations\" are needed",
             inversion->course.progress.best.own_noise, inversion->parameters.precision);
}

/// Why a fit whose g agrees has not converged.
static void report_what_is_missing(const struct inversion *inversion,
                                   char reason[INVERSE_REASON_SIZE]) {
    const struct inversion_progress *p = &inversion->course.progress;
    const struct inversion_parameters *settings = &inversion->parameters;
    const struct target_distance *pressure = &p->best.distance[TARGET_PRESSURE];
    const struct target_distance *integrals = &p->best.distance[mf_kirkwood_buff_kind()];
    const struct inversion_band_drift *ramp = &inversion->course.band.drifts.ramp;
    const struct inversion_band_drift farthest = mf_inversion_band_farthest(inversion);
    const int missed = find_missed(inversion);
    if (missed >= 0)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the error of %s is %.2g, its statistical error %.2g, and chi^2 by bin is %.2g "
                 "where noise makes %.2g at most: more \"iterations\" or \"samples\" may help",
                 mf_targets_name(missed), p->best.distance[missed].rms,
                 p->best.distance[missed].noise, p->best.worst.misfit, p->best.worst.probable);
    else if (targets_ask(&inversion->problem->targets, TARGET_PRESSURE) &&
             pressure->rms > mf_inverse_noise_margin * pressure->noise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g agrees, but the pressure is %.3g off, with an error of %.2g", pressure->rms,
                 pressure->noise);
    else if (integrals->rms > mf_inverse_noise_margin * integrals->noise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g agrees, but an integral of target.kirkwood_buff is %.3g off, with an error of "
                 "%.2g: more \"iterations\" or \"samples\" may help, or a longer cutoff of the "
                 "potential",
                 integrals->rms, integrals->noise);
    else if (inversion_grid(inversion)->groups > 0 && inversion_grid(inversion)->pairs == 0)
        report_groups(inversion, reason);
    else if (isnan(ramp->drift))
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "g agrees within %.2g, but its covariances have no inverse, so that the errors of the "
            "potential are not known: more \"samples\" are needed",
            p->best.own_noise);
    else if (p->best.precise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g agrees, but what it hardly sees has not settled, a ramp A (1 - r/cutoff) of "
                 "the potential and with it the pressure: they went on by %.2g k_B T_0, known "
                 "within %.2g, and by %.2g, known within %.2g; give \"pressure\" as a second "
                 "target, or more \"iterations\"",
                 ramp->drift, ramp->open, farthest.drift, farthest.open);
    else
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "g agrees within a statistical error of %.2g, but \"precision\" asks for %.2g: more "
            "\"samples\" or \"iterations\" are needed",
            p->best.own_noise, settings->precision);
}

/// The same of potentials made of coefficients, which need not meet g.
static void report_gradient(const struct inversion *inversion, char reason[INVERSE_REASON_SIZE]) {
    if (!(inversion->state->gradient <= mf_inverse_noise_margin))
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the gradient of the relative entropy is %.2g times its noise: more "
                 "\"iterations\" or \"samples\", or fewer \"coefficients\", may help",
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

/// Whether the second half of the iterations has not made the excess much smaller.
static bool has_stopped(const struct inversion_history *history) {
    static const double much = 0.5;
    return history->iterations < 2 || square_of(history, history->iterations - 1) >
                                          much * square_of(history, (history->iterations - 1) / 2);
}

/// The first reason that applies.
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
    const struct inversion_parameters *settings = &inversion->parameters;
    const struct target_distance *rdf = &p->best.distance[TARGET_RDF];
    const bool stuck = p->damping < mf_inversion_min_damping;
    const struct inversion_section *worst = &p->best.worst;
    const bool agrees = worst->kind != TARGET_RDF || inversion_section_agrees(worst);
    static const double max = 3; // standard deviations of what was known of a factor
    const double improved = rdf->rms / p->first_error;
    const bool explains = worst->rms < mf_inverse_noise_margin * worst->noise;
    if (!agrees && explains && has_stopped(&inversion->history) &&
        fabs(p->best.factor.missing) > max * p->best.factor.prior)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "g of the target is too %s as a whole by %.2g %%, which no short-ranged potential "
                 "makes, and which its \"particles\" or \"normalisation\" allow by %.2g %%; look "
                 "at these, its density and its cutoff, or give \"pressure\" as a second target",
                 p->best.factor.missing > 0 ? "small" : "large", 100 * fabs(p->best.factor.missing),
                 100 * p->best.factor.prior);
    else if (improved > 0.9 && p->second_error > p->first_error + 2 * rdf->noise && !agrees)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the error of g rose from %.2g to %.2g with the first step, and no shorter one "
                 "helped: the start is outside the basin of \"%s\"; the method \"auto\" or "
                 "another start may lead there",
                 p->first_error, p->second_error, inversion->method->name);
    else if (agrees)
        report_what_is_missing(inversion, reason);
    else if (stuck)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the step has shrunk to 1/%.0f without progress: the error of g is %.2g, its "
                 "statistical error %.2g%s",
                 1 / p->damping, rdf->rms, rdf->noise,
                 composition_is_mixed(&inversion->problem->scene.composition)
                     ? "; potentials of so many pair types may want targets with a shorter "
                       "\"cutoff\""
                     : "");
    else
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "after %lld iterations the error of g is %.2g, from %.2g at first, its statistical "
            "error %.2g, and chi^2 by bin is %.2g where noise makes %.2g at most",
            (long long)settings->iterations, rdf->rms, p->first_error, rdf->noise, worst->misfit,
            worst->probable);
}
