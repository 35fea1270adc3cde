// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS's compressed trajectories: XDR (RFC 4506), each frame with a header of its own. Since
// 2023 a second magic number says that the bytes of the coordinates are counted with 64 bits.
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"
#include "trajectory/xtc_coordinates.h"

#include <math.h>

/// Magic number, atoms, step, time, box, atoms again; then, if packed: precision, least and most
/// coordinates, level, and how many bytes follow.
enum { MAGIC = 1995, MAGIC_LARGE = 2023, HEADER = 56, PACKING = 32, FEW_ATOMS = 9 };

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 4 &&
           (binary_int(begin, true) == MAGIC || binary_int(begin, true) == MAGIC_LARGE);
}

static enum status check_header(const struct trajectory *trajectory, const unsigned char *header) {
    const struct source *const source = &trajectory->source;
    const int32_t atoms = binary_int(header + 4, true);
    if (!recognise(header, HEADER))
        return mf_source_fail_byte(source, "here should begin a frame, and none does");
    if (atoms < 1 || atoms != binary_int(header + 52, true))
        return mf_source_fail_byte(source, "its number of atoms is none");
    if (source->frame > 0 && (size_t)atoms != trajectory->structure.atoms)
        return mf_source_fail_byte(source, "it has %d atoms, the first frame %zu", (int)atoms,
                                   trajectory->structure.atoms);
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct source *const source = &trajectory->source;
    struct bytes *const raw = &frame->raw;
    (void)more;
    TRY(mf_source_take(source, raw, HEADER));
    TRY(check_header(trajectory, raw->data));
    const uint64_t atoms = (uint64_t)binary_int(raw->data + 4, true);
    const bool large = binary_int(raw->data, true) == MAGIC_LARGE;
    if (atoms <= FEW_ATOMS)
        return mf_source_take(source, raw, 12 * atoms);
    TRY(mf_source_take(source, raw, PACKING + (large ? 8 : 4)));
    const unsigned char *const count = raw->data + HEADER + PACKING;
    const uint64_t bytes = large ? binary_long(count, true) : binary_word(count, true);
    if (bytes == 0 || bytes > UINT64_MAX - 3)
        return mf_source_fail_byte(source, "its number of bytes is none");
    TRY(mf_source_take(source, raw, (bytes + 3) / 4 * 4));
    TRY(mf_source_room(raw, XTC_SLACK));
    memset(raw->data + raw->size, 0, XTC_SLACK);
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    return mf_structure_init(&trajectory->structure, binary_word(first->raw.data + 4, true));
}

static enum status unpack(struct trajectory_frame *frame, size_t atoms) {
    const unsigned char *const header = frame->raw.data + HEADER;
    const bool large = binary_int(frame->raw.data, true) == MAGIC_LARGE;
    const size_t begin = HEADER + PACKING + (large ? 8 : 4);
    const unsigned char *const count = header + PACKING;
    const size_t bytes = large ? binary_long(count, true) : binary_word(count, true);
    struct xtc_packing packing = {.atoms = atoms,
                                  .precision = binary_float(header, true),
                                  .level = binary_int(header + 28, true)};
    for (int d = 0; d < 3; d++) {
        packing.least[d] = binary_int(header + 4 + 4 * d, true);
        packing.most[d] = binary_int(header + 16 + 4 * d, true);
    }
    size_t damage = 0;
    const char *fault = mf_xtc_coordinates_check(&packing, bytes);
    if (fault == NULL) {
        TRY(mf_frame_reserve(frame, atoms, false));
        fault = mf_xtc_coordinates_unpack(&packing, frame->raw.data + begin, bytes, frame->position,
                                          &damage);
    }
    return fault ? mf_frame_fail_byte(frame, begin + damage, "%s", fault) : STATUS_OK;
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

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const unsigned char *const header = frame->raw.data;
    const size_t atoms = binary_word(header + 4, true);
    double box[3][3];
    (void)trajectory;
    frame->step = binary_int(header + 8, true);
    frame->time = binary_float(header + 12, true);
    for (int k = 0; k < 9; k++)
        box[k / 3][k % 3] = binary_float(header + 16 + 4 * k, true);
    mf_frame_set_box(frame, box);
    return atoms <= FEW_ATOMS ? copy_few(frame, atoms) : unpack(frame, atoms);
}

static const char *const extensions[] = {"xtc", NULL};

const struct trajectory_format mf_format_xtc = {
    .name = "xtc",
    .extensions = extensions,
    .summary = "GROMACS, compressed: positions; also the frames of 64-bit sizes since 2023",
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
