// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the README says of the tables, and of checks of a run: g(r) by `measure`, and the
/// density at constant pressure, which is to be expected by the pressure and the compressibility of
/// the result.
#pragma once

#include "export/export_engine.h"

/// How wrong the tables are.
void mf_export_checks_tables(const struct export_job *job, FILE *stream);

/// @param[in] files  arguments of `measure`: the trajectory of the run, and what goes with it
void mf_export_checks_rdf(const struct export_job *job, const char *files, FILE *stream);

/// @param[in] commands  lines that run the folder at 1 atm, or at 1 in the engine's unit
void mf_export_checks_pressure(const struct export_job *job, const char *commands, FILE *stream);

/// The pressure of these commands in the engine's unit: 1 atm or 1 bar; in reduced units, and where
/// the compressibility is not known, that of the result, if it is known and above 0.
double mf_export_checks_usual_pressure(const struct export_job *job);

/// κ_T in the engine's unit, of the result's g(r) or S(q); NAN: it is not known.
double mf_export_checks_compressibility(const struct export_job *job);
