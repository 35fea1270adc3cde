// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "optimise/genetic.h"

#include <math.h>

int64_t mf_genetic_tournament(const double *errors, int64_t count, int64_t size, double probability,
                              struct rng_sequence *random) {
    int64_t ranked[GENETIC_LARGEST_TOURNAMENT] = {0};
    for (int64_t drawn = 0; drawn < size; drawn++) {
        const int64_t rival = mf_rng_sequence_below(random, (uint32_t)count);
        int64_t rank = drawn;
        for (; rank > 0 && errors[rival] < errors[ranked[rank - 1]]; rank--)
            ranked[rank] = ranked[rank - 1];
        ranked[rank] = rival;
    }
    int64_t winner = 0;
    while (winner + 1 < size && mf_rng_sequence_uniform(random) >= probability)
        winner++;
    return ranked[winner];
}

void mf_genetic_fill_wheel(double *wheel, const double *errors, int64_t count) {
    double sum = 0;
    bool any_exact = false, any = false;
    for (int64_t k = 0; k < count; k++) {
        any_exact = any_exact || errors[k] <= 0;
        any = any || errors[k] < GENETIC_FAILED;
    }
    for (int64_t k = 0; k < count; k++) {
        const bool failed = any && !(errors[k] < GENETIC_FAILED);
        const double fitness = any_exact ? errors[k] <= 0 : any ? 1 / errors[k] : 1;
        sum += failed ? 0 : fitness;
        wheel[k] = sum;
    }
}

int64_t mf_genetic_roulette(const double *wheel, int64_t count, struct rng_sequence *random) {
    const double ball = wheel[count - 1] * mf_rng_sequence_uniform(random);
    int64_t low = 0, high = count - 1; // the first whose sum is beyond the ball
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (wheel[middle] > ball)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static void exchange(double *a, double *b) {
    const double gene = *a;
    *a = *b;
    *b = gene;
}

void mf_genetic_crossover(double *a, double *b, int64_t genes, struct rng_sequence *random) {
    if (genes < 2)
        return;
    const int64_t point = 1 + mf_rng_sequence_below(random, (uint32_t)(genes - 1));
    for (int64_t k = point; k < genes; k++)
        exchange(&a[k], &b[k]);
}

void mf_genetic_crossover_two_points(double *a, double *b, int64_t genes,
                                     struct rng_sequence *random) {
    if (genes < 2)
        return;
    // Two different places before genes. So the last gene stays: to exchange a stretch that ends
    // with it gives the same two children as to exchange all the rest.
    const int64_t first = mf_rng_sequence_below(random, (uint32_t)genes);
    const int64_t other = mf_rng_sequence_below(random, (uint32_t)(genes - 1));
    const int64_t second = other < first ? other : other + 1;
    const int64_t begin = first < second ? first : second, end = first + second - begin;
    for (int64_t k = begin; k < end; k++)
        exchange(&a[k], &b[k]);
}

void mf_genetic_blend(double *a, double *b, int64_t genes, struct rng_sequence *random) {
    const double centre = (double)genes * mf_rng_sequence_uniform(random) - 0.5;
    const double width = (double)genes / 8 * mf_rng_sequence_uniform(random);
    for (int64_t k = 0; k < genes; k++) {
        const double weight = 1 / (1 + exp(((double)k - centre) / width));
        const double first = a[k], second = b[k];
        a[k] = weight * first + (1 - weight) * second;
        b[k] = weight * second + (1 - weight) * first;
    }
}

void mf_genetic_recombine(double *a, double *b, const struct genetic_parameters *parameters,
                          struct rng_sequence *random) {
    switch ((enum genetic_crossover_kind)parameters->crossover_kind) {
    case GENETIC_ONE_POINT:
        mf_genetic_crossover(a, b, parameters->genes, random);
        break;
    case GENETIC_TWO_POINT:
        mf_genetic_crossover_two_points(a, b, parameters->genes, random);
        break;
    case GENETIC_BLEND:
        mf_genetic_blend(a, b, parameters->genes, random);
        break;
    }
}

/// A normal number from two uniform ones.
static double normal(double u, double v) {
    double pair[2];
    rng_box_muller(u, v, pair);
    return pair[0];
}

/// Of a child that is mutated by scaling: probability of each gene, and share of those to which is
/// added instead, and how much usually at most, as a share of the range.
static const double mutated_genes = 0.1, additive_share = 0.1, added = 0.1;

/// Least spread that steps are taken from, as a share of the range.
static const double min_spread = 1e-4;

void mf_genetic_mutate_scale(double *genes, const struct genetic_parameters *parameters,
                             double probability, double additive, struct rng_sequence *random) {
    const double range = parameters->gene_maximum - parameters->gene_minimum;
    for (int64_t k = 0; k < parameters->genes; k++) {
        if (mf_rng_sequence_uniform(random) >= probability)
            continue;
        const double u = mf_rng_sequence_uniform(random), v = mf_rng_sequence_uniform(random);
        if (mf_rng_sequence_uniform(random) < additive)
            genes[k] += added * range * normal(u, v);
        else
            genes[k] *= exp2(2 * u - 1);
    }
}

void mf_genetic_walk(double *genes, int64_t count, double height, struct rng_sequence *random) {
    const double longest = pow((double)count, mf_rng_sequence_uniform(random));
    double squares = 0;
    for (int pass = 0; pass < 2; pass++) {
        // The same numbers twice: once for the scale, once to be added.
        struct rng_sequence modes = *random;
        const double scale = pass == 0 ? 0 : height / sqrt(squares / (double)count);
        for (int64_t k = 0; k < count; k++) {
            struct rng_sequence numbers = modes;
            const double t = (double)(count - k) / (double)count;
            double sum = 0;
            for (int64_t m = 1; (double)m <= longest; m++) {
                const double wave = ((double)m - 0.5) * M_PI;
                const double u = mf_rng_sequence_uniform(&numbers);
                sum += normal(u, mf_rng_sequence_uniform(&numbers)) * sin(wave * t) / wave;
            }
            squares += pass == 0 ? sum * sum : 0;
            genes[k] += scale * sum;
        }
    }
    for (int64_t m = 1; (double)m <= longest; m++) {
        mf_rng_sequence_uniform(random);
        mf_rng_sequence_uniform(random);
    }
}

/// In each block a walk is added, of |z| 2^(1 − 5u) times the survivors' spread there, at least
/// 1e-4 of the range: steps are as long as those that led to the survivors, and shrink with them.
static void mutate_walk(double *genes, const struct genetic *genetic, struct rng_sequence *random) {
    const double range = genetic->parameters.gene_maximum - genetic->parameters.gene_minimum;
    for (size_t b = 0; b < genetic->blocks; b++) {
        const double u = mf_rng_sequence_uniform(random), v = mf_rng_sequence_uniform(random);
        const double octaves = 1 - 5 * mf_rng_sequence_uniform(random);
        const double spread = fmax(genetic->spread[b], min_spread);
        mf_genetic_walk(genes, (int64_t)genetic->block[b],
                        range * spread * fabs(normal(u, v)) * exp2(octaves), random);
        genes += genetic->block[b];
    }
}

void mf_genetic_mutate(double *genes, const struct genetic *genetic, struct rng_sequence *random) {
    const struct genetic_parameters *parameters = &genetic->parameters;
    if (mf_rng_sequence_uniform(random) >= parameters->mutation)
        return;
    switch ((enum genetic_mutation_kind)parameters->mutation_kind) {
    case GENETIC_SCALE:
        mf_genetic_mutate_scale(genes, parameters, mutated_genes, additive_share, random);
        break;
    case GENETIC_WALK:
        mutate_walk(genes, genetic, random);
        break;
    }
}
