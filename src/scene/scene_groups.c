// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/digest.h"
#include "base/memory.h"
#include "base/names.h"
#include "base/nearest.h"
#include "curves/bonded_table.h"
#include "scene/scene_molecules.h"
#include "observe/bonded_distribution.h"

#include <string.h>

/// Points of the law "table".
static enum status load_points(struct bonded_curve *curve, int order, struct json_object *object,
                               const struct units *units) {
    const char *const unit[2] = {mf_bonded_kinds[order]->unit, "k_B T_0"};
    const struct bonded_table *table = curve->parameters;
    double *q = NULL, *energy = NULL;
    size_t count = 0;
    enum status status =
        mf_scene_read_columns(table->file, unit, bonded_min(order), units, &q, &energy, &count);
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_marked());
    else if ((status = mf_bonded_table_set_points(curve, q, energy, count)) != STATUS_OK ||
             (status = mf_bonded_table_check_wells(curve, q, energy, count)) != STATUS_OK)
        mf_json_fault(object, "file", "%s: %s", table->file, mf_status_marked());
    mf_memory_free(q);
    mf_memory_free(energy);
    return status == STATUS_NO_MEMORY ? status : STATUS_OK;
}

static enum status read_group(struct molecules *molecules, int order, struct json_object *groups,
                              const char *name, const struct units *units) {
    const char **names;
    struct molecules_group *group = &molecules->group[order][molecules->groups[order]];
    struct json_object object = mf_json_child_of(groups, name, true, "law");
    if (object.item == NULL)
        return STATUS_OK;
    TRY(mf_names_collect(mf_bonded_kinds[order]->laws, NULL, &names));
    const char *chosen = mf_json_choice(&object, "law", names, NULL);
    mf_memory_free(names);
    if (chosen == NULL)
        return STATUS_OK;
    const struct bonded_law *law = mf_names_find(mf_bonded_kinds[order]->laws, chosen);
    const size_t faults = mf_json_fault_count(object.document);
    TRY(mf_molecules_add_group(molecules, order, name, law));
    mf_json_fields(&object, law->fields, group->curve.parameters);
    mf_json_fields_need_scale(&object, law->fields);
    if (bonded_is_table(law) && mf_json_fault_count(object.document) == faults)
        TRY(load_points(&group->curve, order, &object, units));
    mf_json_finish(&object);
    return STATUS_OK;
}

bool mf_scene_groups_are_fitted(const struct molecules_group *group) {
    return bonded_is_table(group->curve.law) &&
           ((const struct bonded_table *)group->curve.parameters)->point == NULL;
}

/// A table without points.
static enum status add_fitted(struct molecules *molecules, int order, const char *name,
                              struct json_object *scene) {
    if (molecules->groups[order] >= MOLECULES_MAX_GROUPS) {
        mf_json_fault(scene, mf_bonded_kinds[order]->plural, "there are more than %d groups",
                      MOLECULES_MAX_GROUPS);
        return STATUS_OK;
    }
    return mf_molecules_add_group(molecules, order, name, mf_bonded_kinds[order]->table);
}

/// Those that the scene says.
static enum status read_known(struct molecules *molecules, int order, struct json_object *scene,
                              const struct units *units) {
    const char *name;
    struct json_object groups = mf_json_child(scene, mf_bonded_kinds[order]->plural, false);
    if (groups.item == NULL)
        return STATUS_OK;
    for (size_t n = 0; (name = mf_json_key(&groups, n)); n++) {
        if (n >= MOLECULES_MAX_GROUPS) {
            mf_json_fault(&groups, name, "there are more than %d groups", MOLECULES_MAX_GROUPS);
            mf_json_has(&groups, name);
        } else if (!mf_topology_is_name(name)) {
            mf_json_fault(&groups, name, "expected a group name of " NAMES_OF_OTHERS,
                          TOPOLOGY_NAME_SIZE - 1);
            mf_json_has(&groups, name);
        } else {
            TRY(read_group(molecules, order, &groups, name, units));
        }
    }
    mf_json_finish(&groups);
    return STATUS_OK;
}

enum status mf_scene_groups_read(struct molecules *molecules, int order, struct json_object *scene,
                                 const struct scene_fitted *fitted, const struct units *units) {
    TRY(read_known(molecules, order, scene, units));
    for (int n = 0; fitted && n < fitted->count[order]; n++)
        TRY(add_fitted(molecules, order, fitted->name[order][n], scene));
    return STATUS_OK;
}

/// Add a group without a law of its own: the first one, of strength 0.
static enum status open_group(struct molecules *molecules, struct json_object *object, int order,
                              const char *name) {
    if (mf_molecules_group(molecules, order, name))
        return STATUS_OK;
    if (molecules->groups[order] == MOLECULES_MAX_GROUPS || !mf_topology_is_name(name)) {
        mf_json_fault(object, name, "expected at most %d groups with names of " NAMES_OF_OTHERS,
                      MOLECULES_MAX_GROUPS, TOPOLOGY_NAME_SIZE - 1);
        return STATUS_OK;
    }
    return mf_molecules_add_group(molecules, order, name, mf_bonded_kinds[order]->laws[0]);
}

enum status mf_scene_groups_open(struct molecules *molecules, struct json_object *kind) {
    struct json_object chain = mf_json_child(kind, "chain", false);
    for (int order = 0; order < BONDED_KINDS; order++) {
        struct json_object terms = mf_json_child(kind, mf_bonded_kinds[order]->plural, false);
        const char *name =
            chain.item ? mf_json_choice(&chain, mf_bonded_kinds[order]->name, NULL, "") : "";
        if (name && name[0])
            TRY(open_group(molecules, &chain, order, name));
        for (size_t n = 0; terms.item && (name = mf_json_key(&terms, n)); n++)
            TRY(open_group(molecules, &terms, order, name));
    }
    return STATUS_OK;
}

/// A fault of a name that no molecule's terms have.
static void fault_unused(struct json_object *object, const char *name, int order,
                         const struct molecules *molecules) {
    const char *known[MOLECULES_MAX_GROUPS] = {0};
    const size_t count = (size_t)molecules->groups[order];
    char hint[1024];
    for (size_t g = 0; g < count; g++)
        known[g] = molecules->group[order][g].name;
    mf_nearest_hint(name, known, count, hint, sizeof hint);
    mf_json_fault(object, name, "no molecule has such %s %s%s%s", mf_bonded_kinds[order]->article,
                  mf_bonded_kinds[order]->name, count > 0 ? "; " : "", count > 0 ? hint : "");
}

/// One for each group that is fitted and not among those of the kinds.
static void fault_unnamed(const struct scene_fitted *fitted, int order, struct molecules *named) {
    struct json_object from = fitted->from[order];
    for (int n = 0; n < fitted->count[order]; n++)
        if (mf_molecules_group(named, order, fitted->name[order][n]) == NULL)
            fault_unused(&from, fitted->name[order][n], order, named);
}

enum status mf_scene_groups_check_fitted(const struct scene_fitted *fitted,
                                         struct json_object *scene) {
    CLEARED_BY(mf_molecules_clear) struct molecules named = {0};
    const char *name;
    struct json_object kinds = mf_json_child(scene, "molecules", false);
    if (kinds.item == NULL || scene_molecules_are_of_file(&kinds))
        return STATUS_OK;
    for (size_t n = 0; (name = mf_json_key(&kinds, n)); n++) {
        if (!mf_json_is_object(&kinds, name))
            continue;
        struct json_object kind = mf_json_child(&kinds, name, false);
        TRY(mf_scene_groups_open(&named, &kind));
    }
    for (int order = 0; order < BONDED_KINDS; order++)
        fault_unnamed(fitted, order, &named);
    return STATUS_OK;
}

enum status mf_scene_groups_clear_tables(struct molecules *molecules) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            struct molecules_group *group = &molecules->group[order][g];
            if (!mf_scene_groups_are_fitted(group))
                continue;
            mf_bonded_clear(&group->curve);
            TRY(mf_bonded_create(&group->curve, mf_bonded_kinds[order]->laws[0]));
        }
    return STATUS_OK;
}

/// Whether a group of a topology takes the law that is given; else a fault if it must not be given.
static bool takes(const struct molecules_group *group, const struct molecules_group *given,
                  const struct scene_fitted *fitted, int order, struct json_object *scene) {
    const bool looked_for = mf_scene_groups_are_fitted(given);
    if (mf_scene_groups_are_fitted(group) || (looked_for && fitted->given))
        return true;
    if (!looked_for) {
        struct json_object laws = mf_json_child(scene, mf_bonded_kinds[order]->plural, false);
        mf_json_fault(&laws, given->name,
                      "the topology of \"molecules\" has its law; leave it out");
    }
    return false;
}

void mf_scene_groups_join(struct molecules *molecules, struct molecules *given,
                          const struct scene_fitted *fitted, struct json_object *scene) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        struct json_object laws = mf_json_child(scene, mf_bonded_kinds[order]->plural, false);
        bool known[MOLECULES_MAX_GROUPS] = {false};
        for (int n = 0; n < given->groups[order]; n++) {
            struct molecules_group *own = &given->group[order][n];
            struct molecules_group *group = mf_molecules_group(molecules, order, own->name);
            if (group == NULL && !mf_scene_groups_are_fitted(own))
                fault_unused(&laws, own->name, order, molecules);
            if (group == NULL || !takes(group, own, fitted, order, scene))
                continue;
            const struct bonded_curve curve = group->curve;
            group->curve = own->curve;
            own->curve = curve;
            known[group - molecules->group[order]] = true;
        }
        if (fitted)
            fault_unnamed(fitted, order, molecules);
        for (int g = 0; g < molecules->groups[order]; g++)
            if (mf_scene_groups_are_fitted(&molecules->group[order][g]) && !known[g])
                mf_json_fault(scene, "molecules",
                              "the %s \"%s\" is a table in the topology, which is not read: give "
                              "it by that name in \"scene.%s\" or, for a fit, in \"target.%s\"",
                              mf_bonded_kinds[order]->name, molecules->group[order][g].name,
                              mf_bonded_kinds[order]->plural,
                              mf_bonded_distribution_of(order)->name);
    }
}

void mf_scene_groups_write(const struct molecules *molecules, int order,
                           struct json_writer *writer) {
    int known = 0;
    for (int g = 0; g < molecules->groups[order]; g++)
        known += !mf_scene_groups_are_fitted(&molecules->group[order][g]);
    if (known == 0)
        return;
    mf_json_begin(writer, mf_bonded_kinds[order]->plural);
    for (int g = 0; g < molecules->groups[order]; g++) {
        const struct molecules_group *group = &molecules->group[order][g];
        if (mf_scene_groups_are_fitted(group))
            continue;
        mf_json_begin(writer, group->name);
        mf_json_write_text(writer, "law", group->curve.law->name);
        mf_json_write_fields(writer, group->curve.law->fields, group->curve.parameters);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_scene_molecules_digest(const struct scene_molecules *molecules, uint64_t *digest) {
    const struct molecules *own = &molecules->molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < own->groups[order]; g++) {
            const struct bonded_curve *curve = &own->group[order][g].curve;
            const struct bonded_table *table = curve->parameters;
            if (bonded_is_table(curve->law) && table->point)
                mf_digest_add(digest, table->point,
                              (size_t)(table->intervals + 1) * sizeof *table->point);
        }
}
