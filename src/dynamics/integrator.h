// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a simulation moves by one time step: the record of an integrator.
///
/// To add one, write a file with its record and put it into the list in integrator.c.
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "forces/friction.h"

struct simulation;

struct integrator {
    const char *name;
    const char *summary;        ///< method and citation, one line
    const struct field *fields; ///< of struct integrator_parameters
    bool dissipative;           ///< understands ω(r)
    /// What it makes of ω, if it splits friction and noise off the forces; NULL: they are forces.
    const struct friction_method *friction;
    /// A step begins with the friction of the pairs that the last one kept.
    bool friction_first;
    /// Forces are computed in the middle of the step: those at its end take a pass of their own.
    bool forces_midway;
    /// Advance by one step, with one call of mf_simulation_compute_forces.
    enum status (*step)(struct simulation *simulation);
};

/// Parameters of all mf_integrator_list; a record's field table names those it reads.
struct integrator_parameters {
    double lambda;    ///< dpd-verlet
    double tolerance; ///< aboba-implicit
};

/// All mf_integrator_list, NULL-terminated.
extern const struct integrator *const mf_integrator_list[];

extern const struct integrator mf_velocity_verlet;
extern const struct integrator mf_dpd_verlet;
extern const struct integrator mf_dpd_vv;
extern const struct integrator mf_shardlow;
extern const struct integrator mf_aboba;
extern const struct integrator mf_aboba_implicit;
extern const struct integrator mf_lowe_andersen;
