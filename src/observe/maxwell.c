// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/maxwell.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>

enum status mf_maxwell_init(struct maxwell *maxwell) {
    maxwell->counts = mf_memory_zeroed(MAXWELL_BINS, sizeof *maxwell->counts);
    return maxwell->counts ? STATUS_OK : STATUS_NO_MEMORY;
}

void mf_maxwell_clear(struct maxwell *maxwell) {
    mf_memory_free(maxwell->counts);
    *maxwell = (struct maxwell){0};
}

void mf_maxwell_sample(struct maxwell *maxwell, const struct particles *particles,
                       double temperature, uint64_t seed, uint64_t step) {
    const double *mass = particles_masses(particles);
    const double spread = sqrt(temperature / mf_particles_total_mass(particles));
    double normal[4];
    mf_rng_normal4(
        mf_rng_philox(seed, RNG_MEAN_VELOCITY, (uint32_t)step, (uint32_t)(step >> 32), 0), normal);
    for (int d = 0; d < particles->box.dimensions; d++) {
        // The order is that of the list, which is the same for any number of threads.
        const double *v = particles->velocity[d];
        const double shift = normal[d] * spread - mf_particles_mean_velocity(particles, d);
        const double scale = -1 / sqrt(2 * temperature);
        for (size_t k = 0; k < particles->count; k++) {
            const double own = mass ? scale * sqrt(mass[k]) : scale;
            const double share = 0.5 * erfc(own * (v[k] + shift));
            const size_t bin = (size_t)(share * MAXWELL_BINS);
            maxwell->counts[bin < MAXWELL_BINS ? bin : MAXWELL_BINS - 1]++;
        }
    }
}

struct maxwell_summary mf_maxwell_result(const struct maxwell *maxwell) {
    uint64_t total = 0, below = 0;
    double largest = 0;
    for (size_t k = 0; k < MAXWELL_BINS; k++)
        total += maxwell->counts[k];
    if (total == 0)
        return (struct maxwell_summary){0, NAN, NAN};
    for (size_t k = 0; k < MAXWELL_BINS; k++) {
        below += maxwell->counts[k];
        const double expected = (double)(k + 1) / MAXWELL_BINS;
        largest = fmax(largest, fabs((double)below / (double)total - expected));
    }
    return (struct maxwell_summary){(double)total, largest,
                                    mf_maxwell_probability(largest, (double)total)};
}

double mf_maxwell_probability(double statistic, double n) {
    const double lambda = (sqrt(n) + 0.12 + 0.11 / sqrt(n)) * statistic;
    double sum = 0;
    if (lambda < 1) { // the same function by its theta transform, which converges at small λ
        for (int k = 1; k <= 9; k += 2)
            sum += exp(-(double)(k * k) * M_PI * M_PI / (8 * lambda * lambda));
        return 1 - (lambda > 0 ? sqrt(2 * M_PI) / lambda * sum : 0);
    }
    for (int k = 1; k <= 5; k++)
        sum += (k % 2 ? 2 : -2) * exp(-2 * k * k * lambda * lambda);
    return sum;
}
