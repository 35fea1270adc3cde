// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS's compressed trajectories: XDR (RFC 4506), each frame with a header of its own. Since
// 2023 a second magic number says that the bytes of the coordinates are counted with 64 bits.
#include "trajectory/beads_file.h"
#include "trajectory/snapshot.h"
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"
#include "trajectory/xtc.h"

#include <math.h>

/// Magic number, atoms, step, time, box, atoms again; then, if packed: precision, least and most
/// coordinates, level, and how many bytes follow.
enum { MAGIC_LARGE = 2023, HEADER = 56, PACKING = 32 };

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 4 &&
           (binary_int(begin, true) == XTC_MAGIC || binary_int(begin, true) == MAGIC_LARGE);
}

static enum status check_header(const struct trajectory *trajectory, const unsigned char *header) {
    const struct source *const source = &trajectory->source;
    const int32_t atoms = binary_int(header + 4, true);
    if (!recognise(header, HEADER))
        return mf_source_fail_byte(source, "expected the beginning of a frame");
    if (atoms < 1 || atoms != binary_int(header + 52, true))
        return mf_source_fail_byte(source, "the number of atoms is not valid");
    if (source->frame > 0 && (size_t)atoms != trajectory->structure.atoms)
        return mf_source_fail_byte(source, "it has %d atoms, the first frame %zu", (int)atoms,
                                   trajectory->structure.atoms);
    return STATUS_OK;
}

/// What a frame that is packed says of its coordinates, and which of its bytes they are.
struct packed {
    struct xtc_packing packing;
    size_t begin;
    uint64_t bytes;
};

static struct packed read_packed(const unsigned char *raw) {
    const bool large = binary_int(raw, true) == MAGIC_LARGE;
    const unsigned char *const numbers = raw + HEADER, *const count = numbers + PACKING;
    struct packed packed = {
        .packing = {.atoms = binary_word(raw + 4, true),
                    .precision = binary_float(numbers, true),
                    .level = binary_int(numbers + 28, true)},
        .begin = HEADER + PACKING + (large ? 8 : 4),
        .bytes = large ? binary_long(count, true) : binary_word(count, true),
    };
    for (int d = 0; d < 3; d++) {
        packed.packing.min[d] = binary_int(numbers + 4 + 4 * d, true);
        packed.packing.max[d] = binary_int(numbers + 16 + 4 * d, true);
    }
    return packed;
}

/// The atoms promised are checked against the bytes that were there before there is memory for
/// them.
static enum status fetch_packed(struct source *source, struct bytes *raw) {
    const bool large = binary_int(raw->data, true) == MAGIC_LARGE;
    TRY(mf_source_take(source, raw, PACKING + (large ? 8 : 4)));
    const struct packed packed = read_packed(raw->data);
    if (packed.bytes == 0 || packed.bytes > INT64_MAX)
        return mf_source_fail_byte(source, "the number of bytes is not valid");
    TRY(mf_source_take(source, raw, (packed.bytes + 3) / 4 * 4));
    const char *const fault = mf_xtc_check(&packed.packing, packed.bytes);
    if (fault)
        return mf_source_fail_byte(source, "%s", fault);
    TRY(mf_source_capacity(raw, XTC_SLACK));
    memset(raw->data + raw->size, 0, XTC_SLACK);
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct source *const source = &trajectory->source;
    (void)more;
    TRY(mf_source_take(source, &frame->raw, HEADER));
    TRY(check_header(trajectory, frame->raw.data));
    const uint64_t atoms = binary_word(frame->raw.data + 4, true);
    return atoms <= XTC_FEW_ATOMS ? mf_source_take(source, &frame->raw, 12 * atoms)
                                  : fetch_packed(source, &frame->raw);
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    return mf_structure_init(&trajectory->structure, binary_word(first->raw.data + 4, true));
}

static enum status unpack(struct trajectory_frame *frame) {
    const struct packed packed = read_packed(frame->raw.data);
    size_t damage = 0;
    TRY(mf_frame_reserve(frame, packed.packing.atoms, false));
    const char *const fault = mf_xtc_unpack(&packed.packing, frame->raw.data + packed.begin,
                                            packed.bytes, frame->position, &damage);
    return fault ? mf_frame_fail_byte(frame, packed.begin + damage, "%s", fault) : STATUS_OK;
}

static enum status copy_few(struct trajectory_frame *frame, size_t atoms) {
    const unsigned char *const at = frame->raw.data + HEADER;
    TRY(mf_frame_reserve(frame, atoms, false));
    for (size_t k = 0; k < 3 * atoms; k++) {
        const double value = binary_float(at + 4 * k, true);
        if (!isfinite(value))
            return mf_frame_fail_byte(frame, HEADER + 4 * k, "a coordinate is not finite");
        frame->position[k / 3][k % 3] = value;
    }
    return STATUS_OK;
}

static double peek(const struct trajectory_frame *frame) {
    return binary_float(frame->raw.data + 12, true);
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const unsigned char *const header = frame->raw.data;
    const size_t atoms = binary_word(header + 4, true);
    double box[3][3];
    (void)trajectory;
    frame->step = binary_int(header + 8, true);
    frame->time = peek(frame);
    for (int k = 0; k < 9; k++)
        box[k / 3][k % 3] = binary_float(header + 16 + 4 * k, true);
    mf_frame_set_box(frame, box);
    return atoms <= XTC_FEW_ATOMS ? copy_few(frame, atoms) : unpack(frame);
}

// Writing -----------------------------------------------------------------------------------------

static void place_bead(const void *context, size_t n, double position[3]) {
    const struct beads_file *const file = context;
    memcpy(position, file->beads->position[file->order[n]], 3 * sizeof *position);
}

static enum status print(struct beads_file *file, const struct trajectory_frame *beads) {
    struct xtc_frame frame = {.atoms = beads->atoms,
                              .step = beads_file_step(file, beads),
                              .time = isnan(beads->time) ? (double)file->frames : beads->time,
                              .place = place_bead,
                              .context = file};
    memcpy(frame.box, beads->box, sizeof frame.box);
    for (size_t n = 0; n < beads->atoms; n++)
        for (int d = 0; d < 3; d++)
            if (!(fabs(beads->position[n][d]) < XTC_FARTHEST))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "%s: frame %zu: a bead is more than %g nm away, and .xtc has "
                                      "no room for that: --beads takes .xyz or .lammpstrj, too",
                                      beads->file, beads->number, XTC_FARTHEST);
    file->beads = beads;
    mf_xtc_write(&frame, file->output.stream);
    return STATUS_OK;
}

static const char *const extensions[] = {"xtc", NULL};

const struct trajectory_format mf_format_xtc = {
    .name = "xtc",
    .extensions = extensions,
    .summary = "GROMACS, compressed: positions; also the frames of 64-bit sizes since 2023",
    .recognise = recognise,
    .fetch = fetch,
    .peek = peek,
    .describe = describe,
    .decode = decode,
    .print = print,
};

// Snapshots of a scene ----------------------------------------------------------------------------

/// Of a nm in the snapshot's unit, and of a ps.
struct scale {
    double length, time;
};

static struct scale scale_of(const struct snapshot *snapshot) {
    const bool angstrom = snapshot->units && strcmp(snapshot->units, "real") == 0;
    return angstrom ? (struct scale){0.1, 1e-3} : (struct scale){1, 1};
}

/// The third coordinate is 0 in two dimensions.
static void place(const void *context, size_t particle, double position[3]) {
    const struct snapshot *const snapshot = context;
    const struct snapshot_column *column = snapshot->column;
    const double scale = scale_of(snapshot).length;
    while (strcmp(column->name, "position") != 0)
        column++;
    for (int d = 0; d < 3; d++)
        position[d] = d < column->components
                          ? scale * column->values[(size_t)d * snapshot->count + particle]
                          : 0;
}

static void print_snapshot(const struct snapshot *snapshot, FILE *stream) {
    const struct scale scale = scale_of(snapshot);
    struct xtc_frame frame = {.atoms = snapshot->count,
                              .step = (int64_t)snapshot->step,
                              .time = scale.time * snapshot->time,
                              .place = place,
                              .context = snapshot};
    for (int d = 0; d < 3; d++)
        frame.box[d][d] = d < snapshot->box.dimensions ? scale.length * snapshot->box.length[d] : 1;
    mf_xtc_write(&frame, stream);
}

const struct snapshot_format mf_format_xtc_snapshot = {
    .name = "xtc", .suffix = "xtc", .appended = true, .angstrom = true, .print = print_snapshot};
