// SPDX-License-Identifier: GPL-3.0-or-later
//
// DCD of CHARMM, NAMD and LAMMPS: records of Fortran, each between two counts of its bytes, of 4 or
// 8 bytes, in either order of bytes. Positions are single precision, in Å.
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

enum { HEADER = 84, CELL = 48, LONGEST_MARK = 8, TITLE_LINE = 80, LARGEST_TITLE = 1 << 20 };

/// CHARMM has boxes as symmetric matrices since this version; what others write has 24 or none.
enum { MATRIX_VERSION = 25 };

/// CHARMM's unit of time, sqrt(u Å²/(kcal/mol)) [ps].
static const double akma = 0.0488882129;

struct dcd {
    bool big;             ///< the most significant byte comes first
    size_t mark;          ///< bytes of the counts around records
    bool has_cell, has_w; ///< each frame has a box; a fourth coordinate
    int32_t atoms, fixed, start, every, version;
    double time_step;   ///< [ps]; by the units of the file if it is LAMMPS's
    struct bytes place; ///< of the atoms that move, from 1 on, if some do not
    struct bytes first; ///< positions in the first frame, x, y and z, if some do not move
};

static uint64_t read_mark(const unsigned char *at, size_t mark, bool big) {
    return mark == 4 ? binary_word(at, big) : binary_long(at, big);
}

/// How many bytes the counts have; 0 if there is no header.
static size_t find_mark(const unsigned char *begin, size_t size, bool *big) {
    for (size_t mark = 4; mark <= LONGEST_MARK; mark += 4)
        for (int k = 0; k < 2 && size >= mark + 4; k++) {
            *big = k == 1;
            if (memcmp(begin + mark, "CORD", 4) == 0 && read_mark(begin, mark, *big) == HEADER)
                return mark;
        }
    return 0;
}

static bool recognise(const unsigned char *begin, size_t size) {
    bool big;
    return find_mark(begin, size, &big) > 0;
}

/// Take a record of `size` bytes, its counts among them.
static enum status take_record(struct source *source, struct bytes *raw, uint64_t size,
                               const struct dcd *dcd) {
    const size_t begin = raw->size, mark = dcd->mark;
    TRY(mf_source_take(source, raw, size + 2 * mark));
    if (read_mark(raw->data + begin, mark, dcd->big) != size ||
        read_mark(raw->data + begin + mark + size, mark, dcd->big) != size)
        return mf_source_fail_byte(source,
                                   "the preceding record does not have the expected %llu bytes",
                                   (unsigned long long)size);
    return STATUS_OK;
}

/// Numbers of the header: frames, first step, steps between frames, …; the fixed atoms stand 9th,
/// the time step 10th, whether there are boxes 11th, a fourth coordinate 12th and CHARMM's version
/// last. X-PLOR has no version, and its time step takes the 10th and the 11th place.
static void read_header(const unsigned char *header, struct dcd *dcd) {
    const unsigned char *const number = header + dcd->mark + 4;
    dcd->version = binary_int(number + 4 * 19, dcd->big);
    const bool charmm = dcd->version != 0;
    dcd->start = binary_int(number + 4, dcd->big);
    dcd->every = binary_int(number + 8, dcd->big);
    dcd->fixed = binary_int(number + 4 * 8, dcd->big);
    dcd->has_cell = charmm && binary_int(number + 4 * 10, dcd->big) != 0;
    dcd->has_w = charmm && binary_int(number + 4 * 11, dcd->big) != 0;
    dcd->time_step =
        charmm ? binary_float(number + 4 * 9, dcd->big) : binary_double(number + 4 * 9, dcd->big);
}

/// Whether what follows a title of `size` bytes is the number of atoms.
static bool title_ends(const unsigned char *begin, size_t there, uint64_t size,
                       const struct dcd *dcd) {
    const size_t mark = dcd->mark;
    if (size > there || size + 3 * mark + 4 > there)
        return false;
    const unsigned char *const next = begin + size + mark;
    return read_mark(next, mark, dcd->big) == 4 && read_mark(next + mark + 4, mark, dcd->big) == 4;
}

/// The unit of the time step is CHARMM's, but LAMMPS, which says so in its title, writes its own.
/// The count around a title may be that of other lines than the title says and has: it then ends
/// where the number of atoms begins.
/// @param[in] unit  of LAMMPS's time [ps]
static enum status read_title(struct source *source, struct bytes *raw, double unit,
                              struct dcd *dcd) {
    static const char lammps[] = "Written by LAMMPS";
    const unsigned char *next;
    size_t there;
    raw->size = 0;
    TRY(mf_source_take(source, raw, dcd->mark));
    const uint64_t told = read_mark(raw->data, dcd->mark, dcd->big);
    TRY(mf_source_peek(source, &next, &there));
    const uint64_t lines = there >= 4 ? binary_word(next, dcd->big) : 0;
    const uint64_t of_lines = 4 + lines * TITLE_LINE;
    const bool odd = of_lines != told && !title_ends(next, there, told, dcd) &&
                     title_ends(next, there, of_lines, dcd);
    const uint64_t size = odd ? of_lines : told;
    if (size > LARGEST_TITLE)
        return mf_source_fail_byte(source, "its title has %llu bytes", (unsigned long long)size);
    raw->size = 0;
    TRY(mf_source_take(source, raw, size + dcd->mark));
    if (!odd && read_mark(raw->data + size, dcd->mark, dcd->big) != size)
        return mf_source_fail_byte(source, "the title has the wrong length");
    const bool own = size >= 4 + TITLE_LINE && memcmp(raw->data + 4, lammps, strlen(lammps)) == 0;
    dcd->time_step *= own ? unit : akma;
    return STATUS_OK;
}

/// Which atoms move, where some do not: frames after the first have no others.
static enum status take_places(struct source *source, struct dcd *dcd) {
    const size_t free_atoms = (size_t)(dcd->atoms - dcd->fixed);
    TRY(take_record(source, &dcd->place, 4 * (uint64_t)free_atoms, dcd));
    for (size_t k = 0; k < free_atoms; k++) {
        const int32_t place = binary_int(dcd->place.data + dcd->mark + 4 * k, dcd->big);
        if (place < 1 || place > dcd->atoms)
            return mf_source_fail_byte(source, "a free atom has the number %ld of %ld", (long)place,
                                       (long)dcd->atoms);
    }
    return STATUS_OK;
}

static enum status open_file(struct trajectory *trajectory) {
    enum status status;
    struct source *const source = &trajectory->source;
    struct dcd *const dcd = trajectory->state;
    struct bytes raw = {0};
    const unsigned char *begin;
    size_t there;
    CHECK(mf_source_peek(source, &begin, &there));
    dcd->mark = find_mark(begin, there, &dcd->big);
    if (dcd->mark == 0) {
        status = mf_source_fail_byte(source, "its first record is not that of positions");
        goto done;
    }
    CHECK(take_record(source, &raw, HEADER, dcd));
    read_header(raw.data, dcd);
    CHECK(read_title(source, &raw, trajectory->scale.time, dcd));
    raw.size = 0;
    CHECK(take_record(source, &raw, 4, dcd));
    dcd->atoms = binary_int(raw.data + dcd->mark, dcd->big);
    if (dcd->atoms < 1 || dcd->atoms > INT32_MAX / 4 || dcd->fixed < 0 || dcd->fixed >= dcd->atoms)
        status = mf_source_fail_byte(source, "the number of atoms is not valid");
    else if (dcd->fixed > 0)
        status = take_places(source, dcd);
done:
    mf_source_free(&raw);
    return status;
}

static void close_file(struct trajectory *trajectory) {
    struct dcd *const dcd = trajectory->state;
    mf_source_free(&dcd->place);
    mf_source_free(&dcd->first);
}

/// Atoms that a frame has positions of.
static size_t moving(const struct dcd *dcd, size_t frame) {
    return (size_t)(frame > 0 ? dcd->atoms - dcd->fixed : dcd->atoms);
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct dcd *const dcd = trajectory->state;
    struct source *const source = &trajectory->source;
    const uint64_t size = 4 * (uint64_t)moving(dcd, source->frame);
    (void)more;
    if (dcd->has_cell)
        TRY(take_record(source, &frame->raw, CELL, dcd));
    const size_t begin = frame->raw.size;
    for (int d = 0; d < 3 + dcd->has_w; d++)
        TRY(take_record(source, &frame->raw, size, dcd));
    if (source->frame > 0 || dcd->fixed == 0)
        return STATUS_OK;
    TRY(mf_source_capacity(&dcd->first, frame->raw.size - begin));
    dcd->first.size = frame->raw.size - begin;
    memcpy(dcd->first.data, frame->raw.data + begin, dcd->first.size);
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct dcd *const dcd = trajectory->state;
    (void)first;
    return mf_structure_init(&trajectory->structure, (size_t)dcd->atoms);
}

/// The symmetric matrix of the box's vectors, by rows up to the diagonal; false if the numbers are
/// no such matrix, which has positive principal minors.
static bool read_matrix(struct trajectory_frame *frame, const double v[6], double scale) {
    const double box[3][3] = {{scale * v[0], scale * v[1], scale * v[3]},
                              {scale * v[1], scale * v[2], scale * v[4]},
                              {scale * v[3], scale * v[4], scale * v[5]}};
    const double minor = v[0] * v[2] - v[1] * v[1];
    const double whole =
        v[5] * minor - v[0] * v[4] * v[4] - v[2] * v[3] * v[3] + 2 * v[1] * v[3] * v[4];
    if (!(v[0] > 0 && minor > 0 && whole > 0))
        return false;
    mf_frame_set_box(frame, box);
    return frame->has_box;
}

/// A, γ, B, β, α, C, of which the angles are cosines if none is above 1, else degrees; or CHARMM's
/// matrix.
static enum status read_cell(const struct dcd *dcd, struct trajectory_frame *frame, double scale) {
    double v[6], angle[3];
    const double none[3][3] = {{0}};
    for (size_t k = 0; k < 6; k++)
        v[k] = binary_double(frame->raw.data + dcd->mark + 8 * k, dcd->big);
    const double length[] = {scale * v[0], scale * v[2], scale * v[5]};
    const double given[] = {v[4], v[3], v[1]};
    const bool cosines = fabs(v[1]) <= 1 && fabs(v[3]) <= 1 && fabs(v[4]) <= 1;
    for (int k = 0; k < 3; k++)
        angle[k] = !cosines ? given[k] : given[k] == 0 ? 90 : acos(given[k]) * (180 / acos(-1));
    mf_frame_set_box(frame, none);
    if (v[0] == 0 && v[2] == 0 && v[5] == 0)
        return STATUS_OK;
    if (dcd->version >= MATRIX_VERSION && read_matrix(frame, v, scale))
        return STATUS_OK;
    if (!mf_frame_box_of_angles(frame, length, angle))
        return mf_frame_fail_byte(frame, dcd->mark,
                                  "not a valid box: lengths %g %g %g, angles %g %g %g", v[0], v[2],
                                  v[5], v[4], v[3], v[1]);
    return STATUS_OK;
}

/// Coordinates of `atoms` atoms at a byte of a frame's, whose first begins at `at` of its raw ones;
/// `place`: where they belong, from 1 on, or NULL.
static enum status read_positions(const struct dcd *dcd, struct trajectory_frame *frame,
                                  const unsigned char *from, size_t at, size_t atoms, double scale,
                                  const unsigned char *place) {
    const size_t size = 4 * atoms + 2 * dcd->mark;
    for (size_t d = 0; d < 3; d++)
        for (size_t k = 0; k < atoms; k++) {
            const size_t byte = d * size + dcd->mark + 4 * k;
            const double value = binary_float(from + byte, dcd->big);
            const size_t atom = place ? (size_t)binary_int(place + 4 * k, dcd->big) - 1 : k;
            if (!isfinite(value))
                return mf_frame_fail_byte(frame, at + byte, "a coordinate is not finite");
            frame->position[atom][d] = value * scale;
        }
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const struct dcd *const dcd = trajectory->state;
    const size_t atoms = (size_t)dcd->atoms, begin = dcd->has_cell ? CELL + 2 * dcd->mark : 0;
    const bool partly = frame->number > 0 && dcd->fixed > 0;
    const double none[3][3] = {{0}}, scale = trajectory->scale.length;
    frame->step = dcd->start + (int64_t)frame->number * dcd->every;
    if (!(trajectory->time_step > 0) && dcd->time_step > 0)
        frame->time = (double)frame->step * dcd->time_step;
    mf_frame_set_box(frame, none);
    if (dcd->has_cell)
        TRY(read_cell(dcd, frame, scale));
    TRY(mf_frame_reserve(frame, atoms, false));
    if (partly)
        TRY(read_positions(dcd, frame, dcd->first.data, 0, atoms, scale, NULL));
    return read_positions(dcd, frame, frame->raw.data + begin, begin, moving(dcd, frame->number),
                          scale, partly ? dcd->place.data + dcd->mark : NULL);
}

static const char *const extensions[] = {"dcd", NULL};

const struct trajectory_format mf_format_dcd = {
    .name = "dcd",
    .extensions = extensions,
    .summary =
        "CHARMM, NAMD, X-PLOR, LAMMPS: positions, with or without boxes, fixed atoms, any markers",
    .unit_source = TRAJECTORY_ANGSTROM,
    .state_size = sizeof(struct dcd),
    .recognise = recognise,
    .open = open_file,
    .close = close_file,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
