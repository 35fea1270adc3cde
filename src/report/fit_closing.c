// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_closing.h"

#include "base/number_text.h"
#include "defaults/fit_engine.h"
#include "report/fit_farthest.h"

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

/// rms of the standard error of a friction weight that is well known, as a part of its own.
static const double well = 0.1;

/// Whether what is fitted of motion has no errors: those of ω are then the fit's own, which longer
/// samples lessen as far as one likes.
static bool motion_has_no_errors(const struct targets *targets) {
    bool asked = false;
    for (int kind = TARGET_ETD; kind <= TARGET_DIFFUSION; kind++) {
        const struct target *target = &targets->target[kind];
        if (!targets_ask(targets, kind))
            continue;
        asked = true;
        for (size_t k = 0; k < target->count; k++)
            if (target->error[k] > 0)
                return false;
    }
    return asked;
}

bool mf_fit_closing_is_noise(const struct unknowns *unknowns, const struct targets *targets,
                             const double *const curve[UNKNOWNS],
                             const double *const error[UNKNOWNS], const struct units *units,
                             char reason[INVERSE_REASON_SIZE]) {
    const bool own = motion_has_no_errors(targets);
    char unit[UNITS_NAME_SIZE], name[UNKNOWNS_NAME_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!unknown_is_omega(kind) || curve[kind] == NULL)
            continue;
        const struct curve_knowledge known =
            mf_fit_closing_knowledge(unknowns, kind, curve[kind], error[kind]);
        const bool noisy = known.seen < 0.5, open = own && known.error > well * known.rms;
        if (!noisy && !open)
            continue;
        const double factor = mf_units_factor(units, mf_unknowns_unit(kind));
        mf_unknowns_kind_name(unknowns, kind, name);
        if (open)
            snprintf(
                reason, INVERSE_REASON_SIZE,
                "%.24s is known to %.0f %% of it (rms), by the noise of the fit's own samples, "
                "as its targets are given without errors; more \"samples\" of the method are "
                "needed",
                name, 100 * known.error / known.rms);
        else
            snprintf(
                reason, INVERSE_REASON_SIZE,
                "%.24s is mostly noise: only %.0f %% of it is above two of its standard errors, "
                "%.2g%.16s rms of %.2g; try a shorter \"cutoff\" of it, fewer \"coefficients\", "
                "or more exact targets of motion",
                name, 100 * known.seen, factor * known.error,
                mf_units_suffix(units, mf_unknowns_unit(kind), unit), factor * known.rms);
        return true;
    }
    return false;
}

/// The cutoff of ω, which no fit changes: ", 1.5 nm,".
enum { CUTOFF_SIZE = UNITS_NAME_SIZE + 32 };
static void describe_cutoff(const struct fit_file *fit, char text[CUTOFF_SIZE]) {
    const struct unknown *const omega = &fit->problem.unknown[UNKNOWN_OMEGA];
    char unit[UNITS_NAME_SIZE];
    text[0] = '\0';
    if (omega->wanted)
        snprintf(text, CUTOFF_SIZE, ", %g%.64s,",
                 mf_units_factor(&fit->scene.units, "lambda") * omega->parameters.cutoff,
                 mf_units_suffix(&fit->scene.units, "lambda", unit));
}

bool mf_fit_closing_is_missed(const struct fit_file *fit, const struct verification *verification,
                              double noise, char reason[INVERSE_REASON_SIZE]) {
    char cutoff[CUTOFF_SIZE], off[FIT_FARTHEST_SIZE];
    bool finds = false;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        finds = finds || (unknown_is_omega(kind) && fit->problem.unknown[kind].wanted);
    const struct fit_farthest farthest =
        mf_fit_farthest_find(fit, verification, FIT_TARGETS_FITTED);
    if (!finds || farthest.agreement == NULL || verify_agreement_holds(farthest.agreement))
        return false;
    mf_fit_farthest_describe(&farthest, off);
    describe_cutoff(fit, cutoff);
    if (mf_targets_error(&fit->problem.targets, verification->distance) < noise)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the samples of the fit cannot see how far omega is still off, but its "
                 "verification can: %s; more \"samples\" of the method",
                 off);
    else
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the nearest omega of this form is still off: %s; "
                 "another cutoff than that given or chosen%s which no fit changes, a \"curve\" "
                 "with more freedom or more \"coefficients\" may do, if the target can be met at "
                 "all",
                 off, cutoff);
    return true;
}

static bool only_compares_some(const struct fit_file *fit) {
    bool some = false;
    for (int kind = 0; kind < TARGETS; kind++)
        some = some || (fit->files.given[kind] && !targets_ask(&fit->problem.targets, kind));
    return some;
}

/// "; those only compared differ, most …", or "": what "success" does not cover.
enum { COMPARED_SIZE = FIT_FARTHEST_SIZE + 64 };
static void describe_compared(const struct fit_file *fit, const struct verification *verification,
                              char text[COMPARED_SIZE]) {
    const struct fit_farthest farthest =
        mf_fit_farthest_find(fit, verification, FIT_TARGETS_COMPARED);
    char off[FIT_FARTHEST_SIZE];
    text[0] = '\0';
    if (farthest.agreement == NULL || verify_agreement_holds(farthest.agreement))
        return;
    mf_fit_farthest_describe(&farthest, off);
    snprintf(text, COMPARED_SIZE, "; those only compared differ, most %s", off);
}

void mf_fit_closing_verdict(const struct fit_file *fit, const struct fit_result *result,
                            const char *noise, char text[FIT_VERDICT_SIZE]) {
    const struct fit_farthest farthest =
        mf_fit_farthest_find(fit, result->verification, FIT_TARGETS_FITTED);
    const bool agrees = farthest.agreement && verify_agreement_holds(farthest.agreement);
    const char *word = noise[0]                 ? "undetermined"
                       : agrees                 ? "success"
                       : result->step.converged ? "converged"
                                                : "finished";
    char off[FIT_FARTHEST_SIZE] = "", others[COMPARED_SIZE];
    describe_compared(fit, result->verification, others);
    if (farthest.agreement)
        mf_fit_farthest_describe(&farthest, off);
    if (result->status != STATUS_OK)
        snprintf(text, FIT_VERDICT_SIZE, "the fit did not succeed; the reason follows");
    else if (farthest.agreement == NULL)
        snprintf(text, FIT_VERDICT_SIZE,
                 "unknown: the verification has too few samples for errors to judge by%s", others);
    else
        snprintf(text, FIT_VERDICT_SIZE, "%s: independent simulations %s%s targets%s%s%s%.*s%s",
                 word, agrees ? "agree with the" : "differ from the",
                 only_compares_some(fit) ? " fitted" : "",
                 agrees ? " within their errors" : ", most ", agrees ? "" : off,
                 noise[0] ? ", but " : "", (int)strcspn(noise, ":"), noise, others);
}

/// Whether the fit succeeded.
static void print_verdict(struct progress *to, const struct fit_file *fit,
                          const struct unknowns *unknowns, const struct fit_result *result) {
    char noise[INVERSE_REASON_SIZE] = "", text[FIT_VERDICT_SIZE];
    mf_fit_closing_is_noise(unknowns, &fit->problem.targets, result->step.curve,
                            result->step.curve_error, &fit->scene.units, noise);
    mf_fit_closing_verdict(fit, result, noise, text);
    mf_progress_print(to, "result: %s", text);
}

/// "1350 +- 180": rounded to two digits of the error.
static void print_open(double value, double error, char text[NUMBER_TEXT_SIZE]) {
    const int exponent = (int)floor(log10(error)) - 1, decimals = exponent < 0 ? -exponent : 0;
    const double unit = pow(10, exponent);
    snprintf(text, NUMBER_TEXT_SIZE, "%.*f +- %.*f", decimals, unit * round(value / unit), decimals,
             unit * round(error / unit));
}

bool mf_fit_closing_is_open(const struct fit_file *fit, const struct fit_result *result,
                            char text[FIT_VERDICT_SIZE]) {
    const struct units *units = &fit->scene.units;
    const struct thermodynamics_summary *found = &result->verification->thermodynamics;
    const enum target_kind kind = inverse_problem_bulk(&fit->problem);
    const char *name = mf_targets_name((int)kind), *of = mf_observable_kind((int)kind).target->unit;
    const double open = result->step.ramp.bulk_open, factor = mf_units_factor(units, of);
    const double value = kind == TARGET_DENSITY ? found->density : found->pressure;
    const double error = kind == TARGET_DENSITY ? found->density_error : found->pressure_error;
    char unit[UNITS_NAME_SIZE], range[NUMBER_TEXT_SIZE];
    // Of several states that of the first is known, and together they leave less open.
    if (fit->others > 0 || !(result->step.ramp.error > 0) || !(open > error) ||
        targets_ask(&fit->problem.targets, kind))
        return false;
    print_open(factor * value, factor * hypot(open, error), range);
    char length[UNITS_NAME_SIZE], law[256];
    const double end =
        mf_units_factor(units, "lambda") * mf_rdf_bins_range(&fit->problem.targets.bins);
    mf_units_suffix(units, "lambda", length);
    if (result->step.ramp.bulk_range > sqrt(0.5) * open)
        snprintf(
            law, sizeof law,
            ", most of it by what the law may do beyond %.4g%s, which a longer \"cutoff\" of the "
            "target tells",
            end, length);
    else if (result->step.ramp.bulk_samples > sqrt(0.5) * open)
        snprintf(law, sizeof law,
                 ", most of it by the noise of the fit's own samples, of which a smaller "
                 "\"precision\" takes more");
    else
        snprintf(law, sizeof law, ", if the law ends at %.4g%s", end, length);
    const bool given = targets_ask(&fit->problem.compared, kind);
    snprintf(text, FIT_VERDICT_SIZE,
             "undetermined: g(r) alone does not determine the %s: %s%s%s; %s \"%s\" as a second "
             "target to fix it",
             name, range, mf_units_suffix(units, of, unit), law, given ? "fit" : "give", name);
    return true;
}

static void print_bulk(struct progress *to, const struct fit_file *fit,
                       const struct fit_result *result) {
    char text[FIT_VERDICT_SIZE];
    if (mf_fit_closing_is_open(fit, result, text))
        mf_progress_print(to, "%s", text);
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
    const struct units *units = &fit->scene.units;
    char unit[UNITS_NAME_SIZE], name[UNKNOWNS_NAME_SIZE];
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (!unknown_is_omega(kind) || result->step.curve[kind] == NULL)
            continue;
        const struct curve_knowledge known = mf_fit_closing_knowledge(
            unknowns, kind, result->step.curve[kind], result->step.curve_error[kind]);
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
    print_bulk(to, fit, result);
    print_slowest(to, &result->step.slowest);
    print_friction(to, fit, unknowns, result);
    if (result->status == STATUS_OK && mf_fit_engine_knows_more(fit))
        mf_progress_print(to,
                          "next: figures and summary.json are in %s; the potential runs beside the "
                          "known forces, as the last mesofit.lmp or potential.tsv in %s/engine; "
                          "mesofit export %s --engine lammps writes it alone",
                          folder, folder, folder);
    else if (result->status == STATUS_OK)
        mf_progress_print(to,
                          "next: figures and summary.json are in %s; mesofit export %s "
                          "--engine lammps writes the model for LAMMPS, or for another engine",
                          folder, folder);
}
