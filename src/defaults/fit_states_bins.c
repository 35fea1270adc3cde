// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_states_bins.h"

#include "defaults/fit_states.h"
#include "io/units_scale.h"

#include <math.h>
#include <string.h>

/// Bins meet if their edges are closer than this part of a bin, over all of them.
static const double rounding = 0.02;

static const char *name_of(const struct fit_file *fit, size_t g) {
    const struct bonded_unknown *unknown = &fit->problem.group[g];
    return fit->scene.molecules.molecules.group[unknown->order][unknown->group].name;
}

static enum status check_groups(const struct fit_file *fit, const struct fit_file *other,
                                const char *file) {
    bool same = fit->problem.bonded == other->problem.bonded;
    for (size_t g = 0; same && g < fit->problem.bonded; g++)
        same = fit->problem.group[g].order == other->problem.group[g].order &&
               strcmp(name_of(fit, g), name_of(other, g)) == 0;
    if (same)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: states.%s: the bonds, angles and dihedrals that it has targets for, "
                          "and no laws, are not those of \"%s\"",
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
    const double unit = mf_bonded_kinds[unknown->order]->is_length
                            ? mf_units_factor(&fit->scene.units, "lambda")
                            : 1;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: states.%s: target.%s.%s has %zu bins of %.5g from %.5g, that of \"%s\" has %zu of "
        "%.5g from %.5g: they need not begin or end together, but must be as wide and have common "
        "edges; measure both with the same bins",
        file, other->name, mf_targets_name(mf_bonded_distribution_kind(unknown->order)),
        name_of(fit, g), second->count, unit * second->width, unit * second->low, fit->name,
        first->count, unit * first->width, unit * first->low);
}

/// The bins that the states have together, with the width of the first state's.
static enum status find_bins(struct fit_file *fit, size_t g, const char *file,
                             struct bonded_bins *all) {
    const struct bonded_bins *first = &fit->problem.group[g].bins;
    const bool circle = mf_bonded_kinds[fit->problem.group[g].order]->periodic;
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
            TRY(mf_target_files_widen(&state->files, unknown->order, (size_t)unknown->group, &all));
        }
    }
    return STATUS_OK;
}
