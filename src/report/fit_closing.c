// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_closing.h"

#include "base/number_text.h"
#include "defaults/fit_engine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct curve_knowledge mf_fit_closing_knowledge(const struct unknowns *unknowns,
                                                enum unknown_kind kind, const double *curve,
                                                const double *error) {
    static const double standard_errors = 2;
    double squares = 0, errors = 0, seen = 0, points = 0;
    for (size_t k = 0; k < mf_unknowns_points(unknowns, kind); k++) {
        if (!mf_unknowns_fits(unknowns, kind, k) || !isfinite(error[k]) || !(error[k] > 0))
            continue;
        points++;
        squares += curve[k] * curve[k];
        errors += error[k] * error[k];
        seen += curve[k] > standard_errors * error[k];
    }
    return (struct curve_knowledge){sqrt(squares / points), sqrt(errors / points), seen / points};
}

bool mf_fit_closing_is_noise(const struct unknowns *unknowns, const double *const curve[UNKNOWNS],
                             const double *const error[UNKNOWNS], const struct units *units,
                             char reason[INVERSE_REASON_SIZE]) {
    char unit[UNITS_NAME_SIZE], name[UNKNOWNS_NAME_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!unknown_is_omega(kind) || curve[kind] == NULL)
            continue;
        const struct curve_knowledge known =
            mf_fit_closing_knowledge(unknowns, kind, curve[kind], error[kind]);
        if (!(known.seen < 0.5))
            continue;
        const double factor = mf_units_factor(units, mf_unknowns_unit(kind));
        mf_unknowns_kind_name(unknowns, kind, name);
        snprintf(reason, INVERSE_REASON_SIZE,
                 "%.24s is mostly noise: only %.0f %% of it is above two of its standard errors, "
                 "%.2g%.16s rms of %.2g; more exact targets of motion, or fewer \"coefficients\", "
                 "are needed",
                 name, 100 * known.seen, factor * known.error,
                 mf_units_suffix(units, mf_unknowns_unit(kind), unit), factor * known.rms);
        return true;
    }
    return false;
}

/// The fitted target that is farthest off, in its statistical errors, and its name; NaN if the
/// errors of none are known.
static double find_farthest(const struct fit_file *fit, const struct verification *verification,
                            const char **name) {
    double farthest = NAN;
    for (size_t s = 0; s <= fit->others; s++)
        for (int kind = 0; kind < TARGETS; kind++) {
            const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
            const struct target_distance *distance = &verification[s].worst[kind];
            if (distance->count == 0)
                distance = &verification[s].distance[kind];
            if (!targets_ask(&state->problem.targets, kind) || !(distance->noise > 0) ||
                distance->rms / distance->noise <= farthest)
                continue;
            farthest = distance->rms / distance->noise;
            *name = mf_targets_name(kind);
        }
    return farthest;
}

/// How far a target may be off that is met, in its errors: as inversions end.
static const double within = 1.7;

bool mf_fit_closing_is_missed(const struct fit_file *fit, const struct verification *verification,
                              char reason[INVERSE_REASON_SIZE]) {
    const struct unknown *const omega = &fit->problem.unknown[UNKNOWN_OMEGA];
    const char *name = "";
    char cutoff[UNITS_NAME_SIZE + 32] = "", unit[UNITS_NAME_SIZE];
    bool finds = false;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        finds = finds || (unknown_is_omega(kind) && fit->problem.unknown[kind].wanted);
    const double farthest = find_farthest(fit, verification, &name);
    if (!finds || !(farthest > within))
        return false;
    if (omega->wanted)
        snprintf(cutoff, sizeof cutoff, ", %g%.64s,",
                 mf_units_factor(&fit->scene.units, "lambda") * omega->parameters.cutoff,
                 mf_units_suffix(&fit->scene.units, "lambda", unit));
    snprintf(reason, INVERSE_REASON_SIZE,
             "the nearest omega of this form is still off: %s by %.2g times its statistical error; "
             "another cutoff than that given or chosen%s which no fit changes, a \"curve\" with "
             "more freedom or more \"coefficients\" may do, if the target can be met at all",
             name, farthest, cutoff);
    return true;
}

void mf_fit_closing_verdict(const struct fit_result *result, const char *noise, double farthest,
                            const char *name, char text[FIT_VERDICT_SIZE]) {
    const bool agrees = farthest <= within;
    const char *word = noise[0]          ? "undetermined"
                       : agrees          ? "success"
                       : result->settled ? "converged"
                                         : "finished";
    char off[128];
    snprintf(off, sizeof off,
             "differ from the targets by up to %.2g times the statistical error (%s)", farthest,
             name);
    if (result->status != STATUS_OK)
        snprintf(text, FIT_VERDICT_SIZE, "the fit did not succeed; the reason follows");
    else if (isnan(farthest))
        snprintf(text, FIT_VERDICT_SIZE, "unknown: the verification has no errors");
    else
        snprintf(text, FIT_VERDICT_SIZE, "%s: independent simulations %s%s%.*s", word,
                 agrees ? "agree with the targets within their errors" : off,
                 noise[0] ? ", but " : "", (int)strcspn(noise, ":"), noise);
}

/// Whether the fit succeeded.
static void print_verdict(struct progress *to, const struct fit_file *fit,
                          const struct unknowns *unknowns, const struct fit_result *result) {
    const char *name = "";
    char noise[INVERSE_REASON_SIZE] = "", text[FIT_VERDICT_SIZE];
    const double farthest = find_farthest(fit, result->verification, &name);
    mf_fit_closing_is_noise(unknowns, result->curve, result->curve_error, &fit->scene.units, noise);
    mf_fit_closing_verdict(result, noise, farthest, name, text);
    mf_progress_print(to, "result: %s", text);
}

/// "1350 +- 180": rounded to two digits of the error.
static void print_open(double value, double error, char text[NUMBER_TEXT_SIZE]) {
    const int exponent = (int)floor(log10(error)) - 1, decimals = exponent < 0 ? -exponent : 0;
    const double unit = pow(10, exponent);
    snprintf(text, NUMBER_TEXT_SIZE, "%.*f +- %.*f", decimals, unit * round(value / unit), decimals,
             unit * round(error / unit));
}

/// The pressure, if g(r) does not fix it.
static void print_pressure(struct progress *to, const struct fit_file *fit,
                           const struct fit_result *result) {
    const struct units *units = &fit->scene.units;
    const struct thermodynamics_summary *found = &result->verification->thermodynamics;
    const double open = result->ramp.pressure_open,
                 bar = mf_units_factor(units, "k_B T_0/lambda^d");
    char unit[UNITS_NAME_SIZE], range[NUMBER_TEXT_SIZE];
    // Of several states that of the first is known, and together they leave less open.
    if (fit->others > 0 || !(result->ramp.error > 0) || !(open > found->pressure_error) ||
        targets_ask(&fit->problem.compared, TARGET_PRESSURE))
        return;
    print_open(bar * found->pressure, bar * hypot(open, found->pressure_error), range);
    mf_progress_print(to,
                      "undetermined: g(r) alone does not determine the pressure: %s%s; give "
                      "\"pressure\" as a second target to fix it",
                      range, mf_units_suffix(units, "k_B T_0/lambda^d", unit));
}

/// What relaxes so slowly that the samples hold few independent values of it.
static void print_slowest(struct progress *to, const struct inverse_slowest *slowest) {
    static const double few = 20;
    if (slowest->quantity[0] == '\0' || !(slowest->independent < few))
        return;
    mf_progress_print(to,
                      "slow: the last samples hold some %.0f independent values of %s; more "
                      "\"samples\" hold more",
                      slowest->independent, slowest->quantity);
}

static void print_friction(struct progress *to, const struct fit_file *fit,
                           const struct unknowns *unknowns, const struct fit_result *result) {
    static const double well = 0.1;
    const struct units *units = &fit->scene.units;
    char unit[UNITS_NAME_SIZE], name[UNKNOWNS_NAME_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!unknown_is_omega(kind) || result->curve[kind] == NULL)
            continue;
        const struct curve_knowledge known = mf_fit_closing_knowledge(
            unknowns, kind, result->curve[kind], result->curve_error[kind]);
        const double factor = mf_units_factor(units, mf_unknowns_unit(kind));
        mf_unknowns_kind_name(unknowns, kind, name);
        if (isfinite(known.seen) && known.error > well * known.rms)
            mf_progress_print(to, "undetermined: %s has an error of %.2g%s rms, %.0f %% of it",
                              name, factor * known.error,
                              mf_units_suffix(units, mf_unknowns_unit(kind), unit),
                              100 * known.error / known.rms);
    }
}

void mf_fit_closing_print(struct progress *to, const struct fit_file *fit,
                          const struct unknowns *unknowns, const struct fit_result *result,
                          const char *folder) {
    print_verdict(to, fit, unknowns, result);
    print_pressure(to, fit, result);
    print_slowest(to, &result->slowest);
    print_friction(to, fit, unknowns, result);
    if (result->status == STATUS_OK && mf_fit_engine_knows_more(fit))
        mf_progress_print(to,
                          "next: figures and summary.json are in %s; the potential runs beside the "
                          "known forces, as the last mesofit.lmp or potential.tsv in %s/engine",
                          folder, folder);
    else if (result->status == STATUS_OK)
        mf_progress_print(to,
                          "next: figures and summary.json are in %s; mesofit export %s "
                          "--engine lammps writes the model for LAMMPS, or for another engine",
                          folder, folder);
    else
        mf_progress_print(
            to,
            "next: figures and summary.json are in %s; docs/fit.md has a remedy for each reason",
            folder);
}
