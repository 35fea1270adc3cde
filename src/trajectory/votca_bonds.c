// SPDX-License-Identifier: GPL-3.0-or-later
//
// <cg_bonded> of VOTCA's maps as JSON.
#include "trajectory/votca_map.h"

#include "base/growing.h"
#include "io/json_write.h"
#include "io/xml.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// What VOTCA and a file of molecules call terms of 2, 3 and 4 beads.
static const struct {
    const char *name, *key;
    size_t beads;
} orders[] = {{"bond", "bonds", 2}, {"angle", "angles", 3}, {"dihedral", "dihedrals", 4}};

/// Number of a bead in its molecule, from 1; 0 if there is none of that name.
static int find_bead(const struct xml_document *document, const char *name, size_t length) {
    int number = 1;
    const struct xml_element *bead = mf_xml_find(document->root, "topology.cg_beads.cg_bead");
    for (; bead; bead = mf_xml_next(bead), number++) {
        const char *const known = mf_xml_text(bead, "name");
        if (strncmp(known, name, length) == 0 && known[length] == '\0')
            return number;
    }
    return 0;
}

/// A group of the same name is a member of the same JSON object.
static enum status check_name(const struct xml_document *document,
                              const struct xml_element *group) {
    const char *const name = mf_xml_text(group, "name");
    const struct xml_element *other = mf_xml_find(group->parent, group->name);
    if (name[0] == '\0')
        return mf_xml_fail(document, group, "<name> is missing or empty");
    for (; other != group; other = mf_xml_next(other))
        if (strcmp(mf_xml_text(other, "name"), name) == 0)
            return mf_xml_fail(document, group,
                               "that of line %zu has the name \"%.60s\" too: give it another, or "
                               "all beads in one <beads>",
                               other->line, name);
    return STATUS_OK;
}

static enum status write_group(struct json_writer *writer, const struct xml_document *document,
                               const struct xml_element *group, size_t width) {
    const char *at = mf_xml_text(group, "beads"), *const name = mf_xml_text(group, "name");
    OWNED int *number = NULL;
    size_t count = 0, capacity = 0;
    TRY(check_name(document, group));
    for (size_t length; at += strspn(at, " \t\n\r"), (length = strcspn(at, " \t\n\r")) > 0;
         at += length) {
        const int bead = find_bead(document, at, length);
        if (bead == 0)
            return mf_xml_fail(document, group, "<cg_beads> has no bead \"%.*s\"",
                               (int)(length < 60 ? length : 60), at);
        TRY(mf_growing_reserve(&number, &capacity, count, count + 1, sizeof *number, 16));
        number[count++] = bead;
    }
    if (count == 0 || count % width != 0)
        return mf_xml_fail(document, group, "<beads> names %zu beads, which are no groups of %zu",
                           count, width);
    mf_json_write_rows(writer, name, number, count / width, width);
    return STATUS_OK;
}

static enum status write_groups(struct json_writer *writer, const struct xml_document *document,
                                const struct xml_element *bonded, size_t order) {
    const struct xml_element *group = mf_xml_find(bonded, orders[order].name);
    if (group == NULL)
        return STATUS_OK;
    mf_json_begin(writer, orders[order].key);
    for (; group; group = mf_xml_next(group))
        TRY(write_group(writer, document, group, orders[order].beads));
    mf_json_end(writer);
    return STATUS_OK;
}

static void write_beads(struct json_writer *writer, const struct mapping_plan *plan,
                        const struct mapping_molecule *molecule, const char **types) {
    for (size_t k = 0; k < molecule->parts; k++)
        types[k] = plan->part[molecule->first_part + k].type;
    mf_json_write_texts(writer, "beads", types, molecule->parts);
}

/// A kind of molecules. @param[in,out] bonded  whether any has had terms
static enum status write_kind(struct json_writer *writer, const struct mapping_plan *plan,
                              size_t number, const char *file, bool *bonded) {
    CLEARED_BY(mf_xml_clear) struct xml_document document = {0};
    const struct mapping_molecule *const molecule = &plan->molecule[number];
    OWNED const char **types = NULL;
    TRY(mf_xml_read(&document, file));
    const struct xml_element *const terms = mf_xml_find(document.root, "topology.cg_bonded");
    if (molecule->parts == 1)
        return STATUS_OK;
    TRY_ARRAY(types, molecule->parts);
    mf_json_begin(writer, molecule->name);
    write_beads(writer, plan, molecule, types);
    for (size_t order = 0; order < sizeof orders / sizeof *orders; order++)
        TRY(write_groups(writer, &document, terms, order));
    mf_json_end(writer);
    *bonded = *bonded || (terms && terms->child);
    return STATUS_OK;
}

static void write_single_beads(struct json_writer *writer, const struct mapping_plan *plan) {
    mf_json_begin(writer, "particles");
    mf_json_begin(writer, "types");
    for (size_t k = 0; k < plan->molecules; k++) {
        bool known = plan->molecule[k].parts > 1;
        for (size_t j = 0; j < k && !known; j++)
            known = plan->molecule[j].parts == 1 &&
                    strcmp(plan->part[plan->molecule[j].first_part].type,
                           plan->part[plan->molecule[k].first_part].type) == 0;
        if (!known)
            mf_json_write_integer(writer, plan->part[plan->molecule[k].first_part].type, 0);
    }
    mf_json_end(writer);
    mf_json_end(writer);
}

static enum status write_text(const struct json_writer *writer, const char *files, char **json) {
    char *text = NULL;
    size_t size = 0;
    FILE *const stream = open_memstream(&text, &size);
    enum status status = stream ? mf_json_write_stream(writer, stream, files)
                                : mf_status_fail(STATUS_NO_MEMORY, "%s: no memory", files);
    if (stream && fclose(stream) != 0 && status == STATUS_OK)
        status = mf_status_fail(STATUS_NO_MEMORY, "%s: no memory", files);
    if (status == STATUS_OK)
        NEW_ARRAY(*json, size + 1);
    if (status == STATUS_OK)
        memcpy(*json, text, size);
done:
    free(text);
    return status;
}

static enum status write_kinds(struct json_writer *writer, const struct mapping_plan *plan,
                               const char *files, bool *bonded) {
    const char *at = files;
    char file[VOTCA_MAP_PATH_SIZE];
    if (writer == NULL)
        return STATUS_NO_MEMORY;
    mf_json_begin(writer, "molecules");
    for (size_t k = 0; mf_votca_map_next(&at, file, sizeof file); k++)
        TRY(write_kind(writer, plan, k, file, bonded));
    mf_json_end(writer);
    write_single_beads(writer, plan);
    return STATUS_OK;
}

enum status mf_votca_map_bonds(char **json, const char *files) {
    CLEARED_BY(mf_mapping_plan_clear) struct mapping_plan plan = {0};
    bool bonded = false;
    *json = NULL;
    TRY(mf_votca_map_read(&plan, files));
    struct json_writer *const writer = mf_json_writer_create();
    enum status status = write_kinds(writer, &plan, files, &bonded);
    if (status == STATUS_OK && bonded)
        status = write_text(writer, files, json);
    mf_json_writer_free(writer);
    return status;
}
