// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "scene/scene_molecules.h"

#include <math.h>

static void write_beads(const struct topology_kind *kind, const struct composition *composition,
                        struct json_writer *writer) {
    const char **names = mf_memory_zeroed((size_t)kind->beads, sizeof *names);
    for (int k = 0; k < kind->beads && names; k++)
        names[k] = composition->name[kind->type[k]];
    mf_json_write_texts(writer, "beads", names, names ? (size_t)kind->beads : 0);
    mf_memory_free(names);
}

static void write_chain(const struct molecules *molecules, const struct topology_kind *kind,
                        const struct scene_molecule *given, const struct composition *composition,
                        struct json_writer *writer) {
    mf_json_begin(writer, "chain");
    if (given->of_one_type) {
        mf_json_write_text(writer, "type", composition->name[kind->type[0]]);
        mf_json_write_integer(writer, "length", kind->beads);
    } else {
        write_beads(kind, composition, writer);
    }
    for (int order = 0; order < BONDED_KINDS; order++)
        if (given->group[order] >= 0)
            mf_json_write_text(writer, mf_bonded_kinds[order]->name,
                               molecules->group[order][given->group[order]].name);
    mf_json_end(writer);
}

/// The terms of an order by their groups, in the order in which they are there.
static void write_terms(const struct molecules *molecules, const struct topology_kind *kind,
                        int order, struct json_writer *writer) {
    const size_t beads = (size_t)mf_bonded_kinds[order]->beads;
    int *rows = mf_memory_zeroed((size_t)kind->terms[order] * beads, sizeof *rows);
    if (kind->terms[order] > 0)
        mf_json_begin(writer, mf_bonded_kinds[order]->plural);
    for (int g = 0; g < molecules->groups[order] && kind->terms[order] > 0 && rows; g++) {
        size_t count = 0;
        for (int n = 0; n < kind->terms[order]; n++)
            if (kind->term[order][n].group == g) {
                for (size_t k = 0; k < beads; k++)
                    rows[count * beads + k] = kind->term[order][n].bead[k] + 1;
                count++;
            }
        if (count > 0)
            mf_json_write_rows(writer, molecules->group[order][g].name, rows, count, beads);
    }
    if (kind->terms[order] > 0)
        mf_json_end(writer);
    mf_memory_free(rows);
}

void mf_scene_kinds_write(const struct scene_molecules *molecules,
                          const struct composition *composition, double share,
                          struct json_writer *writer) {
    const struct molecules *own = &molecules->molecules;
    mf_json_begin(writer, "molecules");
    for (int k = 0; k < own->topology.kinds; k++) {
        const struct topology_kind *kind = &own->topology.kind[k];
        mf_json_begin(writer, kind->name);
        mf_json_write_integer(writer, "count", (int64_t)ceil(share * (double)kind->count));
        mf_json_write_integer(writer, "exclude", kind->exclude);
        if (molecules->given[k].is_chain)
            write_chain(own, kind, &molecules->given[k], composition, writer);
        else
            write_beads(kind, composition, writer);
        for (int order = 0; order < BONDED_KINDS && !molecules->given[k].is_chain; order++)
            write_terms(own, kind, order, writer);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_scene_molecules_write(const struct scene_molecules *molecules,
                              const struct composition *composition, struct json_writer *writer) {
    if (!scene_has_molecules(molecules))
        return;
    for (int order = 0; order < BONDED_KINDS; order++)
        mf_scene_groups_write(&molecules->molecules, order, writer);
    mf_scene_kinds_write(molecules, composition, 1, writer);
}
