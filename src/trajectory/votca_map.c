// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/votca_map.h"

#include "base/growing.h"
#include "io/json_write.h"
#include "io/xml.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool mf_votca_map_is(const char *files) {
    return mf_xml_is_name(files);
}

bool mf_votca_map_next(const char **files, char *file, size_t size) {
    while (**files == ';' || **files == ' ')
        ++*files;
    const size_t length = strcspn(*files, ";");
    snprintf(file, size, "%.*s", (int)length, *files);
    *files += length;
    return length > 0;
}

enum { MOLECULE, RESIDUE, PART, MEMBER };

/// Copy a text that names something.
static enum status take_name(const struct xml_document *document, const struct xml_element *parent,
                             const char *key, char name[STRUCTURE_NAME]) {
    const struct xml_element *const element = mf_xml_find(parent, key);
    if (element == NULL || element->text[0] == '\0')
        return mf_xml_fail(document, parent, "<%s> is missing or empty", key);
    if (strlen(element->text) >= STRUCTURE_NAME || strpbrk(element->text, " \t\n\r"))
        return mf_xml_fail(document, element, "\"%.60s\" is no word of at most %d letters",
                           element->text, STRUCTURE_NAME - 1);
    memcpy(name, element->text, strlen(element->text) + 1);
    return STATUS_OK;
}

/// The next word of a text that may have several lines.
static bool next_word(const char **text, struct word *word) {
    word->begin = *text += strspn(*text, " \t\n\r");
    word->length = strcspn(*text, " \t\n\r");
    *text += word->length;
    return word->length > 0;
}

/// "2:SOL:OW", the residues of a molecule being counted from 1.
static enum status read_atom(struct mapping_plan *plan, const struct xml_document *document,
                             const struct xml_element *element, const struct word *word) {
    struct mapping_molecule *const molecule = &plan->molecule[plan->molecules - 1];
    char text[4 * STRUCTURE_NAME];
    char *residue, *name, *end;
    if (!mf_words_copy(word, text, sizeof text) || !(residue = strchr(text, ':')) ||
        !(name = strchr(residue + 1, ':')) || name[1] == '\0' ||
        strlen(name + 1) >= STRUCTURE_NAME || name - residue > STRUCTURE_NAME)
        return mf_xml_fail(document, element,
                           "\"%.*s\" is no atom as 1:SOL:OW, number and name of its residue in the "
                           "molecule and its own",
                           (int)(word->length < 60 ? word->length : 60), word->begin);
    *residue++ = *name++ = '\0';
    const long number = strtol(text, &end, 10);
    if (end == text || *end != '\0' || number < 1 || number > MAPPING_MAX_RESIDUES)
        return mf_xml_fail(document, element,
                           "residue \"%s\" of \"%s\" is no number from 1 to %d: residues of a "
                           "molecule are counted from 1",
                           text, name, MAPPING_MAX_RESIDUES);
    TRY(mf_growing_reserve(&plan->residue, &plan->capacity[RESIDUE], plan->residues,
                           molecule->first_residue + (size_t)number, sizeof *plan->residue, 16));
    for (; plan->residues < molecule->first_residue + (size_t)number; plan->residues++)
        plan->residue[plan->residues][0] = '\0';
    molecule->residues = plan->residues - molecule->first_residue;
    char *const known = plan->residue[molecule->first_residue + (size_t)number - 1];
    if (known[0] && strcmp(known, residue) != 0)
        return mf_xml_fail(document, element, "residue %ld is called \"%s\" and \"%s\"", number,
                           known, residue);
    memcpy(known, residue, strlen(residue) + 1);
    TRY(mf_growing_reserve(&plan->member, &plan->capacity[MEMBER], plan->members, plan->members + 1,
                           sizeof *plan->member, 64));
    struct mapping_member *const member = &plan->member[plan->members++];
    *member = (struct mapping_member){.residue = (size_t)number - 1};
    memcpy(member->name, name, strlen(name) + 1);
    return STATUS_OK;
}

/// Weights of a <map> for the atoms of a bead, 1 in all.
static enum status read_weights(struct mapping_plan *plan, const struct xml_document *document,
                                const struct xml_element *map, const struct mapping_part *part) {
    const struct xml_element *const element = mf_xml_find(map, "weights");
    const char *text = mf_xml_text(map, "weights");
    struct word word;
    double sum = 0;
    size_t count = 0;
    if (element == NULL)
        return mf_xml_fail(document, map, "<weights> is missing");
    for (; next_word(&text, &word); count++) {
        double weight;
        if (!mf_words_number(&word, &weight) || weight < 0)
            return mf_xml_fail(document, element, "\"%.*s\" is no weight from 0 on",
                               (int)(word.length < 60 ? word.length : 60), word.begin);
        if (count < part->count)
            plan->member[part->first + count].weight = weight;
        sum += weight;
    }
    if (count != part->count)
        return mf_xml_fail(document, element, "%zu weights, but bead \"%s\" has %zu atoms", count,
                           part->name, part->count);
    if (!(sum > 0 && isfinite(sum)))
        return mf_xml_fail(document, element, "the sum of the weights is %g", sum);
    for (size_t k = 0; k < count; k++)
        plan->member[part->first + k].weight /= sum;
    return STATUS_OK;
}

static enum status find_weights(struct mapping_plan *plan, const struct xml_document *document,
                                const struct xml_element *bead, const struct mapping_part *part) {
    char name[STRUCTURE_NAME];
    TRY(take_name(document, bead, "mapping", name));
    const struct xml_element *map = mf_xml_find(document->root, "maps.map");
    while (map && strcmp(mf_xml_text(map, "name"), name) != 0)
        map = mf_xml_next(map);
    if (map == NULL)
        return mf_xml_fail(document, mf_xml_find(bead, "mapping"), "<maps> has no <map> \"%s\"",
                           name);
    return read_weights(plan, document, map, part);
}

/// VOTCA's ellipsoids have the same centres; nothing here has an orientation.
static enum status check_symmetry(const struct xml_document *document,
                                  const struct xml_element *bead) {
    const struct xml_element *const symmetry = mf_xml_find(bead, "symmetry");
    if (symmetry == NULL || strcmp(symmetry->text, "1") == 0 || strcmp(symmetry->text, "3") == 0)
        return STATUS_OK;
    return mf_xml_fail(document, symmetry, "\"%.60s\" is neither 1, a sphere, nor 3, an ellipsoid",
                       symmetry->text);
}

static enum status read_bead(struct mapping_plan *plan, const struct xml_document *document,
                             const struct xml_element *bead) {
    struct mapping_molecule *const molecule = &plan->molecule[plan->molecules - 1];
    const struct xml_element *const beads = mf_xml_find(bead, "beads");
    const char *text = mf_xml_text(bead, "beads");
    struct word word;
    TRY(mf_growing_reserve(&plan->part, &plan->capacity[PART], plan->parts, plan->parts + 1,
                           sizeof *plan->part, 16));
    struct mapping_part *const part = &plan->part[plan->parts];
    *part = (struct mapping_part){.first = plan->members};
    TRY(take_name(document, bead, "name", part->name));
    TRY(take_name(document, bead, "type", part->type));
    TRY(check_symmetry(document, bead));
    for (size_t k = molecule->first_part; k < plan->parts; k++)
        if (strcmp(plan->part[k].name, part->name) == 0)
            return mf_xml_fail(document, bead, "there are two beads \"%s\"", part->name);
    if (beads == NULL || beads->text[0] == '\0')
        return mf_xml_fail(document, bead, "<beads> is missing or names no atom");
    while (next_word(&text, &word))
        TRY(read_atom(plan, document, beads, &word));
    part->count = plan->members - part->first;
    plan->parts++;
    molecule->parts++;
    return find_weights(plan, document, bead, part);
}

static enum status open_map(struct xml_document *document, const char *file) {
    TRY(mf_xml_read(document, file));
    const struct xml_element *const root = document->root;
    if (strcmp(root->name, "cg_molecule") != 0)
        return mf_xml_fail(document, root, "no map of VOTCA, which begins with <cg_molecule>%s",
                           strcmp(root->name, "cg") == 0
                               ? ": these are settings, which mesofit import votca reads"
                               : "");
    if (mf_xml_find(root, "topology.cg_beads.cg_bead") == NULL)
        return mf_xml_fail(document, root, "there is no <topology><cg_beads><cg_bead>");
    return STATUS_OK;
}

static enum status read_file(struct mapping_plan *plan, const char *file) {
    CLEARED_BY(mf_xml_clear) struct xml_document document = {0};
    TRY(open_map(&document, file));
    TRY(mf_growing_reserve(&plan->molecule, &plan->capacity[MOLECULE], plan->molecules,
                           plan->molecules + 1, sizeof *plan->molecule, 4));
    struct mapping_molecule *const molecule = &plan->molecule[plan->molecules++];
    *molecule =
        (struct mapping_molecule){.first_residue = plan->residues, .first_part = plan->parts};
    TRY(take_name(&document, document.root, "name", molecule->name));
    const struct xml_element *bead = mf_xml_find(document.root, "topology.cg_beads.cg_bead");
    for (; bead; bead = mf_xml_next(bead))
        TRY(read_bead(plan, &document, bead));
    for (size_t k = 0; k + 1 < plan->molecules; k++)
        if (strcmp(plan->molecule[k].name, molecule->name) == 0)
            return mf_xml_fail(&document, mf_xml_find(document.root, "name"),
                               "another map has the molecule \"%s\"", molecule->name);
    return STATUS_OK;
}

enum status mf_votca_map_read(struct mapping_plan *plan, const char *files) {
    enum status status = STATUS_OK;
    char file[VOTCA_MAP_PATH_SIZE];
    *plan = (struct mapping_plan){.ignores_rest = true};
    snprintf(plan->file, sizeof plan->file, "%s", files);
    while (status == STATUS_OK && mf_votca_map_next(&files, file, sizeof file))
        status = read_file(plan, file);
    if (status != STATUS_OK)
        mf_mapping_plan_clear(plan);
    return status;
}

// Bonds, angles and dihedrals ---------------------------------------------------------------------

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
