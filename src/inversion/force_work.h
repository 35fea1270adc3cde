// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The work space of mf_force_solve: its noise and its prior.
#pragma once

#include "observe/force_equations.h"

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

/// All is over the known unknowns, each in units of 1/sqrt(G_kk).
struct force_work {
    const struct force_equations *equations;
    double temperature;
    size_t count;
    size_t *place;                ///< shape [count]: in the equations
    size_t *begin;                ///< shape [curves + 1]: first known unknown of each curve
    double *scale;                ///< sqrt(G_kk)
    double *x;                    ///< what was found
    double *noise;                ///< variance of b along each eigenvector, over its eigenvalue
    gsl_matrix *gram, *vectors;   ///< G, later Gᵀ V⁻¹ G; eigenvectors of G
    gsl_vector *product, *values; ///< b, and eigenvalues
    gsl_matrix *prior;            ///< K of the prior with its strengths
    gsl_matrix *matrix;           ///< of the posterior: Gᵀ V⁻¹ G + K, or its Cholesky factor
    gsl_vector *weighed, *found;  ///< Gᵀ V⁻¹ b; found: of a solution
    double strength[FORCES_MAX_CURVES];
};

/// G, b or w of all blocks.
static inline double force_work_total(const struct force_equations *equations, const double *blocks,
                                      size_t row, size_t numbers) {
    double sum = 0;
    for (size_t b = 0; b < force_equations_blocks(equations); b++)
        sum += blocks[b * numbers + row];
    return sum;
}

static inline double force_work_gram(const struct force_equations *equations, size_t k, size_t l) {
    const size_t row = k >= l ? k * (k + 1) / 2 + l : l * (l + 1) / 2 + k;
    return force_work_total(equations, equations->gram, row, force_equations_entries(equations));
}

/// Eigenvalues of G that are smaller, of the largest, are rounding.
static inline bool force_work_is_determined(const struct force_work *w, size_t k) {
    return gsl_vector_get(w->values, k) > 1e-11 * gsl_vector_get(w->values, 0);
}

/// Variances of b of the whole along eigenvectors, by those of the whole blocks, with the forces
/// that are in x. Fails: NO_MEMORY.
enum status mf_force_noise_find(struct force_work *w) MUST_USE;

/// K of the prior with the present strengths, of forces as steep as those in x; and of how many
/// differences of a curve it is.
void mf_force_prior_fill(struct force_work *w);
double mf_force_prior_rank(const struct force_work *w, size_t curve);
