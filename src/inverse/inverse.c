// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/inverse.h"

const char *const inverse_unknown_names[UNKNOWNS] = {"potential", "weight"};

static const char *const shape_names[] = {"bezier", "bspline", NULL};

#define MEMBER(name) .offset = offsetof(struct unknown_parameters, name)
#define CURVE(its_genes, its_maximum, its_unit)                                                    \
    {"curve",                                                                                      \
     FIELD_CHOICE,                                                                                 \
     MEMBER(shape),                                                                                \
     .choices = shape_names,                                                                       \
     .initial = 0,                                                                                 \
     .unit = "",                                                                                   \
     .help = "that genes make: Bezier-smoothed random walk, or cubic B-splines"},                  \
        {"genes",      FIELD_INTEGER,   MEMBER(genes), .initial = its_genes,                       \
         .minimum = 1, .maximum = 1000, .unit = "",    .help = "of the curve"},                    \
        {"minimum",           FIELD_NUMBER,       MEMBER(minimum),  .initial = 0,                  \
         .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit, .help = "least gene"},         \
        {"maximum",           FIELD_NUMBER,       MEMBER(maximum),  .initial = its_maximum,        \
         .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit, .help = "largest gene"},

const struct field inverse_potential_fields[] = {
    CURVE(100, 6.5, "k_B T_0") // ends at the target's range
    FIELD_END,
};

const struct field inverse_weight_fields[] = {
    CURVE(100, 6.5, "sqrt(mu/tau)"){"inner_cutoff", FIELD_NUMBER, MEMBER(inner_cutoff),
                                    .initial = 0, .minimum = 0, .maximum = DBL_MAX,
                                    .unit = "lambda", .help = "below which omega is 0"},
    {"cutoff", FIELD_NUMBER, MEMBER(cutoff), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "where omega ends"},
    FIELD_END,
};

const struct inverse_method *const inverse_methods[] = {
    &imc, &matching_genetic, &matching_cmaes, &matching_nlopt, &gauss_newton, NULL};
