// SPDX-License-Identifier: GPL-3.0-or-later
//
// Targets in another unit than that of the file: beside what beads of the scene go by, they are too
// large or too small for any liquid.
#include "targets/target_sanity.h"

#include "scene/scene_doubts.h"

#include <math.h>
#include <stdio.h>

/// Of mean distances: water's g(r) has its first peak at 0.9, and no core is a tenth.
static const double shortest_range = 0.3;

/// Of ρ^(−1/d) sqrt(k_B T/m): water has 0.02, dense liquids before they freeze 0.02, gases more
/// than 1 and no bound.
static const double slowest = 1e-3;

struct report {
    const struct scene *scene;
    const struct target_sanity_listener *listener;
};

static void warn_of_doubt(void *context, const char *line) {
    const struct report *report = context;
    mf_target_sanity_warn(report->listener, "mesofit: warning: scene.%s", line);
}

/// r in metres, or in angstrom where nm are.
static void look_at_ranges(const struct target_files *files, double distance,
                           const struct report *report) {
    const struct target_pairs *pairs = target_files_rdf(files);
    double length;
    const char *unit = mf_target_sanity_length(report->scene, &length);
    for (size_t pair = 0; pair < pairs->pairs; pair++) {
        const struct target_rows *rows = &pairs->member[pair].rows;
        if (rows->count == 0 || rows->x[rows->count - 1] > shortest_range * distance)
            continue;
        mf_target_sanity_warn(report->listener,
                              "mesofit: warning: target.rdf: %s: r ends at %.3g %s, where beads "
                              "have a mean distance of %.3g: is r in metres, or another unit of "
                              "length than %s?",
                              pairs->member[pair].parameters.file,
                              rows->x[rows->count - 1] * length, unit, distance * length, unit);
    }
}

static void look_at_bond(const struct target_bonded *member, const char *name, double distance,
                         const struct report *report) {
    const struct bonded_bins *bins = &member->bins;
    const double begin = bins->low, end = bins->low + (double)bins->count * bins->width;
    double length;
    const char *unit = mf_target_sanity_length(report->scene, &length);
    if (begin <= scene_longest_bond * distance && end > 0.1 * distance)
        return;
    mf_target_sanity_warn(report->listener,
                          "mesofit: warning: target.bond_lengths.%s: %s: bonds of %.3g to %.3g %s, "
                          "where beads have a mean distance of %.3g: are they in another unit of "
                          "length than %s?",
                          name, member->parameters.file, begin * length, end * length, unit,
                          distance * length, unit);
}

static void look_at_bonds(const struct target_files *files, double distance,
                          const struct report *report) {
    const struct target_groups *groups = target_files_groups(files, BONDED_BOND);
    for (size_t g = 0; g < groups->groups; g++)
        if (target_groups_have(groups, g))
            look_at_bond(&groups->member[g], groups->name[g], distance, report);
}

/// The VACF begins at d k_B T/m, which a normalised one, or one in nm²/ns², does not.
static void look_at_velocities(const struct target_files *files, const struct report *report) {
    static const double factor_off = 2;
    const struct simulation_setup *setup = &report->scene->setup;
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    const struct target_curve *curve = target_files_curve(files, TARGET_VACF);
    const double thermal = setup->box.dimensions * setup->temperature;
    const double factor = mf_units_factor(&report->scene->units, "lambda^2/tau^2");
    const double low = thermal / (masses.maximum > 0 ? masses.maximum : 1),
                 high = thermal / (masses.maximum > 0 ? masses.minimum : 1);
    if (!files->given[TARGET_VACF] || curve->points == 0 || curve->x[0] != 0 ||
        (curve->value[0] > low / factor_off && curve->value[0] < high * factor_off))
        return;
    mf_target_sanity_warn(report->listener,
                          "mesofit: warning: target.vacf: %s: at t = 0 it is %.4g, where the "
                          "temperature and the mass of the scene make %d k_B T/m = %.4g: is it "
                          "normalised, or in another unit?",
                          curve->parameters.file, factor * curve->value[0], setup->box.dimensions,
                          factor * low);
}

/// D in cm²/s, 10⁻⁵ in liquids, where the file has nm²/ps or Å²/fs.
static void look_at_diffusion(const struct target_files *files, struct scene_scales scales,
                              const struct report *report) {
    const struct units *units = &report->scene->units;
    const struct target_number *target = files->own[TARGET_DIFFUSION];
    const double natural = scales.distance * scales.distance / scales.time;
    const double factor = mf_units_factor(units, "lambda^2/tau");
    char unit[UNITS_NAME_SIZE], square_cm[UNITS_NAME_SIZE + 32] = "";
    if (!files->given[TARGET_DIFFUSION] || !(target->value > 0) ||
        target->value > slowest * natural)
        return;
    mf_units_name(units, "lambda^2/tau", unit);
    if (mf_units_known(units) && units->system != UNITS_REDUCED)
        snprintf(square_cm, sizeof square_cm, " (1 cm^2/s is %d %s)",
                 units->system == UNITS_NM_PS ? 100 : 10, unit);
    mf_target_sanity_warn(report->listener,
                          "mesofit: warning: target.diffusion: %.3g %s is %.2g of what beads have "
                          "that lose their velocity at each neighbour, %.2g, where liquids have "
                          "more than 0.01 of it: is it in another unit%s?",
                          factor * target->value, unit, target->value / natural, factor * natural,
                          square_cm);
}

void mf_target_sanity_report_scales(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener) {
    struct report report = {scene, listener};
    const struct scene_scales scales = mf_scene_scales(scene);
    mf_scene_doubts(scene, &(struct scene_doubts_listener){warn_of_doubt, &report});
    look_at_ranges(files, scales.distance, &report);
    look_at_bonds(files, scales.distance, &report);
    look_at_velocities(files, &report);
    look_at_diffusion(files, scales, &report);
}
