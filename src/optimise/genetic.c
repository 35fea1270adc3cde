// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/genetic.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    if (genetic->elite_measured > 0)
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
