// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/pair_scales.h"

#include "base/memory.h"
#include "shared/testing.h"

static double separation(const struct particles *particles, size_t i, size_t j) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                      particles->box.length[d]);
        square += dx * dx;
    }
    return sqrt(square);
}

/// |F| + r |dF/dr| of the potential.
static double conservative_scale(const struct table *potential, int pair, double r) {
    double slope, curvature;
    mf_table_evaluate_pair(potential, pair, r, NULL, &slope, &curvature);
    return fabs(slope) + r * fabs(curvature);
}

/// The same for friction at a relative velocity of 4 and noise at its largest. Where ω jumps, the
/// slope is that of one interval of the table; a rounding may fall on either side of its ends.
static double dissipative_scale(const struct pair_law *law, int pair, double r) {
    double omega = 0, slope = 0;
    for (int side = -1; side <= 1; side++) {
        double value, steepness;
        mf_table_evaluate_pair(law->omega, pair, fmin(r * (1 + 1e-6 * side), law->omega->cutoff),
                               &value, &steepness, NULL);
        omega = fmax(omega, fabs(value));
        slope = fmax(slope, fabs(steepness));
    }
    const double zeta = law->friction ? 6.4 : sqrt(3);
    const double noise = sqrt(2 * law->temperature / law->time_step) * zeta;
    return noise * (omega + r * slope) + 4 * omega * (omega + 2 * r * slope);
}

struct pair_scales pair_scales_find(const struct pair_law *law, const struct particles *particles) {
    struct pair_scales scales = {.force = mf_memory_zeroed(particles->count, sizeof(double))};
    assert_non_null(scales.force);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = i + 1; j < particles->count; j++) {
            const double r = separation(particles, i, j);
            const int pair =
                mf_composition_pair_of_ids(&law->composition, particles->id[i], particles->id[j]);
            double force = 0, phi, slope;
            if (law->potential && r < law->potential->cutoff) {
                mf_table_evaluate_pair(law->potential, pair, r, &phi, &slope, NULL);
                scales.energy += fabs(phi);
                scales.virial += fabs(r * slope);
                force += conservative_scale(law->potential, pair, r);
            }
            if (law->omega && r < law->omega->cutoff) {
                force += dissipative_scale(law, pair, r);
                scales.near++;
            }
            scales.force[i] += force;
            scales.force[j] += force;
        }
    return scales;
}

void pair_scales_clear(struct pair_scales *scales) {
    mf_memory_free(scales->force);
    *scales = (struct pair_scales){0};
}
