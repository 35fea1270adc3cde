// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the inversions of g(r) by sampling share: imc, ibi, hnc.
///
/// Each iteration samples the present potential and asks the method for a step towards the target
/// (inverse_method.update). The best potential so far is kept; a worse one than chance allows makes
/// the next step half as long, from the best. Samples double
/// until their noise is small against the error, or as small as was asked for: then the fit has
/// converged when the error is within the noise.
///
/// It starts from the hypernetted-chain inversion (hnc_closure): for water the error of g is then a
/// quarter of that of −k_B T ln g. Where the first step from there makes it worse, as with a target
/// that ends before its oscillations do, it starts again from −k_B T ln g.
#pragma once

#include "inverse/potential_grid.h"
#include "inverse/replicas.h"

struct inversion_parameters {
    int64_t particles, replicas;
    int64_t equilibration, samples, every;
    int64_t iterations;
    double precision, damping;
    int start;   ///< INVERSION_FROM_…
    int sampler; ///< enum sampler_kind
};

enum { INVERSION_FROM_HNC, INVERSION_FROM_MEAN_FORCE };

enum { INVERSION_OWN = 4 }; ///< room for a method's own parameters, in doubles

/// The parameters of a method: a struct whose first part is common, then its own.
struct inversion_settings {
    struct inversion_parameters common;
    double own[INVERSION_OWN];
};

extern const struct field inversion_fields[];

struct inversion {
    struct inversion_settings settings;
    const struct inverse_method *method;
    const struct inverse_problem *problem;
    struct potential_grid grid;
    struct box box; ///< of the sampled system
    size_t particles;
    struct table table;
    struct replicas replicas;
    double *ideal, *target_counts; ///< shape [bins]
    double *excess, *variance;     ///< of S, shape [bins]
    double *phi, *step, *error;    ///< present potential and the last step, shape [points]
    double *best, *best_step, *best_error;
    // What a checkpoint keeps besides phi, best, … and the samplers:
    struct inversion_progress {
        uint32_t iteration;
        uint64_t evaluations, sweeps;
        double damping, best_rmse, best_noise;
    } progress;
};

/// @name For the records of the methods: struct inverse_method has a word on each.

struct inverse_sampling inversion_sampling(const void *parameters);
uint32_t inversion_most_iterations(const struct inverse_method *method,
                                   const struct inverse_problem *problem, const void *parameters);
enum status inversion_create(void *inversion, const struct inverse_method *method,
                             const struct inverse_problem *problem,
                             const void *parameters) MUST_USE;
void inversion_destroy(void *inversion);
enum status inversion_iterate(void *inversion, struct inverse_step *step,
                              const struct inverse_listener *listener) MUST_USE;
size_t inversion_spans(void *inversion, struct memory_span *span);

/// The first two of a method's columns; two may be its own.
#define INVERSION_COLUMNS "damping[1]", "own_noise[1]"

/// g of the samples in a bin, and of the target in the same system.
double inversion_g(const struct inversion *inversion, size_t bin);
double inversion_target_g(const struct inversion *inversion, size_t bin);
