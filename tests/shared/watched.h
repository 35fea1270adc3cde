// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Sampling what a test holds in variables of its own.
#pragma once

#include "observe/etd.h"
#include "observe/force_covariance.h"
#include "observe/measure.h"
#include "observe/motion.h"
#include "observe/rdf_force.h"
#include "observe/thermodynamics.h"

/// What to measure, already initialised; NULL members are not. `rdf_force` goes with or without
/// `rdf`.
struct watched {
    struct rdf *rdf;
    struct rdf_force *rdf_force;
    struct thermodynamics *thermodynamics;
    struct force_covariance *force_covariance;
    struct motion *motion;
    struct etd *etd;
};

/// mf_measure_sample of these.
enum status watched_sample(struct simulation *simulation, const struct measure_plan *plan,
                           struct watched watched, const struct measure_listener *listener);
