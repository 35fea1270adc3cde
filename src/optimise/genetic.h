// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Genetic algorithm over real genes; knows nothing of what they mean.
///
/// Read `population`, measure each individual, hand the errors to mf_genetic_next_generation;
/// `mf_genetic_optimiser` (genetic_optimiser.c) does it by ask and tell. The elite is kept apart
/// from the population with the mean of all its measurements, and a challenger replaces it only by
/// fresh measurements (mf_genetic_offer), so that no individual survives by one lucky draw of a
/// noisy error.
///
/// Operators: A. G. Baydin (thesis, 2008), as its text describes them; D. E. Goldberg, Genetic
/// Algorithms in Search, Optimization and Machine Learning (1989).
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "optimise/optimiser.h"

#include <stdint.h>

#define GENETIC_FAILED OPTIMISER_FAILED

enum genetic_selection { GENETIC_TOURNAMENT, GENETIC_ROULETTE };
enum genetic_crossover_kind { GENETIC_ONE_POINT, GENETIC_TWO_POINT, GENETIC_BLEND };
enum genetic_mutation_kind { GENETIC_SCALE, GENETIC_WALK };
enum genetic_initial_kind { GENETIC_WALKS, GENETIC_UNIFORM };

/// Fresh measurements of a challenger before it replaces the elite.
enum { GENETIC_REMEASUREMENTS = 2 };

struct genetic_parameters {
    int64_t population;                ///< individuals
    int64_t genes;                     ///< genes of each
    double gene_minimum, gene_maximum; ///< range that no gene leaves [gene]
    double crossover;                  ///< probability of crossover of two parents
    int crossover_kind;
    double mutation; ///< probability that a child is mutated
    int mutation_kind;
    int selection;                 ///< enum genetic_selection: how parents are found
    int64_t tournament_size;       ///< individuals drawn for a tournament
    double tournament_probability; ///< with which the best of those left wins
    int64_t generations;
    int initial;      ///< enum genetic_initial_kind: the first generation
    double step;      ///< rms of a walk of the first generation, as a fraction of the range
    int64_t patience; ///< generations without a better elite after which it has settled; 0: never
};

struct genetic {
    struct genetic_parameters parameters;
    uint64_t seed;
    uint32_t generation; ///< of `population`, from 0
    int64_t rows; ///< individuals of `population`: more than its number when a challenger follows
    /// shape [rows, genes], room for a challenger's after the population; individual 0 is the
    /// elite once there is one
    double *population;
    /// shape [room, 2]: whose child each is, as numbers of individuals in the order in which they
    /// were measured, from 1; 0: nobody's. The elite, and copies of a challenger, have the one that
    /// they are
    uint64_t *parent;
    uint64_t measured;     ///< individuals before this generation
    double *offspring;     ///< shape [population, genes]: scratch
    double *ranked;        ///< shape [room]: scratch
    double *elite;         ///< shape [genes]
    double elite_error;    ///< mean of its measurements; GENETIC_FAILED if there is no elite yet
    double elite_measured; ///< how many they were; 0: they are forgotten
    size_t blocks;         ///< of genes that walk together
    size_t *block;         ///< shape [blocks]: genes of each
    double *spread; ///< shape [blocks]: of the better half's genes about their means, rms, as
                    ///< a fraction of the range
    double median;  ///< error of the last generation; HUGE_VAL before. Of the winners of the usual
                    ///< tournaments (eight, 0.75) one in 43 is beyond it
    uint32_t elite_since; ///< generation of the elite
    uint32_t resumed;     ///< generation from which patience counts, if the elite is older
};

static inline bool genetic_has_elite(const struct genetic *genetic) {
    return genetic->elite_error < GENETIC_FAILED;
}

/// First generation: genes uniform in their range, or the start and random walks from it; blocks of
/// one gene, which are no curve, are uniform in any case. Of `space` it takes variables, range,
/// seed, blocks and the start, which becomes individual 0; without one walks are about the middle.
/// Fails: NO_MEMORY.
enum status mf_genetic_init(struct genetic *genetic, const struct genetic_parameters *parameters,
                            const struct optimiser_space *space) MUST_USE;
void mf_genetic_clear(struct genetic *genetic);

/// Genes of one individual, shape [genes].
const double *mf_genetic_individual(const struct genetic *genetic, int64_t index);

/// Add a fresh measurement of the elite to its mean.
void mf_genetic_remeasure_elite(struct genetic *genetic, double error);

/// Measurements have less noise from now on: the next one of the elite is its mean, and patience
/// begins again.
void mf_genetic_forget(struct genetic *genetic);

/// Make `genes` the elite if `error`, the mean of `measured` fresh measurements, is below the
/// elite's. Returns whether it did.
bool mf_genetic_offer(struct genetic *genetic, const double *genes, double error, double measured);

/// Replace the population by the offspring of all rows; individual 0 becomes the elite. Genes that
/// left their range are reflected into it. Tested: test_genetic.
/// @param[in] errors  shape [rows]
void mf_genetic_next_generation(struct genetic *genetic, const double *errors);

/// Mean over genes of the standard deviation over individuals, as a fraction of the first
/// generation's range.
double mf_genetic_diversity(const struct genetic *genetic);

/// @name Operators (genetic_operators.c)
struct rng_sequence;

enum { GENETIC_LARGEST_TOURNAMENT = 64 };

/// Index of the winner of `size` individuals drawn of `count`: the best with probability p, else
/// the second with p, and so on; the worst if nobody else has won.
///
/// Tried instead: each drawn one in turn meets the winner so far, and the better wins with p. Even
/// the worst then wins in one tournament of four if it is drawn last, and with the thesis's
/// parameters the error of a generation's best stood still at 0.14.
int64_t mf_genetic_tournament(const double *errors, int64_t count, int64_t size, double probability,
                              struct rng_sequence *random);

/// Fill the wheel of a roulette: wheel[k] is the sum of the fitness of individuals 0 to k, fitness
/// being 1/error and that of a failed one 0. If any error is 0 these alone have a fitness, 1; if
/// all have failed, each has 1.
void mf_genetic_fill_wheel(double *wheel, const double *errors, int64_t count);

/// Index of an individual, each with a probability that is proportional to its fitness: the
/// selection of J. H. Holland, Adaptation in Natural and Artificial Systems (1975).
int64_t mf_genetic_roulette(const double *wheel, int64_t count, struct rng_sequence *random);

/// Cross two individuals in place, in the way that `crossover_kind` names.
void mf_genetic_recombine(double *a, double *b, const struct genetic_parameters *parameters,
                          struct rng_sequence *random);

/// Exchange the genes beyond one random point of two individuals, in place.
void mf_genetic_crossover(double *a, double *b, int64_t genes, struct rng_sequence *random);

/// Exchange the genes between two random points, in place.
void mf_genetic_crossover_two_points(double *a, double *b, int64_t genes,
                                     struct rng_sequence *random);

/// Blend two curves along their genes without a step:
///   a_k ← w_k a_k + (1 − w_k) b_k,  b_k the other way round,  w_k = 1/(1 + exp((k − c)/s)),
/// c uniform along the genes and s uniform up to an eighth of their number. One-point crossover is
/// the limit of s → 0; its step between neighbouring genes is a kink that curves pay for, or that
/// a Bezier curve smooths away. a_k + b_k stays.
void mf_genetic_blend(double *a, double *b, int64_t genes, struct rng_sequence *random);

/// A random walk along the genes is added, smooth down to a wavelength of its own: Brownian motion
/// from 0 beyond the last gene, where curves end,
///   W_k = Σ_{m ≤ M} z_m √2 sin((m − ½)π t)/((m − ½)π),   t = (genes − k)/genes,
/// its Karhunen–Loève series (K. Karhunen, Ann. Acad. Sci. Fenn. A1 37 (1947)), z normal, broken
/// off at M = genes^u, u uniform in (0, 1), and scaled to the rms `height` over the genes.
void mf_genetic_walk(double *genes, int64_t count, double height, struct rng_sequence *random);

/// A child mutates with probability `mutation`, in the way that `mutation_kind` names.
void mf_genetic_mutate(double *genes, const struct genetic *genetic, struct rng_sequence *random);

/// Each gene, with some probability, is scaled by 2^u, u uniform in (−1, 1), which has no drift;
/// or, in a share `additive` of cases, a normal number of a tenth of the range is added, since a
/// scale alone never crosses zero.
///
/// The thesis's rate of 0.1 for a gene, taken for every gene of every child, moves 10 of 100 genes
/// each time: the individuals then never come closer to each other (measured: diversity grows over
/// 15 generations).
void mf_genetic_mutate_scale(double *genes, const struct genetic_parameters *parameters,
                             double probability, double additive, struct rng_sequence *random);
