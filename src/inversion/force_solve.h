// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The forces that the normal equations of force matching say, with their errors.
///
/// The noise of b − G c is that of blocks of frames, since forces of neighbouring frames are
/// correlated and what is left of them is the motion of atoms, which is no noise of the mean. It is
/// found along each eigenvector of G, and smoothed over neighbouring ones. The prior is a smooth
/// force, which bends by itself within ℓ (mf_imc_smooth_length; of bonded terms so many nodes);
/// its strength, one for all pairs and one for each group, is the most probable one (D. J. C.
/// MacKay, Neural Comput. 4, 415 (1992)).
#pragma once

#include "observe/force_equations.h"

struct force_solution {
    size_t size;        ///< unknowns of the equations
    bool *known;        ///< shape [size]: a node between the first and the last that have been seen
    double *value;      ///< c, shape [size]; 0 where not known
    double *covariance; ///< of c, shape [size, size]
    double *coarse;     ///< c with every other node, shape [size]: it differs by three times the
                        ///< error of straight lines between nodes
    double explained;   ///< share of Σ F² that these forces are
    double directions;  ///< of c that the data determine
};

/// Fewest whole blocks whose scatter is noise.
enum { FORCE_SOLVE_BLOCKS = 4 };

/// @param[in] temperature  [k_B T_0], as the equations' unit of energy
/// Fails: BAD_INPUT for equations of too few blocks, or that are singular in all; NO_MEMORY.
/// Tested: test_force_solve.
enum status mf_force_solve(const struct force_equations *equations, double temperature,
                           struct force_solution *solution) MUST_USE;
void mf_force_solution_clear(struct force_solution *solution);

/// One more equation, that of the pressure: ⟨w⟩·c is `virial`, that is P* − ρ k_B T. c of pairs
/// and densities moves along what its covariance knows least, until it is met: what is left of the
/// forces being the motion of atoms, a liquid of others than pairs has another pressure by far more
/// than its noise. The noise of ⟨w⟩ and the error go into the covariance. Fails: NO_MEMORY. Tested:
/// test_force_solve, cli/test_force_matching.
enum status mf_force_solution_meet(struct force_solution *solution,
                                   const struct force_equations *equations, double virial,
                                   double error) MUST_USE;

/// Share of Σ F² that forces c are: (2 b·c − c·G c)/Σ F².
double mf_force_equations_share(const struct force_equations *equations, const double *c);

/// ∫ of the force of a curve from `from` to `to`, as weights of c: shape [size], uncleared.
/// Beyond the first and last known node the force goes on as there, of terms and densities beyond
/// all nodes along the line of the last two.
void mf_force_solution_integral(const struct force_solution *solution,
                                const struct force_curve *curve, double from, double to,
                                double *weight);
