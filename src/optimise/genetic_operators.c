// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "optimise/genetic.h"

#include <math.h>

int64_t genetic_tournament(const double *errors, int64_t population, int64_t size,
                           double probability, struct rng_sequence *random) {
    int64_t ranked[GENETIC_LARGEST_TOURNAMENT] = {0};
    for (int64_t drawn = 0; drawn < size; drawn++) {
        const int64_t rival = rng_sequence_below(random, (uint32_t)population);
        int64_t rank = drawn;
        for (; rank > 0 && errors[rival] < errors[ranked[rank - 1]]; rank--)
            ranked[rank] = ranked[rank - 1];
        ranked[rank] = rival;
    }
    int64_t winner = 0;
    while (winner + 1 < size && rng_sequence_uniform(random) >= probability)
        winner++;
    return ranked[winner];
}

void genetic_crossover(double *a, double *b, int64_t genes, struct rng_sequence *random) {
    if (genes < 2)
        return;
    const int64_t point = 1 + rng_sequence_below(random, (uint32_t)(genes - 1));
    for (int64_t k = point; k < genes; k++) {
        const double gene = a[k];
        a[k] = b[k];
        b[k] = gene;
    }
}

void genetic_mutate(double *genes, const struct genetic_parameters *parameters,
                    struct rng_sequence *random) {
    const double range = parameters->gene_maximum - parameters->gene_minimum;
    if (rng_sequence_uniform(random) >= parameters->mutation)
        return;
    for (int64_t k = 0; k < parameters->genes; k++) {
        if (rng_sequence_uniform(random) >= parameters->mutated_genes)
            continue;
        const double u = rng_sequence_uniform(random), v = rng_sequence_uniform(random);
        if (rng_sequence_uniform(random) < parameters->additive)
            genes[k] += 0.1 * range * sqrt(-2 * log(u)) * cos(2 * M_PI * v);
        else
            genes[k] *= exp2(2 * u - 1);
    }
}
