// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "scene/scene_molecules.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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
