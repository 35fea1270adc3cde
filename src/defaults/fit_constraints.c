// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_defaults.h"

#include "defaults/fit_choice.h"
#include "problem/bonded_grid.h"

#include <math.h>
#include <string.h>

/// The law of a group, by what its target says of it.
static struct fit_constraint law_of(int order, const char *name,
                                    const struct bonded_moments *moments, double temperature) {
    struct fit_constraint law = {.order = order, .moments = *moments};
    snprintf(law.name, sizeof law.name, "%s", name);
    law.deviation = fmax(moments->deviation, mf_bonded_distribution_narrow(order, moments->mean));
    law.k = temperature / pow(law.deviation * mf_bonded_kinds[order]->scale, 2);
    return law;
}

void mf_fit_constraints_find(struct fit_file *fit) {
    struct fit_constraints *constraints = &fit->constraints;
    const struct molecules *molecules = &fit->scene.molecules.molecules;
    constraints->count = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; mf_bonded_kinds[order]->narrow > 0 && g < molecules->groups[order]; g++) {
            const struct target_groups *groups = target_files_groups(&fit->files, order);
            const struct molecules_group *group = &molecules->group[order][g];
            if (!mf_scene_groups_are_fitted(group) || !target_groups_have(groups, (size_t)g))
                continue;
            const struct target_bonded *target = &groups->member[g];
            const struct bonded_moments moments =
                mf_bonded_distribution_moments(&target->bins, target->value);
            if (moments.seen < BONDED_GRID_FEWEST_BINS ||
                mf_bonded_distribution_is_constrained(order, &moments))
                constraints->of[constraints->count++] =
                    law_of(order, group->name, &moments, fit->scene.setup.temperature);
        }
}

/// A line, as the choices of a fit have.
static void print(const struct fit_choice *choice, const struct fit_constraint *own) {
    const bool bond = mf_bonded_kinds[own->order]->is_length;
    const double factor = bond ? mf_units_factor(mf_units_are_physical(&choice->fit->scene.units)
                                                     ? &choice->fit->scene.units
                                                     : NULL,
                                                 "lambda")
                               : 1;
    char k[FIT_CHOICE_TEXT_SIZE], part[32] = "";
    if (bond)
        snprintf(part, sizeof part, ", %g %% of the mean",
                 100 * mf_bonded_kinds[own->order]->narrow);
    mf_fit_choice_text(choice, bond ? "k_B T_0/lambda^2" : "k_B T_0", own->k, k);
    if (mf_bonded_distribution_is_constrained(own->order, &own->moments))
        mf_fit_choice_note(choice,
                           "%s \"%s\": a constraint (standard deviation %.2g, mean %.4g): "
                           "replaced by a harmonic potential with k = %s and standard "
                           "deviation %.2g%s: a narrower one would need a shorter time step",
                           mf_bonded_kinds[own->order]->name, own->name,
                           factor * own->moments.deviation, factor * own->moments.mean, k,
                           factor * own->deviation, part);
    else
        mf_fit_choice_note(choice,
                           "%s \"%s\": its target has only %zu bin%s with a p above %g of its "
                           "peak: a harmonic law of its width, k = %s; narrower bins would let "
                           "its potential be found",
                           mf_bonded_kinds[own->order]->name, own->name, own->moments.seen,
                           own->moments.seen == 1 ? "" : "s", mf_bonded_distribution_seen, k);
}

/// A harmonic potential in the place of one that is to be found.
static enum status give_law(const struct fit_choice *choice,
                            const struct fit_constraint *constraint,
                            struct molecules_group *group) {
    const struct bonded_kind *kind = mf_bonded_kinds[constraint->order];
    uint64_t given = 0;
    mf_bonded_clear(&group->curve);
    TRY(mf_bonded_create(&group->curve, kind->laws[0]));
    const struct fit_place place = {kind->plural, kind->laws[0]->fields, group->curve.parameters,
                                    &given};
    mf_fit_choice_give(choice, &place, "k", constraint->k);
    mf_fit_choice_give(choice, &place, kind->is_length ? "length" : "angle",
                       constraint->moments.mean);
    return STATUS_OK;
}

enum status mf_fit_constraints_apply(struct fit_file *fit) {
    const struct fit_choice choice = {.fit = fit};
    const struct molecules *molecules = &fit->scene.molecules.molecules;
    for (size_t n = 0; n < fit->constraints.count; n++) {
        const struct fit_constraint *constraint = &fit->constraints.of[n];
        const int order = constraint->order;
        for (int g = 0; g < molecules->groups[order]; g++) {
            struct molecules_group *group = &fit->scene.molecules.molecules.group[order][g];
            if (strcmp(group->name, constraint->name) != 0 || !mf_scene_groups_are_fitted(group))
                continue;
            TRY(give_law(&choice, constraint, group));
            if (target_groups_have(target_files_groups(&fit->files, order), (size_t)g))
                TRY(mf_target_files_drop(&fit->files, order, (size_t)g));
        }
        print(&choice, constraint);
    }
    return STATUS_OK;
}
