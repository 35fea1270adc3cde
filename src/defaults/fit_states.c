// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_states.h"

#include "base/names.h"
#include "base/rng.h"
#include "defaults/fit_densities.h"
#include "defaults/methods.h"
#include "inversion/inversion.h"
#include "io/units_scale.h"
#include "problem/group_kind.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const key = "states";

/// What a state can have of its own; the rest is of all.
static enum status check_keys(const struct json_object *states, const char *file,
                              const char *name) {
    static const char *const own[] = {"scene", "target", "verification"};
    struct json_object all = *states;
    const char *member;
    if (!mf_json_is_object(states, name)) // its reader says so
        return STATUS_OK;
    const struct json_object state = mf_json_child(&all, name, false);
    for (size_t n = 0; (member = mf_json_key(&state, n)); n++) {
        bool known = false;
        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            known = known || strcmp(member, own[k]) == 0;
        if (!known)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s.%s.%.80s: a state has \"scene\", \"target\" and "
                                  "\"verification\"; shared keys belong outside",
                                  file, key, name, member);
    }
    return STATUS_OK;
}

static enum status check_names(const struct json_object *states, const char *file, size_t *count) {
    const char *name;
    for (*count = 0; (name = mf_json_key(states, *count)); ++*count) {
        if (name[0] == '.' || !mf_names_is_plain(name, "_-.", FIT_STATE_NAME_SIZE)) // of a folder
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s: \"%.80s\": expected a state name of letters, digits, _, "
                                  "- and ., at most %d",
                                  file, key, name, FIT_STATE_NAME_SIZE - 1);
        TRY(check_keys(states, file, name));
    }
    if (*count >= 1 && *count <= INVERSE_MAX_STATES)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: %s: there are %zu; from 1 to %d can be fitted",
                          file, key, *count, INVERSE_MAX_STATES);
}

enum status mf_fit_states_take(struct json_document *document, const char *file, size_t n,
                               char *name, size_t *count) {
    struct json_object root = mf_json_root(document);
    name[0] = '\0';
    *count = 0;
    if (root.item == NULL || !mf_json_is_member(&root, key))
        return STATUS_OK;
    if (!mf_json_is_object(&root, key))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: %s: expected an object of states", file, key);
    const struct json_object states = mf_json_child(&root, key, false);
    TRY(check_names(&states, file, count));
    snprintf(name, FIT_STATE_NAME_SIZE, "%s", mf_json_key(&states, n));
    return mf_json_take_variant(document, key, n);
}

size_t mf_fit_states_count(const struct fit_file *fit) {
    return 1 + fit->others;
}

struct fit_file *mf_fit_states_at(struct fit_file *fit, size_t s) {
    return s == 0 ? fit : &fit->other[s - 1];
}

/// "precision" among the parameters of an inversion, which all have first.
static double *precision_of(const struct fit_file *state) {
    return &((struct inversion_parameters *)state->method_parameters)->precision;
}

/// The samples of all states are as exact as the most exact target asks for.
static void share_precision(struct fit_file *fit) {
    double *precision = precision_of(fit), min = *precision;
    for (size_t s = 0; s < fit->others; s++)
        min = fmin(min, *precision_of(&fit->other[s]));
    if (min < *precision && fit->choices.count < FIT_MAX_CHOICES)
        snprintf(fit->choices.line[fit->choices.count++], FIT_CHOICE_SIZE,
                 "\"precision\" %.2g of all states: the least that was chosen for one", min);
    *precision = min;
}

void mf_fit_states_link(struct fit_file *fit) {
    const size_t count = mf_fit_states_count(fit);
    if (count > 1 && fit->method->knows_states)
        share_precision(fit);
    for (size_t s = 0; s < count; s++) {
        fit->problems[s] = &mf_fit_states_at(fit, s)->problem;
        // The steepest of what was chosen for each.
        fit->core.stiffness = fmax(fit->core.stiffness, mf_fit_states_at(fit, s)->core.stiffness);
    }
    fit->problem.core_stiffness = fit->core.stiffness;
    for (size_t s = 0; count > 1 && s < count; s++) {
        struct inverse_problem *problem = &mf_fit_states_at(fit, s)->problem;
        problem->state = fit->problems;
        problem->states = count;
        problem->name = mf_fit_states_at(fit, s)->name;
        problem->core_threshold = fit->problem.core_threshold;
        problem->core_stiffness = fit->problem.core_stiffness;
        if (s > 0)
            problem->seed = mf_rng_child_seed(fit->problem.seed, RNG_STATES, (uint32_t)s, 0);
    }
}

enum status mf_fit_states_normalise(struct fit_file *fit) {
    for (size_t s = 0; s < mf_fit_states_count(fit); s++) {
        struct fit_file *state = mf_fit_states_at(fit, s);
        TRY(mf_target_files_normalise(&state->files, &state->scene.setup.box,
                                      scene_has_molecules(&state->scene.molecules)));
    }
    return STATUS_OK;
}

enum status mf_fit_states_mark(const struct fit_file *fit, enum status status) {
    return status == STATUS_OK || fit->name[0] == '\0'
               ? status
               : mf_status_prefix(status, "%s.%s", key, fit->name);
}

static bool same_types(const struct composition *a, const struct composition *b) {
    bool same = a->types == b->types;
    for (int type = 0; same && type < a->types; type++)
        same = strcmp(a->name[type], b->name[type]) == 0;
    return same;
}

static bool same_units(const struct units *a, const struct units *b) {
    return a->system == b->system && fabs(a->length - b->length) <= 1e-9 * fabs(a->length) &&
           fabs(a->temperature - b->temperature) <= 1e-9 * fabs(a->temperature) &&
           fabs(a->mass - b->mass) <= 1e-9 * fabs(a->mass);
}

/// Curves are shared point by point.
static enum status check_alike(const struct fit_file *fit, const struct fit_file *other,
                               const char *file) {
    const struct targets *first = &fit->problem.targets, *second = &other->problem.targets;
    const double width = first->bins.width, length = mf_units_factor(&fit->scene.units, "lambda");
    if (!same_types(&fit->scene.setup.composition, &other->scene.setup.composition))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %s.%s: its types of beads are not those of \"%s\"", file, key,
                              other->name, fit->name);
    if (fit->scene.setup.box.dimensions != other->scene.setup.box.dimensions)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: %s.%s: its dimensions are not those of \"%s\"",
                              file, key, other->name, fit->name);
    if (!same_units(&fit->scene.units, &other->scene.units))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %s.%s: scene.units: they are not those of \"%s\": lambda, T_0 "
                              "and mu are of all states",
                              file, key, other->name, fit->name);
    if (first->bins.count != second->bins.count ||
        !(fabs(first->bins.low - second->bins.low) < 1e-6 * width) ||
        !(fabs(first->bins.width - second->bins.width) < 1e-6 * width))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: %s.%s: target.rdf has %zu bins of %.4g from %.4g, that of \"%s\" has %zu of %.4g "
            "from %.4g: a potential that is shared needs the same bins and the same \"cutoff\"",
            file, key, other->name, second->bins.count, length * second->bins.width,
            length * second->bins.low, fit->name, first->bins.count, length * width,
            length * first->bins.low);
    for (int kind = 0; mf_targets_name(kind); kind++)
        if (targets_ask(first, kind) != targets_ask(second, kind))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s: target.%s: \"%s\" fits it and \"%s\" does not; all "
                                  "states fit the same targets",
                                  file, key, mf_targets_name(kind),
                                  targets_ask(first, kind) ? fit->name : other->name,
                                  targets_ask(first, kind) ? other->name : fit->name);
    return STATUS_OK;
}

static bool fits_states(const struct inverse_method *method) {
    return method->knows_states;
}

enum status mf_fit_states_check(const struct fit_file *fit, const char *file) {
    char others[METHODS_TEXT_SIZE];
    if (fit->others > 0 && !fits_states(fit->method))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: method.name: \"%s\" fits one state; %s fit several", file,
                              fit->method->name, mf_methods_list(fits_states, others));
    for (size_t s = 0; s < fit->others; s++)
        TRY(check_alike(fit, &fit->other[s], file));
    return STATUS_OK;
}

// Common bins -------------------------------------------------------------------------------------

/// Bins meet if their edges are closer than this part of a bin, over all of them.
static const double rounding = 0.02;

static const char *name_of(const struct fit_file *fit, size_t g) {
    return mf_group_kind_group(&fit->problem.scene, &fit->problem.group[g]);
}

/// Whether a group means the same in two states: one f(ρ) is of densities by one weight.
static bool is_alike(const struct fit_file *fit, const struct fit_file *other, size_t g) {
    const struct bonded_unknown *first = &fit->problem.group[g], *second = &other->problem.group[g];
    if (first->order != second->order || strcmp(name_of(fit, g), name_of(other, g)) != 0)
        return false;
    if (first->order != INVERSE_LOCAL_DENSITY)
        return true;
    const struct weight_table *a = &fit->scene.many_body.law->term[first->group].weight;
    const struct weight_table *b = &other->scene.many_body.law->term[second->group].weight;
    const double apart = fmax(fabs(weight_cutoff(a) - weight_cutoff(b)), fabs(a->inner - b->inner));
    return apart < 1e-6 * weight_cutoff(a);
}

static enum status check_groups(const struct fit_file *fit, const struct fit_file *other,
                                const char *file) {
    bool same = fit->problem.bonded == other->problem.bonded;
    for (size_t g = 0; same && g < fit->problem.bonded; g++)
        same = is_alike(fit, other, g);
    if (same)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: states.%s: the bonds, angles, dihedrals and local densities that it "
                          "has targets for, and no laws, are not those of \"%s\"",
                          file, other->name, fit->name);
}

/// Bins from the begin of `a` to that of `b`; NaN if they do not meet.
static double find_shift(const struct bonded_bins *a, const struct bonded_bins *b) {
    const double shift = (b->low - a->low) / a->width;
    const double drift = (double)b->count * (b->width / a->width - 1);
    return fabs(drift) < rounding && fabs(shift - round(shift)) < rounding ? round(shift) : NAN;
}

static enum status refuse_bins(const struct fit_file *fit, const struct fit_file *other, size_t g,
                               const char *file) {
    const struct bonded_unknown *unknown = &fit->problem.group[g];
    const struct bonded_bins *first = &unknown->bins, *second = &other->problem.group[g].bins;
    const double unit =
        mf_group_kind_is_length(unknown->order) ? mf_units_factor(&fit->scene.units, "lambda") : 1;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: states.%s: target.%s.%s has %zu bins of %.5g from %.5g, that of \"%s\" has %zu of "
        "%.5g from %.5g: they need not begin or end together, but must be as wide and have common "
        "edges; measure both with the same bins",
        file, other->name, mf_targets_name(mf_group_kind_target(unknown->order)), name_of(fit, g),
        second->count, unit * second->width, unit * second->low, fit->name, first->count,
        unit * first->width, unit * first->low);
}

/// The bins that the states have together, with the width of the first state's.
static enum status find_bins(struct fit_file *fit, size_t g, const char *file,
                             struct bonded_bins *all) {
    const struct bonded_bins *first = &fit->problem.group[g].bins;
    const bool circle = mf_group_kind_is_periodic(fit->problem.group[g].order);
    double begin = 0, end = (double)first->count;
    *all = *first;
    for (size_t s = 0; s < fit->others; s++) {
        const struct bonded_bins *own = &fit->other[s].problem.group[g].bins;
        const double shift = find_shift(first, own);
        if (isnan(shift) || (circle && (shift != 0 || own->count != first->count)))
            return refuse_bins(fit, &fit->other[s], g, file);
        all->low = shift < begin ? own->low : all->low;
        begin = fmin(begin, shift);
        end = fmax(end, shift + (double)own->count);
    }
    all->count = (size_t)(end - begin);
    return STATUS_OK;
}

enum status mf_fit_states_widen(struct fit_file *fit, const char *file) {
    struct bonded_bins all;
    for (size_t s = 0; s < fit->others; s++)
        TRY(check_groups(fit, &fit->other[s], file));
    for (size_t g = 0; g < fit->problem.bonded; g++) {
        TRY(find_bins(fit, g, file, &all));
        for (size_t s = 0; s < mf_fit_states_count(fit); s++) {
            struct fit_file *state = mf_fit_states_at(fit, s);
            const struct bonded_unknown *unknown = &state->problem.group[g];
            TRY(unknown->order == INVERSE_LOCAL_DENSITY
                    ? mf_fit_densities_widen(state, all.count)
                    : mf_target_files_widen(&state->files, unknown->order, (size_t)unknown->group,
                                            &all));
        }
    }
    return STATUS_OK;
}
