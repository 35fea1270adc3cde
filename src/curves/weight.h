// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Weights w(r) of local densities, ρ_i = Σ_{j≠i} w(r_ij), and the table that kernels read.
///
/// Sanyal and Shell's weight counts neighbours, so that ρ is a pure number; those of Lucy and of
/// many-body dissipative particle dynamics have the integral 1 over space, so that ρ is a density
/// [1/λ^d]. Tested: test_weight.
#pragma once

#include "curves/table.h"

#include <math.h>

/// Sanyal and Shell's weight of a squared distance, with the squares of r_0 and r_c.
static inline double weight_sanyal_shell(double squared, double inner, double outer) {
    const double x = fmin(1, fmax(0, (squared - inner) / (outer - inner)));
    return 1 - x * x * (3 - 2 * x);
}

/// r w'(r) of it.
static inline double weight_sanyal_shell_stress(double squared, double inner, double outer) {
    const double x = fmin(1, fmax(0, (squared - inner) / (outer - inner)));
    return -12 * x * (1 - x) * squared / (outer - inner);
}

/// w = 1 for r < r_0, 1 − 3x² + 2x³ with x = (r² − r_0²)/(r_c² − r_0²) from there to r_c: the
/// polynomial c_0 + c_2 r² + c_4 r⁴ + c_6 r⁶ whose value and slope go on smoothly at both ends.
/// T. Sanyal and M. S. Shell, J. Chem. Phys. 145, 034109 (2016), eq. 6.
extern const struct curve_family mf_weight_sanyal_shell;

/// w = n (1 + 3r/r_c)(1 − r/r_c)³, n = 105/(16 π r_c³), or 5/(π r_c²) in two dimensions.
/// L. B. Lucy, Astron. J. 82, 1013 (1977).
extern const struct curve_family mf_weight_lucy;

/// w = n (1 − r/r_c)², n = 15/(2 π r_c³), or 6/(π r_c²) in two dimensions.
/// P. B. Warren, Phys. Rev. E 68, 066702 (2003), eq. 5.
extern const struct curve_family mf_weight_many_body_dpd;

/// All that a scene can name, NULL-terminated: with formulas and tables, which are shifted to 0 at
/// their cutoff.
extern const struct curve_family *const mf_weight_laws[];

/// Parameters of the three.
struct weight_parameters {
    double inner_cutoff; ///< r_0; 0 but for Sanyal and Shell's [λ]
    double cutoff;       ///< r_c [λ]
    int dimensions;      ///< of the scene; 0: three
};

/// Tell the three how many dimensions a scene has; others have no use for it.
void mf_weight_set_dimensions(const struct curve *curve, int dimensions);

/// Whether ρ is a density, and no pure number.
bool mf_weight_is_normalised(const struct curve *curve);

/// Table of w, of the distance beyond which w is no longer constant: no interval is astride the end
/// of what is flat.
struct weight_table {
    struct table table; ///< of w(inner + x)
    double inner;       ///< w is flat below [λ]; 0 of most
};

/// Fails: NO_MEMORY; BAD_INPUT where the parameters do not go together, or w is 0 everywhere.
enum status mf_weight_tabulate(struct weight_table *weight, const struct curve *curve) MUST_USE;
void mf_weight_clear(struct weight_table *weight);

/// Where w ends [λ].
static inline double weight_cutoff(const struct weight_table *weight) {
    return weight->inner + weight->table.cutoff;
}

/// w and its slope at r, in double precision.
void mf_weight_evaluate(const struct weight_table *weight, double r, double *value, double *slope);
