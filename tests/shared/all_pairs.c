// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/all_pairs.h"

#include "base/rng.h"

#include <math.h>
#include <string.h>

double all_pairs_separation(const struct particles *particles, size_t i, size_t j, double r_ij[3]) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        r_ij[d] = box_nearest(particles->position[d][i] - particles->position[d][j],
                              particles->box.length[d]);
        square += r_ij[d] * r_ij[d];
    }
    return sqrt(square);
}

/// ζ: normal if friction is kept apart, uniform if it is added to the forces.
static double pair_noise(const struct pair_law *law, uint32_t a, uint32_t b, uint64_t step) {
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    const uint32_t word =
        rng_philox_lane((uint32_t)law->seed, (uint32_t)(law->seed >> 32), (uint32_t)step, low, high,
                        rng_stream_word(RNG_PAIR_NOISE, (uint32_t)(step >> 32)));
    return law->friction ? normal_of_word(&law->friction->normal, word)
                         : sqrt(12) * (double)(int32_t)word * 0x1p-32;
}

/// (F_D + F_R) · r̂ on particle i.
static double friction_and_noise(const struct pair_law *law, const struct particles *particles,
                                 size_t i, size_t j, const double r_ij[3], double r,
                                 uint64_t step) {
    double omega, speed = 0;
    const int pair =
        mf_composition_pair_of_ids(&law->composition, particles->id[i], particles->id[j]);
    mf_table_evaluate_pair(law->omega, pair, r, &omega, NULL, NULL);
    for (int d = 0; d < particles->box.dimensions; d++)
        speed += r_ij[d] / r * (particles->velocity[d][i] - particles->velocity[d][j]);
    const double zeta = pair_noise(law, particles->id[i], particles->id[j], step);
    return -omega * omega * speed + sqrt(2 * law->temperature / law->time_step) * omega * zeta;
}

bool all_pairs_excludes(const struct topology *topology, uint32_t i, uint32_t j) {
    if (topology == NULL)
        return false;
    for (size_t n = topology->excluded_start[i]; n < topology->excluded_start[i + 1]; n++)
        if (topology->excluded[n] == j)
            return true;
    return false;
}

void all_pairs_forces(const struct pair_law *law, struct particles *particles, uint64_t step,
                      struct pair_sums *sums) {
    const int dimensions = particles->box.dimensions;
    for (int d = 0; d < dimensions; d++)
        memset(particles->force[d], 0, particles->count * sizeof *particles->force[d]);
    struct pair_sums total = {0};
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = i + 1; j < particles->count; j++) {
            double r_ij[3];
            const double r = all_pairs_separation(particles, i, j, r_ij);
            double force = 0;
            if (all_pairs_excludes(particles->topology, particles->id[i], particles->id[j]))
                continue;
            if (law->potential && r < law->potential->cutoff) {
                double phi, slope;
                const int pair = mf_composition_pair_of_ids(&law->composition, particles->id[i],
                                                            particles->id[j]);
                mf_table_evaluate_pair(law->potential, pair, r, &phi, &slope, NULL);
                force -= slope;
                total.energy += phi;
                total.virial -= slope * r;
            }
            if (law->omega && r < law->omega->cutoff)
                force += friction_and_noise(law, particles, i, j, r_ij, r, step);
            for (int d = 0; d < dimensions; d++) {
                particles->force[d][i] += force * r_ij[d] / r;
                particles->force[d][j] -= force * r_ij[d] / r;
            }
        }
    if (sums)
        *sums = total;
}
