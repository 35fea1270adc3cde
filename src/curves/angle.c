// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_batch.h"
#include "curves/bonded_table.h"

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
                                              .help = "theta_0, the equilibrium angle"             \
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
    STRENGTH("k of GROMACS, per rad^2; the K of LAMMPS is k/2"), ANGLE, FIELD_END};

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

static const struct field cosine_fields[] = {STRENGTH("bending stiffness, the K of LAMMPS"),
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
    STRENGTH("k of GROMACS (\"G96\"); the K of LAMMPS is k/2"), ANGLE, FIELD_END};

const struct bonded_law mf_angle_cosine_squared = {
    .name = "cosine-squared",
    .summary = "U = k (cos theta - cos theta_0)^2/2, as in Martini",
    .fields = squared_fields,
    .size = sizeof(struct parameters),
    .evaluate = squared_evaluate,
    .rest = given_rest,
};

BONDED_TABLE(mf_angle_table, "columns theta [degrees], U",
             "cubic spline through the points of a file, straight lines beyond its ends");

// Geometry: a = r_0 − r_1 and b = r_2 − r_1 -------------------------------------------------------

/// θ by its sine and cosine, exact at all angles.
SIMD_CLONES static void measure(struct bonded_batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double a[3], b[3], normal[3];
        bonded_take(batch->arm[0], n, a);
        bonded_take(batch->arm[1], n, b);
        bonded_cross(a, b, normal);
        batch->q[n] = atan2(sqrt(bonded_dot(normal, normal)), bonded_dot(a, b));
    }
}

/// With p = a × b, ∂θ/∂a = a × p/(a² |p|) and ∂θ/∂b = p × b/(b² |p|), away from each other in their
/// plane.
SIMD_CLONES static void push(struct bonded_batch *batch) {
    for (int n = 0; n < batch->count; n++) {
        double a[3], b[3], p[3], first[3], last[3];
        bonded_take(batch->arm[0], n, a);
        bonded_take(batch->arm[1], n, b);
        bonded_cross(a, b, p);
        const double aa = bonded_dot(a, a), bb = bonded_dot(b, b), length = sqrt(bonded_dot(p, p));
        const double turn =
            length > BONDED_NO_DIRECTION * sqrt(aa * bb) ? -batch->slope[n] / length : 0;
        bonded_cross(a, p, first);
        bonded_cross(p, b, last);
        for (int d = 0; d < 3; d++) {
            batch->arm[0][d][n] = turn != 0 ? turn / aa * first[d] : 0;
            batch->arm[1][d][n] = turn != 0 ? turn / bb * last[d] : 0;
        }
    }
}

/// Of (sin θ)^(d−2).
static double jacobian(int dimensions, double low, double width) {
    const double from = fmax(0, low), to = fmin(180, low + width);
    return dimensions == 3 ? cos(from * BONDED_RADIANS) - cos(to * BONDED_RADIANS)
                           : (to - from) * BONDED_RADIANS;
}

static const struct bonded_law *const laws[] = {&mf_angle_harmonic, &mf_angle_cosine,
                                                &mf_angle_cosine_squared, &mf_angle_table, NULL};

const struct bonded_kind mf_angle = {
    .name = "angle",
    .plural = "angles",
    .article = "an",
    .beads = 3,
    .reach = 2,
    .chain = {0, 1, 2},
    .arms = 2,
    .arm = {{0, 1}, {2, 1}},
    .measure = measure,
    .push = push,
    .jacobian = jacobian,
    BONDED_ANGLES,
    .high = 180,
    .laws = laws,
    .table = &mf_angle_table,
    .narrow = 1,
    .fine = 9000,
    .cost = 40,
    .common = true,
};
