// SPDX-License-Identifier: GPL-3.0-or-later
//
// PSF of CHARMM, X-PLOR and NAMD, as a structure: names, residues and masses of atoms, molecules by
// bonds. What stands in a line is split by blanks, as all but the oldest versions of CHARMM let it;
// VMD leaves the name of a segment blank that has none.
#include "base/memory.h"
#include "trajectory/trajectory.h"
#include "trajectory/words.h"

#include <string.h>

/// Columns of an atom: number, segment, residue's number and name, name, type, charge, mass.
enum { NUMBER, SEGMENT, RESIDUE, RESIDUE_NAME, ATOM_NAME, TYPE, CHARGE, MASS, COLUMNS };

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 4 && memcmp(begin, "PSF", 3) == 0 && strchr(" \t\r\n", begin[3]) != NULL;
}

/// The whole file, which has no coordinates.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    bool there = true;
    (void)more;
    while (there)
        TRY(mf_source_line(&trajectory->source, &frame->raw, &there));
    return STATUS_OK;
}

/// The line "N !KEY" of a section from a line on, and N; NULL if there is none.
static const char *find_section(const struct trajectory_frame *frame, const char *from,
                                const char *key, struct word *count) {
    const size_t length = strlen(key);
    for (const char *at = from; at; at = mf_frame_next_line(frame, at)) {
        const char *rest = at;
        struct word word;
        if (mf_words_next(&rest, count) && mf_words_next(&rest, &word) && word.length >= length &&
            strncmp(word.begin, key, length) == 0)
            return at;
    }
    return NULL;
}

/// The line after "N !NATOM".
static enum status find_atoms(const struct trajectory_frame *frame, const char **line,
                              size_t *atoms) {
    struct word word;
    int64_t count;
    const char *const at = find_section(frame, (const char *)frame->raw.data, "!NATOM", &word);
    if (at == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no section !NATOM", frame->file);
    if (!mf_words_integer(&word, &count) || count < 1 || (size_t)count > frame->raw.size)
        return mf_frame_fail_line(frame, at, "expected the number of atoms");
    *atoms = (size_t)count;
    *line = mf_frame_next_line(frame, at);
    return STATUS_OK;
}

/// Whether a residue's number and its name follow an atom's number.
static bool is_without_segment(const struct word *word) {
    int64_t number;
    return mf_words_integer(&word[SEGMENT], &number) && word[RESIDUE].length > 0 &&
           strchr("-0123456789", word[RESIDUE].begin[0]) == NULL;
}

/// Segments differ by a letter from their neighbours.
static enum status read_atom(const struct trajectory_frame *frame, const char *line,
                             struct word *segment, struct structure_atom *atom) {
    struct word word[COLUMNS];
    const char *rest = line;
    int columns = 0;
    while (line && columns < COLUMNS && mf_words_next(&rest, &word[columns]))
        if (columns++ == RESIDUE && is_without_segment(word)) {
            word[RESIDUE_NAME] = word[RESIDUE];
            word[RESIDUE] = word[SEGMENT];
            word[SEGMENT] = (struct word){"", 0};
            columns++;
        }
    if (columns < COLUMNS)
        return mf_frame_fail_line(frame, line ? line : (const char *)frame->raw.data,
                                  "expected an atom: number, segment, residue, its name, name, "
                                  "type, charge, mass");
    const size_t digits = strspn(word[RESIDUE].begin, "-0123456789"); // a letter may follow
    const struct word number = {word[RESIDUE].begin, digits};
    if (!mf_words_integer(&number, &atom->residue_number) ||
        !mf_words_number(&word[MASS], &atom->mass) ||
        !mf_words_copy(&word[RESIDUE_NAME], atom->residue_name, STRUCTURE_NAME) ||
        !mf_words_copy(&word[ATOM_NAME], atom->name, STRUCTURE_NAME))
        return mf_frame_fail_line(frame, line,
                                  "expected a residue's number, names of at most %d letters and a "
                                  "mass",
                                  STRUCTURE_NAME - 1);
    const bool same = segment->length == word[SEGMENT].length &&
                      strncmp(segment->begin, word[SEGMENT].begin, segment->length) == 0;
    atom->chain = (char)(same ? 'A' : 'B');
    *segment = word[SEGMENT];
    return STATUS_OK;
}

// Bonds -------------------------------------------------------------------------------------------

/// The atoms of a section's terms, of so many atoms each: numbers from 1 on, on as many lines as it
/// takes.
static enum status read_terms(const struct trajectory_frame *frame, const char *line, size_t atoms,
                              uint32_t *term, size_t numbers) {
    const char *rest = mf_frame_next_line(frame, line);
    for (size_t k = 0; k < numbers;) {
        struct word word;
        int64_t atom;
        if (rest == NULL)
            return mf_frame_fail_line(frame, line, "the file ends with %zu of %zu numbers", k,
                                      numbers);
        line = rest;
        for (; k < numbers && mf_words_next(&rest, &word); k++) {
            if (!mf_words_integer(&word, &atom) || atom < 1 || (uint64_t)atom > atoms)
                return mf_frame_fail_line(frame, line, "expected an atom from 1 to %zu, not %.*s",
                                          atoms, words_shown(&word), word.begin);
            term[k] = (uint32_t)(atom - 1);
        }
        rest = mf_frame_next_line(frame, line);
    }
    return STATUS_OK;
}

static bool are_of_one_residue(const struct structure_atom *a, const struct structure_atom *b) {
    return a->residue_number == b->residue_number && a->chain == b->chain &&
           strcmp(a->residue_name, b->residue_name) == 0;
}

/// Atoms that no bond joins: a site without mass is of the molecule of its residue; but of a
/// residue that is several molecules, whose number says nothing, each is on its own.
static void join_single(struct structure *structure) {
    struct structure_atom *const atom = structure->atom;
    for (size_t first = 0, end; first < structure->atoms; first = end) {
        int64_t molecule = 0;
        bool several = false;
        for (end = first; end < structure->atoms && are_of_one_residue(&atom[first], &atom[end]);
             end++) {
            several = several || (molecule && atom[end].molecule && atom[end].molecule != molecule);
            molecule = atom[end].molecule ? atom[end].molecule : molecule;
        }
        for (size_t k = first; k < end; k++)
            if (atom[k].molecule == 0)
                atom[k].molecule = several ? (int64_t)k + 1 : molecule;
    }
}

static enum status read_section(const struct trajectory_frame *frame, const char *from, int kind,
                                struct structure *structure) {
    static const char *const keys[STRUCTURE_TERM_KINDS] = {"!NBOND", "!NTHETA", "!NPHI"};
    struct structure_terms *const terms = &structure->terms[kind];
    const size_t atoms = 2 + (size_t)kind;
    struct word word;
    int64_t count;
    const char *const line = find_section(frame, from, keys[kind], &word);
    if (line == NULL)
        return STATUS_OK;
    if (!mf_words_integer(&word, &count) || count < 0 || (size_t)count > frame->raw.size)
        return mf_frame_fail_line(frame, line, "expected the number of terms");
    TRY_ARRAY(terms->atom, atoms * (size_t)count);
    terms->count = (size_t)count;
    return read_terms(frame, line, structure->atoms, terms->atom, atoms * terms->count);
}

/// Bonds make molecules, which tell residues apart that are numbered and called the same.
static enum status read_bonds(const struct trajectory_frame *frame, const char *from,
                              struct structure *structure) {
    const struct structure_terms *const bonds = &structure->terms[0];
    for (int kind = 0; from && kind < STRUCTURE_TERM_KINDS; kind++)
        TRY(read_section(frame, from, kind, structure));
    if (bonds->count == 0)
        return STATUS_OK;
    TRY(mf_structure_join(structure, (const uint32_t(*)[2])bonds->atom, bonds->count));
    join_single(structure);
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct structure *const structure = &trajectory->structure;
    struct word segment = {"", 0};
    const char *line = NULL;
    size_t atoms = 0;
    char chain = 'A';
    TRY(find_atoms(first, &line, &atoms));
    TRY(mf_structure_init(structure, atoms));
    structure->has_names = structure->has_residues = structure->has_masses = true;
    for (size_t k = 0; k < atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        TRY(read_atom(first, line, &segment, atom));
        chain = atom->chain == 'A' ? chain : chain == 'A' ? 'B' : 'A';
        atom->chain = chain;
        line = mf_frame_next_line(first, line);
    }
    return read_bonds(first, line, structure);
}

static const char *const extensions[] = {"psf", NULL};

const struct trajectory_format mf_format_psf = {
    .name = "psf",
    .extensions = extensions,
    .summary = "CHARMM, X-PLOR, NAMD, for -s alone: names, residues, masses, molecules by bonds",
    .unit_source = TRAJECTORY_OWN_UNITS,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
};
