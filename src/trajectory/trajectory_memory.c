// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/trajectory_memory.h"

#include <math.h>
#include <string.h>

static _Thread_local const struct trajectory_memory *memory_frames;

void mf_trajectory_lend(const struct trajectory_memory *memory_files) {
    memory_frames = memory_files;
}

const struct trajectory_memory *mf_trajectory_memory_find(const char *name) {
    return memory_frames && strcmp(memory_frames->name, name) == 0 ? memory_frames : NULL;
}

/// What goes before the numbers of a frame in its raw bytes.
struct header {
    double time;      ///< [ps]
    double box[3][3]; ///< [nm]
    bool has_velocities, has_forces;
};

static size_t frame_size(const struct trajectory_memory *memory_files) {
    return sizeof(struct header) + 3 * memory_files->structure->atoms * sizeof(double);
}

uint64_t mf_trajectory_memory_bytes(const struct trajectory_memory *memory_files) {
    return (uint64_t)memory_files->frames * frame_size(memory_files);
}

struct state {
    const struct trajectory_memory *memory_files;
};

static bool recognise(const unsigned char *begin, size_t size) {
    (void)begin, (void)size;
    return false;
}

static enum status open(struct trajectory *trajectory) {
    struct state *const state = trajectory->state;
    state->memory_files = mf_trajectory_memory_find(trajectory->file);
    trajectory->frames = state->memory_files->frames;
    return STATUS_OK;
}

/// Append the numbers of all atoms in nm, nm/ps or kJ/mol/nm. Fails: BAD_INPUT if one is not
/// finite.
static enum status take(struct trajectory *trajectory, struct trajectory_frame *frame,
                        const double *numbers, double factor, const char *what) {
    const struct trajectory_memory *const memory_files =
        ((struct state *)trajectory->state)->memory_files;
    const size_t count = 3 * memory_files->structure->atoms;
    TRY(mf_source_capacity(&frame->raw, count * sizeof(double)));
    double *const to = (double *)(void *)(frame->raw.data + frame->raw.size);
    for (size_t k = 0; k < count; k++) {
        to[k] = numbers[k] * factor;
        if (!isfinite(to[k]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: the %s of atom %zu is not finite",
                                  trajectory->file, frame->number, what, k / 3 + 1);
    }
    frame->raw.size += count * sizeof(double);
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct trajectory_memory *const memory_files =
        ((struct state *)trajectory->state)->memory_files;
    struct source *const source = &trajectory->source;
    struct trajectory_memory_frame from = {.time = NAN};
    struct header header;
    *more = memory_files->frames == 0 || source->frame < memory_files->frames;
    if (*more)
        TRY(memory_files->read(memory_files->context, source->frame, &from, more));
    if (!*more)
        return STATUS_OK;
    frame->number = source->frame + 1; // as atoms are counted
    memset(&header, 0, sizeof header); // a digest is taken of it, padding and all
    header.time = from.time * memory_files->time;
    header.has_velocities = from.velocities != NULL;
    header.has_forces = trajectory->forces && from.forces != NULL;
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++)
            header.box[i][d] = from.box[i][d] * memory_files->length;
    TRY(mf_source_capacity(&frame->raw, sizeof header));
    memcpy(frame->raw.data, &header, sizeof header);
    frame->raw.size = sizeof header;
    TRY(take(trajectory, frame, from.positions, memory_files->length, "position"));
    if (from.velocities)
        TRY(take(trajectory, frame, from.velocities, memory_files->length / memory_files->time,
                 "velocity"));
    if (header.has_forces)
        TRY(take(trajectory, frame, from.forces, 1 / memory_files->length, "force"));
    return STATUS_OK;
}

static double peek(const struct trajectory_frame *frame) {
    struct header header;
    memcpy(&header, frame->raw.data, sizeof header);
    return header.time;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct structure *const from =
        ((struct state *)trajectory->state)->memory_files->structure;
    struct structure *const to = &trajectory->structure;
    (void)first;
    TRY(mf_structure_init(to, from->atoms));
    struct structure_atom *const atom = to->atom;
    *to = *from;
    to->atom = atom;
    memcpy(atom, from->atom, from->atoms * sizeof *atom);
    return STATUS_OK;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const size_t atoms = trajectory->structure.atoms, bytes = 3 * atoms * sizeof(double);
    struct header header;
    memcpy(&header, frame->raw.data, sizeof header);
    frame->time = header.time;
    mf_frame_set_box(frame, (const double(*)[3])header.box);
    TRY(mf_frame_reserve(frame, atoms, header.has_velocities));
    const unsigned char *from = frame->raw.data + sizeof header;
    memcpy(frame->position, from, bytes);
    from += bytes;
    if (header.has_velocities) {
        memcpy(frame->velocity, from, bytes);
        from += bytes;
    }
    if (!header.has_forces)
        return STATUS_OK;
    TRY(mf_frame_reserve_forces(frame));
    memcpy(frame->force, from, bytes);
    return STATUS_OK;
}

static const char *const extensions[] = {NULL};

const struct trajectory_format mf_trajectory_memory = {
    .name = "frames",
    .extensions = extensions,
    .summary = "frames in memory",
    .unit_source = TRAJECTORY_OWN_UNITS,
    .state_size = sizeof(struct state),
    .recognise = recognise,
    .open = open,
    .fetch = fetch,
    .peek = peek,
    .describe = describe,
    .decode = decode,
};
