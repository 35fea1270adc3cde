// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_report.h"

#include "base/number_text.h"
#include "curves/expression_text.h"
#include "observe/kirkwood_buff.h"
#include "problem/parametrisation.h"
#include "report/fit_closing.h"
#include "report/fit_verification.h"

#include <math.h>

/// Whether the target has enough pairs at a point to tell of the curve there.
static bool is_determined(const struct unknowns *unknowns, enum unknown_kind kind, size_t point) {
    const struct potential_grid *grid = &unknowns->potential;
    const size_t among = kind == UNKNOWN_BONDED ? grid->pair_points + point : point;
    if (unknown_is_omega(kind))
        return mf_unknowns_fits(unknowns, kind, point);
    for (size_t n = 0; n < grid->known; n++)
        if (grid->known_point[n] == among)
            return grid->well_known[n];
    return false;
}

static void find_lower(double value, double r, double *lowest, double *at) {
    if (value >= *lowest)
        return;
    *lowest = value;
    *at = r;
}

struct fit_change mf_fit_change_find(const struct unknowns *unknowns, enum unknown_kind kind,
                                     size_t curve, const struct fit_result *result) {
    const double *first = result->first[kind], *last = result->step.curve[kind];
    const double *error = result->step.curve_error[kind];
    struct fit_change change = {.well = INFINITY, .well_error = NAN, .first_well = INFINITY};
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *r = mf_unknowns_r(unknowns, kind);
    double squares = 0, count = 0;
    for (size_t k = part.first; k < part.first + part.points; k++) {
        if (!is_determined(unknowns, kind, k))
            continue;
        squares += (last[k] - first[k]) * (last[k] - first[k]);
        count += 1;
        if (error && last[k] < change.well)
            change.well_error = error[k];
        find_lower(last[k], r[k], &change.well, &change.well_at);
        find_lower(first[k], r[k], &change.first_well, &change.first_well_at);
    }
    change.rms = sqrt(squares / count);
    return change;
}

void mf_fit_report_formula(const struct fit_file *fit, const char *formula,
                           char text[FIELD_TEXT_SIZE]) {
    const struct units *units = &fit->scene.units;
    const enum unknown_kind kind =
        fit->unknown[UNKNOWN_POTENTIAL].wanted ? UNKNOWN_POTENTIAL : UNKNOWN_OMEGA;
    struct expression expression;
    char printed[EXPRESSION_TEXT_SIZE] = "";
    if (formula)
        snprintf(printed, sizeof printed, "%s", formula);
    if (formula && mf_units_are_physical(units) &&
        mf_expression_parse(&expression, formula) == STATUS_OK &&
        mf_expression_scale(&expression, mf_units_factor(units, "lambda"),
                            mf_units_factor(units, mf_unknowns_unit(kind))))
        mf_expression_print(&expression, EXPRESSION_PLAIN, printed);
    snprintf(text, FIELD_TEXT_SIZE, "%.*s", FIELD_TEXT_SIZE - 1, printed);
}

/// "omega: sigma = 6.00(4) (at its maximum), exponent = 1 (fixed), inner_cutoff = 0.02(1), cutoff
/// = 1.5 (fixed)".
static void print_parameters(struct progress *to, const struct fit_file *fit,
                             const struct inverse_parameter *parameter) {
    const struct unknown_parameters *p = &fit->unknown[UNKNOWN_OMEGA].parameters;
    char line[320], unit[UNITS_NAME_SIZE];
    int length = snprintf(line, sizeof line, "%s:", mf_inverse_unknown_names[UNKNOWN_OMEGA]);
    if (!fit->unknown[UNKNOWN_OMEGA].wanted || p->shape != INVERSE_CURVE_POWER)
        return;
    for (int k = 0; k < INVERSE_PARAMETERS; k++) {
        char text[UNITS_MEASURED_SIZE];
        const char *bound = mf_parametrisation_parameter_bound(p, k, parameter[k].value);
        char mark[32] = "";
        if (!isnan(p->fixed[k]))
            snprintf(mark, sizeof mark, " (fixed)");
        else if (bound)
            snprintf(mark, sizeof mark, " (at its %s)", bound);
        length += snprintf(line + length, sizeof line - (size_t)length, "%s %s = %s%s",
                           k > 0 ? "," : "", mf_inverse_fixed_fields[k].name,
                           mf_units_measured(&fit->scene.units, mf_inverse_fixed_fields[k].unit,
                                             parameter[k].value, parameter[k].error, text),
                           mark);
    }
    mf_progress_print(to, "%s, cutoff = %g%s (fixed)", line,
                      mf_units_factor(&fit->scene.units, "lambda") * p->cutoff,
                      mf_units_suffix(&fit->scene.units, "lambda", unit));
    if (p->fixed[INVERSE_INNER_CUTOFF] == 0)
        mf_progress_print(to, p->fixed[INVERSE_EXPONENT] == 1
                                  ? "other engines run this omega as it is: LAMMPS (dpd/tstat), "
                                    "HOOMD-blue, ESPResSo, OpenMM"
                                  : "LAMMPS runs this omega as it is: dpd/ext/tstat of its package "
                                    "DPD-BASIC");
}

/// "dissipative.sigma = 3.02(4)"; what is no result does not look like one.
static void print_numbers(struct progress *to, const struct fit_file *fit,
                          const struct inverse_parameter *found) {
    for (size_t n = 0; n < fit->numbers; n++) {
        const struct inverse_number *number = &fit->number[n];
        char text[NUMBER_TEXT_SIZE], mark[32] = "";
        const char *bound = mf_numbers_bound(number, found[n].value);
        if (bound)
            snprintf(mark, sizeof mark, " (at its %s)", bound);
        const double factor = mf_units_factor(&fit->scene.units, number->unit);
        char unit[UNITS_NAME_SIZE];
        mf_units_suffix(&fit->scene.units, number->unit, unit);
        mf_number_text(factor * found[n].value, factor * found[n].error, text);
        if (mf_numbers_undetermined(number, &found[n]))
            mf_progress_print(to, "%s: undetermined by the targets, between %g and %g%s",
                              number->name, factor * number->minimum, factor * number->maximum,
                              unit);
        else
            mf_progress_print(to, "%s = %s%s%s%s", number->name, text, unit, mark,
                              isnan(found[n].error) ? ", of unknown error" : "");
    }
}

/// What the fit went on from, if it had several starts.
static void print_start(struct progress *to, enum inverse_start start) {
    static const char *const began[] = {
        [INVERSE_START_FORCES] = "the forces of the target, which were near at once",
        [INVERSE_START_FORCES_NEARER] = "the forces of the target, nearer than what its g(r) says",
        [INVERSE_START_TARGET_NEARER] = "what g(r) of the target says, nearer than its forces",
    };
    if (began[start])
        mf_progress_print(to, "begun with %s", began[start]);
}

/// "potential: well -0.354(12) k_B T_0 at 0.99 lambda (-0.451 at 0.99 at first), changed by 0.05
/// rms".
static void print_changes(struct progress *to, const struct units *units,
                          const struct unknowns *unknowns, const struct fit_result *result) {
    const double energy = mf_units_factor(units, "k_B T_0");
    const double length = mf_units_factor(units, "lambda");
    if (isfinite(result->first_error))
        mf_progress_print(to, "error of the fit: %.4g at first, %.4g at the end",
                          result->first_error, result->step.error);
    else if (isfinite(result->step.error))
        mf_progress_print(to, "error of the fit: %.4g at the end", result->step.error);
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t n = 0; result->first[kind] && n < mf_unknowns_curve_count(unknowns, kind);
             n++) {
            char name[UNKNOWNS_NAME_SIZE], well[192] = "";
            char depth[UNITS_MEASURED_SIZE], lengths[UNITS_NAME_SIZE], unit[UNITS_NAME_SIZE];
            const struct fit_change change = mf_fit_change_find(unknowns, kind, n, result);
            if (isnan(change.rms))
                continue; // that of pairs without g(r) is not looked for
            mf_unknowns_curve_name(unknowns, kind, n, name);
            if (kind == UNKNOWN_POTENTIAL && change.well < 0)
                snprintf(well, sizeof well, " well %s at %.3g %s (%.3f at %.3g at first),",
                         mf_units_measured(units, "k_B T_0", change.well, change.well_error, depth),
                         length * change.well_at, mf_units_name(units, "lambda", lengths),
                         energy * change.first_well, length * change.first_well_at);
            const double factor = mf_units_factor(units, mf_unknowns_unit(kind));
            mf_units_suffix(units, mf_unknowns_unit(kind), unit);
            if (unknown_is_omega(kind)) {
                const struct curve_knowledge known = mf_fit_closing_knowledge(
                    unknowns, kind, result->step.curve[kind], result->step.curve_error[kind]);
                if (isfinite(known.seen))
                    snprintf(well, sizeof well, " %.2g%.16s rms, error %.2g,", factor * known.rms,
                             unit, factor * known.error);
            }
            mf_progress_print(to, "%s:%s changed by %.2g%s rms", name, well, factor * change.rms,
                              unit);
        }
}

/// A target that is off by more than so many statistical errors is not met by what was fitted.
static const double missed = 20;

/// Values of a target that are known, without the first row of a matrix: E at time 0 is 1 by
/// nature.
static size_t values_of(const struct target *target) {
    size_t known = 0;
    for (size_t k = target->columns; k < target->count; k++)
        known += isfinite(target->value[k]);
    return known;
}

/// Mean square of the errors of what was observed of a target.
static double variance_of(const struct verification *v, const struct target *target, int kind) {
    double sum = 0, known = 0;
    for (size_t k = 0; k < target->count; k++) {
        const double error = v->observed.error[kind][k];
        if (!isfinite(error) || !isfinite(target->value[k]) ||
            !isfinite(v->observed.value[kind][k]))
            continue;
        sum += error * error;
        known++;
    }
    return known > 0 ? sum / known : 0;
}

/// Noise of a target, of its verification and of the fit's own samples.
struct noises {
    double both;   ///< of the first two
    double own;    ///< of the verification
    double of_fit; ///< 0: not fitted
};

static struct noises noises_of(const struct fit_file *fit, const struct verification *v, int kind) {
    const double own = sqrt(variance_of(v, &fit->problem.compared.target[kind], kind));
    const bool fitted = targets_ask(&fit->problem.targets, kind);
    return (struct noises){v->distance[kind].noise, own, fitted ? sqrt(v->share) * own : 0};
}

/// ", with that of the fit's own samples 0.0045": what a right result may differ by.
enum { OF_FIT_SIZE = 80 };
static void describe_noise_of_fit(const struct noises *noises, double factor,
                                  char text[OF_FIT_SIZE]) {
    static const double seen = 1.1;
    const double all = hypot(noises->both, noises->of_fit);
    text[0] = '\0';
    if (all > seen * noises->both)
        snprintf(text, OF_FIT_SIZE, ", with that of the fit's own samples %.2g", factor * all);
}

/// A verification that is shorter than target and fit are exact.
static void print_what_is_hidden(struct progress *to, const struct noises *noises, const char *name,
                                 double factor, const char *unit) {
    static const double short_of = 2;
    const double of_target = sqrt(fmax(0, noises->both * noises->both - noises->own * noises->own));
    const double others = hypot(of_target, noises->of_fit);
    if (others > 0 && noises->own > short_of * others)
        mf_progress_print(to,
                          "short: the verification's own noise of %s is %.2g%s, %.2g times that of "
                          "target and fit, and hides what is smaller; more "
                          "\"verification.samples\" see it (left out, they are chosen)",
                          name, factor * noises->own, unit, noises->own / others);
}

static void print_distance(struct progress *to, const struct fit_file *fit,
                           const struct verification *v, int kind) {
    const struct target_distance *distance = &v->distance[kind];
    const char *own = mf_observable_kind(kind).target->unit, *unit = own ? own : "";
    const double factor = mf_units_factor(&fit->scene.units, unit);
    const bool fitted = targets_ask(&fit->problem.targets, kind);
    const size_t known = values_of(&fit->problem.compared.target[kind]);
    const struct noises noises = noises_of(fit, v, kind);
    char rms[NUMBER_TEXT_SIZE], name[UNITS_NAME_SIZE] = "", of[96] = "", with[OF_FIT_SIZE];
    if (factor != 1 || mf_units_known(&fit->scene.units)) // of numbers ""
        mf_units_suffix(&fit->scene.units, unit, name);
    mf_number_text(factor * distance->rms, factor * v->distance_error[kind], rms);
    if (distance->count < known)
        snprintf(of, sizeof of, ", of %zu of its %zu values: no others were measured",
                 distance->count, known);
    describe_noise_of_fit(&noises, factor, with);
    mf_progress_print(to, "verified%s: rms of %s - target = %s%s, statistics alone %.2g%s%s%s",
                      v->by_engine ? " by the engine" : "", mf_targets_name(kind), rms, name,
                      factor * noises.both, with, of,
                      !verify_agreement_holds(&v->compared[kind]) ? ": not fitted, only compared"
                      : fitted && distance->rms > missed * noises.both
                          ? ": not met: nothing better was found"
                          : "");
    if (fitted && known > 1)
        print_what_is_hidden(to, &noises, mf_targets_name(kind), factor, name);
}

static void print_distances(struct progress *to, const struct fit_file *fit,
                            const struct verification *v) {
    for (int kind = 0; kind < TARGETS; kind++)
        if (fit->files.given[kind])
            print_distance(to, fit, v, kind);
}

/// Friction that was chosen only holds the temperature: what moves by it is no result.
static void print_diffusion(struct progress *to, const struct fit_file *fit,
                            const struct verification *v) {
    const struct units *units = &fit->scene.units;
    const double time = mf_units_factor(units, "tau");
    char diffusion[UNITS_MEASURED_SIZE], times[UNITS_NAME_SIZE];
    mf_units_measured(units, "lambda^2/tau", *v->observed.value[TARGET_DIFFUSION],
                      *v->observed.error[TARGET_DIFFUSION], diffusion);
    mf_progress_print(to, "D = %s, the slope of the MSD from %.4g to %.4g %s%s", diffusion,
                      time * v->diffusion_begin, time * v->diffusion_end,
                      mf_units_name(units, "tau", times),
                      fit->choices.thermostat ? ": by the friction that was chosen to hold the "
                                                "temperature, and no result"
                                              : "");
}

/// "G of A-B = -0.31(2) lambda^3, target -0.30(1)".
static void print_integrals(struct progress *to, const struct fit_file *fit,
                            const struct verification *v) {
    const int kind = mf_kirkwood_buff_kind();
    const struct target *target = &fit->problem.compared.target[kind];
    const double factor = mf_units_factor(&fit->scene.units, "lambda^d");
    for (size_t pair = 0; pair < target->count; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        char found[UNITS_MEASURED_SIZE], wanted[NUMBER_TEXT_SIZE];
        if (isnan(target->value[pair]))
            continue;
        mf_composition_pair_name(&target_files_kirkwood_buff(&fit->files)->components, (int)pair,
                                 name);
        mf_units_measured(&fit->scene.units, "lambda^d", v->observed.value[kind][pair],
                          v->observed.error[kind][pair], found);
        mf_number_text(factor * target->value[pair], factor * target->error[pair], wanted);
        mf_progress_print(to, "Kirkwood-Buff integral%s%s = %s, target %s", name[0] ? " of " : "",
                          name, found, wanted);
    }
}

/// " (at this time step; without it about 0.12(2) more)".
static void report_shift(const struct verification *v, double scale, char *text, size_t size) {
    char shift[NUMBER_TEXT_SIZE];
    mf_number_text(scale * fabs(v->shift.pressure), scale * v->shift.error, shift);
    if (mf_fit_step_shifts_pressure(v))
        snprintf(text, size, " (at this time step; without it about %s %s)", shift,
                 v->shift.pressure < 0 ? "more" : "less");
}

/// ", density 32.61(2) nm^-3", where it may change.
static void report_density(const struct fit_file *fit, const struct thermodynamics_summary *t,
                           char *text, size_t size) {
    const double factor = mf_units_factor(&fit->scene.units, "1/lambda^d");
    char found[NUMBER_TEXT_SIZE], unit[UNITS_NAME_SIZE];
    mf_number_text(factor * t->density, factor * t->density_error, found);
    if (targets_ask(&fit->problem.compared, TARGET_DENSITY))
        snprintf(text, size, ", density %s%s", found,
                 mf_units_suffix(&fit->scene.units, "1/lambda^d", unit));
}

static void print_thermodynamics(struct progress *to, const struct fit_file *fit,
                                 const struct verification *v) {
    const struct units *units = &fit->scene.units;
    const struct thermodynamics_summary *t = &v->thermodynamics;
    const double factor = mf_units_factor(units, "T_0");
    const double scale = mf_units_factor(units, "k_B T_0/lambda^d");
    char kinetic[NUMBER_TEXT_SIZE], configurational[NUMBER_TEXT_SIZE], found[NUMBER_TEXT_SIZE];
    char kelvin[UNITS_NAME_SIZE], unit[UNITS_NAME_SIZE], pressure[320], shift[128] = "";
    mf_number_text(factor * t->temperature, factor * t->temperature_error, kinetic);
    mf_number_text(factor * t->temperature_configurational,
                   factor * t->temperature_configurational_error, configurational);
    mf_number_text(scale * t->pressure, scale * t->pressure_error, found);
    mf_units_suffix(units, "T_0", kelvin);
    report_shift(v, scale, shift, sizeof shift);
    snprintf(pressure, sizeof pressure, ", pressure %s%s%s", found,
             mf_units_suffix(units, "k_B T_0/lambda^d", unit), shift);
    if (isnan(t->pressure)) // of another engine that has not told it
        pressure[0] = '\0';
    report_density(fit, t, pressure + strlen(pressure), sizeof pressure - strlen(pressure));
    if (isnan(t->temperature) && isnan(t->temperature_configurational)) // no particles
        return;
    if (isnan(t->temperature)) // no velocities
        mf_progress_print(to, "configurational T = %s%s%s", configurational, kelvin, pressure);
    else if (isnan(t->temperature_configurational)) // no potential of pairs
        mf_progress_print(to, "T = %s%s%s", kinetic, kelvin, pressure);
    else
        mf_progress_print(to, "T = %s%s, configurational %s%s%s", kinetic, kelvin, configurational,
                          kelvin, pressure);
}

/// With which time step a state was verified, and that a fit by simulations had another one.
static void print_step(struct progress *to, const struct fit_file *fit,
                       const struct verification *v) {
    const struct units *units = &fit->scene.units;
    char text[FIT_STEP_TEXT_SIZE], unit[UNITS_NAME_SIZE];
    mf_fit_step_text(v, units, text);
    if (text[0])
        mf_progress_print(to, "%s", text);
    if (fit->method->kind == INVERSE_MATCHING && mf_fit_step_was_shortened(v))
        mf_progress_print(to,
                          "mesofit: warning: the fit simulated its candidates with the longer time "
                          "step, whose error is part of what it found: \"scene.time_step\": "
                          "%.3g%s%s, and fit again",
                          mf_units_factor(units, "tau") * v->step.used,
                          mf_units_suffix(units, "tau", unit), v->dynamics);
}

/// What was found of a state, or of the only one.
static void print_state(struct progress *to, const struct fit_file *fit,
                        const struct verification *v) {
    if (fit->name[0])
        mf_progress_print(to, "state \"%s\":", fit->name);
    print_distances(to, fit, v);
    if (targets_ask(&fit->problem.compared, TARGET_DIFFUSION))
        print_diffusion(to, fit, v);
    print_integrals(to, fit, v);
    print_thermodynamics(to, fit, v);
    print_step(to, fit, v);
}

/// "converged after 8 iterations, 111 s".
static void print_end(struct progress *to, const struct fit_result *result) {
    const bool exhausted = result->status == STATUS_OK && !result->step.converged;
    mf_progress_print(to, "%s after %llu iterations, %.1f s%s%s",
                      exhausted                     ? "finished"
                      : result->status == STATUS_OK ? "converged"
                                                    : "not converged",
                      result->step.iteration + 1ULL, result->seconds, exhausted ? ": " : "",
                      exhausted ? result->reason : "");
}

void mf_fit_report_print(struct progress *to, const struct fit_file *fit,
                         const struct unknowns *unknowns, const struct fit_result *result) {
    const struct units *units = &fit->scene.units;
    print_end(to, result);
    print_start(to, result->step.start);
    print_changes(to, units, unknowns, result);
    if (result->step.formula[0])
        mf_progress_print(to, "formula: %s", result->step.formula);
    print_parameters(to, fit, result->step.parameter);
    print_numbers(to, fit, result->step.number);
    for (size_t s = 0; s <= fit->others; s++)
        print_state(to, s == 0 ? fit : &fit->other[s - 1], &result->verification[s]);
}
