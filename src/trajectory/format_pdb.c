// SPDX-License-Identifier: GPL-3.0-or-later
//
// PDB, format 3.3 of wwPDB: ATOM and HETATM by their columns, CRYST1, frames between MODEL and
// ENDMDL or up to END. Of alternate locations the first, "A", is taken.
#include "trajectory/trajectory.h"
#include "trajectory/words.h"

#include <ctype.h>
#include <string.h>

enum { COORDINATES = 30, WIDTH = 8, LOCATION = 16 };

static const double angstrom = 0.1; // nm

/// What holds until a file says otherwise.
struct pdb {
    double box[3][3];
    bool in_model; ///< MODEL has been read, its ENDMDL has not
};

static bool is_record(const char *line, const char *record) {
    return strncmp(line, record, strlen(record)) == 0;
}

static bool is_atom(const char *line) {
    if (!is_record(line, "ATOM  ") && !is_record(line, "HETATM"))
        return false;
    return strlen(line) <= LOCATION || strchr(" A1", line[LOCATION]) != NULL;
}

static bool recognise(const unsigned char *begin, size_t size) {
    static const char *const records[] = {"HEADER", "TITLE ", "REMARK", "CRYST1", "ATOM  ",
                                          "HETATM", "MODEL ", "COMPND", "AUTHOR", "EXPDTA"};
    char line[16];
    if (!mf_words_line(begin, size, 0, line, sizeof line))
        return false;
    for (size_t k = 0; k < sizeof records / sizeof *records; k++)
        if (is_record(line, records[k]))
            return true;
    return false;
}

/// The box of a crystal, but for the unit cube, which stands for none.
static enum status read_cell(const struct source *source, struct pdb *pdb, const char *line) {
    struct trajectory_frame frame = {0};
    double length[3], angle[3];
    bool unit = true;
    for (size_t d = 0; d < 3; d++) {
        const struct word edge = mf_words_columns(line, 6 + 9 * d, 9);
        const struct word corner = mf_words_columns(line, 33 + 7 * d, 7);
        if (!mf_words_number(&edge, &length[d]) || !mf_words_number(&corner, &angle[d]))
            return mf_source_fail_line(source, "expected three lengths and three angles in CRYST1");
        unit = unit && length[d] <= 1;
        length[d] *= angstrom;
    }
    if (!unit && !mf_frame_box_of_angles(&frame, length, angle))
        return mf_source_fail_line(source, "not a valid box: no cell has these lengths and angles");
    memcpy(pdb->box, frame.box, sizeof pdb->box);
    return STATUS_OK;
}

/// Whether the line ends a frame of so many atoms.
static bool ends_frame(struct pdb *pdb, const char *line, uint64_t atoms) {
    const bool begins = is_record(line, "MODEL"), ends = is_record(line, "ENDMDL");
    if (begins || ends)
        pdb->in_model = begins;
    return atoms > 0 && (begins || ends || (is_record(line, "END") && strlen(line) < 6) ||
                         is_record(line, "END   "));
}

/// Take lines up to the end of a frame; `*more` is false if the file ends without another atom.
static enum status take_lines(struct trajectory *trajectory, struct bytes *raw, uint64_t *atoms,
                              bool *more) {
    struct source *const source = &trajectory->source;
    struct pdb *const pdb = trajectory->state;
    for (;;) {
        const size_t begin = raw->size;
        bool there;
        TRY(mf_source_line(source, raw, &there));
        if (!there)
            break;
        const char *const line = (const char *)raw->data + begin;
        if (is_record(line, "CRYST1"))
            TRY(read_cell(source, pdb, line));
        *atoms += is_atom(line);
        if (ends_frame(pdb, line, *atoms))
            return STATUS_OK;
        if (is_atom(line) && source->broken_line && source->frame > 0)
            return mf_source_fail_line(source, "the file ends within this line");
    }
    *more = *atoms > 0;
    if (*more && pdb->in_model)
        return mf_source_fail_line(source, "the file ends within the frame: ENDMDL is missing");
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct pdb *const pdb = trajectory->state;
    uint64_t atoms = 0;
    TRY(take_lines(trajectory, &frame->raw, &atoms, more));
    if (*more && trajectory->source.frame > 0 && atoms != trajectory->structure.atoms)
        return mf_source_fail_line(&trajectory->source, "it has %llu atoms, the first frame %zu",
                                   (unsigned long long)atoms, trajectory->structure.atoms);
    mf_frame_set_box(frame, pdb->box);
    return STATUS_OK;
}

/// The first atom at this line or after it; NULL if there is none.
static const char *find_atom(const struct trajectory_frame *frame, const char *line) {
    while (line && !is_atom(line))
        line = mf_frame_next_line(frame, line);
    return line;
}

static const char *first_atom(const struct trajectory_frame *frame) {
    return find_atom(frame, (const char *)frame->raw.data);
}

static const char *next_atom(const struct trajectory_frame *frame, const char *line) {
    return find_atom(frame, mf_frame_next_line(frame, line));
}

/// Beyond 9999 programs go on in digits of their own, such as "A000": any number that tells
/// residues apart will do.
static int64_t number_of_letters(const struct word *word) {
    int64_t number = 0;
    for (size_t k = 0; k < word->length; k++)
        number = 256 * number + (unsigned char)word->begin[k];
    return number;
}

/// Chains and insertion codes tell residues of the same number apart.
static void describe_atom(const char *line, struct structure_atom *atom) {
    const struct word name = mf_words_columns(line, 12, 4), residue = mf_words_columns(line, 17, 4);
    const struct word number = mf_words_columns(line, 22, 4),
                      element = mf_words_columns(line, 76, 2);
    const size_t length = strlen(line);
    mf_words_copy(&name, atom->name, STRUCTURE_NAME); // all are short enough
    mf_words_copy(&residue, atom->residue_name, STRUCTURE_NAME);
    mf_words_copy(&element, atom->element, STRUCTURE_NAME);
    if (atom->element[0] && atom->element[1])
        atom->element[1] = (char)tolower((unsigned char)atom->element[1]);
    atom->chain = length > 21 ? line[21] : ' ';
    atom->molecule = length > 26 && line[26] != ' ' ? line[26] : 0;
    if (!mf_words_integer(&number, &atom->residue_number))
        atom->residue_number = number_of_letters(&number);
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    size_t atoms = 0;
    for (const char *line = first_atom(first); line; line = next_atom(first, line))
        atoms++;
    TRY(mf_structure_init(&trajectory->structure, atoms));
    struct structure *const structure = &trajectory->structure;
    structure->has_names = structure->has_residues = structure->has_elements = true;
    size_t k = 0;
    for (const char *line = first_atom(first); line; line = next_atom(first, line), k++) {
        describe_atom(line, &structure->atom[k]);
        structure->has_elements &= structure->atom[k].element[0] != '\0';
    }
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    size_t k = 0;
    for (const char *line = (const char *)frame->raw.data; line;
         line = mf_frame_next_line(frame, line))
        if (is_record(line, "TITLE"))
            mf_frame_read_title(frame, line);
    TRY(mf_frame_reserve(frame, trajectory->structure.atoms, false));
    for (const char *line = first_atom(frame); line; line = next_atom(frame, line), k++)
        for (size_t d = 0; d < 3; d++) {
            const struct word word = mf_words_columns(line, COORDINATES + WIDTH * d, WIDTH);
            if (!mf_words_number(&word, &frame->position[k][d]))
                return mf_frame_fail_line(frame, line, "expected an atom position");
            frame->position[k][d] *= angstrom;
        }
    return STATUS_OK;
}

static const char *const extensions[] = {"pdb", "ent", NULL};

const struct trajectory_format mf_format_pdb = {
    .name = "pdb",
    .extensions = extensions,
    .summary = "Protein Data Bank, text: positions, names, elements, CRYST1; one model or many",
    .state_size = sizeof(struct pdb),
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
