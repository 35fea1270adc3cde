// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS's data files: one configuration, with masses, types, molecules and what joins them; and
// its templates of molecules (manual, command `molecule`), which have the same sections but a type
// and perhaps a mass for each atom, and no place in a box.
#include "base/memory.h"
#include "trajectory/lammps_data.h"
#include "trajectory/trajectory.h"

#include <ctype.h>
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
    if (data->atoms > frame->raw.size)
        return mf_frame_fail_line(frame, begin, "the file is too short for so many atoms");
    const bool is_template = data->kinds && data->atom == NULL;
    if (is_template && data->atoms == 0)
        return mf_frame_fail_line(frame, begin,
                                  "a template of LAMMPS has \"N atoms\" before its sections");
    if (is_template)
        return STATUS_OK;
    if (!data->is_text)
        return mf_frame_fail_line(frame, begin,
                                  "a data file of LAMMPS has \"N atoms\" and \"… xlo xhi\" or "
                                  "\"… avec\"");
    if (data->atom == NULL)
        return mf_frame_fail_line(frame, begin, "there is no section Atoms");
    return STATUS_OK;
}

/// What the types of atoms are: shape [types + 1], by their numbers.
struct types {
    size_t count;
    char (*name)[STRUCTURE_NAME];
    double *mass; ///< NAN: not given
};

static void clear_types(struct types *types) {
    mf_memory_free(types->name);
    mf_memory_free(types->mass);
}

static size_t type_of(const struct types *types, const struct word *word) {
    return mf_lammps_data_type(word, types->count, (const char(*)[STRUCTURE_NAME])types->name);
}

static enum status read_types(struct types *types, const struct lammps_data *data,
                              const struct trajectory_frame *first, double unit) {
    struct word word[LAMMPS_DATA_WORDS];
    const char *line = data->masses;
    types->count = data->types;
    TRY_ARRAY(types->name, types->count + 1);
    TRY_ARRAY(types->mass, types->count + 1);
    TRY(mf_lammps_data_names(first, data->labels, types->count, types->name));
    for (size_t k = 0; k <= types->count; k++)
        types->mass[k] = NAN;
    for (size_t k = 0; line && k < types->count; k++, line = mf_frame_next_line(first, line)) {
        double value = 0;
        const bool two = mf_lammps_data_split(line, word) >= 2;
        const size_t type = two ? type_of(types, &word[0]) : 0;
        if (type == 0 || !mf_words_number(&word[1], &value))
            return mf_frame_fail_line(first, line, "expected an atom type and its mass");
        types->mass[type] = value * unit;
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
                                  const struct trajectory_frame *first, const struct types *types) {
    const struct lammps_style *style;
    struct word word[LAMMPS_DATA_WORDS];
    size_t count = 0;
    TRY(mf_lammps_data_style(data, first, &style));
    structure->has_ids = structure->has_types = structure->has_names = true;
    structure->names = data->labels ? STRUCTURE_NAMES : STRUCTURE_TYPES;
    structure->has_molecules = style->molecule >= 0;
    structure->has_masses = data->masses != NULL;
    const char *line = data->atom;
    for (size_t k = 0; k < data->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        TRY(split_atom(style, first, line, word, &count));
        const size_t type = type_of(types, &word[style->type]);
        if (!mf_words_integer(&word[0], &atom->id) || type == 0 ||
            (style->molecule >= 0 && !mf_words_integer(&word[style->molecule], &atom->molecule)))
            return mf_frame_fail_line(
                first, line, "expected integers for id, molecule and type, types from 1 to %zu",
                data->types);
        atom->type = (int64_t)type;
        memcpy(atom->name, types->name[type], STRUCTURE_NAME);
        atom->mass = types->mass[type];
        line = mf_frame_next_line(first, line);
    }
    return STATUS_OK;
}

static const struct {
    const char *name, *article;
} kinds[STRUCTURE_TERM_KINDS] = {{"bond", "a"}, {"angle", "an"}, {"dihedral", "a"}};

/// The number of a type by its number or label or, where the header does not say how many there
/// are, the next one for what was not seen yet; 0: there is none.
static size_t find_term_type(const struct word *word, bool counted, struct structure_terms *terms) {
    enum { MOST_UNCOUNTED = 1000 };
    if (counted)
        return mf_lammps_data_type(word, terms->types, (const char(*)[STRUCTURE_NAME])terms->name);
    for (size_t k = 1; k <= terms->types; k++)
        if (mf_words_same(word, terms->name[k]))
            return k;
    if (terms->types == MOST_UNCOUNTED ||
        !mf_words_copy(word, terms->name[terms->types + 1], STRUCTURE_NAME))
        return 0;
    return ++terms->types;
}

/// One term: its number, its type, its atoms by their ids.
static enum status read_term(const struct structure *structure,
                             const struct trajectory_frame *first, const char *line,
                             const struct word *word, int kind, bool counted,
                             struct structure_terms *terms) {
    const size_t atoms = (size_t)kind + 2, n = terms->count;
    int64_t id;
    const size_t type = find_term_type(&word[1], counted, terms);
    if (type == 0)
        return mf_frame_fail_line(first, line,
                                  "\"%.*s\" is not a type of %s %s: expected 1 to %zu or a label",
                                  words_shown(&word[1]), word[1].begin, kinds[kind].article,
                                  kinds[kind].name, terms->types);
    terms->type[n] = (uint32_t)type;
    for (size_t k = 0; k < atoms; k++) {
        const size_t atom = mf_words_integer(&word[2 + k], &id) ? mf_structure_find(structure, id)
                                                                : structure->atoms;
        if (atom == structure->atoms)
            return mf_frame_fail_line(first, line, "there is no atom %.*s",
                                      words_shown(&word[2 + k]), word[2 + k].begin);
        terms->atom[n * atoms + k] = (uint32_t)atom;
        for (size_t other = 0; other < k; other++)
            if (terms->atom[n * atoms + other] == (uint32_t)atom)
                return mf_frame_fail_line(first, line, "the %s has an atom twice",
                                          kinds[kind].name);
    }
    terms->count++;
    return STATUS_OK;
}

/// The lines of a section, among which may be empty ones, up to as many as the header says.
static enum status read_terms(const struct structure *structure,
                              const struct lammps_data_terms *from,
                              const struct trajectory_frame *first, int kind,
                              struct structure_terms *terms) {
    struct word word[LAMMPS_DATA_WORDS];
    const size_t wanted = (size_t)kind + 4;
    for (const char *line = from->first; line && terms->count < from->count;
         line = mf_frame_next_line(first, line)) {
        const size_t words = mf_lammps_data_split(line, word);
        if (words > 0 && isalpha((unsigned char)*word[0].begin))
            break;
        if (words > 0 && words != wanted)
            return mf_frame_fail_line(first, line,
                                      "%zu words; expected in %ss %zu: number, type and %zu atoms",
                                      words, kinds[kind].name, wanted, wanted - 2);
        if (words > 0)
            TRY(read_term(structure, first, line, word, kind, from->types > 0, terms));
    }
    if (from->first == NULL || terms->count == from->count)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: expected \"%zu %ss\", found %zu: is the file complete?", first->file,
                          from->count, kinds[kind].name, terms->count);
}

static enum status describe_terms(struct structure *structure, const struct lammps_data *data,
                                  const struct trajectory_frame *first, int kind) {
    const struct lammps_data_terms *const from = &data->terms[kind];
    struct structure_terms *const terms = &structure->terms[kind];
    if (from->count > first->raw.size)
        return mf_frame_fail_line(first, (const char *)first->raw.data,
                                  "the file is too short for so many %ss", kinds[kind].name);
    terms->types = from->types;
    TRY_ARRAY(terms->name, (from->types > 0 ? from->types : from->count) + 2);
    TRY_ARRAY(terms->type, from->count);
    TRY_ARRAY(terms->atom, from->count * ((size_t)kind + 2));
    TRY(mf_lammps_data_names(first, from->labels, terms->types, terms->name));
    return read_terms(structure, from, first, kind, terms);
}

/// Molecules are what bonds join where all atoms are said to be of one.
static enum status find_molecules(struct structure *structure) {
    const struct structure_terms *const bonds = &structure->terms[0];
    bool told = !structure->has_molecules || bonds->count == 0;
    for (size_t k = 1; k < structure->atoms; k++)
        told = told || structure->atom[k].molecule != structure->atom[0].molecule;
    if (told)
        return STATUS_OK;
    for (size_t k = 0; k < structure->atoms; k++)
        structure->atom[k].molecule = 0;
    return mf_structure_join(structure, (const uint32_t(*)[2])(const void *)bonds->atom,
                             bonds->count);
}

/// "1 2", or "1 OW": an atom and its type, a number or a label; likewise its mass.
static enum status describe_template(struct structure *structure, const struct lammps_data *data,
                                     const struct trajectory_frame *first, double unit) {
    struct word word[LAMMPS_DATA_WORDS];
    const char *line = data->kinds, *mass = data->masses;
    int64_t id;
    structure->has_ids = structure->has_names = true;
    structure->names = STRUCTURE_TYPES;
    structure->has_masses = mass != NULL;
    for (size_t k = 0; k < structure->atoms; k++)
        structure->atom[k].id = (int64_t)k + 1;
    for (size_t k = 0; k < structure->atoms; k++, line = mf_frame_next_line(first, line)) {
        if (line == NULL || mf_lammps_data_split(line, word) != 2 ||
            !mf_words_integer(&word[0], &id) || id < 1 || (size_t)id > structure->atoms ||
            !mf_words_copy(&word[1], structure->atom[id - 1].name, STRUCTURE_NAME))
            return mf_frame_fail_line(first, line ? line : (const char *)first->raw.data,
                                      "expected an atom from 1 to %zu and its type",
                                      structure->atoms);
        if (!mf_words_integer(&word[1], &structure->atom[id - 1].type))
            structure->names = STRUCTURE_NAMES;
    }
    for (size_t k = 0; mass && k < structure->atoms; k++, mass = mf_frame_next_line(first, mass)) {
        double value = NAN;
        if (mf_lammps_data_split(mass, word) != 2 || !mf_words_integer(&word[0], &id) || id < 1 ||
            (size_t)id > structure->atoms || !mf_words_number(&word[1], &value))
            return mf_frame_fail_line(first, mass, "expected an atom and its mass");
        structure->atom[id - 1].mass = value * unit;
    }
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct structure *const structure = &trajectory->structure;
    struct lammps_data data;
    CLEARED_BY(clear_types) struct types types = {0};
    TRY(mf_lammps_data_read(&data, first));
    TRY(check(&data, first));
    if (data.units[0])
        TRY(mf_trajectory_found_units(trajectory, data.units));
    TRY(mf_structure_init(structure, data.atoms));
    if (data.atom) {
        TRY(read_types(&types, &data, first, trajectory->scale.mass));
        TRY(describe_atoms(structure, &data, first, &types));
        TRY(mf_trajectory_sort(trajectory, first));
    } else {
        TRY(describe_template(structure, &data, first, trajectory->scale.mass));
    }
    for (int kind = 0; kind < STRUCTURE_TERM_KINDS; kind++)
        TRY(describe_terms(structure, &data, first, kind));
    return find_molecules(structure);
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
            return mf_frame_fail_line(frame, line, "a coordinate is not a finite number%s",
                                      mf_words_number_hint(line));
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
    if (data.atom == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: a template of a molecule has no place in a box: give it by "
                              "--molecules",
                              frame->file);
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
    .summary =
        "LAMMPS, data file: one configuration of style atomic, charge, molecular or full; for "
        "--molecules also a template of \"molecule\"",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
