// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/inverse.h"

#include <math.h>
#include <stdio.h>

/// The error counts as statistical below this multiple of the noise of target and measurement: the
/// potential also carries the noise of the measurement before (a factor of up to sqrt 2), and the
/// errors of a target are themselves known to 10 to 20 %. Measured for SPC water: of twelve
/// iterations of imc that changed no more than noise, one came within 1.5 times the noise, six
/// within 1.7.
const double mf_inverse_noise_margin = 1.7;

const char *const mf_inverse_unknown_names[UNKNOWNS] = {
    "potential", "omega", "memory", "memory", "memory", "memory", "omega_transverse", "bonded"};

size_t mf_inverse_unknown_count(const struct inverse_problem *problem) {
    size_t count = problem->numbers;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        count += problem->unknown[kind].wanted;
    return count;
}

static const char *const potential_curves[] = {"bezier", "bspline", NULL};
static const char *const omega_curves[] = {"bezier", "bspline", "power", NULL};

/// In the order of enum unknown_base.
static const char *const potential_bases[] = {"none", "start", "mean-force", "hypernetted-chain",
                                              "auto", NULL};
static const char *const omega_bases[] = {"none", "start", NULL};

#define MEMBER(name) .offset = offsetof(struct unknown_parameters, name)
#define CURVE(its_names, its_bases, its_base, its_base_help, its_maximum, its_unit)                 \
    {"curve",                                                                                       \
     FIELD_CHOICE,                                                                                  \
     MEMBER(shape),                                                                                 \
     .choices = its_names,                                                                          \
     .initial = 0,                                                                                  \
     .unit = "",                                                                                    \
     .help = "smoothed random walk, cubic B-splines, or a power law"},                              \
        {"coefficients",                                                                            \
         FIELD_INTEGER,                                                                             \
         MEMBER(coefficients),                                                                      \
         .initial = 0,                                                                              \
         .minimum = 0,                                                                              \
         .maximum = 1000,                                                                           \
         .unit = "",                                                                                \
         .help = "number; 0: 100 (bezier), 12 (bspline) or those not "                              \
                 "fixed (power)"},                                                                  \
        {"base",     FIELD_CHOICE,         MEMBER(base), .choices = its_bases, .initial = its_base, \
         .unit = "", .help = its_base_help},                                                        \
        {"minimum",                                                                                 \
         FIELD_NUMBER,                                                                              \
         MEMBER(minimum),                                                                           \
         .initial = NAN,                                                                            \
         .minimum = -DBL_MAX,                                                                       \
         .maximum = DBL_MAX,                                                                        \
         .unit = its_unit,                                                                          \
         .help = "least coefficient; default: 0 without a base, else -maximum"},                    \
        {"maximum",           FIELD_NUMBER,       MEMBER(maximum),  .initial = its_maximum,         \
         .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit, .help = "largest coefficient"},

const struct field mf_inverse_potential_fields[] = {
    CURVE(potential_curves, potential_bases, BASE_AUTO,
          "what the curve is added to; auto: \"start\", else hypernetted-chain, where that fails "
          "mean-force, -k_B T ln g, less \"known\"; none with \"minimum\" or \"maximum\"",
          6.5, "k_B T_0") // ends at the target's range
    FIELD_END,
};

const struct field mf_inverse_omega_fields[] = {
    CURVE(omega_curves, omega_bases, BASE_NONE, "what the curve is added to", 6.5, "sqrt(mu/tau)"){
        "inner_cutoff", FIELD_NUMBER, MEMBER(inner_cutoff), .initial = 0, .minimum = 0,
        .maximum = DBL_MAX, .unit = "lambda", .help = "r at and below which omega is 0"},
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "cutoff of omega"},
    FIELD_END,
};

#define SHAPE(name) .offset = offsetof(struct bonded_shape, name)
const struct field mf_inverse_group_fields[] = {
    {"coefficients", FIELD_INTEGER, SHAPE(coefficients), .initial = 0, .minimum = 0, .maximum = 100,
     .unit = "",
     .help = "coefficients of methods that search, added to -k_B T ln(p/J): cubic B-splines, of "
             "dihedrals cos phi, sin phi, …; 0: 4, dihedrals 6"},
    {"maximum", FIELD_NUMBER, SHAPE(maximum), .initial = 2, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "k_B T_0", .help = "largest absolute coefficient"},
    FIELD_END,
};

const struct field mf_inverse_fixed_fields[] = {
    {"sigma", FIELD_NUMBER, INVERSE_SIGMA * sizeof(double), .initial = NAN, .minimum = 0,
     .maximum = DBL_MAX, .unit = "sqrt(mu/tau)", .help = "omega extrapolated to r = 0"},
    {"exponent", FIELD_NUMBER, INVERSE_EXPONENT * sizeof(double), .initial = NAN, .minimum = 0,
     .maximum = DBL_MAX, .unit = "", .help = "s, the exponent"},
    {"inner_cutoff", FIELD_NUMBER, INVERSE_INNER_CUTOFF * sizeof(double), .initial = NAN,
     .minimum = 0, .maximum = DBL_MAX, .unit = "lambda", .help = "r_0: omega is 0 at and below it"},
    FIELD_END,
};

int mf_inverse_free_parameters(const double fixed[INVERSE_PARAMETERS]) {
    int count = 0;
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        count += isnan(fixed[k]);
    return count;
}

/// An error that has fallen in this last part of the iterations still falls.
static const double recent = 0.25;

void mf_inverse_give_up(struct inverse_step *step) {
    step->exhausted = true;
    snprintf(step->reason, sizeof step->reason,
             "the algorithm found no better step, perhaps because the errors are noisy; its error "
             "is %.2g (statistical error %.2g)",
             step->error, step->noise);
}

void mf_inverse_exhaust(struct inverse_step *step, const char *parameter, uint32_t last_better) {
    const uint32_t iterations = step->iteration + 1, since = step->iteration - last_better;
    step->exhausted = true;
    if (iterations == 1)
        snprintf(
            step->reason, sizeof step->reason,
            "its \"%s\" are used up by the first iteration, with an error of %.2g (statistical "
            "error %.2g)",
            parameter, step->error, step->noise);
    else if (since <= recent * iterations)
        snprintf(step->reason, sizeof step->reason,
                 "its \"%s\" are used up; the error was still decreasing, to %.2g (statistical "
                 "error %.2g)",
                 parameter, step->error, step->noise);
    else
        snprintf(step->reason, sizeof step->reason,
                 "its \"%s\" are used up; the error, %.2g (statistical error %.2g), has not "
                 "decreased in the last %u of %u iterations",
                 parameter, step->error, step->noise, since, iterations);
}
