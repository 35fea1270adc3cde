// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/mapping_plan.h"

#include "base/memory.h"
#include "io/json.h"
#include "trajectory/votca_map.h"

#include <string.h>

static const char *const centres[] = {"mass", "geometry", NULL};
static const char *const rests[] = {"refuse", "ignore", NULL};

struct rest {
    int rest;
};

const struct field mf_mapping_plan_fields[] = {{"rest", FIELD_CHOICE, offsetof(struct rest, rest),
                                                .choices = rests, .unit = "",
                                                .help = "treatment of atoms in no bead"},
                                               FIELD_END};

#define OFFSET(member) offsetof(struct mapping_entry, member)
const struct field mf_mapping_plan_bead_fields[] = {
    {"type", FIELD_TEXT, OFFSET(type), .unit = "", .help = "type of the bead; default: its name"},
    {"residue", FIELD_TEXT, OFFSET(residue), .unit = "",
     .help = "name of the residue; default: any residue or molecule"},
    {"atoms", FIELD_TEXT, OFFSET(atoms), .unit = "",
     .help = "names of its atoms; default: all of the residue"},
    {"first", FIELD_INTEGER, OFFSET(first), .minimum = 1, .maximum = FIELD_LARGEST_INTEGER,
     .unit = "", .help = "instead of names: first atom, counted from 1"},
    {"last", FIELD_INTEGER, OFFSET(last), .minimum = 1, .maximum = FIELD_LARGEST_INTEGER,
     .unit = "", .help = "last atom"},
    {"size", FIELD_INTEGER, OFFSET(size), .minimum = 1, .maximum = FIELD_LARGEST_INTEGER,
     .unit = "", .help = "consecutive atoms in a bead; default: all"},
    {"centre", FIELD_CHOICE, OFFSET(centre), .choices = centres, .unit = "",
     .help = "centre of mass or of geometry"},
    FIELD_END};
#undef OFFSET

static void check_entry(struct json_object *object, const struct mapping_entry *entry) {
    const bool range = entry->first || entry->last || entry->size;
    if (range && (entry->residue[0] || entry->atoms[0]))
        mf_json_fault(object, NULL,
                      "takes names (\"residue\", \"atoms\") or a range (\"first\", "
                      "\"last\"), not both");
    else if (range && !(entry->first && entry->last >= entry->first))
        mf_json_fault(object, NULL, "a range goes from \"first\" to \"last\"");
    else if (entry->size && (entry->last - entry->first + 1) % entry->size != 0)
        mf_json_fault(object, "size", "%lld atoms are not a whole number of beads of %lld",
                      (long long)(entry->last - entry->first + 1), (long long)entry->size);
    if (entry->atoms[0] && mf_words_count(entry->atoms) == 0)
        mf_json_fault(object, "atoms", "names no atom");
    if (strlen(entry->type) >= STRUCTURE_NAME)
        mf_json_fault(object, "type", "is longer than %d characters", STRUCTURE_NAME - 1);
}

static enum status read_beads(struct mapping_plan *plan, struct json_object *root) {
    struct json_object beads = mf_json_child(root, "beads", true);
    size_t count = 0;
    while (beads.item && mf_json_key(&beads, count))
        count++;
    if (beads.item && (count == 0 || count > MAPPING_MAX_BEADS)) {
        mf_json_fault(&beads, NULL, "names %zu kinds of beads; there may be 1 to %d", count,
                      MAPPING_MAX_BEADS);
        return STATUS_OK;
    }
    plan->entry = mf_memory_zeroed(count + 1, sizeof *plan->entry);
    if (plan->entry == NULL)
        return STATUS_NO_MEMORY;
    for (; plan->entries < count; plan->entries++) {
        struct mapping_entry *const entry = &plan->entry[plan->entries];
        const char *const key = mf_json_key(&beads, plan->entries);
        struct json_object one = mf_json_child(&beads, key, true);
        mf_json_fields(&one, mf_mapping_plan_bead_fields, entry);
        snprintf(entry->key, sizeof entry->key, "%s", key);
        if (entry->type[0] == '\0')
            snprintf(entry->type, sizeof entry->type, "%s", key);
        if (entry->first && entry->size == 0)
            entry->size = entry->last - entry->first + 1;
        check_entry(&one, entry);
        mf_json_finish(&one);
    }
    return STATUS_OK;
}

/// {"OW": 15.9994}: keys are names of atoms.
static void read_masses(struct mapping_plan *plan, struct json_object *root) {
    struct json_object masses = mf_json_child(root, "masses", false);
    const char *name;
    for (size_t n = 0; masses.item && (name = mf_json_key(&masses, n)); n++) {
        struct mapping_mass *const mass = &plan->mass[plan->masses];
        const struct field fields[] = {{name, FIELD_NUMBER, offsetof(struct mapping_mass, mass),
                                        .required = true, .minimum = 0, .maximum = DBL_MAX,
                                        .unit = "u", .help = ""},
                                       FIELD_END};
        const struct word word = {name, strlen(name)};
        if (n >= MAPPING_MAX_MASSES) {
            mf_json_fault(&masses, NULL, "more than %d masses", MAPPING_MAX_MASSES);
            return;
        }
        mf_json_fields(&masses, fields, mass);
        if (mf_words_copy(&word, mass->name, STRUCTURE_NAME))
            plan->masses++;
        else
            mf_json_fault(&masses, name, "no atom has a name of more than %d characters",
                          STRUCTURE_NAME - 1);
    }
}

enum status mf_mapping_plan_read(struct mapping_plan *plan, const char *file) {
    struct json_document *document;
    struct rest rest = {0};
    if (mf_votca_map_is(file))
        return mf_votca_map_read(plan, file);
    *plan = (struct mapping_plan){0};
    snprintf(plan->file, sizeof plan->file, "%s", file);
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, mf_mapping_plan_fields, &rest);
    plan->ignores_rest = rest.rest == 1;
    enum status status = read_beads(plan, &root);
    read_masses(plan, &root);
    mf_json_finish(&root);
    status = mf_json_close(document, status);
    if (status != STATUS_OK)
        mf_mapping_plan_clear(plan);
    return status;
}

enum status mf_mapping_plan_default(struct mapping_plan *plan) {
    *plan = (struct mapping_plan){.file = "one bead per residue", .entries = 1};
    plan->entry = mf_memory_zeroed(1, sizeof *plan->entry);
    return plan->entry ? STATUS_OK : STATUS_NO_MEMORY;
}

void mf_mapping_plan_clear(struct mapping_plan *plan) {
    mf_memory_free(plan->entry);
    mf_memory_free(plan->molecule);
    mf_memory_free(plan->residue);
    mf_memory_free(plan->part);
    mf_memory_free(plan->member);
    *plan = (struct mapping_plan){0};
}
