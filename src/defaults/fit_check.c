// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_file.h"

#include "defaults/fit_densities.h"
#include "defaults/fit_engine.h"
#include "defaults/methods.h"
#include "targets/target_sanity.h"
#include "io/units_scale.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"
#include "inversion/inversion.h"
#include "inversion/inversion_state.h"
#include "problem/group_kind.h"
#include "problem/measurement.h"
#include "problem/unknowns.h"

#include <string.h>

/// Begin one simulation, so that a box too small for the forces or particles without room are found
/// now and not by the verification after the fit.
static enum status begin_one(const struct fit_file *fit, const struct inverse_problem *problem) {
    CLEARED_BY(mf_unknowns_clear) struct unknowns unknowns = {0};
    CLEARED_BY(mf_unknowns_laws_clear) struct unknowns_laws laws = {0};
    CLEARED_BY(mf_measurement_clear) struct measurement measurement = {0};
    TRY(mf_units_convert_message(&fit->scene.units, mf_unknowns_init(&unknowns, problem)));
    TRY(mf_unknowns_laws_start(&unknowns, &laws));
    const struct measurement_setup setup = {.targets = &problem->compared,
                                            .potential = laws.table[UNKNOWN_POTENTIAL],
                                            .omega = laws.table[UNKNOWN_OMEGA],
                                            .time_step = fit->verification.time_step,
                                            .plan = fit->verification.plan,
                                            .thermodynamics = true,
                                            .threads = 1,
                                            .seed = problem->seed};
    return mf_units_convert_message(&fit->scene.units,
                                    mf_measurement_init(&measurement, &laws.problem, &setup));
}

/// The same with each number at the ends of its range.
static enum status try_scene(const struct fit_file *fit) {
    const struct inverse_problem *problem = &fit->problem;
    TRY(begin_one(fit, problem));
    for (size_t n = 0; n < problem->numbers; n++)
        for (int end = 0; end < 2; end++) {
            struct inverse_problem other = *problem;
            struct inverse_number *number = &other.number[n];
            number->start = end ? number->maximum : number->minimum;
            const enum status status = begin_one(fit, &other);
            if (status != STATUS_OK)
                return mf_status_prefix(status, "with %s = %g", number->name,
                                        number->start *
                                            mf_units_factor(&fit->scene.units, number->unit));
        }
    return STATUS_OK;
}

static enum status check_range(const struct fit_file *fit, const char *file, const char *target,
                               double range) {
    const struct box *box = &fit->scene.setup.box;
    if (mf_box_shortest(box) >= 2 * range)
        return STATUS_OK;
    const double length = mf_units_factor(&fit->scene.units, "lambda");
    char unit[UNITS_NAME_SIZE];
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: scene.box: the shortest edge %g is below twice the range of the "
                          "target \"%s\", %g%s; are both in the same unit? A larger box with more "
                          "particles, or a target that ends earlier, would do",
                          file, length * mf_box_shortest(box), target, length * range,
                          mf_units_suffix(&fit->scene.units, "lambda", unit));
}

/// Whether a kind of targets is of bonds, angles or dihedrals some of which are looked for.
static bool is_inverted(const struct fit_file *fit, int kind) {
    for (size_t g = 0; g < fit->problem.bonded; g++)
        if (mf_group_kind_target(fit->problem.group[g].order) == kind)
            return true;
    return false;
}

static bool fits_molecules(const struct inverse_method *method) {
    return method->knows_molecules;
}

/// A group is found from its own distribution.
static enum status check_molecules(const struct fit_file *fit, const char *file) {
    char others[METHODS_TEXT_SIZE];
    if (scene_has_molecules(&fit->scene.molecules) && !fit->method->knows_molecules)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: method.name: \"%s\" does not fit molecules; %s do", file,
                              fit->method->name, mf_methods_list(fits_molecules, others));
    for (int kind = 0; mf_targets_name(kind); kind++)
        if (is_inverted(fit, kind) && !fit->files.use[kind].fitted)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: target.%s.fitted: U is found from this target alone", file,
                                  mf_targets_name(kind));
    return STATUS_OK;
}

static bool fits_integrals(const struct inverse_method *method) {
    return mf_methods_fits_any_target(method) || method->meets_integrals;
}

/// Integrals of Kirkwood and Buff are met by linear equations, not by a ramp.
static enum status check_integrals(const struct fit_file *fit, const char *file) {
    char others[METHODS_TEXT_SIZE];
    if (fits_integrals(fit->method) || !targets_ask(&fit->problem.targets, mf_kirkwood_buff_kind()))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: target.kirkwood_buff: \"%s\" does not fit it; %s do; with "
                          "\"fitted\": \"no\" it is compared with",
                          file, fit->method->name, mf_methods_list(fits_integrals, others));
}

/// An inversion changes the potential of all pairs by the response of all pairs.
static enum status check_intermolecular(const struct fit_file *fit, const char *file) {
    char others[METHODS_TEXT_SIZE];
    if (fit->method->kind == INVERSE_MATCHING ||
        !targets_ask(&fit->problem.targets, mf_rdf_intermolecular_kind()))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: target.intermolecular_rdf.fitted: \"%s\" does not fit it; where molecules exclude all "
        "intramolecular pairs it is the same as rdf: give the file as \"rdf\"; %s fit it, and "
        "\"no\" compares it with the result",
        file, fit->method->name, mf_methods_list(mf_methods_fits_any_target, others));
}

/// A target of its own that an inversion has no use for.
static enum status fail_of_target(const struct fit_file *fit, const char *file, int kind) {
    char others[METHODS_TEXT_SIZE];
    if (kind == mf_weighted_density_kind())
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: target.weighted_density.fitted: f is found from it where "
            "\"scene.many_body\" has its weight, and no \"energy\"; \"no\" compares "
            "it with the result",
            file);
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: target.%s.fitted: \"%s\" does not fit it; %s do, and \"no\" "
                          "compares it with the result",
                          file, mf_targets_name(kind), fit->method->name,
                          mf_methods_list(mf_methods_fits_any_target, others));
}

static enum status check_unknowns(const struct fit_file *fit, const char *file) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (fit->unknown[kind].wanted &&
            !(unknown_is_omega(kind) ? fit->method->finds_omega : fit->method->finds_potential))
            return mf_status_fail(STATUS_BAD_INPUT, "%s: method.name: \"%s\" does not find %s",
                                  file, fit->method->name, mf_inverse_unknown_names[kind]);
    if (fit->numbers > 0 && fit->method->kind != INVERSE_MATCHING)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: method.name: \"%s\" does not find numbers",
                              file, fit->method->name);
    for (int kind = 0; kind < TARGETS && fit->method->kind != INVERSE_MATCHING; kind++)
        if (kind != TARGET_RDF && kind != TARGET_PRESSURE && kind != TARGET_DENSITY &&
            kind != mf_kirkwood_buff_kind() && !is_inverted(fit, kind) &&
            targets_ask(&fit->problem.targets, kind))
            return fail_of_target(fit, file, kind);
    if (fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->files.given[TARGET_RDF])
        return mf_status_fail(STATUS_BAD_INPUT, "%s: target.rdf is required to find a potential",
                              file);
    if (fit->unknown[UNKNOWN_POTENTIAL].wanted && !fit->files.use[TARGET_RDF].fitted)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: target.rdf.fitted: a potential is found from its g(r)", file);
    return STATUS_OK;
}

static enum status check_bins(const struct fit_file *fit, const char *file) {
    size_t bins = fit->problem.targets.target[TARGET_RDF].count;
    for (size_t g = 0; g < fit->problem.bonded; g++)
        bins += fit->problem.group[g].bins.count;
    if (fit->method->kind != INVERSE_INVERSION || bins <= INVERSION_MAX_BINS)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: target.rdf: expected at most %d bins of all pairs, found %zu: merge "
                          "bins by \"bin_width\", or end the target by \"cutoff\"",
                          file, INVERSION_MAX_BINS, bins);
}

static bool follows_pairs(const struct inverse_method *method) {
    return method->kind != INVERSE_MATCHING || method == &mf_successive;
}

/// The closure of "hnc" needs g(r) of all pairs that there are.
static bool follows_given_pairs(const struct inverse_method *method) {
    return follows_pairs(method) && method != &mf_hnc;
}

/// What acts between pairs whose g(r) is not given: a potential of nobody's is none.
static bool knows_others(const struct fit_file *fit) {
    const bool engine = mf_fit_engine_knows_more(fit) && mf_fit_engine_verifies(fit);
    return engine || fit->scene.known.curves > 0;
}

/// A potential is looked for between pairs whose g(r) is given. Of a single bead there are none;
/// the potentials of others are known. What moves the curves of all pairs would move theirs.
static enum status check_pair(const struct fit_file *fit, int pair, const char *file) {
    const struct composition *composition = &fit->scene.setup.composition;
    const bool exists = mf_composition_has_pairs(composition, pair);
    char name[COMPOSITION_PAIR_NAME_SIZE], others[METHODS_TEXT_SIZE];
    mf_composition_pair_name(composition, pair, name);
    if (exists && !knows_others(fit))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: target.rdf.%s: missing: give its g(r), or, where its potential "
                              "is known, that as \"known\" of \"scene\"",
                              file, name);
    bool (*const can)(const struct inverse_method *) = exists ? follows_given_pairs : follows_pairs;
    if (can(fit->method))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: method.name: %s pair %s, which \"%s\" needs; %s do not", file,
                          exists ? "no g(r) is given of the" : "a single bead has no", name,
                          fit->method->name, mf_methods_list(can, others));
}

static enum status check_pairs(const struct fit_file *fit, const char *file) {
    const int pairs = mf_composition_pairs(&fit->scene.setup.composition);
    for (int pair = 0; fit->unknown[UNKNOWN_POTENTIAL].wanted && pair < pairs; pair++)
        if (!mf_targets_have_pair(&fit->problem.targets, (size_t)pair))
            TRY(check_pair(fit, pair, file));
    return STATUS_OK;
}

/// An inversion samples pairs, molecules and local densities alone.
static enum status check_interactions(const struct fit_file *fit, const char *file) {
    const int others = fit->scene.setup.interactions - scene_has_molecules(&fit->scene.molecules) -
                       (fit->scene.many_body.law != NULL);
    char methods[METHODS_TEXT_SIZE];
    if (fit->method->kind != INVERSE_INVERSION || others == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: scene.interactions: \"%s\" samples only pairs, molecules and "
                          "\"many_body\"; use a method that simulates candidates: %s",
                          file, fit->method->name,
                          mf_methods_list(mf_methods_fits_any_target, methods));
}

/// Without velocities there is no VACF to be measured, and without time nothing that needs it.
static enum status check_velocities(const struct fit_file *fit, const char *file) {
    const struct simulation_setup *setup = &fit->scene.setup;
    for (int kind = 0; kind < TARGETS && setup->integrator->samples; kind++)
        if (fit->files.given[kind] && mf_observable_kind(kind).observable->of_time)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: target.%s: \"%s\" has neither time nor velocities", file,
                                  mf_targets_name(kind), setup->integrator->name);
    if (simulation_has_velocities(setup) || !fit->files.given[TARGET_VACF])
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: target.vacf: \"%s\" has no velocities", file,
                          setup->integrator->name);
}

/// Targets at times are measured in whole time steps, which an unknown step has not.
static enum status check_free_step(const struct fit_file *fit, const char *file) {
    static const enum target_kind timed[] = {TARGET_ETD, TARGET_VACF, TARGET_MSD};
    for (size_t n = 0; n < fit->problem.numbers; n++)
        for (size_t k = 0; k < sizeof timed / sizeof *timed; k++)
            if (strcmp(fit->problem.number[n].name, "time_step") == 0 && fit->files.given[timed[k]])
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: unknowns.numbers.time_step: target.%s is measured in "
                                      "whole time steps",
                                      file, mf_targets_name(timed[k]));
    return STATUS_OK;
}

/// The time step must be able to follow all that a memory may become.
static enum status check_memory(const struct fit_file *fit, const char *file) {
    const struct inverse_problem *problem = &fit->problem;
    const double step = problem->scene.time_step;
    for (size_t n = 0; n < problem->numbers; n++) {
        const struct inverse_number *number = &problem->number[n];
        const char *field = strrchr(number->name, '.');
        if (strncmp(number->name, "memory.", strlen("memory.")) != 0 || field == NULL)
            continue;
        const double factor = mf_units_factor(&fit->scene.units, number->unit);
        if (strcmp(field, ".time") == 0 && number->minimum < 2 * step)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: unknowns.numbers.%s.minimum: %.4g is below two time steps, "
                                  "%.4g: use \"omega\" for so short a memory",
                                  file, number->name, number->minimum * factor, 2 * step * factor);
        if (strcmp(field, ".frequency") == 0 && number->maximum * step > 0.5)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: unknowns.numbers.%s.maximum: %.4g is beyond %.4g, half a "
                                  "radian a time step",
                                  file, number->name, number->maximum * factor,
                                  0.5 / step * factor);
    }
    return STATUS_OK;
}

static enum status check_steps(const struct fit_file *fit, const char *file) {
    TRY(check_free_step(fit, file));
    enum status status = mf_target_files_check_steps(&fit->files, fit->scene.setup.time_step);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s: scene.time_step", file);
    if (fit->verification.time_step > 0)
        status = mf_target_files_check_steps(&fit->files, fit->verification.time_step);
    return status == STATUS_OK ? STATUS_OK
                               : mf_status_prefix(status, "%s: verification.time_step", file);
}

/// A simulation must be as long as the longest window of what is measured in it.
static enum status check_window(const char *file, const char *key, const struct targets *targets,
                                double time_step, int64_t samples, int64_t every) {
    enum target_kind longest;
    const int64_t window = mf_measurement_window(targets, time_step, &longest);
    if (samples * every >= window)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: %s.samples: %lld, one \"every\" %lld steps, are %lld steps, but \"%s\" "
        "looks at %lld; %lld would do",
        file, key, (long long)samples, (long long)every, (long long)(samples * every),
        mf_targets_name(longest), (long long)window, (long long)((window + every - 1) / every));
}

static enum status check_windows(const struct fit_file *fit, const char *file) {
    const struct verify_parameters *verification = &fit->verification;
    const double time_step = fit->scene.setup.time_step;
    if (fit->method->kind == INVERSE_MATCHING) {
        const struct inverse_sampling sampling = fit->method->sampling(fit->method_parameters);
        TRY(check_window(file, "method", &fit->problem.targets, time_step, sampling.samples,
                         sampling.every));
    }
    return check_window(file, "verification", &fit->problem.compared,
                        verification->time_step > 0 ? verification->time_step : time_step,
                        verification->plan.samples, verification->plan.every);
}

/// Before the scene is begun, which takes long of many molecules. Other engines sample all of it.
static enum status check_size(const struct fit_file *fit, const char *file) {
    const int64_t particles = (int64_t)mf_methods_sampled_particles(fit);
    if (fit->engine.kind != ENGINE_NONE)
        return STATUS_OK;
    const enum status status = mf_inversion_check_size(&fit->problem, particles);
    return status == STATUS_OK
               ? STATUS_OK
               : mf_status_prefix(mf_units_convert_message(&fit->scene.units, status), "%s", file);
}

enum status mf_fit_check(const struct fit_file *fit, const char *file) {
    const struct target_files *files = &fit->files;
    TRY(check_molecules(fit, file));
    TRY(mf_fit_densities_check(fit, file));
    TRY(check_integrals(fit, file));
    TRY(check_intermolecular(fit, file));
    TRY(check_unknowns(fit, file));
    if (files->given[TARGET_RDF])
        TRY(check_range(fit, file, "rdf",
                        mf_rdf_bins_range(target_pairs_bins(target_files_rdf(files)))));
    if (files->given[mf_rdf_intermolecular_kind()])
        TRY(check_range(fit, file, "intermolecular_rdf",
                        mf_rdf_bins_range(target_pairs_bins(target_files_intermolecular(files)))));
    if (files->given[TARGET_ETD])
        TRY(check_range(fit, file, "etd", target_files_etd(files)->grid.r_maximum));
    if (mf_targets_count(&fit->problem.targets) == 0)
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s: target: nothing to fit%s", file,
            fit->constraints.count > 0
                ? ": its target is that of a constraint, whose potential is not fitted"
                : "");
    TRY(check_bins(fit, file));
    TRY(check_pairs(fit, file));
    TRY(check_interactions(fit, file));
    TRY(check_velocities(fit, file));
    TRY(check_steps(fit, file));
    TRY(check_memory(fit, file));
    TRY(check_windows(fit, file));
    if (fit->scene.setup.placement.kind == PLACEMENT_FILE)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: scene.particles.placement: a fit places its particles on a lattice "
            "or at random",
            file);
    // Targets first: a potential begins with that of g(r).
    TRY(mf_target_sanity_check(files, &fit->scene, file));
    TRY(check_size(fit, file));
    const enum status status = try_scene(fit);
    return status == STATUS_OK ? status : mf_status_prefix(status, "%s: scene", file);
}
