// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/hard_spheres.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double hard_spheres_density(double eta) {
    return 6 * eta / pi;
}

/// c = a + b r + d r³ within the diameter.
static void coefficients(double eta, double *a, double *b, double *d) {
    const double square = pow(1 + 2 * eta, 2), fourth = pow(1 - eta, 4);
    *a = -square / fourth;
    *b = 6 * eta * pow(1 + 0.5 * eta, 2) / fourth;
    *d = 0.5 * eta * *a;
}

double hard_spheres_c(double eta, double r) {
    double a, b, d;
    coefficients(eta, &a, &b, &d);
    return r < 1 ? a + b * r + d * r * r * r : 0;
}

double hard_spheres_compressibility(double eta) {
    return pow(1 - eta, 4) / pow(1 + 2 * eta, 2);
}

/// ĉ(q) = (4π/q) ∫_0^1 r c(r) sin(qr) dr, by parts.
static double transform_c(double eta, double q) {
    double a, b, d;
    coefficients(eta, &a, &b, &d);
    const double s = sin(q), c = cos(q), q2 = q * q;
    const double first = (s - q * c) / q2;
    const double second = (2 * q * s - (q2 - 2) * c - 2) / (q2 * q);
    const double fourth =
        (4 * q * (q2 - 6) * s - (q2 * q2 - 12 * q2 + 24) * c + 24) / (q2 * q2 * q);
    return 4 * pi / q * (a * first + b * second + d * fourth);
}

/// h = c + the transform back of the smooth ĥ − ĉ = ρĉ²/(1 − ρĉ), which falls off as 1/q⁴.
double hard_spheres_h(double eta, double r) {
    const double density = hard_spheres_density(eta), step = 0.02, last = 400;
    double sum = 0;
    if (r < 1)
        return -1;
    for (double q = step; q < last; q += step) {
        const double c = transform_c(eta, q);
        sum += q * density * c * c / (1 - density * c) * sin(q * r) * step;
    }
    return sum / (2 * pi * pi * r);
}
