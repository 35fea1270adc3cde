// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Physical units of a scene: what λ, k_B T_0 and μ are.
#pragma once

#include "base/fields.h"
#include "io/json.h"
#include "io/json_write.h"

/// Boltzmann's and Avogadro's constants (exact, SI 2019).
#define UNITS_BOLTZMANN 1.380649e-23
#define UNITS_AVOGADRO 6.02214076e23

struct units {
    double length;      ///< λ [nm]; 0 if the scene has no physical units
    double temperature; ///< T_0 [K]
    double mass;        ///< μ [kg]
};

extern const struct field mf_units_fields[];

/// Read "units" of a scene; units whose time, energy, pressure or diffusion no number can hold are
/// a fault. Tested: test_units.
void mf_units_read(struct units *units, struct json_object *scene);

bool mf_units_known(const struct units *units);
double mf_units_energy_kj_per_mol(const struct units *units);   ///< k_B T_0 [kJ/mol]
double mf_units_time_ps(const struct units *units);             ///< λ sqrt(μ / k_B T_0) [ps]
double mf_units_pressure_bar(const struct units *units);        ///< k_B T_0 / λ³ [bar]
double mf_units_diffusion_cm2_per_s(const struct units *units); ///< λ²/τ [cm²/s]

/// A column of a table in another unit: factor · values; the caller frees it. NULL: no memory.
double *mf_units_column(const double *values, size_t count, double factor);

/// Add an object "physical" with the units and the given results in them; nothing if not known.
/// @param[in] energy    of a particle [k_B T_0]
/// @param[in] pressure  [k_B T_0/λ³]
void mf_units_put(const struct units *units, struct json_writer *writer, double energy,
                  double pressure);
