// SPDX-License-Identifier: GPL-3.0-or-later
//
// What was made of a table of g(r) that is not what a program writes.
#include "targets/target_sanity.h"

#include <math.h>
#include <stdio.h>

void mf_target_sanity_report_reading(const struct target_rdf *target, const char *name,
                                     const struct scene *scene,
                                     const struct target_sanity_listener *listener) {
    const struct target_resampling *r = &target->resampling;
    double length;
    char error[96] = "";
    const char *unit = mf_target_sanity_length(scene, &length);
    if (target->negative > 0)
        mf_target_sanity_warn(listener,
                              "target %s: g is below 0 in %zu rows, by %.2g at most: taken as 0",
                              name, target->negative, -target->min);
    if (r->points == 0)
        return;
    if (r->assumed)
        snprintf(error, sizeof error, ", each with the error %.2g that is assumed,", r->error);
    else if (r->error > 0)
        snprintf(error, sizeof error, ", which scatter by %.2g in g and %.2g %s in r,", r->error,
                 r->error_in_r * length, unit);
    mf_target_sanity_warn(listener,
                          "target %s: r is not equally spaced (steps of %.3g to %.3g %s): its %zu "
                          "points%s are read at equal bins of %.4g %s by cubic interpolation",
                          name, r->shortest * length, r->longest * length, unit, r->points, error,
                          target->bins.width * length / (double)target->joined, unit);
}

void mf_target_sanity_report_normalisation(const struct normalisation *n,
                                           const struct target_sanity_listener *listener) {
    if (n->found)
        mf_target_sanity_warn(
            listener,
            "target.rdf: g(r) is too %s at all distances: it is divided by %.4f(%.0f); "
            "\"normalisation\" of the target sets another factor, 1 for none",
            n->factor > 1 ? "large" : "small", n->factor, ceil(n->error * 1e4));
}
