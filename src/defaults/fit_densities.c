// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tested: cli/test_fit_densities.
#include "defaults/fit_densities.h"

#include "base/memory.h"
#include "defaults/methods.h"
#include "observe/weighted_density.h"

#include <math.h>
#include <string.h>

/// By which rounding may change a number of the file.
static const double rounding = 1e-4;

/// The next local density after one whose energy is to be found, or −1.
static int find_next(const struct scene_many_body *many_body, int after) {
    for (int t = after + 1; many_body->law && t < many_body->law->terms; t++)
        if (scene_many_body_is_fitted(many_body, t))
            return t;
    return -1;
}

/// The first of them: there is one target to find an energy from.
static int find_term(const struct scene_many_body *many_body) {
    return find_next(many_body, -1);
}

static struct weighted_density_settings *settings_of(struct fit_file *fit) {
    return fit->files.settings[mf_observable_kind(mf_weighted_density_kind()).place];
}

static bool are_equal(double a, double b) {
    return fabs(a - b) <= rounding * fabs(b);
}

/// Whether the density of a term is the one that the target has measured: of all beads, by the
/// same weight.
static bool is_that_of_target(const struct fit_file *fit, int t,
                              const struct weighted_density_settings *settings) {
    const struct scene_many_body *many_body = &fit->scene.many_body;
    const struct many_body_term *term = &many_body->law->term[t];
    const int types = fit->scene.setup.composition.types;
    const uint32_t all = (1U << (types > 1 ? types : 1)) - 1;
    const struct weight_parameters *weight = many_body->weight[t].parameters;
    return many_body->weight[t].family == &mf_weight_sanyal_shell &&
           are_equal(weight->cutoff, settings->cutoff) &&
           fabs(weight->inner_cutoff - settings->inner_cutoff) <= rounding * weight->cutoff &&
           (term->central & all) == all && (term->neighbours & all) == all;
}

/// Equal bins from 0, as `measure` and `simulate` write them, and p that is one.
static enum status check_bins(const struct target_curve *curve) {
    const double width = 2 * curve->x[0];
    double sum = 0;
    for (size_t k = 0; k < curve->points; k++) {
        if (!are_equal(curve->x[k], ((double)k + 0.5) * width))
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: expected the middles of equal bins from 0, as "
                "weighted_density.tsv has them, those of p = 0 too; row %zu is at %g, "
                "and %g was expected, after a first one at %g",
                curve->parameters.file, k + 1, curve->x[k], ((double)k + 0.5) * width, curve->x[0]);
        if (curve->value[k] < 0)
            return mf_status_fail(STATUS_BAD_INPUT, "%s: row %zu: p = %g is not a distribution",
                                  curve->parameters.file, k + 1, curve->value[k]);
        sum += isfinite(curve->value[k]) ? curve->value[k] * width : 0;
    }
    if (fabs(sum - 1) < 0.01)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: the integral of p over the rows without nan is %.4g, not 1: counts are "
        "divided by their sum and by the width of a bin, and bins reach beyond "
        "the densest bead",
        curve->parameters.file, sum);
}

/// What was never seen, or not often enough for an error, has that of what was seen least.
static void complete_errors(const struct target_curve *curve) {
    double least = INFINITY;
    for (size_t k = 0; k < curve->points; k++)
        if (curve->value[k] > 0 && curve->error[k] > 0)
            least = fmin(least, curve->error[k]);
    for (size_t k = 0; k < curve->points; k++) {
        curve->value[k] = isfinite(curve->value[k]) ? curve->value[k] : 0;
        if (!(curve->error[k] > 0))
            curve->error[k] = isfinite(least) ? least : 0;
    }
}

/// The verification measures in the bins of the target.
static void set_bins(struct fit_file *fit, const struct target_curve *curve) {
    struct weighted_density_settings *settings = settings_of(fit);
    settings->bins = (int64_t)curve->points;
    settings->maximum = 2 * curve->x[0] * (double)curve->points;
}

static enum status lengthen(double **values, size_t from, size_t to) {
    double *longer;
    TRY_ARRAY(longer, to);
    memcpy(longer, *values, from * sizeof *longer);
    mf_memory_free(*values);
    *values = longer;
    return STATUS_OK;
}

enum status mf_fit_densities_widen(struct fit_file *fit, size_t bins) {
    struct target_curve *curve = fit->files.own[mf_weighted_density_kind()];
    const size_t before = curve->points;
    if (bins == before)
        return STATUS_OK;
    TRY(lengthen(&curve->x, before, bins));
    TRY(lengthen(&curve->value, before, bins));
    TRY(lengthen(&curve->error, before, bins));
    for (size_t k = before; k < bins; k++) {
        curve->x[k] = (2 * (double)k + 1) * curve->x[0];
        curve->error[k] = curve->error[before - 1];
    }
    curve->points = bins;
    set_bins(fit, curve);
    return STATUS_OK;
}

/// Why the energy of a term cannot be found from the target; NULL if it can.
static const char *find_fault(const struct fit_file *fit, int t, const struct target_curve *curve,
                              const struct weighted_density_settings *settings) {
    if (curve->points == 0 || settings == NULL)
        return "there is no \"target.weighted_density\" to find it from; measure it, or give "
               "\"energy\"";
    if (fit->files.use[mf_weighted_density_kind()].fitted == 0)
        return "\"target.weighted_density\", which it is found from, has \"fitted\": \"no\"; leave "
               "that out, or give \"energy\"";
    if (!is_that_of_target(fit, t, settings))
        return "it is found from \"target.weighted_density\", that of all beads by the weight "
               "\"sanyal-shell\" with the same cutoffs";
    return NULL;
}

enum status mf_fit_densities_read(struct fit_file *fit, struct json_object *root) {
    const char *const key = "scene";
    const int kind = mf_weighted_density_kind(), t = find_term(&fit->scene.many_body);
    if (t < 0 || mf_json_fault_count(root->document) > 0)
        return STATUS_OK;
    const struct target_curve *curve = target_files_curve(&fit->files, kind);
    struct weighted_density_settings *settings = settings_of(fit);
    const int other = find_next(&fit->scene.many_body, t);
    const char *name = fit->scene.many_body.law->term[other < 0 ? t : other].name;
    const char *why = other >= 0 ? "that of another density is found from "
                                   "\"target.weighted_density\"; give it, or leave this density out"
                                 : find_fault(fit, t, curve, settings);
    if (why) {
        mf_json_fault(root, key, "many_body.%s has no \"energy\": %s", name, why);
        return STATUS_OK;
    }
    if (check_bins(curve) != STATUS_OK) {
        mf_json_fault(root, "target", "%s", mf_status_marked());
        return STATUS_OK;
    }
    complete_errors(curve);
    set_bins(fit, curve);
    fit->unknown[UNKNOWN_BONDED].wanted = true;
    return STATUS_OK;
}

void mf_fit_densities_state(const struct fit_file *fit, struct inverse_problem *problem) {
    const int t = find_term(&fit->scene.many_body);
    const struct target_curve *curve = target_files_curve(&fit->files, mf_weighted_density_kind());
    if (t < 0 || curve->points == 0)
        return;
    problem->group[problem->bonded++] = (struct bonded_unknown){
        .order = INVERSE_LOCAL_DENSITY, .group = t, .bins = {0, 2 * curve->x[0], curve->points}};
}

static bool finds_energies(const struct inverse_method *method) {
    return (method->kind == INVERSE_INVERSION || method->kind == INVERSE_DIRECT) &&
           method->knows_molecules && !method->restricted;
}

enum status mf_fit_densities_check(const struct fit_file *fit, const char *file) {
    char others[METHODS_TEXT_SIZE];
    const struct scene_many_body *many_body = &fit->scene.many_body;
    const int t = find_term(many_body);
    if (t < 0)
        return STATUS_OK;
    if (!finds_energies(fit->method))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: method.name: \"%s\" does not find an \"energy\" that "
                              "\"scene.many_body\" leaves out; %s do",
                              file, fit->method->name, mf_methods_list(finds_energies, others));
    const double range = mf_rdf_bins_range(&fit->problem.targets.bins);
    const double cutoff = weight_cutoff(&many_body->law->term[t].weight);
    if (!fit->unknown[UNKNOWN_POTENTIAL].wanted || range >= (1 - rounding) * cutoff)
        return STATUS_OK;
    const double length = mf_units_factor(&fit->scene.units, "lambda");
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: target.rdf: it ends at %g, before the weight of "
                          "\"scene.many_body.%s\" at %g; g(r) and the energy are told apart only "
                          "where it reaches as far",
                          file, length * range, many_body->law->term[t].name, length * cutoff);
}
