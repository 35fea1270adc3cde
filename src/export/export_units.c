// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_units.h"

#include <math.h>

/// How many of a unit are a nm, ps, kJ/mol and bar.
struct scale {
    double length, time, energy, pressure;
    const char *length_name, *time_name, *energy_name, *pressure_name;
    const char *flat_pressure_name; ///< energy over an area
};

static const struct scale scales[] = {
    [EXPORT_REAL] = {10, 1000, 1 / 4.184, 1 / 1.01325, "A", "fs", "kcal/mol", "atm",
                     "kcal/mol/A^2"},
    [EXPORT_NANOMETRES] = {1, 1, 1, 1, "nm", "ps", "kJ/mol", "bar", "kJ/mol/nm^2"},
    [EXPORT_DL_POLY] = {10, 1, 1, 1e-3 / 1.01325, "A", "ps", "kJ/mol", "katm", "kJ/mol/A^2"},
};

struct export_units mf_export_units(enum export_system system, const struct units *units,
                                    bool physical) {
    static const struct units pretended = {.length = 1,
                                           .temperature = 1e3 / (UNITS_BOLTZMANN * UNITS_AVOGADRO),
                                           .mass = UNITS_ATOMIC_MASS};
    if (!mf_units_known(units) && physical)
        units = &pretended;
    const bool flat = units->dimensions == 2;
    if (system == EXPORT_REDUCED || !mf_units_known(units))
        return (struct export_units){EXPORT_REDUCED,
                                     1,
                                     1,
                                     1,
                                     1,
                                     1,
                                     1,
                                     "lambda",
                                     "tau",
                                     "k_B T_0",
                                     "T_0",
                                     flat ? "k_B T_0/lambda^2" : "k_B T_0/lambda^3"};
    const struct scale *scale = &scales[system];
    const double energy = mf_units_energy_kj_per_mol(units) * scale->energy;
    return (struct export_units){
        .system = system,
        .length = units->length * scale->length,
        .time = mf_units_time_ps(units) * scale->time,
        .energy = energy,
        .mass = units->mass * UNITS_AVOGADRO * 1e3,
        .temperature = units->temperature,
        .pressure = flat ? energy / pow(units->length * scale->length, 2)
                         : mf_units_pressure_bar(units) * scale->pressure,
        .length_name = scale->length_name,
        .time_name = scale->time_name,
        .energy_name = scale->energy_name,
        .temperature_name = "K",
        .pressure_name = flat ? scale->flat_pressure_name : scale->pressure_name,
    };
}
