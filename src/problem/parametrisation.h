// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Variables → curves: the unknowns of a problem, side by side in one vector of variables.
///
/// Variables are fractions of the range that the run file gives to an unknown, so that one
/// optimiser can move a potential and a friction weight together.
#pragma once

#include "problem/bonded_grid.h"
#include "problem/unknowns.h"

struct parametrisation {
    struct unknowns unknowns;
    size_t variables;        ///< of all unknowns
    size_t first_number;     ///< variable of the first number, after those of the curves
    size_t first[UNKNOWNS];  ///< variable of each
    double *basis[UNKNOWNS]; ///< shape [points, variables of it]: curve = base + basis · c, with
                             ///< the base of the problem; NULL: a formula
    double *min, *range;     ///< shape [variables]: c = least + range · x, and of numbers; of a
                             ///< formula 0 and 1
    double *bonded;          ///< base of the groups, as below
};

/// Variables of a problem, as mf_parametrisation_init counts them.
size_t mf_parametrisation_count(const struct inverse_problem *problem);

/// Fails: NO_MEMORY; BAD_INPUT as mf_potential_grid_init.
enum status mf_parametrisation_init(struct parametrisation *parametrisation,
                                    const struct inverse_problem *problem) MUST_USE;
void mf_parametrisation_clear(struct parametrisation *parametrisation);

/// Variables of an unknown, 0 if it is known; and of one of its curves.
size_t mf_parametrisation_variables(const struct parametrisation *parametrisation,
                                    enum unknown_kind kind);
size_t mf_parametrisation_variables_of(const struct parametrisation *parametrisation,
                                       enum unknown_kind kind, size_t curve);

/// Points of a curve below this one do not follow its variables: the core of a potential, and what
/// a group's target does not know.
size_t mf_parametrisation_first_point(const struct parametrisation *parametrisation,
                                      enum unknown_kind kind, size_t curve);

/// Where the points of a curve lie between the first that follows its variables (0) and the cutoff
/// (1), shape [points of it] of which the last are not set: its core has no place.
void mf_parametrisation_places(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, size_t curve, double *place);

/// Curve of some variables, shape [points]. A friction weight that would be negative is 0.
void mf_parametrisation_curve(const struct parametrisation *parametrisation, enum unknown_kind kind,
                              const double *variables, double *curve);

/// Parameters of a friction weight that is a formula, and their standard errors from the covariance
/// of the variables as in mf_parametrisation_band; that may be NULL. Tested: test_parametrisation.
void mf_parametrisation_parameters(const struct parametrisation *parametrisation,
                                   const double *variables, const double *covariance,
                                   struct inverse_parameter parameter[INVERSE_PARAMETERS]);

/// The end of its range, "minimum" or "maximum", that a parameter of the formula has come to within
/// a thousandth of the range; NULL if none, or if it is held fixed. Tested: test_parametrisation.
const char *mf_parametrisation_parameter_bound(const struct unknown_parameters *p, int parameter,
                                               double value);

/// The numbers of the scene that are to be found, shape [problem->numbers]: each variable goes
/// through its range. Errors as of the parameters. Tested: test_numbers.
void mf_parametrisation_numbers(const struct parametrisation *parametrisation,
                                const double *variables, const double *covariance,
                                struct inverse_parameter *number);

/// Standard errors of the curve of some variables, shape [points], from the covariance of the
/// variables, shape [variables, variables] of all unknowns; NaN if that is NULL, and in the core,
/// which is set.
/// @param[out] flat  as curve_flat of an inverse_step: principal components of the curve's errors,
///                   each upwards where it is largest; NaN as the errors
/// Fails: NO_MEMORY.
enum status mf_parametrisation_band(const struct parametrisation *parametrisation,
                                    enum unknown_kind kind, const double *variables,
                                    const double *covariance, double *error, double *flat) MUST_USE;

/// Tables of all unknowns from variables, as mf_unknowns_laws_make. Fails: NO_MEMORY.
enum status mf_parametrisation_laws(const struct parametrisation *parametrisation,
                                    const double *variables, struct unknowns_laws *laws) MUST_USE;

/// Variables that belong together: of each curve, and each number alone; returns how many blocks.
/// @param[out] block  variables of each, shape [variables], of which the first ones are set
size_t mf_parametrisation_blocks(const struct parametrisation *parametrisation, size_t *block);

/// Variables nearest to the curves that the fit begins with: those of the file, or the base, or
/// mf_unknowns_start. Fails: NO_MEMORY.
enum status mf_parametrisation_start(const struct parametrisation *parametrisation,
                                     double *variables) MUST_USE;

/// The unknowns' curves with their standard errors, for a method to show.
struct parametrisation_curves {
    double *value[UNKNOWNS], *error[UNKNOWNS]; ///< shape [points]; NULL for what is known
    double *flat[UNKNOWNS];                    ///< as curve_flat of an inverse_step
    struct inverse_parameter parameter[INVERSE_PARAMETERS];
    struct inverse_parameter number[INVERSE_MAX_NUMBERS];
};
enum status mf_parametrisation_curves_init(const struct parametrisation *parametrisation,
                                           struct parametrisation_curves *curves) MUST_USE;
void mf_parametrisation_curves_clear(struct parametrisation_curves *curves);

/// Put the curves of some variables into a step.
void mf_parametrisation_curves_show(const struct parametrisation *parametrisation,
                                    const double *variables, struct parametrisation_curves *curves,
                                    struct inverse_step *step);

/// Standard errors of all curves, parameters and numbers, as mf_parametrisation_band. Fails:
/// NO_MEMORY.
enum status mf_parametrisation_curves_bands(const struct parametrisation *parametrisation,
                                            const double *variables, const double *covariance,
                                            struct parametrisation_curves *curves) MUST_USE;

/// The errors, for a checkpoint.
size_t mf_parametrisation_curves_spans(const struct parametrisation *parametrisation,
                                       struct parametrisation_curves *curves,
                                       struct memory_span *spans);

/// @name U(q) of a group of bonds, angles or dihedrals, made of coefficients:
///
///   U(q) = U_0(q) + Σ_k c_k (B_k(q) − ⟨B_k⟩),
///
/// with U_0 the Boltzmann inversion of the target (mf_bonded_grid_start), which has its detail, and
/// B_k few functions: cubic B-splines over the bins that are known, of a dihedral cos φ, sin φ,
/// cos 2φ and so on. A constant of U changes nothing: means ⟨B_k⟩ over the target hold it.

/// B_k − ⟨B_k⟩ at the known bins. Fails: NO_MEMORY. Tested: test_parametrisation_bonded.
/// @param[out] basis  shape [grid->known, count]
enum status mf_parametrisation_bonded_basis(const struct bonded_grid *grid, size_t count,
                                            double *basis) MUST_USE;

/// Standard errors of U_0 by those of the target, as far as no coefficients and no constant can
/// make up for them, at the known bins: with Σ = diag((k_B T σ/p)²) of U_0 and the basis B, a
/// constant in it, the diagonal of Σ − B (Bᵀ Σ⁻¹ B)⁻¹ Bᵀ. Fails: NO_MEMORY. Tested:
/// test_parametrisation_bonded.
/// @param[in]  target_error  σ of the target's bins
/// @param[in]  basis         of the coefficients of the group
/// @param[out] error         shape [grid->known] [k_B T_0]
enum status mf_parametrisation_bonded_rough(const struct bonded_grid *grid,
                                            const double *target_error, const double *basis,
                                            double *error) MUST_USE;
