// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_molecules.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Add to the warning, after what it says already; what has no room is cut.
static void warn(struct scene_molecules *molecules, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void warn(struct scene_molecules *molecules, const char *format, ...) {
    char *warning = molecules->warning;
    const size_t length = strlen(warning);
    const char *between = length > 0 && length + 3 < SCENE_MOLECULES_WARNING_SIZE ? "; " : "";
    va_list list;
    strcpy(warning + length, between);
    va_start(list, format);
    vsnprintf(warning + length + strlen(between),
              SCENE_MOLECULES_WARNING_SIZE - length - strlen(between), format, list);
    va_end(list);
}

static void warn_of_terms(struct scene_molecules *molecules, const struct topology_kind *kind) {
    int order, pair[2];
    char name[TOPOLOGY_TERM_SIZE];
    const struct topology_term *term = mf_topology_unbonded(kind, &order, pair);
    if (term == NULL)
        return;
    mf_topology_name_term(term, order, name);
    warn(molecules, "molecules.%s: %s %s has no bond %d-%d", kind->name,
         mf_bonded_kinds[order]->name, name, pair[0] + 1, pair[1] + 1);
}

static void warn_of_fene(struct scene_molecules *molecules, const struct topology_kind *kind) {
    for (int n = 0; n < kind->terms[BONDED_BOND] && kind->exclude > 0; n++) {
        const int group = kind->term[BONDED_BOND][n].group;
        if (molecules->molecules.group[BONDED_BOND][group].curve.law != &mf_bond_fene)
            continue;
        warn(molecules,
             "molecules.%s: \"fene\" only pulls, and \"exclude\": %d removes the repulsion of its "
             "beads; 0 keeps it",
             kind->name, kind->exclude);
        return;
    }
}

static enum status warn_of_pieces(struct scene_molecules *molecules,
                                  const struct topology_kind *kind) {
    int bead;
    TRY(mf_topology_find_disconnected(kind, &bead));
    if (bead > 0)
        warn(molecules, "molecules.%s: it is in pieces: no bonds join its beads 1 and %d",
             kind->name, bead + 1);
    return STATUS_OK;
}

enum status mf_scene_molecules_warn(struct scene_molecules *molecules,
                                    const struct topology_kind *kind) {
    warn_of_terms(molecules, kind);
    warn_of_fene(molecules, kind);
    return warn_of_pieces(molecules, kind);
}

void mf_scene_molecules_warn_of_box(struct scene_molecules *molecules, const struct box *box,
                                    double temperature) {
    static const double seldom = 1e-5;
    const struct molecules *own = &molecules->molecules;
    const double half = 0.5 * mf_box_shortest(box);
    for (int g = 0; g < own->groups[BONDED_BOND]; g++) {
        const struct molecules_group *group = &own->group[BONDED_BOND][g];
        if (mf_scene_groups_are_fitted(group))
            continue;
        const double share =
            mf_bonded_share_beyond(&group->curve, half, temperature, box->dimensions);
        if (share > seldom)
            warn(molecules,
                 "bonds.%s: %.2g %% of them would be longer than half of the box, and its nearest "
                 "images cut them off: take a larger box",
                 group->name, 100 * share);
    }
}
