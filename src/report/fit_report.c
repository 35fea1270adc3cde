// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_report.h"

#include "problem/parametrisation.h"
#include "report/fit_change.h"
#include "base/number_text.h"

#include <math.h>

/// "omega: sigma = 6.00(4) (at its maximum), exponent = 1 (fixed), inner_cutoff = 0.02(1)".
static void say_parameters(struct progress *to, const struct fit_file *fit,
                           const struct inverse_parameter *parameter) {
    const struct unknown_parameters *p = &fit->unknown[UNKNOWN_OMEGA].parameters;
    char line[256];
    int length = snprintf(line, sizeof line, "%s:", mf_inverse_unknown_names[UNKNOWN_OMEGA]);
    if (!fit->unknown[UNKNOWN_OMEGA].wanted || p->shape != INVERSE_CURVE_POWER)
        return;
    for (int k = 0; k < INVERSE_PARAMETERS; k++) {
        char text[NUMBER_TEXT_SIZE];
        const char *bound = mf_parametrisation_parameter_bound(p, k, parameter[k].value);
        char mark[32] = "";
        if (!isnan(p->fixed[k]))
            snprintf(mark, sizeof mark, " (fixed)");
        else if (bound)
            snprintf(mark, sizeof mark, " (at its %s)", bound);
        mf_number_text(parameter[k].value, parameter[k].error, text);
        length += snprintf(line + length, sizeof line - (size_t)length, "%s %s = %s%s",
                           k > 0 ? "," : "", mf_inverse_fixed_fields[k].name, text, mark);
    }
    mf_progress_say(to, "%s", line);
}

/// "dissipative.sigma = 3.02(4)"; what is no result does not look like one.
static void say_numbers(struct progress *to, const struct fit_file *fit,
                        const struct inverse_parameter *found) {
    for (size_t n = 0; n < fit->numbers; n++) {
        const struct inverse_number *number = &fit->number[n];
        char text[NUMBER_TEXT_SIZE], mark[32] = "";
        const char *bound = mf_numbers_bound(number, found[n].value);
        if (bound)
            snprintf(mark, sizeof mark, " (at its %s)", bound);
        mf_number_text(found[n].value, found[n].error, text);
        if (mf_numbers_undetermined(number, &found[n]))
            mf_progress_say(to, "%s: undetermined by the targets, anything from %g to %g may be it",
                            number->name, number->minimum, number->maximum);
        else
            mf_progress_say(to, "%s = %s%s%s", number->name, text, mark,
                            isnan(found[n].error) ? ", of unknown error" : "");
    }
}

/// "potential: well -0.354 k_B T_0 at 0.99 lambda (-0.451 at 0.99 at first), changed by 0.05 rms".
static void say_changes(struct progress *to, const struct unknowns *unknowns,
                        const struct fit_result *result) {
    mf_progress_say(to, "error of the fit: %.4g at first, %.4g at the end", result->first_error,
                    result->error);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t n = 0; result->first[kind] && n < mf_unknowns_curve_count(unknowns, kind);
             n++) {
            char name[UNKNOWNS_NAME_SIZE], well[128] = "";
            const struct fit_change change =
                mf_fit_change_find(unknowns, kind, n, result->first[kind], result->curve[kind]);
            mf_unknowns_curve_name(unknowns, kind, n, name);
            if (kind == UNKNOWN_POTENTIAL && change.well < 0)
                snprintf(well, sizeof well,
                         " well %.3f k_B T_0 at %.3g lambda (%.3f at %.3g at first),", change.well,
                         change.well_at, change.first_well, change.first_well_at);
            mf_progress_say(to, "%s:%s changed by %.2g rms", name, well, change.rms);
        }
}

/// A target that is off by more than so many statistical errors is not met by what was fitted.
static const double missed = 20;

/// Values of a target that are known.
static size_t values_of(const struct target *target) {
    size_t known = 0;
    for (size_t k = 0; k < target->count; k++)
        known += isfinite(target->value[k]);
    return known;
}

static void say_distances(struct progress *to, const struct fit_file *fit,
                          const struct verification *v) {
    for (int kind = 0; kind < TARGETS; kind++) {
        char rms[NUMBER_TEXT_SIZE];
        if (!fit->files.given[kind])
            continue;
        mf_number_text(v->distance[kind].rms, v->distance_error[kind], rms);
        const double noises = v->distance[kind].rms / v->distance[kind].noise;
        const size_t known = values_of(&fit->problem.compared.target[kind]);
        char of[96] = "";
        if (v->distance[kind].count < known)
            snprintf(of, sizeof of, ", of %zu of its %zu values: no others were measured",
                     v->distance[kind].count, known);
        mf_progress_say(to, "verified: rms of %s - target = %s, statistics alone %.2g%s%s",
                        mf_targets_name(kind), rms, v->distance[kind].noise, of,
                        noises > missed ? ": not met, though nothing better was found" : "");
    }
}

void mf_fit_report_say(struct progress *to, const struct fit_file *fit,
                       const struct unknowns *unknowns, const struct fit_result *result) {
    const struct verification *v = result->verification;
    say_changes(to, unknowns, result);
    if (result->formula[0])
        mf_progress_say(to, "formula: %s", result->formula);
    say_parameters(to, fit, result->parameter);
    say_numbers(to, fit, result->number);
    say_distances(to, fit, v);
    if (targets_ask(&fit->problem.compared, TARGET_DIFFUSION)) {
        char diffusion[NUMBER_TEXT_SIZE];
        mf_number_text(*v->observed.value[TARGET_DIFFUSION], *v->observed.error[TARGET_DIFFUSION],
                       diffusion);
        mf_progress_say(to, "D = %s, the slope of the MSD from %.4g to %.4g tau", diffusion,
                        v->diffusion_begin, v->diffusion_end);
    }
    const struct thermodynamics_summary *t = &v->thermodynamics;
    if (isnan(t->temperature) && isnan(t->temperature_configurational)) // no particles
        return;
    if (isnan(t->temperature)) // no velocities
        mf_progress_say(to, "configurational T = %.4f, pressure %.3f",
                        t->temperature_configurational, t->pressure);
    else if (isnan(t->temperature_configurational)) // no potential of pairs
        mf_progress_say(to, "T = %.4f, pressure %.3f", t->temperature, t->pressure);
    else
        mf_progress_say(to, "T = %.4f, configurational %.4f, pressure %.3f", t->temperature,
                        t->temperature_configurational, t->pressure);
}
