// SPDX-License-Identifier: GPL-3.0-or-later
//
// XYZ, plain and extended (ASE, OVITO, QUIP, LAMMPS and our own): the number of atoms, a comment, a
// line for each atom; one frame after the other.
#include "trajectory/beads_file.h"
#include "trajectory/elements.h"
#include "trajectory/trajectory.h"
#include "trajectory/words.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// The comment: key=value, values with blanks being quoted -----------------------------------------

/// What columns of atoms mean to us.
enum xyz_column {
    XYZ_NAME,
    XYZ_LABEL,    ///< what a species that is no element is called; instead of XYZ_NAME
    XYZ_POSITION, ///< three columns
    XYZ_VELOCITY, ///< three columns
    XYZ_MOMENTUM, ///< three columns, in the unit of ASE
    XYZ_FORCE,    ///< three columns
    XYZ_MASS,
    XYZ_ID,
    XYZ_MOLECULE,
    XYZ_COLUMNS,
};

struct xyz_comment {
    double box[3][3];        ///< in the file's unit; 0: none
    bool periodic[3];        ///< all, unless the file says otherwise
    double time;             ///< in the file's unit; NAN: not said
    int64_t step;            ///< −1: not said
    int column[XYZ_COLUMNS]; ///< where each begins; −1: nowhere
    size_t columns;          ///< of an atom, at least
    char units[32];          ///< as mf_trajectory_unit_names has them; "": not said
};

enum { VALUE_SIZE = 1024, MAX_COLUMNS = 1000 };

/// Names of columns as ASE, OVITO, QUIP and LAMMPS write them; they may differ in case.
static const struct {
    const char *name;
    enum xyz_column column;
    int64_t width;
} known_columns[] = {
    {"name", XYZ_LABEL, 1},
    {"species", XYZ_NAME, 1},
    {"element", XYZ_NAME, 1},
    {"type", XYZ_NAME, 1},
    {"pos", XYZ_POSITION, 3},
    {"position", XYZ_POSITION, 3},
    {"positions", XYZ_POSITION, 3},
    {"velo", XYZ_VELOCITY, 3},
    {"vel", XYZ_VELOCITY, 3},
    {"velocity", XYZ_VELOCITY, 3},
    {"velocities", XYZ_VELOCITY, 3},
    {"momenta", XYZ_MOMENTUM, 3},
    {"force", XYZ_FORCE, 3},
    {"forces", XYZ_FORCE, 3},
    {"mass", XYZ_MASS, 1},
    {"masses", XYZ_MASS, 1},
    {"id", XYZ_ID, 1},
    {"mol", XYZ_MOLECULE, 1},
    {"molecule", XYZ_MOLECULE, 1},
    {"molid", XYZ_MOLECULE, 1},
};

/// Take the next key=value; a word without a value is one with an empty value.
static bool next_pair(const char **line, struct word *key, struct word *value) {
    const char *at = *line + strspn(*line, " \t");
    key->begin = at;
    at += strcspn(at, "= \t");
    key->length = (size_t)(at - key->begin);
    *value = (struct word){at, 0};
    if (*at == '=') {
        const char quote = at[1];
        const bool quoted = quote == '"' || quote == '\'';
        value->begin = at + 1 + quoted;
        value->length = strcspn(value->begin, quoted ? (char[]){quote, '\0'} : " \t");
        at = value->begin + value->length + (quoted && value->begin[value->length]);
    }
    *line = at;
    return key->length > 0 || value->length > 0 || *at != '\0';
}

static bool read_numbers(const struct word *value, double *numbers, size_t count) {
    char text[VALUE_SIZE];
    const char *rest = text;
    return mf_words_copy(value, text, sizeof text) && mf_words_numbers(&rest, numbers, count);
}

/// "T T F", with or without blanks between.
static bool read_periodic(const struct word *value, bool periodic[3]) {
    int d = 0;
    for (size_t k = 0; k < value->length; k++) {
        const char c = value->begin[k];
        if (c == 'T' || c == 't' || c == '1' || c == 'F' || c == 'f' || c == '0') {
            if (d < 3)
                periodic[d] = c == 'T' || c == 't' || c == '1';
            d++;
            while (k + 1 < value->length && value->begin[k + 1] >= 'a' &&
                   value->begin[k + 1] <= 'z')
                k++; // "True"
        }
    }
    return d == 3;
}

/// Up to the next colon.
static struct word take_part(const char **at, const char *end) {
    const char *begin = *at, *colon = memchr(begin, ':', (size_t)(end - begin));
    *at = colon ? colon + 1 : end;
    return (struct word){begin, (size_t)((colon ? colon : end) - begin)};
}

/// "species:S:1:pos:R:3": names, kinds and numbers of columns.
static bool read_properties(const struct word *value, struct xyz_comment *comment) {
    const char *at = value->begin, *const end = at + value->length;
    comment->columns = 0;
    for (int k = 0; k < XYZ_COLUMNS; k++)
        comment->column[k] = -1;
    while (at < end) {
        const struct word name = take_part(&at, end);
        take_part(&at, end); // the kind
        const struct word number = take_part(&at, end);
        int64_t width;
        if (!mf_words_integer(&number, &width) || width < 1 || width > MAX_COLUMNS)
            return false;
        for (size_t k = 0; k < sizeof known_columns / sizeof *known_columns; k++) {
            int *const column = &comment->column[known_columns[k].column];
            if (mf_words_alike(&name, known_columns[k].name) && width == known_columns[k].width &&
                *column < 0)
                *column = (int)comment->columns;
        }
        comment->columns += (size_t)width;
        if (comment->columns > MAX_COLUMNS)
            return false;
    }
    if (comment->column[XYZ_LABEL] >= 0)
        comment->column[XYZ_NAME] = comment->column[XYZ_LABEL];
    return comment->column[XYZ_POSITION] >= 0;
}

static const char *read_pair(struct xyz_comment *comment, const struct word *key,
                             const struct word *value) {
    double number;
    if (mf_words_alike(key, "Lattice"))
        return read_numbers(value, &comment->box[0][0], 9) ? NULL
                                                           : "expected nine numbers in Lattice";
    if (mf_words_alike(key, "Properties"))
        return read_properties(value, comment)
                   ? NULL
                   : "expected name:kind:number in Properties, including pos:R:3";
    if (mf_words_alike(key, "pbc"))
        return read_periodic(value, comment->periodic) ? NULL : "expected three of T and F in pbc";
    if (mf_words_alike(key, "Units"))
        return mf_words_copy(value, comment->units, sizeof comment->units) ? NULL
                                                                           : "Units is too long";
    if (mf_words_alike(key, "Time") && read_numbers(value, &number, 1))
        comment->time = number;
    if ((mf_words_alike(key, "Step") || mf_words_alike(key, "Timestep")) &&
        read_numbers(value, &number, 1) && fabs(number) < 9e15)
        comment->step = (int64_t)number;
    return NULL;
}

/// Read a comment; a plain one says nothing, and gives the columns of plain XYZ.
static const char *read_comment(struct xyz_comment *comment, const char *line) {
    struct word key, value;
    *comment = (struct xyz_comment){.periodic = {true, true, true},
                                    .time = NAN,
                                    .step = -1,
                                    .column = {0, -1, 1, -1, -1, -1, -1, -1, -1},
                                    .columns = 4};
    while (next_pair(&line, &key, &value)) {
        const char *const fault = read_pair(comment, &key, &value);
        if (fault)
            return fault;
    }
    return NULL;
}

// Frames ------------------------------------------------------------------------------------------

/// ASE (ase.io.extxyz) writes momenta in place of velocities, whatever the units of the file, in
/// sqrt(u eV), and masses only where they are not those of the elements: a speed of sqrt(eV/u) is
/// sqrt(1.602176634e-19 J / 1.66053906892e-27 kg) [nm/ps].
static const double ase_speed = 9.822694743;

/// Forces of a file that says no units are in eV/Å, as ASE, QUIP and OVITO have them [kJ/mol/nm].
static const double ase_force = 964.8533212;

static bool recognise(const unsigned char *begin, size_t size) {
    char line[SOURCE_PEEK];
    const char *rest = line;
    struct word word;
    int64_t atoms;
    double position[3];
    if (!mf_words_line(begin, size, 0, line, sizeof line) || !mf_words_next(&rest, &word) ||
        !mf_words_integer(&word, &atoms) || mf_words_count(line) != 1 ||
        !mf_words_line(begin, size, 1, line, sizeof line))
        return false;
    if (strstr(line, "Properties=") || strstr(line, "Lattice="))
        return true;
    rest = line;
    return mf_words_line(begin, size, 2, line, sizeof line) && mf_words_next(&rest, &word) &&
           mf_words_numbers(&rest, position, 3);
}

/// Empty lines at the end of a file are not a frame.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct source *const source = &trajectory->source;
    uint64_t atoms;
    do {
        frame->raw.size = 0;
        frame->first_line = source->line;
        frame->first_byte = source->byte;
        TRY(mf_source_line(source, &frame->raw, more));
        if (!*more)
            return STATUS_OK;
    } while (mf_words_count((const char *)frame->raw.data) == 0);
    TRY(mf_trajectory_read_count(trajectory, (const char *)frame->raw.data, &atoms));
    return mf_source_lines(source, &frame->raw, atoms + 1);
}

/// Read the comment; `*line` is that of the first atom.
static enum status begin_frame(const struct trajectory_frame *frame, struct xyz_comment *comment,
                               const char **line) {
    const char *const second = mf_frame_next_line(frame, (const char *)frame->raw.data);
    const char *const fault = read_comment(comment, second);
    *line = mf_frame_next_line(frame, second);
    return fault ? mf_frame_fail_line(frame, second, "%s", fault) : STATUS_OK;
}

/// The columns that we know of an atom's line.
static enum status split(const struct xyz_comment *comment, const struct trajectory_frame *frame,
                         const char *line, struct word known[XYZ_COLUMNS][3]) {
    const char *rest = line;
    struct word word;
    for (int k = 0; k < (int)comment->columns; k++) {
        if (!mf_words_next(&rest, &word))
            return mf_frame_fail_line(frame, line, "%d columns, expected %zu", k, comment->columns);
        for (int c = 0; c < XYZ_COLUMNS; c++) {
            const int place = k - comment->column[c];
            const bool vector = c >= XYZ_POSITION && c <= XYZ_FORCE;
            const int width = vector ? 3 : 1;
            if (comment->column[c] >= 0 && place >= 0 && place < width)
                known[c][place] = word;
        }
    }
    return STATUS_OK;
}

static enum status describe_atom(const struct xyz_comment *comment,
                                 const struct trajectory_frame *first, const char *line,
                                 double mass_unit, struct structure_atom *atom) {
    struct word known[XYZ_COLUMNS][3];
    const int *const column = comment->column;
    TRY(split(comment, first, line, known));
    if (column[XYZ_NAME] >= 0 && !mf_words_copy(known[XYZ_NAME], atom->name, STRUCTURE_NAME))
        return mf_frame_fail_line(first, line, "a name of more than %d characters",
                                  STRUCTURE_NAME - 1);
    if (column[XYZ_MASS] >= 0 && !mf_words_number(known[XYZ_MASS], &atom->mass))
        return mf_frame_fail_line(first, line, "expected a number for the mass");
    atom->mass *= mass_unit;
    if (column[XYZ_MASS] < 0 && column[XYZ_MOMENTUM] >= 0)
        atom->mass = mf_elements_mass(atom->name);
    if ((column[XYZ_ID] >= 0 && !mf_words_integer(known[XYZ_ID], &atom->id)) ||
        (column[XYZ_MOLECULE] >= 0 && !mf_words_integer(known[XYZ_MOLECULE], &atom->molecule)))
        return mf_frame_fail_line(first, line, "expected integers for id and molecule");
    return STATUS_OK;
}

/// What the file or the user says; else the field's habit of Å, fs, u, and eV/Å.
static enum status find_units(struct trajectory *trajectory, const struct xyz_comment *comment) {
    if (comment->units[0] != '\0')
        return mf_trajectory_found_units(trajectory, comment->units);
    if (trajectory->scale.length > 0)
        return STATUS_OK;
    TRY(mf_trajectory_found_units(trajectory, "real"));
    trajectory->scale.force = ase_force;
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct structure *const structure = &trajectory->structure;
    struct xyz_comment comment;
    const char *line, *rest = (const char *)first->raw.data;
    struct word word;
    int64_t atoms = 0;
    TRY(begin_frame(first, &comment, &line));
    TRY(find_units(trajectory, &comment));
    if (mf_words_next(&rest, &word) && mf_words_integer(&word, &atoms))
        TRY(mf_structure_init(structure, (size_t)atoms));
    structure->has_names = comment.column[XYZ_NAME] >= 0;
    structure->has_masses = comment.column[XYZ_MASS] >= 0 || comment.column[XYZ_MOMENTUM] >= 0;
    structure->has_ids = comment.column[XYZ_ID] >= 0;
    structure->has_molecules = comment.column[XYZ_MOLECULE] >= 0;
    for (size_t k = 0; k < structure->atoms; k++, line = mf_frame_next_line(first, line))
        TRY(describe_atom(&comment, first, line, trajectory->scale.mass, &structure->atom[k]));
    for (size_t k = 0; k < structure->atoms; k++) // of what is no element only the map may know it
        structure->has_masses = structure->has_masses && isfinite(structure->atom[k].mass);
    return structure->has_ids ? mf_trajectory_sort(trajectory, first) : STATUS_OK;
}

static bool read_vector(const struct word word[3], double scale, double vector[3]) {
    for (int d = 0; d < 3; d++) {
        if (!mf_words_number(&word[d], &vector[d]))
            return false;
        vector[d] *= scale;
    }
    return true;
}

static enum status read_atom(const struct trajectory *trajectory, struct trajectory_frame *frame,
                             const struct xyz_comment *comment, const char *line, size_t atom) {
    struct word known[XYZ_COLUMNS][3];
    int64_t id;
    TRY(split(comment, frame, line, known));
    if (trajectory->structure.has_ids) {
        if (comment->column[XYZ_ID] < 0 || !mf_words_integer(known[XYZ_ID], &id))
            return mf_frame_fail_line(frame, line, "expected an atom id");
        TRY(mf_trajectory_find_atom(trajectory, frame, line, id, &atom));
    }
    if (comment->column[XYZ_NAME] >= 0 && trajectory->structure.has_names &&
        !mf_words_same(known[XYZ_NAME], trajectory->structure.atom[atom].name))
        return mf_trajectory_fail_type(trajectory, frame, line, atom, known[XYZ_NAME]);
    if (!read_vector(known[XYZ_POSITION], trajectory->scale.length, frame->position[atom]))
        return mf_frame_fail_line(frame, line, "a coordinate is not a finite number%s",
                                  mf_words_number_hint(line));
    const bool momenta = comment->column[XYZ_VELOCITY] < 0;
    const double speed =
        momenta ? ase_speed / trajectory->structure.atom[atom].mass : trajectory->scale.speed;
    if (frame->has_velocities &&
        !read_vector(known[momenta ? XYZ_MOMENTUM : XYZ_VELOCITY], speed, frame->velocity[atom]))
        return mf_frame_fail_line(frame, line, "a velocity is not a finite number");
    if (frame->has_forces &&
        !read_vector(known[XYZ_FORCE], trajectory->scale.force, frame->force[atom]))
        return mf_frame_fail_line(frame, line, "a force is not a finite number");
    return STATUS_OK;
}

/// Momenta are velocities where masses are known, and above 0.
static bool has_velocities(const struct trajectory *trajectory, const struct xyz_comment *comment) {
    const struct structure *const structure = &trajectory->structure;
    bool known = comment->column[XYZ_MOMENTUM] >= 0 && structure->has_masses;
    for (size_t k = 0; k < structure->atoms && known; k++)
        known = structure->atom[k].mass > 0;
    return known || comment->column[XYZ_VELOCITY] >= 0;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    struct xyz_comment comment;
    const char *line;
    TRY(begin_frame(frame, &comment, &line));
    for (int k = 0; k < 9; k++)
        comment.box[k / 3][k % 3] *= trajectory->scale.length;
    mf_frame_set_box(frame, comment.box);
    for (int d = 0; d < 3; d++)
        frame->periodic[d] = frame->has_box && comment.periodic[d];
    frame->time = comment.time * trajectory->scale.time;
    frame->step = comment.step;
    TRY(mf_frame_reserve(frame, trajectory->structure.atoms, has_velocities(trajectory, &comment)));
    if (trajectory->forces && comment.column[XYZ_FORCE] >= 0)
        TRY(mf_frame_reserve_forces(frame));
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    for (size_t k = 0; k < frame->atoms; k++, line = mf_frame_next_line(frame, line))
        TRY(read_atom(trajectory, frame, &comment, line, k));
    return STATUS_OK;
}

// Beads -------------------------------------------------------------------------------------------

static void print_heading(const struct beads_file *file, const struct trajectory_frame *beads,
                          bool masses) {
    FILE *const stream = file->output.stream;
    const double *const box = beads->box[0];
    fprintf(stream, "%zu\n", beads->atoms);
    if (beads->has_box) {
        fprintf(stream, "Lattice=\"");
        for (int k = 0; k < 9; k++)
            fprintf(stream, k ? " %.9g" : "%.9g", box[k] * beads_file_angstrom);
        fprintf(stream, "\" ");
    }
    fprintf(stream, "pbc=\"%c %c %c\" Units=real ", beads->periodic[0] ? 'T' : 'F',
            beads->periodic[1] ? 'T' : 'F', beads->periodic[2] ? 'T' : 'F');
    if (!isnan(beads->time))
        fprintf(stream, "Time=%.9g ", beads->time * beads_file_femtosecond);
    if (beads->step >= 0)
        fprintf(stream, "Step=%lld ", (long long)beads->step);
    fprintf(stream, "Properties=species:S:1:pos:R:3%s%s:molecule:I:1:type:I:1:name:S:1\n",
            beads->has_velocities ? ":velo:R:3" : "", masses ? ":masses:R:1" : "");
}

static enum status print(struct beads_file *file, const struct trajectory_frame *beads) {
    const bool masses = mf_beads_file_has_masses(file);
    FILE *const stream = file->output.stream;
    print_heading(file, beads, masses);
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        fputs(mf_elements_symbol(beads_file_type_name(file, k)), stream);
        beads_file_print_vector(stream, beads->position[k], beads_file_angstrom);
        if (beads->has_velocities)
            beads_file_print_vector(stream, beads->velocity[k],
                                    beads_file_angstrom_per_femtosecond);
        if (masses)
            fprintf(stream, " %.9g", file->mapping->bead[k].mass);
        fprintf(stream, " %zu %zu %s\n", file->mapping->bead[k].molecule + 1,
                file->mapping->bead[k].type + 1, beads_file_type_name(file, k));
    }
    return STATUS_OK;
}

static const char *const extensions[] = {"xyz", "extxyz", "exyz", NULL};

const struct trajectory_format mf_format_xyz = {
    .name = "xyz",
    .extensions = extensions,
    .summary = "XYZ, plain or extended: Lattice, pbc, Time, Units, and of Properties name, pos, "
               "velo, momenta, forces, mass, id, mol",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
    .print = print,
};
