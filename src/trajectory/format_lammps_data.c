// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS's data files: one configuration, with masses, types and molecules.
#include "base/memory.h"
#include "trajectory/lammps_data.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

/// The second line or one after it tells the number of atoms.
static bool recognise(const unsigned char *begin, size_t size) {
    char line[256];
    struct word word[LAMMPS_DATA_WORDS];
    int64_t atoms;
    for (size_t k = 1; k < 12 && mf_words_line(begin, size, k, line, sizeof line); k++)
        if (mf_lammps_data_split(line, word) == 2 && mf_words_same(&word[1], "atoms"))
            return mf_words_integer(&word[0], &atoms);
    return false;
}

/// The whole file is one frame.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    bool there = true;
    (void)more;
    while (there)
        TRY(mf_source_line(&trajectory->source, &frame->raw, &there));
    return STATUS_OK;
}

static enum status check(const struct lammps_data *data, const struct trajectory_frame *frame) {
    const char *const begin = (const char *)frame->raw.data;
    if (!data->is_text)
        return mf_frame_fail_line(frame, begin,
                                  "a data file of LAMMPS has \"N atoms\" and \"… xlo xhi\"");
    if (data->atom == NULL)
        return mf_frame_fail_line(frame, begin, "there is no section Atoms");
    if (data->atoms > frame->raw.size)
        return mf_frame_fail_line(frame, begin, "the file is too short for so many atoms");
    return STATUS_OK;
}

/// Masses by type; NAN: not given.
static enum status read_masses(const struct lammps_data *data, const struct trajectory_frame *first,
                               double unit, double *mass) {
    struct word word[LAMMPS_DATA_WORDS];
    int64_t type;
    const char *line = data->masses;
    for (size_t k = 0; k <= data->types; k++)
        mass[k] = NAN;
    for (size_t k = 0; line && k < data->types; k++, line = mf_frame_next_line(first, line)) {
        double value = 0;
        if (mf_lammps_data_split(line, word) < 2 || !mf_words_integer(&word[0], &type) ||
            type < 1 || (size_t)type > data->types || !mf_words_number(&word[1], &value))
            return mf_frame_fail_line(first, line, "expected an atom type and its mass");
        mass[type] = value * unit;
    }
    return STATUS_OK;
}

/// Split the line of an atom, which is there and has enough columns.
static enum status split_atom(const struct lammps_style *style,
                              const struct trajectory_frame *frame, const char *line,
                              struct word word[LAMMPS_DATA_WORDS], size_t *count) {
    if (line == NULL)
        return mf_frame_fail_line(frame, (const char *)frame->raw.data + frame->raw.size - 1,
                                  "the file ends within the section");
    *count = mf_lammps_data_split(line, word);
    if (*count < (size_t)style->position + 3)
        return mf_frame_fail_line(frame, line, "%zu columns, atom style %s has %d", *count,
                                  style->name, style->position + 3);
    return STATUS_OK;
}

static enum status describe_atoms(struct structure *structure, const struct lammps_data *data,
                                  const struct trajectory_frame *first, const double *mass) {
    const struct lammps_style *style;
    struct word word[LAMMPS_DATA_WORDS];
    size_t count = 0;
    TRY(mf_lammps_data_style(data, first, &style));
    structure->has_ids = structure->has_types = structure->has_names = true;
    structure->names = STRUCTURE_TYPES;
    structure->has_molecules = style->molecule >= 0;
    structure->has_masses = data->masses != NULL;
    const char *line = data->atom;
    for (size_t k = 0; k < data->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        TRY(split_atom(style, first, line, word, &count));
        const struct word *const type = &word[style->type];
        if (!mf_words_integer(&word[0], &atom->id) || !mf_words_integer(type, &atom->type) ||
            atom->type < 1 || (size_t)atom->type > data->types ||
            (style->molecule >= 0 && !mf_words_integer(&word[style->molecule], &atom->molecule)))
            return mf_frame_fail_line(
                first, line, "expected integers for id, molecule and type, types from 1 to %zu",
                data->types);
        mf_words_copy(type, atom->name, STRUCTURE_NAME);
        atom->mass = mass[atom->type];
        line = mf_frame_next_line(first, line);
    }
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct lammps_data data;
    OWNED double *mass = NULL;
    TRY(mf_lammps_data_read(&data, first));
    TRY(check(&data, first));
    if (data.units[0])
        TRY(mf_trajectory_found_units(trajectory, data.units));
    TRY_ARRAY(mass, data.types + 1);
    TRY(mf_structure_init(&trajectory->structure, data.atoms));
    TRY(read_masses(&data, first, trajectory->scale.mass, mass));
    TRY(describe_atoms(&trajectory->structure, &data, first, mass));
    return mf_trajectory_sort(trajectory, first);
}

/// Positions, with the images of their lines if these have them.
static enum status read_positions(const struct trajectory *trajectory,
                                  struct trajectory_frame *frame, const struct lammps_data *data) {
    const struct lammps_style *style;
    struct word word[LAMMPS_DATA_WORDS];
    size_t count = 0, atom = 0;
    int64_t id;
    TRY(mf_lammps_data_style(data, frame, &style));
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    const char *line = data->atom;
    for (size_t k = 0; k < data->atoms; k++, line = mf_frame_next_line(frame, line)) {
        double image[3] = {0};
        TRY(split_atom(style, frame, line, word, &count));
        const struct word *const place = &word[style->position];
        const bool images = count == (size_t)style->position + 6;
        bool good = mf_words_integer(&word[0], &id);
        TRY(mf_trajectory_find_atom(trajectory, frame, line, good ? id : -1, &atom));
        double *const position = frame->position[atom];
        for (int d = 0; d < 3; d++)
            good = good && mf_words_number(&place[d], &position[d]) &&
                   (!images || mf_words_number(&place[3 + d], &image[d]));
        if (!good)
            return mf_frame_fail_line(frame, line, "a coordinate is not a finite number");
        for (int d = 0; d < 3; d++)
            position[d] = trajectory->scale.length *
                          (position[d] + image[0] * data->box[0][d] + image[1] * data->box[1][d] +
                           image[2] * data->box[2][d]);
    }
    return STATUS_OK;
}

static enum status read_velocities(const struct trajectory *trajectory,
                                   struct trajectory_frame *frame, const struct lammps_data *data) {
    static const struct lammps_style style = {"Velocities", -1, -1, -1, 1};
    struct word word[LAMMPS_DATA_WORDS];
    size_t count = 0, atom = 0;
    int64_t id;
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    const char *line = data->velocities;
    for (size_t k = 0; k < data->atoms; k++, line = mf_frame_next_line(frame, line)) {
        TRY(split_atom(&style, frame, line, word, &count));
        bool good = mf_words_integer(&word[0], &id);
        TRY(mf_trajectory_find_atom(trajectory, frame, line, good ? id : -1, &atom));
        double *const velocity = frame->velocity[atom];
        for (int d = 0; d < 3; d++)
            good = good && mf_words_number(&word[1 + d], &velocity[d]);
        if (!good)
            return mf_frame_fail_line(frame, line, "a velocity is not a finite number");
        for (int d = 0; d < 3; d++)
            velocity[d] *= trajectory->scale.speed;
    }
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    struct lammps_data data;
    double box[3][3];
    TRY(mf_lammps_data_read(&data, frame));
    frame->step = data.step;
    for (int k = 0; k < 9; k++)
        box[k / 3][k % 3] = data.box[k / 3][k % 3] * trajectory->scale.length;
    mf_frame_set_box(frame, box);
    TRY(mf_frame_reserve(frame, data.atoms, data.velocities != NULL));
    TRY(read_positions(trajectory, frame, &data));
    return frame->has_velocities ? read_velocities(trajectory, frame, &data) : STATUS_OK;
}

static const char *const extensions[] = {"data", NULL};

const struct trajectory_format mf_format_lammps_data = {
    .name = "lammps-data",
    .extensions = extensions,
    .summary = "LAMMPS, data file: one configuration of style atomic, charge, molecular or full",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
