// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS's .gro (manual, "gro file format"): columns of fixed width, of which the numbers are as
// wide as their decimal points are apart; any number of frames, one after the other.
#include "trajectory/beads_file.h"
#include "trajectory/trajectory.h"
#include "trajectory/words.h"

#include <math.h>
#include <string.h>

enum { NAME_WIDTH = 5, NUMBERS = 4 * NAME_WIDTH, LONGEST_ATOM = 256 };

/// How wide the numbers of an atom's line are; 0 if they are no such numbers.
static size_t find_width(const char *line) {
    const char *first = strlen(line) > NUMBERS ? strchr(line + NUMBERS, '.') : NULL;
    const char *second = first ? strchr(first + 1, '.') : NULL;
    const size_t width = second ? (size_t)(second - first) : 0;
    return width <= LONGEST_ATOM ? width : 0;
}

static bool is_atom(const char *line) {
    const struct word residue = mf_words_columns(line, 0, NAME_WIDTH);
    const struct word id = mf_words_columns(line, 3 * NAME_WIDTH, NAME_WIDTH);
    int64_t number;
    return mf_words_integer(&residue, &number) && mf_words_integer(&id, &number) &&
           find_width(line) > 0;
}

static bool recognise(const unsigned char *begin, size_t size) {
    char line[LONGEST_ATOM];
    struct word count;
    int64_t atoms;
    if (!mf_words_line(begin, size, 1, line, sizeof line))
        return false;
    count = mf_words_columns(line, 0, sizeof line);
    return mf_words_integer(&count, &atoms) && mf_words_line(begin, size, 2, line, sizeof line) &&
           is_atom(line);
}

/// Digits after the last point of a line.
static size_t count_decimals(const char *line) {
    const char *const point = strrchr(line, '.');
    return point ? strspn(point + 1, "0123456789") : 0;
}

/// The box is the last line of a file, whose end may be missing. The digits of its last number are
/// then all there if they are as many as those of the first.
static enum status fetch_box(struct source *source, struct bytes *raw) {
    const size_t begin = raw->size;
    bool there;
    TRY(mf_source_line(source, raw, &there));
    const char *const line = there ? (const char *)raw->data + begin : "";
    const char *const first = strchr(line, '.');
    const size_t decimals = first ? strspn(first + 1, "0123456789") : 0;
    if (there && (!source->broken_line || source->frame == 0 || count_decimals(line) == decimals))
        return STATUS_OK;
    return mf_source_fail_line(source, there ? "the file ends within this line"
                                             : "the file ends within the frame, the box is "
                                               "missing");
}

/// A title, the number of atoms, a line for each, and the box. An empty title may also be an empty
/// line at the end.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct source *const source = &trajectory->source;
    uint64_t atoms;
    TRY(mf_source_line(source, &frame->raw, more));
    const size_t title = frame->raw.size;
    if (title == 1) {
        TRY(mf_source_more(source, more));
        if (!*more)
            return STATUS_OK;
    }
    TRY(mf_source_lines(source, &frame->raw, 1));
    TRY(mf_trajectory_read_count(trajectory, (const char *)frame->raw.data + title, &atoms));
    TRY(mf_source_lines(source, &frame->raw, atoms));
    return fetch_box(source, &frame->raw);
}

/// The first atom's line, and how many there are, which fetch has seen to.
static const char *find_atoms(const struct trajectory_frame *frame, size_t *atoms) {
    const char *line = mf_frame_next_line(frame, (const char *)frame->raw.data), *rest = line;
    struct word word;
    int64_t count = 0;
    if (mf_words_next(&rest, &word) && mf_words_integer(&word, &count))
        *atoms = (size_t)count;
    return mf_frame_next_line(frame, line);
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    size_t atoms = 0;
    const char *line = find_atoms(first, &atoms);
    TRY(mf_structure_init(&trajectory->structure, atoms));
    struct structure *const structure = &trajectory->structure;
    structure->has_names = structure->has_residues = true;
    for (size_t k = 0; k < atoms; k++, line = mf_frame_next_line(first, line)) {
        struct structure_atom *const atom = &structure->atom[k];
        const struct word number = mf_words_columns(line, 0, NAME_WIDTH);
        const struct word residue = mf_words_columns(line, NAME_WIDTH, NAME_WIDTH);
        const struct word name = mf_words_columns(line, 2 * NAME_WIDTH, NAME_WIDTH);
        if (!mf_words_integer(&number, &atom->residue_number))
            return mf_frame_fail_line(first, line, "expected a residue number");
        mf_words_copy(&residue, atom->residue_name, STRUCTURE_NAME); // both are short enough
        mf_words_copy(&name, atom->name, STRUCTURE_NAME);
    }
    return STATUS_OK;
}

/// Three numbers of fixed width; false if one of them is none.
static bool read_vector(const char *line, size_t first, size_t width, double vector[3]) {
    for (size_t d = 0; d < 3; d++) {
        const struct word word = mf_words_columns(line, first + d * width, width);
        if (!mf_words_number(&word, &vector[d]))
            return false;
    }
    return true;
}

static enum status read_atoms(struct trajectory_frame *frame, const char **line) {
    const size_t width = find_width(*line), speeds = NUMBERS + 3 * width;
    for (size_t k = 0; k < frame->atoms; k++, *line = mf_frame_next_line(frame, *line)) {
        // A line may end early, and nothing after its end may be read.
        const size_t length = strnlen(*line, speeds + 3 * width);
        if (width == 0 || length <= NUMBERS ||
            !read_vector(*line, NUMBERS, width, frame->position[k]))
            return mf_frame_fail_line(frame, *line, "expected an atom position");
        if (frame->has_velocities &&
            (length <= speeds || !read_vector(*line, speeds, width, frame->velocity[k])))
            return mf_frame_fail_line(frame, *line, "expected an atom velocity");
    }
    return STATUS_OK;
}

/// Numbers of `decimals` digits after their points, which may stand so close that no blank is
/// left.
static size_t read_tight(const char *line, size_t decimals, double *values, size_t max) {
    size_t count = 0;
    const char *point;
    for (; count < max && (point = strchr(line, '.')); count++) {
        const size_t length = (size_t)(point - line) + 1 + decimals;
        const struct word word = mf_words_columns(line, 0, length);
        if (!mf_words_number(&word, &values[count]))
            return 0;
        line += strnlen(line, length);
    }
    return mf_words_count(line) == 0 ? count : 0;
}

/// Three numbers, or nine: the diagonal, then a_y a_z b_x b_z c_x c_y. They have as many decimals
/// as positions, but five at least. A fourth alone, which somebody has left there, GROMACS and
/// VOTCA do not read.
static enum status read_box(struct trajectory_frame *frame, const char *line, size_t width) {
    enum { FEWEST_DECIMALS = 5 };
    const size_t decimals =
        width > NAME_WIDTH + FEWEST_DECIMALS ? width - NAME_WIDTH : FEWEST_DECIMALS;
    size_t count = mf_words_count(line);
    count = count == 4 ? 3 : count;
    const char *rest = line;
    double v[9] = {0};
    if ((count != 3 && count != 9) || !mf_words_numbers(&rest, v, count))
        count = read_tight(line, decimals, v, sizeof v / sizeof *v);
    if (count != 3 && count != 9)
        return mf_frame_fail_line(frame, line, "expected the box, 3 or 9 numbers");
    const double box[3][3] = {{v[0], v[3], v[4]}, {v[5], v[1], v[6]}, {v[7], v[8], v[2]}};
    mf_frame_set_box(frame, box);
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    size_t atoms = 0;
    const char *line = find_atoms(frame, &atoms);
    (void)trajectory;
    mf_frame_read_title(frame, (const char *)frame->raw.data);
    const size_t width = find_width(line);
    const struct word speed = mf_words_columns(line, NUMBERS + 3 * width, LONGEST_ATOM);
    TRY(mf_frame_reserve(frame, atoms, speed.length > 0));
    TRY(read_atoms(frame, &line));
    return read_box(frame, line, width);
}

// Beads -------------------------------------------------------------------------------------------

/// Decimals of positions; velocities have one more.
enum { PRINTED_DECIMALS = 6, PRINTED_WIDTH = PRINTED_DECIMALS + 5 };

static void print_box(FILE *stream, const double box[3][3]) {
    static const int rest[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};
    bool tilted = false;
    for (int k = 0; k < 6; k++)
        tilted = tilted || box[rest[k][0]][rest[k][1]] != 0;
    for (int d = 0; d < 3; d++)
        fprintf(stream, " %.9f", box[d][d]);
    for (int k = 0; tilted && k < 6; k++)
        fprintf(stream, " %.9f", box[rest[k][0]][rest[k][1]]);
    fprintf(stream, "\n");
}

static enum status print(struct beads_file *file, const struct trajectory_frame *beads) {
    enum { MAX_NUMBER = 100000 }; // of five digits
    static const double farthest = 999;
    FILE *const stream = file->output.stream;
    fprintf(stream, "beads by mesofit");
    if (!isnan(beads->time))
        fprintf(stream, ", t= %.9g", beads->time);
    if (beads->step >= 0)
        fprintf(stream, " step= %lld", (long long)beads->step);
    fprintf(stream, "\n%zu\n", beads->atoms);
    for (size_t n = 0; n < beads->atoms; n++) {
        const size_t k = file->order[n];
        const struct mapping_bead *const bead = &file->mapping->bead[k];
        const char *const residue =
            file->structure->atom[file->mapping->atom[bead->first]].residue_name;
        const double *const x = beads->position[k], *const v = beads->velocity[k];
        if (!(fmax(fmax(fabs(x[0]), fabs(x[1])), fabs(x[2])) < farthest))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: a bead is more than %g nm away, and .gro has no "
                                  "room for that: --beads takes .xyz or .lammpstrj, too",
                                  beads->file, beads->number, farthest);
        fprintf(stream, "%5zu%-5.5s%5.5s%5zu", (bead->molecule + 1) % MAX_NUMBER,
                residue[0] ? residue : beads_file_type_name(file, k), beads_file_type_name(file, k),
                (n + 1) % MAX_NUMBER);
        for (int d = 0; d < 3; d++)
            fprintf(stream, "%*.*f", PRINTED_WIDTH, PRINTED_DECIMALS, x[d]);
        for (int d = 0; beads->has_velocities && d < 3; d++)
            fprintf(stream, "%*.*f", PRINTED_WIDTH, PRINTED_DECIMALS + 1, v[d]);
        fprintf(stream, "\n");
    }
    print_box(stream, beads->box);
    return STATUS_OK;
}

static const char *const extensions[] = {"gro", NULL};

const struct trajectory_format mf_format_gro = {
    .name = "gro",
    .extensions = extensions,
    .summary = "GROMACS, text: positions, velocities, names; one frame or many, of any precision",
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
    .print = print,
};
