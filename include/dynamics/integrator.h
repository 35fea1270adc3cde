// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a simulation moves by one time step: the record of an integrator.
///
/// To add one, write a file with its record and put it into the list in integrator.c.
#pragma once

#include "base/fields.h"
#include "base/status.h"

struct simulation;

struct integrator {
    const char *name;
    const char *summary;        ///< method and citation, one line
    const struct field *fields; ///< of struct integrator_parameters
    bool dissipative;           ///< understands ω(r)
    /// Advance by one step: positions, then forces (simulation_compute_forces), then velocities.
    enum status (*step)(struct simulation *simulation);
};

/// Parameters of all integrator_list; a record's field table names those it reads.
struct integrator_parameters {
    double lambda; ///< dpd-verlet
};

/// All integrator_list, NULL-terminated.
extern const struct integrator *const integrator_list[];

extern const struct integrator velocity_verlet;
extern const struct integrator dpd_verlet;
