// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The normal distribution that CMA-ES samples and adapts.
///
/// N. Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772 (2016); numbers of equations
/// are those of its version 2. `mf_cmaes_optimiser` (cmaes.c) drives it.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Numbers that follow from variables and population (tutorial, table 1).
struct cmaes_strategy {
    size_t population;  ///< λ, at least 4
    size_t parents;     ///< µ = λ/2
    double effective;   ///< µ_eff
    double *weights;    ///< w by rank, shape [population]; those of the worse half are negative
    double path_sigma;  ///< c_σ
    double damping;     ///< d_σ
    double path;        ///< c_c
    double rank_one;    ///< c_1
    double rank_mu;     ///< c_µ
    double weights_sum; ///< Σ w
    double length;      ///< mean length of a standard normal vector
};

/// Fill all but `population`; `weights` has room for it.
void mf_cmaes_strategy_set(struct cmaes_strategy *strategy, size_t variables);

/// N(mean, sigma² covariance).
struct cmaes_distribution {
    size_t variables;
    struct cmaes_moments {
        double sigma;
        uint64_t updates;    ///< since the beginning
        uint64_t decomposed; ///< of them when axes and lengths were made
    } moments;
    double *mean;                    ///< shape [variables]
    double *path_sigma;              ///< p_σ, shape [variables]
    double *path;                    ///< p_c, shape [variables]
    double *covariance;              ///< shape [variables, variables]
    double *axes;                    ///< eigenvectors as columns, shape [variables, variables]
    double *lengths;                 ///< roots of the eigenvalues, shape [variables]
    struct cmaes_workspace *scratch; ///< of the decomposition
};

/// Memory of a distribution. Fails: NO_MEMORY; mf_cmaes_clear is then still to be called.
enum status mf_cmaes_init(struct cmaes_distribution *distribution, size_t variables) MUST_USE;
void mf_cmaes_clear(struct cmaes_distribution *distribution);

/// Begin: covariance 1, paths 0. The mean is the caller's to set.
void mf_cmaes_begin(struct cmaes_distribution *distribution, double sigma);

/// A step y = B D z of individual (round, row), so that its candidate is mean + σ y.
/// @param[in]  seed, round, row  of its random numbers
/// @param[out] step              shape [variables]
void mf_cmaes_sample(const struct cmaes_distribution *distribution, uint64_t seed, uint32_t round,
                     uint32_t row, double *step);

/// Move and reshape the distribution by the steps of a round (eq. 38–47): both evolution paths,
/// rank-one and rank-µ update with negative weights ("active"), cumulative step-size control.
/// Equal errors share the weights of their ranks, so that a plateau pulls nowhere.
/// @param[in] steps   shape [population, variables]
/// @param[in] errors  shape [population]
/// Fails: NO_MEMORY.
enum status mf_cmaes_update(struct cmaes_distribution *distribution,
                            const struct cmaes_strategy *strategy, const double *steps,
                            const double *errors) MUST_USE;

/// Standard deviation of a variable.
double mf_cmaes_deviation(const struct cmaes_distribution *distribution, size_t variable);

/// Ratio of the longest to the shortest axis.
double mf_cmaes_axis_ratio(const struct cmaes_distribution *distribution);
