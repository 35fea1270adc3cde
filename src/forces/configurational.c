// SPDX-License-Identifier: GPL-3.0-or-later
//
// Distances of a stretch of a particle's row come first, a vector at a time; those in range are
// packed, and the table is read for them alone.
#include "forces/configurational.h"

#include "base/memory.h"
#include "base/simd.h"

#include <math.h>

/// Entries of a row that are looked at together.
enum { STRETCH = 128 };

/// Particles of a row, and those of them that a pair type has within its cutoff.
struct stretch {
    double apart[3][STRETCH], square[STRETCH];
    int pair[STRETCH];
    int count, at[STRETCH];    ///< in range: how many, and where they stand
    double packed[STRETCH];    ///< their r² [λ²]
    double slope[STRETCH];     ///< Φ'/r [k_B T_0/λ²]
    double curvature[STRETCH]; ///< Φ'' [k_B T_0/λ²]
};

/// What the pairs of a configuration add up to.
struct sums {
    const struct table *potential;
    const struct particles *particles;
    double temperature;
    double *force;                         ///< shape [particles, 3]
    double density[COMPOSITION_MAX_PAIRS]; ///< of each pair type at its cutoff
    double laplacian;
};

/// Nearest images of the particles of a list, as seen from particle i.
SIMD_CLONES static void find_apart(const struct particles *particles, size_t i, const int32_t *list,
                                   int count, struct stretch *stretch) {
    for (int n = 0; n < count; n++)
        stretch->square[n] = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d], inverse = 1 / length;
        const double *position = particles->position[d];
        for (int n = 0; n < count; n++) {
            const double apart = position[i] - position[list[n]];
            const double nearest = apart - length * rint(apart * inverse);
            stretch->apart[d][n] = nearest;
            stretch->square[n] += nearest * nearest;
        }
    }
}

static void find_pairs(const struct composition *composition, const struct particles *particles,
                       size_t i, const int32_t *list, int count, struct stretch *stretch) {
    for (int n = 0; n < count; n++)
        stretch->pair[n] = mf_composition_pair_of_ids(composition, particles->id[i],
                                                      particles->id[(size_t)list[n]]);
}

/// Those of a pair type in range. Particle i itself is what is left of its row.
static void pack(struct stretch *stretch, int count, int pair, double cutoff, size_t i,
                 const int32_t *list) {
    int used = 0;
    for (int n = 0; n < count; n++) {
        stretch->at[used] = n;
        stretch->packed[used] = stretch->square[n];
        used += stretch->pair[n] == pair && stretch->square[n] < cutoff * cutoff &&
                list[n] != (int32_t)i;
    }
    stretch->count = used;
}

/// Φ'/r and Φ'' of the pairs in range.
SIMD_CLONES static void evaluate(const struct table *potential, int pair, struct stretch *stretch) {
    const double inverse = mf_table_inverse_spacing(potential, pair);
    const double *coefficient =
        potential->coefficient + 4 * (ptrdiff_t)pair * table_stride(potential);
    for (int n = 0; n < stretch->count; n++) {
        const double r = sqrt(stretch->packed[n]), place = r * inverse;
        const int k = (int)place;
        const double f = place - k, *c = coefficient + 4 * k;
        stretch->slope[n] = inverse * (c[1] + f * (2 * c[2] + f * 3 * c[3])) / r;
        stretch->curvature[n] = inverse * inverse * (2 * c[2] + 6 * f * c[3]);
    }
}

static void add_forces(struct sums *sums, const struct stretch *stretch, size_t i,
                       const int32_t *list) {
    double *force = sums->force, own[3] = {0}, laplacian = 0;
    const int dimensions = sums->particles->box.dimensions;
    for (int n = 0; n < stretch->count; n++) {
        const int at = stretch->at[n];
        for (int d = 0; d < dimensions; d++) {
            const double part = stretch->slope[n] * stretch->apart[d][at];
            own[d] += part;
            force[3 * (size_t)list[at] + (size_t)d] += part;
        }
        laplacian += stretch->curvature[n] + (dimensions - 1) * stretch->slope[n];
    }
    for (int d = 0; d < dimensions; d++)
        force[3 * i + (size_t)d] -= own[d];
    sums->laplacian += 2 * laplacian;
}

/// Thickness of the shell inside the cutoff in which pairs are counted, relative to the cutoff.
static const double shell = 0.01;

static double shell_begin(const struct table *potential, int pair) {
    return (1 - shell) * table_cutoff(potential, pair);
}

/// What a pair in the shell says of the density of pairs at the cutoff, where Φ = 0: those nearer
/// have less room, and are rarer or more frequent by exp(−Φ/k_B T).
static double density_at_cutoff(const struct table *potential, int pair, double r,
                                double temperature, int dimensions) {
    const double cutoff = table_cutoff(potential, pair);
    double phi;
    mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
    return pow(cutoff / r, dimensions - 1) * exp(phi / temperature) / (shell * cutoff);
}

/// Σ∇²U of the cutoff: the slope jumps to 0 there, which is a Dirac peak of Φ'' seen by the pairs
/// that are just there, of which `density` are so many in a length [1/λ].
static double edge_laplacian(const struct table *potential, int pair, double density) {
    double slope;
    mf_table_evaluate_pair(potential, pair, table_cutoff(potential, pair) * (1 - 1e-9), NULL,
                           &slope, NULL);
    return -2 * slope * density;
}

static void add_density(struct sums *sums, const struct stretch *stretch, int pair) {
    const double begin = shell_begin(sums->potential, pair);
    for (int n = 0; n < stretch->count; n++)
        if (stretch->packed[n] > begin * begin)
            sums->density[pair] +=
                density_at_cutoff(sums->potential, pair, sqrt(stretch->packed[n]),
                                  sums->temperature, sums->particles->box.dimensions);
}

static void add_stretch(struct sums *sums, const struct composition *composition, size_t i,
                        const int32_t *list, int count) {
    struct stretch stretch;
    find_apart(sums->particles, i, list, count, &stretch);
    find_pairs(composition, sums->particles, i, list, count, &stretch);
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        pack(&stretch, count, pair, table_cutoff(sums->potential, pair), i, list);
        evaluate(sums->potential, pair, &stretch);
        add_forces(sums, &stretch, i, list);
        add_density(sums, &stretch, pair);
    }
}

enum status mf_configurational(const struct table *potential, const struct composition *composition,
                               double temperature, const struct particles *particles,
                               const struct neighbours *neighbours, double *const *known,
                               double *const *others, double *squares, double *laplacian) {
    OWNED double *force = NULL;
    TRY_ARRAY(force, 3 * particles->count);
    struct sums sums = {potential, particles, temperature, force, {0}, 0};
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k += STRETCH) {
            const size_t left = neighbours->stop[i] - k;
            add_stretch(&sums, composition, i, neighbours->list + k,
                        left < STRETCH ? (int)left : STRETCH);
        }
    *laplacian = sums.laplacian;
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++)
        *laplacian += edge_laplacian(potential, pair, sums.density[pair]);
    *squares = 0;
    for (size_t k = 0; k < 3 * particles->count; k++)
        *squares += force[k] * force[k];
    for (int d = 0; d < particles->box.dimensions && known; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const double own = force[3 * k + (size_t)d];
            *squares += (own + known[d][k]) * (own + known[d][k] + others[d][k]) - own * own;
        }
    return STATUS_OK;
}
