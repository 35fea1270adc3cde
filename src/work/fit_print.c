// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_print.h"

#include "base/interrupt.h"
#include "base/visible.h"
#include "defaults/fit_engine.h"
#include "defaults/fit_scales.h"
#include "dynamics/hybrid_step.h"
#include "dynamics/respa.h"
#include "observe/stages.h"
#include "system/attributes.h"

#include <math.h>
#include <stdio.h>

static void print_line(void *progress, const char *line) {
    mf_progress_print(progress, "%s", line);
}

static double variance_of(const struct target_bonded *bond) {
    double sum = 0, mean = 0, square = 0;
    for (size_t k = 0; k < bond->bins.count; k++) {
        const double q = bonded_bins_centre(&bond->bins, k);
        sum += bond->value[k];
        mean += bond->value[k] * q;
        square += bond->value[k] * q * q;
    }
    return square / sum - pow(mean / sum, 2);
}

/// A bond whose length has the variance s² oscillates with Ω² = 2 k_B T/(m s²). Steps Δt make the
/// variance wrong by a share of (Ω Δt)², and blow up where that is 4.
static void warn_of_step(const struct fit_file *fit,
                         const struct target_sanity_listener *listener) {
    static const double coarse = 0.05, fine = 0.003;
    const struct simulation_setup *setup = &fit->scene.setup;
    const struct units *units = &fit->scene.units;
    const struct target_groups *bonds = target_files_groups(&fit->files, BONDED_BOND);
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    const double mass = masses.maximum > 0 ? masses.minimum : 1;
    const bool own = fit->verification.time_step > 0;
    const double step = own ? fit->verification.time_step : setup->time_step;
    const double time = mf_units_factor(units, "tau");
    char unit[UNITS_NAME_SIZE], harm[64];
    mf_units_suffix(units, "tau", unit);
    if (!simulation_has_velocities(setup) || mf_respa_acts(setup))
        return;
    for (size_t g = 0; g < bonds->groups; g++) {
        if (!target_groups_have(bonds, g))
            continue;
        const double turn =
            2 * setup->temperature * step * step / (mass * variance_of(&bonds->member[g]));
        const double share = turn * mf_hybrid_step_wrong(setup->integrator);
        if (share < coarse && turn < 4)
            continue;
        snprintf(harm, sizeof harm, "make their variance wrong by %.0f %%", 100 * share);
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: %s.time_step: with %.3g%s the bonds \"%s\" %s in the "
            "verification; %.2g%s would make their variance right within 0.3 %%",
            own ? "verification" : "scene", step * time, unit, bonds->name[g],
            turn < 4 ? harm : "blow up", sqrt(fine / share) * step * time, unit);
    }
}

/// A range far beyond the structure of g makes a fit slow, and tells it nothing.
static enum status warn_of_range(const struct fit_file *fit,
                                 const struct target_sanity_listener *listener) {
    static const double many = 150, more = 2;
    const struct simulation_setup *setup = &fit->scene.setup;
    struct fit_scales_rdf rdf;
    double length;
    if (!fit->files.given[TARGET_RDF] || !fit->unknown[UNKNOWN_POTENTIAL].wanted)
        return STATUS_OK;
    TRY(mf_fit_scales_rdf_init(&rdf, &fit->files, &fit->scene));
    const struct fit_scales scales =
        mf_fit_scales_find(&rdf, setup->temperature, fit_scales_little);
    mf_fit_scales_rdf_clear(&rdf);
    const double enough = fmax(scales.seen, 2 * scales.neighbour);
    const double others = 2 * mf_stages_pairs_within(setup, scales.range),
                 near = 2 * mf_stages_pairs_within(setup, enough);
    const char *unit = mf_target_sanity_length(&fit->scene, &length);
    if (others > many && others > more * near)
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: target.rdf: %.0f others are within its range of "
            "each bead, which makes the fit slow; within %.4g %s, beyond which g "
            "differs from its tail by less than %g or its noise, there are %.0f; a "
            "\"cutoff\" there saves that time, and ends the potential, too: what "
            "its law would do beyond is then left open",
            others, enough * length, unit, fit_scales_little, near);
    return STATUS_OK;
}

/// What acts beside the potential that is looked for, and who has it.
static void tell_known(const struct fit_file *fit, const struct target_sanity_listener *listener) {
    const struct composition *composition = &fit->scene.setup.composition;
    char laws[512] = "";
    size_t used = 0;
    if (fit->scene.known.curves == 0)
        return;
    for (int pair = 0; pair < mf_composition_pairs(composition) && used < sizeof laws; pair++) {
        const struct curve *law = mf_scene_law_curve(&fit->scene.known, pair);
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, pair, name);
        used += (size_t)snprintf(laws + used, sizeof laws - used, "%s%s%s%s", pair > 0 ? ", " : "",
                                 name, name[0] ? " " : "", law ? law->family->name : "none");
    }
    mf_target_sanity_warn(
        listener, "known beside the potential that is looked for: %s; %s", laws,
        mf_fit_engine_knows_more(fit) ? "the engine has it itself, and its tables are of the rest"
        : fit->engine.kind == ENGINE_NONE ? "simulations have both"
                                          : "the tables of the engine are of both");
}

/// Pairs whose potential is not looked for.
static void tell_others(const struct fit_file *fit, const struct target_sanity_listener *listener) {
    const struct composition *composition = &fit->scene.setup.composition;
    char others[256] = "";
    size_t used = 0;
    for (int pair = 0; pair < mf_composition_pairs(composition) && used < sizeof others; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, pair, name);
        if (!mf_targets_have_pair(&fit->problem.targets, (size_t)pair) &&
            mf_composition_has_pairs(composition, pair))
            used += (size_t)snprintf(others + used, sizeof others - used, "%s%s",
                                     used > 0 ? ", " : "", name);
    }
    if (used > 0 && fit->unknown[UNKNOWN_POTENTIAL].wanted)
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: no g(r) is given of %s: their potential is not looked for; %s",
            others,
            mf_fit_engine_knows_more(fit) ? "the engine has it" : "it is that of scene.known");
}

enum status mf_fit_print_state(const struct fit_file *fit,
                               const struct target_sanity_listener *listener) {
    tell_known(fit, listener);
    tell_others(fit, listener);
    warn_of_step(fit, listener);
    TRY(warn_of_range(fit, listener));
    return mf_target_sanity_report(&fit->files, &fit->scene, listener);
}

static enum status report_state(struct progress *to, const struct fit_file *fit) {
    const struct target_etd *etd = target_files_etd(&fit->files);
    const char *warning = mf_scene_warning(&fit->scene);
    if (fit->name[0])
        mf_progress_print(to, "state \"%s\":", fit->name);
    if (warning)
        mf_progress_print(to, "mesofit: warning: scene: %s", warning);
    for (size_t k = 0; k < fit->choices.count; k++)
        mf_progress_print(to, "chosen: %s", fit->choices.line[k]);
    if (fit->choices.doubt[0])
        mf_progress_print(to, "mesofit: warning: %s", fit->choices.doubt);
    if (etd->left_out > 0)
        mf_progress_print(to,
                          "target.etd: %zu of %zu cells of the target are not known and left out",
                          etd->left_out, (size_t)(etd->grid.times * etd->grid.bins));
    return mf_fit_print_state(fit, &(struct target_sanity_listener){print_line, to});
}

enum status mf_fit_print_targets(struct progress *to, const struct fit_file *fit) {
    mf_progress_print_scale(to, &fit->scene.units);
    TRY(report_state(to, fit));
    for (size_t s = 0; s < fit->others; s++)
        TRY(report_state(to, &fit->other[s]));
    return STATUS_OK;
}

/// No fit is without an error: 0 is what nobody has set yet.
static bool is_known(double error) {
    return isfinite(error) && error > 0;
}

void mf_fit_print_step(const struct inverse_step *step, double seconds, struct progress *progress) {
    if (isfinite(step->error))
        mf_progress_print(progress, "iteration %u  error %.4f  noise %.4f  %.1f s", step->iteration,
                          mf_visible_number(step->error), mf_visible_number(step->noise), seconds);
    else
        mf_progress_print(progress, "iteration %u  %.1f s", step->iteration, seconds);
}

void mf_fit_print_iteration(const struct inverse_progress *now, const struct units *units,
                            char text[FIT_TELL_SIZE]) {
    const struct inverse_doubling *doubling = &now->doubling;
    char error[48] = "", min[48] = "", mean[64] = "", unit[UNITS_NAME_SIZE];
    if (doubling->number > 0) {
        const double factor = mf_units_factor(units, doubling->unit);
        snprintf(text, FIT_TELL_SIZE,
                 "iteration %u  doubling samples, %d of %d: noise %.2g, wanted %.2g%s",
                 now->iteration, doubling->number, doubling->max, factor * doubling->noise,
                 factor * doubling->wanted, mf_units_suffix(units, doubling->unit, unit));
        return;
    }
    if (is_known(now->best))
        snprintf(error, sizeof error, "  error %.4f so far", now->best);
    if (is_known(now->min))
        snprintf(min, sizeof min, "  this round: best %.4f", now->min);
    if (is_known(now->mean))
        snprintf(mean, sizeof mean, ", mean %.4f, %llu failed", now->mean,
                 (unsigned long long)now->failures);
    snprintf(text, FIT_TELL_SIZE, "iteration %u%s%s%s", now->iteration, error, min, mean);
}

void mf_fit_print_unconverged(const char *folder, const struct inverse_step *step,
                              const char *reason) {
    if (isfinite(step->error))
        mf_status_fail(STATUS_UNCONVERGED,
                       "the fit has not converged%s%s; next: its best curves, figures and "
                       "summary.json are in %s; docs/fit.md has a remedy for each reason",
                       reason[0] ? ": " : "", reason, folder);
    else if (reason[0])
        mf_status_fail(STATUS_UNCONVERGED,
                       "the fit has no result: %s; the failures are counted in %s/history.tsv",
                       reason, folder);
    else
        mf_status_fail(STATUS_UNCONVERGED,
                       "not one simulation of the fit succeeded; the failures are counted in "
                       "%s/history.tsv",
                       folder);
}

void mf_fit_print_warnings(struct progress *to, const struct fit_file *fit,
                           const struct verification *verification) {
    for (size_t s = 0; s <= fit->others; s++)
        if (verification[s].warning[0])
            mf_progress_print(to, "mesofit: warning: %s%s%s",
                              s == 0 ? fit->name : fit->other[s - 1].name, fit->name[0] ? ": " : "",
                              verification[s].warning);
}

// The engine that samples -------------------------------------------------------------------------

enum status mf_fit_engine_expect(const struct fit_file *fit, const struct engine_door *door) {
    if (fit->engine.kind == ENGINE_NONE && door && door->command)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--engine: the run file has no \"engine\" that says what the "
                              "command is: {\"name\": \"lammps\"} or \"command\"");
    return STATUS_OK;
}

enum status mf_fit_engine_open(struct fit_file *fit, const struct engine_door *door,
                               const char *folder, bool resume) {
    TRY(mf_fit_engine_expect(fit, door));
    if (fit->engine.kind == ENGINE_NONE)
        return STATUS_OK;
    if (door == NULL || door->command == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "engine: its command stands on the command line, as a run file "
                              "starts nothing: mesofit fit ... --engine \"COMMAND\"");
    return door->open(door->command, fit, folder, resume, &fit->problem.engine);
}

bool mf_fit_engine_waits(const struct fit_file *fit, const struct engine_door *door) {
    char text[STATUS_MESSAGE_SIZE / 2];
    if (fit->problem.engine == NULL || !door->waits(fit->problem.engine, text, sizeof text))
        return false;
    mf_interrupt_plan();
    (void)mf_status_fail(STATUS_INTERRUPTED, "%s", text);
    return true;
}

enum status mf_fit_engine_print_targets(struct progress *to, const struct fit_file *fit,
                                        bool resume) {
    const struct sampling_engine *engine = fit->problem.engine;
    return resume && engine && engine->announce ? STATUS_OK : mf_fit_print_targets(to, fit);
}

void mf_fit_engine_close(struct fit_file *fit, const struct engine_door *door) {
    if (door)
        door->close(fit->problem.engine);
    fit->problem.engine = NULL;
}
