// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_choice.h"

#include <math.h>
#include <string.h>

/// In a gas collisions are rare, and no pair may lose more than a tenth of its velocity a step.
double mf_fit_defaults_sigma(const struct fit_choice *c, double cutoff) {
    static const double strongest = 0.1;
    const double rate = mf_fit_scales_friction(c->rdf, cutoff) / c->mass;
    return sqrt(fmin(1 / (rate * c->crossing), strongest * c->mass / c->time_step));
}

/// A power law: its parameters are few, and its start is one. A steep one needs more at r = 0.
static enum status choose_power(struct fit_choice *c, double largest, double cutoff) {
    static const char *const path = "unknowns.omega";
    static const double steeper = 3;
    const bool steep = mf_fit_choice_lacks(c->root, "unknowns.omega.fixed", "exponent");
    char most[FIT_CHOICE_TEXT_SIZE], to[FIT_CHOICE_TEXT_SIZE];
    largest *= steep ? steeper : 1;
    mf_fit_choice_note(c, "omega: a power law of 1 - r/(%s), at r = 0 from 0 to %s",
                       mf_fit_choice_text(c, "lambda", cutoff, to),
                       mf_fit_choice_text(c, "sqrt(mu/tau)", largest, most));
    return mf_fit_choice_give(c, path, mf_inverse_omega_fields, "maximum", largest);
}

/// A spline from where pairs begin.
static enum status choose_spline(struct fit_choice *c, double largest, double cutoff) {
    static const char *const path = "unknowns.omega";
    enum { COEFFICIENTS = 8 };
    char most[FIT_CHOICE_TEXT_SIZE], from[FIT_CHOICE_TEXT_SIZE], to[FIT_CHOICE_TEXT_SIZE];
    mf_fit_choice_note(c, "omega: %d coefficients from 0 to %s, between r = %s and %s, %s",
                       COEFFICIENTS, mf_fit_choice_text(c, "sqrt(mu/tau)", largest, most),
                       mf_fit_choice_text(c, "lambda", c->scales.core, from),
                       mf_fit_choice_text(c, "lambda", cutoff, to),
                       "about the end of the second shell");
    TRY(mf_fit_choice_give(c, path, mf_inverse_omega_fields, "maximum", largest));
    TRY(mf_fit_choice_give(c, path, mf_inverse_omega_fields, "coefficients", COEFFICIENTS));
    return mf_fit_choice_give_text(c->root, path, "curve", "bspline");
}

static bool is_power(const struct json_object *root) {
    struct json_object omega = mf_fit_choice_object(root, "unknowns.omega");
    return mf_json_has(&omega, "curve") &&
           strcmp(mf_json_choice(&omega, "curve", NULL, ""), "power") == 0;
}

enum status mf_fit_defaults_omega(struct fit_choice *c) {
    static const char *const path = "unknowns.omega";
    static const double shells = 2, beyond_etd = 1.3, max = 6;
    if (!c->finds[UNKNOWN_OMEGA] || !mf_fit_choice_lacks(c->root, path, "cutoff") ||
        !mf_fit_choice_lacks(c->root, path, "maximum"))
        return STATUS_OK;
    const double cutoff =
        fmin(c->range, fmax(shells * c->scales.shell,
                            beyond_etd * target_files_etd(&c->read->files)->grid.r_maximum));
    const double sigma = mf_fit_defaults_sigma(c, cutoff);
    TRY(mf_fit_choice_give(c, path, mf_inverse_omega_fields, "cutoff", cutoff));
    TRY(mf_fit_choice_give(c, path, mf_inverse_omega_fields, "inner_cutoff", c->scales.core));
    TRY(is_power(c->root) ? choose_power(c, max * sigma, cutoff)
                          : choose_spline(c, max * sigma, cutoff));
    return mf_fit_choice_give_omega(c, "unknowns.omega.start", sigma, cutoff);
}
