// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/finite_size.h"

#include "observe/kirkwood_buff.h"

#include <math.h>

/// Of N: a larger s is no small correction.
static const double max = 0.05;

double mf_finite_size_factor(double s, double from, double to) {
    return (1 + (s - 1) / from) / (1 + (s - 1) / to);
}

/// N_a² and N_a N_b: twice the possible pairs of like beads in a large system, and all of unlike.
static double ordered_pairs(const struct composition *composition, const int type[2]) {
    return (double)composition->count[type[0]] * (double)composition->count[type[1]];
}

double mf_finite_size_intramolecular(const struct finite_size_fluid *fluid, int pair) {
    int type[2];
    if (fluid->topology == NULL)
        return 0;
    mf_composition_pair_types(fluid->composition, pair, type);
    const double inside =
        mf_topology_intramolecular_pairs(fluid->topology, type, !fluid->intermolecular);
    return mf_box_volume(fluid->box) * inside / ordered_pairs(fluid->composition, type);
}

/// Numbers of molecules fluctuate as those of an ideal mixture, M_k, but for Σ n_k M_k, their
/// beads; a single bead is a molecule of its own.
double mf_finite_size_rigid(const struct finite_size_fluid *fluid, int pair) {
    const struct topology *topology = fluid->topology;
    const struct composition *composition = fluid->composition;
    const double all = (double)mf_composition_particles(composition);
    int type[2];
    if (topology == NULL)
        return 0;
    mf_composition_pair_types(composition, pair, type);
    double single[2], filled[2], capacity = all, together = 0;
    for (int t = 0; t < 2; t++)
        filled[t] = single[t] = (double)composition->count[type[t]];
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        const double count = (double)kind->count, beads = kind->beads;
        double own[2];
        for (int t = 0; t < 2; t++) {
            own[t] = mf_topology_beads_of(kind, type[t]);
            single[t] -= count * own[t];
            filled[t] += count * (beads - 1) * own[t];
        }
        capacity += count * beads * (beads - 1);
        together += count * own[0] * own[1];
    }
    const bool alike = type[0] == type[1];
    const double fluctuation =
        together + (alike ? single[0] : 0) - filled[0] * filled[1] / capacity;
    const double self = alike ? (double)composition->count[type[0]] : 0;
    return 1 + all * (fluctuation - self) / ordered_pairs(composition, type);
}

/// The least s of a pair type: fluctuations of a number, 1 + ρ_a G_aa, are not negative.
static double min(const struct composition *composition, int pair) {
    int type[2];
    mf_composition_pair_types(composition, pair, type);
    const double share =
        (double)composition->count[type[0]] / (double)mf_composition_particles(composition);
    return type[0] == type[1] ? 1 - 1 / share : -INFINITY;
}

double mf_finite_size_factor_of(const struct rdf_bins *bins, const double *g, const double *error,
                                const struct finite_size_fluid *fluid, int pair, double from,
                                double to) {
    if (from == to)
        return 1;
    const double rigid = mf_finite_size_rigid(fluid, pair);
    double s = rigid;
    if (fluid->box->dimensions == 3) {
        const double share = from / (double)mf_composition_particles(fluid->composition);
        const struct box measured = mf_box_scaled(fluid->box, share);
        const double inside = mf_finite_size_intramolecular(fluid, pair);
        const struct kirkwood_buff kb =
            mf_kirkwood_buff_of_range(bins, g, error, &measured, (size_t)from, inside);
        const double variance = kb.compressibility_error * kb.compressibility_error;
        const double seen = fmax(kb.compressibility, min(fluid->composition, pair));
        const double away = seen - rigid;
        if (variance < away * away && fabs(seen) < max * from)
            s = rigid + (away - variance / away);
    }
    return mf_finite_size_factor(s, from, to);
}

double mf_finite_size_diffusion(double temperature, double viscosity, double density,
                                double diffusion, double edge) {
    static const double lattice = 2.837297; // of periodic point forces in a cube
    return lattice * temperature / (6 * M_PI * (viscosity + density * diffusion) * edge);
}
