// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS's full trajectories: XDR (RFC 4506), in single or double precision, each frame with a
// header that tells the bytes of its parts.
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"

#include <math.h>

enum { MAGIC = 1993, TITLE = 24, HEADER = TITLE + 13 * 4, PARTS = 10 };

/// The parts of a frame in the order in which they follow; all but these four are passed over.
enum { BOX = 2, POSITIONS = 7, VELOCITIES = 8, FORCES = 9 };

/// The header with numbers after the title: sizes of the parts, atoms, step, and one that nobody
/// uses; time and λ, of the precision of the rest, follow.
struct header {
    int32_t size[PARTS];
    int32_t atoms, step;
    size_t real;                 ///< bytes of a number
    size_t place[PARTS], length; ///< of the parts in the frame; of the frame
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 4 && binary_int(begin, true) == MAGIC;
}

/// Bytes of a number, from the part that is there: 0 if none says it, or says it wrongly.
static size_t find_precision(const struct header *header) {
    const int64_t atoms = header->atoms;
    static const int vectors[] = {POSITIONS, VELOCITIES, FORCES};
    for (size_t real = 4; real <= 8; real += 4) {
        bool fits = header->size[BOX] == 0 || header->size[BOX] == (int32_t)(9 * real);
        for (int k = 0; k < 3; k++)
            fits &= header->size[vectors[k]] == 0 ||
                    header->size[vectors[k]] == 3 * atoms * (int64_t)real;
        if (fits)
            return real;
    }
    return 0;
}

static bool read_header(struct header *header, const unsigned char *raw) {
    *header = (struct header){0};
    for (int k = 0; k < PARTS; k++) {
        header->size[k] = binary_int(raw + TITLE + 4 * k, true);
        if (header->size[k] < 0)
            return false;
    }
    header->atoms = binary_int(raw + TITLE + 4 * PARTS, true);
    header->step = binary_int(raw + TITLE + 4 * PARTS + 4, true);
    header->real = header->atoms > 0 ? find_precision(header) : 0;
    header->length = HEADER + 2 * header->real;
    for (int k = 0; k < PARTS; k++) {
        header->place[k] = header->length;
        header->length += (size_t)header->size[k];
    }
    return header->real > 0;
}

static enum status check_header(const struct trajectory *trajectory, const unsigned char *raw,
                                struct header *header) {
    const struct source *const source = &trajectory->source;
    static const unsigned char title[] = "\0\0\0\x0D\0\0\0\x0CGMX_trn_file";
    if (!recognise(raw, HEADER) || memcmp(raw + 4, title, TITLE - 4) != 0)
        return mf_source_fail_byte(source, "expected the beginning of a frame");
    if (!read_header(header, raw))
        return mf_source_fail_byte(source, "inconsistent sizes in the header");
    if (source->frame > 0 && (size_t)header->atoms != trajectory->structure.atoms)
        return mf_source_fail_byte(source, "it has %d atoms, the first frame %zu",
                                   (int)header->atoms, trajectory->structure.atoms);
    return STATUS_OK;
}

/// Frames that hold velocities or forces alone are passed over.
static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    struct source *const source = &trajectory->source;
    struct header header;
    do {
        TRY(mf_source_more(source, more));
        if (!*more)
            return STATUS_OK;
        frame->first_byte = source->byte;
        frame->raw.size = 0;
        TRY(mf_source_take(source, &frame->raw, HEADER));
        TRY(check_header(trajectory, frame->raw.data, &header));
        TRY(mf_source_take(source, &frame->raw, header.length - HEADER));
    } while (header.size[POSITIONS] == 0);
    return STATUS_OK;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    struct header header = {0};
    read_header(&header, first->raw.data);
    return mf_structure_init(&trajectory->structure, (size_t)header.atoms);
}

static enum status copy(const struct trajectory_frame *frame, const struct header *header, int part,
                        double (*array)[3]) {
    const unsigned char *const from = frame->raw.data + header->place[part];
    for (size_t k = 0; k < 3 * frame->atoms; k++) {
        const double value = binary_real(from, k, header->real, true);
        if (!isfinite(value))
            return mf_frame_fail_byte(frame, header->place[part] + k * header->real,
                                      "a coordinate is not finite");
        array[k / 3][k % 3] = value;
    }
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const unsigned char *const raw = frame->raw.data;
    struct header header;
    double box[3][3] = {{0}};
    read_header(&header, raw);
    frame->step = header.step;
    frame->time = binary_real(raw + HEADER, 0, header.real, true);
    for (int k = 0; header.size[BOX] > 0 && k < 9; k++)
        box[k / 3][k % 3] = binary_real(raw + header.place[BOX], (size_t)k, header.real, true);
    mf_frame_set_box(frame, box);
    TRY(mf_frame_reserve(frame, (size_t)header.atoms, header.size[VELOCITIES] > 0));
    TRY(copy(frame, &header, POSITIONS, frame->position));
    if (frame->has_velocities)
        TRY(copy(frame, &header, VELOCITIES, frame->velocity));
    if (!trajectory->forces || header.size[FORCES] == 0)
        return STATUS_OK;
    TRY(mf_frame_reserve_forces(frame));
    return copy(frame, &header, FORCES, frame->force);
}

static const char *const extensions[] = {"trr", NULL};

const struct trajectory_format mf_format_trr = {
    .name = "trr",
    .extensions = extensions,
    .summary =
        "GROMACS, single or double precision: positions; velocities and forces if it has them",
    .recognise = recognise,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
