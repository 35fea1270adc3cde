// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The units that another engine has, as multiples of the reduced ones.
#pragma once

#include "io/units.h"

/// Systems of units: λ, k_B T_0, μ as they are; Å, fs, kcal/mol, g/mol, K, atm ("real" of LAMMPS);
/// nm, ps, kJ/mol, u, K, bar; Å, ps, kJ/mol, u, K, katm (DL_POLY).
enum export_system { EXPORT_REDUCED, EXPORT_REAL, EXPORT_NANOMETRES, EXPORT_DL_POLY };

/// What a reduced number is to be multiplied with, and what the unit is then called.
struct export_units {
    enum export_system system;
    double length, time, energy, mass, temperature, pressure;
    const char *length_name, *time_name, *energy_name, *temperature_name, *pressure_name;
};

/// The units of a system. Where the result has no physical units, reduced ones, or, for an engine
/// that knows none, those of λ = 1 nm, μ = 1 u and k_B T_0 = 1 kJ/mol, so that τ = 1 ps.
/// Tested: test_export_model.
struct export_units mf_export_units(enum export_system system, const struct units *units,
                                    bool physical);

static inline double export_units_force(const struct export_units *units) {
    return units->energy / units->length;
}

static inline double export_units_velocity(const struct export_units *units) {
    return units->length / units->time;
}

/// Of a friction ω², force over velocity: μ/τ = k_B T_0 τ/λ².
static inline double export_units_friction(const struct export_units *units) {
    return units->energy * units->time / (units->length * units->length);
}
