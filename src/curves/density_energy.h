// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Laws f(ρ) of the energy that a bead has in its local density.
///
/// A law is a curve of ρ. Polynomials are as they are for every ρ; of formulas and tables there is
/// a cubic spline between their ends, beyond which f goes on as a straight line with the slope
/// there: forces stay continuous, and nothing is thrown out of a region that the table did not
/// expect. Who wants to know whether that happened asks for the densities that occurred
/// (forces/many_body.h). Tested: test_weight.
#pragma once

#include "curves/table.h"

/// f = c_1 x + c_2 x² + c_3 x³ + c_4 x⁴, x = ρ − ρ_o, less its value at ρ = 0: a bead alone has no
/// energy. About the mean density of a liquid the coefficients do not share what they do to it:
/// there c_1 is the mean force of all neighbours, and c_2 how it follows the density.
extern const struct curve_family mf_density_energy_polynomial;

/// f = π B r_c⁴ ρ²/30, in two dimensions π B r_c³ ρ²/24: with the weight "many-body-dpd" the force
/// on i is B (ρ_i + ρ_j)(1 − r/r_c) r̂. P. B. Warren, Phys. Rev. E 68, 066702 (2003), eq. 4.
extern const struct curve_family mf_density_energy_many_body_dpd;

/// A formula of ρ from one density to another, and a spline through the points of a file.
extern const struct curve_family mf_density_energy_expression, mf_density_energy_table;

/// All that a scene can name, NULL-terminated.
extern const struct curve_family *const mf_density_energy_laws[];

enum { DENSITY_ENERGY_TERMS = 4 };

/// What simulations evaluate.
struct density_energy {
    double term[DENSITY_ENERGY_TERMS]; ///< coefficients of ρ, ρ², …, of a polynomial
    bool tabulated;
    struct table table; ///< of f(low + x) − f(high)
    double low, high;   ///< ends of the table
    double shift;       ///< f(high)
    double slope_at_low, slope_at_high;
};

/// Tell the law "many-body-dpd" how many dimensions a scene has; others have no use for it.
void mf_density_energy_set_dimensions(const struct curve *curve, int dimensions);

/// Forces of the law "many-body-dpd" are what it promises with the weight of that name and the same
/// cutoff alone. Fails: BAD_INPUT with another one. Tested: cli/test_many_body.
enum status mf_density_energy_check_weight(const struct curve *curve,
                                           const struct curve *weight) MUST_USE;

/// Fails: NO_MEMORY; BAD_INPUT where the parameters do not go together.
enum status mf_density_energy_init(struct density_energy *energy,
                                   const struct curve *curve) MUST_USE;
void mf_density_energy_clear(struct density_energy *energy);

/// f(ρ) [k_B T_0], and its slope. Threads: any number at once.
double mf_density_energy_value(const struct density_energy *energy, double density, double *slope);

/// Whether it is a polynomial without any coefficient, which a fit may begin with.
bool mf_density_energy_is_zero(const struct density_energy *energy);

/// Points of a curve of the law "table", in reduced units. Fails: as mf_sampled_set_points.
enum status mf_density_energy_set_points(struct curve *curve, const double *density,
                                         const double *energy, size_t count) MUST_USE;

/// The name of the file that such a curve is to be read from.
const char *mf_density_energy_file(const struct curve *curve);
