// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From a target back to the interaction: the problem, and the record of a method.
///
/// A method is a state that improves by iterations. It says what of its state a checkpoint must
/// keep (spans), so that a run stopped after any iteration goes on with the same bits.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "dynamics/simulation.h"
#include "observe/rdf.h"

/// What is to be fitted. Borrowed by the methods.
struct inverse_problem {
    struct rdf_bins bins;
    const double *target;          ///< g*, shape [bins.count]
    const double *target_error;    ///< standard errors, shape [bins.count]
    struct simulation_setup scene; ///< all but the potential
    const struct curve *start;     ///< potential to begin with, or NULL for −k_B T ln g*
    double core_threshold;         ///< bins below the first with g* above this are the hard core
    double core_stiffness;         ///< of the core (core_fill) [k_B T_0/λ²]
    uint64_t seed;
    int threads;
};

/// State of a fit after an iteration. Arrays belong to the method.
struct inverse_step {
    uint32_t iteration;    ///< from 0
    uint64_t evaluations;  ///< measurements of g so far
    uint64_t engine_steps; ///< time steps or Monte Carlo sweeps so far, over all replicas
    double error;      ///< rms of g − g* of the best potential so far, as the method measured it
    double noise;      ///< rms that the statistical errors alone would give
    double extra[4];   ///< columns of the method's own
    const double *phi; ///< on the potential grid; best so far [k_B T_0]
    const double *phi_error; ///< standard error, or NULL where the method has none
    bool finished;
    bool converged;
};

/// Told from time to time inside an iteration, from one thread at a time.
struct inverse_progress {
    uint32_t iteration;
    uint32_t iterations;  ///< at most
    uint64_t done, total; ///< parts of this iteration
    double best, mean;    ///< error; not finite if not known yet
    uint64_t failures;    ///< simulations that left their temperature or blew up
};

struct inverse_listener {
    void (*tell)(void *context, const struct inverse_progress *progress);
    void *context;
};

enum { INVERSE_MAX_SPANS = 512 };

/// What a method measures of an evaluation.
struct inverse_sampling {
    int64_t every;  ///< steps between samples; 0: no dynamics are simulated
    bool rdf_force; ///< g(r) from forces, where the potential allows
};

struct inverse_method {
    const char *name;
    const char *summary;               ///< with citation, one line
    const struct field *const *tables; ///< of the parameter struct, NULL-terminated
    size_t parameters_size;
    size_t state_size;
    uint32_t (*most_iterations)(const void *parameters);
    struct inverse_sampling (*sampling)(const void *parameters);
    bool keeps_parts;
    const char *const *columns; ///< names of `extra`, NULL-terminated
    enum status (*create)(void *state, const struct inverse_problem *problem,
                          const void *parameters);
    void (*destroy)(void *state);
    /// One iteration. After INTERRUPTED the state is fit for a checkpoint if `keeps_parts`, else
    /// only that from before the iteration is.
    enum status (*iterate)(void *state, struct inverse_step *step,
                           const struct inverse_listener *listener);
    /// List the state; returns the number of spans.
    size_t (*spans)(void *state, struct memory_span *spans);
};

/// All methods, NULL-terminated.
extern const struct inverse_method *const inverse_methods[];

extern const struct inverse_method imc;
extern const struct inverse_method matching;
