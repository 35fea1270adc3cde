// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/finite_size.h"

#include "observe/kirkwood_buff.h"

#include <math.h>

/// The scatter of s is that over so many ranges, from this part of the bins on to all of them.
enum { RANGES = 16 };
static const double shortest_range = 0.7;

/// Of N: a larger s is no small correction.
static const double most = 0.05;

double mf_finite_size_factor(double s, double from, double to) {
    return (1 + (s - 1) / from) / (1 + (s - 1) / to);
}

/// s = 1 + ρG by all bins, and the variance of it.
static double measure(const struct rdf_bins *bins, const double *g, const double *error,
                      const struct box *box, size_t particles, double *variance) {
    const struct kirkwood_buff whole = mf_kirkwood_buff_integrate(bins, g, error, box, particles);
    double squares = 0;
    for (int k = 0; k < RANGES; k++) {
        const double part = shortest_range + (1 - shortest_range) * k / RANGES;
        struct rdf_bins fewer = *bins;
        fewer.count = (size_t)ceil(part * (double)bins->count);
        squares +=
            pow(mf_kirkwood_buff_integrate(&fewer, g, error, box, particles).compressibility -
                    whole.compressibility,
                2);
    }
    *variance = squares / RANGES + whole.compressibility_error * whole.compressibility_error;
    return whole.compressibility;
}

/// The least s of a pair type: fluctuations of a number, 1 + ρ_a G_aa, are not negative.
static double least(const struct composition *composition, int pair) {
    int type[2];
    mf_composition_pair_types(composition, pair, type);
    const double share =
        (double)composition->count[type[0]] / (double)mf_composition_particles(composition);
    return type[0] == type[1] ? 1 - 1 / share : -INFINITY;
}

double mf_finite_size_factor_of(const struct rdf_bins *bins, const double *g, const double *error,
                                const struct box *box, const struct composition *composition,
                                int pair, double from, double to) {
    double s = 0, variance;
    if (from == to)
        return 1;
    if (box->dimensions == 3) {
        const double share = from / (double)mf_composition_particles(composition);
        const struct box measured = mf_box_scaled(box, share);
        s = fmax(measure(bins, g, error, &measured, (size_t)from, &variance),
                 least(composition, pair));
        s = variance < s * s && fabs(s) < most * from ? s - variance / s : 0;
    }
    return mf_finite_size_factor(s, from, to);
}

double mf_finite_size_diffusion(double temperature, double viscosity, double density,
                                double diffusion, double edge) {
    static const double lattice = 2.837297; // of periodic point forces in a cube
    return lattice * temperature / (6 * M_PI * (viscosity + density * diffusion) * edge);
}
