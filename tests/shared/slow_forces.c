// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/slow_forces.h"

#include "base/memory.h"
#include "shared/all_pairs.h"

#include <math.h>
#include <string.h>

/// Thickness of the shell inside the cutoff in which pairs are counted, relative to the cutoff.
static const double shell = 0.01;

static double shell_begin(const struct table *potential, int pair) {
    return (1 - shell) * table_cutoff(potential, pair);
}

static double density_at_cutoff(const struct table *potential, int pair, double r,
                                double temperature, int dimensions) {
    const double cutoff = table_cutoff(potential, pair);
    double phi;
    mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
    return pow(cutoff / r, dimensions - 1) * exp(phi / temperature) / (shell * cutoff);
}

static double edge_laplacian(const struct table *potential, int pair, double density) {
    double slope;
    mf_table_evaluate_pair(potential, pair, table_cutoff(potential, pair) * (1 - 1e-9), NULL,
                           &slope, NULL);
    return -2 * slope * density;
}

enum status slow_forces_configurational(const struct table *potential,
                                        const struct composition *composition, double temperature,
                                        const struct particles *particles,
                                        const struct neighbours *neighbours, double *const *known,
                                        double *const *others, double *squares, double *laplacian) {
    const int dimensions = particles->box.dimensions;
    OWNED double *force = NULL;
    double density[COMPOSITION_MAX_PAIRS] = {0}; // of each pair type
    *squares = *laplacian = 0;
    TRY_ARRAY(force, 3 * particles->count);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            if (j == i) // what is left of a row
                continue;
            double r_ij[3], slope, curvature;
            const double r = all_pairs_separation(particles, i, j, r_ij);
            const int pair =
                mf_composition_pair_of_ids(composition, particles->id[i], particles->id[j]);
            const double cutoff = table_cutoff(potential, pair);
            if (r >= cutoff)
                continue;
            mf_table_evaluate_pair(potential, pair, r, NULL, &slope, &curvature);
            if (r > shell_begin(potential, pair))
                density[pair] += density_at_cutoff(potential, pair, r, temperature, dimensions);
            *laplacian += 2 * (curvature + (dimensions - 1) * slope / r);
            for (int d = 0; d < dimensions; d++) {
                force[3 * i + (size_t)d] -= slope * r_ij[d] / r;
                force[3 * j + (size_t)d] += slope * r_ij[d] / r;
            }
        }
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++)
        *laplacian += edge_laplacian(potential, pair, density[pair]);
    for (size_t k = 0; k < 3 * particles->count; k++)
        *squares += force[k] * force[k];
    for (int d = 0; d < dimensions && known; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const double own = force[3 * k + (size_t)d];
            *squares += (own + known[d][k]) * (own + known[d][k] + others[d][k]) - own * own;
        }
    return STATUS_OK;
}

static bool is_of(uint32_t set, const struct many_body *many_body, uint32_t id) {
    return set >> mf_composition_type(&many_body->composition, id) & 1;
}

/// ρ_i of a term.
static double density_of(const struct many_body *many_body, const struct many_body_term *term,
                         const struct particles *particles, size_t i) {
    double density = 0, r_ij[3], weight;
    for (size_t j = 0; j < particles->count; j++) {
        const double r = all_pairs_separation(particles, i, j, r_ij);
        mf_weight_evaluate(&term->weight, r, &weight, NULL);
        if (j != i && is_of(term->neighbours, many_body, particles->id[j]))
            density += weight;
    }
    return density;
}

static void add_term(const struct many_body *many_body, const struct many_body_term *term,
                     const struct particles *particles, double *slope, double *const *force,
                     struct pair_sums *sums) {
    for (size_t i = 0; i < particles->count; i++) {
        const double density = density_of(many_body, term, particles, i);
        const double energy = mf_density_energy_value(&term->energy, density, &slope[i]);
        const bool central = is_of(term->central, many_body, particles->id[i]);
        slope[i] = central ? slope[i] : 0;
        sums->energy += central ? energy : 0;
    }
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < particles->count; j++) {
            double r_ij[3], change; // of w
            const double r = all_pairs_separation(particles, i, j, r_ij);
            if (i == j)
                continue;
            mf_weight_evaluate(&term->weight, r, NULL, &change);
            const bool i_counts = is_of(term->neighbours, many_body, particles->id[i]);
            const bool j_counts = is_of(term->neighbours, many_body, particles->id[j]);
            const double pull = -(slope[i] * j_counts + slope[j] * i_counts) * change;
            for (int d = 0; d < particles->box.dimensions; d++)
                force[d][i] += pull * r_ij[d] / r;
            sums->virial += 0.5 * pull * r;
        }
}

enum status slow_forces_many_body(const struct many_body *many_body,
                                  const struct particles *particles, double *const *force,
                                  struct pair_sums *sums) {
    OWNED double *slope = NULL;
    TRY_ARRAY(slope, particles->count);
    for (int t = 0; t < many_body->terms; t++)
        add_term(many_body, &many_body->term[t], particles, slope, force, sums);
    return STATUS_OK;
}
