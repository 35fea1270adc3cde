// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/components.h"

#include <stdio.h>
#include <string.h>

int64_t mf_components_single(const struct composition *beads, size_t count,
                             const struct topology *topology, int type) {
    int64_t single = composition_is_mixed(beads) ? beads->count[type] : (int64_t)count;
    for (int k = 0; topology && k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            single -= topology->kind[k].type[bead] == type ? topology->kind[k].count : 0;
    return single;
}

/// Returns false if there are too many.
static bool add(struct composition *components, const char *name, int64_t sites) {
    if (components->types == COMPOSITION_MAX_TYPES)
        return false;
    snprintf(components->name[components->types], COMPOSITION_NAME_SIZE, "%.*s",
             COMPOSITION_NAME_SIZE - 1, name);
    components->count[components->types++] = sites;
    return true;
}

static enum status fail_of_many(void) {
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "kinds of molecules and types of single beads are more than %d components",
        COMPOSITION_MAX_TYPES);
}

/// Two pairs of one name, as those of a kind and a type that are called alike.
static enum status check_names(const struct composition *components) {
    const int pairs = mf_composition_pairs(components);
    for (int pair = 0; pair < pairs; pair++) {
        int type[2];
        char name[2][COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_types(components, pair, type);
        for (int k = 0; k < 2; k++)
            snprintf(name[k], sizeof name[k], "%s-%s", components->name[type[k]],
                     components->name[type[1 - k]]);
        for (int other = pair + 1; other < pairs; other++) {
            char its[COMPOSITION_PAIR_NAME_SIZE];
            mf_composition_pair_name(components, other, its);
            if (strcmp(its, name[0]) == 0 || strcmp(its, name[1]) == 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "\"%s\" would name two pairs of components (kinds of "
                                      "molecules, types of single beads): rename a kind",
                                      its);
        }
    }
    return STATUS_OK;
}

enum status mf_components_find(struct composition *components, const struct composition *beads,
                               size_t count, const struct topology *topology) {
    const int types = composition_is_mixed(beads) ? beads->types : 1;
    const char *longest = "";
    *components = (struct composition){0};
    for (int k = 0; topology && k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        if (!add(components, kind->name, kind->count))
            return fail_of_many();
        longest = strlen(kind->name) > strlen(longest) ? kind->name : longest;
    }
    for (int type = 0; type < types; type++) {
        const int64_t single = mf_components_single(beads, count, topology, type);
        if (single > 0 && !add(components, beads->name[type], single))
            return fail_of_many();
    }
    if (!composition_is_mixed(components))
        return STATUS_OK;
    if (strlen(longest) >= COMPOSITION_NAME_SIZE)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "the kind of molecules \"%s\" is a component, whose name has up to %d "
            "characters",
            longest, COMPOSITION_NAME_SIZE - 1);
    return check_names(components);
}
