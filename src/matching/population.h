// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The candidates of an optimiser's round, measured by simulations in parallel.
#pragma once

#include "base/statistics.h"
#include "problem/parametrisation.h"
#include "problem/evaluate.h"
#include "matching/surrogate.h"
#include "optimise/optimiser.h"

enum { POPULATION_MAX = 1024 }; ///< in a round

/// What the run file says of how candidates are measured: the first member of the parameters of
/// every method of the kind INVERSE_MATCHING.
struct population_parameters {
    struct evaluate_parameters evaluate;
    int warm_start; ///< 0: no
};

/// Of struct population_parameters: of every simulation, and of rounds of them. "racing" stands
/// with the methods whose optimiser says what cannot win.
extern const struct field mf_population_fields[], mf_population_round_fields[];

/// For `struct inverse_method`.
struct inverse_sampling mf_population_sampling(const void *parameters);

/// What was measured since mf_population_reset_survey.
struct population_survey {
    size_t evaluations;
    double min; ///< error; infinite if there is none
    struct running_mean alive;
    uint64_t failures;
};

/// What failed, and of which causes, since the fit began. What is added in another order is the
/// same.
struct population_failures {
    uint64_t count[EVALUATE_FAILURES];
    double coldest, hottest; ///< of those whose temperature was off, over what it should be
};

struct population {
    const struct parametrisation *parametrisation;
    struct population_parameters parameters;
    double *errors, *variances; ///< shape [POPULATION_MAX]; an error is negative if not measured
    struct target_distance *distances; ///< shape [POPULATION_MAX, TARGETS]; not set of what failed
    double *features;                  ///< shape [POPULATION_MAX, features] of the targets
    struct surrogate surrogate;        ///< that remembers them
    double *target, *target_error;     ///< shape [features]
    double *excess;                    ///< shape [features]: see mf_population_expect
    double *first;                     ///< shape [variables]: the first candidate of the last round
    double *shown, *shown_error;       ///< the last large round, to be written
    size_t shown_count;
    double *position;               ///< shape [dimensions, particles]: where simulations begin
    double *best_position;          ///< where the best of this round ended
    uint32_t iteration, iterations; ///< for progress: of the method, at most
    double best;                    ///< for progress: the method's error so far, or NaN
    size_t singles; ///< for progress: rounds of one candidate in an iteration; 0: that is one
    struct population_survey survey;
    struct population_totals {
        uint64_t rounds, evaluations, steps;
        uint64_t remeasured; ///< candidates
        int64_t length;      ///< of simulations, in units of what the run file says
        bool warm;           ///< whether there is a position to begin with
        double best_error;   ///< of this round
        uint64_t best_index;
        struct population_failures failures;
    } totals;
};

/// Fails: NO_MEMORY.
enum status mf_population_init(struct population *population,
                               const struct parametrisation *parametrisation,
                               const struct population_parameters *parameters) MUST_USE;
void mf_population_clear(struct population *population);

/// Measure all candidates that have no error yet. A failed simulation is the worst error.
/// Seeds depend on the round and the candidate's number alone: the same bits for any threads.
/// Fails: INTERRUPTED, NO_MEMORY, BAD_INPUT.
enum status mf_population_measure(struct population *population,
                                  const struct optimiser_round *round, double discard_above,
                                  const struct inverse_listener *listener) MUST_USE;

/// Forget the errors, and begin the next round's simulations where the best of this one ended.
void mf_population_next_round(struct population *population);

/// With a warm start, and before the first round of candidates that have one potential: let the
/// first of them that can settle where all simulations are to begin. Where none can, and otherwise,
/// they begin as the scene says. Fails: INTERRUPTED, NO_MEMORY, BAD_INPUT.
/// (population_check.c)
enum status mf_population_settle(struct population *population,
                                 const struct optimiser_round *round) MUST_USE;

/// How candidates are measured now: for `length` times as long as the run file says, but for their
/// equilibration, and as much more precisely.
struct evaluate_parameters mf_population_evaluate(const struct population *population);

/// Columns of positions, one a dimension.
void mf_population_split(const struct population *population, double *position, double *column[3]);

/// Threads for the simulation of a candidate alone. Particles too few to share are done before the
/// threads have met.
int mf_population_threads_inside(const struct inverse_problem *problem);

/// Numbers of a configuration: dimensions times particles.
size_t mf_population_coordinates(const struct population *population);

/// One simulation of a candidate.
struct population_task {
    const struct evaluate_parameters *parameters;
    uint64_t seed;
    double discard_above;      ///< error with which it cannot win; HUGE_VAL: none
    int threads;               ///< of the simulation
    double *features;          ///< shape [features], to be filled
    struct observed *observed; ///< to be filled, or NULL
    double *end;               ///< as population.position, to be filled
};

/// What blew up, left its temperature or collapsed has the error OPTIMISER_FAILED.
/// Fails: as mf_evaluate but for UNSTABLE.
enum status mf_population_simulate(const struct population *population, const double *variables,
                                   const struct population_task *task,
                                   struct evaluate_result *result) MUST_USE;

/// Add a measurement to the linear model's; what failed has no features.
void mf_population_remember(struct population *population, const double *variables, double error,
                            const double *features);

/// What fresh measurements of a candidate say together.
struct population_check {
    double error;                         ///< of their mean; OPTIMISER_FAILED if one of them failed
    double noise;                         ///< in that
    double variance;                      ///< of that
    struct target_distance each[TARGETS]; ///< means of those of single measurements
};

/// Measure one candidate `count` times afresh, for as long as is set: none stops early. The mean of
/// what was measured is compared with the targets: its noise is less than that of each, of which a
/// mean of errors would keep all. (population_check.c)
/// @param[in] length  of their simulations, in those of a round
/// Fails: INTERRUPTED, NO_MEMORY, BAD_INPUT.
enum status mf_population_check(struct population *population, const double *variables,
                                size_t count, int64_t length,
                                struct population_check *check) MUST_USE;

/// Tell the linear model what the best so far misses the targets by, and how much of that is noise;
/// NaN: not known yet. (population_check.c)
void mf_population_expect(struct population *population, double error, double noise);

/// Write the curves of the last round of at least eight candidates: population_potential.tsv and so
/// on, r and a column for each that did not fail, from the least error on, as their names say.
/// Nothing before there is one. Fails: IO, NO_MEMORY. (population_tables.c)
enum status mf_population_write(const struct population *population,
                                const struct inverse_folder *folder) MUST_USE;

enum { POPULATION_NAME_SIZE = 24 };

/// One of several candidates whose curves stand side by side in tables.
struct population_member {
    const double *variables;
    char name[POPULATION_NAME_SIZE]; ///< of its column
};

/// Write a table for each curve of each unknown, `prefix`_potential.tsv and so on: r and a column
/// for each member.
/// @param[in] comment  first line, or NULL
/// Fails: IO, NO_MEMORY. Tested: cli/test_fit, cli/test_fit_pareto.
enum status mf_population_write_curves(const struct parametrisation *parametrisation,
                                       const struct inverse_folder *folder, const char *prefix,
                                       const char *comment, const struct population_member *member,
                                       size_t members) MUST_USE;

void mf_population_reset_survey(struct population *population);

/// @name What failed, and why (matching/population_tables.c)

/// Add a simulation, if it failed.
void mf_population_add_failure(struct population_failures *failures,
                               const struct evaluate_result *result);

/// Say into `reason` how many simulations succeeded, but `why` there is no result, and what most of
/// those that failed have failed of. Tested: test_population_failures.
void mf_population_report_failure(const struct population *population, const char *why,
                                  char reason[INVERSE_REASON_SIZE]);

/// What the record of every method of the kind INVERSE_MATCHING has: its functions of these names.
#define POPULATION_RECORD                                                                          \
    .kind = INVERSE_MATCHING, .finds_potential = true, .finds_omega = true,                        \
    .sampling = mf_population_sampling, .columns = columns, .create = create, .destroy = destroy,  \
    .iterate = iterate, .spans = spans

enum { CANDIDATES_SPANS = 12 + SURROGATE_SPANS };
size_t mf_population_spans(struct population *population, struct memory_span *spans);
