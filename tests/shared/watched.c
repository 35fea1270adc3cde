// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/watched.h"

#include "observe/rdf_observable.h"

enum status watched_sample(struct simulation *simulation, const struct measure_plan *plan,
                           struct watched watched, const struct measure_listener *listener) {
    struct rdf_observed rdf = {0};
    struct observable_use uses[6] = {{0}}, *use = uses;
    if (watched.rdf)
        rdf.counted = *watched.rdf;
    if (watched.rdf_force)
        rdf.force = *watched.rdf_force;
    if (watched.rdf || watched.rdf_force)
        *use++ = (struct observable_use){&mf_rdf_observable, &rdf, NULL};
    if (watched.etd)
        *use++ = (struct observable_use){&mf_etd_observable, watched.etd, NULL};
    if (watched.motion)
        *use++ = (struct observable_use){&mf_motion_observable, watched.motion, NULL};
    if (watched.thermodynamics)
        *use++ =
            (struct observable_use){&mf_thermodynamics_observable, watched.thermodynamics, NULL};
    if (watched.force_covariance)
        *use++ = (struct observable_use){&mf_force_covariance_observable, watched.force_covariance,
                                         NULL};
    const enum status status = mf_measure_sample(simulation, plan, uses, listener);
    if (watched.rdf)
        *watched.rdf = rdf.counted;
    if (watched.rdf_force)
        *watched.rdf_force = rdf.force;
    return status;
}
