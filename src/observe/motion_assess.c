// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether diffusion coefficients can be trusted.
#include "observe/motion.h"

#include <math.h>
#include <stdio.h>

bool mf_motion_is_within(const struct motion_summary *s) {
    static const double enough = 4;
    return s->sizes > 0 && s->sizes < enough;
}

/// Whether the MSD is a line that does not go through 0, as in a dense liquid, and no power of t,
/// whose slope would change along the window, from five to seven eighths of it.
static bool is_straight(const struct motion_summary *s) {
    static const double errors = 2, part = 0.5;
    const double of_power = pow(7.0 / 5, s->growth - 1) - 1;
    return s->bend_error > 0 && fabs(s->bend) + errors * s->bend_error < part * fabs(of_power);
}

static bool grows_otherwise(const struct motion_summary *s) {
    static const double least = 0.85, most = 1.3, errors = 3;
    const bool is_far = s->growth < least || s->growth > most;
    return is_far && !(fabs(s->growth - 1) < errors * s->growth_error) && !is_straight(s);
}

static bool bends(const struct motion_summary *s) {
    static const double little = 0.05, errors = 3;
    return fabs(s->bend) > fmax(little, errors * s->bend_error) && s->bend_error > 0;
}

bool mf_motion_is_early(const struct motion_summary *s) {
    return mf_motion_is_within(s) || grows_otherwise(s) || bends(s);
}

/// "0.803(21)": the exponent, with its error where that is above a hundredth.
static void print_growth(const struct motion_summary *s, char text[NUMBER_TEXT_SIZE]) {
    static const double rounded = 0.01;
    if (s->growth_error >= rounded)
        mf_number_text(s->growth, s->growth_error, text);
    else
        snprintf(text, NUMBER_TEXT_SIZE, "%.2f", s->growth);
}

const char *mf_motion_early_text(const struct motion_summary *s, char text[MOTION_EARLY_SIZE]) {
    char growth[NUMBER_TEXT_SIZE];
    print_growth(s, growth);
    text[0] = '\0';
    if (grows_otherwise(s))
        snprintf(text, MOTION_EARLY_SIZE, "no D yet: the MSD still grows as t^%s", growth);
    else if (mf_motion_is_within(s))
        snprintf(text, MOTION_EARLY_SIZE, "no D yet: beads still move within their molecules");
    else if (bends(s))
        snprintf(text, MOTION_EARLY_SIZE,
                 "no D yet: the slope of the MSD still changes by %.0f %% along the window",
                 100 * s->bend);
    return text;
}

double mf_motion_green_kubo_uncertainty(const struct motion_summary *summary) {
    const double error = isnan(summary->green_kubo_error) ? 0 : summary->green_kubo_error;
    return hypot(hypot(error, summary->green_kubo_sampling), summary->green_kubo_truncation);
}

bool mf_motion_is_coarse(const struct motion_summary *s) {
    static const double coarse = 0.03;
    return s->green_kubo_sampling > fmax(coarse * fabs(s->green_kubo), s->green_kubo_error);
}

enum status mf_motion_assess(const struct motion_summary *s) {
    static const double deviations = 4;
    const double error = mf_motion_green_kubo_uncertainty(s);
    if (mf_motion_is_coarse(s))
        return mf_status_fail(STATUS_UNCONVERGED,
                              "D by Green and Kubo, %.3g" STATUS_DIFFUSION
                              ", may be off by %.2g" STATUS_DIFFUSION ": the VACF falls by %.0f "
                              "%% from one sample to the next; lower \"motion.every\"",
                              s->green_kubo, s->green_kubo_sampling, 100 * s->vacf_drop);
    // It is not known of one window.
    if (s->msd_error > 0 && fabs(s->msd - s->green_kubo) > deviations * hypot(s->msd_error, error))
        return mf_status_fail(STATUS_UNCONVERGED,
                              "D is %.3g" STATUS_DIFFUSION " by the MSD and %.3g" STATUS_DIFFUSION
                              " by Green and Kubo, with errors of %.1g" STATUS_DIFFUSION
                              " and %.1g" STATUS_DIFFUSION
                              ": a longer window (\"motion.lags\") may bring them together",
                              s->msd, s->green_kubo, s->msd_error, error);
    return STATUS_OK;
}
