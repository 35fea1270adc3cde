// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_law.h"

#include <math.h>

#define AT_LEAST_ZERO .minimum = 0, .maximum = DBL_MAX

struct parameters {
    double k, angle; ///< [k_B T_0], [degrees]
};

#define MEMBER(name) .offset = offsetof(struct parameters, name)
#define STRENGTH(text)                                                                             \
    {                                                                                              \
        "k", FIELD_NUMBER, MEMBER(k), .required = true, AT_LEAST_ZERO, .unit = "k_B T_0",          \
                                      .help = text                                                 \
    }
#define ANGLE                                                                                      \
    {                                                                                              \
        "angle", FIELD_NUMBER, MEMBER(angle), .initial = 180, .minimum = 0, .maximum = 180,        \
                                              .unit = "degrees",                                   \
                                              .help = "theta_0, without strain; 180: straight"     \
    }

static double given_rest(const void *parameters) {
    return BONDED_RADIANS * ((const struct parameters *)parameters)->angle;
}

static double straight_rest(const void *parameters) {
    (void)parameters;
    return M_PI;
}

static void harmonic_evaluate(const void *parameters, size_t count, const double *theta,
                              double *energy, double *slope) {
    const struct parameters *p = parameters;
    const double rest = given_rest(p);
    for (size_t n = 0; n < count; n++) {
        energy[n] = 0.5 * p->k * (theta[n] - rest) * (theta[n] - rest);
        slope[n] = p->k * (theta[n] - rest);
    }
}

static const struct field harmonic_fields[] = {
    STRENGTH("per rad^2, in U = k (theta - theta_0)^2/2, as GROMACS has it; the K of LAMMPS is "
             "k/2"),
    ANGLE, FIELD_END};

const struct bonded_law mf_angle_harmonic = {
    .name = "harmonic",
    .summary = "U = k (theta - theta_0)^2/2",
    .fields = harmonic_fields,
    .size = sizeof(struct parameters),
    .evaluate = harmonic_evaluate,
    .rest = given_rest,
};

static void cosine_evaluate(const void *parameters, size_t count, const double *theta,
                            double *energy, double *slope) {
    const struct parameters *p = parameters;
    for (size_t n = 0; n < count; n++) {
        energy[n] = p->k * (1 + cos(theta[n]));
        slope[n] = -p->k * sin(theta[n]);
    }
}

static const struct field cosine_fields[] = {
    STRENGTH("in U = k (1 + cos theta), as the K of LAMMPS; a chain's bending stiffness"),
    FIELD_END};

const struct bonded_law mf_angle_cosine = {
    .name = "cosine",
    .summary = "U = k (1 + cos theta), least where the chain is straight",
    .fields = cosine_fields,
    .size = sizeof(struct parameters),
    .evaluate = cosine_evaluate,
    .rest = straight_rest,
};

static void squared_evaluate(const void *parameters, size_t count, const double *theta,
                             double *energy, double *slope) {
    const struct parameters *p = parameters;
    const double rest = cos(given_rest(p));
    for (size_t n = 0; n < count; n++) {
        const double away = cos(theta[n]) - rest;
        energy[n] = 0.5 * p->k * away * away;
        slope[n] = -p->k * away * sin(theta[n]);
    }
}

static const struct field squared_fields[] = {
    STRENGTH("in U = k (cos theta - cos theta_0)^2/2, as GROMACS has it (\"G96\"); the K of LAMMPS "
             "is k/2"),
    ANGLE, FIELD_END};

const struct bonded_law mf_angle_cosine_squared = {
    .name = "cosine-squared",
    .summary = "U = k (cos theta - cos theta_0)^2/2, as in Martini",
    .fields = squared_fields,
    .size = sizeof(struct parameters),
    .evaluate = squared_evaluate,
    .rest = given_rest,
};
