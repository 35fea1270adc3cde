// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_verification.h"

#include "base/number_text.h"
#include "observe/kirkwood_buff.h"
#include "problem/group_kind.h"

#include <math.h>
#include <stdio.h>

// The time step -----------------------------------------------------------------------------------

/// "12.5 fs", "0.002 tau".
enum { TIME_SIZE = 48 };
static const char *time_text(const struct units *units, double time, char text[TIME_SIZE]) {
    char unit[UNITS_NAME_SIZE];
    snprintf(text, TIME_SIZE, "%.3g %.20s", mf_units_factor(units, "tau") * time,
             mf_units_name(units, "tau", unit));
    return text;
}

/// The next lower number of two digits, which is as right.
static double round_down(double value) {
    const double power = pow(10, floor(log10(value)) - 1);
    return floor(value / power * (1 + 1e-9)) * power;
}

/// "the kinetic temperature is 10 % too high".
enum { OFF_SIZE = 80 };
static const char *off_text(const struct thermodynamics_off *off, bool blew_up,
                            char text[OFF_SIZE]) {
    if (blew_up)
        snprintf(text, OFF_SIZE, "the simulation blows up or heats");
    else
        snprintf(text, OFF_SIZE, "the %s temperature is %.2g %% too %s",
                 off->kinetic ? "kinetic" : "configurational", 100 * fabs(off->share),
                 off->share > 0 ? "high" : "low");
    return text;
}

/// "a half", "a sixteenth".
static const char *part_text(int halvings) {
    static const char *const parts[] = {"all", "half", "a quarter", "an eighth", "a sixteenth"};
    return parts[halvings];
}

void mf_fit_step_add_dynamics(const struct fit_file *fit, struct verification *verification) {
    verification->dynamics[0] = '\0';
    if (fit->inner_steps > 0)
        snprintf(verification->dynamics, sizeof verification->dynamics,
                 " and \"scene.dynamics\": {\"integrator\": \"%s\", \"inner_steps\": %lld}",
                 fit->scene.setup.integrator->name, (long long)fit->inner_steps);
}

bool mf_fit_step_was_shortened(const struct verification *verification) {
    return verification->step.halvings > 0;
}

bool mf_fit_step_shifts_pressure(const struct verification *verification) {
    static const double errors = 2;
    const struct thermodynamics_shift *shift = &verification->shift;
    return fabs(shift->pressure) >
           fmax(errors * shift->error, verification->thermodynamics.pressure_error);
}

/// Why temperatures are off, as far as other time steps tell, and what helps; "" if they do not
/// tell.
static void find_step_cause(const struct verification *verification, const struct units *units,
                            char text[FIT_STEP_TEXT_SIZE]) {
    const struct verify_step *step = &verification->step;
    char off[OFF_SIZE], used[TIME_SIZE], holds[TIME_SIZE];
    off_text(&step->off, step->blew_up, off);
    time_text(units, step->used, used);
    text[0] = '\0';
    if (step->result == VERIFY_STEP_NOT_THE_CAUSE)
        snprintf(
            text, FIT_STEP_TEXT_SIZE,
            "%s, and was so with twice the time step: the cause is not the time step but too "
            "little friction, a force with a jump at its cutoff, or too short an \"equilibration\"",
            off);
    else if (step->result == VERIFY_STEP_LONG && step->shortens)
        snprintf(text, FIT_STEP_TEXT_SIZE,
                 "%s even with %s, %s of the time step chosen, and no shorter one is tried: the "
                 "potential is too rough; wider bins of g(r) (\"bin_width\") make it smooth",
                 off, used, part_text(step->halvings));
    else if (step->result == VERIFY_STEP_LONG)
        snprintf(text, FIT_STEP_TEXT_SIZE,
                 "%s: the time step, %s, is too long for this potential; use about %s%s", off, used,
                 time_text(units, round_down(step->would_hold), holds), verification->dynamics);
}

void mf_fit_step_text(const struct verification *verification, const struct units *units,
                      char text[FIT_STEP_TEXT_SIZE]) {
    const struct verify_step *step = &verification->step;
    static const double exact = 0.0101; // the 1 % by which a step is judged
    char used[TIME_SIZE], first[TIME_SIZE], off[OFF_SIZE], why[OFF_SIZE + TIME_SIZE + 8], bound[96];
    text[0] = '\0';
    if (step->result == VERIFY_STEP_LONG || step->result == VERIFY_STEP_NOT_THE_CAUSE) {
        find_step_cause(verification, units, text);
        return;
    }
    if (!step->shortens)
        return;
    if (step->result == VERIFY_STEP_UNKNOWN)
        snprintf(bound, sizeof bound, "too few samples to check it");
    else if (step->off.within > exact)
        snprintf(bound, sizeof bound,
                 "no error of a temperature seen, but its samples see none below %.2g %%",
                 100 * step->off.within);
    else
        snprintf(bound, sizeof bound, "both temperatures are right within %.2g %%",
                 100 * step->off.within);
    time_text(units, step->used, used);
    if (step->halvings == 0) {
        snprintf(text, FIT_STEP_TEXT_SIZE, "time step of the verification: %s; %s", used, bound);
        return;
    }
    if (step->used < step->tried)
        snprintf(why, sizeof why, "with %s %s", time_text(units, step->tried, first),
                 off_text(&step->first_off, step->first_blew_up, off));
    else
        snprintf(why, sizeof why,
                 "the potential has a larger curvature than estimated from the target");
    snprintf(text, FIT_STEP_TEXT_SIZE,
             "time step of the verification: %s, %s of the one chosen before the fit, since %s; %s",
             used, part_text(step->halvings), why, bound);
}

// The verification --------------------------------------------------------------------------------

/// A kinetic temperature that is off by more than this is reported even if all targets agree.
static const double hot = 0.05;

/// Why the verification may differ from the samples of the fit: temperatures and how they depend on
/// the time step, tension, the number of particles.
static void find_cause(const struct verification *verification, double temperature,
                       const struct units *units, char cause[FIT_STEP_TEXT_SIZE]) {
    static const double tension = 3; // standard errors
    const struct thermodynamics_summary *found = &verification->thermodynamics;
    const bool holds = verification->step.result == VERIFY_STEP_HOLDS;
    const char *known = NULL, *dynamics = "";
    find_step_cause(verification, units, cause);
    if (found->temperature / temperature < 1 - hot) {
        known = "the friction is too weak to hold the temperature: increase the \"dissipative\" "
                "friction or shorten \"verification.time_step\"";
        dynamics = verification->dynamics;
    } else if (cause[0])
        return;
    else if (found->temperature / temperature > 1 + hot)
        known = "the temperature is off, and there are too few \"samples\" to tell whether the "
                "time step is the cause";
    else if (found->pressure < 0 && !(-found->pressure < tension * found->pressure_error))
        known = "the liquid is under tension, in which it may cavitate: g(r) does not determine "
                "the pressure, so give it as a second target";
    if (known == NULL && verification->unequilibrated[0])
        snprintf(
            cause, FIT_STEP_TEXT_SIZE,
            "it is not in equilibrium, %.150s: it may need a longer "
            "\"verification.equilibration\", or freeze, cavitate or condense with this potential, "
            "so that another temperature, density or target is needed",
            verification->unequilibrated);
    else if (known)
        snprintf(cause, FIT_STEP_TEXT_SIZE, "%s%s", known, dynamics);
    else if (verification->sampled > 0 && verification->sampled != verification->particles)
        snprintf(
            cause, FIT_STEP_TEXT_SIZE,
            "%sthe fit simulates %zu particles and the verification %zu: set \"particles\": %zu "
            "in the method to see whether the size is the cause, or try a longer "
            "\"equilibration\" of both",
            holds ? "the temperatures are right, but " : "", verification->sampled,
            verification->particles, verification->particles);
    else
        snprintf(cause, FIT_STEP_TEXT_SIZE, "%stry a longer \"equilibration\" of both",
                 holds ? "the temperatures are right and both systems have the same size: " : "");
}

/// Whether a Kirkwood-Buff integral is off.
static bool contradicts_integrals(const struct verification *verification,
                                  const struct units *units, char reason[INVERSE_REASON_SIZE]) {
    const struct verify_agreement *agreement = &verification->agreement[mf_kirkwood_buff_kind()];
    const struct target_distance *worst = &agreement->distance;
    const double volume = mf_units_factor(units, "lambda^d");
    char unit[UNITS_NAME_SIZE];
    if (verify_agreement_holds(agreement))
        return false;
    snprintf(reason, INVERSE_REASON_SIZE,
             "a Kirkwood-Buff integral of the verification is off by %.2g%.16s (statistical error "
             "%.2g), although the fit's samples agree with it: try more \"samples\", or more "
             "\"particles\", up to those of the scene",
             volume * worst->rms, mf_units_suffix(units, "lambda^d", unit), volume * worst->noise);
    return true;
}

/// "T = 1.02, pressure 3.4"; molecules that move by moves tell no temperature.
enum { STATE_SIZE = 96 };
static void report_state(const struct thermodynamics_summary *found, const struct units *units,
                         char text[STATE_SIZE]) {
    const double temperature =
        isnan(found->temperature) ? found->temperature_configurational : found->temperature;
    char unit[UNITS_NAME_SIZE], kelvin[UNITS_NAME_SIZE];
    int length = 0;
    if (!isnan(temperature))
        length = snprintf(text, STATE_SIZE, "T = %.3g%.8s, ",
                          mf_units_factor(units, "T_0") * temperature,
                          mf_units_suffix(units, "T_0", kelvin));
    snprintf(text + length, STATE_SIZE - (size_t)length, "pressure %.3g%.16s",
             mf_units_factor(units, "k_B T_0/lambda^d") * found->pressure,
             mf_units_suffix(units, "k_B T_0/lambda^d", unit));
}

/// Report a distribution that agrees in the samples of the fit and not in the verification.
/// @param[in] bins  of g(r); NULL: of a group
static void report_structure(const char *name, const struct rdf_bins *bins,
                             const struct verify_agreement *agreement,
                             const struct verification *verification, double temperature,
                             const struct units *units, char reason[INVERSE_REASON_SIZE]) {
    static const double beyond_doubt = 2;
    const struct target_distance *distance = &agreement->distance;
    const struct verify_stretch *stretch = &agreement->stretch;
    char state[STATE_SIZE], cause[FIT_STEP_TEXT_SIZE], where[100] = "", unit[UNITS_NAME_SIZE];
    report_state(&verification->thermodynamics, units, state);
    find_cause(verification, temperature, units, cause);
    // What few bins have most of, the rms hides.
    if (!(agreement->misfit > agreement->probable))
        snprintf(where, sizeof where,
                 "; more from r = %.3g%.8s on: chi^2 by bin is %.2g, by chance %.2g",
                 mf_units_factor(units, "lambda") *
                     mf_rdf_bins_centre(bins, stretch->first % bins->count),
                 mf_units_suffix(units, "lambda", unit), stretch->misfit, stretch->probable);
    else if (distance->rms < beyond_doubt * distance->noise)
        snprintf(where, sizeof where, "; in single bins more: chi^2 by bin is %.2g, by chance %.2g",
                 agreement->misfit, agreement->probable);
    snprintf(reason, INVERSE_REASON_SIZE,
             "the fit's samples agree with %.24s, but its verification is off by %.2g (statistical "
             "error %.2g%s) at %.60s: %.340s",
             name, distance->rms, distance->noise, where, state, cause);
}

/// Report pairs of a core, where the fit has no equations.
static void report_core(const struct rdf_bins *bins, const struct verify_agreement *agreement,
                        const struct units *units, char reason[INVERSE_REASON_SIZE]) {
    const struct verify_stretch *core = &agreement->stretch;
    char unit[UNITS_NAME_SIZE];
    snprintf(reason, INVERSE_REASON_SIZE,
             "the fit's samples agree with g(r), but in its verification pairs come as near as "
             "r = %.3g%.8s, where the target has none (%.2g times the statistical error, by chance "
             "up to %.2g): the potential of the core is too low; set a larger \"core.stiffness\", "
             "or narrower bins (\"bin_width\") if the target has them",
             mf_units_factor(units, "lambda") * mf_rdf_bins_centre(bins, core->first % bins->count),
             mf_units_suffix(units, "lambda", unit), sqrt(core->misfit), sqrt(core->probable));
}

/// Whether the kinetic temperature is off; the structure is then another, even within its noise.
static bool contradicts_temperature(const struct verification *verification, double temperature,
                                    const struct units *units, char reason[INVERSE_REASON_SIZE]) {
    const struct thermodynamics_summary *found = &verification->thermodynamics;
    char kelvin[UNITS_NAME_SIZE], cause[FIT_STEP_TEXT_SIZE];
    if (!verification->warning[0] || !(fabs(found->temperature / temperature - 1) > hot))
        return false;
    mf_units_suffix(units, "T_0", kelvin);
    find_cause(verification, temperature, units, cause);
    snprintf(reason, INVERSE_REASON_SIZE,
             "the temperature of the verification is %.4g%.8s, not %.4g%.8s: %s",
             mf_units_factor(units, "T_0") * found->temperature, kelvin,
             mf_units_factor(units, "T_0") * temperature, kelvin, cause);
    return true;
}

bool mf_fit_verification_contradicts(const struct verification *verification,
                                     const struct targets *fitted, double temperature,
                                     const struct units *units, char reason[INVERSE_REASON_SIZE]) {
    const struct verify_agreement *const agreement = verification->agreement;
    const double bar = mf_units_factor(units, "k_B T_0/lambda^d");
    char unit[UNITS_NAME_SIZE];
    mf_units_suffix(units, "k_B T_0/lambda^d", unit);
    const bool several = fitted->bins.count < fitted->target[TARGET_RDF].count;
    const struct thermodynamics_summary *found = &verification->thermodynamics;
    const struct target_distance *pressure = &agreement[TARGET_PRESSURE].distance;
    const struct target_distance *density = &agreement[TARGET_DENSITY].distance;
    if (targets_ask(fitted, TARGET_PRESSURE) &&
        !verify_agreement_holds(&agreement[TARGET_PRESSURE])) {
        char cause[FIT_STEP_TEXT_SIZE];
        if (mf_fit_step_shifts_pressure(verification))
            snprintf(cause, sizeof cause,
                     "its time step shifts it by about %.2g, as the configurational temperature "
                     "shows: set a shorter \"verification.time_step\"%s",
                     bar * verification->shift.pressure, verification->dynamics);
        else
            find_cause(verification, temperature, units, cause);
        snprintf(
            reason, INVERSE_REASON_SIZE,
            "the pressure of the verification, %.4g%.16s, is off by %.2g (statistical error %.2g): "
            "%s",
            bar * found->pressure, unit, bar * pressure->rms, bar * pressure->noise, cause);
        return true;
    }
    if (targets_ask(fitted, TARGET_DENSITY) &&
        !verify_agreement_holds(&agreement[TARGET_DENSITY])) {
        const double volume = mf_units_factor(units, "1/lambda^d");
        snprintf(reason, INVERSE_REASON_SIZE,
                 "the density of the verification, %.5g%.16s, is off by %.2g (statistical error "
                 "%.2g): try more \"samples\", or a longer \"equilibration\" of both",
                 volume * found->density, mf_units_suffix(units, "1/lambda^d", unit),
                 volume * density->rms, volume * density->noise);
        return true;
    }
    if (targets_ask(fitted, mf_kirkwood_buff_kind()) &&
        contradicts_integrals(verification, units, reason))
        return true;
    for (int order = 0; order <= INVERSE_LOCAL_DENSITY; order++) {
        const int kind = mf_group_kind_target(order);
        if (verify_agreement_holds(&agreement[kind]))
            continue;
        report_structure(mf_targets_name(kind), &fitted->bins, &agreement[kind], verification,
                         temperature, units, reason);
        return true;
    }
    if (!targets_ask(fitted, TARGET_RDF) || verify_agreement_holds(&agreement[TARGET_RDF]))
        return contradicts_temperature(verification, temperature, units, reason);
    const struct verify_stretch *stretch = &agreement[TARGET_RDF].stretch;
    const bool sound = !verification->warning[0] && !verification->unequilibrated[0];
    if (sound && stretch->core && stretch->misfit > stretch->probable)
        report_core(&fitted->bins, &agreement[TARGET_RDF], units, reason);
    else
        report_structure(several ? "g(r) of all pair types" : "g(r)", &fitted->bins,
                         &agreement[TARGET_RDF], verification, temperature, units, reason);
    return true;
}

void mf_fit_verification_add_units(const struct units *units, struct verification *verification) {
    char cause[FIT_STEP_TEXT_SIZE];
    find_step_cause(verification, units, cause);
    if (verification->warning[0] && cause[0]) {
        snprintf(verification->warning, sizeof verification->warning, "%s", cause);
        return;
    }
    if (verification->warning[0] == '\0' && verification->unequilibrated[0]) {
        snprintf(verification->warning, sizeof verification->warning,
                 "the verification is not in equilibrium: %s; a longer "
                 "\"verification.equilibration\" or "
                 "\"every\" may help",
                 verification->unequilibrated);
        return;
    }
    mf_units_convert_text(units, verification->warning, sizeof verification->warning);
}

/// Whether an error is larger by a quarter, and by five standard errors.
static bool is_larger(double verified, double own, double error, double variance) {
    static const double deviations = 5, part = 0.25;
    return verified > error + deviations * sqrt(variance + own) && verified > (1 + part) * error;
}

bool mf_fit_verification_is_worse(const struct verification *verification,
                                  const struct targets *targets, double error, double variance,
                                  char reason[INVERSE_REASON_SIZE]) {
    const double verified = mf_targets_error(targets, verification->distance);
    const double own = mf_targets_variance(targets, verification->distance);
    if (!is_larger(verified, own, error, variance))
        return false;
    snprintf(
        reason, INVERSE_REASON_SIZE,
        "the error measured by the fit is %.2g +- %.1g, that of its verification %.2g +- %.1g: the "
        "simulations of the fit were too short or their time step too long: try a longer "
        "\"equilibration\", more \"samples\" or a shorter time step",
        error, sqrt(variance), verified, sqrt(own));
    return true;
}

bool mf_fit_verification_is_worse_than_samples(const struct verification *verification,
                                               const struct targets *targets, double error,
                                               double variance, double temperature,
                                               const struct units *units,
                                               char reason[INVERSE_REASON_SIZE]) {
    const double verified = mf_targets_error(targets, verification->distance);
    const double own = mf_targets_variance(targets, verification->distance);
    char of_samples[NUMBER_TEXT_SIZE], of_verification[NUMBER_TEXT_SIZE], state[STATE_SIZE];
    char cause[FIT_STEP_TEXT_SIZE];
    if (!is_larger(verified, own, error, variance))
        return contradicts_temperature(verification, temperature, units, reason);
    mf_number_text(error, sqrt(variance), of_samples);
    mf_number_text(verified, sqrt(own), of_verification);
    report_state(&verification->thermodynamics, units, state);
    find_cause(verification, temperature, units, cause);
    snprintf(reason, INVERSE_REASON_SIZE,
             "the fit's samples differ from %s by %.16s%s, its verification by %.16s at %.60s: %s",
             mf_targets_count(targets) > 1 ? "the targets" : "the target", of_samples,
             mf_targets_count(targets) > 1 ? " of their errors (rms)" : "", of_verification, state,
             cause);
    return true;
}
