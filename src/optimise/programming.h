// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Genetic programming: formulas that describe a curve, the best of each length.
///
/// J. R. Koza, Genetic Programming (1992). Islands of formulas are changed by crossover, mutation
/// of subtrees and of points, growing and hoisting; each child is simplified, and its constants are
/// fitted by least squares with its derivatives (M. Kommenda et al., Genet. Program. Evolvable
/// Mach. 21, 471 (2020)). An island keeps the best few of each length, of different structure, so
/// that what is short need not compete with what is long. A formula that is not finite everywhere
/// between the first point and the last is dropped.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "curves/expression.h"

#include <stdatomic.h>
#include <stdint.h>

/// What formulas are to describe. Borrowed.
struct programming_points {
    size_t count;
    const double *r, *y; ///< shape [count], r growing
    /// Shape [count]: the residuals are weight (f − y); NULL if there is a response.
    const double *weight;
    /// Shape [rows, count]: the residuals are the response times f − y, plus the offset.
    const double *response;
    size_t rows;
    const double *offset; ///< shape [rows], or NULL: 0
    /// A formula counts as shifted so that it is 0 here; NaN: as it is.
    double zero;
    /// Shape [count], or NULL. Differences d = f − y count as s log(1 + d/s) above 0 and as
    /// s (1 − exp(−d/s)) below, in a straight line from −3 s on: pairs at a distance that they
    /// hardly ever have do not see how high a barrier is, but a hole. 0: as they are.
    const double *softness;
    double noise; ///< of the residuals, rms; 0: not known
};

enum { PROGRAMMING_MAX_NODES = 30, PROGRAMMING_KEPT = 16, PROGRAMMING_MAX_ISLANDS = 64 };

struct programming_parameters {
    int64_t nodes, islands, rounds, children;
};

extern const struct field mf_programming_fields[]; ///< of struct programming_parameters

/// A formula and the rms of its residuals.
struct programming_member {
    struct expression expression;
    double error; ///< infinite: there is none
};

/// The best few of each length, best first.
struct programming_island {
    struct programming_member member[PROGRAMMING_MAX_NODES + 1][PROGRAMMING_KEPT];
};

struct programming {
    struct programming_parameters parameters;
    const struct programming_points *points;
    uint64_t seed;
    int threads;
    const atomic_bool *cancel;
    struct programming_island *island;                         ///< shape [islands]
    struct programming_member best[PROGRAMMING_MAX_NODES + 1]; ///< of each length
    uint64_t round;
};

/// Begin. `points` must outlive it, and may change between rounds (mf_programming_reconsider).
/// Fails: NO_MEMORY.
enum status mf_programming_init(struct programming *programming,
                                const struct programming_points *points,
                                const struct programming_parameters *parameters, uint64_t seed,
                                int threads, const atomic_bool *cancel) MUST_USE;
void mf_programming_clear(struct programming *programming);

/// One round: as many children as the parameters say on each island, in parallel; the same bits for
/// any number of threads. Fails: NO_MEMORY; INTERRUPTED, and then only the state from before the
/// round is fit to go on. Tested: test_programming.
enum status mf_programming_round(struct programming *programming) MUST_USE;

/// After the points have changed: refit and sort all formulas. Fails as mf_programming_round.
enum status mf_programming_reconsider(struct programming *programming) MUST_USE;

/// The front of error against length: each member is better than all shorter ones by more than
/// 2 %. Exponents that may as well be whole numbers within the noise are, and constants have no
/// more digits than make the error smaller by 1 %, or by half of the noise as squares add.
/// @param[out] front  shape [PROGRAMMING_MAX_NODES]
/// @return members, shortest first. Fails: NO_MEMORY. Tested: test_programming.
enum status mf_programming_front(const struct programming *programming,
                                 struct programming_member *front, size_t *members) MUST_USE;

/// Fit the constants of a formula to some points, and tidy them as those of a front.
/// Fails: NO_MEMORY.
enum status mf_programming_polish(const struct programming_points *points,
                                  struct programming_member *member) MUST_USE;

size_t mf_programming_spans(struct programming *programming, struct memory_span *spans);
