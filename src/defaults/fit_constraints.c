// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_constraints.h"

#include "defaults/fit_choice.h"
#include "io/json_fill.h"
#include "problem/bonded_grid.h"

#include <math.h>

/// The law of a group, by what its target says of it.
static struct fit_constraint law_of(int order, const char *name,
                                    const struct bonded_moments *moments, double temperature) {
    struct fit_constraint law = {.order = order, .moments = *moments};
    snprintf(law.name, sizeof law.name, "%s", name);
    law.deviation = fmax(moments->deviation, mf_bonded_distribution_narrow(order, moments->mean));
    law.k = temperature / pow(law.deviation * mf_bonded_kinds[order]->scale, 2);
    return law;
}

void mf_fit_constraints_find(const struct fit_file *read, struct fit_constraints *constraints) {
    const struct molecules *molecules = &read->scene.molecules.molecules;
    constraints->count = 0;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; mf_bonded_kinds[order]->narrow > 0 && g < molecules->groups[order]; g++) {
            const struct target_groups *groups = target_files_groups(&read->files, order);
            const struct molecules_group *group = &molecules->group[order][g];
            if (!mf_scene_groups_are_fitted(group) || !target_groups_have(groups, (size_t)g))
                continue;
            const struct target_bonded *target = &groups->member[g];
            const struct bonded_moments moments =
                mf_bonded_distribution_moments(&target->bins, target->value);
            if (moments.seen < BONDED_GRID_FEWEST_BINS ||
                mf_bonded_distribution_is_constrained(order, &moments))
                constraints->of[constraints->count++] =
                    law_of(order, group->name, &moments, read->scene.setup.temperature);
        }
}

static enum status write_law(const struct fit_constraint *constraint,
                             const struct fit_choice *choice) {
    const struct bonded_kind *kind = mf_bonded_kinds[constraint->order];
    const struct bonded_law *law = kind->laws[0];
    char path[JSON_PATH_SIZE];
    snprintf(path, sizeof path, "scene.%s.%s", kind->plural, constraint->name);
    TRY(mf_fit_choice_give_text(choice->root, path, "law", law->name));
    TRY(mf_fit_choice_give(choice, path, law->fields, "k", constraint->k));
    return mf_fit_choice_give(choice, path, law->fields, kind->is_length ? "length" : "angle",
                              constraint->moments.mean);
}

enum status mf_fit_constraints_write(const struct fit_constraints *constraints,
                                     const struct fit_file *read, const struct json_object *root) {
    struct json_object own = *root;
    const struct fit_choice choice = {.read = read, .root = &own};
    for (size_t n = 0; n < constraints->count; n++) {
        const struct fit_constraint *constraint = &constraints->of[n];
        TRY(write_law(constraint, &choice));
        mf_json_drop(&own, "target", mf_bonded_distribution_of(constraint->order)->name,
                     constraint->name);
    }
    return STATUS_OK;
}

void mf_fit_constraints_print(const struct fit_constraints *constraints,
                              const struct fit_file *read, struct fit_choices *choices) {
    struct fit_choice choice = {.read = read, .choices = choices};
    for (size_t n = 0; n < constraints->count; n++) {
        const struct fit_constraint *own = &constraints->of[n];
        const bool bond = mf_bonded_kinds[own->order]->is_length;
        const double factor =
            bond ? mf_units_factor(mf_units_are_physical(&read->scene.units) ? &read->scene.units
                                                                             : NULL,
                                   "lambda")
                 : 1;
        char k[FIT_CHOICE_TEXT_SIZE];
        mf_fit_choice_text(&choice, bond ? "k_B T_0/lambda^2" : "k_B T_0", own->k, k);
        if (mf_bonded_distribution_is_constrained(own->order, &own->moments))
            mf_fit_choice_note(&choice,
                               "%s \"%s\": a constraint (standard deviation %.2g, mean %.4g): "
                               "replaced by a harmonic potential with k = %s and standard "
                               "deviation %.2g, as narrow as the time step allows",
                               mf_bonded_kinds[own->order]->name, own->name,
                               factor * own->moments.deviation, factor * own->moments.mean, k,
                               factor * own->deviation);
        else
            mf_fit_choice_note(&choice,
                               "%s \"%s\": its target has only %zu bin%s with a p above %g of its "
                               "peak: a harmonic law of its width, k = %s; narrower bins would let "
                               "its potential be found",
                               mf_bonded_kinds[own->order]->name, own->name, own->moments.seen,
                               own->moments.seen == 1 ? "" : "s", mf_bonded_distribution_seen, k);
    }
}
