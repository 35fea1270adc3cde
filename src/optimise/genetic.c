// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/genetic.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Operators ---------------------------------------------------------------------------------------

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

// Generations -------------------------------------------------------------------------------------

static const char *const selections[] = {"tournament", "roulette", NULL};
static const char *const crossovers[] = {"one-point", "two-point", "blend", NULL};
static const char *const mutations[] = {"scale", "walk", NULL};
static const char *const initials[] = {"walks", "uniform", NULL};

#define MEMBER(name) .offset = offsetof(struct genetic_parameters, name)
#define PROBABILITY .minimum = 0, .maximum = 1, .unit = ""
const struct field mf_genetic_fields[] = {
    {"population", FIELD_INTEGER, MEMBER(population), .initial = 250, .minimum = 2, .maximum = 1e6,
     .unit = "", .help = "individuals of a generation"},
    {"crossover", FIELD_NUMBER, MEMBER(crossover), .initial = 0.91, PROBABILITY,
     .help = "probability of crossover of two parents"},
    {"crossover_kind", FIELD_CHOICE, MEMBER(crossover_kind), .choices = crossovers,
     .initial = GENETIC_BLEND, .unit = "", .help = "blend: smooth mixture of two curves"},
    {"mutation", FIELD_NUMBER, MEMBER(mutation), .initial = 1, PROBABILITY,
     .help = "probability that a child is mutated"},
    {"mutation_kind", FIELD_CHOICE, MEMBER(mutation_kind), .choices = mutations,
     .initial = GENETIC_WALK, .unit = "",
     .help = "scale: one gene in ten by 1/2 to 2; walk: smooth random walks"},
    {"selection", FIELD_CHOICE, MEMBER(selection), .choices = selections,
     .initial = GENETIC_TOURNAMENT, .unit = "",
     .help = "of parents; roulette: each with a probability like 1/error"},
    {"tournament_size", FIELD_INTEGER, MEMBER(tournament_size), .initial = 8, .minimum = 1,
     .maximum = GENETIC_LARGEST_TOURNAMENT, .unit = "",
     .help = "individuals drawn for a tournament"},
    {"tournament_probability", FIELD_NUMBER, MEMBER(tournament_probability), .initial = 0.75,
     PROBABILITY, .help = "probability that the best wins, then the next"},
    {"initial", FIELD_CHOICE, MEMBER(initial), .choices = initials, .initial = GENETIC_WALKS,
     .unit = "", .help = "first generation: random walks from the start, or uniform genes"},
    {"step", FIELD_NUMBER, MEMBER(step), .initial = 0.02, .minimum = FIELD_ABOVE_ZERO, .maximum = 1,
     .unit = "", .help = "rms of the first walks, as a fraction of the range"},
    {"patience", FIELD_INTEGER, MEMBER(patience), .initial = 10, .minimum = 0, .maximum = 1e6,
     .unit = "", .help = "generations without a better elite until converged; 0: never"},
    {"generations", FIELD_INTEGER, MEMBER(generations), .initial = 21, .minimum = 1, .maximum = 1e6,
     .unit = "", .help = "number of generations"},
    FIELD_END,
};

static size_t total_genes(const struct genetic *genetic) {
    return (size_t)(genetic->parameters.population * genetic->parameters.genes);
}

/// The gene itself, or its mirror image if it left its range.
static double within_range(double gene, const struct genetic_parameters *p) {
    if (gene >= p->gene_minimum && gene <= p->gene_maximum)
        return gene;
    const double range = p->gene_maximum - p->gene_minimum;
    const double mirrored = mf_optimiser_reflect((gene - p->gene_minimum) / range);
    return fmin(fmax(p->gene_minimum + range * mirrored, p->gene_minimum), p->gene_maximum);
}

/// Genes uniform in their range.
static void fill_uniform(const struct genetic_parameters *p, double *genes, size_t count,
                         struct rng_sequence *random) {
    for (size_t k = 0; k < count; k++)
        genes[k] =
            p->gene_minimum + (p->gene_maximum - p->gene_minimum) * mf_rng_sequence_uniform(random);
}

/// One block of an individual: a walk from the start, or from the middle of the range.
static void fill_walk(const struct genetic_parameters *p, double *genes, size_t count,
                      const double *start, struct rng_sequence *random) {
    const double range = p->gene_maximum - p->gene_minimum;
    for (size_t k = 0; k < count; k++)
        genes[k] = start ? start[k] : p->gene_minimum + 0.5 * range;
    mf_genetic_walk(genes, (int64_t)count, p->step * range, random);
    for (size_t k = 0; k < count; k++)
        genes[k] = within_range(genes[k], p);
}

static void fill_individual(struct genetic *genetic, double *genes, const double *start,
                            struct rng_sequence *random) {
    const struct genetic_parameters *p = &genetic->parameters;
    for (size_t b = 0, gene = 0; b < genetic->blocks; gene += genetic->block[b], b++)
        if (p->initial == GENETIC_UNIFORM || genetic->block[b] == 1)
            fill_uniform(p, genes + gene, genetic->block[b], random);
        else
            fill_walk(p, genes + gene, genetic->block[b], start ? start + gene : NULL, random);
}

/// The blocks of the space, or one of all genes.
static void take_blocks(struct genetic *genetic, const struct optimiser_space *space) {
    if (space->blocks == 0)
        genetic->block[0] = space->variables;
    for (size_t b = 0; b < space->blocks; b++)
        genetic->block[b] = space->block[b];
    for (size_t b = 0; b < genetic->blocks; b++)
        genetic->spread[b] = genetic->parameters.step;
}

enum status mf_genetic_init(struct genetic *genetic, const struct genetic_parameters *parameters,
                            const struct optimiser_space *space) {
    enum status status = STATUS_OK;
    struct genetic_parameters p = *parameters;
    p.genes = (int64_t)space->variables;
    p.gene_minimum = space->minimum;
    p.gene_maximum = space->maximum;
    *genetic = (struct genetic){.parameters = p,
                                .seed = space->seed,
                                .rows = p.population,
                                .blocks = space->blocks > 0 ? space->blocks : 1,
                                .median = HUGE_VAL,
                                .elite_error = GENETIC_FAILED};
    NEW_ARRAY(genetic->population, (size_t)((p.population + GENETIC_REMEASUREMENTS) * p.genes));
    NEW_ARRAY(genetic->parent, (size_t)(2 * (p.population + GENETIC_REMEASUREMENTS + 1)));
    // Children come in pairs: one place more for the last of an odd population.
    NEW_ARRAY(genetic->offspring, total_genes(genetic) + (size_t)p.genes);
    NEW_ARRAY(genetic->ranked, (size_t)(p.population + GENETIC_REMEASUREMENTS));
    NEW_ARRAY(genetic->elite, (size_t)p.genes);
    NEW_ARRAY(genetic->block, genetic->blocks);
    NEW_ARRAY(genetic->spread, genetic->blocks);
    take_blocks(genetic, space);
    struct rng_sequence random = mf_rng_sequence_begin(space->seed, RNG_INITIAL, 0, 0);
    for (int64_t k = 0; k < p.population; k++)
        fill_individual(genetic, genetic->population + k * p.genes, space->start, &random);
    if (space->start)
        memcpy(genetic->population, space->start, space->variables * sizeof(double));
done:
    if (status != STATUS_OK)
        mf_genetic_clear(genetic);
    return status;
}

void mf_genetic_clear(struct genetic *genetic) {
    mf_memory_free(genetic->population);
    mf_memory_free(genetic->parent);
    mf_memory_free(genetic->offspring);
    mf_memory_free(genetic->ranked);
    mf_memory_free(genetic->block);
    mf_memory_free(genetic->spread);
    mf_memory_free(genetic->elite);
    *genetic = (struct genetic){0};
}

const double *mf_genetic_individual(const struct genetic *genetic, int64_t index) {
    return genetic->population + index * genetic->parameters.genes;
}

void mf_genetic_remeasure_elite(struct genetic *genetic, double error) {
    genetic->elite_measured += 1;
    genetic->elite_error += (error - genetic->elite_error) / genetic->elite_measured;
}

void mf_genetic_forget(struct genetic *genetic) {
    genetic->elite_measured = 0;
    genetic->resumed = genetic->generation;
}

bool mf_genetic_offer(struct genetic *genetic, const double *genes, double error, double measured) {
    if (error >= genetic->elite_error)
        return false;
    memcpy(genetic->elite, genes, (size_t)genetic->parameters.genes * sizeof *genes);
    genetic->elite_error = error;
    genetic->elite_measured = measured;
    genetic->elite_since = genetic->generation;
    return true;
}

/// A copy of an individual that is selected. Returns its number.
/// @pre with roulette: `ranked` is its wheel
static uint64_t copy_winner(const struct genetic *genetic, const double *errors, double *child,
                            struct rng_sequence *random) {
    const struct genetic_parameters *p = &genetic->parameters;
    const int64_t winner = p->selection == GENETIC_ROULETTE
                               ? mf_genetic_roulette(genetic->ranked, genetic->rows, random)
                               : mf_genetic_tournament(errors, genetic->rows, p->tournament_size,
                                                       p->tournament_probability, random);
    memcpy(child, mf_genetic_individual(genetic, winner), (size_t)p->genes * sizeof *child);
    return genetic->measured + (uint64_t)winner + 1;
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Median error of the population.
static double find_median(struct genetic *genetic, const double *errors) {
    const size_t count = (size_t)genetic->parameters.population;
    memcpy(genetic->ranked, errors, count * sizeof *errors);
    qsort(genetic->ranked, count, sizeof *errors, compare_numbers);
    return genetic->ranked[count / 2];
}

/// rms over the genes of each block of the standard deviation over the better half.
static void find_spread(struct genetic *genetic, const double *errors) {
    const struct genetic_parameters *p = &genetic->parameters;
    for (size_t b = 0, gene = 0; b < genetic->blocks; b++) {
        double sum = 0;
        for (size_t end = gene + genetic->block[b]; gene < end; gene++) {
            struct running_mean over = {0};
            for (int64_t k = 0; k < p->population; k++)
                if (errors[k] <= genetic->median)
                    mf_statistics_add(&over, mf_genetic_individual(genetic, k)[gene]);
            sum += over.squares / over.count;
        }
        genetic->spread[b] =
            sqrt(sum / (double)genetic->block[b]) / (p->gene_maximum - p->gene_minimum);
    }
}

/// As individual 0, which it was already, or the challenger after the generation that was
/// measured.
static void place_elite(struct genetic *genetic) {
    const struct genetic_parameters *p = &genetic->parameters;
    const bool is_new = genetic->elite_since + 1 == genetic->generation;
    memcpy(genetic->population, genetic->elite, (size_t)p->genes * sizeof(double));
    genetic->parent[0] = genetic->measured + 1 + (is_new ? (uint64_t)p->population : 0);
    genetic->parent[1] = 0;
}

void mf_genetic_next_generation(struct genetic *genetic, const double *errors) {
    const struct genetic_parameters *p = &genetic->parameters;
    genetic->generation++;
    genetic->median = find_median(genetic, errors);
    find_spread(genetic, errors);
    mf_genetic_fill_wheel(genetic->ranked, errors, genetic->rows);
    for (int64_t pair = 0; pair < p->population; pair += 2) {
        struct rng_sequence random = mf_rng_sequence_begin(genetic->seed, RNG_SELECTION,
                                                           genetic->generation, (uint32_t)pair);
        double *first = genetic->offspring + pair * p->genes, *second = first + p->genes;
        uint64_t *parent = genetic->parent + 2 * pair; // of both children
        parent[0] = copy_winner(genetic, errors, first, &random);
        parent[2] = copy_winner(genetic, errors, second, &random);
        parent[1] = parent[3] = 0;
        if (mf_rng_sequence_uniform(&random) < p->crossover) {
            mf_genetic_recombine(first, second, p, &random);
            parent[1] = parent[2];
            parent[3] = parent[0];
        }
        mf_genetic_mutate(first, genetic, &random);
        mf_genetic_mutate(second, genetic, &random);
    }
    for (size_t k = 0; k < total_genes(genetic); k++)
        genetic->population[k] = within_range(genetic->offspring[k], p);
    if (genetic_has_elite(genetic))
        place_elite(genetic);
    genetic->measured += (uint64_t)genetic->rows;
    genetic->rows = p->population;
}

double mf_genetic_diversity(const struct genetic *genetic) {
    const struct genetic_parameters *p = &genetic->parameters;
    double sum = 0;
    for (int64_t gene = 0; gene < p->genes; gene++) {
        struct running_mean over = {0};
        for (int64_t k = 0; k < p->population; k++)
            mf_statistics_add(&over, mf_genetic_individual(genetic, k)[gene]);
        sum += sqrt(over.squares / over.count);
    }
    return sum / (double)p->genes / (p->gene_maximum - p->gene_minimum);
}
