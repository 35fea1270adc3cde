// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/hnc_closure.h"

#include <math.h>

/// The transform back is periodic in r with twice this many ranges of the target: h − c of liquids
/// has died away well before.
static const double ranges = 8;

/// S(q) counts as no less in h − c. Measured: with 0.01 the noise of a soft fluid's g, S(0) = 0.06,
/// made a potential so wrong (g off by 0.9) that no inversion came back from it.
static const double least_structure = 0.1;

static const double pi = 3.14159265358979323846;

/// Transform of 1 for r < edge, 0 beyond: 4π (sin x − x cos x)/q³, x = q edge.
static double ball(double q, double edge) {
    const double x = q * edge;
    if (x < 1e-2) // the difference cancels; the series is exact to 1e-13 there
        return 4 * pi / 3 * edge * edge * edge * (1 - x * x / 10 + x * x * x * x / 280);
    return 4 * pi * (sin(x) - x * cos(x)) / (q * q * q);
}

/// Transform at q of `values` − `zero` in the bins and of `core` below the first.
static double transform(const struct rdf_bins *bins, const double *values, double zero, double core,
                        double q) {
    double inner = ball(q, rdf_bins_edge(bins, 0)), sum = core * inner;
    for (size_t k = 0; k < bins->count; k++) {
        const double outer = ball(q, rdf_bins_edge(bins, k + 1));
        sum += (values[k] - zero) * (outer - inner);
        inner = outer;
    }
    return sum;
}

/// h − c of g, or with a `difference` of g its change.
static enum status solve(const struct rdf_bins *bins, const struct box *box, size_t count,
                         const double *g, const double *difference, double ridge,
                         double *indirect) {
    if (box->dimensions != 3)
        return status_fail(STATUS_BAD_INPUT, "the hypernetted chain is for three dimensions");
    const double density = (double)count / (box->length[0] * box->length[1] * box->length[2]);
    const double spacing = pi / (ranges * rdf_bins_range(bins));
    const size_t waves = (size_t)(pi / bins->width / spacing);
    for (size_t k = 0; k < bins->count; k++)
        indirect[k] = 0;
    for (size_t wave = 1; wave <= waves; wave++) {
        const double q = (double)wave * spacing, h = transform(bins, g, 1, -1, q);
        const double structure = 1 + density * h;
        const double gamma = difference ? (1 - 1 / (structure * structure + ridge * ridge)) *
                                              transform(bins, difference, 0, 0, q)
                                        : density * h * h / fmax(structure, least_structure);
        for (size_t k = 0; k < bins->count; k++) {
            const double r = rdf_bins_centre(bins, k);
            indirect[k] += q * gamma * sin(q * r) / r * spacing / (2 * pi * pi);
        }
    }
    return STATUS_OK;
}

enum status hnc_closure(const struct rdf_bins *bins, const struct box *box, size_t count,
                        const double *g, double *indirect) {
    return solve(bins, box, count, g, NULL, 0, indirect);
}

enum status hnc_closure_slope(const struct rdf_bins *bins, const struct box *box, size_t count,
                              const double *g, const double *difference, double ridge,
                              double *indirect) {
    return solve(bins, box, count, g, difference, ridge, indirect);
}
