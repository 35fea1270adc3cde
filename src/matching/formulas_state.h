// SPDX-License-Identifier: GPL-3.0-or-later
/// @file State of the method "formulas", and its tables.
#pragma once

#include "matching/population.h"
#include "optimise/programming.h"
#include "problem/unknowns.h"

struct formulas_parameters {
    struct population_parameters population;
    struct programming_parameters programming;
    int64_t curve_particles;
    double curve_precision;
    int64_t checks, cycles;
};

/// What an iteration does.
enum formulas_stage { FORMULAS_CURVE, FORMULAS_BREED, FORMULAS_MEASURE };

/// The best formula of a length, with what simulations say of it.
struct formulas_member {
    struct programming_member formula; ///< its error is the one that the response expects
    bool measured;
    double error, noise, variance; ///< of simulations; OPTIMISER_FAILED
};

/// The method that finds the curve of a potential: an inversion of g(r).
struct formulas_inner {
    const struct inverse_method *method;
    struct inverse_problem problem;
    void *parameters, *state;
    bool created;
};

struct formulas_state {
    struct formulas_parameters own;
    const struct inverse_problem *problem;
    enum unknown_kind kind; ///< what is looked for
    struct unknowns unknowns;
    struct formulas_inner inner;
    size_t count;                ///< points of the curve that a formula describes
    size_t first;                ///< of the unknown's points; they follow one another
    size_t features;             ///< of the targets
    double *y, *weight;          ///< shape [count]: what formulas are compared with
    double *softness;            ///< shape [count]
    double *start;               ///< shape [count]: the potential of the inversion
    double *response;            ///< shape [2 count, count]: of g(r), and of what reins formulas in
    double *offset;              ///< shape [2 count]: of both where f = y
    double *curve, *curve_error; ///< shape [points]: the best so far
    double *target;              ///< shape [features]
    double *found;               ///< shape [lengths, features]: as simulated
    struct programming_points points;
    struct programming programming;
    struct formulas_member front[PROGRAMMING_MAX_NODES + 1]; ///< by length; of length 0: none yet
    char formula[FIELD_TEXT_SIZE];                           ///< the chosen, as text
    struct formulas_progress {
        uint32_t iteration, stage, cycle;
        int chosen, nearest; ///< lengths in the front; 0: none. The shortest, and the best
        uint64_t evaluations, engine_steps;
        double error, noise, variance;
    } progress;
};

/// The chosen formula is the shortest within so many standard errors of the best.
enum { FORMULAS_CHANCE = 2 };

/// The unknown as a formula makes it, shape [points].
void mf_formulas_make_curve(const struct formulas_state *state, const struct expression *expression,
                            double *curve);

/// Simulate the front; then begin the next cycle, if one is needed.
/// Fails: INTERRUPTED, NO_MEMORY, BAD_INPUT as mf_evaluate.
enum status mf_formulas_simulate(struct formulas_state *state,
                                 const struct inverse_listener *listener, bool *finished) MUST_USE;

/// formulas.tsv, formulas.tex and formulas.h.
enum status mf_formulas_write(const void *state, const struct inverse_folder *folder);
