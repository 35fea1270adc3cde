// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_molecules.h"

#include "base/memory.h"
#include "base/nearest.h"
#include "base/names.h"
#include "io/json.h"
#include "observe/bonded_distribution.h"

#include <string.h>

enum { AS_FAR_AS_TERMS = -1 }; ///< of "exclude"

struct given {
    int64_t count, exclude;
};
struct chain_input {
    char type[FIELD_TEXT_SIZE];
    int64_t length;
    char group[BONDED_KINDS][FIELD_TEXT_SIZE];
};

#define MOLECULE(member) .offset = offsetof(struct given, member)
const struct field mf_scene_molecule_fields[] = {
    {"count", FIELD_INTEGER, MOLECULE(count), .required = true, .minimum = 1, .maximum = 1e8,
     .unit = "", .help = "number of molecules of this kind"},
    {"exclude", FIELD_INTEGER, MOLECULE(exclude), .initial = AS_FAR_AS_TERMS,
     .minimum = AS_FAR_AS_TERMS, .maximum = TOPOLOGY_MAX_EXCLUDE, .unit = "",
     .help = "largest number of bonds between beads without pair interactions; -1: 1, 2 with "
             "angles, 3 with dihedrals, as in VOTCA"},
    FIELD_END,
};

enum { MOLECULE_FIELDS = sizeof mf_scene_molecule_fields / sizeof *mf_scene_molecule_fields };

#define CHAIN_GROUP(NAME, kind, ...)                                                               \
    {#kind, FIELD_TEXT, CHAIN(group[BONDED_##NAME]), .unit = "",                                   \
     .help = "group of all " #kind "s; none without"},
#define CHAIN(member) .offset = offsetof(struct chain_input, member)
const struct field mf_scene_chain_fields[] = {
    {"type", FIELD_TEXT, CHAIN(type), .unit = "",
     .help =
         "type of all beads; a chain of several types has \"beads\": [\"A\", \"B\", …] instead"},
    {"length", FIELD_INTEGER, CHAIN(length), .initial = 0, .minimum = 2, .maximum = 10000,
     .unit = "", .help = "number of beads, with \"type\""},
    {"bond", FIELD_TEXT, CHAIN(group[BONDED_BOND]), .required = true, .unit = "",
     .help = "group of all bonds"},
    BONDED_LIST_BEYOND_BONDS(CHAIN_GROUP) FIELD_END,
};

/// What is being read: a kind's view of the file and all that it may name.
struct reading {
    struct scene_molecules *molecules;
    struct composition *composition;
    struct json_object object;
    struct topology_kind kind;
    struct scene_molecule given;
    bool used[BONDED_KINDS][MOLECULES_MAX_GROUPS];
    bool open; ///< groups are those that kinds name, and counts may be missing
    const struct scene_fitted *fitted; ///< or NULL
};

// Names -------------------------------------------------------------------------------------------

/// The number of a group, or −1 and a fault.
static int find_group(struct reading *reading, struct json_object *object, const char *key,
                      int order, const char *name) {
    const struct molecules *molecules = &reading->molecules->molecules;
    const char *known[MOLECULES_MAX_GROUPS];
    char hint[1024];
    for (int g = 0; g < molecules->groups[order]; g++) {
        known[g] = molecules->group[order][g].name;
        if (strcmp(known[g], name) == 0) {
            reading->used[order][g] = true;
            return g;
        }
    }
    mf_nearest_hint(name, known, (size_t)molecules->groups[order], hint, sizeof hint);
    if (reading->fitted)
        mf_json_fault(
            object, key, "\"%.60s\" has no law in \"scene.%s\" and is not in \"%s.%s\"%s%s", name,
            mf_bonded_kinds[order]->plural, reading->fitted->given ? "unknowns" : "target",
            reading->fitted->given ? mf_bonded_kinds[order]->plural
                                   : mf_bonded_distribution_of(order)->name,
            molecules->groups[order] ? "; " : "", molecules->groups[order] ? hint : "");
    else
        mf_json_fault(object, key, "\"%.60s\" is not a group of \"%s\"%s%s", name,
                      mf_bonded_kinds[order]->plural, molecules->groups[order] ? "; " : "",
                      molecules->groups[order] ? hint : "");
    return -1;
}

/// The number of a type, which is added if it is new; −1 and a fault if it cannot be.
static int find_type(struct reading *reading, struct json_object *object, const char *key,
                     const char *name) {
    struct composition *composition = reading->composition;
    for (int type = 0; type < composition->types; type++)
        if (strcmp(composition->name[type], name) == 0)
            return type;
    if (!mf_composition_is_name(name))
        mf_json_fault(object, key, "\"%.60s\": expected a type name of " NAMES_OF_TYPE, name,
                      COMPOSITION_NAME_SIZE - 1);
    else if (composition->types == COMPOSITION_MAX_TYPES)
        mf_json_fault(object, key, "\"%s\": more than %d types", name, COMPOSITION_MAX_TYPES);
    else {
        strcpy(composition->name[composition->types], name);
        return composition->types++;
    }
    return -1;
}

static struct scene_molecule no_chain(void) {
    struct scene_molecule given = {.is_chain = false};
    for (int order = 0; order < BONDED_KINDS; order++)
        given.group[order] = -1;
    return given;
}

// Beads and terms ---------------------------------------------------------------------------------

/// "beads": the type of each.
static enum status read_beads(struct reading *reading, struct json_object *object) {
    OWNED const char **names = NULL;
    const int count = mf_json_count(object, "beads");
    TRY_ARRAY(names, count);
    TRY_ARRAY(reading->kind.type, count);
    if (count < 1)
        mf_json_fault(object, "beads", "missing: expected a list of the types of the beads");
    else if (mf_json_list_texts(object, "beads", names, (size_t)count))
        for (int k = 0; k < count; k++)
            reading->kind.type[k] = find_type(reading, object, "beads", names[k]);
    mf_json_has(object, "beads");
    reading->kind.beads = count;
    return STATUS_OK;
}

static enum status read_chain_of_one(struct reading *reading, struct json_object *object,
                                     const struct chain_input *chain) {
    if (mf_json_has(object, "length") && chain->length == 0)
        return STATUS_OK; // out of range, which is told
    if (chain->type[0] == '\0' || chain->length == 0) {
        mf_json_fault(object, chain->type[0] ? "length" : "type",
                      "missing: expected \"type\" and \"length\", or \"beads\"");
        return STATUS_OK;
    }
    const int type = find_type(reading, object, "type", chain->type);
    TRY_ARRAY(reading->kind.type, chain->length);
    for (int k = 0; k < chain->length; k++)
        reading->kind.type[k] = type;
    reading->kind.beads = (int)chain->length;
    return STATUS_OK;
}

/// The terms of a chain: all that follow each other.
static enum status link_chain(struct topology_kind *kind, int order, int group) {
    const struct bonded_kind *of = mf_bonded_kinds[order];
    const int span = of->chain[of->beads - 1];
    kind->terms[order] = span > 0 && kind->beads > span ? kind->beads - span : 0;
    TRY_ARRAY(kind->term[order], kind->terms[order]);
    for (int n = 0; n < kind->terms[order]; n++) {
        kind->term[order][n].group = group;
        for (int k = 0; k < of->beads; k++)
            kind->term[order][n].bead[k] = n + of->chain[k];
    }
    return STATUS_OK;
}

/// Whether a chain is too short for the terms of an order, or cannot have them, which is a fault.
static bool is_too_short(const struct reading *reading, struct json_object *chain, int order) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const int beads = reading->kind.beads, needed = kind->chain[kind->beads - 1] + 1;
    if (needed > 1 && beads >= needed)
        return false;
    if (needed == 1) {
        mf_json_fault(chain, kind->name, "a chain has no %s: write its \"beads\" and \"%s\"",
                      kind->plural, kind->plural);
        return true;
    }
    mf_json_fault(chain, kind->name, "%s %s is of %d beads, and the chain has %d", kind->article,
                  kind->name, needed, beads);
    return true;
}

static enum status read_chain(struct reading *reading) {
    const size_t faults = mf_json_fault_count(reading->object.document);
    struct json_object object = mf_json_child(&reading->object, "chain", true);
    struct chain_input chain;
    if (object.item == NULL)
        return STATUS_OK;
    mf_json_fields(&object, mf_scene_chain_fields, &chain);
    reading->given.is_chain = true;
    reading->given.of_one_type = !mf_json_has(&object, "beads");
    if (reading->given.of_one_type)
        TRY(read_chain_of_one(reading, &object, &chain));
    else
        TRY(read_beads(reading, &object));
    for (const char *const *key = (const char *const[]){"type", "length", NULL}; *key; key++)
        if (!reading->given.of_one_type && mf_json_has(&object, *key))
            mf_json_fault(&object, *key, "\"beads\" is given, too; leave one of them out");
    for (int order = 0; order < BONDED_KINDS; order++) {
        const char *name = chain.group[order];
        if (name[0] && mf_json_fault_count(object.document) == faults &&
            is_too_short(reading, &object, order))
            break;
        reading->given.group[order] =
            name[0] ? find_group(reading, &object, mf_bonded_kinds[order]->name, order, name) : -1;
        if (reading->given.group[order] >= 0)
            TRY(link_chain(&reading->kind, order, reading->given.group[order]));
    }
    mf_json_finish(&object);
    return STATUS_OK;
}

/// "bonds": {"backbone": [[1, 2], [2, 3]], …}, likewise "angles" and "dihedrals": in the order of
/// the groups, in which they are written.
static enum status read_terms(struct reading *reading, int order) {
    const struct molecules *molecules = &reading->molecules->molecules;
    struct topology_kind *kind = &reading->kind;
    struct json_object object =
        mf_json_child(&reading->object, mf_bonded_kinds[order]->plural, false);
    const size_t beads = (size_t)mf_bonded_kinds[order]->beads;
    OWNED int *rows = NULL;
    size_t all = 0;
    for (int g = 0; g < molecules->groups[order]; g++)
        all += (size_t)mf_json_count(&object, molecules->group[order][g].name);
    TRY_ARRAY(kind->term[order], all);
    TRY_ARRAY(rows, all * beads);
    for (int g = 0; g < molecules->groups[order]; g++) {
        const char *name = molecules->group[order][g].name;
        const size_t count = (size_t)mf_json_count(&object, name);
        if (!mf_json_has(&object, name) || !mf_json_list_rows(&object, name, rows, count, beads))
            continue;
        reading->used[order][g] = true;
        for (size_t k = 0; k < count; k++) {
            struct topology_term *term = &kind->term[order][kind->terms[order]++];
            term->group = g;
            for (size_t bead = 0; bead < beads; bead++)
                term->bead[bead] = rows[k * beads + bead] - 1;
        }
    }
    if (object.item)
        mf_json_finish(&object);
    return STATUS_OK;
}

// Kinds -------------------------------------------------------------------------------------------

/// Check a kind and hand it over to the topology, or clear it if there was a fault.
static enum status enter_kind(struct reading *reading, size_t faults) {
    struct topology *topology = &reading->molecules->molecules.topology;
    struct topology_kind *kind = &reading->kind;
    const struct json_document *document = reading->object.document;
    if (mf_json_fault_count(document) == faults && mf_topology_check(kind) != STATUS_OK)
        mf_json_fault(&reading->object, NULL, "%s", mf_status_marked());
    if (mf_json_fault_count(document) > faults) {
        mf_topology_kind_clear(kind);
        return STATUS_OK;
    }
    const enum status status = mf_scene_molecules_warn(reading->molecules, &reading->kind);
    for (int k = 0; k < kind->beads; k++)
        reading->composition->count[kind->type[k]] += kind->count;
    reading->molecules->given[topology->kinds] = reading->given;
    topology->kind[topology->kinds++] = *kind;
    return status;
}

static enum status read_kind(struct reading *reading, struct json_object *molecules,
                             const char *name) {
    struct json_object *object = &reading->object;
    const size_t faults = mf_json_fault_count(molecules->document);
    enum status status = STATUS_OK;
    struct given given;
    *object = mf_json_child(molecules, name, true);
    if (object->item == NULL)
        return STATUS_OK;
    reading->kind = (struct topology_kind){0};
    reading->given = no_chain();
    struct field fields[MOLECULE_FIELDS];
    memcpy(fields, mf_scene_molecule_fields, sizeof fields);
    fields[0].required = !reading->open;
    mf_json_fields(object, fields, &given);
    if (reading->open)
        TRY(mf_scene_groups_open(&reading->molecules->molecules, object));
    snprintf(reading->kind.name, sizeof reading->kind.name, "%s", name);
    reading->kind.count = given.count;
    if (mf_json_has(object, "chain")) {
        status = read_chain(reading);
    } else {
        status = read_beads(reading, object);
        for (int order = 0; order < BONDED_KINDS && status == STATUS_OK; order++)
            status = read_terms(reading, order);
    }
    reading->kind.exclude =
        given.exclude == AS_FAR_AS_TERMS ? mf_topology_reach(&reading->kind) : (int)given.exclude;
    mf_json_finish(object);
    const enum status entered = enter_kind(reading, faults);
    return status == STATUS_OK ? entered : status;
}

/// Groups that no molecule has.
static void check_use(const struct reading *reading, struct json_object *scene) {
    const struct molecules *molecules = &reading->molecules->molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        struct json_object groups = mf_json_child(scene, mf_bonded_kinds[order]->plural, false);
        for (int g = 0; g < molecules->groups[order]; g++)
            if (!reading->used[order][g])
                mf_json_fault(&groups, molecules->group[order][g].name,
                              "no molecule has such %s %s", mf_bonded_kinds[order]->article,
                              mf_bonded_kinds[order]->name);
    }
}

/// Groups of a scene that a file's terms have, beside those that the file brings along.
static void find_used(struct reading *reading) {
    const struct topology *topology = &reading->molecules->molecules.topology;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int k = 0; k < topology->kinds; k++)
            for (int n = 0; n < topology->kind[k].terms[order]; n++)
                reading->used[order][topology->kind[k].term[order][n].group] = true;
}

/// "molecules": {"file": "topol.top"}: kinds and groups of a topology.
static enum status read_file(struct reading *reading, struct json_object *object,
                             struct json_object *scene, const struct units *units) {
    const size_t faults = mf_json_fault_count(object->document);
    struct scene_molecules *own = reading->molecules;
    struct topology *topology = &own->molecules.topology;
    TRY(mf_scene_topology_read(own, object, scene, reading->fitted, reading->composition, units));
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    for (int k = 0; k < topology->kinds; k++) {
        own->given[k] = no_chain();
        reading->kind = topology->kind[k]; // borrowed
        TRY(mf_scene_molecules_warn(reading->molecules, &reading->kind));
    }
    find_used(reading);
    return STATUS_OK;
}

static enum status read_kinds(struct reading *reading, struct json_object *scene, bool required,
                              const struct units *units) {
    const char *name;
    struct json_object object = mf_json_child(scene, "molecules", required);
    if (scene_molecules_are_of_file(&object))
        return read_file(reading, &object, scene, units);
    for (size_t n = 0; (name = mf_json_key(&object, n)); n++) {
        if (n >= TOPOLOGY_MAX_KINDS || !mf_topology_is_name(name)) {
            mf_json_fault(&object, name, "expected at most %d kinds with names of " NAMES_OF_OTHERS,
                          TOPOLOGY_MAX_KINDS, TOPOLOGY_NAME_SIZE - 1);
            mf_json_has(&object, name);
        } else {
            TRY(read_kind(reading, &object, name));
        }
    }
    if (object.item)
        mf_json_finish(&object);
    return STATUS_OK;
}

enum status mf_scene_kinds_read(struct scene_molecules *molecules, struct json_object *scene,
                                struct composition *composition) {
    struct reading reading = {.molecules = molecules, .composition = composition, .open = true};
    return read_kinds(&reading, scene, true, NULL);
}

enum status mf_scene_molecules_read(struct scene_molecules *molecules, struct json_object *scene,
                                    const struct scene_fitted *fitted,
                                    struct composition *composition, const struct units *units) {
    static const double max = 1e8;
    struct reading reading = {.molecules = molecules, .composition = composition, .fitted = fitted};
    const size_t faults = mf_json_fault_count(scene->document);
    for (int order = 0; order < BONDED_KINDS; order++)
        TRY(mf_scene_groups_read(&molecules->molecules, order, scene, fitted, units));
    if (fitted)
        TRY(mf_scene_groups_check_fitted(fitted, scene));
    if (mf_json_fault_count(scene->document) > faults)
        return STATUS_OK; // that kinds lack such a group would mislead
    TRY(read_kinds(&reading, scene, false, units));
    if (mf_json_fault_count(scene->document) == faults)
        check_use(&reading, scene);
    if (mf_json_fault_count(scene->document) == faults &&
        (double)mf_composition_particles(composition) > max)
        mf_json_fault(scene, "molecules", "they have %g beads; the most are %g",
                      (double)mf_composition_particles(composition), max);
    if (mf_json_fault_count(scene->document) > faults || !scene_has_molecules(molecules))
        return STATUS_OK;
    return mf_topology_complete(&molecules->molecules.topology, composition);
}

void mf_scene_molecules_clear(struct scene_molecules *molecules) {
    mf_molecules_clear(&molecules->molecules);
    mf_memory_free(molecules->order);
    *molecules = (struct scene_molecules){0};
}
