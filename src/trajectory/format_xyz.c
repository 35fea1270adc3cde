// SPDX-License-Identifier: GPL-3.0-or-later
//
// XYZ, plain and extended (ASE, OVITO, QUIP, LAMMPS and our own): the number of atoms, a comment, a
// line for each atom; one frame after the other.
#include "trajectory/elements.h"
#include "trajectory/trajectory.h"
#include "trajectory/xyz_comment.h"

#include <math.h>
#include <string.h>

/// ASE (ase.io.extxyz) writes momenta in place of velocities, whatever the units of the file, in
/// sqrt(u eV), and masses only where they are not those of the elements: a speed of sqrt(eV/u) is
/// sqrt(1.602176634e-19 J / 1.66053906892e-27 kg) [nm/ps].
static const double ase_speed = 9.822694743;

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
    const char *const fault = mf_xyz_comment_read(comment, second);
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
            const bool vector = c == XYZ_POSITION || c == XYZ_VELOCITY || c == XYZ_MOMENTUM;
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

/// What the file or the user says; else the field's habit of Å, fs and u.
static enum status find_units(struct trajectory *trajectory, const struct xyz_comment *comment) {
    if (comment->units[0] != '\0')
        return mf_trajectory_found_units(trajectory, comment->units);
    return trajectory->scale.length > 0 ? STATUS_OK : mf_trajectory_found_units(trajectory, "real");
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
    if (!read_vector(known[XYZ_POSITION], trajectory->scale.length, frame->position[atom]))
        return mf_frame_fail_line(frame, line, "a coordinate is not a finite number");
    const bool momenta = comment->column[XYZ_VELOCITY] < 0;
    const double speed =
        momenta ? ase_speed / trajectory->structure.atom[atom].mass : trajectory->scale.speed;
    if (frame->has_velocities &&
        !read_vector(known[momenta ? XYZ_MOMENTUM : XYZ_VELOCITY], speed, frame->velocity[atom]))
        return mf_frame_fail_line(frame, line, "a velocity is not a finite number");
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
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    for (size_t k = 0; k < frame->atoms; k++, line = mf_frame_next_line(frame, line))
        TRY(read_atom(trajectory, frame, &comment, line, k));
    return STATUS_OK;
}

static const char *const extensions[] = {"xyz", "extxyz", "exyz", NULL};

const struct trajectory_format mf_format_xyz = {
    .name = "xyz",
    .extensions = extensions,
    .summary = "XYZ, plain or extended: Lattice, pbc, Time, Units, and of Properties pos, velo, "
               "momenta, mass, id, mol",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
