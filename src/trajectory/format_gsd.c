// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSD of HOOMD-blue (gsd.readthedocs.io: file layer 1 and 2, schema hoomd): chunks of numbers by
// frame and name, found by an index; little-endian. What a frame does not have is as in frame 0,
// or else as the schema says; but velocities of frame 0 alone are no velocities of the others:
// HOOMD writes those of all frames only if "momentum" is dynamic. Its units are those of the
// simulation, which nothing tells.
#include "base/memory.h"
#include "trajectory/binary.h"
#include "trajectory/gsd.h"

#include <math.h>
#include <string.h>

/// What goes before the numbers of a frame in its raw bytes.
struct header {
    uint64_t step;
    double box[6]; ///< lengths and tilts
    bool has_velocities, has_images;
    bool has_own_images; ///< else they are those of frame 0, which may not be written again
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 8 && memcmp(begin, "\xDF\x65\xDF\x65\xDF\x65\xDF\x65", 8) == 0;
}

/// What a frame must be like, as numbers of its own and of frame 0.
static enum status check_frame(struct trajectory *trajectory, uint64_t frame, struct bytes *raw) {
    struct gsd *const gsd = trajectory->state;
    const struct source *const source = &trajectory->source;
    uint64_t dimensions, atoms;
    TRY(mf_gsd_take_number(trajectory, frame, DIMENSIONS, 3, raw, &dimensions));
    TRY(mf_gsd_take_number(trajectory, frame, COUNT, 0, raw, &atoms));
    if (dimensions != 3)
        return mf_source_fail_byte(source, "it is of %llu dimensions; those of 3 are read",
                                   (unsigned long long)dimensions);
    if (atoms == 0)
        return mf_source_fail_byte(source, "there are no particles");
    if (frame > 0 && atoms != gsd->atoms)
        return mf_source_fail_byte(source, "it has %llu particles, the first frame %lu",
                                   (unsigned long long)atoms, (unsigned long)gsd->atoms);
    gsd->atoms = (uint32_t)atoms;
    return STATUS_OK;
}

/// Of a particle, by the bytes of all; of none it is 0.
static uint32_t type_of(const struct bytes *types, size_t particle) {
    return types->size ? binary_word(types->data + 4 * particle, false) : 0;
}

/// Particles keep their types, which beads are made by.
static enum status check_types(struct trajectory *trajectory, uint64_t frame, struct bytes *raw) {
    struct gsd *const gsd = trajectory->state;
    bool there;
    if (frame > 0 && mf_gsd_find(gsd, frame, TYPE) == NULL)
        return STATUS_OK;
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, frame, TYPE, gsd->atoms, frame > 0 ? raw : &gsd->types, &there));
    for (size_t k = 0; frame > 0 && there && k < gsd->atoms; k++)
        if (type_of(raw, k) != type_of(&gsd->types, k))
            return mf_source_fail_byte(&trajectory->source,
                                       "particle %zu is of type %lu, in the first frame of %lu: "
                                       "particles must keep their types",
                                       k + 1, (unsigned long)type_of(raw, k),
                                       (unsigned long)type_of(&gsd->types, k));
    return STATUS_OK;
}

static enum status take_box(struct trajectory *trajectory, uint64_t frame, struct bytes *raw,
                            double box[6]) {
    bool there;
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, frame, BOX, 6, raw, &there));
    for (size_t k = 0; k < 6; k++)
        box[k] = there ? binary_double(raw->data + 8 * k, false) : k < 3;
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct gsd *const gsd = trajectory->state;
    struct bytes *const raw = &frame->raw;
    const uint64_t number = trajectory->source.frame;
    struct header header = {0};
    bool there;
    (void)more;
    TRY(check_frame(trajectory, number, raw));
    TRY(check_types(trajectory, number, raw));
    TRY(mf_gsd_take_number(trajectory, number, STEP, 0, raw, &header.step));
    TRY(take_box(trajectory, number, raw, header.box));
    raw->size = 0;
    TRY(mf_source_capacity(raw, sizeof header));
    raw->size = sizeof header;
    TRY(mf_gsd_take_if(trajectory, number, POSITION, gsd->atoms, raw, &there));
    if (!there)
        return mf_source_fail_byte(&trajectory->source, "there are no positions");
    if (gsd->moves && mf_gsd_find(gsd, number, VELOCITY))
        TRY(mf_gsd_take_if(trajectory, number, VELOCITY, gsd->atoms, raw, &header.has_velocities));
    TRY(mf_gsd_take_if(trajectory, number, IMAGE, gsd->atoms, raw, &header.has_images));
    header.has_own_images = mf_gsd_find(gsd, number, IMAGE);
    memcpy(raw->data, &header, sizeof header);
    return STATUS_OK;
}

// What the atoms are ------------------------------------------------------------------------------

/// Names of types, each ended by a NUL or by the end of its row; "A" if there are none.
static enum status describe_types(struct trajectory *trajectory, struct bytes *raw) {
    const struct gsd *const gsd = trajectory->state;
    struct structure *const structure = &trajectory->structure;
    uint64_t types;
    uint32_t width = 0;
    raw->size = 0;
    TRY(mf_gsd_take(trajectory, 0, TYPES, 0, raw, &types, &width));
    structure->has_names = true; // whose numbers are the file's own
    for (size_t k = 0; k < structure->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        const uint32_t type = type_of(&gsd->types, k);
        if (type >= (types ? types : 1))
            return mf_source_fail_byte(&trajectory->source, "particle %zu is of type %lu of %llu",
                                       k + 1, (unsigned long)type, (unsigned long long)types);
        const char *const name = types ? (const char *)raw->data + (size_t)type * width : "A";
        const size_t length = types ? strnlen(name, width) : 1;
        memcpy(atom->name, name, length < STRUCTURE_NAME ? length : STRUCTURE_NAME - 1);
    }
    return STATUS_OK;
}

static enum status describe_masses(struct trajectory *trajectory, struct bytes *raw) {
    struct structure *const structure = &trajectory->structure;
    bool there;
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, 0, MASS, structure->atoms, raw, &there));
    structure->has_masses = true;
    for (size_t k = 0; k < structure->atoms; k++)
        structure->atom[k].mass =
            trajectory->scale.mass * (there ? binary_double(raw->data + 8 * k, false) : 1);
    return STATUS_OK;
}

/// A particle on its own is a bead that is called as its type.
static void name_single(struct structure *structure) {
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].molecule == 0)
            memcpy(structure->atom[k].residue_name, structure->atom[k].name, STRUCTURE_NAME);
}

/// Types of terms and their names. A file without them has one type, which is not named.
static enum status describe_term_types(struct trajectory *trajectory, int kind, struct bytes *raw) {
    struct structure_terms *const terms = &trajectory->structure.terms[kind];
    uint64_t types;
    uint32_t width = 0;
    bool there;
    raw->size = 0;
    TRY(mf_gsd_take(trajectory, 0, (enum gsd_chunk)(BOND_TYPES + kind), 0, raw, &types, &width));
    if (types == 0)
        return STATUS_OK;
    TRY_ARRAY(terms->name, (size_t)types);
    terms->types = (size_t)types;
    for (size_t k = 0; k < terms->types; k++) {
        const char *const name = (const char *)raw->data + k * width;
        const size_t length = strnlen(name, width);
        memcpy(terms->name[k], name, length < STRUCTURE_NAME ? length : STRUCTURE_NAME - 1);
    }
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, 0, (enum gsd_chunk)(BOND_TYPE + kind), terms->count, raw,
                       &there));
    TRY_ARRAY(terms->type, terms->count);
    for (size_t k = 0; k < terms->count; k++) {
        terms->type[k] = there ? binary_word(raw->data + 4 * k, false) : 0;
        if (terms->type[k] >= types)
            return mf_source_fail_byte(&trajectory->source, "\"%s\": number %zu is %lu of %llu",
                                       mf_gsd_name((enum gsd_chunk)(BOND_TYPE + kind)), k + 1,
                                       (unsigned long)terms->type[k], (unsigned long long)types);
    }
    return STATUS_OK;
}

static enum status describe_terms(struct trajectory *trajectory, int kind, struct bytes *raw) {
    struct structure_terms *const terms = &trajectory->structure.terms[kind];
    const size_t atoms = 2 + (size_t)kind;
    bool there;
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, 0, (enum gsd_chunk)(BOND + kind), 0, raw, &there));
    const size_t count = there ? raw->size / (4 * atoms) : 0;
    if (count == 0)
        return STATUS_OK;
    TRY_ARRAY(terms->atom, count * atoms);
    terms->count = count;
    for (size_t k = 0; k < count * atoms; k++) {
        terms->atom[k] = binary_word(raw->data + 4 * k, false);
        if (terms->atom[k] >= trajectory->structure.atoms)
            return mf_source_fail_byte(
                &trajectory->source, "\"%s\": number %zu is of particle %lu of %zu",
                mf_gsd_name((enum gsd_chunk)(BOND + kind)), k / atoms + 1,
                (unsigned long)terms->atom[k] + 1, trajectory->structure.atoms);
    }
    return describe_term_types(trajectory, kind, raw);
}

/// Molecules are what bonds and constraints join.
static enum status describe_molecules(struct trajectory *trajectory, struct bytes *raw) {
    bool there;
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, 0, BOND, 0, raw, &there));
    TRY(mf_gsd_take_if(trajectory, 0, CONSTRAINT, 0, raw, &there));
    const enum status status =
        raw->size == 0 ? STATUS_OK
                       : mf_structure_join(&trajectory->structure,
                                           (const uint32_t(*)[2])(const void *)raw->data,
                                           raw->size / (2 * sizeof(uint32_t)));
    name_single(&trajectory->structure);
    return status == STATUS_BAD_INPUT ? mf_status_prefix(status, "%s", trajectory->file) : status;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct gsd *const gsd = trajectory->state;
    struct bytes raw = {0};
    (void)first;
    enum status status = mf_structure_init(&trajectory->structure, gsd->atoms);
    if (status == STATUS_OK)
        status = describe_types(trajectory, &raw);
    if (status == STATUS_OK)
        status = describe_masses(trajectory, &raw);
    if (status == STATUS_OK)
        status = describe_molecules(trajectory, &raw);
    for (int kind = 0; kind < STRUCTURE_TERM_KINDS && status == STATUS_OK; kind++)
        status = describe_terms(trajectory, kind, &raw);
    mf_source_free(&raw);
    return status;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const size_t atoms = trajectory->structure.atoms, bytes = 24 * atoms;
    const struct trajectory_scale *const scale = &trajectory->scale;
    const unsigned char *const position = frame->raw.data + sizeof(struct header);
    struct header header;
    memcpy(&header, frame->raw.data, sizeof header);
    const double *const v = header.box, x = scale->length;
    const double box[3][3] = {{v[0] * x, 0, 0},
                              {v[3] * v[1] * x, v[1] * x, 0},
                              {v[4] * v[2] * x, v[5] * v[2] * x, v[2] * x}};
    const unsigned char *const velocity = position + bytes, *const image =
                                                                velocity +
                                                                (header.has_velocities ? bytes : 0);
    frame->step = header.step < INT64_MAX ? (int64_t)header.step : -1;
    mf_frame_set_box(frame, box);
    TRY(mf_frame_reserve(frame, atoms, header.has_velocities));
    frame->unwrapped = header.has_own_images;
    for (size_t k = 0; k < 3 * atoms; k++) {
        const size_t at = 8 * k;
        frame->position[k / 3][k % 3] = x * binary_double(position + at, false);
        for (size_t i = 0; header.has_images && i < 3; i++)
            frame->position[k / 3][k % 3] +=
                frame->box[i][k % 3] * binary_int(image + 12 * (k / 3) + 4 * i, false);
        if (header.has_velocities)
            frame->velocity[k / 3][k % 3] = scale->speed * binary_double(velocity + at, false);
        if (!isfinite(frame->position[k / 3][k % 3]) ||
            (header.has_velocities && !isfinite(frame->velocity[k / 3][k % 3])))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: position or velocity of particle %zu is not "
                                  "finite",
                                  frame->file, frame->number, k / 3 + 1);
    }
    return STATUS_OK;
}

static const char *const extensions[] = {"gsd", NULL};

const struct trajectory_format mf_format_gsd = {
    .name = "gsd",
    .extensions = extensions,
    .summary = "HOOMD-blue: positions, velocities, images, box; types, masses, molecules by bonds",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .state_size = sizeof(struct gsd),
    .recognise = recognise,
    .open = mf_gsd_open,
    .close = mf_gsd_close,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
    .print = mf_gsd_print_beads,
};
