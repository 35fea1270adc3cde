// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Physical units of a scene: what λ, k_B T_0 and μ are, and in which units its files and
/// results are.
///
/// Inside, everything is in reduced units. Conversions stand where files are read and written, by
/// the units of field tables and of columns' headings: a number of the unit "k_B T_0/lambda" is
/// multiplied by mf_units_factor on its way out, and divided by it on its way in. Units of matter
/// as it is, such as "nm", and pure numbers stay what they are. Tested: test_units.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/// Boltzmann's and Avogadro's constants (exact, SI 2019).
#define UNITS_BOLTZMANN 1.380649e-23
#define UNITS_AVOGADRO 6.02214076e23
/// 1 g/mol [kg], by which 1 u nm²/ps² is 1 kJ/mol; CODATA's u differs by 4e-10.
#define UNITS_ATOMIC_MASS (1e-3 / UNITS_AVOGADRO)

/// Units of files and results.
enum units_system {
    UNITS_REDUCED,     ///< λ, τ, μ, k_B T_0
    UNITS_NM_PS,       ///< nm, ps, u, kJ/mol, K, bar
    UNITS_ANGSTROM_FS, ///< Å, fs, g/mol, kcal/mol, K, atm: LAMMPS's "real"
};

/// A zeroed one is reduced, and has no scale.
struct units {
    double length;      ///< λ [nm]; 0 if the scene has no physical units
    double temperature; ///< T_0 [K]
    double mass;        ///< μ [kg]
    int system;         ///< enum units_system
    int dimensions;     ///< of the scene, for "lambda^d"; 0 stands for 3
    bool chosen;        ///< λ by the program: no other file can know it
    bool massless;      ///< the file says no mass, and μ stands for it
};

/// Whether files and results are in other units than reduced ones. NULL: they are not.
bool mf_units_are_physical(const struct units *units);

/// Names of the systems as files have them: "reduced", "nm-ps", "angstrom-fs"; NULL-terminated.
extern const char *const mf_units_systems[];

bool mf_units_known(const struct units *units);
/// Whether tables in reduced units have columns in physical ones beside.
bool mf_units_have_second_columns(const struct units *units);
double mf_units_energy_kj_per_mol(const struct units *units);   ///< k_B T_0 [kJ/mol]
double mf_units_time_ps(const struct units *units);             ///< λ sqrt(μ / k_B T_0) [ps]
double mf_units_pressure_bar(const struct units *units);        ///< k_B T_0 / λ³ [bar]
double mf_units_diffusion_cm2_per_s(const struct units *units); ///< λ²/τ [cm²/s]

enum { UNITS_NAME_SIZE = 128, UNITS_LINE_SIZE = 256, UNITS_MEASURED_SIZE = 192 };

/// How many units of the file one reduced `unit` of a field table or heading is: with "lambda"
/// and nm-ps, λ in nm. 1 for reduced files, units that the scene does not set, and what is no unit.
/// @param[in] units  NULL: reduced
double mf_units_factor(const struct units *units, const char *unit);

/// The name of the same unit in the file: "nm", "kJ/mol/nm^2", "bar", "sqrt(u/ps)".
/// @param[out] name  shape [UNITS_NAME_SIZE]
/// Returns `name`.
const char *mf_units_name(const struct units *units, const char *unit, char *name);

/// " nm", the name of a unit after a number of a message, or "" in reduced units and of pure
/// numbers, "1", which are left out.
const char *mf_units_suffix(const struct units *units, const char *unit, char *name);

/// A number of a reduced unit with its error, for a person: "0.29(1) nm^2/ps". Returns `text`.
const char *mf_units_measured(const struct units *units, const char *unit, double value,
                              double error, char text[UNITS_MEASURED_SIZE]);

/// Numbers of a text that have the mark of a reduced unit (STATUS_IN) in those of the file, with
/// their names; in a reduced file without the marks. Tested: test_units.
void mf_units_convert_text(const struct units *units, char *text, size_t size);

/// The same of the message of the calling thread. Returns `status` unchanged.
enum status mf_units_convert_message(const struct units *units, enum status status);

/// The number that a file says for `reduced`: factor · reduced, or, where rounding allows it, the
/// number nearest to that which reads back to the same bits, 15 digits or fewer if they do.
double mf_units_file_value(double reduced, double factor);

/// What makes the reduced `unit` of a number in units of `from`, which a heading names.
/// Fails: BAD_INPUT if `from` is no unit, one of something else, or of a λ that the program chose.
enum status mf_units_from(const struct units *units, const char *from, const char *unit,
                          double *factor) MUST_USE;

/// "nm-ps: lambda = 0.465 nm, …", the scale in one line.
void mf_units_print(const struct units *units, char line[UNITS_LINE_SIZE]);
