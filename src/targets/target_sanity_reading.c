// SPDX-License-Identifier: GPL-3.0-or-later
//
// What was made of a table of g(r) that is not what a program writes, and a pressure that no fluid
// has.
#include "targets/target_sanity.h"

#include <math.h>
#include <stdio.h>

/// How many times as large as an ideal gas's a pressure can be. Fluids of repulsions r^-12 freeze
/// at 19 times, of r^-6 at 39, hard spheres at 12.5; coarse potentials of water, and DPD's, have 7
/// to
/// 25. Water's 1 bar in Pa would be 73.
static const double largest = 50;

void mf_target_sanity_report_pressure(const struct target_files *files, const struct scene *scene,
                                      const struct target_sanity_listener *listener) {
    const struct target_number *const target = files->own[TARGET_PRESSURE];
    const struct simulation_setup *const setup = &scene->setup;
    const struct units *const units = &scene->units;
    const double ideal = setup->temperature *
                         (double)mf_composition_particles(&setup->composition) /
                         mf_box_volume(&setup->box);
    const double factor = mf_units_factor(units, "k_B T_0/lambda^d");
    char unit[UNITS_NAME_SIZE];
    if (!files->given[TARGET_PRESSURE] || !(fabs(target->value) > largest * ideal))
        return;
    mf_units_suffix(units, "k_B T_0/lambda^d", unit);
    mf_target_sanity_warn(listener,
                          "mesofit: warning: target.pressure: %.6g%s is %.3g times the pressure of "
                          "an ideal gas of this density and temperature, %.4g%s: no fluid has more "
                          "than some %g times as much; is it in%s, and not in Pa or another unit?",
                          factor * target->value, unit, fabs(target->value) / ideal, factor * ideal,
                          unit, largest, unit[0] ? unit : " units of k_B T_0/lambda^3");
}

/// Where pairs do not come g is 0, and a fluid of soft cores has pairs from r = 0 on.
static void warn_of_missing_rows(const struct target_rdf *target, const char *name,
                                 const struct scene *scene,
                                 const struct target_sanity_listener *listener) {
    static const double seen = 0.05, standard_errors = 3;
    double length;
    const char *unit = mf_target_sanity_length(scene, &length);
    if (target->bins.low < 0.5 * target->bins.width ||
        target->g[0] < fmax(seen, standard_errors * target->error[0]))
        return;
    mf_target_sanity_warn(listener,
                          "mesofit: warning: target.%s: its first row, at %.4g %s, has g = %.3g: "
                          "nearer pairs are taken for none, as if rows of 0 were missing; give g "
                          "from where it is 0, or from r = 0",
                          name, mf_rdf_bins_centre(&target->bins, 0) * length, unit, target->g[0]);
}

/// A potential that ends before its "cutoff" is not the one that was asked for.
static void warn_of_missing_end(const struct target_rdf *target, const char *name,
                                const struct scene *scene,
                                const struct target_sanity_listener *listener) {
    const double end = mf_rdf_bins_edge(&target->bins, target->bins.count);
    const double cutoff = target->parameters.cutoff;
    double length;
    const char *unit = mf_target_sanity_length(scene, &length);
    if (cutoff > end + target->bins.width)
        mf_target_sanity_warn(listener,
                              "mesofit: warning: target.%s.cutoff: %.4g %s is beyond the end of "
                              "the table: g(r) and the potential end at %.4g %s",
                              name, cutoff * length, unit, end * length, unit);
}

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
    warn_of_missing_rows(target, name, scene, listener);
    warn_of_missing_end(target, name, scene, listener);
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
