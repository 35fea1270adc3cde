// SPDX-License-Identifier: GPL-3.0-or-later
/// @file State of the method "pareto", and its tables.
#pragma once

#include "matching/population.h"
#include "problem/inverse.h"
#include "optimise/nsga2.h"

struct pareto_parameters {
    struct population_parameters population;
    struct nsga2_parameters nsga2;
    int64_t checks, surrogate;
};

/// What a row of the log is of.
enum pareto_log_kind { LOG_MEASURED, LOG_FRONT, LOG_CHOSEN };

/// Columns of a row before the objectives.
enum { LOG_ITERATION, LOG_KIND, LOG_ERROR, LOG_OBJECTIVES };

struct pareto_state {
    struct pareto_parameters own;
    const struct inverse_problem *problem;
    struct parametrisation parametrisation;
    struct population population;
    struct nsga2 nsga2;
    size_t objectives;
    enum target_kind target[TARGETS];     ///< of each objective
    double *value;                        ///< shape [candidates, objectives]: scratch
    double *log;                          ///< shape [rows, LOG_OBJECTIVES + objectives]
    struct parametrisation_curves curves; ///< of the chosen
    struct progress {
        uint32_t iteration, stage;
        uint64_t rows;         ///< of the log
        uint64_t chosen;       ///< parent
        bool known;            ///< whether there is a chosen one
        double noise[TARGETS]; ///< of one simulation's distances, by objective
        double variance;       ///< of the error of what was checked last
        uint32_t last_better;  ///< iteration in which the least error fell last
        double min;            ///< chosen so far
    } progress;
};

/// Numbers in a row of the log.
size_t mf_pareto_log_width(const struct pareto_state *state);

/// Weighted error of a row of objectives, or of their noise.
double mf_pareto_error(const struct pareto_state *state, const double *value);

/// Objectives of a parent.
const double *mf_pareto_value(const struct pareto_state *state, size_t parent);

/// Whether a parent is a member of the front. Those that failed are a front when all have.
bool mf_pareto_is_member(const struct pareto_state *state, size_t parent);

/// Write pareto.tsv, pareto_history.tsv, and the curves of the front. Fails: IO, NO_MEMORY.
enum status mf_pareto_write_tables(const void *state, const struct inverse_folder *folder) MUST_USE;
