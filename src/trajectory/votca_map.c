// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/votca_map.h"

#include "base/growing.h"
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
