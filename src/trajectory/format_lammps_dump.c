// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS's dumps in text: styles atom and custom, with any columns in any order. Atoms are sorted
// by their ids, since LAMMPS writes them as its processors have them.
#include "trajectory/beads_file.h"
#include "trajectory/elements.h"
#include "trajectory/snapshot.h"
#include "trajectory/lammps_dump.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 6 && memcmp(begin, "ITEM: ", 6) == 0;
}

/// Lines after an item but the atoms.
static uint64_t lines_after(const char *item) {
    return strncmp(item, "ITEM: BOX BOUNDS", 16) == 0 ? 3 : 1;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    static const char count[] = "ITEM: NUMBER OF ATOMS", table[] = "ITEM: ATOMS";
    struct source *const source = &trajectory->source;
    struct bytes *const raw = &frame->raw;
    uint64_t atoms = 0;
    (void)more;
    for (;;) {
        const size_t begin = raw->size;
        TRY(mf_source_lines(source, raw, 1));
        if (strncmp((const char *)raw->data + begin, "ITEM: ", 6) != 0)
            return mf_source_fail_line(source, "expected \"ITEM:\"");
        if (strncmp((const char *)raw->data + begin, table, sizeof table - 1) == 0)
            break;
        const size_t value = raw->size;
        TRY(mf_source_lines(source, raw, lines_after((const char *)raw->data + begin)));
        if (strncmp((const char *)raw->data + begin, count, sizeof count - 1) == 0)
            TRY(mf_trajectory_read_count(trajectory, (const char *)raw->data + value, &atoms));
    }
    if (atoms == 0)
        return mf_source_fail_line(source, "expected the number of atoms before the atoms");
    return mf_source_lines(source, raw, atoms);
}

static bool integer_at(const struct lammps_dump *dump, const struct word *word,
                       enum lammps_column column, int64_t *value) {
    return dump->column[column] < 0 || mf_words_integer(&word[dump->column[column]], value);
}

/// The column with the name of an atom: the label of its type, or else its element, or the number
/// of its type; −1: there is none.
static int name_column(const struct lammps_dump *dump) {
    const int *const column = dump->column;
    return column[LAMMPS_LABEL] >= 0     ? column[LAMMPS_LABEL]
           : column[LAMMPS_ELEMENT] >= 0 ? column[LAMMPS_ELEMENT]
                                         : column[LAMMPS_TYPE];
}

static enum status describe_atom(const struct lammps_dump *dump,
                                 const struct trajectory_frame *first, const char *line,
                                 const struct trajectory_scale *scale,
                                 struct structure_atom *atom) {
    struct word word[LAMMPS_MAX_COLUMNS];
    const int *const column = dump->column;
    TRY(mf_lammps_dump_split(dump, first, line, word));
    if (!integer_at(dump, word, LAMMPS_ID, &atom->id) ||
        !integer_at(dump, word, LAMMPS_TYPE, &atom->type) ||
        !integer_at(dump, word, LAMMPS_MOLECULE, &atom->molecule))
        return mf_frame_fail_line(first, line, "expected integers for id, type and mol");
    if (column[LAMMPS_MASS] >= 0 && !mf_words_number(&word[column[LAMMPS_MASS]], &atom->mass))
        return mf_frame_fail_line(first, line, "expected a number for the mass");
    atom->mass *= scale->mass;
    const int name = name_column(dump);
    if (name >= 0 && !mf_words_copy(&word[name], atom->name, STRUCTURE_NAME))
        return mf_frame_fail_line(first, line, "a name of more than %d characters",
                                  STRUCTURE_NAME - 1);
    if (column[LAMMPS_ELEMENT] >= 0 &&
        !mf_words_copy(&word[column[LAMMPS_ELEMENT]], atom->element, STRUCTURE_NAME))
        return mf_frame_fail_line(first, line, "an element of more than %d characters",
                                  STRUCTURE_NAME - 1);
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct structure *const structure = &trajectory->structure;
    struct lammps_dump dump;
    char units[32];
    TRY(mf_lammps_dump_read(&dump, first));
    if (dump.units) {
        const char *rest = dump.units;
        struct word name;
        if (!mf_words_next(&rest, &name) || !mf_words_copy(&name, units, sizeof units))
            return mf_frame_fail_line(first, dump.units, "expected the units");
        TRY(mf_trajectory_found_units(trajectory, units));
    }
    TRY(mf_structure_init(structure, dump.atoms));
    structure->has_ids = dump.column[LAMMPS_ID] >= 0;
    structure->has_types = dump.column[LAMMPS_TYPE] >= 0;
    structure->has_molecules = dump.column[LAMMPS_MOLECULE] >= 0;
    structure->has_elements = dump.column[LAMMPS_ELEMENT] >= 0;
    structure->has_masses = dump.column[LAMMPS_MASS] >= 0;
    const bool has_labels = dump.column[LAMMPS_LABEL] >= 0;
    structure->has_names = has_labels || structure->has_elements || structure->has_types;
    structure->names = has_labels                ? STRUCTURE_NAMES
                       : structure->has_elements ? STRUCTURE_ELEMENTS
                                                 : STRUCTURE_TYPES;
    const char *line = dump.first;
    for (size_t k = 0; k < dump.atoms; k++, line = mf_frame_next_line(first, line))
        TRY(describe_atom(&dump, first, line, &trajectory->scale, &structure->atom[k]));
    return structure->has_ids ? mf_trajectory_sort(trajectory, first) : STATUS_OK;
}

/// Which of the columns give positions, those first that know the images.
static enum status find_positions(const struct lammps_dump *dump,
                                  const struct trajectory_frame *frame, enum lammps_column *from) {
    static const enum lammps_column known[] = {LAMMPS_XU, LAMMPS_XSU, LAMMPS_X, LAMMPS_XS};
    for (int k = 0; k < 4; k++) {
        const int *const column = &dump->column[known[k]];
        *from = known[k];
        if (column[0] >= 0 && column[1] >= 0 && column[2] >= 0)
            return STATUS_OK;
    }
    return mf_frame_fail_line(frame, (const char *)frame->raw.data,
                              "there are no positions: columns x y z, xs ys zs, xu yu zu or xsu "
                              "ysu zsu (two dimensions are not measured)");
}

static bool has_vector(const struct lammps_dump *dump, enum lammps_column first) {
    const int *const column = &dump->column[first];
    return column[0] >= 0 && column[1] >= 0 && column[2] >= 0;
}

static bool read_vector(const struct lammps_dump *dump, const struct word *word,
                        enum lammps_column first, double vector[3]) {
    for (int d = 0; d < 3; d++)
        if (!mf_words_number(&word[dump->column[first + d]], &vector[d]))
            return false;
    return true;
}

/// vector += Σ_d number[d] box[d]
static void add_box(const struct lammps_dump *dump, const double number[3], double vector[3]) {
    for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++)
            vector[e] += number[d] * dump->box[d][e];
}

static bool read_position(const struct lammps_dump *dump, const struct word *word,
                          enum lammps_column from, double position[3]) {
    double number[3];
    if (!read_vector(dump, word, from, number))
        return false;
    const bool scaled = from == LAMMPS_XS || from == LAMMPS_XSU;
    memcpy(position, scaled ? dump->origin : number, sizeof number);
    if (scaled)
        add_box(dump, number, position);
    if ((from == LAMMPS_X || from == LAMMPS_XS) && has_vector(dump, LAMMPS_IX)) {
        if (!read_vector(dump, word, LAMMPS_IX, number))
            return false;
        add_box(dump, number, position);
    }
    return true;
}

/// Atoms keep their types, or else their names: also without ids, where LAMMPS changes the order of
/// rows as it sorts atoms.
static enum status check_type(const struct trajectory *trajectory,
                              const struct trajectory_frame *frame, const struct lammps_dump *dump,
                              const struct word *word, const char *line, size_t atom) {
    const struct structure *const structure = &trajectory->structure;
    const struct structure_atom *const first = &structure->atom[atom];
    const bool numbers = structure->has_types;
    const int column = numbers ? dump->column[LAMMPS_TYPE] : name_column(dump);
    int64_t type;
    if (column < 0 || !structure->has_names ||
        (numbers ? mf_words_integer(&word[column], &type) && type == first->type
                 : mf_words_same(&word[column], first->name)))
        return STATUS_OK;
    return mf_trajectory_fail_type(trajectory, frame, line, atom, &word[column]);
}

/// Where the atom stands among the structure's, each once.
static enum status find_atom(const struct trajectory *trajectory, struct trajectory_frame *frame,
                             const struct lammps_dump *dump, const struct word *word,
                             const char *line, size_t *atom) {
    int64_t id;
    if (!trajectory->structure.has_ids)
        return STATUS_OK;
    if (dump->column[LAMMPS_ID] < 0 || !mf_words_integer(&word[dump->column[LAMMPS_ID]], &id))
        return mf_frame_fail_line(frame, line, "expected an atom id");
    return mf_trajectory_find_atom(trajectory, frame, line, id, atom);
}

static void scale_vector(double vector[3], double factor) {
    for (int d = 0; d < 3; d++)
        vector[d] *= factor;
}

/// What atoms may have beside their positions.
static enum status read_more(const struct trajectory *trajectory, struct trajectory_frame *frame,
                             const struct lammps_dump *dump, const struct word *word,
                             const char *line, size_t atom) {
    if (frame->has_velocities) {
        if (!read_vector(dump, word, LAMMPS_VX, frame->velocity[atom]))
            return mf_frame_fail_line(frame, line, "a velocity is not a finite number");
        scale_vector(frame->velocity[atom], trajectory->scale.speed);
    }
    if (frame->has_forces) {
        if (!read_vector(dump, word, LAMMPS_FX, frame->force[atom]))
            return mf_frame_fail_line(frame, line, "a force is not a finite number");
        scale_vector(frame->force[atom], trajectory->scale.force);
    }
    return STATUS_OK;
}

static enum status read_atoms(const struct trajectory *trajectory, struct trajectory_frame *frame,
                              const struct lammps_dump *dump) {
    struct word word[LAMMPS_MAX_COLUMNS];
    enum lammps_column from;
    TRY(find_positions(dump, frame, &from));
    frame->unwrapped = from == LAMMPS_XU || from == LAMMPS_XSU || has_vector(dump, LAMMPS_IX);
    const char *line = dump->first;
    for (size_t k = 0; k < dump->atoms; k++, line = mf_frame_next_line(frame, line)) {
        size_t atom = k;
        TRY(mf_lammps_dump_split(dump, frame, line, word));
        TRY(find_atom(trajectory, frame, dump, word, line, &atom));
        TRY(check_type(trajectory, frame, dump, word, line, atom));
        double *const position = frame->position[atom];
        if (!read_position(dump, word, from, position))
            return mf_frame_fail_line(frame, line, "a coordinate is not a finite number%s",
                                      mf_words_number_hint(line));
        scale_vector(position, trajectory->scale.length);
        TRY(read_more(trajectory, frame, dump, word, line, atom));
    }
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    struct lammps_dump dump;
    double box[3][3];
    TRY(mf_lammps_dump_read(&dump, frame));
    frame->step = dump.step;
    frame->time = dump.time * trajectory->scale.time;
    for (int k = 0; k < 9; k++)
        box[k / 3][k % 3] = dump.box[k / 3][k % 3] * trajectory->scale.length;
    mf_frame_set_box(frame, box);
    for (int d = 0; d < 3; d++)
        frame->periodic[d] = frame->has_box && dump.periodic[d];
    TRY(mf_frame_reserve(frame, dump.atoms, has_vector(&dump, LAMMPS_VX)));
    if (trajectory->forces && has_vector(&dump, LAMMPS_FX))
        TRY(mf_frame_reserve_forces(frame));
    TRY(mf_trajectory_begin_atoms(trajectory, frame));
    return read_atoms(trajectory, frame, &dump);
}

// Beads -------------------------------------------------------------------------------------------

/// Bounds of a tilted box are those of the upright one around it.
static enum status print_box(FILE *stream, const struct trajectory_frame *beads) {
    const double(*const box)[3] = (const double(*)[3])beads->box;
    const double xy = box[1][0], xz = box[2][0], yz = box[2][1];
    const double low[3] = {fmin(fmin(0, xy), fmin(xz, xy + xz)), fmin(0, yz), 0};
    const double high[3] = {fmax(fmax(0, xy), fmax(xz, xy + xz)), fmax(0, yz), 0};
    const double tilt[3] = {xy, xz, yz};
    const bool tilted = xy != 0 || xz != 0 || yz != 0;
    if (box[0][1] != 0 || box[0][2] != 0 || box[1][2] != 0)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: frame %zu: a dump has boxes with a along x and b in the plane of "
            "x and y: --beads takes .xyz or .gro, too",
            beads->file, beads->number);
    fprintf(stream, "ITEM: BOX BOUNDS%s", tilted ? " xy xz yz" : "");
    for (int d = 0; d < 3; d++)
        fprintf(stream, beads->periodic[d] ? " pp" : " ff");
    for (int d = 0; d < 3; d++) {
        fprintf(stream, "\n%.9g %.9g", low[d] * beads_file_angstrom,
                (box[d][d] + high[d]) * beads_file_angstrom);
        if (tilted)
            fprintf(stream, " %.9g", tilt[d] * beads_file_angstrom);
    }
    fprintf(stream, "\n");
    return STATUS_OK;
}

static enum status print(struct beads_file *file, const struct trajectory_frame *beads) {
    const bool masses = mf_beads_file_has_masses(file);
    FILE *const stream = file->output.stream;
    fprintf(stream, "ITEM: TIMESTEP\n%lld\nITEM: NUMBER OF ATOMS", beads_file_step(file, beads));
    if (!isnan(beads->time))
        fprintf(stream, " time=%.9g", beads->time * beads_file_femtosecond);
    fprintf(stream, " units=real\n%zu\n", beads->atoms);
    TRY(print_box(stream, beads));
    fprintf(stream, "ITEM: ATOMS id mol type element typelabel%s%s%s\n", masses ? " mass" : "",
            beads->unwrapped ? " xu yu zu" : " x y z", beads->has_velocities ? " vx vy vz" : "");
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        const struct mapping_bead *const bead = &file->mapping->bead[k];
        const char *const name = beads_file_type_name(file, k);
        fprintf(stream, "%zu %zu %zu %s %s", n + 1, bead->molecule + 1, bead->type + 1,
                mf_elements_symbol(name), name);
        if (masses)
            fprintf(stream, " %.9g", bead->mass);
        beads_file_print_vector(stream, beads->position[k], beads_file_angstrom);
        if (beads->has_velocities)
            beads_file_print_vector(stream, beads->velocity[k],
                                    beads_file_angstrom_per_femtosecond);
        fprintf(stream, "\n");
    }
    return STATUS_OK;
}

static const char *const extensions[] = {"lammpstrj", "dump", "lammpsdump", NULL};

const struct trajectory_format mf_format_lammps_dump = {
    .name = "lammps-dump",
    .extensions = extensions,
    .summary =
        "LAMMPS, dump in text, atom or custom: any columns, x xs xu xsu, ix, vx, fx, id type mol "
        "element typelabel mass",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .unsorted = true,
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
    .print = print,
};

// Snapshots of a scene ----------------------------------------------------------------------------

/// Three components, of which the third is 0 in two dimensions.
static void print_vector(const struct snapshot *snapshot, const struct snapshot_column *column,
                         size_t particle, FILE *stream) {
    for (int c = 0; c < 3; c++)
        fprintf(stream, " %.10g",
                c < column->components ? column->values[(size_t)c * snapshot->count + particle]
                                       : 0);
}

static void print_snapshot_heading(const struct snapshot *snapshot, FILE *stream) {
    const struct box *box = &snapshot->box;
    fprintf(stream, "ITEM: TIMESTEP\n%llu\nITEM: NUMBER OF ATOMS time=%.10g",
            (unsigned long long)snapshot->step, snapshot->time);
    if (snapshot->units)
        fprintf(stream, " units=%s", snapshot->units);
    fprintf(stream, "\n%zu\n", snapshot->count);
    fprintf(stream, "ITEM: BOX BOUNDS pp pp pp\n");
    for (int d = 0; d < box->dimensions; d++)
        fprintf(stream, "0 %.10g\n", box->length[d]);
    if (box->dimensions == 2) // as LAMMPS has two
        fprintf(stream, "-0.5 0.5\n");
    fprintf(stream, "ITEM: ATOMS id%s type element typelabel%s x y z ix iy iz vx vy vz fx fy fz\n",
            mf_snapshot_find(snapshot, "molecule") ? " mol" : "",
            mf_snapshot_has_masses(snapshot) ? " mass" : "");
}

static void print_snapshot(const struct snapshot *snapshot, FILE *stream) {
    const struct snapshot_column *position = mf_snapshot_find(snapshot, "position"),
                                 *image = mf_snapshot_find(snapshot, "image"),
                                 *velocity = mf_snapshot_find(snapshot, "velocity"),
                                 *force = mf_snapshot_find(snapshot, "force"),
                                 *molecule = mf_snapshot_find(snapshot, "molecule");
    print_snapshot_heading(snapshot, stream);
    for (size_t k = 0; k < snapshot->count; k++) {
        fprintf(stream, "%zu", k + 1);
        if (molecule)
            fprintf(stream, " %.0f", molecule->values[k]);
        const char *const name = mf_snapshot_type_name(snapshot, k);
        fprintf(stream, " %d %s %s", mf_snapshot_type(snapshot, k) + 1, mf_elements_symbol(name),
                name);
        if (mf_snapshot_has_masses(snapshot))
            fprintf(stream, " %.10g", mf_snapshot_mass(snapshot, k));
        print_vector(snapshot, position, k, stream);
        print_vector(snapshot, image, k, stream);
        print_vector(snapshot, velocity, k, stream);
        print_vector(snapshot, force, k, stream);
        fprintf(stream, "\n");
    }
}

const struct snapshot_format mf_format_lammps_dump_snapshot = {.name = "lammps-dump",
                                                               .suffix = "lammpstrj",
                                                               .appended = true,
                                                               .angstrom = true,
                                                               .print = print_snapshot};
