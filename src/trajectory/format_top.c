// SPDX-License-Identifier: GPL-3.0-or-later
//
// Topologies of GROMACS (reference manual, "Topology file") as a structure: names, residues, masses
// and molecules of atoms, in the order of [ molecules ]; #include and #ifdef as its preprocessor
// has them. A file without [ molecules ], as an .itp, is of one molecule of each [ moleculetype ].
#include "base/growing.h"
#include "base/memory.h"
#include "trajectory/gromacs_text.h"
#include "trajectory/trajectory.h"
#include "trajectory/words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum section { OTHERS, ATOM_TYPES, MOLECULE_TYPE, ATOMS, MOLECULES };
static const char *const names[] = {[ATOM_TYPES] = "atomtypes",
                                    [MOLECULE_TYPE] = "moleculetype",
                                    [ATOMS] = "atoms",
                                    [MOLECULES] = "molecules"};

enum { NAME = 64, MAX_WORDS = 16, MOST_ATOMS = 100000000 };

struct type {
    char name[NAME];
    double mass;
};

struct kind {
    char name[NAME];
    size_t first, atoms; ///< of the atoms of all kinds
};

struct lot {
    size_t kind;
    int64_t count;
};

struct reading {
    enum section section;
    struct type *type;
    struct kind *kind;
    struct structure_atom *atom; ///< those of all kinds
    struct lot *lot;             ///< [ molecules ]
    size_t types, kinds, atoms, lots, capacity[4];
};

static bool recognise(const unsigned char *begin, size_t size) {
    char line[GROMACS_LINE_SIZE], name[32];
    for (size_t k = 0; mf_words_line(begin, size, k, line, sizeof line); k++)
        if (sscanf(line, " [ %31[a-z] ]", name) == 1)
            return strcmp(name, "defaults") == 0 || strcmp(name, "moleculetype") == 0 ||
                   strcmp(name, "atomtypes") == 0;
    return false;
}

// Lines -------------------------------------------------------------------------------------------

static int split(const char *text, struct word word[MAX_WORDS]) {
    int count = 0;
    while (count < MAX_WORDS && mf_words_next(&text, &word[count]))
        count++;
    return count;
}

#define RESERVE(reading, array, count, number)                                                     \
    TRY(mf_growing_reserve(&(reading)->array, &(reading)->capacity[number], (reading)->count,      \
                           (reading)->count + 1, sizeof *(reading)->array, 64))

/// name [bonded type] [atomic number] mass charge kind …: the mass stands two before the kind, a
/// letter.
static enum status add_type(struct reading *reading, const struct gromacs_line *line,
                            const struct word *word, int words) {
    RESERVE(reading, type, types, 0);
    struct type *const type = &reading->type[reading->types];
    for (int k = 3; k < words; k++)
        if (word[k].length == 1 && strchr("ASVDasvd", word[k].begin[0]) &&
            mf_words_number(&word[k - 2], &type->mass) &&
            mf_words_copy(&word[0], type->name, NAME)) {
            reading->types++;
            return STATUS_OK;
        }
    return mf_gromacs_fail(line, "expected an atom type, its mass, charge and A, S, V or D");
}

static enum status add_kind(struct reading *reading, const struct gromacs_line *line,
                            const struct word *word) {
    RESERVE(reading, kind, kinds, 1);
    struct kind *const kind = &reading->kind[reading->kinds];
    *kind = (struct kind){.first = reading->atoms};
    if (!mf_words_copy(&word[0], kind->name, NAME))
        return mf_gromacs_fail(line, "a name of a moleculetype has at most %d letters", NAME - 1);
    reading->kinds++;
    return STATUS_OK;
}

/// The mass of a type, of which the last line counts; NAN if it has none.
static double mass_of(const struct reading *reading, const struct word *name) {
    for (size_t k = reading->types; k-- > 0;)
        if (mf_words_same(name, reading->type[k].name))
            return reading->type[k].mass;
    return NAN;
}

/// number type residue's number and name, name, charge group, charge, mass.
static enum status add_atom(struct reading *reading, const struct gromacs_line *line,
                            const struct word *word, int words) {
    RESERVE(reading, atom, atoms, 2);
    struct structure_atom *const atom = &reading->atom[reading->atoms];
    *atom = (struct structure_atom){.mass = NAN};
    if (reading->kinds == 0)
        return mf_gromacs_fail(line, "atoms without a moleculetype");
    const struct word number = {words > 2 ? word[2].begin : "",
                                words > 2 ? strspn(word[2].begin, "-0123456789") : 0};
    if (words < 5 || !mf_words_integer(&number, &atom->residue_number) ||
        !mf_words_copy(&word[3], atom->residue_name, STRUCTURE_NAME) ||
        !mf_words_copy(&word[4], atom->name, STRUCTURE_NAME))
        return mf_gromacs_fail(line,
                               "expected an atom: number, type, residue, its name, name, the "
                               "latter of at most %d letters",
                               STRUCTURE_NAME - 1);
    atom->mass = mass_of(reading, &word[1]);
    mf_words_copy(&word[1], atom->type_name, STRUCTURE_NAME); // one that is longer no bead can have
    if (words > 7 && !mf_words_number(&word[7], &atom->mass))
        return mf_gromacs_fail(line, "expected a mass, not %.*s", (int)word[7].length,
                               word[7].begin);
    reading->atoms++;
    reading->kind[reading->kinds - 1].atoms++;
    return STATUS_OK;
}

static enum status add_lot(struct reading *reading, const struct gromacs_line *line,
                           const struct word *word, int words) {
    RESERVE(reading, lot, lots, 3);
    struct lot *const lot = &reading->lot[reading->lots];
    lot->kind = 0;
    while (lot->kind < reading->kinds && !mf_words_same(&word[0], reading->kind[lot->kind].name))
        lot->kind++;
    if (lot->kind == reading->kinds)
        return mf_gromacs_fail(line, "there is no moleculetype %.*s", (int)word[0].length,
                               word[0].begin);
    if (words != 2 || !mf_words_integer(&word[1], &lot->count) || lot->count < 0 ||
        lot->count > MOST_ATOMS)
        return mf_gromacs_fail(line, "expected a moleculetype and a count up to 1e8");
    reading->lots++;
    return STATUS_OK;
}

static enum status begin_section(struct reading *reading, const struct gromacs_line *line) {
    char name[32] = "";
    if (sscanf(line->text, "[ %31[a-z_A-Z0-9] ]", name) != 1)
        return mf_gromacs_fail(line, "expected \"[ name ]\"");
    reading->section = OTHERS;
    for (int k = 1; k < (int)(sizeof names / sizeof *names); k++)
        if (strcasecmp(name, names[k]) == 0) // as GROMACS has it
            reading->section = (enum section)k;
    return STATUS_OK;
}

static enum status take(void *context, struct gromacs_line *line) {
    struct reading *const reading = context;
    struct word word[MAX_WORDS];
    if (line->text[0] == '[')
        return begin_section(reading, line);
    const int words = split(line->text, word);
    switch (words > 0 ? reading->section : OTHERS) {
    case ATOM_TYPES:
        return add_type(reading, line, word, words);
    case MOLECULE_TYPE:
        return add_kind(reading, line, word);
    case ATOMS:
        return add_atom(reading, line, word, words);
    case MOLECULES:
        return add_lot(reading, line, word, words);
    case OTHERS:
        break;
    }
    return STATUS_OK;
}

// Structure ---------------------------------------------------------------------------------------

/// The text is read again by its name, since what it includes stands beside it.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    (void)more;
    while (*more) {
        frame->raw.size = 0;
        TRY(mf_source_line(&trajectory->source, &frame->raw, more));
    }
    *more = true;
    return STATUS_OK;
}

/// Without [ molecules ] there is one of each kind.
static enum status complete(struct reading *reading, const char *file, size_t *atoms) {
    const bool alone = reading->lots == 0;
    *atoms = 0;
    for (size_t k = 0; alone && k < reading->kinds; k++) {
        RESERVE(reading, lot, lots, 3);
        reading->lot[reading->lots++] = (struct lot){k, 1};
    }
    for (size_t k = 0; k < reading->lots && *atoms <= MOST_ATOMS; k++)
        *atoms += (size_t)reading->lot[k].count * reading->kind[reading->lot[k].kind].atoms;
    if (*atoms == 0 || *atoms > MOST_ATOMS)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: its molecules have %zu atoms; 1 to %d are read", file, *atoms,
                              MOST_ATOMS);
    return STATUS_OK;
}

/// Each molecule has its atoms, which lie together.
static void place_atoms(const struct reading *reading, struct structure *structure) {
    struct structure_atom *to = structure->atom;
    int64_t molecule = 0;
    for (size_t k = 0; k < reading->lots; k++) {
        const struct kind *const kind = &reading->kind[reading->lot[k].kind];
        for (int64_t n = 0; kind->atoms > 0 && n < reading->lot[k].count; n++) {
            molecule++;
            for (size_t i = 0; i < kind->atoms; i++, to++) {
                *to = reading->atom[kind->first + i];
                to->molecule = molecule;
            }
        }
    }
    structure->has_names = structure->has_residues = structure->has_masses = true;
    structure->has_molecules = true;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    enum status status;
    struct reading reading = {.section = OTHERS};
    size_t atoms;
    (void)first;
    CHECK(mf_gromacs_text_read(trajectory->file, take, &reading));
    CHECK(complete(&reading, trajectory->file, &atoms));
    CHECK(mf_structure_init(&trajectory->structure, atoms));
    place_atoms(&reading, &trajectory->structure);
done:
    mf_memory_free(reading.type);
    mf_memory_free(reading.kind);
    mf_memory_free(reading.atom);
    mf_memory_free(reading.lot);
    return status;
}

static const char *const extensions[] = {"top", "itp", NULL};

const struct trajectory_format mf_format_top = {
    .name = "top",
    .extensions = extensions,
    .summary = "GROMACS's topologies, for -s alone: names, residues, masses, molecules",
    .unit_source = TRAJECTORY_OWN_UNITS,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
};
