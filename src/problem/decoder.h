// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Variables → curves: the unknowns of a problem, side by side in one vector of variables.
///
/// Variables are fractions of the range that the run file gives to an unknown, so that one
/// optimiser can move a potential and a friction weight together.
#pragma once

#include "problem/inverse.h"
#include "problem/potential_grid.h"
#include "problem/omega_grid.h"

struct decoder {
    const struct inverse_problem *problem;
    struct potential_grid potential; ///< if it is unknown
    struct omega_grid omega;         ///< if it is unknown
    size_t variables;                ///< of all unknowns
    size_t first[UNKNOWNS];          ///< variable of each
    double
        *basis[UNKNOWNS]; ///< shape [points, variables of it]: curve = basis · x; NULL: a formula
};

/// Fails: NO_MEMORY; BAD_INPUT as mf_potential_grid_init.
enum status mf_decoder_init(struct decoder *decoder,
                            const struct inverse_problem *problem) MUST_USE;
void mf_decoder_clear(struct decoder *decoder);

/// Variables of an unknown; 0 if it is known.
size_t mf_decoder_variables(const struct decoder *decoder, enum unknown_kind kind);

/// Points of an unknown's curve; 0 if it is known. And where they are [λ].
size_t mf_decoder_points(const struct decoder *decoder, enum unknown_kind kind);
const double *mf_decoder_r(const struct decoder *decoder, enum unknown_kind kind);

/// The curves that an unknown is made of, one behind the other with as many points each: potentials
/// are one for each pair type. And whether a point of them is fitted: not in a core, and not at
/// the cutoff.
size_t mf_decoder_curve_count(const struct decoder *decoder, enum unknown_kind kind);
bool mf_decoder_fits(const struct decoder *decoder, enum unknown_kind kind, size_t point);

/// What files call one of them: "potential", or "potential_A-B" in a mixture.
enum { DECODER_NAME_SIZE = COMPOSITION_PAIR_NAME_SIZE + 16 };
void mf_decoder_curve_name(const struct decoder *decoder, enum unknown_kind kind, size_t curve,
                           char name[DECODER_NAME_SIZE]);

/// Curve of some variables, shape [points]. A friction weight that would be negative is 0.
void mf_decoder_curve(const struct decoder *decoder, enum unknown_kind kind,
                      const double *variables, double *curve);

/// Parameters of a friction weight that is a formula, and their standard errors from the covariance
/// of the variables as in mf_decoder_band; that may be NULL. Tested: test_decoder.
void mf_decoder_parameters(const struct decoder *decoder, const double *variables,
                           const double *covariance,
                           struct inverse_parameter parameter[INVERSE_PARAMETERS]);

/// The end of its range, "minimum" or "maximum", that a parameter of the formula has come to within
/// a thousandth of the range; NULL if none, or if it is held fixed. Tested: test_decoder.
const char *mf_decoder_parameter_bound(const struct unknown_parameters *p, int parameter,
                                       double value);

/// Standard errors of the curve of some variables, shape [points], from the covariance of the
/// variables, shape [variables, variables] of all unknowns; NaN if that is NULL, and in the core,
/// which is set.
/// @param[out] flat  as curve_flat of an inverse_step: principal components of the curve's errors,
///                   each upwards where it is largest; NaN as the errors
/// Fails: NO_MEMORY.
enum status mf_decoder_band(const struct decoder *decoder, enum unknown_kind kind,
                            const double *variables, const double *covariance, double *error,
                            double *flat) MUST_USE;

/// Table for the kernels from a curve. Fails: NO_MEMORY.
enum status mf_decoder_table(const struct decoder *decoder, enum unknown_kind kind,
                             const double *curve, struct table *table) MUST_USE;

/// Tables of all unknowns from variables, and those of the scene for what is known. What was made
/// must be cleared with laws_clear, even after a failure.
struct decoder_laws {
    struct table own[UNKNOWNS]; ///< zero for what is known
    const struct table *table[UNKNOWNS];
};
enum status mf_decoder_laws(const struct decoder *decoder, const double *variables,
                            struct decoder_laws *laws) MUST_USE;
void mf_decoder_laws_clear(struct decoder_laws *laws);

/// Variables nearest to the curves that the fit begins with: those of the run file, or the
/// potential of mean force and a friction weight that falls linearly from the middle of its range.
/// Fails: NO_MEMORY.
enum status mf_decoder_start(const struct decoder *decoder, double *variables) MUST_USE;

/// The unknowns' curves with their standard errors, for a method to show.
struct decoder_curves {
    double *value[UNKNOWNS], *error[UNKNOWNS]; ///< shape [points]; NULL for what is known
    double *flat[UNKNOWNS];                    ///< as curve_flat of an inverse_step
    struct inverse_parameter parameter[INVERSE_PARAMETERS];
};
enum status mf_decoder_curves_init(const struct decoder *decoder,
                                   struct decoder_curves *curves) MUST_USE;
void mf_decoder_curves_clear(struct decoder_curves *curves);

/// Put the curves of some variables into a step.
void mf_decoder_curves_show(const struct decoder *decoder, const double *variables,
                            struct decoder_curves *curves, struct inverse_step *step);

/// Standard errors of all curves and parameters, as mf_decoder_band. Fails: NO_MEMORY.
enum status mf_decoder_curves_bands(const struct decoder *decoder, const double *variables,
                                    const double *covariance,
                                    struct decoder_curves *curves) MUST_USE;

/// The errors, for a checkpoint.
size_t mf_decoder_curves_spans(const struct decoder *decoder, struct decoder_curves *curves,
                               struct memory_span *spans);
