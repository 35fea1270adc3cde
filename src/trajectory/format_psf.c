// SPDX-License-Identifier: GPL-3.0-or-later
//
// PSF of CHARMM, X-PLOR and NAMD, as a structure: names, residues and masses of atoms. What stands
// in a line is split by blanks, as all but the oldest versions of CHARMM let it.
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

/// The line after "N !NATOM".
static enum status find_atoms(const struct trajectory_frame *frame, const char **line,
                              size_t *atoms) {
    const char *at = (const char *)frame->raw.data;
    for (; at; at = mf_frame_next_line(frame, at)) {
        const char *rest = at;
        struct word word, key;
        int64_t count;
        if (!mf_words_next(&rest, &word) || !mf_words_next(&rest, &key) || key.length < 6 ||
            strncmp(key.begin, "!NATOM", 6) != 0)
            continue;
        if (!mf_words_integer(&word, &count) || count < 1 || (size_t)count > frame->raw.size)
            return mf_frame_fail_line(frame, at, "expected the number of atoms");
        *atoms = (size_t)count;
        *line = mf_frame_next_line(frame, at);
        return STATUS_OK;
    }
    return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no section !NATOM", frame->file);
}

/// Segments differ by a letter from their neighbours.
static enum status read_atom(const struct trajectory_frame *frame, const char *line,
                             struct word *segment, struct structure_atom *atom) {
    struct word word[COLUMNS];
    const char *rest = line;
    int columns = 0;
    while (line && columns < COLUMNS && mf_words_next(&rest, &word[columns]))
        columns++;
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
    return STATUS_OK;
}

static const char *const extensions[] = {"psf", NULL};

const struct trajectory_format mf_format_psf = {
    .name = "psf",
    .extensions = extensions,
    .summary = "CHARMM, X-PLOR, NAMD, for -s alone: names, residues, masses",
    .unit_source = TRAJECTORY_OWN_UNITS,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
};
