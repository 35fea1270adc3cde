// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/gromacs_topology.h"

#include "base/growing.h"
#include "base/memory.h"
#include "base/names.h"
#include "topologies/gromacs_terms.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum section { TERMS, TERM_TYPES, MOLECULETYPE, ATOMS, MOLECULES, IGNORED, PAIRS, EXCLUSIONS };

#define SECTIONS(NAME, kind, ...)                                                                  \
    {#kind "s", TERMS, BONDED_##NAME}, {#kind "types", TERM_TYPES, BONDED_##NAME},

/// The sections that are known. PAIRS are not read, and a line says so.
static const struct known {
    const char *name;
    enum section section;
    int order; ///< of terms and their types
} sections[] = {
    BONDED_LIST(SECTIONS){"moleculetype", MOLECULETYPE, 0},
    {"atoms", ATOMS, 0},
    {"molecules", MOLECULES, 0},
    {"exclusions", EXCLUSIONS, 0},
    {"defaults", IGNORED, 0},
    {"atomtypes", IGNORED, 0},
    {"system", IGNORED, 0},
    {"nonbond_params", PAIRS, 0},
    {"pairtypes", PAIRS, 0},
    {"pairs", PAIRS, 0},
};

/// What is read where laws do not matter; all other sections are then passed over.
static const struct known constraints = {"constraints", TERMS, BONDED_BOND},
                          other = {"", IGNORED, 0};

/// A moleculetype that [ molecules ] counts.
struct counted {
    char name[TOPOLOGY_NAME_SIZE];
};

struct reading {
    struct gromacs_reading terms;
    const struct known *section; ///< NULL: none has begun
    struct counted *counted;     ///< what a first reading finds; none: all kinds are read
    size_t count, capacity;
    bool is_left_out; ///< the moleculetype that is being read
};

static struct gromacs_words split(struct gromacs_line *line) {
    struct gromacs_words words = {.count = 0};
    char *rest = NULL;
    for (char *word = strtok_r(line->text, " \t", &rest); word && words.count < GROMACS_MAX_WORDS;
         word = strtok_r(NULL, " \t", &rest))
        words.word[words.count++] = word;
    return words;
}

// Kinds and atoms ---------------------------------------------------------------------------------

/// A name of a moleculetype, whose other letters than ours become _.
static bool copy_name(const char *word, char name[TOPOLOGY_NAME_SIZE]) {
    snprintf(name, TOPOLOGY_NAME_SIZE, "%s", word);
    for (char *letter = name; *letter; letter++)
        if (!isalnum((unsigned char)*letter) && *letter != '-')
            *letter = '_';
    return strlen(word) < TOPOLOGY_NAME_SIZE;
}

static int find_kind(const struct topology *topology, const char *name) {
    int k = 0;
    while (k < topology->kinds && strcmp(topology->kind[k].name, name) != 0)
        k++;
    return k;
}

/// Libraries define dozens of moleculetypes: those that nobody has are not looked at.
static bool is_counted(const struct reading *own, const char *word) {
    char name[TOPOLOGY_NAME_SIZE];
    copy_name(word, name);
    for (size_t k = 0; k < own->count; k++)
        if (strcmp(own->counted[k].name, name) == 0)
            return true;
    return own->count == 0;
}

static enum status begin_kind(struct gromacs_reading *reading, const struct gromacs_line *line,
                              const struct gromacs_words *words) {
    struct topology *topology = &reading->molecules->topology;
    struct topology_kind *kind = &topology->kind[topology->kinds];
    int64_t exclude = 0;
    char name[TOPOLOGY_NAME_SIZE];
    if (words->count < 2 || !copy_name(words->word[0], name))
        return mf_gromacs_fail(
            line, "expected the name of a moleculetype, of up to %d characters, and nrexcl",
            TOPOLOGY_NAME_SIZE - 1);
    if (mf_names_is_reserved(name))
        return mf_gromacs_fail(
            line, "\"%.40s\": a moleculetype needs a unique name, " NAMES_RESERVED, name);
    if (!mf_gromacs_is_integer(words->word[1], 0, TOPOLOGY_MAX_EXCLUDE, &exclude))
        return mf_gromacs_fail(line, "nrexcl is 0 to %d, not %.40s", TOPOLOGY_MAX_EXCLUDE,
                               words->word[1]);
    if (topology->kinds == TOPOLOGY_MAX_KINDS)
        return mf_gromacs_fail(line, "there are more than %d moleculetypes", TOPOLOGY_MAX_KINDS);
    if (find_kind(topology, name) < topology->kinds)
        return mf_gromacs_fail(line, "duplicate moleculetype %s", name);
    *kind = (struct topology_kind){.exclude = (int)exclude};
    memcpy(kind->name, name, sizeof name);
    topology->kinds++;
    reading->atom_capacity = 0;
    memset(reading->term_capacity, 0, sizeof reading->term_capacity);
    return STATUS_OK;
}

static enum status find_type(struct gromacs_reading *reading, const struct gromacs_line *line,
                             const char *name, int *type) {
    struct composition *composition = reading->composition;
    for (*type = 0; *type < composition->types; ++*type)
        if (strcmp(composition->name[*type], name) == 0)
            return STATUS_OK;
    if (!mf_composition_is_name(name))
        return mf_gromacs_fail(line, "\"%.40s\": expected a type name of " NAMES_OF_TYPE, name,
                               COMPOSITION_NAME_SIZE - 1);
    if (composition->types == COMPOSITION_MAX_TYPES)
        return mf_gromacs_fail(line, "\"%s\": more than %d types", name, COMPOSITION_MAX_TYPES);
    strcpy(composition->name[composition->types++], name);
    return STATUS_OK;
}

static void note(struct gromacs_reading *reading, const struct gromacs_line *line,
                 const char *what) {
    if (reading->note->text[0] == '\0')
        snprintf(reading->note->text, sizeof reading->note->text,
                 "%.120s:%zu: %s not used: pairs have \"conservative\"", line->file, line->number,
                 what);
}

static enum status add_atom(struct gromacs_reading *reading, const struct gromacs_line *line,
                            const struct gromacs_words *words) {
    struct topology_kind *kind = mf_gromacs_last_kind(reading);
    int64_t number;
    if (kind && kind->beads == GROMACS_MAX_ATOMS)
        return mf_gromacs_fail(line, "%s has more than %d atoms", kind->name, GROMACS_MAX_ATOMS);
    if (kind == NULL)
        return mf_gromacs_fail(line, "atoms without a moleculetype");
    if (words->count < 2 ||
        !mf_gromacs_is_integer(words->word[0], kind->beads + 1, kind->beads + 1, &number))
        return mf_gromacs_fail(line, "expected atom number %d and a type", kind->beads + 1);
    TRY(mf_gromacs_reserve((void **)&kind->type, (size_t)kind->beads, &reading->atom_capacity,
                           sizeof *kind->type));
    TRY(find_type(reading, line, words->word[1], &kind->type[kind->beads]));
    kind->beads++;
    if (words->count > 6 && strtod(words->word[6], NULL) != 0)
        note(reading, line, "charges are");
    return STATUS_OK;
}

// Counts ------------------------------------------------------------------------------------------

/// [ molecules ]: counts of one name add up.
static enum status add_count(struct gromacs_reading *reading, const struct gromacs_line *line,
                             const struct gromacs_words *words) {
    struct topology *topology = &reading->molecules->topology;
    int64_t count;
    char name[TOPOLOGY_NAME_SIZE];
    if (words->count != 2 || !mf_gromacs_is_integer(words->word[1], 0, 100000000, &count))
        return mf_gromacs_fail(line, "expected a moleculetype and a count up to 1e8");
    copy_name(words->word[0], name);
    const int k = find_kind(topology, name);
    if (count == 0)
        return STATUS_OK;
    if (k == topology->kinds)
        return mf_gromacs_fail(line, "there is no moleculetype %.40s", words->word[0]);
    if (topology->kind[k].beads == 0)
        return mf_gromacs_fail(line, "moleculetype %.40s has no atoms", words->word[0]);
    for (int later = k; later < topology->kinds; later++)
        reading->note->scattered |= topology->kind[later].count > 0;
    topology->kind[k].count += count;
    return STATUS_OK;
}

// Lines -------------------------------------------------------------------------------------------

static enum status begin_section(struct reading *reading, struct gromacs_line *line) {
    char name[GROMACS_WORD_SIZE] = "";
    if (sscanf(line->text, "[ %31[a-z_A-Z0-9] ]", name) != 1 || strchr(line->text, ']') == NULL)
        return mf_gromacs_fail(line, "expected \"[ name ]\"");
    const bool held = strcmp(name, constraints.name) == 0;
    reading->section = reading->terms.lawless ? held ? &constraints : &other : NULL;
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++)
        if (strcmp(sections[k].name, name) == 0)
            reading->section = &sections[k];
    if (reading->section == NULL)
        return mf_gromacs_fail(line, "[ %s ] is not known", name);
    reading->terms.order = reading->section->order;
    reading->terms.constraints = reading->section == &constraints;
    return STATUS_OK;
}

static enum status take(void *context, struct gromacs_line *line) {
    struct reading *own = context;
    struct gromacs_reading *reading = &own->terms;
    if (line->text[0] == '[')
        return begin_section(own, line);
    if (own->section == NULL)
        return mf_gromacs_fail(line, "expected a section, such as \"[ defaults ]\"");
    const struct gromacs_words words = split(line);
    const enum section section = own->section->section;
    if (section == MOLECULETYPE)
        own->is_left_out = words.count > 0 && !is_counted(own, words.word[0]);
    if (own->is_left_out &&
        (section == MOLECULETYPE || section == ATOMS || section == TERMS || section == EXCLUSIONS))
        return STATUS_OK;
    switch (section) {
    case TERMS:
        return mf_gromacs_add_term(reading, line, &words);
    case TERM_TYPES:
        return mf_gromacs_add_type(reading, line, &words);
    case MOLECULETYPE:
        return begin_kind(reading, line, &words);
    case ATOMS:
        return add_atom(reading, line, &words);
    case MOLECULES:
        return add_count(reading, line, &words);
    case EXCLUSIONS:
        if (reading->lawless)
            return STATUS_OK; // what is measured goes by nrexcl, as a fit of it will
        return mf_gromacs_fail(line, "[ exclusions ] are not read: nrexcl alone excludes pairs");
    case PAIRS:
        note(reading, line, "parameters of pairs are");
        return STATUS_OK;
    case IGNORED:
        break;
    }
    return STATUS_OK;
}

// The whole ---------------------------------------------------------------------------------------

/// Of a first reading: the names in [ molecules ] of what there is any of.
static enum status take_counted(void *context, struct gromacs_line *line) {
    struct reading *own = context;
    char name[GROMACS_WORD_SIZE] = "";
    int64_t count;
    if (line->text[0] == '[') {
        own->is_left_out =
            sscanf(line->text, "[ %31[a-z_A-Z0-9] ]", name) != 1 || strcmp(name, "molecules") != 0;
        return STATUS_OK;
    }
    if (own->is_left_out)
        return STATUS_OK;
    const struct gromacs_words words = split(line);
    if (words.count != 2 || !mf_gromacs_is_integer(words.word[1], 1, INT64_MAX, &count))
        return STATUS_OK; // which is told when it is read again
    TRY(mf_growing_reserve(&own->counted, &own->capacity, own->count, own->count + 1,
                           sizeof *own->counted, 16));
    copy_name(words.word[0], own->counted[own->count++].name);
    return STATUS_OK;
}

/// Count the beads of each type.
static enum status finish(struct gromacs_reading *reading, bool counted, const char *file) {
    const struct topology *const topology = &reading->molecules->topology;
    for (int k = 0; k < topology->kinds; k++)
        for (int bead = 0; bead < topology->kind[k].beads; bead++)
            reading->composition->count[topology->kind[k].type[bead]] += topology->kind[k].count;
    if (!counted && !reading->lawless)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: [ molecules ] is empty", file);
    return topology->kinds > 0
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "%s: there is no [ moleculetype ]", file);
}

enum status mf_gromacs_topology_read(struct molecules *molecules, struct composition *composition,
                                     const char *file, const struct units *units,
                                     struct gromacs_note *given) {
    enum status status = STATUS_OK;
    struct reading own = {.section = NULL};
    own.terms = (struct gromacs_reading){
        .molecules = molecules,
        .composition = composition,
        .lawless = units == NULL,
        .length = units && mf_units_known(units) ? units->length : 1,
        .energy = units && mf_units_known(units) ? mf_units_energy_kj_per_mol(units) : 1,
        .note = given};
    *given = (struct gromacs_note){.text = ""};
    NEW_ARRAY(own.terms.type, GROMACS_MAX_TYPES);
    own.is_left_out = true;
    CHECK(mf_gromacs_text_read(file, take_counted, &own));
    own.is_left_out = false;
    CHECK(mf_gromacs_text_read(file, take, &own));
    CHECK(finish(&own.terms, own.count > 0, file));
done:
    mf_memory_free(own.counted);
    mf_memory_free(own.terms.type);
    return status;
}
