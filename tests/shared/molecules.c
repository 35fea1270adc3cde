// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/molecules.h"

#include "base/memory.h"
#include "shared/testing.h"

#include <string.h>

struct topology_kind molecules_chain(int64_t count, const int *types, int beads, int highest,
                                     int exclude) {
    struct topology_kind kind = {
        .name = "chain", .count = count, .exclude = exclude, .beads = beads};
    kind.type = mf_memory_zeroed((size_t)beads, sizeof *kind.type);
    memcpy(kind.type, types, (size_t)beads * sizeof *types);
    for (int order = 0; order <= highest && order < beads - 1; order++) {
        kind.terms[order] = beads - 1 - order;
        kind.term[order] = mf_memory_zeroed((size_t)kind.terms[order], sizeof *kind.term[order]);
        for (int n = 0; n < kind.terms[order]; n++)
            for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
                kind.term[order][n].bead[k] = n + k;
    }
    return kind;
}

struct composition molecules_topology(struct topology *topology, struct topology_kind first,
                                      struct topology_kind second, int types,
                                      const int64_t *single) {
    struct composition composition = {.types = types};
    struct topology_kind kinds[] = {first, second};
    *topology = (struct topology){0};
    for (int type = 0; type < types; type++) {
        composition.count[type] = single ? single[type] : 0;
        composition.name[type][0] = (char)('A' + type);
    }
    for (int k = 0; k < 2 && kinds[k].count > 0; k++) {
        topology->kind[topology->kinds++] = kinds[k];
        for (int bead = 0; bead < kinds[k].beads; bead++)
            composition.count[kinds[k].type[bead]] += kinds[k].count;
    }
    if (second.count == 0)
        mf_topology_kind_clear(&kinds[1]);
    assert_ok(mf_topology_complete(topology, &composition));
    return composition;
}

void molecules_add_group(struct molecules *molecules, int order, const struct bonded_law *law,
                         const struct molecules_number *numbers) {
    struct molecules_group *group = &molecules->group[order][molecules->groups[order]++];
    snprintf(group->name, sizeof group->name, "%s", law->name);
    assert_ok(mf_bonded_create(&group->curve, law));
    for (; numbers && numbers->name; numbers++) {
        const struct field *field = law->fields;
        while (field->name && strcmp(field->name, numbers->name) != 0)
            field++;
        assert_non_null(field->name);
        const int64_t integer = (int64_t)numbers->value;
        memcpy((char *)group->curve.parameters + field->offset,
               field->type == FIELD_INTEGER ? (const void *)&integer
                                            : (const void *)&numbers->value,
               8);
    }
}

void molecules_enter(struct simulation_setup *setup, const struct molecules *molecules,
                     const struct composition *composition) {
    setup->composition = *composition;
    setup->placement.count = mf_composition_particles(composition);
    setup->interaction[setup->interactions++] =
        (struct interaction_choice){&mf_molecules, molecules};
}
