// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/maxwell.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"

#include <math.h>

/// Blocks of time.
enum { MAX_BLOCKS = 512 };

enum status mf_maxwell_init(struct maxwell *maxwell, size_t planned) {
    *maxwell = (struct maxwell){.each = planned / MAX_BLOCKS + 1};
    maxwell->blocks = planned / maxwell->each + 1;
    TRY_ARRAY(maxwell->counts, MAXWELL_BINS);
    TRY_ARRAY(maxwell->cells, maxwell->blocks * MAXWELL_CELLS);
    return STATUS_OK;
}

void mf_maxwell_clear(struct maxwell *maxwell) {
    mf_memory_free(maxwell->counts);
    mf_memory_free(maxwell->cells);
    *maxwell = (struct maxwell){0};
}

void mf_maxwell_begin(struct maxwell *maxwell) {
    maxwell->taken++;
}

void mf_maxwell_add(struct maxwell *maxwell, double share) {
    const size_t place = (size_t)(share * MAXWELL_BINS);
    const size_t bin = place < MAXWELL_BINS ? place : MAXWELL_BINS - 1;
    const size_t block = (maxwell->taken - 1) / maxwell->each;
    maxwell->counts[bin]++;
    maxwell->cells[block * MAXWELL_CELLS + bin / (MAXWELL_BINS / MAXWELL_CELLS)] += 1;
}

size_t mf_maxwell_spans(struct maxwell *maxwell, struct memory_span *spans) {
    const size_t cells = maxwell->blocks * MAXWELL_CELLS;
    spans[0] = (struct memory_span){&maxwell->taken, sizeof maxwell->taken};
    spans[1] = (struct memory_span){maxwell->counts, MAXWELL_BINS * sizeof *maxwell->counts};
    spans[2] = (struct memory_span){maxwell->cells, cells * sizeof *maxwell->cells};
    return MAXWELL_SPANS;
}

void mf_maxwell_sample(struct maxwell *maxwell, const struct particles *particles,
                       double temperature, uint64_t seed, uint64_t step) {
    const double *mass = particles_masses(particles);
    const double spread = sqrt(temperature / mf_particles_total_mass(particles));
    double normal[4];
    mf_maxwell_begin(maxwell);
    mf_rng_normal4(
        mf_rng_philox(seed, RNG_MEAN_VELOCITY, (uint32_t)step, (uint32_t)(step >> 32), 0), normal);
    for (int d = 0; d < particles->box.dimensions; d++) {
        // The order is that of the list, which is the same for any number of threads.
        const double *v = particles->velocity[d];
        const double shift = normal[d] * spread - mf_particles_mean_velocity(particles, d);
        const double scale = -1 / sqrt(2 * temperature);
        for (size_t k = 0; k < particles->count; k++) {
            const double own = mass ? scale * sqrt(mass[k]) : scale;
            mf_maxwell_add(maxwell, 0.5 * erfc(own * (v[k] + shift)));
        }
    }
}

enum { EDGES = MAXWELL_CELLS - 1 };

/// F_n at the edges between cells in each whole block of time, shape [EDGES, blocks].
static void find_series(const struct maxwell *maxwell, size_t blocks, double *series) {
    for (size_t b = 0; b < blocks; b++) {
        const double *cells = maxwell->cells + b * MAXWELL_CELLS;
        double all = 0, below = 0;
        for (size_t c = 0; c < MAXWELL_CELLS; c++)
            all += cells[c];
        for (size_t c = 0; c < EDGES; c++) {
            below += cells[c];
            series[c * blocks + b] = below / all;
        }
    }
}

/// How many numbers stand for one independent: variances of F_n over F (1 − F)/n, the mean over the
/// edges. What it is more than 1 is drawn towards 0 by the share that its error has in it: of the
/// edges together 3.4 are independent, (Σ λ)²/Σ λ² with Anderson and Darling's λ = 1/(j (j + 1)).
static double find_inefficiency(const struct maxwell *maxwell, double total) {
    static const double edges = 3.4;
    const size_t blocks = (size_t)maxwell->taken / maxwell->each;
    double series[EDGES * (MAX_BLOCKS + 1)], error[EDGES], found = 0;
    if (blocks < 2)
        return 1;
    find_series(maxwell, blocks, series);
    mf_statistics_correlated_errors(series, blocks, 1, EDGES, error);
    for (size_t c = 0; c < EDGES; c++) {
        const double below = (double)(c + 1) / MAXWELL_CELLS;
        found += error[c] * error[c] * total / (below * (1 - below)) / EDGES;
    }
    const double memory = 2 * mf_statistics_inefficiency(series, blocks, 1, EDGES) - 1;
    const double more = found - 1, variance = 2 * found * found * memory / ((double)blocks * edges);
    return more > 0 && more * more > variance ? 1 + more - variance / more : 1;
}

struct maxwell_summary mf_maxwell_result(const struct maxwell *maxwell) {
    uint64_t total = 0, below = 0;
    double largest = 0;
    for (size_t k = 0; k < MAXWELL_BINS; k++)
        total += maxwell->counts[k];
    if (total == 0)
        return (struct maxwell_summary){.statistic = NAN, .probability = NAN};
    for (size_t k = 0; k < MAXWELL_BINS; k++) {
        below += maxwell->counts[k];
        const double expected = (double)(k + 1) / MAXWELL_BINS;
        largest = fmax(largest, fabs((double)below / (double)total - expected));
    }
    const double independent = (double)total / find_inefficiency(maxwell, (double)total);
    return (struct maxwell_summary){(double)total, independent, largest,
                                    mf_maxwell_probability(largest, independent)};
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
