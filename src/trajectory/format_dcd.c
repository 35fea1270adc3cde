// SPDX-License-Identifier: GPL-3.0-or-later
//
// DCD of CHARMM, NAMD and LAMMPS: records of Fortran, each between two counts of its bytes, in
// either order of bytes. Positions are single precision, in Å.
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"

#include <math.h>

enum { MARK = 4, HEADER = 84, CELL = 48, LARGEST_TITLE = 1 << 20 };

/// CHARMM's unit of time, sqrt(u Å²/(kcal/mol)) [ps].
static const double akma = 0.0488882129;

struct dcd {
    bool big;             ///< the most significant byte comes first
    bool has_cell, has_w; ///< each frame has a box; a fourth coordinate
    int32_t atoms, start, every;
    double time_step; ///< [ps]
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 8 && memcmp(begin + MARK, "CORD", 4) == 0 &&
           (binary_int(begin, true) == HEADER || binary_int(begin, false) == HEADER);
}

/// Take a record of `size` bytes, its counts among them.
static enum status take_record(struct source *source, struct bytes *raw, uint64_t size, bool big) {
    const size_t begin = raw->size;
    TRY(mf_source_take(source, raw, size + 2 * MARK));
    if (binary_word(raw->data + begin, big) != size ||
        binary_word(raw->data + begin + MARK + size, big) != size)
        return mf_source_fail_byte(source,
                                   "the preceding record does not have the expected %llu bytes",
                                   (unsigned long long)size);
    return STATUS_OK;
}

/// Numbers of the header: frames, first step, steps between frames, …; the fixed atoms stand 9th,
/// the time step 10th, whether there are boxes 11th, a fourth coordinate 12th and CHARMM's version
/// last. X-PLOR has no version, and its time step takes the 10th and the 11th place.
static enum status read_header(const struct source *source, const unsigned char *header,
                               struct dcd *dcd) {
    const unsigned char *const number = header + MARK + 4;
    dcd->big = binary_int(header, true) == HEADER;
    if (memcmp(header + MARK, "CORD", 4) != 0)
        return mf_source_fail_byte(source, "its first record is not that of positions");
    const bool charmm = binary_int(number + 4 * 19, dcd->big) != 0;
    dcd->start = binary_int(number + 4, dcd->big);
    dcd->every = binary_int(number + 8, dcd->big);
    dcd->has_cell = charmm && binary_int(number + 4 * 10, dcd->big) != 0;
    dcd->has_w = charmm && binary_int(number + 4 * 11, dcd->big) != 0;
    dcd->time_step = akma * (charmm ? binary_float(number + 4 * 9, dcd->big)
                                    : binary_double(number + 4 * 9, dcd->big));
    if (binary_int(number + 4 * 8, dcd->big) != 0)
        return mf_source_fail_byte(source,
                                   "it has fixed atoms, which are not read: write all atoms");
    return STATUS_OK;
}

static enum status skip_title(struct source *source, struct bytes *raw, bool big) {
    const size_t begin = raw->size;
    TRY(mf_source_take(source, raw, MARK));
    const uint32_t size = binary_word(raw->data + begin, big);
    if (size > LARGEST_TITLE)
        return mf_source_fail_byte(source, "its title has %u bytes", (unsigned)size);
    TRY(mf_source_take(source, raw, (uint64_t)size + MARK));
    if (binary_word(raw->data + begin + MARK + size, big) != size)
        return mf_source_fail_byte(source, "the title has the wrong length");
    return STATUS_OK;
}

static enum status open_file(struct trajectory *trajectory) {
    enum status status;
    struct source *const source = &trajectory->source;
    struct dcd *const dcd = trajectory->state;
    struct bytes raw = {0};
    CHECK(mf_source_take(source, &raw, MARK));
    CHECK(mf_source_take(source, &raw, HEADER + MARK));
    CHECK(read_header(source, raw.data, dcd));
    CHECK(skip_title(source, &raw, dcd->big));
    const size_t begin = raw.size;
    CHECK(take_record(source, &raw, 4, dcd->big));
    dcd->atoms = binary_int(raw.data + begin + MARK, dcd->big);
    if (dcd->atoms < 1 || dcd->atoms > INT32_MAX / 4)
        status = mf_source_fail_byte(source, "the number of atoms is not valid");
done:
    mf_source_free(&raw);
    return status;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct dcd *const dcd = trajectory->state;
    const uint64_t size = 4 * (uint64_t)dcd->atoms;
    (void)more;
    if (dcd->has_cell)
        TRY(take_record(&trajectory->source, &frame->raw, CELL, dcd->big));
    for (int d = 0; d < 3 + dcd->has_w; d++)
        TRY(take_record(&trajectory->source, &frame->raw, size, dcd->big));
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct dcd *const dcd = trajectory->state;
    (void)first;
    return mf_structure_init(&trajectory->structure, (size_t)dcd->atoms);
}

/// A, γ, B, β, α, C, of which the angles are cosines if none is above 1, else degrees.
static enum status read_cell(const struct dcd *dcd, struct trajectory_frame *frame, double scale) {
    double v[6], angle[3];
    const double none[3][3] = {{0}};
    for (size_t k = 0; k < 6; k++)
        v[k] = binary_double(frame->raw.data + MARK + 8 * k, dcd->big);
    const double length[] = {scale * v[0], scale * v[2], scale * v[5]};
    const double given[] = {v[4], v[3], v[1]};
    const bool cosines = fabs(v[1]) <= 1 && fabs(v[3]) <= 1 && fabs(v[4]) <= 1;
    for (int k = 0; k < 3; k++)
        angle[k] = !cosines ? given[k] : given[k] == 0 ? 90 : acos(given[k]) * (180 / acos(-1));
    mf_frame_set_box(frame, none);
    if (v[0] == 0 && v[2] == 0 && v[5] == 0)
        return STATUS_OK;
    if (!mf_frame_box_of_angles(frame, length, angle))
        return mf_frame_fail_byte(frame, MARK, "not a valid box: lengths %g %g %g, angles %g %g %g",
                                  v[0], v[2], v[5], v[4], v[3], v[1]);
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const struct dcd *const dcd = trajectory->state;
    const size_t atoms = (size_t)dcd->atoms, size = 4 * atoms + 2 * MARK;
    const size_t first = (dcd->has_cell ? CELL + 2 * MARK : 0) + MARK;
    const double none[3][3] = {{0}};
    frame->step = dcd->start + (int64_t)frame->number * dcd->every;
    if (!(trajectory->time_step > 0) && dcd->time_step > 0)
        frame->time = (double)frame->step * dcd->time_step;
    mf_frame_set_box(frame, none);
    if (dcd->has_cell)
        TRY(read_cell(dcd, frame, trajectory->scale.length));
    TRY(mf_frame_reserve(frame, atoms, false));
    for (size_t d = 0; d < 3; d++)
        for (size_t k = 0; k < atoms; k++) {
            const size_t place = first + d * size + 4 * k;
            const double value = binary_float(frame->raw.data + place, dcd->big);
            if (!isfinite(value))
                return mf_frame_fail_byte(frame, place, "a coordinate is not finite");
            frame->position[k][d] = value * trajectory->scale.length;
        }
    return STATUS_OK;
}

static const char *const extensions[] = {"dcd", NULL};

const struct trajectory_format mf_format_dcd = {
    .name = "dcd",
    .extensions = extensions,
    .summary =
        "CHARMM, NAMD, X-PLOR, LAMMPS: positions, with or without boxes, either order of bytes",
    .unit_source = TRAJECTORY_ANGSTROM,
    .state_size = sizeof(struct dcd),
    .recognise = recognise,
    .open = open_file,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
