// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One interface of all optimisers: ask for candidates, measure them, tell their errors.
///
/// An optimiser minimises an error over variables in a box and knows nothing of what they mean. Who
/// drives it owns the loop, so candidates of a round are measured in any order and by any number of
/// threads. Errors may be noisy: the same variables may stand in several rows of a round, and each
/// row wants a measurement of its own.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "base/status.h"

#include <math.h>

/// Error of a candidate that could not be measured (its simulation blew up): worse than any.
/// Infinities, NaN and whatever is above count as it.
#define OPTIMISER_FAILED 1e9

/// Where to look.
struct optimiser_space {
    size_t variables;        ///< at least 1
    double minimum, maximum; ///< of every variable: no candidate is ever beyond
    const double *start; ///< shape [variables]: where to begin, or NULL for the optimiser's choice
    uint64_t seed;
    size_t max; ///< candidates that a round may have; 0: any number
    /// Variables that belong together, as those of a curve, shape [blocks], adding up to all of
    /// them; 0: all are one.
    size_t blocks;
    const size_t *block;
};

/// Candidates to be measured.
struct optimiser_round {
    const double *variables; ///< shape [count, variables]; the optimiser's own, valid until tell
    size_t count;            ///< 0: finished
};

enum { OPTIMISER_MAX_SPANS = 32 };

struct optimiser {
    const char *name;                  ///< in run files, as OPTIMISERS has it
    const struct field *const *tables; ///< of the parameter struct, NULL-terminated
    size_t parameters_size;
    size_t state_size;
    const char *budget; ///< the parameter that ends it if nothing else does
    /// Upper bound of rounds.
    uint32_t (*max_rounds)(const void *parameters, size_t variables);
    /// Begin in zeroed memory of `state_size`; nothing of `space` or `parameters` is kept.
    /// Fails: BAD_INPUT for an empty box, or a population beyond space.most; NO_MEMORY; `destroy`
    /// must follow all the same.
    enum status (*create)(void *state, const struct optimiser_space *space, const void *parameters);
    void (*destroy)(void *state);
    /// Asking again before telling gives the same.
    enum status (*ask)(void *state, struct optimiser_round *round);
    /// @param[in] errors     shape [count]: measured error of each candidate
    /// @param[in] variances  shape [count]: of that error as a mean; 0 if it is exact
    enum status (*tell)(void *state, const double *errors, const double *variances);
    /// The variables that it believes best now, shape [variables]; false, and nothing written,
    /// before anything has been measured.
    bool (*best_candidate)(const void *state, double *variables);
    /// Diversity of the candidates: a standard deviation as a fraction of the range.
    double (*spread)(const void *state);
    /// Error beyond which a candidate hardly changes what happens next, by the round told last;
    /// HUGE_VAL if that is not known. The same before and after `ask`.
    double (*discard_above)(const void *state);
    /// Let variables that somebody else found join, shape [variables], or NULL: it does not listen.
    void (*suggest)(void *state, const double *variables);
    /// Whether it ended since it could do no better, before its budget was used up. NULL: it never
    /// does.
    bool (*settled)(const void *state);
    /// Go on after it has settled, with measurements that have less noise from now on: those before
    /// are forgotten. NULL: it cannot. Returns whether its budget allows it.
    bool (*go_on)(void *state);
    /// Whether it ended by itself without having settled, or NULL: it does not.
    bool (*gave_up)(const void *state);
    /// Whose child row `row` of the round asked for is, as numbers of candidates in the order in
    /// which they were told, from 1; 0: nobody's. NULL: there are no parents.
    void (*parents)(const void *state, size_t row, uint64_t parent[2]);
    /// The state of a checkpoint, between tell and tell: what is written there and read into a new
    /// state of the same space and parameters goes on with the same bits. Returns their number, at
    /// most OPTIMISER_MAX_SPANS.
    size_t (*spans)(void *state, struct memory_span *spans);
};

/// The optimisers, each driven by a method of that name: mf_genetic_optimiser has struct
/// genetic_parameters, read by mf_genetic_fields.
#define OPTIMISERS(EACH)                                                                           \
    EACH(genetic, "genetic", "genetic algorithm over smooth curves; A. G. Baydin (2008)")          \
    EACH(cmaes, "cma-es",                                                                          \
         "evolution strategy with covariance matrix adaptation; N. Hansen, arXiv:1604.00772")      \
    EACH(nlopt, "nlopt", "algorithms of NLopt by name; S. G. Johnson, github.com/stevengj/nlopt")

#define OPTIMISER_DECLARE(record, name, summary)                                                   \
    extern const struct optimiser mf_##record##_optimiser;                                         \
    extern const struct field mf_##record##_fields[];
OPTIMISERS(OPTIMISER_DECLARE)
#undef OPTIMISER_DECLARE

/// All of them, NULL-terminated.
extern const struct optimiser *const mf_optimisers[];

/// The one of that name, or NULL.
const struct optimiser *mf_optimiser_find(const char *name);

/// @name For those who write one

/// What the record of every optimiser has: its functions of these names, and `struct state`.
#define OPTIMISER_RECORD                                                                           \
    .state_size = sizeof(struct state), .max_rounds = max_rounds, .create = create,                \
    .destroy = destroy, .ask = ask, .tell = tell, .best_candidate = best_candidate,                \
    .spread = spread, .discard_above = discard_above, .settled = settled, .spans = spans

/// Fails with BAD_INPUT unless there are variables and a box of finite, positive size, and the
/// start, if there is one, is finite.
enum status mf_optimiser_check_space(const struct optimiser_space *space) MUST_USE;

/// Fails with BAD_INPUT if a round of `count` candidates is more than there may be.
enum status mf_optimiser_check_round(const struct optimiser_space *space, size_t count) MUST_USE;

/// An error as given, or OPTIMISER_FAILED if it is not finite or beyond that.
static inline double optimiser_error(double told) {
    return told < OPTIMISER_FAILED && told > -HUGE_VAL ? told : OPTIMISER_FAILED;
}

/// `x` folded into [0, 1] by mirrors at both ends, so that what is beyond is as far inside.
/// Fails: never; what is not finite becomes 0.
double mf_optimiser_reflect(double x);

/// Variable at a fraction of the range, never beyond its ends by rounding.
static inline double optimiser_variable(const struct optimiser_space *space, double fraction) {
    const double variable = space->minimum + fraction * (space->maximum - space->minimum);
    return fmin(fmax(variable, space->minimum), space->maximum);
}

/// Where `space->start` is as a fraction of the range, the middle if there is none.
double mf_optimiser_start(const struct optimiser_space *space, size_t variable);

/// @name Parameters, for those who drive one by its name; those of the genetic one are in genetic.h
struct cmaes_parameters {
    int64_t population;
    double step;
    int64_t rounds;
    double tolerance;
};
struct nlopt_parameters {
    int algorithm;
    int64_t evaluations;
    double step, tolerance;
};
