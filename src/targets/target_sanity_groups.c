// SPDX-License-Identifier: GPL-3.0-or-later
//
// A look at the targets of bonds, angles and dihedrals, at g(r) of molecules, and at units.
#include "scene/scene_doubts.h"
#include "targets/target_sanity.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void mf_target_sanity_warn(const struct target_sanity_listener *listener, const char *format, ...) {
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    listener->warn(listener->context, line);
}

/// Unit of printed lengths.
const char *mf_target_sanity_length(const struct scene *scene, double *length) {
    const struct units *units = &scene->units;
    static const char *const names[] = {"nm", "nm", "angstrom"};
    *length =
        mf_units_have_second_columns(units) ? units->length : mf_units_factor(units, "lambda");
    return mf_units_known(units) ? names[units->system] : "lambda";
}

/// "target bond_lengths.backbone: 34 bins of 0.001 from 0.1505 to 0.1835, peak 84 at 0.169; …".
static void report_group(const struct target_groups *groups, size_t g, const struct scene *scene,
                         const struct target_sanity_listener *listener) {
    const struct target_bonded *member = &groups->member[g];
    const struct bonded_bins *bins = &member->bins;
    size_t peak = 0;
    char errors[128] = "";
    if (bins->count == 0)
        return;
    for (size_t k = 0; k < bins->count; k++)
        peak = member->value[k] > member->value[peak] ? k : peak;
    if (member->estimated_error > 0)
        snprintf(errors, sizeof errors, "; no errors given: %.2g of the peak %s",
                 member->estimated_error,
                 member->assumed ? "is assumed there" : "there, from the scatter of the rows");
    double factor = 1;
    const char *unit = mf_bonded_kinds[groups->order]->is_length
                           ? mf_target_sanity_length(scene, &factor)
                           : "degrees";
    mf_target_sanity_warn(listener,
                          "target %s.%s: %zu bins of %.4g from %.4g to %.4g %s, peak at %.4g%s",
                          mf_bonded_distribution_of(groups->order)->name, groups->name[g],
                          bins->count, factor * bins->width, factor * bins->low,
                          factor * (bins->low + (double)bins->count * bins->width), unit,
                          factor * bonded_bins_centre(bins, peak), errors);
}

/// Three beads in a line have no plane: next to it the forces of a dihedral are without bound, and
/// no time step follows them. Octane in four beads, of angles up to 180 degrees, was at 317 K for
/// 298 K.
static void warn_of_lines(const struct target_files *files,
                          const struct target_sanity_listener *listener) {
    static const double straight = 170, many = 0.01;
    const struct target_groups *angles = target_files_groups(files, BONDED_ANGLE);
    for (size_t g = 0;
         files->given[mf_bonded_distribution_kind(BONDED_DIHEDRAL)] && g < angles->groups; g++) {
        const struct target_bonded *member = &angles->member[g];
        double share = 0;
        for (size_t k = 0; k < member->bins.count; k++)
            if (bonded_bins_centre(&member->bins, k) > straight)
                share += member->value[k] * member->bins.width;
        if (share > many)
            mf_target_sanity_warn(
                listener,
                "mesofit: warning: target.dihedral_angles: %.0f %% of the angles \"%s\" are within "
                "10 degrees of a straight line, where the force of a dihedral has no bound: "
                "simulations with it are too hot. Leave the dihedrals out, and write "
                "\"exclude\": 3 into the molecule if g(r) was counted with them",
                100 * share, angles->name[g]);
    }
}

/// Beads of the longest molecule: so many of all are not counted around a bead at most.
static double longest(const struct topology *topology) {
    int beads = 0;
    for (int k = 0; k < topology->kinds; k++)
        beads = topology->kind[k].beads > beads ? topology->kind[k].beads : beads;
    return beads;
}

/// Over the last quarter of its range, g of a pair type, and its scatter from row to row.
static struct target_tail tail_of(const struct target_files *files, size_t pair) {
    const struct target_rdf *target = &target_files_rdf(files)->member[pair];
    const double given = target->parameters.normalisation, factor = given > 0 ? given : 1;
    return (struct target_tail){.mean = target->tail.mean / factor,
                                .scatter = target->tail.scatter / factor};
}

/// Whether g does not end at 1, by more than `allowed` and by more than chance.
static bool ends_beside_1(struct target_tail tail, double allowed) {
    static const double deviations = 3;
    const double away = fabs(tail.mean - 1);
    return away > allowed && away > deviations * tail.scatter;
}

/// The only pair type whose g does not end at 1, where all others do, or −1: types of one kind of
/// molecules that gather change the g of all pairs.
static int find_odd_pair(const struct target_files *files, const struct topology *topology,
                         double allowed) {
    const bool one_kind =
        topology->kinds == 1 && topology->kind[0].count == topology->molecules &&
        (size_t)topology->kind[0].count * (size_t)topology->kind[0].beads == topology->particles;
    int odd = -1, count = 0;
    for (size_t pair = 0; pair < target_files_rdf(files)->pairs; pair++)
        if (target_files_rdf(files)->has_g[pair] && ends_beside_1(tail_of(files, pair), allowed)) {
            odd = (int)pair;
            count++;
        }
    return one_kind && target_files_rdf(files)->pairs > 1 && count == 1 ? odd : -1;
}

/// The mean g of all beads has no reason to differ from 1 at its end, where that of a pair type
/// may: types gather. Molecules have no theory that finds its factor (inversion/normalisation).
static void warn_of_tails(const struct target_files *files, const struct scene *scene,
                          const struct target_sanity_listener *listener) {
    static const double allowed = 0.03;
    const struct composition *composition = &files->composition;
    const struct topology *topology = &scene->molecules.molecules.topology;
    const double max = allowed + longest(topology) / (double)mf_composition_particles(composition);
    const int odd = find_odd_pair(files, topology, max);
    struct target_tail mean = {0};
    double all = 0;
    for (size_t pair = 0; pair < target_files_rdf(files)->pairs; pair++)
        all += mf_composition_possible_pairs(composition, (int)pair);
    for (size_t pair = 0; pair < target_files_rdf(files)->pairs; pair++) {
        const double part = mf_composition_possible_pairs(composition, (int)pair) / all;
        mean.mean += part * tail_of(files, pair).mean;
        mean.scatter += part * tail_of(files, pair).scatter;
    }
    if (odd >= 0) {
        const struct target_tail tail = tail_of(files, (size_t)odd);
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, odd, name);
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: target.rdf.%s: over the last quarter of its range g is %.3f(%.0f), "
            "not 1, which the other pair types have there: is it over another number of pairs than "
            "these? A fit of molecules does not mend it; \"normalisation\" divides by a factor",
            name, tail.mean, ceil(1e3 * tail.scatter));
    } else if (all > 0 && ends_beside_1(mean, max)) {
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: target.rdf: over the last quarter of its range g of all beads is "
            "%.3f(%.0f), not 1: is its volume or number of beads another than the scene's? A fit "
            "of molecules does not mend it; \"normalisation\" of each pair divides by a factor",
            mean.mean, ceil(1e3 * mean.scatter));
    }
}

void mf_target_sanity_report_groups(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (size_t g = 0; g < target_files_groups(files, order)->groups; g++)
            report_group(target_files_groups(files, order), g, scene, listener);
    mf_target_sanity_report_other_errors(files, listener);
    warn_of_lines(files, listener);
    if (scene_has_molecules(&scene->molecules))
        warn_of_tails(files, scene, listener);
}

// Targets in another unit than that of the file ---------------------------------------------------

// Beside what beads of the scene go by, they are too large or too small for any liquid.

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
