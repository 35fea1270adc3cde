// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_step.h"

#include <math.h>
#include <stdio.h>

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

bool mf_fit_step_was_shortened(const struct verification *verification) {
    return verification->step.halvings > 0;
}

bool mf_fit_step_shifts_pressure(const struct verification *verification) {
    static const double errors = 2;
    const struct thermodynamics_shift *shift = &verification->shift;
    return fabs(shift->pressure) >
           fmax(errors * shift->error, verification->thermodynamics.pressure_error);
}

void mf_fit_step_cause(const struct verification *verification, const struct units *units,
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
                 "%s: the time step, %s, is too long for this potential; use about %s", off, used,
                 time_text(units, round_down(step->would_hold), holds));
}

void mf_fit_step_text(const struct verification *verification, const struct units *units,
                      char text[FIT_STEP_TEXT_SIZE]) {
    const struct verify_step *step = &verification->step;
    char used[TIME_SIZE], first[TIME_SIZE], off[OFF_SIZE], why[OFF_SIZE + TIME_SIZE + 8], bound[64];
    text[0] = '\0';
    if (step->result == VERIFY_STEP_LONG || step->result == VERIFY_STEP_NOT_THE_CAUSE) {
        mf_fit_step_cause(verification, units, text);
        return;
    }
    if (!step->shortens)
        return;
    if (step->result == VERIFY_STEP_UNKNOWN)
        snprintf(bound, sizeof bound, "too few samples to check it");
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
